//! Ground effect: more thrust near the ground.

/// Below this height in radii the factor keeps its value at this height: the formula grows without bound towards a quarter.
const LOWEST_RADII: f64 = 0.5;

/// Thrust near the ground over thrust far from it at the same speed, 1/(1 - (R/4z)²), for a disc of `radius_m` at
/// `height_m` above flat ground; Cheeseman and Bennett 1955, for an isolated rotor in hover. Rotors that stand close
/// together have a larger effect. The load torque does not change. Below half a radius the factor stays at 1.33.
pub fn ground_effect(radius_m: f64, height_m: f64) -> f64 {
    let share = radius_m / (4.0 * height_m.max(LOWEST_RADII * radius_m));
    1.0 / (1.0 - share * share)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_published_shares_at_a_radius_of_a_tenth() {
        for (height_m, percent) in [(1.0, 0.06), (0.5, 0.25), (0.3, 0.70), (0.2, 1.59)] {
            let found = 100.0 * (ground_effect(0.1, height_m) - 1.0);
            assert!((found - percent).abs() < 0.005, "{height_m} m: {found} %");
        }
        assert_eq!(ground_effect(0.1, 1e9), 1.0);
        assert_eq!(ground_effect(0.1, -1.0), ground_effect(0.1, 0.05));
        assert!((ground_effect(0.1, 0.0) - 4.0 / 3.0).abs() < 1e-12);
    }
}
