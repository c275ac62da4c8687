//! When the lines of each rotor arrive at one microphone after another, against those of the other rotors and where all stand.

use super::heard::PhaseDifference;
use super::{MicrophoneArray, direction, distance_m};
use crate::by_microphones::MicrophonesConfig;
use hovertone_signal::statistics::log_sum_exp;
use std::f64::consts::{PI, TAU};

/// What is not known of paths is integrated over out to so many standard deviations, in steps of so much of the highest line's phase.
const REACH_STD: f64 = 3.0;
const STEP_RAD: f64 = 0.4;
/// A rotor sounds from somewhere on its disc, and not from its hub: this far off in each path.
const SOURCE_STD_M: f64 = 0.01;

/// Logarithm of the likelihood ratio of the phases of two tracks at two places to those of rotors that stand anywhere about as far apart.
pub(super) struct Delays {
    pairs: Vec<TrackPair>,
}

/// Two tracks.
struct TrackPair {
    tracks: (usize, usize),
    /// `ratios[rotor of the first][rotor of the second]`.
    ratios: Vec<Vec<f64>>,
}

/// A phase difference, ready to be compared.
struct Phase {
    phase_rad: f64,
    /// Of each rotor, and of both on the average.
    rad_per_m: (f64, f64),
    mean_rad_per_m: f64,
    /// Inverse variance, and the logarithm of the density of that von Mises distribution at its peak over uniform, for each scatter.
    kappas: [(f64, f64); 3],
}

/// How much further two rotors are from one microphone than from another, and how well that is known against each other.
#[derive(Clone, Copy)]
struct Paths {
    further_m: (f64, f64),
    std_m: f64,
}

impl Delays {
    pub(super) fn new(
        phases: &[PhaseDifference],
        tracks: usize,
        array: &MicrophoneArray,
        config: &MicrophonesConfig,
    ) -> Self {
        let microphones = array.microphones_m.len();
        let rotors = array.rotors.len();
        let pairs = |count: usize| (0..count).flat_map(move |a| (a + 1..count).map(move |b| (a, b)));
        // all pairs of microphones, none of which is new where those with the first are known; so with rotors
        let weight = 2.0 / microphones as f64 * 2.0 / tracks as f64;
        let mut all_pairs: Vec<TrackPair> =
            pairs(tracks).map(|tracks| TrackPair { tracks, ratios: vec![vec![0.0; rotors]; rotors] }).collect();
        for between in pairs(microphones) {
            let all: Vec<Vec<Paths>> =
                (0..rotors).map(|a| (0..rotors).map(|b| Paths::of((a, b), between, array, config)).collect()).collect();
            // the same lines for all assignments
            let std_m = all.iter().flatten().map(|paths| paths.std_m).fold(0.0, f64::max);
            let anywhere = Paths::anywhere(&all, std_m);
            for pair in &mut all_pairs {
                let own = phases.iter().filter(|phase| phase.rotors == pair.tracks && phase.microphones == between);
                let own: Vec<Phase> = own.filter_map(|phase| Phase::of(phase, std_m, config)).collect();
                let log_anywhere = log_ratio(&own, anywhere, config);
                for (a, b) in (0..rotors).flat_map(|a| (0..rotors).map(move |b| (a, b))).filter(|(a, b)| a != b) {
                    pair.ratios[a][b] += weight * (log_ratio(&own, all[a][b], config) - log_anywhere);
                }
            }
        }
        Self { pairs: all_pairs }
    }

    pub(super) fn log_ratio(&self, assignment: &[usize]) -> f64 {
        self.pairs.iter().map(|TrackPair { tracks: (a, b), ratios }| ratios[assignment[*a]][assignment[*b]]).sum()
    }
}

impl Paths {
    fn of(
        rotors: (usize, usize),
        microphones: (usize, usize),
        array: &MicrophoneArray,
        config: &MicrophonesConfig,
    ) -> Self {
        let rotor_m = |rotor: usize| array.rotors[rotor].position_m;
        let microphone_m = |microphone: usize| array.microphones_m[microphone];
        let further_m = |rotor: usize| {
            let to = |microphone: usize| distance_m(rotor_m(rotor), microphone_m(microphone));
            to(microphones.0) - to(microphones.1)
        };
        // a microphone that stands elsewhere changes both rotors' paths, by as much as it lies in the same direction from both
        let turned2 = |microphone: usize| {
            let towards = |rotor: usize| direction(rotor_m(rotor), microphone_m(microphone));
            distance_m(towards(rotors.0), towards(rotors.1)).powi(2)
        };
        let from_positions_m2 = config.position_std_m.powi(2) * (turned2(microphones.0) + turned2(microphones.1));
        let std_m = (from_positions_m2 + 4.0 * SOURCE_STD_M.powi(2)).sqrt();
        Self { further_m: (further_m(rotors.0), further_m(rotors.1)), std_m }
    }
}

impl Paths {
    /// Those of two rotors of which it is only known how far apart such rotors are.
    fn anywhere(all: &[Vec<Self>], std_m: f64) -> Self {
        let differences = all.iter().flatten().map(|paths| (paths.further_m.0 - paths.further_m.1).powi(2));
        let count = (all.len() * all.len().saturating_sub(1)).max(1) as f64;
        Self { further_m: (0.0, 0.0), std_m: (differences.sum::<f64>() / count + std_m * std_m).sqrt() }
    }
}

