//! Level of a rotor over time → when it begins.

use super::frames::{FRAME_S, HOP_S};
use hovertone_signal::statistics::{mean, median};

/// A rotor is heard above this share of the power that it has in the hover.
pub(super) const HEARD_SHARE: f64 = 0.1;
/// Frames that a smoothed level looks at: others that run up through the same lines, and gusts, are shorter.
const SMOOTHED_FRAMES: usize = 5;
/// Spread of a level's logarithm, at least: lines swell and fade, and rooms add to that.
const LEVEL_STD_MIN: f64 = 0.5;
/// Standard deviation of what unlike motors need to run up to their speed.
const RUN_UP_STD_S: f64 = 0.1;

/// When a rotor begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Begin {
    /// On the clock of the frames, with its standard uncertainty.
    At { time_s: f64, std_s: f64 },
    /// It turns already when the recording begins.
    Before,
    /// It comes and goes, or never is there.
    Unclear,
}

/// From the powers of a rotor up to a time from which on it is heard, over `floor`, that of noise, and `typical`, that of the hover.
///
/// The smoothed level must rise once and stay. When is the mean of the change point's posterior: two levels with Gaussian
/// logarithms, before and after, each with a mean and spread of its own.
pub(super) fn begin_of(powers: &[f64], first_middle_s: f64, floor: f64, typical: f64) -> Begin {
    let log: Vec<f64> = powers.iter().map(|power| power.max(floor / 2.0).ln()).collect();
    let heard_log = (HEARD_SHARE * typical).ln();
    let is_heard: Vec<bool> = smoothed(&log).into_iter().map(|level| level > heard_log).collect();
    let Some(first) = is_heard.iter().position(|heard| *heard) else { return Begin::Unclear };
    if !is_heard[first..].iter().all(|heard| *heard) {
        return Begin::Unclear;
    }
    if first < SMOOTHED_FRAMES {
        return Begin::Before;
    }
    let (before, after) = (&log[..first], &log[first..]);
    let level = |part: &[f64]| {
        let middle = median(part).unwrap_or(0.0);
        let deviations: Vec<f64> = part.iter().map(|value| (value - middle).abs()).collect();
        (middle, (1.4826 * median(&deviations).unwrap_or(0.0)).max(LEVEL_STD_MIN))
    };
    let (quiet, loud) = (level(before), level(after));
    let log_density = |value: f64, (mean, std): (f64, f64)| -0.5 * ((value - mean) / std).powi(2) - std.ln();
    // of a change before each frame
    let mut posterior: Vec<f64> = Vec::with_capacity(log.len());
    let mut sum: f64 = log.iter().map(|&value| log_density(value, loud)).sum();
    for &value in &log {
        posterior.push(sum);
        sum += log_density(value, quiet) - log_density(value, loud);
    }
    let highest = posterior.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let weights: Vec<f64> = posterior.iter().map(|log| (log - highest).exp()).collect();
    let total: f64 = weights.iter().sum();
    let change: f64 = weights.iter().enumerate().map(|(frame, weight)| frame as f64 * weight).sum::<f64>() / total;
    let variance =
        weights.iter().enumerate().map(|(frame, weight)| (frame as f64 - change).powi(2) * weight).sum::<f64>() / total;
    // a frame half of which is heard lies in the middle between the levels; where in it the sound begins is not known
    let within_s = FRAME_S / 48f64.sqrt();
    Begin::At {
        time_s: first_middle_s + HOP_S * (change - 0.5),
        std_s: (variance.sqrt() * HOP_S).hypot(within_s).hypot(RUN_UP_STD_S),
    }
}

/// Median of neighbouring values.
fn smoothed(values: &[f64]) -> Vec<f64> {
    let reach = SMOOTHED_FRAMES / 2;
    (0..values.len())
        .map(|at| {
            let part = &values[at.saturating_sub(reach)..(at + reach + 1).min(values.len())];
            median(part).or_else(|| mean(part)).unwrap_or(0.0)
        })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_distr::{Distribution, StandardNormal};

    fn powers(rng: &mut rand_pcg::Pcg64, begin: usize, count: usize) -> Vec<f64> {
        let mut level = |mean: f64, std: f64| {
            let normal: f64 = StandardNormal.sample(rng);
            mean * (std * normal).exp()
        };
        (0..count).map(|frame| if frame < begin { level(10.0, 0.4) } else { level(5000.0, 0.4) }).collect()
    }

    #[test]
    fn the_begin_is_within_its_uncertainty() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(1);
        let mut within = 0;
        for _ in 0..100 {
            let begin = rng.random_range(8..60);
            let Begin::At { time_s, std_s } = begin_of(&powers(&mut rng, begin, 80), 0.2, 10.0, 5000.0) else {
                panic!("not found")
            };
            // half a frame's hop before the first frame that is heard
            let truth_s = 0.2 + HOP_S * (begin as f64 - 0.5);
            assert!((0.1..0.3).contains(&std_s), "{std_s}");
            within += usize::from((time_s - truth_s).abs() < std_s);
        }
        assert!(within >= 95, "{within}");
    }

    #[test]
    fn what_comes_and_goes_has_no_begin_and_what_was_there_none_to_hear() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(2);
        let mut gone = powers(&mut rng, 20, 80);
        gone[40..50].fill(10.0);
        assert_eq!(begin_of(&gone, 0.2, 10.0, 5000.0), Begin::Unclear);
        assert_eq!(begin_of(&powers(&mut rng, 0, 80), 0.2, 10.0, 5000.0), Begin::Before);
        assert_eq!(begin_of(&powers(&mut rng, 80, 80), 0.2, 10.0, 5000.0), Begin::Unclear);
        // another one that runs up through its lines
        let mut passed = powers(&mut rng, 40, 80);
        passed[20..22].fill(5000.0);
        assert!(matches!(begin_of(&passed, 0.2, 10.0, 5000.0), Begin::At { .. }));
    }
}
