//! Parameters of a flight model: inertia, rotors, motors, battery, embedded controller.
//!
//! The symbols are those of section 3 of the paper (Pizetta et al., preprints201808.0313 v1). Every number has its source, which says
//! where it is an estimate. To override one, write `parameters.mass_kg.value = 0.444`.

mod axis;
mod presets;

pub use axis::Axis;
pub use presets::{find_flight_parameters, flight_preset_names, flight_presets};

use crate::{QuantityError, Sourced, Vehicle};
use serde::Serialize;

/// Positions of the four rotors, seen from above with the nose (x) ahead and y to the left. Rotors 1 and 3 turn clockwise, 2 and 4
/// counter-clockwise, as the signs of the mixer in eq 1 of the paper require.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Layout {
    /// Arms at 45° to the axes (remark 2 of the paper): 1 front left, 2 rear left, 3 rear right, 4 front right.
    X,
    /// Arms along the axes: 1 front, 2 left, 3 rear, 4 right.
    Plus,
}

impl Layout {
    /// Directions of the hubs from the centre, as unit vectors (x forward, y left).
    pub fn hub_directions(self) -> [[f64; 2]; 4] {
        /// Cosine and sine of 45°. *Physics.*
        const D: f64 = std::f64::consts::FRAC_1_SQRT_2;
        match self {
            Self::X => [[D, D], [-D, D], [-D, -D], [D, -D]],
            Self::Plus => [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]],
        }
    }

    /// Directions of rotation seen from above: +1 counter-clockwise, -1 clockwise.
    pub fn spins(self) -> [f64; 4] {
        [-1.0, 1.0, -1.0, 1.0]
    }
}

/// Aerodynamics of one rotor, eqs 3 and 4 of the paper: f = C_f ω², τ_l = C_τ ω², with the speed ω and the torque τ_l at the shaft of
/// the rotor.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RotorParameters {
    /// C_f of one rotor, N s².
    pub thrust_constant_n_s2: Sourced<f64>,
    /// C_τ of one rotor, N m s².
    pub torque_constant_n_m_s2: Sourced<f64>,
    /// Radius of the disc, for the ground effect only.
    pub radius_m: Sourced<f64>,
    /// Density of the air to which both constants belong; used only where a scenario sets the air.
    pub air_density_kg_m3: Sourced<f64>,
}

/// One DC motor with its gear, eq 2 of the paper in SI units, in which k_m = k_b (N m/A equals V s/rad):
/// R J/k · ω_m' + (R B/k + k) ω_m = v − R/(r k) · τ_l, with the speed of the motor's shaft ω_m = r ω.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct MotorParameters {
    /// R, ohm.
    pub resistance_ohm: Sourced<f64>,
    /// k_m = k_b, at the motor's shaft.
    pub constant_v_s_rad: Sourced<f64>,
    /// B_m, viscous loss at the motor's shaft.
    pub viscous_n_m_s: Sourced<f64>,
    /// J_m, inertia of all rotating parts at the motor's shaft: armature plus rotor inertia over r².
    pub inertia_kg_m2: Sourced<f64>,
    /// Inertia of the parts that turn with the rotor, about the rotor's shaft. The gyroscopic torque needs it alone, since the armature
    /// of a geared motor turns in the opposite direction. Equal to `inertia_kg_m2` for direct drive.
    pub rotor_inertia_kg_m2: Sourced<f64>,
    /// r, motor turns per rotor turn; 1 for direct drive.
    pub gear_ratio: Sourced<f64>,
}

/// The battery. Without voltage sag only the nominal voltage matters.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BatteryParameters {
    /// Voltage limit of the motors: the nominal voltage.
    pub voltage_v: Sourced<f64>,
    /// Open-circuit voltage when full.
    pub full_v: Sourced<f64>,
    /// Open-circuit voltage when the capacity is used up.
    pub empty_v: Sourced<f64>,
    /// Charge between full and empty, ampere hours.
    pub capacity_a_h: Sourced<f64>,
    /// Internal resistance including leads.
    pub resistance_ohm: Sourced<f64>,
}

/// One loop of eq 1 of the paper: Δv = k_p e + k_d de/dt, limited smoothly to ±limit by a tanh as in the code of the authors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LoopGains {
    /// k_p, volts per rad (roll, pitch), per rad/s (yaw rate), per m/s (vertical rate).
    pub proportional: f64,
    /// k_d, volts per unit of the derivative of the error.
    pub derivative: f64,
    /// Largest output of the loop, volts.
    pub limit_v: f64,
}

/// The embedded low-level controller, eq 1 and remark 1 of the paper.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ControllerParameters {
    /// Time between two runs of the controller, in which the voltages are constant.
    pub period_s: Sourced<f64>,
    /// Time constant of the filter on the derivatives of the two rate errors.
    pub derivative_filter_s: Sourced<f64>,
    /// Roll.
    pub roll: Sourced<LoopGains>,
    /// Pitch.
    pub pitch: Sourced<LoopGains>,
    /// Yaw rate.
    pub yaw_rate: Sourced<LoopGains>,
    /// Vertical rate.
    pub climb: Sourced<LoopGains>,
    /// φ_max and θ_max: roll and pitch at a command of 1.
    pub tilt_rad_max: Sourced<f64>,
    /// Yaw rate at a command of 1.
    pub yaw_rate_rad_s_max: Sourced<f64>,
    /// Vertical rate at a command of 1.
    pub climb_m_s_max: Sourced<f64>,
}