impl Phase {
    /// Nothing where what is not known of the path makes more than half a wave: it would not tell one place from another.
    fn of(heard: &PhaseDifference, path_std_m: f64, config: &MicrophonesConfig) -> Option<Self> {
        let per_m = |hz: f64| TAU * hz / config.sound_m_s();
        let rad_per_m = (per_m(heard.hz.0), per_m(heard.hz.1));
        let mean_rad_per_m = (rad_per_m.0 + rad_per_m.1) / 2.0;
        // rotors of unlike speeds do not feel the same of what the whole vehicle does
        let common_rad = (rad_per_m.0 - rad_per_m.1) * config.position_std_m;
        let kappas = config.phase_std_rad.map(|std_rad| {
            let kappa = 1.0 / (std_rad * std_rad + heard.variance_rad2 + 2.0 * common_rad * common_rad);
            (kappa, kappa - log_bessel_i0(kappa))
        });
        let is_telling = mean_rad_per_m * path_std_m < PI;
        is_telling.then_some(Self { phase_rad: heard.phase_rad, rad_per_m, mean_rad_per_m, kappas })
    }
}

/// Logarithm of the likelihood ratio to phases that mean nothing, over what is not known of the paths, and over how much single lines
/// are off.
fn log_ratio(phases: &[Phase], paths: Paths, config: &MicrophonesConfig) -> f64 {
    let outliers = config.phase_outlier_share;
    let highest_rad_per_m = phases.iter().map(|phase| phase.mean_rad_per_m).fold(0.0, f64::max);
    let half = (REACH_STD * paths.std_m * highest_rad_per_m / STEP_RAD).ceil().max(1.0) as i32;
    let steps: Vec<(f64, f64)> = (-half..=half)
        .map(|step| REACH_STD * f64::from(step) / f64::from(half))
        .map(|z| (z * paths.std_m, -z * z / 2.0))
        .collect();
    let log_total = log_sum_exp(steps.iter().map(|step| step.1));
    let of_scatter = |scatter: usize| {
        let of_step = |&(off_m, log_weight): &(f64, f64)| -> f64 {
            let of_phase = |phase: &Phase| {
                // the later a line arrives, the less its phase
                let path_rad = phase.rad_per_m.0 * paths.further_m.0 - phase.rad_per_m.1 * paths.further_m.1;
                let off_rad = phase.phase_rad + path_rad + phase.mean_rad_per_m * off_m;
                let (kappa, at_peak) = phase.kappas[scatter];
                (outliers + (1.0 - outliers) * (at_peak + kappa * (off_rad.cos() - 1.0)).exp()).ln()
            };
            log_weight - log_total + phases.iter().map(of_phase).sum::<f64>()
        };
        log_sum_exp(steps.iter().map(of_step))
    };
    let scatters = config.phase_std_rad.len();
    log_sum_exp((0..scatters).map(of_scatter)) - (scatters as f64).ln()
}

/// ln I₀(κ) (Abramowitz and Stegun 9.8.1 and 9.8.2; off by less than 2e-7).
fn log_bessel_i0(kappa: f64) -> f64 {
    let polynomial = |x: f64, terms: &[f64]| terms.iter().rev().fold(0.0, |sum, term| sum * x + term);
    if kappa < 3.75 {
        let terms = [1.0, 3.515_622_9, 3.089_942_4, 1.206_749_2, 0.265_973_2, 0.036_076_8, 0.004_581_3];
        polynomial((kappa / 3.75).powi(2), &terms).ln()
    } else {
        let terms = [
            0.398_942_28,
            0.013_285_92,
            0.002_253_19,
            -0.001_575_65,
            0.009_162_81,
            -0.020_577_06,
            0.026_355_37,
            -0.016_476_33,
            0.003_923_77,
        ];
        polynomial(3.75 / kappa, &terms).ln() + kappa - kappa.ln() / 2.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_bessel_function_is_its_integral() {
        for kappa in [0.01, 0.7, 3.7, 3.8, 11.0, 400.0] {
            let count = 20_000;
            let sum: f64 =
                (0..count).map(|n| (kappa * ((PI * (f64::from(n) + 0.5) / f64::from(count)).cos() - 1.0)).exp()).sum();
            let integral = (sum / f64::from(count)).ln() + kappa;
            assert!((log_bessel_i0(kappa) - integral).abs() < 1e-6, "{kappa}");
        }
    }

    /// Phases of paths that are known point to them.
    #[test]
    fn phases_point_to_the_paths_they_took() {
        let config = MicrophonesConfig::default();
        let heard = |line: i32| {
            let hz = (120.0 * f64::from(line), 121.0 * f64::from(line));
            let phase_rad = -TAU * (hz.0 * 0.3 - hz.1 * 0.1) / config.sound_m_s();
            PhaseDifference { rotors: (0, 1), hz, microphones: (0, 1), phase_rad, variance_rad2: 0.0 }
        };
        let phases: Vec<Phase> = (1..=10).filter_map(|line| Phase::of(&heard(line), 0.05, &config)).collect();
        let at = |first_m: f64, second_m: f64| {
            log_ratio(&phases, Paths { further_m: (first_m, second_m), std_m: 0.05 }, &config)
        };
        let found = [at(0.3, 0.1), at(0.2, 0.1), at(0.1, 0.3)];
        assert!(phases.len() == 10 && found[0] > 8.0, "{found:?}");
        assert!(found[0] > found[1] + 0.5 && found[0] > found[2] + 10.0, "{found:?}");
        // what moves both does not matter
        assert!((at(0.4, 0.2) - found[0]).abs() < 0.3);
        // beyond half a wave nothing is told
        assert!(Phase::of(&heard(30), 0.05, &config).is_none());
        assert_eq!(log_ratio(&[], Paths { further_m: (0.3, 0.1), std_m: 0.05 }, &config), 0.0);
    }
}
