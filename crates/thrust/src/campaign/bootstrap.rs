//! The uncertainty again, by drawing trials anew: a cross-check that uses no formula of the budget.

use crate::campaign::Campaign;
use crate::square_law::SquareLawFit;
use crate::statistics::{mean, std};
use rand::{RngExt, SeedableRng};
use serde::Serialize;

/// Draws: their own scatter then is 1.6 % of the result.
const DRAWS: usize = 2000;
/// Everything random comes from here; the same trials give the same number.
const SEED: u64 = 1;

/// Scatter of the constant when trials are drawn with replacement, load by load.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct TrialBootstrap {
    /// Standard deviation over the draws, times √(n/(n−1)) for n trials a load, by which drawing from few falls short.
    pub std_uncertainty_n_s2: f64,
    /// 2.5 % of the draws lie below …
    pub low_n_s2: f64,
    /// … and 2.5 % above.
    pub high_n_s2: f64,
    /// How many.
    pub draws: usize,
    /// Where they come from.
    pub seed: u64,
}

/// Draws trials, never samples: those of a trial overlap and share a flight. `None` where a load has a single trial: there is
/// nothing to draw.
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
    Some(TrialBootstrap { std_uncertainty_n_s2, low_n_s2: at(0.025), high_n_s2: at(0.975), draws: DRAWS, seed: SEED })
}
