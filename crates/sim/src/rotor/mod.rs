//! Third subsystem, eqs 3 and 4: from rotor speed to thrust and load torque.

mod ground_effect;

pub use ground_effect::ground_effect;

/// One rotor in the present air.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rotor {
    /// C_f, N s²: the vehicle's, times the rotor's own share and the density's.
    pub thrust_constant_n_s2: f64,
    /// C_τ, N m s²: the vehicle's, times the density's share.
    pub torque_constant_n_m_s2: f64,
    /// Radius of the disc, m.
    pub radius_m: f64,
}

impl Rotor {
    /// f = C_f ω², N (eq 3), far from the ground.
    pub fn thrust_n(&self, speed_rad_s: f64) -> f64 {
        self.thrust_constant_n_s2 * speed_rad_s * speed_rad_s
    }

    /// τ_l = C_τ ω², N m (eq 4), against the sense of turning.
    pub fn load_torque_n_m(&self, speed_rad_s: f64) -> f64 {
        self.torque_constant_n_m_s2 * speed_rad_s * speed_rad_s
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone_vehicle::find_flight_parameters;

    /// The paper's three loads at its speeds: 413, 444 and 462 g on 2.831e-5 N s² of the whole vehicle.
    #[test]
    fn the_papers_speeds_carry_the_papers_loads() {
        let parameters = find_flight_parameters("ardrone").unwrap();
        let rotor = Rotor {
            thrust_constant_n_s2: parameters.rotor.thrust_constant_n_s2.value,
            torque_constant_n_m_s2: parameters.rotor.torque_constant_n_m_s2.value,
            radius_m: parameters.rotor.radius_m.value,
        };
        assert_eq!(4.0 * rotor.thrust_constant_n_s2, 2.831e-5);
        for load in &crate::paper::LOADS {
            let weight_n = load.mass_kg * crate::paper::GRAVITY_M_S2;
            let ratio = 4.0 * rotor.thrust_n(load.speed().rad_s()) / weight_n;
            // Thrust is proportional to the square of the speed: 0.2 % of the speed is 0.4 % of the thrust.
            assert!((ratio - 1.0).abs() < 0.004, "{}: {ratio}", load.name);
        }
        assert!((rotor.load_torque_n_m(378.07) - 0.030_46).abs() < 1e-5);
    }
}
