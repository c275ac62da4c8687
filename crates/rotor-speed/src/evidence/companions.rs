//! Other rotors of the same vehicle, beside one or several that are heard.

use super::excess::{Excess, Looks};
use super::own_lines::{OwnPropeller, is_apart, loudness_db, own_lines_nats};
use super::path::best_path;
use super::rotor_lines::RotorLines;
use super::second_look::path_in_long_frames;
use super::votes::{HARMONICS, VoteTable};
use hovertone_signal::statistics::{mean, median};
use std::ops::Range;

/// Largest distance of a rotor of the same vehicle, as a logarithm of the speed. *Decision.*
const DISTANCE_MAX: f64 = 0.15;
/// Smallest distance of a rotor that stands apart, as a logarithm of the speed: the speed of one rotor is not known better in a frame.
/// *Decision.*
const DISTANCE_MIN: f64 = 0.01;
/// Step of the logarithm of the speed: half the width of a line of a long frame at its twentieth harmonic. *Numeric.*
const STEP: f64 = 1e-3;

/// The evidence in nats for another rotor of the vehicle beside one. `None` where there is none.
///
/// - `speeds_rev_s`: speed of the heard rotor in each short frame.
///
/// One propeller had up to 13 nats, several rotors 15 to 50 (`docs/measurements.md`). Rotors less than 1 % apart are not told.
pub(super) fn companion_nats(looks: &Looks, speeds_rev_s: &[f64], propeller: &OwnPropeller<'_>) -> Option<f64> {
    let table = VoteTable::of(&RotorLines::of_blades(propeller.blades));
    let heard_rev_s = path_in_long_frames(looks, speeds_rev_s, &table)?;
    nats_beside(&looks.long, &[heard_rev_s], propeller)
}

/// The evidence in nats for another rotor beside all that are heard: that of the path with the most votes from blade passes which stand apart
/// from all lines of the heard rotors. Between two of them, and beyond the outermost ones, each has a path. `None` where there is none.
///
/// - `heard_rev_s`: speed of each heard rotor in each long frame.
pub(crate) fn nats_beside(long: &Excess, heard_rev_s: &[Vec<f64>], propeller: &OwnPropeller<'_>) -> Option<f64> {
    let table = VoteTable::of(&RotorLines::of_blades(propeller.blades));
    let speeds_in = |frame: usize| -> Vec<f64> { heard_rev_s.iter().map(|speeds| speeds[frame]).collect() };
    let middles_rev_s: Vec<f64> = (0..long.frames.len()).map(|frame| mean(&speeds_in(frame))).collect::<Option<_>>()?;
    let steps = (DISTANCE_MAX / STEP) as i32;
    let ratios: Vec<f64> = (-steps..=steps).map(|step| (STEP * f64::from(step)).exp()).collect();
    let vote_in = |frame: usize, speed_rev_s: f64, others_rev_s: &[f64]| -> f32 {
        let vote = |harmonic: u32| {
            let order = harmonic * propeller.blades;
            let hz = f64::from(order) * speed_rev_s;
            let is_own = || others_rev_s.iter().all(|&other_rev_s| is_apart(long, hz, other_rev_s));
            let level = long.frames[frame].level_near(hz, long.bin_hz).filter(|_| is_own());
            level.map_or(0.0, |level| table.vote(order, level))
        };
        (1..=HARMONICS).map(vote).sum()
    };
    let votes_in = |(frame, middle_rev_s): (usize, &f64)| -> Vec<f32> {
        let others_rev_s = speeds_in(frame);
        ratios.iter().map(|ratio| vote_in(frame, ratio * middle_rev_s, &others_rev_s)).collect()
    };
    let votes: Vec<Vec<f32>> = middles_rev_s.iter().enumerate().map(votes_in).collect();
    let others: Vec<&[f64]> = heard_rev_s.iter().map(Vec::as_slice).collect();
    let loudest_db =
        others.iter().filter_map(|speeds| loudness_db(long, speeds, propeller.blades)).max_by(f64::total_cmp)?;
    let found = gaps_between(heard_rev_s, &middles_rev_s, ratios.len()).into_iter().map(|gap| {
        let path = best_path(&votes, gap, &long.hops(), STEP);
        let speeds_rev_s: Vec<f64> =
            path.iter().zip(&middles_rev_s).map(|(&point, middle_rev_s)| ratios[point] * middle_rev_s).collect();
        own_lines_nats(long, &speeds_rev_s, &others, loudest_db, propeller)
    });
    found.flatten().max_by(f64::total_cmp)
}

