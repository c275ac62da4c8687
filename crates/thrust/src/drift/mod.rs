//! Whether the constant drifts from trial to trial, or within trials. At a constant weight the battery does not change Σω², so a drift
//! comes from the height, a draught, another loudest rotor, or a load that shifts.

mod rows;

pub use rows::row_drifts;

use crate::campaign::Campaign;
use crate::statistics::{mean, std, two_sided_chance};
use serde::Serialize;

/// Probability of a false alarm of one test. It is below the usual 5 %, since every experiment is tested for two drifts. *Decision.*
const FALSE_ALARM_CHANCE: f64 = 0.01;
/// Fewest trials for a drift within trials: the scatter of their slopes is its uncertainty. *Decision.*
const TRIALS_MIN: usize = 3;
/// Fewest samples of a trial for a slope. *Decision.*
const SAMPLES_MIN: usize = 3;

/// The variable of a drift.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum DriftKind {
    /// From one trial of a load to the next, in the listed order.
    PerTrial,
    /// Per second within the trials.
    PerSecond,
    /// From one row of a table to the next.
    PerRow,
    /// Per volt of the supply voltage.
    PerVolt,
}

/// A significant change of the constant.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Drift {
    /// The variable.
    pub kind: DriftKind,
    /// Relative change of the constant per unit of the variable.
    pub constant_share: f64,
    /// Its standard uncertainty.
    pub std_uncertainty_share: f64,
    /// Probability of a change at least this large without any drift.
    pub p_value: f64,
}

/// The significant drifts of a campaign.
pub(crate) fn drifts(campaign: &Campaign<'_>) -> Vec<Drift> {
    [drift_per_trial(campaign), drift_per_second(campaign)]
        .into_iter()
        .flatten()
        .filter(|drift| drift.p_value < FALSE_ALARM_CHANCE)
        .collect()
}

/// A value at a place or a time.
struct At {
    x: f64,
    value: f64,
}

/// Slope of the relative speed over the index of the trial, by least squares about the mean of each load.
fn drift_per_trial(campaign: &Campaign<'_>) -> Option<Drift> {
    let steps: Vec<At> = campaign
        .loads
        .iter()
        .flat_map(|load| {
            let middle = (load.trials_rad_s.len() as f64 - 1.0) / 2.0;
            load.trials_rad_s
                .iter()
                .enumerate()
                .map(move |(place, rad_s)| At { x: place as f64 - middle, value: rad_s / load.speed_rad_s - 1.0 })
        })
        .collect();
    let squares: f64 = steps.iter().map(|step| step.x * step.x).sum();
    let freedom = steps.len() as f64 - campaign.loads.len() as f64 - 1.0;
    if squares == 0.0 || freedom < 1.0 {
        return None;
    }
    let slope = steps.iter().map(|step| step.x * step.value).sum::<f64>() / squares;
    let residuals: f64 = steps.iter().map(|step| (step.value - slope * step.x).powi(2)).sum();
    judged(DriftKind::PerTrial, slope, (residuals / freedom / squares).sqrt(), freedom)
}

/// Mean over the slopes of the trials. Its uncertainty is the scatter of the slopes, because the samples of a trial are correlated.
fn drift_per_second(campaign: &Campaign<'_>) -> Option<Drift> {
    let slopes: Vec<f64> = campaign
        .loads
        .iter()
        .flat_map(|load| &load.load.trials)
        .filter_map(|trial| {
            let samples: Vec<At> = trial
                .samples
                .iter()
                .map(|sample| At { x: (sample.span.from_s + sample.span.to_s) / 2.0, value: sample.speed.rad_s().ln() })
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

/// Slope by least squares; `None` with fewer than [`SAMPLES_MIN`] points.
fn slope_of(points: &[At]) -> Option<f64> {
    let middle = mean(&points.iter().map(|point| point.x).collect::<Vec<_>>())?;
    let squares: f64 = points.iter().map(|point| (point.x - middle).powi(2)).sum();
    let products: f64 = points.iter().map(|point| (point.x - middle) * point.value).sum();
    (points.len() >= SAMPLES_MIN && squares > 0.0).then(|| products / squares)
}

/// The drift of the constant from the drift of the speed: C ∝ 1/ω², so δC/C = −2 δω/ω.
fn judged(kind: DriftKind, speed_slope: f64, speed_slope_std: f64, freedom: f64) -> Option<Drift> {
    let is_judged = speed_slope_std > 0.0;
    Some(Drift {
        kind,
        constant_share: -2.0 * speed_slope,
        std_uncertainty_share: 2.0 * speed_slope_std,
        p_value: if is_judged { two_sided_chance(speed_slope / speed_slope_std, Some(freedom))? } else { 1.0 },
    })
}
