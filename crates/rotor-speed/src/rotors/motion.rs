//! The motion that all rotors share: a vehicle that bobs speeds them all up and slows them all down, by so much in so short a time that
//! a rotor which is looked for by itself is left behind, on its neighbour's line.

use super::atoms::ChannelAtoms;
use super::grid::OffsetGrid;
use super::line_weights::line_weights;
use super::pace::Pace;
use super::paths::{offsets_within, path_through};
use super::scores::{GridScores, Trust};
use super::spectra::{FRAME_TICKS, Spectra};
use crate::harmonic::best_path::best_path;
use crate::harmonic::chunks::Chunk;
use crate::harmonic::speed_path::SpeedPath;
use crate::thresholds::STEADY_FRAME_S;
use hovertone_signal::fft::ComplexPlanner;
use hovertone_signal::statistics::{mean, median};
use std::ops::RangeInclusive;

/// Times that the motion is found by the pattern, and the pattern along the motion. *Numeric.*
const ROUNDS: usize = 4;
/// Over this time rates are taken.
const RATE_S: f64 = STEADY_FRAME_S;
/// Slower motion, in shares of the speed per second, smears the frames of the first search over less than two resolution cells; four rotors
/// that wander for themselves have half as much in common by chance. *Decision.*
const RATE_MIN_PER_S: f64 = 0.015;
/// The pattern along the motion has at least so much more power than without: in loud noise a motion is found by chance, with 1.07 times;
/// in flights that bob it has 1.13 times or more. *Decision.*
const SHARPER_MIN: f64 = 1.1;

/// How closely the motion is looked at.
struct Look {
    /// A line at f has frames of `√(this / f)`.
    frame_hz_s2: f64,
    /// Of the frames of tracks, every so many'th.
    frames_apart: usize,
    /// How much the shared speed changes from one of these frames to the next, as a share.
    step_std_share: f64,
    /// How far it is looked for from where it is known to be, as a share.
    reach_share: f64,
}

/// A speed that changes by 3 % in a second smears a line over one resolution cell. Small drones in flight, and the demo's, change by 5 to 7 % in a
/// second (rms), and by a few per cent in all. *Decision.*
const FIRST_LOOK: Look = Look { frame_hz_s2: 30.0, frames_apart: 2, step_std_share: 0.007, reach_share: 0.06 };
/// Along what the first has found, which leaves less to smear. *Decision.*
const SECOND_LOOK: Look = Look { frame_hz_s2: 100.0, frames_apart: 1, step_std_share: 0.002, reach_share: 0.015 };

/// The path of a rotor in the middle of `limits_rev_s` that only moves with all others, where these move fast; else `None`.
///
/// What speaks for a rotor at each speed is a pattern that moves as a whole. Whichever rotors make it, it is found along the motion, and
/// the motion by it, in turns.
pub(super) fn common_motion(
    chunk: &Chunk<'_>,
    atoms: &[ChannelAtoms],
    limits_rev_s: &RangeInclusive<f64>,
    count: usize,
    planner: &mut ComplexPlanner,
) -> Option<SpeedPath> {
    let middle_rev_s = (limits_rev_s.start() + limits_rev_s.end()) / 2.0;
    let mut look_along = |path: &SpeedPath, look: &Look| {
        let frame_s = Pace::Steady.frame_s_of_order(look.frame_hz_s2, middle_rev_s);
        let spectra = Spectra::along(chunk, &chunk.series, path, frame_s, look.frames_apart, planner);
        let grid = OffsetGrid::new(offsets_within(limits_rev_s, &spectra.common_rev_s), &spectra);
        let line_weights = line_weights(&spectra, &grid, count);
        let mut scores = GridScores::new(
            &spectra,
            atoms,
            &grid,
            Trust { line_weights: &line_weights, residue_share: 0.0, echo_share: 0.0 },
        );
        let rows: Vec<Vec<f32>> =
            (0..spectra.frames()).map(|frame| above_median(&scores.of_frame(frame, &[]))).collect();
        let points_of = |share: f64| share * middle_rev_s / grid.step_rev_s;
        let reach = (points_of(look.reach_share).round() as usize).min(grid.points() / 2);
        let shifts = common_shifts(&rows, reach, points_of(look.step_std_share));
        let sharper = power(&pattern_along(&rows, &shifts)) / power(&pattern_along(&rows, &vec![0.0; rows.len()]));
        let offsets: Vec<f64> = shifts.into_iter().map(|shift| shift * grid.step_rev_s).collect();
        let rate_rev_s2 = rms_rate(&offsets, (look.frames_apart * FRAME_TICKS) as f64 * chunk.tick_s);
        spectra.path_at(&offsets, chunk).map(|path| (path, rate_rev_s2 / middle_rev_s, sharper))
    };
    let (path, rate_share_per_s, sharper) = look_along(&path_through([middle_rev_s], chunk)?, &FIRST_LOOK)?;
    if rate_share_per_s < RATE_MIN_PER_S || sharper < SHARPER_MIN {
        return None;
    }
    look_along(&path, &SECOND_LOOK).map(|(path, ..)| path)
}

/// The rms rate at which values that are `step_s` apart change, in their unit per second.
fn rms_rate(values: &[f64], step_s: f64) -> f64 {
    let steps = (RATE_S / step_s).round().max(1.0) as usize;
    let later = values.get(steps..).unwrap_or_default();
    let length_s = steps as f64 * step_s;
    let squares: Vec<f64> =
        values.iter().zip(later).map(|(before, after)| ((after - before) / length_s).powi(2)).collect();
    mean(&squares).unwrap_or_default().sqrt()
}

