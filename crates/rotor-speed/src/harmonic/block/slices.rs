//! The lines of a block as sums over slices: their likelihood and its derivatives near a first guess of the speed.

use super::SpeedLine;
use crate::harmonic::demodulation::Line;
use crate::harmonic::phasors::{OrderPhasors, small_turn};
use crate::harmonic::speed_path::SpeedPath;
use hovertone_signal::channels::TICKS_PER_HOP;
use realfft::num_complex::Complex;
use std::f64::consts::TAU;
use std::ops::Range;

/// Largest number of slices of a block. Within a slice, a speed that is off by one resolution cell of a line turns this line by at
/// most a sixteenth of a cycle. *Numeric.*
const SLICES_MAX: usize = 16;
/// Ticks of half a hop. *Numeric.*
pub(crate) const HALF_HOP_TICKS: usize = TICKS_PER_HOP / 2;

/// One line in a block.
pub(super) struct BlockLine {
    pub(super) order: f64,
    pub(super) is_first: bool,
    pub(super) is_strong: bool,
    pub(super) leakage_band_hz: Range<f64>,
    /// 1 / (N V).
    pub(super) scale: f64,
    /// N: number of samples in the block.
    pub(super) samples: f64,
}

/// The lines of a block, demodulated along a first guess of its speed and summed over slices of equal length.
pub(crate) struct BlockSlices {
    pub(super) lines: Vec<BlockLine>,
    pub(super) ticks: Range<usize>,
    /// Middle of each slice from the middle of the block.
    times_s: Vec<f64>,
    /// Sum of each slice, line by line.
    sums: Vec<Complex<f64>>,
    /// Middle of each half hop from the middle of the block.
    pub(super) half_hop_times_s: Vec<f64>,
    /// Sum of each half hop, line by line: they show whether a line keeps its phase.
    pub(super) half_hops: Vec<Complex<f64>>,
    /// Share of the block in each half hop.
    pub(super) half_hop_shares: Vec<f64>,
    /// Length of the block.
    pub(super) length_s: f64,
    pub(super) guess: SpeedLine,
}

/// J at a place, its gradient (∂/∂n, ∂/∂γ), and its second derivatives (∂²/∂n², ∂²/∂n∂γ, ∂²/∂γ²).
pub(crate) struct Expansion {
    pub(crate) value: f64,
    pub(crate) gradient: [f64; 2],
    pub(crate) second: [f64; 3],
}

impl Expansion {
    /// J after a small step of speed and slope.
    pub(super) fn value_after(&self, speed: f64, slope: f64) -> f64 {
        let [nn, ng, gg] = self.second;
        let bend = nn * speed * speed + 2.0 * ng * speed * slope + gg * slope * slope;
        self.value + self.gradient[0] * speed + self.gradient[1] * slope + bend / 2.0
    }
}

impl BlockSlices {
    /// The slices of a block of `ticks`, demodulated along the line of speed `guess` instead of along `path`.
    pub(crate) fn new(lines: &[Line], path: &SpeedPath, ticks: Range<usize>, guess: SpeedLine) -> Self {
        let tick_s = path.tick_s;
        let count = ticks.len();
        let per_slice = count.div_ceil(SLICES_MAX);
        let slices = count.div_ceil(per_slice);
        let halves = count.div_ceil(HALF_HOP_TICKS);
        let lead = Lead { path, middle_s: (ticks.start + ticks.end) as f64 / 2.0 * tick_s, guess };
        let turns: Vec<f64> = lead.turns(ticks.clone());
        let of_slices = lead.speeds_rev_s(ticks.clone(), per_slice);
        let of_halves = lead.speeds_rev_s(ticks.clone(), HALF_HOP_TICKS);
        let mut phasors = OrderPhasors::new(&turns);
        let mut turned = Vec::with_capacity(count);
        let mut sums = vec![Complex::default(); lines.len() * slices];
        let mut half_hops = vec![Complex::default(); lines.len() * halves];
        for ((line, sums), half_hops) in
            lines.iter().zip(sums.chunks_exact_mut(slices)).zip(half_hops.chunks_exact_mut(halves))
        {
            // the mean time of the samples of a tick is half a sample before its middle
            let half_sample = TAU * line.order * tick_s / line.samples_per_tick / 2.0;
            let ticks = line.ticks[ticks.clone()].iter().zip(phasors.of(line.order));
            turned.clear();
            turned.extend(ticks.map(|(z, phasor)| z * phasor));
            sum_chunks(&turned, per_slice, sums);
            sum_half_hops(&turned, half_hops);
            let turn_back = |(sum, speed): (&mut Complex<f64>, &f64)| *sum *= small_turn(speed * half_sample);
            sums.iter_mut().zip(&of_slices).for_each(turn_back);
            half_hops.iter_mut().zip(&of_halves).for_each(turn_back);
        }
        Self {
            lines: lines.iter().map(|line| BlockLine::new(line, count)).collect(),
            times_s: slice_times_s(count, per_slice, tick_s),
            sums,
            half_hop_times_s: slice_times_s(count, HALF_HOP_TICKS, tick_s),
            half_hops,
            half_hop_shares: (0..halves)
                .map(|half| (count - half * HALF_HOP_TICKS).min(HALF_HOP_TICKS) as f64 / count as f64)
                .collect(),
            length_s: count as f64 * tick_s,
            ticks,
            guess,
        }
    }

