//! Uncertainty budget of a speed: the sound, the recorder's clock, the motion of the vehicle, and the differences of the rotors.

use super::BudgetConfig;
use hovertone_analysis::{SpeedEstimate, UncertaintySource, UncertaintyTerm};
use hovertone_vehicle::SOUND_M_S;

/// An estimate with the terms of its uncertainty over a span of length `length_s`. Without an uncertainty from the sound, it has no terms.
///
/// `rotors_std_share` is the standard deviation of the mean of all rotors about this speed, as a share. A term with a limit has a
/// rectangular distribution: its standard uncertainty is half width / √3 (GUM, JCGM 100:2008, 4.3.7).
pub(crate) fn with_budget(
    mut estimate: SpeedEstimate,
    config: &BudgetConfig,
    rotors_std_share: f64,
    length_s: f64,
) -> SpeedEstimate {
    let drift_m_s_max = if length_s > 0.0 { config.drift_m_max / length_s } else { 0.0 };
    let limits = [
        (UncertaintySource::Clock, config.clock_ppm / 1e6),
        (UncertaintySource::Doppler, config.radial_speed_m_s_max / SOUND_M_S),
        (UncertaintySource::Drift, drift_m_s_max / SOUND_M_S),
    ];
    if let Some(std_uncertainty_rev_s) = estimate.std_uncertainty_rev_s {
        let of_limit = |(source, share): (UncertaintySource, f64)| UncertaintyTerm {
            source,
            std_uncertainty_rev_s: estimate.speed.rev_s() * share / 3f64.sqrt(),
        };
        estimate.budget = vec![UncertaintyTerm { source: UncertaintySource::Sound, std_uncertainty_rev_s }];
        estimate.budget.extend(limits.into_iter().filter(|(_, share)| *share > 0.0).map(of_limit));
        if rotors_std_share > 0.0 {
            let std_uncertainty_rev_s = estimate.speed.rev_s() * rotors_std_share;
            estimate.budget.push(UncertaintyTerm { source: UncertaintySource::Rotors, std_uncertainty_rev_s });
        }
    }
    estimate
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone_analysis::Method;
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
        let got = with_budget(estimate.clone(), &config, 0.0, 10.0);
        assert!((got.combined_std_uncertainty_rev_s().unwrap() - 0.005).abs() < 1e-12, "{:?}", got.budget);
        // 24 cm in 10 s, and no clock
        let drifting = BudgetConfig { clock_ppm: 0.0, drift_m_max: SOUND_M_S * 3f64.sqrt() * 4e-4, ..config };
        let got = with_budget(estimate.clone(), &drifting, 0.0, 10.0);
        assert!((got.combined_std_uncertainty_rev_s().unwrap() - 0.005).abs() < 1e-12, "{:?}", got.budget);
        let config = BudgetConfig {
            clock_ppm: 0.0,
            radial_speed_m_s_max: SOUND_M_S * 1e-3,
            drift_m_max: 0.0,
            ..BudgetConfig::default()
        };
        let got = with_budget(estimate.clone(), &config, 0.0, 10.0);
        assert_eq!(got.budget.len(), 2);
        assert!((got.budget[1].std_uncertainty_rev_s - 0.1 / 3f64.sqrt()).abs() < 1e-12);
        // rotors that were not separated
        let got = with_budget(estimate, &config, 0.004, 10.0);
        assert_eq!(got.budget[2].source, UncertaintySource::Rotors);
        assert!((got.budget[2].std_uncertainty_rev_s - 0.4).abs() < 1e-12);
    }
}
