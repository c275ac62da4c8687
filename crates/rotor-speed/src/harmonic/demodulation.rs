//! Demodulation: a channel times the conjugate of the line that a path of speed predicts, one sum for each tick.
//!
//! Where the path is right, the product is constant: amplitude and phase of the line, and noise.

use super::phasors::small_turn;
use super::speed_path::{PathTick, SpeedPath};
use hovertone_signal::channels::Channel;
use realfft::num_complex::Complex;
use std::f64::consts::{PI, TAU};
use std::ops::Range;

/// One line of a rotor over a chunk, demodulated along a path.
pub(crate) struct Line {
    pub(crate) order: f64,
    /// Whether the line is the first of its family.
    pub(crate) is_first: bool,
    /// Whether the line stands out of the noise in every half hop.
    pub(crate) is_strong: bool,
    /// Noise variance of one channel sample.
    pub(crate) noise_variance: f64,
    /// The band of the channel: other lines of the same rotor in it leak into this line. Empty where they were subtracted.
    pub(crate) leakage_band_hz: Range<f64>,
    pub(crate) samples_per_tick: f64,
    /// Sum of the demodulated samples of each tick.
    pub(crate) ticks: Vec<Complex<f64>>,
}

/// Order of a line, and centre frequency and sample rate of the channel in which it is heard.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LinePlace {
    pub(crate) order: f64,
    pub(crate) centre_hz: f64,
    pub(crate) rate_hz: f64,
}

impl LinePlace {
    /// The line for which a channel was made.
    pub(crate) fn of_channel(channel: &Channel) -> Self {
        Self { order: channel.order, centre_hz: channel.centre_hz, rate_hz: channel.rate_hz }
    }
}

/// Ticks after which the phase is computed from the path again, before the rounding errors of the recurrence add up. *Numeric.*
const EXACT_EVERY_TICKS: usize = 64;

/// `exp(j 2π (o θ(t) − f t))` at the samples of a channel with centre frequency f, where θ(t) is the angle of the path in turns: a
/// line of order o, amplitude 1 and phase 0, as the channel shows it.
///
/// The speed is linear in each tick, so that the phase is quadratic: the phasor advances by a step, and the step by a constant
/// factor, all by multiplication.
pub(crate) struct LinePhasors<'a> {
    path: &'a SpeedPath,
    order: f64,
    centre_hz: f64,
    /// Time between samples.
    step_s: f64,
    samples_per_tick: usize,
    tick: usize,
    /// Phasor of the next sample.
    turn: Complex<f64>,
    /// Factor from the next sample to the one after it.
    step: Complex<f64>,
    /// Factor from one step to the next.
    step_of_step: Complex<f64>,
    /// Half of the second difference of the phase, for each rev/s that the speed changes in a tick.
    bend_per_rev_s: f64,
    /// Half of the second difference of the phase in this tick, rad.
    bend: f64,
}

impl<'a> LinePhasors<'a> {
    pub(crate) fn new(
        LinePlace { order, centre_hz, rate_hz }: LinePlace,
        path: &'a SpeedPath,
        samples_per_tick: usize,
    ) -> Self {
        let step_s = 1.0 / rate_hz;
        Self {
            bend_per_rev_s: PI * order / path.tick_s * step_s * step_s,
            path,
            order,
            centre_hz,
            step_s,
            samples_per_tick,
            tick: 0,
            turn: Complex::default(),
            step: Complex::default(),
            step_of_step: Complex::default(),
            bend: 0.0,
        }
    }

    fn begin_tick(&mut self) {
        let PathTick { turns, speed_from_rev_s: from, speed_to_rev_s: to } = self.path.tick(self.tick);
        let bend = self.bend_per_rev_s * (to - from);
        if self.tick.is_multiple_of(EXACT_EVERY_TICKS) {
            let cycles = self.order * turns - self.centre_hz * self.tick as f64 * self.path.tick_s;
            self.turn = Complex::from_polar(1.0, TAU * cycles.fract());
            self.step = Complex::from_polar(1.0, TAU * (self.order * from - self.centre_hz) * self.step_s + bend);
        } else {
            self.step *= small_turn(bend - self.bend);
        }
        self.step_of_step = small_turn(2.0 * bend);
        self.bend = bend;
        self.tick += 1;
    }

