//! The air around the rotors and its density, local gravity, and the dimensionless thrust coefficients.

mod cipm_2007;
mod dimensionless;
mod gravity;

pub use dimensionless::{
    ThrustCoefficients, TorqueReading, figure_of_merit, is_plausible_merit, least_diameter_m, least_tip_mach,
    torque_constant_n_m_s2,
};
pub use gravity::{Gravity, check_gravity, check_latitude, gravity_m_s2, thrust_constant_n_s2};

use hovertone_vehicle::ConfigError;
use hovertone_vehicle::check_range;
use serde::{Deserialize, Serialize};
use std::ops::RangeInclusive;

/// Temperature of the standard atmosphere at sea level, °C (ISO 2533). *Physics.*
const STANDARD_TEMPERATURE_C: f64 = 15.0;
/// Decrease of the temperature with the height, K/m (ISO 2533). *Physics.*
const STANDARD_LAPSE_K_M: f64 = 0.0065;
/// Pressure of the standard atmosphere at sea level, hPa (ISO 2533). *Physics.*
const STANDARD_PRESSURE_HPA: f64 = 1013.25;
/// Lapse rate over the temperature at sea level, 0.0065/288.15 per metre (ISO 2533). *Physics.*
const STANDARD_LAPSE_SHARE_M: f64 = 2.25577e-5;
/// Exponent of the pressure in the temperature: gravity over gas constant of air and lapse rate (ISO 2533). *Physics.*
const STANDARD_EXPONENT: f64 = 5.25588;
/// Pascals in a hectopascal. *Physics.*
const PA_PER_HPA: f64 = 100.0;

/// Temperatures in which multirotors fly, °C. A value in kelvin lies outside. *Decision.*
const TEMPERATURE_C_ALLOWED: RangeInclusive<f64> = -60.0..=60.0;
/// Pressures in which multirotors fly, hPa. A value in pascals lies outside. *Decision.*
const PRESSURE_HPA_ALLOWED: RangeInclusive<f64> = 300.0..=1100.0;
/// Heights above the sea at which multirotors fly, m. *Decision.*
const HEIGHT_M_ALLOWED: RangeInclusive<f64> = -450.0..=9000.0;
/// Relative humidities, per cent. *Physics.*
const HUMIDITY_PERCENT_ALLOWED: RangeInclusive<f64> = 0.0..=100.0;

/// The air around the rotors. A missing pressure, and a missing temperature, come from the standard atmosphere at the height.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct Air {
    /// Temperature.
    pub temperature_c: Option<f64>,
    /// Pressure at the place, not reduced to sea level.
    pub pressure_hpa: Option<f64>,
    /// Relative humidity, 0 to 100; dry where absent.
    pub humidity_percent: f64,
    /// Height above the sea, in place of a pressure.
    pub height_m: Option<f64>,
}

impl Air {
    /// Checks that a multirotor can fly in this air. Values in pascals or kelvins lie outside.
    ///
    /// # Errors
    /// The first number outside of its limits, with its name, its value and the limits.
    pub fn check(&self) -> Result<(), ConfigError> {
        let within = |name, value: Option<f64>, allowed: RangeInclusive<f64>| {
            value.map_or(Ok(()), |value| check_range(name, value, *allowed.start(), *allowed.end()))
        };
        within("temperature_c", self.temperature_c, TEMPERATURE_C_ALLOWED)?;
        within("pressure_hpa", self.pressure_hpa, PRESSURE_HPA_ALLOWED)?;
        within("height_m", self.height_m, HEIGHT_M_ALLOWED)?;
        within("humidity_percent", Some(self.humidity_percent), HUMIDITY_PERCENT_ALLOWED)
    }

    /// Density by the CIPM-2007 formula (Picard, Davis, Gläser and Fujii, Metrologia 45, 149, 2008): exact to 2e-5 from 15 to
    /// 27 °C and 600 to 1100 hPa, and to 0.1 % in all air that [`Air::check`] allows. From the height alone it is the density of
    /// the standard atmosphere (ISO 2533), which weather changes by 2 %.
    pub fn density_kg_m3(&self) -> f64 {
        let height_m = self.height_m.unwrap_or(0.0);
        let temperature_c = self.temperature_c.unwrap_or(STANDARD_TEMPERATURE_C - STANDARD_LAPSE_K_M * height_m);
        let standard_hpa = || STANDARD_PRESSURE_HPA * (1.0 - STANDARD_LAPSE_SHARE_M * height_m).powf(STANDARD_EXPONENT);
        let pressure_pa = PA_PER_HPA * self.pressure_hpa.unwrap_or_else(standard_hpa);
        cipm_2007::density_kg_m3(temperature_c, pressure_pa, self.humidity_percent / 100.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn density(temperature_c: f64, pressure_hpa: f64, humidity_percent: f64) -> f64 {
        let pressure_hpa = Some(pressure_hpa);
        Air { temperature_c: Some(temperature_c), pressure_hpa, humidity_percent, height_m: None }.density_kg_m3()
    }

    #[test]
    fn density_of_known_airs() {
        // the standard atmosphere takes dry air as an ideal gas that is 0.004 % lighter
        assert!((density(15.0, 1013.25, 0.0) / 1.2250 - 1.0).abs() < 1e-3);
        // an independent program with other real-gas equations (Psychro for Julia: 1.20448 dry, 1.19714 at 70 %)
        assert!((density(20.0, 1013.25, 0.0) / 1.204478 - 1.0).abs() < 5e-4);
        assert!((density(20.0, 1013.25, 70.0) / 1.197144 - 1.0).abs() < 5e-4);
        // the ideal gas with the vapour pressure of the Magnus formula, on a humid day in Vitória
        let (kelvin, vapour_pa) = (298.15, 0.75 * 611.2 * (17.62f64 * 25.0 / 268.12).exp());
        let ideal = (101_325.0 - vapour_pa) / (287.05 * kelvin) + vapour_pa / (461.5 * kelvin);
        assert!((density(25.0, 1013.25, 75.0) / ideal - 1.0).abs() < 1e-3);
    }

    #[test]
    fn a_height_stands_for_the_pressure_and_the_temperature() {
        let vicosa = Air { height_m: Some(650.0), ..Air::default() };
        // ISO 2533 at 650 m: 937.6 hPa, 10.775 °C, 1.1503 kg/m³
        assert!((vicosa.density_kg_m3() / 1.1503 - 1.0).abs() < 1e-3, "{}", vicosa.density_kg_m3());
        let warm = Air { temperature_c: Some(22.0), ..vicosa };
        assert!((warm.density_kg_m3() / density(22.0, 937.6, 0.0) - 1.0).abs() < 1e-4);
        assert!(Air { pressure_hpa: Some(93_760.0), ..vicosa }.check().is_err());
    }
}
