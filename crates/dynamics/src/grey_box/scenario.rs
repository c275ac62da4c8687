//! From rad/s to volts: the numbers that the simulator's scenario needs.

use super::fit::GreyBoxFit;
use super::parameters::{GreyBoxModel, LoopModel};
use hovertone_vehicle::{FlightParameters, LoopGains};

/// Eq 2 for the rotor's speed, c ω' + a ω + b ω² = v: what is known of the motor without a flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotorVolts {
    /// a.
    pub linear_v_s_rad: f64,
    /// b.
    pub load_v_s2_rad2: f64,
    /// c.
    pub inertia_v_s2_rad: f64,
}

impl MotorVolts {
    /// By the numbers of a vehicle.
    pub fn of(vehicle: &FlightParameters) -> Self {
        let (motor, rotor) = (&vehicle.motor, &vehicle.rotor);
        let (r, k, resistance) = (motor.gear_ratio.value, motor.constant_v_s_rad.value, motor.resistance_ohm.value);
        Self {
            linear_v_s_rad: r * (resistance * motor.viscous_n_m_s.value / k + k),
            load_v_s2_rad2: resistance * rotor.torque_constant_n_m_s2.value / (r * k),
            inertia_v_s2_rad: r * resistance * motor.inertia_kg_m2.value / k,
        }
    }

    /// s = a + 2 b ω: volts per rad/s about a speed.
    pub fn slope_v_s_rad(&self, speed_rad_s: f64) -> f64 {
        self.linear_v_s_rad + 2.0 * self.load_v_s2_rad2 * speed_rad_s
    }
}

impl GreyBoxFit {
    /// The gains of a loop in volts, with the slope of eq 2 at hover of this vehicle. `limit_v` is kept where the flight shows no limit.
    pub fn loop_gains(&self, of: &LoopModel, slope_v_s_rad: f64, limit_v: f64) -> LoopGains {
        let told_v = slope_v_s_rad / of.inverse_square_limit.sqrt();
        LoopGains {
            proportional: of.proportional.max(0.0) * slope_v_s_rad,
            derivative: of.derivative.max(0.0) * slope_v_s_rad,
            limit_v: if told_v.is_finite() { told_v } else { limit_v },
        }
    }

    /// The vehicle with what was identified: gains and limits of the controller, inertia of the motor by τ, and C_f by the weight over Σω². Returns
    /// it with the thrust share of each rotor, which makes the hover speeds unequal.
    pub fn vehicle(&self, of: &FlightParameters, weight_n: f64) -> IdentifiedVehicle {
        let model = &self.model;
        let speed = model.mean_hover_rad_s();
        let mut vehicle = of.clone();
        let slope = MotorVolts::of(of).slope_v_s_rad(speed);
        let controller = &mut vehicle.controller;
        let loops = [&mut controller.roll, &mut controller.pitch, &mut controller.yaw_rate, &mut controller.climb];
        for (gains, of) in loops.into_iter().zip(&model.loops) {
            gains.value = self.loop_gains(of, slope, gains.value.limit_v);
        }
        let motor = &mut vehicle.motor;
        let (r, k, resistance) = (motor.gear_ratio.value, motor.constant_v_s_rad.value, motor.resistance_ohm.value);
        motor.inertia_kg_m2.value = model.time_constant_s * slope * k / (r * resistance);
        let squares = model.hover_rad_s.map(|speed| speed * speed);
        vehicle.rotor.thrust_constant_n_s2.value = weight_n / squares.iter().sum::<f64>();
        let mean_square = squares.iter().sum::<f64>() / 4.0;
        IdentifiedVehicle { vehicle, thrust_shares: thrust_shares(model, mean_square), motor_gains: model.motor_gain }
    }
}

/// A vehicle with identified numbers.
#[derive(Clone, Debug, PartialEq)]
pub struct IdentifiedVehicle {
    /// Its numbers.
    pub vehicle: FlightParameters,
    /// C_f of each rotor over the mean of them: each rotor bears a quarter of the weight.
    pub thrust_shares: [f64; 4],
    /// Gain of each motor over their mean.
    pub motor_gains: [f64; 4],
}

fn thrust_shares(model: &GreyBoxModel, mean_square: f64) -> [f64; 4] {
    model.hover_rad_s.map(|speed| mean_square / (speed * speed))
}
