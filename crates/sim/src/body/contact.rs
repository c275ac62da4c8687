//! Standing on the ground: four feet on springs.

use crate::forces::Wrench;
use nalgebra::{Matrix3, Vector3};

/// Compression of the springs under the weight, as a share of the standing height: 2 mm of 0.1 m.
const SETTLING_SHARE: f64 = 0.02;
/// Damping of the vertical motion, as a share of the critical damping: the vehicle rests after a few bounces.
const DAMPING_SHARE: f64 = 0.7;
/// Friction coefficient of plastic on a floor.
const FRICTION: f64 = 0.5;
/// Slip speed at which friction has half its full size. At lower speeds friction acts as a stiff damper; this keeps steps of 1 ms stable.
const SLIP_M_S: f64 = 0.02;

/// Flat ground at z = 0 under four feet: springs and dampers along z that only push, friction across. Not in the paper.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GroundContact {
    feet_m: [Vector3<f64>; 4],
    stiffness_n_m: f64,
    damping_n_s_m: f64,
    reach_m: f64,
}

impl GroundContact {
    /// Feet at these places of the body, `standing_height_m` below it, for a vehicle of `mass_kg`. The weight compresses
    /// the springs by 2 % of that height.
    pub fn new(feet_m: [Vector3<f64>; 4], standing_height_m: f64, mass_kg: f64, gravity_m_s2: f64) -> Self {
        let whole_n_m = mass_kg * gravity_m_s2 / (SETTLING_SHARE * standing_height_m);
        let damping_n_s_m = 2.0 * DAMPING_SHARE * (whole_n_m * mass_kg).sqrt() / 4.0;
        let reach_m = feet_m.iter().map(|foot| foot.norm()).fold(0.0, f64::max);
        Self { feet_m, stiffness_n_m: whole_n_m / 4.0, damping_n_s_m, reach_m }
    }

    /// Height of the centre of mass at rest, m above the ground: the standing height minus the compression of the springs.
    pub fn resting_height_m(&self, weight_n: f64) -> f64 {
        let below_m: f64 = self.feet_m.iter().map(|foot| -foot.z).sum::<f64>() / 4.0;
        below_m - weight_n / (4.0 * self.stiffness_n_m)
    }

    /// Force and torque on the body, body axes; `None` when no foot can touch.
    pub fn wrench(
        &self,
        position_m: &Vector3<f64>,
        velocity_m_s: &Vector3<f64>,
        rotation: &Matrix3<f64>,
        rates_rad_s: &Vector3<f64>,
    ) -> Option<Wrench> {
        if position_m.z > self.reach_m {
            return None;
        }
        let (mut force, mut torque) = (Vector3::zeros(), Vector3::zeros());
        for foot in &self.feet_m {
            let depth_m = -(position_m + rotation * foot).z;
            if depth_m <= 0.0 {
                continue;
            }
            let speed = velocity_m_s + rotation * rates_rad_s.cross(foot);
            let normal_n = (self.stiffness_n_m * depth_m - self.damping_n_s_m * speed.z).max(0.0);
            let slip_m_s = speed.x.hypot(speed.y);
            let drag = -FRICTION * normal_n / (slip_m_s + SLIP_M_S);
            let at_foot = rotation.transpose() * Vector3::new(drag * speed.x, drag * speed.y, normal_n);
            force += at_foot;
            torque += foot.cross(&at_foot);
        }
        Some(Wrench { force_n: force, torque_n_m: torque })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{BodyState, Euler, RigidBody, rotation};

    fn dropped(state: BodyState, seconds: u32) -> (f64, f64, BodyState) {
        let body = RigidBody::new(0.413, Matrix3::from_diagonal(&Vector3::new(2.2e-3, 3.0e-3, 4.8e-3)), 9.8).unwrap();
        let feet = [[0.13, 0.13], [-0.13, 0.13], [-0.13, -0.13], [0.13, -0.13]];
        let contact = GroundContact::new(feet.map(|[x, y]| Vector3::new(x, y, -0.05)), 0.05, 0.413, 9.8);
        let energy = |state: &BodyState| body.kinetic_energy_j(state) + body.potential_energy_j(state);
        let (mut state, start_j, mut most_j, mut lowest_m) = (state, energy(&state), f64::MIN, f64::MAX);
        for _ in 0..seconds * 1000 {
            state = body.step(&state, 0.001, |s| {
                let wrench = contact.wrench(&s.position_m, &s.velocity_m_s, &rotation(&s.attitude), &s.rates_rad_s);
                wrench.unwrap_or(Wrench { force_n: Vector3::zeros(), torque_n_m: Vector3::zeros() })
            });
            most_j = most_j.max(energy(&state) - start_j);
            lowest_m = lowest_m.min(state.position_m.z);
        }
        assert!((state.position_m.z - contact.resting_height_m(body.weight_n())).abs() < 1e-6, "{state:?}");
        (most_j, lowest_m, state)
    }

    #[test]
    fn what_is_dropped_comes_to_rest_on_its_feet_and_gains_no_energy() {
        let (gained_j, lowest_m, state) = dropped(BodyState::at_rest([0.0, 0.0, 0.25]), 5);
        assert!(gained_j < 1e-6 && lowest_m > 0.0, "{gained_j} J, down to {lowest_m} m");
        assert!(state.velocity_m_s.norm() < 1e-6 && state.rates_rad_s.norm() < 1e-6);
    }

    #[test]
    fn a_tilted_sliding_landing_ends_flat_and_still() {
        let mut state = BodyState::at_rest([0.0, 0.0, 0.2]);
        state.velocity_m_s = Vector3::new(0.8, -0.3, 0.0);
        state.attitude = Euler { roll_rad: 0.2, pitch_rad: -0.15, yaw_rad: 1.0 }.attitude();
        let (gained_j, lowest_m, state) = dropped(state, 10);
        assert!(gained_j < 1e-6 && lowest_m > 0.0, "{gained_j} J, down to {lowest_m} m");
        let end = Euler::from_attitude(&state.attitude);
        assert!(end.roll_rad.abs() < 1e-6 && end.pitch_rad.abs() < 1e-6);
        assert!(state.velocity_m_s.norm() < 1e-3, "{}", state.velocity_m_s);
    }

    #[test]
    fn out_of_reach_there_is_no_contact() {
        let contact = GroundContact::new([Vector3::new(0.1, 0.0, -0.05); 4], 0.05, 0.4, 9.8);
        let still = Vector3::zeros();
        assert!(contact.wrench(&Vector3::new(0.0, 0.0, 0.2), &still, &Matrix3::identity(), &still).is_none());
        let flying = contact.wrench(&Vector3::new(0.0, 0.0, 0.06), &still, &Matrix3::identity(), &still).unwrap();
        assert_eq!(flying.force_n, still);
    }
}
