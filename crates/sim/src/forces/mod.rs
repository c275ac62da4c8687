//! Fourth subsystem, first half: from thrusts and load torques to one force and one torque on the body.
//!
//! Body axes: x forward, y left, z up. A thrust f at (x, y) turns the body by (y f, -x f, 0); the air holds a rotor
//! that turns counter-clockwise (spin +1) back with -τ_l about z, and the gear hands that to the body.

use hovertone_vehicle::{FlightParameters, Layout};
use nalgebra::Vector3;

/// Position and sense of rotation of a rotor on the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hub {
    /// From the centre of mass, body axes, m.
    pub position_m: Vector3<f64>,
    /// +1 counter-clockwise seen from above, -1 clockwise.
    pub spin: f64,
    /// Angular momentum along z for each rad/s of the rotor, of spin +1, kg m²: rotor and armature together. A pair
    /// of gears turns the armature the other way, r times as fast.
    pub momentum_kg_m2: f64,
}

/// Force and torque about the centre of mass, body axes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Wrench {
    /// N.
    pub force_n: Vector3<f64>,
    /// N m.
    pub torque_n_m: Vector3<f64>,
}

/// The four hubs of a vehicle whose centre of mass is shifted by `shift_m`.
pub fn hubs(parameters: &FlightParameters, shift_m: Vector3<f64>) -> [Hub; 4] {
    let (directions, spins) = (parameters.layout.value.hub_directions(), parameters.layout.value.spins());
    let motor = &parameters.motor;
    let (r, rotor_kg_m2) = (motor.gear_ratio.value, motor.rotor_inertia_kg_m2.value);
    let armature_kg_m2 = (motor.inertia_kg_m2.value - rotor_kg_m2 / (r * r)).max(0.0);
    let direction_of_armature = if r == 1.0 { 1.0 } else { -1.0 };
    let momentum_kg_m2 = rotor_kg_m2 + direction_of_armature * r * armature_kg_m2;
    let arm_m = parameters.arm_length_m.value;
    std::array::from_fn(|k| Hub {
        position_m: Vector3::new(arm_m * directions[k][0], arm_m * directions[k][1], 0.0) - shift_m,
        spin: spins[k],
        momentum_kg_m2,
    })
}

/// Sum of the rotors' thrusts and load torques.
pub fn rotor_wrench(hubs: &[Hub; 4], thrust_n: &[f64; 4], load_torque_n_m: &[f64; 4]) -> Wrench {
    let (mut force, mut torque) = (0.0, Vector3::zeros());
    for k in 0..4 {
        force += thrust_n[k];
        torque.x += hubs[k].position_m.y * thrust_n[k];
        torque.y -= hubs[k].position_m.x * thrust_n[k];
        torque.z -= hubs[k].spin * load_torque_n_m[k];
    }
    Wrench { force_n: Vector3::new(0.0, 0.0, force), torque_n_m: torque }
}

/// Gyroscopic torque of the rotors on the body: -Ω × h - dh/dt, with h = Σ spin · momentum · ω along z. The sum of h and
/// the body's own angular momentum is conserved when no torque acts from outside.
pub fn gyroscopic_torque_n_m(
    hubs: &[Hub; 4],
    rates_rad_s: &Vector3<f64>,
    speed_rad_s: &[f64; 4],
    acceleration_rad_s2: &[f64; 4],
) -> Vector3<f64> {
    let (mut momentum, mut change) = (0.0, 0.0);
    for k in 0..4 {
        let of_one = hubs[k].spin * hubs[k].momentum_kg_m2;
        momentum += of_one * speed_rad_s[k];
        change += of_one * acceleration_rad_s2[k];
    }
    Vector3::new(-rates_rad_s.y * momentum, rates_rad_s.x * momentum, -change)
}

