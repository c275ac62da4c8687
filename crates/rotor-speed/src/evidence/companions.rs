//! Other rotors of the same vehicle, beside one or several that are heard.

use super::excess::{Excess, Looks};
use super::own_lines::{OwnPropeller, is_apart, loudness_db, own_lines_nats};
use super::path::best_path;
use super::rotor_lines::RotorLines;
use super::second_look::path_in_long_frames;
use super::settings::EvidenceConfig;
use super::votes::{HARMONICS, VoteTable};
use hovertone_signal::statistics::{mean, median};
use std::ops::Range;

/// Largest distance of a rotor of the same vehicle, as a logarithm of the speed. *Decision.*
const DISTANCE_MAX: f64 = 0.15;
/// Smallest distance of a rotor that stands apart, as a logarithm of the speed: the speed of one rotor is not known better in a frame.
/// *Decision.*
const DISTANCE_MIN: f64 = 0.01;
/// Largest distance of a rotor from the middle of all, as a logarithm of the speed: those of real quadrotors differ by up to 22 % from slowest to
/// fastest. *Physics.*
const HALF_RANGE_MAX: f64 = 0.11;
/// Step of the logarithm of the speed: half the width of a line of a long frame at its twentieth harmonic. *Numeric.*
const STEP: f64 = 1e-3;

/// What is heard of other rotors of the vehicle beside one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Companions {
    /// The one whose lines stand out most; `None` where no line would stand apart.
    found: Option<Companion>,
    /// Smallest distance, as a logarithm of the speed, from which on another rotor as loud as the heard one would have more evidence.
    excluded_from: f64,
}

/// A path beside those of the rotors that are heard.
#[derive(Clone, Copy, Debug)]
struct Companion {
    /// Evidence in nats that a rotor turns there.
    nats: f64,
    /// Its mean distance from the middle of the heard rotors, as a logarithm of the speed.
    distance: f64,
}

impl Companions {
    /// Those beside a faint rotor: none would be heard.
    pub(super) const UNHEARD: Self = Self { found: None, excluded_from: HALF_RANGE_MAX };

    /// Those beside one rotor. `None` without frames.
    ///
    /// - `speeds_rev_s`: speed of the heard rotor in each short frame.
    ///
    /// One propeller had up to 13 nats, several rotors 15 to 50 (`docs/measurements.md`). Rotors less than 1 % apart are not told.
    pub(super) fn beside(
        looks: &Looks,
        speeds_rev_s: &[f64],
        propeller: &OwnPropeller<'_>,
        config: &EvidenceConfig,
    ) -> Option<Self> {
        let table = VoteTable::of(&RotorLines::of_blades(propeller.blades));
        let heard_rev_s = path_in_long_frames(looks, speeds_rev_s, &table)?;
        let found = companion(&looks.long, std::slice::from_ref(&heard_rev_s), propeller);
        let nats_min = found.map_or(0.0, |found| found.nats.max(0.0)) + config.levels_nats_min;
        Some(Self { found, excluded_from: excluded_from(&looks.long, &heard_rev_s, propeller, nats_min) })
    }

    /// Whether another rotor is heard.
    pub(crate) fn are_heard(&self, config: &EvidenceConfig) -> bool {
        self.found.is_some_and(|found| found.nats >= config.companion_nats_min)
    }

    /// Standard deviation of the speeds of all rotors about that of the heard one, as a share.
    ///
    /// All rotors lie within a distance of the heard one, evenly: `d / √3`. It is the distance from which on no other rotor turns, or that of a
    /// found one, where this is larger: with the probability `1 / (1 + e^(n₀ − n))` for `n` nats. Where the number of rotors is known, others turn
    /// somewhere, and `n₀` is 0. Else it is the logarithm of the number of places where a path may lie by chance.
    pub(crate) fn spread_share(&self, is_count_known: bool) -> f64 {
        let even_nats = if is_count_known { 0.0 } else { (2.0 * DISTANCE_MAX / STEP).ln() };
        let within = self.excluded_from;
        let square = self.found.map_or(within.powi(2), |Companion { nats, distance }| {
            let probability = 1.0 / (1.0 + (even_nats - nats).exp());
            probability * distance.max(within).powi(2) + (1.0 - probability) * within.powi(2)
        });
        (square / 3.0).sqrt()
    }
}

