//! When a rotor becomes audible: the change point of its power over time.

use super::frames::{FRAME_S, HOP_S};
use hovertone_signal::statistics::{STD_PER_MEDIAN_DEVIATION, median};

/// Power of a rotor, as a share of its power in the hover, above which it is audible. *Decision.*
pub(super) const AUDIBLE_SHARE: f64 = 0.1;
/// Number of frames of the running median: other rotors whose lines pass through this rotor's as they run up, and gusts, are shorter.
/// *Decision.*
const SMOOTHED_FRAMES: usize = 5;
/// Smallest standard deviation of the logarithm of a rotor's power: lines swell and fade, and rooms add to that. *Decision.*
const LN_POWER_STD_MIN: f64 = 0.5;
/// Standard deviation over unlike motors of the time that they need to run up, in s. *Physics.*
const RUN_UP_STD_S: f64 = 0.1;

/// When a rotor becomes audible.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Onset {
    /// On the clock of the frames, with the standard uncertainty.
    At { time_s: f64, std_s: f64 },
    /// It is audible from the first frames on.
    BeforeRecording,
    /// It becomes audible and inaudible again, or is never audible.
    Unclear,
}

/// Normal distribution of the logarithm of a power.
#[derive(Clone, Copy)]
struct LnPower {
    mean: f64,
    std: f64,
}

/// The onset of a rotor, from its power in consecutive frames. In the last of them it is audible. `noise_power` is the power that noise
/// alone has, `hover_power` that of the rotor in the hover.
///
/// The smoothed power must rise above the limit once and stay there. The onset is the mean of the posterior of one change point with a flat
/// prior (Smith 1975), between two normal distributions of the logarithm of the power, before and after.
pub(super) fn onset_from_powers(powers: &[f64], first_middle_s: f64, noise_power: f64, hover_power: f64) -> Onset {
    let ln_powers: Vec<f64> = powers.iter().map(|power| power.max(noise_power / 2.0).ln()).collect();
    let ln_audible = (AUDIBLE_SHARE * hover_power).ln();
    let is_audible: Vec<bool> = running_median(&ln_powers).into_iter().map(|power| power > ln_audible).collect();
    let Some(first) = is_audible.iter().position(|is_audible| *is_audible) else { return Onset::Unclear };
    if !is_audible[first..].iter().all(|is_audible| *is_audible) {
        return Onset::Unclear;
    }
    if first < SMOOTHED_FRAMES {
        return Onset::BeforeRecording;
    }
    let (before, after) = (LnPower::robust(&ln_powers[..first]), LnPower::robust(&ln_powers[first..]));
    let weights = change_point_weights(&ln_powers, before, after);
    let total: f64 = weights.iter().sum();
    let change: f64 = weights.iter().enumerate().map(|(frame, weight)| frame as f64 * weight).sum::<f64>() / total;
    let variance =
        weights.iter().enumerate().map(|(frame, weight)| (frame as f64 - change).powi(2) * weight).sum::<f64>() / total;
    // where within half a frame the sound starts is unknown: a uniform distribution
    let within_s = FRAME_S / 2.0 / 12f64.sqrt();
    Onset::At {
        time_s: first_middle_s + HOP_S * (change - 0.5),
        std_s: (variance.sqrt() * HOP_S).hypot(within_s).hypot(RUN_UP_STD_S),
    }
}

impl LnPower {
    /// By median and median absolute deviation.
    fn robust(ln_powers: &[f64]) -> Self {
        let mean = median(ln_powers).unwrap_or(0.0);
        let deviations: Vec<f64> = ln_powers.iter().map(|value| (value - mean).abs()).collect();
        let std = (STD_PER_MEDIAN_DEVIATION * median(&deviations).unwrap_or(0.0)).max(LN_POWER_STD_MIN);
        Self { mean, std }
    }

    /// Logarithm of the density, without the power of 2π.
    fn ln_density(self, value: f64) -> f64 {
        -0.5 * ((value - self.mean) / self.std).powi(2) - self.std.ln()
    }
}

/// Posterior of a change before each frame, up to a factor.
fn change_point_weights(ln_powers: &[f64], before: LnPower, after: LnPower) -> Vec<f64> {
    let mut ln_posterior: Vec<f64> = Vec::with_capacity(ln_powers.len());
    let mut sum: f64 = ln_powers.iter().map(|&value| after.ln_density(value)).sum();
    for &value in ln_powers {
        ln_posterior.push(sum);
        sum += before.ln_density(value) - after.ln_density(value);
    }
    let highest = ln_posterior.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    ln_posterior.iter().map(|ln_weight| (ln_weight - highest).exp()).collect()
}

/// Median of each value and its neighbours.
fn running_median(values: &[f64]) -> Vec<f64> {
    let reach = SMOOTHED_FRAMES / 2;
    (0..values.len())
        .map(|at| {
            let part = &values[at.saturating_sub(reach)..(at + reach + 1).min(values.len())];
            median(part).unwrap_or(0.0)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_distr::{Distribution, StandardNormal};

    fn powers(rng: &mut rand_pcg::Pcg64, onset: usize, count: usize) -> Vec<f64> {
        let mut power = |mean: f64, std: f64| {
            let normal: f64 = StandardNormal.sample(rng);
            mean * (std * normal).exp()
        };
        (0..count).map(|frame| if frame < onset { power(10.0, 0.4) } else { power(5000.0, 0.4) }).collect()
    }

    #[test]
    fn the_onset_is_within_its_uncertainty() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(1);
        let mut within = 0;
        for _ in 0..100 {
            let onset = rng.random_range(8..60);
            let powers = powers(&mut rng, onset, 80);
            let Onset::At { time_s, std_s } = onset_from_powers(&powers, 0.2, 10.0, 5000.0) else {
                panic!("not found")
            };
            // half a hop before the first audible frame
            let truth_s = 0.2 + HOP_S * (onset as f64 - 0.5);
            assert!((0.1..0.3).contains(&std_s), "{std_s}");
            within += usize::from((time_s - truth_s).abs() < std_s);
        }
        assert!(within >= 95, "{within}");
    }

    #[test]
    fn an_interrupted_rotor_and_one_that_turns_already_have_no_onset() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(2);
        let mut gone = powers(&mut rng, 20, 80);
        gone[40..50].fill(10.0);
        assert_eq!(onset_from_powers(&gone, 0.2, 10.0, 5000.0), Onset::Unclear);
        assert_eq!(onset_from_powers(&powers(&mut rng, 0, 80), 0.2, 10.0, 5000.0), Onset::BeforeRecording);
        assert_eq!(onset_from_powers(&powers(&mut rng, 80, 80), 0.2, 10.0, 5000.0), Onset::Unclear);
        // another rotor runs up through its lines
        let mut passed = powers(&mut rng, 40, 80);
        passed[20..22].fill(5000.0);
        assert!(matches!(onset_from_powers(&passed, 0.2, 10.0, 5000.0), Onset::At { .. }));
    }
}
