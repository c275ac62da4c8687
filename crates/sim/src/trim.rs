//! The hover of a vehicle, solved exactly.

use crate::airframe::Airframe;
use crate::rotor::ground_effect;
use hovertone_vehicle::QuantityError;
use nalgebra::{Matrix4, Vector4};

/// The speeds at which the vehicle hovers level in still air, and the voltages that hold these speeds: the paper's v_o
/// (remark 3), one for each rotor, since rotors may differ.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HoverTrim {
    /// ω of each rotor, rad/s.
    pub speed_rad_s: [f64; 4],
    /// v_o of each motor, V.
    pub voltage_v: [f64; 4],
    /// f of each rotor, N; the sum is the weight.
    pub thrust_n: [f64; 4],
}

impl HoverTrim {
    /// Mean of the four speeds, rad/s: √(m g/4 C_f) when the rotors are alike.
    pub fn mean_speed_rad_s(&self) -> f64 {
        self.speed_rad_s.iter().sum::<f64>() / 4.0
    }
}

/// Name of the voltage that a hover needs, where it is more than that of the battery: the vehicle is too heavy.
pub const HOVER_VOLTAGE: &str = "hover voltage";

/// Solves for hover with the centre of mass `height_m` above the ground: thrust equals weight, and no torque about any
/// axis. These are four linear equations for the four ω², so the solution is exact. Fails if a rotor would have to
/// turn backwards, or if a motor needs more than `battery_v`.
pub fn hover_trim(airframe: &Airframe, height_m: f64, battery_v: f64) -> Result<HoverTrim, QuantityError> {
    let mut columns = [Vector4::zeros(); 4];
    let mut lift = [0.0; 4];
    for k in 0..4 {
        let (hub, rotor) = (&airframe.hubs[k], &airframe.rotors[k]);
        let share =
            if airframe.has_ground_effect { ground_effect(rotor.radius_m, height_m + hub.position_m.z) } else { 1.0 };
        lift[k] = share * rotor.thrust_constant_n_s2;
        // Without load torques the yaw equation is empty; then a load torque proportional to the thrust is assumed.
        let load = if rotor.torque_constant_n_m_s2 > 0.0 { rotor.torque_constant_n_m_s2 } else { lift[k] };
        columns[k] = Vector4::new(lift[k], hub.position_m.y * lift[k], -hub.position_m.x * lift[k], -hub.spin * load);
    }
    let wanted = Vector4::new(airframe.body.weight_n(), 0.0, 0.0, 0.0);
    let none = QuantityError { name: "hover", value: f64::NAN, must_be: "possible with these rotors" };
    // The rows have very different sizes (N, N m); scaling keeps the digits of the solution.
    let mut matrix = Matrix4::from_columns(&columns);
    for row in 0..4 {
        let size = (0..4).map(|k| matrix[(row, k)].abs()).fold(0.0, f64::max);
        let scale = if row == 0 { 1.0 } else { columns[0][0] / size };
        matrix.row_mut(row).scale_mut(scale);
    }
    let squares = matrix.lu().solve(&wanted).ok_or(none)?;
    let mut trim = HoverTrim { speed_rad_s: [0.0; 4], voltage_v: [0.0; 4], thrust_n: [0.0; 4] };
    for k in 0..4 {
        if squares[k].is_nan() || squares[k] <= 0.0 {
            return Err(QuantityError { name: "squared hover speed", value: squares[k], must_be: "above 0" });
        }
        trim.speed_rad_s[k] = squares[k].sqrt();
        trim.thrust_n[k] = lift[k] * squares[k];
        trim.voltage_v[k] = airframe.motors[k].steady_voltage_v(trim.speed_rad_s[k]);
        if trim.voltage_v[k] > battery_v {
            let must_be = "within the battery's voltage: the vehicle is too heavy to hover (masses are in kilograms)";
            let value = (1e3 * trim.voltage_v[k]).round() / 1e3;
            return Err(QuantityError { name: HOVER_VOLTAGE, value, must_be });
        }
    }
    Ok(trim)
}
