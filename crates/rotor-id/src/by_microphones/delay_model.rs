//! Delays of the rotors' lines between microphones, as phases, against the distances.

use super::array::{MicrophoneArray, direction, distance_m};
use super::paired_lines::PhaseDifference;
use super::settings::MicrophonesConfig;
use super::von_mises::ln_peak_over_uniform;
use hovertone_signal::statistics::log_sum_exp;
use std::f64::consts::{PI, TAU};

/// Limit of the integral over the path error, in standard deviations. *Numeric.*
const REACH_STD: f64 = 3.0;
/// Step of the integral over the path error, in rad of phase of the highest line. *Numeric.*
const STEP_RAD: f64 = 0.4;
/// Standard deviation of the path from a rotor to a microphone, in m: a rotor sounds from somewhere on its disc, not from its hub.
/// *Decision.*
const SOURCE_STD_M: f64 = 0.01;

/// Logarithms of the likelihood ratios of the phases, by pairs of tracks.
pub(super) struct DelayModel {
    pairs: Vec<TrackPair>,
}

/// Two tracks, and the likelihood ratio of their phases for all places.
struct TrackPair {
    tracks: [usize; 2],
    /// `ln_ratios[rotor of the first][rotor of the second]`: phases of rotors at these places, over phases of rotors at unknown places with
    /// similar distances.
    ln_ratios: Vec<Vec<f64>>,
}

/// A double phase difference, and how it depends on the paths.
struct Phase {
    phase_rad: f64,
    /// Phase per path, of each rotor's line.
    rad_per_m: [f64; 2],
    mean_rad_per_m: f64,
    /// The von Mises distribution for each scatter of [`MicrophonesConfig::phase_std_rad`].
    scatters: [VonMises; 3],
}

#[derive(Clone, Copy)]
struct VonMises {
    kappa: f64,
    ln_peak_over_uniform: f64,
}

/// How much longer the paths of two rotors to one microphone are than to another.
#[derive(Clone, Copy)]
struct PathDifferences {
    /// Of each rotor.
    further_m: [f64; 2],
    /// Standard deviation of the difference between the two rotors.
    std_m: f64,
}

/// A step of the integral over the path error.
struct PathStep {
    off_m: f64,
    ln_weight: f64,
}

impl DelayModel {
    pub(super) fn new(
        phases: &[PhaseDifference],
        tracks: usize,
        array: &MicrophoneArray,
        config: &MicrophonesConfig,
    ) -> Self {
        let microphones = array.microphones_m.len();
        let rotors = array.rotors.len();
        // only m − 1 of the m (m − 1) / 2 pairs of m microphones are independent: weight 2 / m; the same with pairs of tracks
        let weight = 2.0 / microphones as f64 * 2.0 / tracks as f64;
        let mut track_pairs: Vec<TrackPair> =
            pairs(tracks).map(|tracks| TrackPair { tracks, ln_ratios: vec![vec![0.0; rotors]; rotors] }).collect();
        for between in pairs(microphones) {
            let all: Vec<Vec<PathDifferences>> = (0..rotors)
                .map(|a| (0..rotors).map(|b| PathDifferences::of([a, b], between, array, config)).collect())
                .collect();
            // one limit for all places, so that all assignments are compared by the same lines
            let std_m = all.iter().flatten().map(|paths| paths.std_m).fold(0.0, f64::max);
            let unknown = PathDifferences::of_unknown_places(&all, std_m);
            for pair in &mut track_pairs {
                let own =
                    phases.iter().filter(|phase| phase.rotors.rotors == pair.tracks && phase.microphones == between);
                let own: Vec<Phase> = own.filter_map(|phase| Phase::usable(phase, std_m, config)).collect();
                let ln_unknown = ln_likelihood_ratio(&own, unknown, config);
                for (a, b) in (0..rotors).flat_map(|a| (0..rotors).map(move |b| (a, b))).filter(|(a, b)| a != b) {
                    pair.ln_ratios[a][b] += weight * (ln_likelihood_ratio(&own, all[a][b], config) - ln_unknown);
                }
            }
        }
        Self { pairs: track_pairs }
    }

    /// Logarithm of the likelihood ratio of an assignment to rotors at unknown places.
    pub(super) fn ln_likelihood_ratio(&self, assignment: &[usize]) -> f64 {
        self.pairs.iter().map(|pair| pair.ln_ratios[assignment[pair.tracks[0]]][assignment[pair.tracks[1]]]).sum()
    }
}

/// All pairs of different indices below `count`.
fn pairs(count: usize) -> impl Iterator<Item = [usize; 2]> {
    (0..count).flat_map(move |a| (a + 1..count).map(move |b| [a, b]))
}

impl PathDifferences {
    /// The path differences of two rotors between two microphones. An error of a microphone's position changes the paths of both rotors
    /// alike, except for the angle between them, seen from the microphone.
    fn of(rotors: [usize; 2], microphones: [usize; 2], array: &MicrophoneArray, config: &MicrophonesConfig) -> Self {
        let rotor_m = |rotor: usize| array.rotors[rotor].position_m;
        let microphone_m = |microphone: usize| array.microphones_m[microphone];
        let further_m = |rotor: usize| {
            let to = |microphone: usize| distance_m(rotor_m(rotor), microphone_m(microphone));
            to(microphones[0]) - to(microphones[1])
        };
        let squared_angle = |microphone: usize| {
            let towards = |rotor: usize| direction(rotor_m(rotor), microphone_m(microphone));
            distance_m(towards(rotors[0]), towards(rotors[1])).powi(2)
        };
        let from_positions_m2 =
            config.position_std_m.powi(2) * (squared_angle(microphones[0]) + squared_angle(microphones[1]));
        let std_m = (from_positions_m2 + 4.0 * SOURCE_STD_M.powi(2)).sqrt();
        Self { further_m: rotors.map(further_m), std_m }
    }

