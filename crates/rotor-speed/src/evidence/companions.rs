//! Other rotors of the same vehicle, beside one that is heard.

use super::excess::{Excess, Looks};
use super::own_lines::{OwnPropeller, is_apart, loudness_db, own_lines_nats};
use super::path::best_path;
use super::rotor_lines::RotorLines;
use super::second_look::{STEP, path_in_long_frames};
use super::settings::EvidenceConfig;
use super::votes::{HARMONICS, VoteTable};
use hovertone_signal::statistics::mean;
use hovertone_vehicle::ROTOR_STD_SHARE;
use std::f64::consts::SQRT_2;

/// Largest distance of a rotor of the same vehicle, as a logarithm of the speed: those of real quadrotors differ by up to 22 % from slowest to
/// fastest. *Physics.*
pub(super) const DISTANCE_MAX: f64 = 0.22;
/// Standard deviation of that distance: of two rotors that are independent. *Physics.*
const DISTANCE_STD: f64 = SQRT_2 * ROTOR_STD_SHARE;
/// Smallest distance of another rotor that is looked for, as a logarithm of the speed: the speed of one rotor is not known better in a frame.
/// *Decision.*
pub(crate) const COMPANION_DISTANCE_MIN: f64 = 0.01;
/// Largest distance of a rotor from the middle of all, as a logarithm of the speed. *Physics.*
pub(super) const HALF_RANGE_MAX: f64 = DISTANCE_MAX / 2.0;

/// What is heard of other rotors of the vehicle beside one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Companions {
    /// The one whose lines stand out most; `None` where no line would stand apart.
    found: Option<Companion>,
    /// Smallest distance, as a logarithm of the speed, from which on another rotor as loud as the heard one would have more evidence.
    excluded_from: f64,
}

/// A path beside that of the rotor that is heard.
#[derive(Clone, Copy, Debug)]
struct Companion {
    /// Evidence in nats that a rotor turns there.
    nats: f64,
    /// Its mean distance from the heard rotor, as a logarithm of the speed.
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
        let found = companion(&looks.long, &heard_rev_s, propeller);
        let nats_min = found.map_or(0.0, |found| found.nats.max(0.0)) + config.levels_nats_min;
        Some(Self { found, excluded_from: excluded_from(&looks.long, &heard_rev_s, propeller, nats_min) })
    }

    /// Whether another rotor is heard.
    pub(crate) fn are_heard(&self, config: &EvidenceConfig) -> bool {
        self.found.is_some_and(|found| found.nats >= config.companion_nats_min)
    }

    /// Whether another rotor is more probable than not, where their number is not known.
    pub(crate) fn are_likely(&self) -> bool {
        self.found.is_some_and(|found| found.probability(false) >= 0.5)
    }

    /// Standard deviation of the speeds of all rotors about that of the heard one, as a share.
    ///
    /// All rotors lie within a distance of the heard one, evenly: `d / √3`. It is the distance from which on no other rotor turns, or that of a
    /// found one with its probability, where this is larger.
    pub(crate) fn spread_share(&self, is_count_known: bool) -> f64 {
        let within = self.excluded_from;
        let square = self.found.map_or(within.powi(2), |found| {
            let probability = found.probability(is_count_known);
            probability * found.distance.max(within).powi(2) + (1.0 - probability) * within.powi(2)
        });
        (square / 3.0).sqrt()
    }
}

impl Companion {
    /// The probability that a rotor turns there: `1 / (1 + e^(n₀ + d²/2σ² − n))` for `n` nats, where σ is the standard deviation of the distance
    /// of two rotors. Where the number of rotors is known, others turn somewhere, and `n₀` is 0. Else it is the logarithm of the number of places
    /// where a path may lie by chance.
    fn probability(&self, is_count_known: bool) -> f64 {
        let places_nats = if is_count_known { 0.0 } else { (2.0 * DISTANCE_MAX / STEP).ln() };
        let far_nats = (self.distance / DISTANCE_STD).powi(2) / 2.0;
        1.0 / (1.0 + (places_nats + far_nats - self.nats).exp())
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
    let steps = (COMPANION_DISTANCE_MIN / STEP) as u32..(HALF_RANGE_MAX / STEP) as u32;
    steps.map(|step| STEP * f64::from(step)).find(|&distance| is_heard(distance)).unwrap_or(HALF_RANGE_MAX)
}

/// The path beside the heard rotor whose lines stand out most: of those slower and those faster, the one with the most votes from blade passes
/// that stand apart from all lines of the heard rotor. `None` where there is none.
///
/// - `heard_rev_s`: speed of the heard rotor in each long frame.
fn companion(long: &Excess, heard_rev_s: &[f64], propeller: &OwnPropeller<'_>) -> Option<Companion> {
    let table = VoteTable::of(&RotorLines::of_blades(propeller.blades));
    let (far, near) = ((DISTANCE_MAX / STEP) as i32, (COMPANION_DISTANCE_MIN / STEP) as i32);
    let vote_in = |frame: usize, speed_rev_s: f64| -> f32 {
        let vote = |harmonic: u32| {
            let order = harmonic * propeller.blades;
            let hz = f64::from(order) * speed_rev_s;
            let is_own = || is_apart(long, hz, heard_rev_s[frame]);
            let level = long.frames[frame].level_near(hz, long.bin_hz).filter(|_| is_own());
            level.map_or(0.0, |level| table.vote(order, level))
        };
        (1..=HARMONICS).map(vote).sum()
    };
    let loudest_db = loudness_db(long, heard_rev_s, propeller.blades)?;
    let found = [-far..-near, near + 1..far + 1].into_iter().filter_map(|steps| {
        let logs: Vec<f64> = steps.map(|step| STEP * f64::from(step)).collect();
        let ratios: Vec<f64> = logs.iter().map(|log| log.exp()).collect();
        let votes_in = |(frame, heard_rev_s): (usize, &f64)| -> Vec<f32> {
            ratios.iter().map(|ratio| vote_in(frame, heard_rev_s * ratio)).collect()
        };
        let votes: Vec<Vec<f32>> = heard_rev_s.iter().enumerate().map(votes_in).collect();
        let path = best_path(&votes, 0..logs.len(), &long.hops(), STEP);
        let distances: Vec<f64> = path.iter().map(|&point| logs[point]).collect();
        let speeds = heard_rev_s.iter().zip(&path).map(|(heard_rev_s, &point)| heard_rev_s * ratios[point]);
        let nats = own_lines_nats(long, &speeds.collect::<Vec<f64>>(), &[heard_rev_s], loudest_db, propeller)?;
        Some(Companion { nats, distance: mean(&distances)?.abs() })
    });
    found.max_by(|a, b| a.nats.total_cmp(&b.nats))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::level_table::level_of;
    use hovertone_vehicle::LineLevels;

    /// Two seconds of noise to 9 kHz, with lines of 20 dB at some harmonics of the blade pass of each rotor.
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
        // 18 % apart, over √3: the heard one is the fastest
        let far = spread_share(12, &[90.0, 75.0]);
        assert!((far - 0.1053).abs() < 0.002, "{far}");
        assert!((Companions::UNHEARD.spread_share(true) - 0.0635).abs() < 1e-3);
    }

    #[test]
    fn another_rotor_has_lines_of_its_own() {
        assert!(nats(&[90.0, 93.0]) > 20.0, "{}", nats(&[90.0, 93.0]));
        assert!(nats(&[90.0]) < 0.0, "{}", nats(&[90.0]));
        // closer than a path tells
        assert!(nats(&[90.0, 90.2]) < 18.0, "{}", nats(&[90.0, 90.2]));
    }
}
