//! Fourth subsystem, second half: the rigid body, Newton-Euler in body axes.
//!
//! ```text
//! x' = v        m v' = R F + (0, 0, -m g)        q' = q ⊗ (0, Ω)/2        I Ω' = τ - Ω × I Ω
//! ```
//!
//! World z up; force F and torque τ about the centre of mass in body axes; I any symmetric inertia. The authors' code
//! treats torques as generalised torques of the Euler angles and has a mistake in its Coriolis matrix; this module does
//! neither.

mod attitude;
mod contact;

pub use attitude::Euler;
pub(crate) use attitude::{normalised, rotation};
pub use contact::GroundContact;

use crate::forces::Wrench;
use crate::rk4::rk4;
use nalgebra::{Matrix3, Vector3};

/// Length of [`BodyState::to_array`].
pub const BODY_NUMBERS: usize = 13;

/// Position, velocity, attitude and rates of the body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct BodyState {
    /// Centre of mass, world axes, m.
    pub position_m: Vector3<f64>,
    /// Its velocity, world axes, m/s.
    pub velocity_m_s: Vector3<f64>,
    /// Body to world, unit quaternion, scalar first.
    pub attitude: [f64; 4],
    /// Ω, body axes, rad/s.
    pub rates_rad_s: Vector3<f64>,
}

impl BodyState {
    /// At rest and level at a place.
    pub fn at_rest(position_m: [f64; 3]) -> Self {
        Self {
            position_m: position_m.into(),
            velocity_m_s: Vector3::zeros(),
            attitude: [1.0, 0.0, 0.0, 0.0],
            rates_rad_s: Vector3::zeros(),
        }
    }

    /// Position, velocity, attitude, rates.
    pub fn to_array(&self) -> [f64; BODY_NUMBERS] {
        let (x, v, q, rates) = (&self.position_m, &self.velocity_m_s, &self.attitude, &self.rates_rad_s);
        [x.x, x.y, x.z, v.x, v.y, v.z, q[0], q[1], q[2], q[3], rates.x, rates.y, rates.z]
    }

    /// The inverse of [`BodyState::to_array`]; does not normalise the attitude.
    pub fn from_array(numbers: &[f64; BODY_NUMBERS]) -> Self {
        let [x, y, z, u, v, w, q0, q1, q2, q3, p, q, r] = *numbers;
        Self {
            position_m: Vector3::new(x, y, z),
            velocity_m_s: Vector3::new(u, v, w),
            attitude: [q0, q1, q2, q3],
            rates_rad_s: Vector3::new(p, q, r),
        }
    }

    /// Rotation matrix, body to world. The quaternion may have any length except zero.
    pub fn rotation(&self) -> Matrix3<f64> {
        rotation(&self.attitude)
    }

    /// A body vector in world axes.
    pub fn to_world(&self, body: &Vector3<f64>) -> Vector3<f64> {
        self.rotation() * body
    }
}

/// A rigid body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidBody {
    mass_kg: f64,
    inertia_kg_m2: Matrix3<f64>,
    inverse_inertia: Matrix3<f64>,
    gravity_m_s2: f64,
}

impl RigidBody {
    /// A body of this mass and of this inertia about its centre of mass, in a gravity along -z. `None` when the inertia has no
    /// inverse or the mass is not above 0.
    pub fn new(mass_kg: f64, inertia_kg_m2: Matrix3<f64>, gravity_m_s2: f64) -> Option<Self> {
        let inverse_inertia = inertia_kg_m2.try_inverse().filter(|_| mass_kg > 0.0)?;
        Some(Self { mass_kg, inertia_kg_m2, inverse_inertia, gravity_m_s2 })
    }

    /// m, kg.
    pub fn mass_kg(&self) -> f64 {
        self.mass_kg
    }

    /// I, kg m².
    pub fn inertia_kg_m2(&self) -> &Matrix3<f64> {
        &self.inertia_kg_m2
    }

    /// m g, N.
    pub fn weight_n(&self) -> f64 {
        self.mass_kg * self.gravity_m_s2
    }

    /// The time derivative under a force and a torque in body axes, in the order of [`BodyState::to_array`].
    pub fn rate(&self, state: &BodyState, rotation: &Matrix3<f64>, wrench: &Wrench) -> [f64; BODY_NUMBERS] {
        let mut acceleration = rotation * wrench.force_n / self.mass_kg;
        acceleration.z -= self.gravity_m_s2;
        let rates = &state.rates_rad_s;
        let turning = self.inverse_inertia * (wrench.torque_n_m - rates.cross(&(self.inertia_kg_m2 * rates)));
        let [q0, q1, q2, q3] = attitude::attitude_rate(&state.attitude, rates);
        let (v, a) = (&state.velocity_m_s, &acceleration);
        [v.x, v.y, v.z, a.x, a.y, a.z, q0, q1, q2, q3, turning.x, turning.y, turning.z]
    }

    /// One Runge-Kutta step; `wrench` gives force and torque for each intermediate state. The new attitude is normalised.
    pub fn step(&self, state: &BodyState, step_s: f64, wrench: impl Fn(&BodyState) -> Wrench) -> BodyState {
        let next = rk4(&state.to_array(), step_s, |numbers| {
            let state = BodyState::from_array(numbers);
            self.rate(&state, &rotation(&state.attitude), &wrench(&state))
        });
        let mut next = BodyState::from_array(&next);
        next.attitude = normalised(next.attitude);
        next
    }

    /// Kinetic energy of translation and rotation, J.
    pub fn kinetic_energy_j(&self, state: &BodyState) -> f64 {
        let turning = state.rates_rad_s.dot(&(self.inertia_kg_m2 * state.rates_rad_s));
        0.5 * (self.mass_kg * state.velocity_m_s.norm_squared() + turning)
    }

    /// Potential energy above z = 0, J.
    pub fn potential_energy_j(&self, state: &BodyState) -> f64 {
        self.weight_n() * state.position_m.z
    }

    /// R I Ω: angular momentum about the centre of mass, world axes, kg m²/s.
    pub fn angular_momentum(&self, state: &BodyState) -> Vector3<f64> {
        state.to_world(&(self.inertia_kg_m2 * state.rates_rad_s))
    }
}

#[cfg(test)]
mod tests;
