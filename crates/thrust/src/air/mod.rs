//! The air that the rotors turned in, and its density.

mod dimensionless;
mod gravity;

pub use dimensionless::{ThrustCoefficients, figure_of_merit, is_plausible_merit, torque_constant_n_m_s2};
pub use gravity::{Gravity, gravity_m_s2, thrust_constant_n_s2};

use hovertone_vehicle::ConfigError;
use hovertone_vehicle::check_range;
use serde::{Deserialize, Serialize};

/// 0 °C.
const KELVIN_AT_0_C: f64 = 273.15;
/// Molar gas constant, J/(mol K), as the CIPM-2007 formula has it.
const GAS_CONSTANT: f64 = 8.314472;
/// Molar masses of dry air (400 ppm carbon dioxide) and of water, kg/mol.
const MOLAR_MASS_DRY_KG: f64 = 28.96546e-3;
const MOLAR_MASS_WATER_KG: f64 = 18.01528e-3;

/// The air that the rotors turned in. Where no pressure is given the standard atmosphere at the height has it, where no
/// temperature is given also that.
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
    /// What is wrong with it, by name, value and limit: air that one can fly in, so that pascals, kelvins and shares are
    /// told from hectopascals, degrees and per cent.
    ///
    /// # Errors
    /// The first number that is outside of its limits.
    pub fn check(&self) -> Result<(), ConfigError> {
        let given =
            |name, value: Option<f64>, min, max| value.map_or(Ok(()), |value| check_range(name, value, min, max));
        given("temperature_c", self.temperature_c, -60.0, 60.0)?;
        given("pressure_hpa", self.pressure_hpa, 300.0, 1100.0)?;
        given("height_m", self.height_m, -450.0, 9000.0)?;
        check_range("humidity_percent", self.humidity_percent, 0.0, 100.0)
    }

    /// Density by the CIPM-2007 formula (Picard, Davis, Gläser and Fujii, Metrologia 45, 149, 2008): exact to 2e-5 from 15 to
    /// 27 °C and 600 to 1100 hPa, and within 0.1 % wherever one can fly. With height alone, that of the standard atmosphere
    /// (ISO 2533), which weather moves by 2 %.
    pub fn density_kg_m3(&self) -> f64 {
        let height_m = self.height_m.unwrap_or(0.0);
        let temperature_c = self.temperature_c.unwrap_or(15.0 - 0.0065 * height_m);
        let standard_hpa = || 1013.25 * (1.0 - 2.25577e-5 * height_m).powf(5.25588);
        let pressure_pa = 100.0 * self.pressure_hpa.unwrap_or_else(standard_hpa);
        cipm_2007_kg_m3(temperature_c, pressure_pa, self.humidity_percent / 100.0)
    }
}

/// ρ = p M_a / (Z R T) · (1 − x_v (1 − M_v/M_a)).
fn cipm_2007_kg_m3(temperature_c: f64, pressure_pa: f64, humidity_share: f64) -> f64 {
    let kelvin = temperature_c + KELVIN_AT_0_C;
    let saturation_pa =
        (1.2378847e-5 * kelvin.powi(2) - 1.9121316e-2 * kelvin + 33.93711047 - 6.3431645e3 / kelvin).exp();
    let enhancement = 1.00062 + 3.14e-8 * pressure_pa + 5.6e-7 * temperature_c.powi(2);
    let vapour = humidity_share * enhancement * saturation_pa / pressure_pa;
    let compressibility = 1.0
        - pressure_pa / kelvin
            * (1.58123e-6 - 2.9331e-8 * temperature_c
                + 1.1043e-10 * temperature_c.powi(2)
                + (5.707e-6 - 2.051e-8 * temperature_c) * vapour
                + (1.9898e-4 - 2.376e-6 * temperature_c) * vapour.powi(2))
        + (pressure_pa / kelvin).powi(2) * (1.83e-11 - 0.765e-8 * vapour.powi(2));
    pressure_pa * MOLAR_MASS_DRY_KG / (compressibility * GAS_CONSTANT * kelvin)
        * (1.0 - vapour * (1.0 - MOLAR_MASS_WATER_KG / MOLAR_MASS_DRY_KG))
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
        // standard atmosphere, whose dry air is 0.004 % lighter and ideal
        assert!((density(15.0, 1013.25, 0.0) / 1.2250 - 1.0).abs() < 1e-3);
        // an independent program with real-gas equations of its own (Psychro for Julia: 1.20448 dry, 1.19714 at 70 %)
        assert!((density(20.0, 1013.25, 0.0) / 1.204478 - 1.0).abs() < 5e-4);
        assert!((density(20.0, 1013.25, 70.0) / 1.197144 - 1.0).abs() < 5e-4);
        // the ideal gas with Magnus' vapour pressure, on a humid day in Vitória
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
