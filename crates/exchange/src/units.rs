//! One thrust constant in the units of other programs.

use hovertone_vehicle::GRAVITY_STANDARD_M_S2;
use std::f64::consts::TAU;

/// A thrust constant of one rotor, stored in N/(rad/s)².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstantUnits {
    n_s2: f64,
}

impl ConstantUnits {
    /// From N/(rad/s)².
    pub fn from_n_s2(n_s2: f64) -> Self {
        Self { n_s2 }
    }

    /// From N/rpm².
    pub fn from_n_rpm2(n_rpm2: f64) -> Self {
        Self { n_s2: n_rpm2 * (60.0 / TAU).powi(2) }
    }

    /// From F/(ρ n² D⁴).
    pub fn from_coefficient(propeller: f64, density_kg_m3: f64, diameter_m: f64) -> Self {
        Self { n_s2: propeller * density_kg_m3 * diameter_m.powi(4) / TAU.powi(2) }
    }

    /// N/(rad/s)², which is N s².
    pub fn n_s2(self) -> f64 {
        self.n_s2
    }

    /// N/(rev/s)².
    pub fn n_rev_s2(self) -> f64 {
        self.n_s2 * TAU.powi(2)
    }

    /// N/rpm².
    pub fn n_rpm2(self) -> f64 {
        self.n_s2 * (TAU / 60.0).powi(2)
    }

    /// Gram-force/rpm².
    pub fn g_rpm2(self) -> f64 {
        self.n_rpm2() * 1e3 / GRAVITY_STANDARD_M_S2
    }

    /// F/(ρ n² D⁴).
    pub fn coefficient(self, density_kg_m3: f64, diameter_m: f64) -> f64 {
        self.n_s2 * TAU.powi(2) / (density_kg_m3 * diameter_m.powi(4))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_constants_in_known_units() {
        // 1 N/rpm² is (60/2π)² = 91.189 N/(rad/s)²; the 3.16e-10 N/rpm² of a Crazyflie is 2.88e-8 N/(rad/s)²
        assert!((ConstantUnits::from_n_rpm2(1.0).n_s2() - 91.189).abs() < 1e-3);
        assert!((ConstantUnits::from_n_rpm2(3.16e-10).n_s2() - 2.88e-8).abs() < 5e-11);
        // the rotor of AirSim: 4.179446268 N at 6396.667 rpm
        let airsim = ConstantUnits::from_coefficient(0.109919, 1.225, 0.2286);
        assert!((airsim.n_rpm2() * 6396.667f64.powi(2) - 4.179446268).abs() < 1e-5);
    }

    #[test]
    fn there_and_back() {
        let constant = ConstantUnits::from_n_s2(7.0775e-6);
        for back in [
            ConstantUnits::from_n_rpm2(constant.n_rpm2()),
            ConstantUnits::from_coefficient(constant.coefficient(1.1, 0.2), 1.1, 0.2),
        ] {
            assert!((back.n_s2() / constant.n_s2() - 1.0).abs() < 1e-14);
        }
        assert!((constant.n_rev_s2() / constant.n_rpm2() - 3600.0).abs() < 1e-9);
        // 1 N is 101.9716 gram-force
        assert!((constant.g_rpm2() / constant.n_rpm2() - 101.9716).abs() < 1e-4);
    }
}