    fn lines(&self) -> impl Iterator<Item = (&BlockLine, &[Complex<f64>])> {
        self.lines.iter().zip(self.sums.chunks_exact(self.times_s.len()))
    }

    /// The sum of each line along a line of speed near the guess, over √(N V): the square of its magnitude is J.
    pub(super) fn line_sums(&self, along: SpeedLine) -> Vec<LineSum> {
        let turns =
            self.turns(along.speed_rev_s - self.guess.speed_rev_s, along.slope_rev_s2 - self.guess.slope_rev_s2);
        let mut phasors = OrderPhasors::new(&turns);
        self.lines()
            .map(|(&BlockLine { order, scale, .. }, sums)| {
                let sum: Complex<f64> = sums.iter().zip(phasors.of(order)).map(|(z, phasor)| z * phasor).sum();
                LineSum { order, sum: scale.sqrt() * sum }
            })
            .collect()
    }

    /// Angle of the shaft in the middle of each slice, in turns, ahead of the guess.
    fn turns(&self, d_speed: f64, d_slope: f64) -> Vec<f64> {
        self.times_s.iter().map(|t| t * (d_speed + d_slope * t / 2.0)).collect()
    }

    /// J and its derivatives at a difference of speed and slope from the guess.
    pub(crate) fn expansion(&self, d_speed: f64, d_slope: f64) -> Expansion {
        let (mut value, mut gradient, mut second) = (0.0, [0.0; 2], [0.0; 3]);
        let turns = self.turns(d_speed, d_slope);
        let powers: Vec<[f64; 5]> = self.times_s.iter().map(|t| [1.0, *t, t * t, t * t * t, t * t * t * t]).collect();
        let mut phasors = OrderPhasors::new(&turns);
        for (&BlockLine { order, scale, .. }, sums) in self.lines() {
            let w = TAU * order;
            // moments S_m = Σ z τ^m, m = 0 … 4
            let mut moments = [Complex::<f64>::default(); 5];
            for ((z, phasor), powers) in sums.iter().zip(phasors.of(order)).zip(&powers) {
                let z = z * phasor;
                moments.iter_mut().zip(powers).for_each(|(moment, power)| *moment += z * power);
            }
            let [s, s1, s2, s3, s4] = moments;
            // ∂S/∂n = −jw S₁, ∂S/∂γ = −jw S₂/2, and so on
            let j = Complex::new(0.0, 1.0);
            let (dn, dg) = (-j * w * s1, -j * w * s2 / 2.0);
            let (nn, ng, gg) = (-w * w * s2, -w * w * s3 / 2.0, -w * w * s4 / 4.0);
            let of = |a: Complex<f64>, b: Complex<f64>| (a.conj() * b).re;
            value += scale * s.norm_sqr();
            gradient[0] += 2.0 * scale * of(s, dn);
            gradient[1] += 2.0 * scale * of(s, dg);
            second[0] += 2.0 * scale * (dn.norm_sqr() + of(s, nn));
            second[1] += 2.0 * scale * (of(dn, dg) + of(s, ng));
            second[2] += 2.0 * scale * (dg.norm_sqr() + of(s, gg));
        }
        Expansion { value, gradient, second }
    }

    /// Adds J on a grid of speeds around the guess to `values`: `points` grid points to either side.
    pub(super) fn add_grid(&self, step_rev_s: f64, points: usize, values: &mut [f64]) {
        let turns_at = |d_speed: f64| -> Vec<f64> { self.times_s.iter().map(|t| t * d_speed).collect() };
        let (first, step) = (turns_at(-step_rev_s * points as f64), turns_at(step_rev_s));
        let (mut firsts, mut steps) = (OrderPhasors::new(&first), OrderPhasors::new(&step));
        for (&BlockLine { order, scale, .. }, sums) in self.lines() {
            let turned = sums.iter().zip(firsts.of(order)).map(|(z, first)| z * first);
            let mut slices: Vec<(Complex<f64>, Complex<f64>)> = turned.zip(steps.of(order).iter().copied()).collect();
            for value in values.iter_mut() {
                let mut sum = Complex::<f64>::default();
                for (z, step) in &mut slices {
                    sum += *z;
                    *z *= *step;
                }
                *value += scale * sum.norm_sqr();
            }
        }
    }

