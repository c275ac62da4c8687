//! The battery: its voltage falls under load and with the charge used.

use hovertone_vehicle::BatteryParameters;

/// Coulombs in an ampere hour.
const A_H: f64 = 3600.0;

/// The open-circuit voltage falls linearly with the charge used; one resistance is in series. The controllers chop the
/// battery's voltage without loss: at a duty d the motor gets d V and the battery gives d times the motor's current.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Battery {
    nominal_v: f64,
    full_v: f64,
    slope_v_c: f64,
    resistance_ohm: f64,
}

impl Battery {
    pub(crate) fn new(parameters: &BatteryParameters) -> Self {
        let (full_v, empty_v) = (parameters.full_v.value, parameters.empty_v.value);
        Self {
            nominal_v: parameters.voltage_v.value,
            full_v,
            slope_v_c: (full_v - empty_v) / (A_H * parameters.capacity_a_h.value),
            resistance_ohm: parameters.resistance_ohm.value,
        }
    }

    /// The battery's voltage V when `used_c` coulombs are gone, for the duties d of the motors with their resistance,
    /// gains g and back-EMFs e: V = E - R_b Σ d (g d V - e)/R is linear in V.
    pub(crate) fn voltage_v(
        &self,
        used_c: f64,
        duties: &[f64; 4],
        gains: &[f64; 4],
        emf_v: &[f64; 4],
        ohm: f64,
    ) -> f64 {
        let share = self.resistance_ohm / ohm;
        let (mut load, mut back) = (1.0, self.full_v - self.slope_v_c * used_c);
        for k in 0..4 {
            load += share * gains[k] * duties[k] * duties[k];
            back += share * duties[k] * emf_v[k];
        }
        (back / load).max(0.0)
    }

    /// The demand, from a controller that assumes the nominal voltage, with which the full battery gives `volts` under a
    /// load of `load_w`: V² - E V + R P = 0.
    pub(crate) fn demand_v(&self, volts: f64, load_w: f64) -> f64 {
        let open_v = self.full_v;
        let under_load_v = 0.5 * (open_v + (open_v * open_v - 4.0 * self.resistance_ohm * load_w).max(0.0).sqrt());
        volts * self.nominal_v / under_load_v
    }

    /// Duty for a demand in volts, 0 to 1: the demand over the nominal voltage, since the controllers do not know the sag.
    pub(crate) fn duty(&self, demand_v: f64) -> f64 {
        demand_v / self.nominal_v
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone_vehicle::find_flight_parameters;

    #[test]
    fn voltage_current_and_charge_agree() {
        let parameters = &find_flight_parameters("ardrone").unwrap().battery;
        let battery = Battery::new(parameters);
        let (duties, gains, emf_v, ohm) = ([0.7, 0.72, 0.68, 0.71], [1.0, 1.01, 1.0, 0.99], [6.9, 7.0, 6.8, 7.0], 0.6);
        for used_c in [0.0, 3600.0, 7200.0] {
            let volts = battery.voltage_v(used_c, &duties, &gains, &emf_v, ohm);
            let amperes: f64 = (0..4).map(|k| duties[k] * (gains[k] * duties[k] * volts - emf_v[k]) / ohm).sum();
            let open_v = 12.6 - 2.1 * used_c / 7200.0;
            assert!((open_v - 0.08 * amperes - volts).abs() < 1e-12);
            assert!(amperes > 0.0);
        }
        assert_eq!(battery.voltage_v(0.0, &[0.0; 4], &gains, &emf_v, ohm), 12.6);
    }
}
