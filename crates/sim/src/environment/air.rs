//! Density of moist air.

use hovertone_vehicle::QuantityError;

/// Gas constant of dry air, J/(kg K).
const DRY_J_KG_K: f64 = 287.05;
/// Gas constant of water vapour, J/(kg K).
const VAPOUR_J_KG_K: f64 = 461.5;
const ZERO_CELSIUS_K: f64 = 273.15;

/// The air, as a weather station reports it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Air {
    /// Temperature.
    pub temperature_c: f64,
    /// Pressure at the place, not reduced to sea level.
    pub pressure_hpa: f64,
    /// Relative humidity, 0 to 100.
    pub humidity_percent: f64,
}

impl Air {
    /// Dry, 15 °C, 1013.25 hPa: 1.225 kg/m³ (ISO 2533).
    pub const STANDARD: Self = Self { temperature_c: 15.0, pressure_hpa: 1013.25, humidity_percent: 0.0 };

    /// Density, kg/m³: (p - e)/(287.05 T) + e/(461.5 T), with the vapour's pressure e in Pa from the Magnus formula, RH
    /// · 611.2 · exp(17.62 t/(243.12 + t)).
    pub fn density_kg_m3(&self) -> f64 {
        let (celsius, kelvin) = (self.temperature_c, self.temperature_c + ZERO_CELSIUS_K);
        let saturated_pa = 611.2 * (17.62 * celsius / (243.12 + celsius)).exp();
        let vapour_pa = self.humidity_percent / 100.0 * saturated_pa;
        (100.0 * self.pressure_hpa - vapour_pa) / (DRY_J_KG_K * kelvin) + vapour_pa / (VAPOUR_J_KG_K * kelvin)
    }

    pub(crate) fn check(&self) -> Result<(), QuantityError> {
        let refused = |name, value, must_be| Err(QuantityError { name, value, must_be });
        if !(-60.0..=60.0).contains(&self.temperature_c) {
            return refused("temperature_c", self.temperature_c, "between -60 and 60");
        }
        if !(200.0..=1200.0).contains(&self.pressure_hpa) {
            return refused("pressure_hpa", self.pressure_hpa, "between 200 and 1200");
        }
        if !(0.0..=100.0).contains(&self.humidity_percent) {
            return refused("humidity_percent", self.humidity_percent, "between 0 and 100");
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn known_densities() {
        let density = |temperature_c, pressure_hpa, humidity_percent| {
            Air { temperature_c, pressure_hpa, humidity_percent }.density_kg_m3()
        };
        assert!((Air::STANDARD.density_kg_m3() - 1.225).abs() < 5e-5);
        // Dry air at 20 °C and 0 °C from tables; moist air is lighter than dry air.
        assert!((density(20.0, 1013.25, 0.0) - 1.2041).abs() < 1e-4);
        assert!((density(0.0, 1013.25, 0.0) - 1.2922).abs() < 2e-4);
        // Vitória: 25 °C, relative humidity 75 %.
        assert!((density(25.0, 1013.25, 75.0) - 1.173).abs() < 2e-3);
        assert!(density(25.0, 1013.25, 100.0) < density(25.0, 1013.25, 0.0));
    }
}