/// All parameters of the flight model of a vehicle with four rotors.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FlightParameters {
    /// The [`Vehicle::id`] of the vehicle.
    pub id: &'static str,
    /// Take-off mass with battery.
    pub mass_kg: Sourced<f64>,
    /// Ixx, Iyy, Izz about the centre of mass, body axes.
    pub inertia_kg_m2: Sourced<[f64; 3]>,
    /// Positions of the rotors.
    pub layout: Sourced<Layout>,
    /// Distance from the centre to a rotor's shaft. The lever of an X layout is this length over √2.
    pub arm_length_m: Sourced<f64>,
    /// Height of the centre of mass and of the plane of the rotors when the vehicle stands on the ground.
    pub standing_height_m: Sourced<f64>,
    /// Linear drag along the axes of the body: force per airspeed.
    pub drag_n_s_m: Sourced<[f64; 3]>,
    /// Each of the rotors.
    pub rotor: RotorParameters,
    /// Each of the motors.
    pub motor: MotorParameters,
    /// The battery.
    pub battery: BatteryParameters,
    /// The embedded controller.
    pub controller: ControllerParameters,
}

impl Vehicle {
    /// Its flight parameters, where enough sources were found.
    pub fn flight_parameters(&self) -> Option<&'static FlightParameters> {
        find_flight_parameters(self.id)
    }
}

impl FlightParameters {
    /// Every number with its name in files; vectors have one entry per axis.
    pub fn numbers(&self) -> Vec<(&'static str, Sourced<f64>)> {
        let axis = |of: &Sourced<[f64; 3]>, k: usize| Sourced { value: of.value[k], source: of.source };
        let (rotor, motor, battery, control) = (&self.rotor, &self.motor, &self.battery, &self.controller);
        let mut numbers = vec![
            ("mass_kg", self.mass_kg),
            ("inertia_xx_kg_m2", axis(&self.inertia_kg_m2, 0)),
            ("inertia_yy_kg_m2", axis(&self.inertia_kg_m2, 1)),
            ("inertia_zz_kg_m2", axis(&self.inertia_kg_m2, 2)),
            ("arm_length_m", self.arm_length_m),
            ("standing_height_m", self.standing_height_m),
            ("drag_x_n_s_m", axis(&self.drag_n_s_m, 0)),
            ("drag_y_n_s_m", axis(&self.drag_n_s_m, 1)),
            ("drag_z_n_s_m", axis(&self.drag_n_s_m, 2)),
            ("thrust_constant_n_s2", rotor.thrust_constant_n_s2),
            ("torque_constant_n_m_s2", rotor.torque_constant_n_m_s2),
            ("radius_m", rotor.radius_m),
            ("air_density_kg_m3", rotor.air_density_kg_m3),
            ("resistance_ohm", motor.resistance_ohm),
            ("constant_v_s_rad", motor.constant_v_s_rad),
            ("viscous_n_m_s", motor.viscous_n_m_s),
            ("inertia_kg_m2", motor.inertia_kg_m2),
            ("rotor_inertia_kg_m2", motor.rotor_inertia_kg_m2),
            ("gear_ratio", motor.gear_ratio),
            ("battery_voltage_v", battery.voltage_v),
            ("battery_full_v", battery.full_v),
            ("battery_empty_v", battery.empty_v),
            ("battery_capacity_a_h", battery.capacity_a_h),
            ("battery_resistance_ohm", battery.resistance_ohm),
            ("controller_period_s", control.period_s),
            ("derivative_filter_s", control.derivative_filter_s),
            ("tilt_rad_max", control.tilt_rad_max),
            ("yaw_rate_rad_s_max", control.yaw_rate_rad_s_max),
            ("climb_m_s_max", control.climb_m_s_max),
        ];
        for (name, gains) in
            [("roll", control.roll), ("pitch", control.pitch), ("yaw_rate", control.yaw_rate), ("climb", control.climb)]
        {
            let of = |value| Sourced { value, source: gains.source };
            numbers.push((name, of(gains.value.proportional)));
            numbers.push((name, of(gains.value.derivative)));
            numbers.push((name, of(gains.value.limit_v)));
        }
        numbers
    }

    /// Checks that no number is negative, and that divisors are not zero.
    ///
    /// # Errors
    /// The first number that fails, by its name.
    pub fn check(&self) -> Result<(), QuantityError> {
        const MAY_BE_ZERO: [&str; 12] = [
            "drag_x_n_s_m",
            "drag_y_n_s_m",
            "drag_z_n_s_m",
            "torque_constant_n_m_s2",
            "viscous_n_m_s",
            "rotor_inertia_kg_m2",
            "battery_resistance_ohm",
            "roll",
            "pitch",
            "yaw_rate",
            "climb",
            "derivative_filter_s",
        ];
        for (name, number) in self.numbers() {
            let value = number.value;
            let may_be_zero = MAY_BE_ZERO.contains(&name);
            if !value.is_finite() || value < 0.0 || (value == 0.0 && !may_be_zero) {
                let must_be = if may_be_zero { "0 or above" } else { "above 0" };
                return Err(QuantityError { name, value, must_be });
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
