//! What makes a speed uncertain: what the sound leaves open, the recorder's clock, and the motion of the vehicle.

use super::SpeedEstimate;
use crate::budget_config::BudgetConfig;
use serde::Serialize;

/// Speed of sound in dry air of 20 °C. It changes by 0.17 % for each kelvin, which does not matter here.
pub(crate) const SOUND_M_S: f64 = 343.2;

/// Where an uncertainty comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum UncertaintySource {
    /// Noise, and what the method makes of it.
    Sound,
    /// The sampling clock of the recorder: `n Δ / √3` for a clock that is off by up to ±Δ.
    Clock,
    /// A vehicle that moves along the line to the microphone by up to ±v all the time: `n v / (c √3)`.
    Doppler,
    /// A hover that is up to ±d nearer to the microphone at the end of a stretch T than at its beginning: `n d / (c T √3)`.
    Drift,
    /// The mean of all rotors is not that of those that were heard apart: one ridge stands for all of them, and their mean lies about it as
    /// their speeds scatter; or some of them were not told from others.
    Rotors,
}

/// One term of the uncertainty of a speed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct UncertaintyTerm {
    /// Where it comes from.
    pub source: UncertaintySource,
    /// Standard uncertainty (GUM, type B terms from rectangular distributions).
    pub std_uncertainty_rev_s: f64,
}

impl SpeedEstimate {
    /// The terms of its uncertainty over a stretch of `length_s`; none where the sound itself leaves it unknown. The mean of all rotors
    /// may be so far from it, as a share.
    pub(crate) fn with_budget(mut self, config: &BudgetConfig, rotors_std_share: f64, length_s: f64) -> Self {
        let drift_m_s_max = if length_s > 0.0 { config.drift_m_max / length_s } else { 0.0 };
        let limits = [
            (UncertaintySource::Clock, config.clock_ppm / 1e6),
            (UncertaintySource::Doppler, config.radial_speed_m_s_max / SOUND_M_S),
            (UncertaintySource::Drift, drift_m_s_max / SOUND_M_S),
        ];
        if let Some(std_uncertainty_rev_s) = self.std_uncertainty_rev_s {
            let of_limit = |(source, share): (UncertaintySource, f64)| UncertaintyTerm {
                source,
                std_uncertainty_rev_s: self.speed.rev_s() * share / 3f64.sqrt(),
            };
            self.budget = vec![UncertaintyTerm { source: UncertaintySource::Sound, std_uncertainty_rev_s }];
            self.budget.extend(limits.into_iter().filter(|(_, share)| *share > 0.0).map(of_limit));
            if rotors_std_share > 0.0 {
                let std_uncertainty_rev_s = self.speed.rev_s() * rotors_std_share;
                self.budget.push(UncertaintyTerm { source: UncertaintySource::Rotors, std_uncertainty_rev_s });
            }
        }
        self
    }

    /// How far the mean of all rotors may be from this speed, as a share.
    pub fn rotors_std_share(&self) -> f64 {
        let term = self.budget.iter().find(|term| term.source == UncertaintySource::Rotors);
        term.map_or(0.0, |term| term.std_uncertainty_rev_s / self.speed.rev_s())
    }

    /// All terms together, at k = 1. `None` where the sound leaves it unknown.
    pub fn combined_std_uncertainty_rev_s(&self) -> Option<f64> {
        let sum: f64 = self.budget.iter().map(|term| term.std_uncertainty_rev_s.powi(2)).sum();
        (!self.budget.is_empty()).then(|| sum.sqrt())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::method::Method;
    use hovertone_vehicle::{Order, RotorSpeed};

    #[test]
    fn a_clock_and_a_motion_add_their_shares() {
        let estimate = SpeedEstimate {
            method: Method::Harmonic,
            order: Order::new(2.0).unwrap(),
            speed: RotorSpeed::from_rev_s(100.0),
            std_uncertainty_rev_s: Some(0.003),
            spread_rev_s: None,
            mean_square_rad2_s2: None,
            frame_count: 1,
            harmonics: Vec::new(),
            budget: Vec::new(),
        };
        let config = BudgetConfig { clock_ppm: 3f64.sqrt() * 40.0, drift_m_max: 0.0, ..BudgetConfig::default() };
        let got = estimate.clone().with_budget(&config, 0.0, 10.0);
        assert!((got.combined_std_uncertainty_rev_s().unwrap() - 0.005).abs() < 1e-12, "{:?}", got.budget);
        // 24 cm in 10 s, and no clock
        let drifting = BudgetConfig { clock_ppm: 0.0, drift_m_max: SOUND_M_S * 3f64.sqrt() * 4e-4, ..config };
        let got = estimate.clone().with_budget(&drifting, 0.0, 10.0);
        assert!((got.combined_std_uncertainty_rev_s().unwrap() - 0.005).abs() < 1e-12, "{:?}", got.budget);
        let config = BudgetConfig {
            clock_ppm: 0.0,
            radial_speed_m_s_max: SOUND_M_S * 1e-3,
            drift_m_max: 0.0,
            ..BudgetConfig::default()
        };
        let got = estimate.clone().with_budget(&config, 0.0, 10.0);
        assert_eq!(got.budget.len(), 2);
        assert!((got.budget[1].std_uncertainty_rev_s - 0.1 / 3f64.sqrt()).abs() < 1e-12);
        // rotors that were not told apart
        let got = estimate.with_budget(&config, 0.004, 10.0);
        assert_eq!(got.budget[2].source, UncertaintySource::Rotors);
        assert!((got.budget[2].std_uncertainty_rev_s - 0.4).abs() < 1e-12);
    }
}
