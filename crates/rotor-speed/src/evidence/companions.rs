//! Other rotors of the same vehicle, beside one that is heard.

use super::excess::Looks;
use super::own_lines::{OwnPropeller, is_apart, loudness_db, own_lines_nats};
use super::path::best_path;
use super::second_look::path_in_long_frames;
use super::votes::{HARMONICS, VoteTable};

/// Largest distance of a rotor of the same vehicle, as a logarithm of the speed. *Decision.*
const DISTANCE_MAX: f64 = 0.15;
/// Smallest distance of a rotor that stands apart, as a logarithm of the speed: the speed of one rotor is not known better in a frame.
/// *Decision.*
const DISTANCE_MIN: f64 = 0.01;
/// Step of the logarithm of the speed: half the width of a line of a long frame at its twentieth harmonic. *Numeric.*
const STEP: f64 = 1e-3;

/// The evidence in nats for another rotor of the vehicle: that of the path in long frames with the most votes from blade passes which stand
/// apart from all lines of the heard rotor. `None` where there is none.
///
/// - `speeds_rev_s`: speed of the heard rotor in each short frame.
///
/// One propeller had up to 13 nats, several rotors 15 to 50 (`docs/measurements.md`). Rotors less than 1 % apart are not told.
pub(super) fn companion_nats(looks: &Looks, speeds_rev_s: &[f64], propeller: &OwnPropeller<'_>) -> Option<f64> {
    let long = &looks.long;
    let table = VoteTable::for_blades(propeller.blades);
    let heard_rev_s = path_in_long_frames(looks, speeds_rev_s, &table)?;
    let steps = (DISTANCE_MAX / STEP) as i32;
    let ratios: Vec<f64> = (-steps..=steps).map(|step| (STEP * f64::from(step)).exp()).collect();
    let vote_in = |frame: usize, speed_rev_s: f64| -> f32 {
        let other_rev_s = heard_rev_s[frame];
        let vote = |harmonic: u32| {
            let order = harmonic * propeller.blades;
            let hz = f64::from(order) * speed_rev_s;
            let level = long.frames[frame].level_near(hz, long.bin_hz).filter(|_| is_apart(long, hz, other_rev_s));
            level.map_or(0.0, |level| table.vote(order, level))
        };
        (1..=HARMONICS).map(vote).sum()
    };
    let votes: Vec<Vec<f32>> = heard_rev_s
        .iter()
        .enumerate()
        .map(|(frame, heard_rev_s)| ratios.iter().map(|ratio| vote_in(frame, ratio * heard_rev_s)).collect())
        .collect();
    let loudest_db = loudness_db(long, &heard_rev_s, propeller.blades)?;
    let beside = (DISTANCE_MIN / STEP) as usize;
    let middle = ratios.len() / 2;
    let found = [0..middle - beside, middle + beside + 1..ratios.len()].map(|range| {
        let path = best_path(&votes, range, &long.hops(), STEP);
        let speeds_rev_s: Vec<f64> =
            path.iter().zip(&heard_rev_s).map(|(&point, heard_rev_s)| ratios[point] * heard_rev_s).collect();
        own_lines_nats(long, &speeds_rev_s, &[&heard_rev_s], loudest_db, propeller)
    });
    found.into_iter().flatten().max_by(f64::total_cmp)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::excess::Excess;
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
    fn another_rotor_has_lines_of_its_own() {
        assert!(nats(&[90.0, 93.0]) > 20.0, "{}", nats(&[90.0, 93.0]));
        assert!(nats(&[90.0]) < 0.0, "{}", nats(&[90.0]));
        // closer than a path tells
        assert!(nats(&[90.0, 90.2]) < 18.0, "{}", nats(&[90.0, 90.2]));
    }
}
