//! A channel, turned back by the shaft's angle: one sum for each tick.

use super::path::SpeedPath;
use super::phasors::small_turn;
use realfft::num_complex::Complex;
use std::f64::consts::{PI, TAU};
use std::ops::Range;

/// One line of a quantum, turned back by a path: one sum for each tick.
pub(crate) struct Line {
    pub(crate) order: f64,
    /// Whether it is the first of its family.
    pub(crate) is_first: bool,
    /// Whether it stands out of the noise in every half hop.
    pub(crate) is_strong: bool,
    pub(crate) noise_variance: f64,
    /// Where other lines of the same rotor are heard with it; an empty range where they were taken away.
    pub(crate) company_hz: Range<f64>,
    pub(crate) samples_per_tick: f64,
    pub(crate) ticks: Vec<Complex<f64>>,
}

/// After so many ticks the phase is taken from the path again, before the roundings of its recurrence add up to anything.
const EXACT_EVERY_TICKS: usize = 64;

/// `exp(j 2π (o turns(t) − f t))` at the samples of a channel around f: a line of order o and amplitude 1, as the channel shows it.
///
/// The phase advances by a step that itself advances, by the same within each tick: all by multiplication.
pub(crate) struct LinePhasors<'a> {
    path: &'a SpeedPath,
    order: f64,
    centre_hz: f64,
    step_s: f64,
    samples_per_tick: usize,
    tick: usize,
    samples_left: usize,
    turn: Complex<f64>,
    step: Complex<f64>,
    step_of_step: Complex<f64>,
    /// Half of the second difference of the phase, for each rev/s that the speed gains in a tick; and that of this tick.
    bend_per_rev_s: f64,
    bend: f64,
}

impl<'a> LinePhasors<'a> {
    pub(crate) fn new(
        (order, centre_hz, rate_hz): (f64, f64, f64),
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
            samples_left: 0,
            turn: Complex::default(),
            step: Complex::default(),
            step_of_step: Complex::default(),
            bend: 0.0,
        }
    }

    fn begin_tick(&mut self) {
        let (turns, from, to) = self.path.tick(self.tick);
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
        self.samples_left = self.samples_per_tick;
    }

    /// The sum of all samples of the next tick, turned back.
    fn tick_turned_back(&mut self, samples: &[Complex<f32>]) -> Complex<f64> {
        self.begin_tick();
        let wide = |z: &Complex<f32>| Complex::new(f64::from(z.re), f64::from(z.im));
        // two samples at a time, so that the products of one need not wait for those of the other
        let (mut even, mut odd) = (self.turn, self.turn * self.step);
        let bend = self.step_of_step;
        let mut even_step = self.step * self.step * bend;
        let mut odd_step = even_step * bend * bend;
        let bend_of_two = bend * bend * bend * bend;
        let (mut even_sum, mut odd_sum) = (Complex::<f64>::default(), Complex::<f64>::default());
        let (pairs, last) = samples.as_chunks::<2>();
        for [first, second] in pairs {
            even_sum += even.conj() * wide(first);
            odd_sum += odd.conj() * wide(second);
            even *= even_step;
            odd *= odd_step;
            even_step *= bend_of_two;
            odd_step *= bend_of_two;
        }
        if let [last] = last {
            even_sum += even.conj() * wide(last);
            (even, odd) = (odd, even * even_step);
        }
        // odd / even, whose magnitudes are 1 but for what rounding adds; without the second factor that would double at every tick
        self.step = odd * even.conj() * (2.0 - even.norm_sqr());
        (self.turn, self.samples_left) = (even, 0);
        even_sum + odd_sum
    }
}

impl Iterator for LinePhasors<'_> {
    type Item = Complex<f64>;

    fn next(&mut self) -> Option<Complex<f64>> {
        if self.samples_left == 0 {
            if self.tick >= self.path.ticks() {
                return None;
            }
            self.begin_tick();
        }
        self.samples_left -= 1;
        let now = self.turn;
        self.turn *= self.step;
        self.step *= self.step_of_step;
        Some(now)
    }
}

/// Turns a channel back by the shaft's angle times its order and adds up each tick.
pub(crate) fn demodulated(
    series: &[Complex<f32>],
    place: (f64, f64, f64),
    samples_per_tick: usize,
    path: &SpeedPath,
) -> Vec<Complex<f64>> {
    let mut phasors = LinePhasors::new(place, path, samples_per_tick);
    series.chunks_exact(samples_per_tick).take(path.ticks()).map(|samples| phasors.tick_turned_back(samples)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phasors_by_multiplication_are_those_of_the_path() {
        let (tick_s, samples_per_tick, order, centre_hz) = (0.0106, 13, 207.0, 12_400.0);
        let speeds: Vec<f64> = (0..=1000).map(|tick| 60.0 + (f64::from(tick) * 0.05).sin()).collect();
        let path = SpeedPath::from_borders(tick_s, speeds);
        let rate_hz = samples_per_tick as f64 / tick_s;
        let phasors: Vec<_> = LinePhasors::new((order, centre_hz, rate_hz), &path, samples_per_tick).collect();
        assert_eq!(phasors.len(), 1000 * samples_per_tick);
        for (sample, phasor) in phasors.iter().enumerate() {
            let (tick, within) = (sample / samples_per_tick, (sample % samples_per_tick) as f64 / rate_hz);
            let (turns, from, to) = path.tick(tick);
            let turned = turns + from * within + (to - from) / tick_s * within * within / 2.0;
            let cycles = order * turned - centre_hz * (tick as f64 * tick_s + within);
            let error = (phasor - Complex::from_polar(1.0, TAU * cycles.fract())).norm();
            assert!(error < 1e-8, "sample {sample}: {error}");
        }
        for odd_or_even in [samples_per_tick, samples_per_tick - 1] {
            let place = (order, centre_hz, odd_or_even as f64 / tick_s);
            let phasors: Vec<_> = LinePhasors::new(place, &path, odd_or_even).collect();
            let narrow = |z: &Complex<f64>| Complex::new(z.re as f32, z.im as f32);
            let series: Vec<Complex<f32>> = phasors.iter().map(narrow).collect();
            for (tick, sum) in demodulated(&series, place, odd_or_even, &path).into_iter().enumerate() {
                let error = (sum / odd_or_even as f64 - 1.0).norm();
                assert!(error < 1e-6, "tick {tick} of {odd_or_even} samples: {error}");
            }
        }
    }
}