/// The ranges of a grid of `len` ratios to the middle speeds in which no heard rotor turns.
fn gaps_between(heard_rev_s: &[Vec<f64>], middles_rev_s: &[f64], len: usize) -> Vec<Range<usize>> {
    let beside = (DISTANCE_MIN / STEP) as isize;
    let place = |speeds_rev_s: &Vec<f64>| {
        let ratios: Vec<f64> = speeds_rev_s.iter().zip(middles_rev_s).map(|(speed, middle)| speed / middle).collect();
        let steps = (median(&ratios)?.ln() / STEP).round() as isize;
        Some((len / 2).saturating_add_signed(steps))
    };
    let mut places: Vec<usize> = heard_rev_s.iter().filter_map(place).collect();
    places.sort_unstable();
    let starts = std::iter::once(0).chain(places.iter().map(|place| place.saturating_add_signed(beside + 1)));
    let ends = places.iter().map(|place| place.saturating_add_signed(-beside)).chain([len]);
    starts.zip(ends).map(|(start, end)| start..end.min(len)).filter(|gap| gap.start < gap.end).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::level_table::level_of;
    use hovertone_vehicle::LineLevels;

    /// Two seconds of noise to 9 kHz, with lines of 20 dB at twelve harmonics of the blade pass of each rotor.
    fn rotors(speeds_rev_s: &[f64], bin_hz: f64, hop_s: f64) -> Excess {
        let mut levels = vec![level_of(0.8); (9000.0 / bin_hz) as usize];
        for speed_rev_s in speeds_rev_s {
            for harmonic in 1..=12u32 {
                levels[(f64::from(2 * harmonic) * speed_rev_s / bin_hz).round() as usize] = level_of(100.0);
            }
        }
        let frames = (2.0 / hop_s) as u32;
        Excess::of_levels(bin_hz, hop_s, frames, &levels)
    }

    fn nats(speeds_rev_s: &[f64]) -> f64 {
        let looks = Looks { short: rotors(speeds_rev_s, 2.5, 0.05), long: rotors(speeds_rev_s, 0.625, 0.1) };
        let heard = vec![speeds_rev_s[0]; looks.short.frames.len()];
        let propeller = OwnPropeller { blades: 2, prior: &LineLevels::default() };
        companion_nats(&looks, &heard, &propeller).expect("frames")
    }

    #[test]
    fn a_rotor_beside_several_has_lines_of_its_own() {
        let nats = |sounding: &[f64], heard: &[f64]| {
            let long = rotors(sounding, 0.625, 0.1);
            let heard: Vec<Vec<f64>> = heard.iter().map(|&speed_rev_s| vec![speed_rev_s; long.frames.len()]).collect();
            let propeller = OwnPropeller { blades: 2, prior: &LineLevels::default() };
            nats_beside(&long, &heard, &propeller)
        };
        let four = [86.0, 88.0, 90.5, 93.0];
        let five = [86.0, 88.0, 90.5, 93.0, 96.0];
        let between = [86.0, 88.0, 89.2, 90.5, 93.0];
        assert!(nats(&five, &four).is_some_and(|nats| nats > 18.4), "{:?}", nats(&five, &four));
        assert!(nats(&between, &four).is_some_and(|nats| nats > 0.0), "{:?}", nats(&between, &four));
        assert!(nats(&four, &four).is_none_or(|nats| nats < 0.0), "{:?}", nats(&four, &four));
    }

    #[test]
    fn another_rotor_has_lines_of_its_own() {
        assert!(nats(&[90.0, 93.0]) > 20.0, "{}", nats(&[90.0, 93.0]));
        assert!(nats(&[90.0]) < 0.0, "{}", nats(&[90.0]));
        // closer than a path tells
        assert!(nats(&[90.0, 90.2]) < 18.0, "{}", nats(&[90.0, 90.2]));
    }
}