/// The smallest distance, as a logarithm of the speed, from which on another rotor beside one would have this evidence, were it as loud: the
/// lines of the heard one that stand apart there have it.
fn excluded_from(long: &Excess, heard_rev_s: &[f64], propeller: &OwnPropeller<'_>, nats_min: f64) -> f64 {
    let Some(loudest_db) = loudness_db(long, heard_rev_s, propeller.blades) else { return HALF_RANGE_MAX };
    let is_heard = |distance: f64| {
        let beside_rev_s: Vec<f64> = heard_rev_s.iter().map(|speed_rev_s| speed_rev_s * distance.exp()).collect();
        let nats = own_lines_nats(long, heard_rev_s, &[&beside_rev_s], loudest_db, propeller);
        nats.is_some_and(|nats| nats >= nats_min)
    };
    let steps = (DISTANCE_MIN / STEP) as u32..(HALF_RANGE_MAX / STEP) as u32;
    steps.map(|step| STEP * f64::from(step)).find(|&distance| is_heard(distance)).unwrap_or(HALF_RANGE_MAX)
}

/// The evidence in nats for another rotor beside all that are heard: that of the path with the most votes from blade passes which stand apart
/// from all lines of the heard rotors. Between two of them, and beyond the outermost ones, each has a path. `None` where there is none.
///
/// - `heard_rev_s`: speed of each heard rotor in each long frame.
pub(crate) fn nats_beside(long: &Excess, heard_rev_s: &[Vec<f64>], propeller: &OwnPropeller<'_>) -> Option<f64> {
    companion(long, heard_rev_s, propeller).map(|found| found.nats)
}

/// The path beside all heard rotors whose lines stand out most.
fn companion(long: &Excess, heard_rev_s: &[Vec<f64>], propeller: &OwnPropeller<'_>) -> Option<Companion> {
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
    let found = gaps_between(heard_rev_s, &middles_rev_s, ratios.len()).into_iter().filter_map(|gap| {
        let path = best_path(&votes, gap, &long.hops(), STEP);
        let speeds_rev_s: Vec<f64> =
            path.iter().zip(&middles_rev_s).map(|(&point, middle_rev_s)| ratios[point] * middle_rev_s).collect();
        let logs: Vec<f64> = path.iter().map(|&point| ratios[point].ln()).collect();
        let nats = own_lines_nats(long, &speeds_rev_s, &others, loudest_db, propeller)?;
        Some(Companion { nats, distance: mean(&logs)?.abs() })
    });
    found.max_by(|a, b| a.nats.total_cmp(&b.nats))
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
        rotors_with(12, speeds_rev_s, bin_hz, hop_s)
    }

    fn rotors_with(harmonics: u32, speeds_rev_s: &[f64], bin_hz: f64, hop_s: f64) -> Excess {
        let mut levels = vec![level_of(0.8); (9000.0 / bin_hz) as usize];
        for speed_rev_s in speeds_rev_s {
            for harmonic in 1..=harmonics {
                levels[(f64::from(2 * harmonic) * speed_rev_s / bin_hz).round() as usize] = level_of(100.0);
            }
        }
        let frames = (2.0 / hop_s) as u32;
        Excess::of_levels(bin_hz, hop_s, frames, &levels)
    }

    fn companions(harmonics: u32, speeds_rev_s: &[f64]) -> Companions {
        let sound = |bin_hz: f64, hop_s: f64| rotors_with(harmonics, speeds_rev_s, bin_hz, hop_s);
        let looks = Looks { short: sound(2.5, 0.05), long: sound(0.625, 0.1) };
        let heard = vec![speeds_rev_s[0]; looks.short.frames.len()];
        let propeller = OwnPropeller { blades: 2, prior: &LineLevels::default() };
        Companions::beside(&looks, &heard, &propeller, &EvidenceConfig::default()).expect("frames")
    }

    fn nats(speeds_rev_s: &[f64]) -> f64 {
        companions(12, speeds_rev_s).found.expect("lines").nats
    }

    #[test]
    fn only_rotors_that_would_be_heard_are_excluded() {
        let spread_share =
            |harmonics: u32, speeds_rev_s: &[f64]| companions(harmonics, speeds_rev_s).spread_share(false);
        assert!(spread_share(12, &[90.0]) < 0.01, "{}", spread_share(12, &[90.0]));
        // one harmonic tells little
        assert!(spread_share(1, &[90.0]) > 0.06, "{}", spread_share(1, &[90.0]));
        // 6.5 % apart, over √3
        let apart = spread_share(12, &[90.0, 96.0]);
        assert!((apart - 0.0373).abs() < 0.002, "{apart}");
        assert!((Companions::UNHEARD.spread_share(true) - 0.0635).abs() < 1e-3);
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
