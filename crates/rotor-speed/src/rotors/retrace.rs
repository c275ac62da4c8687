//! A rotor's path once more, near where it is known to be: in its own lines, from which the other rotors have been taken away and
//! which have been turned back by the path itself, so that frames can be longer and finer than along a path that all share.

use super::spectra::{FRAME_TICKS, frame_middle_ticks, half_frame_ticks};
use crate::harmonic::best_path::best_path;
use crate::harmonic::demodulation::Line;
use crate::harmonic::speed_path::SpeedPath;
use hovertone_signal::spectrogram::hann_weights;
use realfft::num_complex::Complex;
use std::f64::consts::TAU;

/// Points of the grid in a resolution cell of the line that resolves most finely. *Numeric.*
const GRID_PER_CELL: f64 = 3.0;
/// How far from the path, in such cells. *Decision.*
const REACH_CELLS: f64 = 3.0;
/// How much the distance from the path changes from one frame to the next, as a share of the speed. *Decision.*
const STEP_STD_SHARE: f64 = 0.0004;

/// The speeds of the best path through the lines' joint likelihood, frame by frame.
pub(super) fn retraced(lines: &[Line], path: &SpeedPath, frame_s_of_order: impl Fn(f64) -> f64) -> Vec<f64> {
    let tick_s = path.tick_s;
    let finest = lines.iter().map(|line| line.order * frame_s_of_order(line.order)).fold(1.0, f64::max);
    let step_rev_s = 1.0 / (finest * GRID_PER_CELL);
    let side = (REACH_CELLS * GRID_PER_CELL).round() as usize;
    let points = 2 * side + 1;
    let frames = path.ticks() / FRAME_TICKS;
    let mut scores = vec![vec![0.0; points]; frames];
    let mut sums = vec![Complex::<f64>::default(); points];
    for line in lines {
        let half_ticks = half_frame_ticks(frame_s_of_order(line.order), tick_s);
        let length = 2 * half_ticks;
        let window: Vec<f64> = hann_weights(length).collect();
        let energy: f64 = window.iter().map(|w| w * w).sum::<f64>() * line.samples_per_tick * line.noise_variance;
        let turns = turns_of_points(line.order * step_rev_s * tick_s, &window, side);
        for (frame, scores) in scores.iter_mut().enumerate() {
            let middle = frame_middle_ticks(frame);
            let from = middle.saturating_sub(half_ticks);
            let to = (middle + half_ticks).min(line.ticks.len());
            let first = from + half_ticks - middle;
            sums.fill(Complex::default());
            for (z, turns) in line.ticks[from..to].iter().zip(turns[points * first..].chunks_exact(points)) {
                // all points beside each other, which the compiler turns into vector instructions
                sums.iter_mut().zip(turns).for_each(|(sum, turn)| *sum += z * turn);
            }
            scores.iter_mut().zip(&sums).for_each(|(score, sum)| *score += sum.norm_sqr() / energy);
        }
    }
    let step_std = STEP_STD_SHARE * path.mean_rev_s() / step_rev_s;
    best_path(&scores, step_std)
        .into_iter()
        .enumerate()
        .map(|(frame, place)| {
            let offset = (place as f64 - side as f64) * step_rev_s;
            path.speed_rev_s(frame_middle_ticks(frame)) + offset
        })
        .collect()
}

/// For each tick of a frame, its weight turned back by `side` points of the grid to either side, which are `cycles_per_tick` apart.
fn turns_of_points(cycles_per_tick: f64, window: &[f64], side: usize) -> Vec<Complex<f64>> {
    let mut turns = Vec::with_capacity(window.len() * (2 * side + 1));
    for (tick, &weight) in window.iter().enumerate() {
        let cycles = cycles_per_tick * (tick as f64 + 0.5 - window.len() as f64 / 2.0);
        let step = Complex::cis(-TAU * cycles);
        let first = Complex::from_polar(weight, TAU * cycles * side as f64);
        turns.extend(std::iter::successors(Some(first), |turn| Some(turn * step)).take(2 * side + 1));
    }
    turns
}