/// The levers of a layout as the sign of each torque per thrust: +1, -1 or 0 for roll and pitch, and the sign of yaw
/// per load torque. The paper's mixer (eq 1) has the same signs.
pub fn torque_signs(layout: Layout) -> [[f64; 3]; 4] {
    let sign = |value: f64| if value.abs() < 1e-9 { 0.0 } else { value.signum() };
    let (directions, spins) = (layout.hub_directions(), layout.spins());
    std::array::from_fn(|k| [sign(directions[k][1]), -sign(directions[k][0]), -spins[k]])
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone_vehicle::find_flight_parameters;

    fn ardrone(layout: Layout) -> [Hub; 4] {
        let mut parameters = find_flight_parameters("ardrone").unwrap().clone();
        parameters.layout.value = layout;
        hubs(&parameters, Vector3::zeros())
    }

    /// The authors' matrix for the X layout, rows k1 [1 1 -1 -1], k1 [-1 1 1 -1], k2 [1 -1 1 -1], with the lever k1/√2
    /// of their remark 2.
    #[test]
    fn one_rotor_at_a_time_gives_the_authors_columns() {
        let hubs = ardrone(Layout::X);
        let lever = 0.1785 / 2.0_f64.sqrt();
        let expected = [[1.0, -1.0, 1.0], [1.0, 1.0, -1.0], [-1.0, 1.0, 1.0], [-1.0, -1.0, -1.0]];
        for k in 0..4 {
            let (mut thrust, mut load) = ([0.0; 4], [0.0; 4]);
            (thrust[k], load[k]) = (2.0, 0.06);
            let wrench = rotor_wrench(&hubs, &thrust, &load);
            assert_eq!(wrench.force_n, Vector3::new(0.0, 0.0, 2.0));
            let [roll, pitch, yaw] = expected[k];
            let torque = Vector3::new(2.0 * lever * roll, 2.0 * lever * pitch, 0.06 * yaw);
            assert!((wrench.torque_n_m - torque).norm() < 1e-15, "rotor {}", k + 1);
        }
        assert_eq!(torque_signs(Layout::X), expected);
    }

    #[test]
    fn on_a_plus_each_arm_has_one_axis_and_the_whole_lever() {
        let expected = [[0.0, -1.0, 1.0], [1.0, 0.0, -1.0], [0.0, 1.0, 1.0], [-1.0, 0.0, -1.0]];
        assert_eq!(torque_signs(Layout::Plus), expected);
        let wrench = rotor_wrench(&ardrone(Layout::Plus), &[0.0, 1.0, 0.0, 0.0], &[0.0; 4]);
        assert!((wrench.torque_n_m - Vector3::new(0.1785, 0.0, 0.0)).norm() < 1e-15);
    }

    #[test]
    fn a_gear_takes_the_armature_from_the_momentum_and_direct_drive_adds_it() {
        let geared = ardrone(Layout::X)[0].momentum_kg_m2;
        let armature = 2.307_775_73e-7 - 1.5e-5 / 8.625_f64.powi(2);
        assert!((geared - (1.5e-5 - 8.625 * armature)).abs() < 1e-15);
        let mut parameters = find_flight_parameters("crazyflie").unwrap().clone();
        assert!((hubs(&parameters, Vector3::zeros())[0].momentum_kg_m2 / 5.27e-8 - 1.0).abs() < 1e-12);
        parameters.motor.rotor_inertia_kg_m2.value = 3e-8;
        assert!((hubs(&parameters, Vector3::zeros())[0].momentum_kg_m2 / 5.27e-8 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn the_gyroscopic_torque_is_minus_the_change_of_the_rotors_momentum() {
        let hubs = ardrone(Layout::X);
        let (speed, acceleration) = ([300.0, 400.0, 350.0, 420.0], [10.0, -20.0, 5.0, 0.0]);
        let rates = Vector3::new(1.0, -2.0, 3.0);
        let along =
            |values: &[f64; 4]| -> f64 { (0..4).map(|k| hubs[k].spin * hubs[k].momentum_kg_m2 * values[k]).sum() };
        let momentum = Vector3::new(0.0, 0.0, along(&speed));
        let expected = -rates.cross(&momentum) - Vector3::new(0.0, 0.0, along(&acceleration));
        assert!((gyroscopic_torque_n_m(&hubs, &rates, &speed, &acceleration) - expected).norm() < 1e-15);
    }
}
