//! When each rotor's lines arrive at one microphone after another, against how much further it is.

use super::heard::HeardLine;
use super::{MicrophoneArray, distance_m};
use crate::labels::evidence::log_sum_exp;
use crate::microphones_config::MicrophonesConfig;
use std::f64::consts::{PI, SQRT_2, TAU};

/// Path differences are integrated over in so many steps, out to so many standard deviations: a step is at most 0.4 rad of the highest
/// line that is used.
const STEPS: i32 = 24;
const REACH_STD: f64 = 3.0;

/// Logarithm of the likelihood ratio of each track's phases at each place to phases that mean nothing: `ratios[track][rotor]`.
pub(super) struct Delays {
    ratios: Vec<Vec<f64>>,
}

/// A phase difference, ready to be compared.
struct Phase {
    phase_rad: f64,
    rad_per_m: f64,
    /// Inverse variances, and the logarithm of the density of that von Mises distribution at its peak over uniform, for each scatter.
    kappas: [(f64, f64); 3],
}

impl Delays {
    pub(super) fn new(
        lines: &[HeardLine],
        tracks: usize,
        array: &MicrophoneArray,
        config: &MicrophonesConfig,
    ) -> Self {
        let microphones = array.microphones_m.len();
        let mut ratios = vec![vec![0.0; array.rotors.len()]; tracks];
        // all pairs, none of which is new where the others are known
        let weight = 2.0 / microphones as f64;
        for (track, ratios) in ratios.iter_mut().enumerate() {
            for pair in (0..microphones).flat_map(|a| (a + 1..microphones).map(move |b| (a, b))) {
                let phases = phases_of(lines, track, pair, config);
                for (ratio, rotor) in ratios.iter_mut().zip(&array.rotors) {
                    let to = |microphone: usize| distance_m(rotor.position_m, array.microphones_m[microphone]);
                    *ratio += weight * log_ratio(&phases, to(pair.0) - to(pair.1), config);
                }
            }
        }
        Self { ratios }
    }

    pub(super) fn log_ratio(&self, assignment: &[usize]) -> f64 {
        self.ratios.iter().zip(assignment).map(|(ratios, &rotor)| ratios[rotor]).sum()
    }
}

/// The lines of a track whose phases mean something between two microphones: beyond half a wave of what is not known of the path
/// they would not tell one place from another.
fn phases_of(lines: &[HeardLine], track: usize, pair: (usize, usize), config: &MicrophonesConfig) -> Vec<Phase> {
    let path_std_m = SQRT_2 * config.position_std_m;
    let own = lines.iter().filter(|line| line.rotor == track);
    own.filter_map(|line| {
        let heard = line.phases.iter().find(|phase| phase.microphones == pair)?;
        let rad_per_m = TAU * line.hz / config.sound_m_s();
        let kappas = config.phase_std_rad.map(|std_rad| {
            let kappa = 1.0 / (std_rad * std_rad + heard.variance_rad2);
            (kappa, kappa - log_bessel_i0(kappa))
        });
        (rad_per_m * path_std_m < PI).then_some(Phase { phase_rad: heard.phase_rad, rad_per_m, kappas })
    })
    .collect()
}

/// Over what is not known of the path, and over how much single lines are off.
fn log_ratio(phases: &[Phase], further_m: f64, config: &MicrophonesConfig) -> f64 {
    let path_std_m = SQRT_2 * config.position_std_m;
    let outliers = config.phase_outlier_share;
    let steps: Vec<(f64, f64)> = (-STEPS..=STEPS)
        .map(|step| REACH_STD * f64::from(step) / f64::from(STEPS))
        .map(|z| (z * path_std_m, -z * z / 2.0))
        .collect();
    let log_total = log_sum_exp(steps.iter().map(|step| step.1));
    let of_scatter = |scatter: usize| {
        let of_step = |&(off_m, log_weight): &(f64, f64)| -> f64 {
            let of_phase = |phase: &Phase| {
                // the later a line arrives, the less its phase
                let off_rad = phase.phase_rad + phase.rad_per_m * (further_m + off_m);
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

    /// Phases of a path that is known point to it; those of lines too high for what is known of it are left out.
    #[test]
    fn phases_point_to_the_path_they_took() {
        let config = MicrophonesConfig::default();
        let phase = |hz: f64, further_m: f64| {
            let rad_per_m = TAU * hz / config.sound_m_s();
            let kappas = config.phase_std_rad.map(|std| 1.0 / (std * std)).map(|kappa| (kappa, kappa - log_bessel_i0(kappa)));
            Phase { phase_rad: -rad_per_m * further_m, rad_per_m, kappas }
        };
        let phases: Vec<Phase> = (1..=10).map(|line| phase(120.0 * f64::from(line), 0.3)).collect();
        let at = |further_m: f64| log_ratio(&phases, further_m, &config);
        assert!(at(0.3) > 8.0 && at(0.3) > at(0.2) + 0.5 && at(0.3) > at(-0.1) + 10.0, "{} {} {}", at(0.3), at(0.2), at(-0.1));
        assert_eq!(log_ratio(&[], 0.3, &config), 0.0);
    }
}