    /// The path differences of two rotors whose places are unknown: as large as between the rotors of the array.
    fn of_unknown_places(all: &[Vec<Self>], std_m: f64) -> Self {
        let differences = all.iter().flatten().map(|paths| (paths.further_m[0] - paths.further_m[1]).powi(2));
        let count = (all.len() * all.len().saturating_sub(1)).max(1) as f64;
        Self { further_m: [0.0; 2], std_m: (differences.sum::<f64>() / count + std_m * std_m).sqrt() }
    }
}

impl Phase {
    /// `None` if the path error exceeds half a wavelength: the phase would fit all places.
    fn usable(difference: &PhaseDifference, path_std_m: f64, config: &MicrophonesConfig) -> Option<Self> {
        let rad_per_m = difference.rotors.hz.map(|hz| TAU * hz / config.sound_m_s());
        let mean_rad_per_m = (rad_per_m[0] + rad_per_m[1]) / 2.0;
        // motion of the whole vehicle cancels up to the difference of the frequencies
        let common_rad = (rad_per_m[0] - rad_per_m[1]) * config.position_std_m;
        let scatters = config.phase_std_rad.map(|std_rad| {
            let kappa = 1.0 / (std_rad * std_rad + difference.variance_rad2 + 2.0 * common_rad * common_rad);
            VonMises { kappa, ln_peak_over_uniform: ln_peak_over_uniform(kappa) }
        });
        let is_usable = mean_rad_per_m * path_std_m < PI;
        is_usable.then_some(Self { phase_rad: difference.phase_rad, rad_per_m, mean_rad_per_m, scatters })
    }
}

/// Logarithm of the likelihood ratio of phases to uniform phases. It is averaged over the error of the paths, which is common to all lines,
/// and over the scatter. A single phase has the density `outliers + (1 − outliers) · von Mises`, relative to the uniform one.
fn ln_likelihood_ratio(phases: &[Phase], paths: PathDifferences, config: &MicrophonesConfig) -> f64 {
    let outliers = config.phase_outlier_share;
    let steps = path_steps(phases, paths.std_m);
    let ln_total = log_sum_exp(steps.iter().map(|step| step.ln_weight));
    let of_scatter = |scatter: usize| {
        let of_step = |step: &PathStep| -> f64 {
            let of_phase = |phase: &Phase| {
                // a longer path makes the phase smaller
                let path_rad = phase.rad_per_m[0] * paths.further_m[0] - phase.rad_per_m[1] * paths.further_m[1];
                let off_rad = phase.phase_rad + path_rad + phase.mean_rad_per_m * step.off_m;
                let VonMises { kappa, ln_peak_over_uniform } = phase.scatters[scatter];
                (outliers + (1.0 - outliers) * (ln_peak_over_uniform + kappa * (off_rad.cos() - 1.0)).exp()).ln()
            };
            step.ln_weight - ln_total + phases.iter().map(of_phase).sum::<f64>()
        };
        log_sum_exp(steps.iter().map(of_step))
    };
    let scatters = config.phase_std_rad.len();
    log_sum_exp((0..scatters).map(of_scatter)) - (scatters as f64).ln()
}

/// Steps of the integral over the normally distributed path error, fine enough for the highest line.
fn path_steps(phases: &[Phase], std_m: f64) -> Vec<PathStep> {
    let highest_rad_per_m = phases.iter().map(|phase| phase.mean_rad_per_m).fold(0.0, f64::max);
    let half = (REACH_STD * std_m * highest_rad_per_m / STEP_RAD).ceil().max(1.0) as i32;
    (-half..=half)
        .map(|step| REACH_STD * f64::from(step) / f64::from(half))
        .map(|z| PathStep { off_m: z * std_m, ln_weight: -z * z / 2.0 })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::super::paired_lines::RotorPair;
    use super::*;

    #[test]
    fn phases_of_known_paths_favour_these_paths() {
        let config = MicrophonesConfig::default();
        let difference = |line: i32| {
            let hz = [120.0 * f64::from(line), 121.0 * f64::from(line)];
            let phase_rad = -TAU * (hz[0] * 0.3 - hz[1] * 0.1) / config.sound_m_s();
            let rotors = RotorPair { rotors: [0, 1], hz };
            PhaseDifference { rotors, microphones: [0, 1], phase_rad, variance_rad2: 0.0 }
        };
        let phases: Vec<Phase> = (1..=10).filter_map(|line| Phase::usable(&difference(line), 0.05, &config)).collect();
        let at = |first_m: f64, second_m: f64| {
            ln_likelihood_ratio(&phases, PathDifferences { further_m: [first_m, second_m], std_m: 0.05 }, &config)
        };
        let found = [at(0.3, 0.1), at(0.2, 0.1), at(0.1, 0.3)];
        assert!(phases.len() == 10 && found[0] > 8.0, "{found:?}");
        assert!(found[0] > found[1] + 0.5 && found[0] > found[2] + 10.0, "{found:?}");
        // a common path of both rotors has little effect
        assert!((at(0.4, 0.2) - found[0]).abs() < 0.3);
        // beyond half a wavelength no phase is usable
        assert!(Phase::usable(&difference(30), 0.05, &config).is_none());
        assert_eq!(ln_likelihood_ratio(&[], PathDifferences { further_m: [0.3, 0.1], std_m: 0.05 }, &config), 0.0);
    }
}