    /// Hands out the phasors of the next tick with their numbers.
    pub(crate) fn take_tick(&mut self, mut on_phasor: impl FnMut(usize, Complex<f64>)) {
        self.begin_tick();
        // two samples at a time, because the processor computes independent products in parallel
        let (mut even, mut odd) = (self.turn, self.turn * self.step);
        let bend = self.step_of_step;
        let mut even_step = self.step * self.step * bend;
        let mut odd_step = even_step * bend * bend;
        let bend_of_two = bend * bend * bend * bend;
        let mut sample = 0;
        while sample + 1 < self.samples_per_tick {
            on_phasor(sample, even);
            on_phasor(sample + 1, odd);
            even *= even_step;
            odd *= odd_step;
            even_step *= bend_of_two;
            odd_step *= bend_of_two;
            sample += 2;
        }
        if sample < self.samples_per_tick {
            on_phasor(sample, even);
            (even, odd) = (odd, even * even_step);
        }
        // odd / even: both magnitudes are 1 up to rounding errors; without the second factor these errors would double in each tick
        self.step = odd * even.conj() * (2.0 - even.norm_sqr());
        self.turn = even;
    }

    /// Sum of the demodulated samples of the next tick.
    fn tick_sum(&mut self, samples: &[Complex<f32>]) -> Complex<f64> {
        let wide = |z: &Complex<f32>| Complex::new(f64::from(z.re), f64::from(z.im));
        let samples = &samples[..self.samples_per_tick];
        let mut sums = [Complex::<f64>::default(); 2];
        self.take_tick(|sample, phasor| sums[sample % 2] += phasor.conj() * wide(&samples[sample]));
        sums[0] + sums[1]
    }
}

/// Demodulates the samples of a channel along a path: one sum for each tick.
pub(crate) fn demodulated(
    series: &[Complex<f32>],
    place: LinePlace,
    samples_per_tick: usize,
    path: &SpeedPath,
) -> Vec<Complex<f64>> {
    let mut phasors = LinePhasors::new(place, path, samples_per_tick);
    series.chunks_exact(samples_per_tick).take(path.ticks()).map(|samples| phasors.tick_sum(samples)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all_phasors(place: LinePlace, path: &SpeedPath, samples_per_tick: usize) -> Vec<Complex<f64>> {
        let (mut phasors, mut all) = (LinePhasors::new(place, path, samples_per_tick), Vec::new());
        (0..path.ticks()).for_each(|_| phasors.take_tick(|_, phasor| all.push(phasor)));
        all
    }

    #[test]
    fn phasors_by_multiplication_are_those_of_the_path() {
        let (tick_s, samples_per_tick, order, centre_hz) = (0.0106, 13, 207.0, 12_400.0);
        let speeds: Vec<f64> = (0..=1000).map(|tick| 60.0 + (f64::from(tick) * 0.05).sin()).collect();
        let path = SpeedPath::from_borders(tick_s, speeds);
        let rate_hz = samples_per_tick as f64 / tick_s;
        let place = LinePlace { order, centre_hz, rate_hz };
        let phasors = all_phasors(place, &path, samples_per_tick);
        assert_eq!(phasors.len(), 1000 * samples_per_tick);
        for (sample, phasor) in phasors.iter().enumerate() {
            let (tick, within) = (sample / samples_per_tick, (sample % samples_per_tick) as f64 / rate_hz);
            let PathTick { turns, speed_from_rev_s: from, speed_to_rev_s: to } = path.tick(tick);
            let turned = turns + from * within + (to - from) / tick_s * within * within / 2.0;
            let cycles = order * turned - centre_hz * (tick as f64 * tick_s + within);
            let error = (phasor - Complex::from_polar(1.0, TAU * cycles.fract())).norm();
            assert!(error < 1e-8, "sample {sample}: {error}");
        }
        for odd_or_even in [samples_per_tick, samples_per_tick - 1] {
            let place = LinePlace { rate_hz: odd_or_even as f64 / tick_s, ..place };
            let phasors = all_phasors(place, &path, odd_or_even);
            let narrow = |z: &Complex<f64>| Complex::new(z.re as f32, z.im as f32);
            let series: Vec<Complex<f32>> = phasors.iter().map(narrow).collect();
            for (tick, sum) in demodulated(&series, place, odd_or_even, &path).into_iter().enumerate() {
                let error = (sum / odd_or_even as f64 - 1.0).norm();
                assert!(error < 1e-6, "tick {tick} of {odd_or_even} samples: {error}");
            }
        }
    }
}
