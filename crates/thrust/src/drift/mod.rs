//! Whether the constant drifts: from trial to trial, or within them. At a constant weight no battery changes Σω², so a drift is
//! height, draught, another loudest rotor, or a load that shifts.

mod rows;

pub use rows::row_drifts;

use crate::campaign::Campaign;
use crate::square_law::point_verdict::two_sided_chance;
use crate::statistics::{mean, std};
use serde::Serialize;

/// Chance of calling chance a drift: two are looked for in every experiment, so rarer than other tests.
const FALSE_ALARM_CHANCE: f64 = 0.01;
/// Fewest trials with a slope of their own.
const TRIALS_MIN: usize = 3;
/// Fewest samples that have a slope.
const SAMPLES_MIN: usize = 3;

/// How a drift was seen.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum DriftKind {
    /// From one trial of a load to the next, in the order in which they are listed.
    PerTrial,
    /// Within the trials, for each second.
    PerSecond,
    /// From one row of a table to the next.
    PerRow,
    /// With the voltage of the supply, for each volt.
    PerVolt,
}

/// A change of the constant that is not chance.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Drift {
    /// Over what.
    pub kind: DriftKind,
    /// Relative change of the constant for each step.
    pub constant_share: f64,
    /// Its standard uncertainty.
    pub std_uncertainty_share: f64,
    /// Chance of so much without any drift.
    pub p_value: f64,
}

/// What drifts beyond chance.
pub(crate) fn drifts(campaign: &Campaign<'_>) -> Vec<Drift> {
    [drift_per_trial(campaign), drift_per_second(campaign)]
        .into_iter()
        .flatten()
        .filter(|drift| drift.p_value < FALSE_ALARM_CHANCE)
        .collect()
}

fn drift_per_trial(campaign: &Campaign<'_>) -> Option<Drift> {
    // place of a trial and its speed, both from the mean of its load
    let steps: Vec<(f64, f64)> = campaign
        .loads
        .iter()
        .flat_map(|load| {
            let middle = (load.trials_rad_s.len() as f64 - 1.0) / 2.0;
            load.trials_rad_s
                .iter()
                .enumerate()
                .map(move |(place, rad_s)| (place as f64 - middle, rad_s / load.speed_rad_s - 1.0))
        })
        .collect();
    let squares: f64 = steps.iter().map(|(place, _)| place * place).sum();
    let freedom = steps.len() as f64 - campaign.loads.len() as f64 - 1.0;
    if squares == 0.0 || freedom < 1.0 {
        return None;
    }
    let slope = steps.iter().map(|(place, change)| place * change).sum::<f64>() / squares;
    let residuals: f64 = steps.iter().map(|(place, change)| (change - slope * place).powi(2)).sum();
    judged(DriftKind::PerTrial, slope, (residuals / freedom / squares).sqrt(), freedom)
}

/// One slope for each trial, whose samples are correlated; their scatter says what a slope is worth.
fn drift_per_second(campaign: &Campaign<'_>) -> Option<Drift> {
    let slopes: Vec<f64> = campaign
        .loads
        .iter()
        .flat_map(|load| &load.load.trials)
        .filter_map(|trial| {
            let samples: Vec<(f64, f64)> = trial
                .samples
                .iter()
                .map(|sample| ((sample.span.from_s + sample.span.to_s) / 2.0, sample.speed.rad_s().ln()))
                .collect();
            slope_of(&samples)
        })
        .collect();
    let (slope, scatter) = (mean(&slopes)?, std(&slopes)?);
    if slopes.len() < TRIALS_MIN {
        return None;
    }
    let count = slopes.len() as f64;
    judged(DriftKind::PerSecond, slope, scatter / count.sqrt(), count - 1.0)
}

fn slope_of(points: &[(f64, f64)]) -> Option<f64> {
    let time = mean(&points.iter().map(|point| point.0).collect::<Vec<_>>())?;
    let squares: f64 = points.iter().map(|(s, _)| (s - time).powi(2)).sum();
    let products: f64 = points.iter().map(|(s, value)| (s - time) * value).sum();
    (points.len() >= SAMPLES_MIN && squares > 0.0).then(|| products / squares)
}

/// The constant goes with the inverse square of the speed.
fn judged(kind: DriftKind, speed_slope: f64, speed_slope_std: f64, freedom: f64) -> Option<Drift> {
    let is_judged = speed_slope_std > 0.0;
    Some(Drift {
        kind,
        constant_share: -2.0 * speed_slope,
        std_uncertainty_share: 2.0 * speed_slope_std,
        p_value: if is_judged { two_sided_chance(speed_slope / speed_slope_std, Some(freedom))? } else { 1.0 },
    })
}