/// What of a frame's scores rises over their middle.
fn above_median(scores: &[f64]) -> Vec<f32> {
    let middle = median(scores).unwrap_or_default();
    scores.iter().map(|score| (score - middle).max(0.0) as f32).collect()
}

/// By how many points the pattern that all rows have in common is shifted in each of them; 0 on average.
fn common_shifts(rows: &[Vec<f32>], reach: usize, step_std: f64) -> Vec<f64> {
    let noise = variance(rows).max(f64::MIN_POSITIVE);
    let centroids: Vec<f64> = rows.iter().map(|row| centroid(row)).collect();
    let mut shifts = about_their_mean(centroids);
    for _ in 0..ROUNDS {
        let pattern = pattern_along(rows, &shifts);
        let scores: Vec<Vec<f64>> = rows
            .iter()
            .map(|row| correlation(&pattern, row, reach).into_iter().map(|sum| f64::from(sum) / noise).collect())
            .collect();
        let path = best_path(&scores, step_std);
        shifts = about_their_mean(path.into_iter().map(|place| place as f64).collect());
    }
    shifts
}

fn about_their_mean(values: Vec<f64>) -> Vec<f64> {
    let middle = mean(&values).unwrap_or_default();
    values.into_iter().map(|value| value - middle).collect()
}

fn variance(rows: &[Vec<f32>]) -> f64 {
    let (mut count, mut sum, mut squares) = (0.0, 0.0, 0.0);
    for &value in rows.iter().flatten() {
        count += 1.0;
        sum += f64::from(value);
        squares += f64::from(value).powi(2);
    }
    let mean = sum / f64::max(count, 1.0);
    squares / f64::max(count, 1.0) - mean * mean
}

/// Where the squares of values have their middle.
fn centroid(row: &[f32]) -> f64 {
    let (mut sum, mut moment) = (0.0, 0.0);
    for (point, &value) in row.iter().enumerate() {
        let square = f64::from(value).powi(2);
        sum += square;
        moment += point as f64 * square;
    }
    if sum > 0.0 { moment / sum } else { row.len() as f64 / 2.0 }
}

/// The mean of rows that are shifted back, less its own mean.
fn pattern_along(rows: &[Vec<f32>], shifts: &[f64]) -> Vec<f32> {
    let points = rows.first().map_or(0, Vec::len);
    let mut pattern = vec![0.0f32; points];
    for (row, shift) in rows.iter().zip(shifts) {
        let shift = shift.round() as isize;
        for (point, pattern) in pattern.iter_mut().enumerate() {
            *pattern += point.checked_add_signed(shift).and_then(|from| row.get(from)).copied().unwrap_or_default();
        }
    }
    let mean = pattern.iter().sum::<f32>() / points.max(1) as f32;
    pattern.iter_mut().for_each(|value| *value = (*value - mean) / rows.len() as f32);
    pattern
}

fn power(pattern: &[f32]) -> f64 {
    pattern.iter().map(|&value| f64::from(value).powi(2)).sum()
}

/// Σ pattern(n) row(n + s) for each shift s of up to `reach` down and up.
fn correlation(pattern: &[f32], row: &[f32], reach: usize) -> Vec<f32> {
    let mut padded = vec![0.0; row.len() + 2 * reach];
    padded[reach..reach + row.len()].copy_from_slice(row);
    let mut sums = vec![0.0f32; 2 * reach + 1];
    for (value, near) in pattern.iter().zip(padded.windows(2 * reach + 1)) {
        for (sum, near) in sums.iter_mut().zip(near) {
            *sum += value * near;
        }
    }
    sums
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    /// Rows of noise and four peaks, now weak and now strong, that move together.
    fn rows_along(motion: impl Fn(usize) -> f64) -> Vec<Vec<f32>> {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(6);
        (0..120)
            .map(|frame| {
                let peaks =
                    [120.0, 131.0, 140.0, 152.0].map(|place| (place + motion(frame), rng.random_range(4.0..30.0)));
                (0..300)
                    .map(|point| {
                        let peak =
                            |(place, level): &(f64, f64)| level * (-(f64::from(point) - place).powi(2) / 4.0).exp();
                        (peaks.iter().map(peak).sum::<f64>() + rng.random_range(0.0..4.0)) as f32
                    })
                    .collect()
            })
            .collect()
    }

    #[test]
    fn shifts_are_those_of_the_pattern_whichever_peak_is_strong() {
        // the peaks move by more than they are apart from each other
        let motion = |frame: usize| 14.0 * (frame as f64 / 3.0).sin();
        let mean = (0..120).map(motion).sum::<f64>() / 120.0;
        let shifts = common_shifts(&rows_along(motion), 40, 7.0);
        for (frame, shift) in shifts.iter().enumerate() {
            assert!((shift - (motion(frame) - mean)).abs() < 1.5, "{frame}: {shift}");
        }
        assert!(common_shifts(&rows_along(|_| 0.0), 40, 7.0).iter().all(|shift| shift.abs() < 1.5));
        assert!(common_shifts(&[], 40, 7.0).is_empty());
    }

    #[test]
    fn a_rate_is_that_of_the_motion() {
        let values: Vec<f64> = (0..50).map(|frame| 0.002 * f64::from(frame)).collect();
        assert!((rms_rate(&values, 0.08) - 0.025).abs() < 1e-12);
        assert_eq!(rms_rate(&values[..5], 0.08), 0.0);
    }
}
