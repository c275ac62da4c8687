//! Bootstrap over trials (Efron 1979): a cross-check of the uncertainty without any formula of the budget.

use crate::campaign::Campaign;
use crate::square_law::SquareLawFit;
use crate::statistics::{mean, std};
use rand::{RngExt, SeedableRng};
use serde::Serialize;

/// Number of resamples. The standard deviation that they give scatters by 1/√(2 · 2000) = 1.6 %. *Numeric.*
const DRAWS: usize = 2000;
/// Seed of the random numbers: the same trials give the same result. *Numeric.*
const SEED: u64 = 1;
/// Lower end of the 95 % interval, as a share of the sorted resamples. *Decision.*
const QUANTILE_LOW: f64 = 0.025;
/// Upper end of the 95 % interval. *Decision.*
const QUANTILE_HIGH: f64 = 0.975;

/// Scatter of the constant over resamples: trials are drawn with replacement, load by load.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TrialBootstrap {
    /// Standard deviation over the resamples, times √(n/(n−1)) for n trials of a load: a bootstrap over few trials is too small by
    /// this factor.
    pub std_uncertainty_n_s2: f64,
    /// 2.5 % of the resamples lie below this constant …
    pub low_n_s2: f64,
    /// … and 2.5 % lie above this one.
    pub high_n_s2: f64,
    /// Number of resamples.
    pub draws: usize,
    /// Seed of the random numbers.
    pub seed: u64,
}

/// Bootstrap over trials, not over samples: the samples of a trial overlap and share a flight. `None` where a load has a single
/// trial, since one trial shows no scatter.
pub(crate) fn trial_bootstrap(campaign: &Campaign<'_>, fit: &SquareLawFit) -> Option<TrialBootstrap> {
    let decides = || campaign.loads.iter().zip(&fit.shares).filter(|(_, share)| **share > 0.0);
    if decides().any(|(load, _)| load.trials_rad_s.len() < 2) {
        return None;
    }
    let mut random = rand_pcg::Pcg64::seed_from_u64(SEED);
    let mut draws: Vec<f64> = (0..DRAWS)
        .map(|_| {
            let parts = decides().map(|(load, share)| {
                let trials = &load.trials_rad_s;
                let drawn: Vec<f64> = trials.iter().map(|_| trials[random.random_range(0..trials.len())]).collect();
                share * load.force_n / mean(&drawn).unwrap_or(load.speed_rad_s).powi(2)
            });
            parts.sum()
        })
        .collect();
    let trials: Vec<f64> = decides().map(|(load, _)| load.trials_rad_s.len() as f64).collect();
    let trials = mean(&trials)?;
    let std_uncertainty_n_s2 = std(&draws)? * (trials / (trials - 1.0)).sqrt();
    draws.sort_by(f64::total_cmp);
    let at = |share: f64| draws[((DRAWS as f64 * share) as usize).min(DRAWS - 1)];
    Some(TrialBootstrap {
        std_uncertainty_n_s2,
        low_n_s2: at(QUANTILE_LOW),
        high_n_s2: at(QUANTILE_HIGH),
        draws: DRAWS,
        seed: SEED,
    })
}
