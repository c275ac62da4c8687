//! The prior of a speed by what is known of the vehicle, in nats; and odds.

use super::settings::EvidenceConfig;
use hovertone_vehicle::{AIR_KG_M3, KnownRotor};

/// Logarithm of the odds of a belief.
pub(super) fn odds_nats(belief: f64) -> f64 {
    (belief / (1.0 - belief)).ln()
}

/// Logarithm of the prior of a speed: by the thrust coefficient of the hover where mass, rotors and diameter are known, else slow shafts are
/// rare; and by the distance from the range of speeds of a known vehicle.
pub(super) fn nats_of_vehicle(speed_rev_s: f64, known: &KnownRotor, config: &EvidenceConfig) -> f64 {
    let prior = &config.levels;
    let deviations = match known.hover_thrust_coefficient(speed_rev_s, AIR_KG_M3) {
        Some(coefficient) => (coefficient / prior.thrust_coefficient).ln() / prior.thrust_coefficient_std,
        None => (speed_rev_s / prior.slow_rev_s).ln().min(0.0) / prior.slow_std,
    };
    let outside = known.shaft_speed.map_or(0.0, |range| {
        (range.rev_s_low / speed_rev_s).ln().max(0.0) + (speed_rev_s / range.rev_s_high).ln().max(0.0)
    });
    -0.5 * (deviations.powi(2) + (outside / prior.range_std).powi(2))
}
