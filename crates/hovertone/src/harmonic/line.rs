//! A channel, turned back by the shaft's angle: one sum for each tick.

use super::path::SpeedPath;
use realfft::num_complex::Complex;
use std::f64::consts::{PI, TAU};

/// One line of a quantum, turned back by a path: one sum for each tick.
pub(super) struct Line {
    pub(super) order: f64,
    /// Whether it is the first of its family.
    pub(super) is_first: bool,
    /// Whether it stands out of the noise in every half hop.
    pub(super) is_strong: bool,
    pub(super) noise_variance: f64,
    pub(super) samples_per_tick: f64,
    pub(super) ticks: Vec<Complex<f64>>,
}

/// `exp(j 2π (o turns(t) − f t))` at the samples of one tick of a channel around f: a line of order o and amplitude 1, as the channel
/// shows it.
pub(super) fn tick_phasors(
    (order, centre_hz, rate_hz): (f64, f64, f64),
    path: &SpeedPath,
    tick: usize,
) -> impl Iterator<Item = Complex<f64>> {
    let (turns, from, to) = path.tick(tick);
    let cycles = order * turns - centre_hz * tick as f64 * path.tick_s;
    // the phase advances by a step that itself advances: both by multiplication
    let step_s = 1.0 / rate_hz;
    let bend = PI * order * (to - from) / path.tick_s * step_s * step_s;
    let mut turn = Complex::from_polar(1.0, TAU * cycles.fract());
    let mut step = Complex::from_polar(1.0, TAU * (order * from - centre_hz) * step_s + bend);
    let step_of_step = Complex::from_polar(1.0, 2.0 * bend);
    std::iter::repeat_with(move || {
        let now = turn;
        turn *= step;
        step *= step_of_step;
        now
    })
}

/// Turns a channel back by the shaft's angle times its order and adds up each tick.
pub(super) fn demodulated(
    series: &[Complex<f32>],
    place: (f64, f64, f64),
    samples_per_tick: usize,
    path: &SpeedPath,
) -> Vec<Complex<f64>> {
    series
        .chunks_exact(samples_per_tick)
        .take(path.ticks())
        .enumerate()
        .map(|(tick, samples)| {
            let turned = samples.iter().zip(tick_phasors(place, path, tick));
            turned.map(|(z, phasor)| phasor.conj() * Complex::new(f64::from(z.re), f64::from(z.im))).sum()
        })
        .collect()
}
