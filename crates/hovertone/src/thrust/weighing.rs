//! The acoustic scale: with a known thrust constant, what hovers weighs C ω²/g.

use hovertone_vehicle::{Ending, Estimate, RotorSpeed};

/// A hover as it was heard.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeardHover {
    /// Mean shaft speed.
    pub speed: RotorSpeed,
    /// Its relative standard uncertainty; absent where nothing tells.
    pub std_uncertainty_share: Option<f64>,
    /// Local gravity.
    pub gravity_m_s2: f64,
    /// Its standard uncertainty.
    pub gravity_std_m_s2: f64,
}

/// Mass of all that hovers: m = C ω²/g, with C the constant of the whole vehicle. u²(m)/m² = u²(C)/C² + 4 u²(ω)/ω² + u²(g)/g².
///
/// That one ridge follows the loudest rotor cancels as far as the same rotor was loudest when C was found.
pub fn mass_from_hover(thrust_constant_total_n_s2: Estimate, hover: &HeardHover) -> Estimate {
    let constant = thrust_constant_total_n_s2;
    let value = constant.value * hover.speed.rad_s().powi(2) / hover.gravity_m_s2;
    let shares = constant.std_uncertainty.zip(hover.std_uncertainty_share).map(|(constant_std, speed_share)| {
        (constant_std / constant.value).hypot(2.0 * speed_share).hypot(hover.gravity_std_m_s2 / hover.gravity_m_s2)
    });
    Estimate { value, std_uncertainty: shares.map(|share| share * value), ending: Ending::Solved }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The paper's hulls by its no-hull row: 443.68 and 462.40 g (table 1).
    #[test]
    fn the_papers_speeds_weigh_its_hulls() {
        let constant = Estimate {
            value: 0.413 * 9.8 / RotorSpeed::from_rpm(3610.3438).rad_s().powi(2),
            std_uncertainty: Some(2.83e-5 * 0.005),
            ending: Ending::Solved,
        };
        for (rpm, expected_kg) in [(3742.0275, 0.44368), (3820.1625, 0.46240)] {
            let hover = HeardHover {
                speed: RotorSpeed::from_rpm(rpm),
                std_uncertainty_share: Some(0.0025),
                gravity_m_s2: 9.8,
                gravity_std_m_s2: 0.0,
            };
            let mass = mass_from_hover(constant, &hover);
            assert!((mass.value - expected_kg).abs() < 5e-6, "{mass:?}");
            assert!((mass.std_uncertainty.unwrap() / mass.value - 0.0050f64.hypot(0.005)).abs() < 2e-5, "{mass:?}");
        }
    }
}