    /// A resolution cell of the highest line, as a speed: 1 / (order × length of the block).
    pub(crate) fn cell_rev_s(&self) -> f64 {
        1.0 / (self.lines.iter().map(|line| line.order).fold(1.0, f64::max) * self.length_s)
    }
}

impl BlockLine {
    /// A line in a block of a number of ticks.
    fn new(line: &Line, ticks: usize) -> Self {
        let samples = line.samples_per_tick * ticks as f64;
        Self {
            order: line.order,
            is_first: line.is_first,
            is_strong: line.is_strong,
            leakage_band_hz: line.leakage_band_hz.clone(),
            scale: 1.0 / (samples * line.noise_variance),
            samples,
        }
    }
}

/// The sum of a line over a block.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LineSum {
    pub(crate) order: f64,
    pub(crate) sum: Complex<f64>,
}

/// How far the line of speed `guess` is ahead of the path. Their angles are equal in the middle of the block.
struct Lead<'a> {
    path: &'a SpeedPath,
    middle_s: f64,
    guess: SpeedLine,
}

impl Lead<'_> {
    /// Angle of the lead in the middle of each tick, in turns.
    fn turns(&self, ticks: Range<usize>) -> Vec<f64> {
        let turns_middle = self.path.turns_at(self.middle_s);
        let SpeedLine { speed_rev_s: speed, slope_rev_s2: slope } = self.guess;
        let turns = |tick: usize| {
            let t = (tick as f64 + 0.5) * self.path.tick_s - self.middle_s;
            speed * t + slope * t * t / 2.0 - (self.path.turns_at_middle(tick) - turns_middle)
        };
        ticks.map(turns).collect()
    }

    /// Speed of the lead in the middle of each sum of `per_sum` ticks.
    fn speeds_rev_s(&self, ticks: Range<usize>, per_sum: usize) -> Vec<f64> {
        let SpeedLine { speed_rev_s: speed, slope_rev_s2: slope } = self.guess;
        let of_sum = |first: usize| {
            let last = (first + per_sum).min(ticks.end);
            let time_s = (first + last) as f64 / 2.0 * self.path.tick_s;
            let of_path = self.path.turns_between(first, last) / ((last - first) as f64 * self.path.tick_s);
            speed + slope * (time_s - self.middle_s) - of_path
        };
        ticks.clone().step_by(per_sum).map(of_sum).collect()
    }
}

/// Middle of each slice of `per_slice` ticks from the middle of a block of `ticks` ticks, s. The last slice may be shorter.
fn slice_times_s(ticks: usize, per_slice: usize, tick_s: f64) -> Vec<f64> {
    (0..ticks.div_ceil(per_slice))
        .map(|slice| {
            let (first, last) = (slice * per_slice, ((slice + 1) * per_slice).min(ticks));
            ((first + last) as f64 - ticks as f64) / 2.0 * tick_s
        })
        .collect()
}

/// Sums of `per_sum` values each.
fn sum_chunks(values: &[Complex<f64>], per_sum: usize, sums: &mut [Complex<f64>]) {
    sums.iter_mut().zip(values.chunks(per_sum)).for_each(|(sum, values)| *sum = sum_of(values));
}

/// The sum of some values, as four sums at once: each addition waits for the one before it.
fn sum_of(values: &[Complex<f64>]) -> Complex<f64> {
    let (fours, rest) = values.as_chunks::<4>();
    let mut sums = [Complex::default(); 4];
    for four in fours {
        sums.iter_mut().zip(four).for_each(|(sum, value)| *sum += value);
    }
    sums.iter().chain(rest).sum()
}

/// Sums of a half hop each: their length is known before, so that there is no inner loop.
fn sum_half_hops(values: &[Complex<f64>], sums: &mut [Complex<f64>]) {
    let (whole, rest) = values.as_chunks::<HALF_HOP_TICKS>();
    sums.iter_mut().zip(whole).for_each(|(sum, values)| *sum = values.iter().sum());
    if let Some(last) = sums.get_mut(whole.len()) {
        *last = rest.iter().sum();
    }
}
