//! Force balance: what a known force and a measured speed say of the thrust constant (paper, eq 3).

use crate::config::check_range;
use crate::error::ConfigError;
use hovertone_vehicle::RotorSpeed;
use serde::{Deserialize, Serialize};
use std::f64::consts::{PI, TAU};

/// Standard gravity, where no local value is given.
pub const GRAVITY_STANDARD_M_S2: f64 = 9.80665;

/// C = f / ω² in N s² (N per (rad/s)²), eq 3 solved for the constant.
///
/// With `force_n` the whole weight, as in the paper's tables, it is the constant of the whole vehicle: the sum over its
/// rotors. With the force of one rotor it is that rotor's.
pub fn thrust_constant_n_s2(force_n: f64, speed: RotorSpeed) -> f64 {
    force_n / speed.rad_s().powi(2)
}

/// Normal gravity at a latitude and height: Somigliana's formula on the WGS84 ellipsoid with the free-air gradient, good
/// to about 0.0005 m/s² where the ground is not unusual.
pub fn gravity_m_s2(latitude_deg: f64, height_m: f64) -> f64 {
    let sine_squared = latitude_deg.to_radians().sin().powi(2);
    let on_ellipsoid =
        9.7803253359 * (1.0 + 0.00193185265241 * sine_squared) / (1.0 - 0.00669437999013 * sine_squared).sqrt();
    on_ellipsoid - 3.086e-6 * height_m
}

/// The air that the rotors turned in.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Air {
    /// Temperature.
    pub temperature_c: f64,
    /// Pressure at the place, not reduced to sea level.
    pub pressure_hpa: f64,
    /// Relative humidity, 0 to 100; dry where absent.
    #[serde(default)]
    pub humidity_percent: f64,
}

impl Air {
    /// What is wrong with it, by name, value and limit: air that one can fly in, so that pascals, kelvins and shares are
    /// told from hectopascals, degrees and per cent.
    pub(crate) fn check(&self) -> Result<(), ConfigError> {
        check_range("temperature_c", self.temperature_c, -60.0, 60.0)?;
        check_range("pressure_hpa", self.pressure_hpa, 300.0, 1100.0)?;
        check_range("humidity_percent", self.humidity_percent, 0.0, 100.0)
    }

    /// Density of moist air as an ideal gas, (p − e) / (287.05 T) + e / (461.5 T) with the vapour pressure e by Magnus'
    /// formula. Within 0.1 % of the reference formula for weather one can fly in.
    pub fn density_kg_m3(&self) -> f64 {
        let kelvin = self.temperature_c + 273.15;
        let vapour_pa =
            self.humidity_percent / 100.0 * 611.2 * (17.62 * self.temperature_c / (243.12 + self.temperature_c)).exp();
        (100.0 * self.pressure_hpa - vapour_pa) / (287.05 * kelvin) + vapour_pa / (461.5 * kelvin)
    }
}

/// The thrust constant of one rotor without its dimension, in both conventions.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct ThrustCoefficients {
    /// T / (ρ n² D⁴), n in turns per second.
    pub propeller: f64,
    /// T / (ρ A (ω R)²), A the disc's area.
    pub rotorcraft: f64,
    /// Air density that was used.
    pub density_kg_m3: f64,
}

impl ThrustCoefficients {
    /// From the constant of one rotor.
    pub fn of_rotor(thrust_constant_n_s2: f64, propeller_diameter_m: f64, density_kg_m3: f64) -> Self {
        let radius_m = propeller_diameter_m / 2.0;
        Self {
            propeller: thrust_constant_n_s2 * TAU.powi(2) / (density_kg_m3 * propeller_diameter_m.powi(4)),
            rotorcraft: thrust_constant_n_s2 / (density_kg_m3 * PI * radius_m.powi(4)),
            density_kg_m3,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gravity_at_known_places() {
        for (latitude_deg, height_m, expected) in [(-20.32, 5.0, 9.7865), (-20.76, 650.0, 9.7848), (52.0, 0.0, 9.8125)]
        {
            assert!((gravity_m_s2(latitude_deg, height_m) - expected).abs() < 1e-4);
        }
    }

    #[test]
    fn air_at_sea_level_and_on_a_humid_day() {
        let standard = Air { temperature_c: 15.0, pressure_hpa: 1013.25, humidity_percent: 0.0 };
        assert!((standard.density_kg_m3() - 1.225).abs() < 5e-4);
        let humid = Air { temperature_c: 25.0, pressure_hpa: 1013.25, humidity_percent: 75.0 };
        assert!((humid.density_kg_m3() - 1.173).abs() < 2e-3);
    }

    #[test]
    fn the_two_conventions_differ_by_pi_cubed_over_four() {
        let both = ThrustCoefficients::of_rotor(7.08e-6, 0.2, 1.225);
        assert!((both.propeller / both.rotorcraft - PI.powi(3) / 4.0).abs() < 1e-12);
        assert!((both.propeller - 0.143).abs() < 5e-4);
    }
}
