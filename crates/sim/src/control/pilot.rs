//! The outer loop: holds a place, a height and a heading through the four commands, as the paper's height control and a
//! person with a joystick do. Not a part of the paper's model.

use super::controller::Command;
use crate::body::{BodyState, Euler};
use hovertone_vehicle::ControllerParameters;

/// The integrals grow only below this speed: while the vehicle flies to another place, its error says nothing about wind and battery.
const SETTLED_M_S: f64 = 0.1;
/// Gains of the integrals, as a share of the gains in a loop of three equal poles.
const INTEGRAL_SHARE: f64 = 0.2;

/// The place and heading to hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Setpoint {
    /// World axes, m.
    pub position_m: [f64; 3],
    /// Heading, rad, positive to the left of world x.
    pub yaw_rad: f64,
}

/// The pilot's gains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PilotGains {
    /// Bandwidth of the horizontal loop, rad/s: k_p is its square, k_d twice it, k_i a fifth of its cube.
    pub position_rad_s: f64,
    /// Commanded vertical rate per error of height, 1/s; the gain of its integral is a fifth of the square.
    pub height_1_s: f64,
    /// Commanded yaw rate per error of heading, 1/s.
    pub heading_1_s: f64,
    /// Overdrive of the attitude: commanded tilt beyond the wanted tilt, per error of tilt. It makes a sluggish drone quick.
    pub overdrive: f64,
    /// Reduction of the commanded tilt per rate of tilt, s: the damping of that overdrive.
    pub damping_s: f64,
}

/// The outer loop: its gains, the scales of the commands, and its integrals.
#[derive(Clone, Copy, Debug)]
pub struct Pilot {
    gains: PilotGains,
    gravity_m_s2: f64,
    period_s: f64,
    tilt_rad_max: f64,
    yaw_rate_rad_s_max: f64,
    climb_m_s_max: f64,
    setpoint: Setpoint,
    pushed_m_s2: [f64; 2],
    climbed_m_s: f64,
}

impl Pilot {
    /// A pilot of a vehicle with this embedded controller.
    pub fn new(gains: PilotGains, controller: &ControllerParameters, gravity_m_s2: f64, setpoint: Setpoint) -> Self {
        Self {
            gains,
            gravity_m_s2,
            period_s: controller.period_s.value,
            tilt_rad_max: controller.tilt_rad_max.value,
            yaw_rate_rad_s_max: controller.yaw_rate_rad_s_max.value,
            climb_m_s_max: controller.climb_m_s_max.value,
            setpoint,
            pushed_m_s2: [0.0; 2],
            climbed_m_s: 0.0,
        }
    }

    /// The present setpoint.
    pub fn setpoint(&self) -> Setpoint {
        self.setpoint
    }

    /// Sets another setpoint; keeps the integrals, which hold the effect of the wind.
    pub fn fly_to(&mut self, setpoint: Setpoint) {
        self.setpoint = setpoint;
    }

    /// The present commands. Call it once per controller period.
    pub fn command(&mut self, state: &BodyState) -> Command {
        let (gains, wanted) = (self.gains, self.setpoint);
        let omega = gains.position_rad_s;
        let angles = Euler::from_attitude(&state.attitude);
        let [roll_rate, pitch_rate, _] = angles.rates(&state.rates_rad_s);
        let largest_m_s2 = self.gravity_m_s2 * self.tilt_rad_max.tan();

        let mut wanted_m_s2 = [0.0; 2];
        for (axis, acceleration) in wanted_m_s2.iter_mut().enumerate() {
            let missing_m = wanted.position_m[axis] - state.position_m[axis];
            let direct = omega * omega * missing_m - 2.0 * omega * state.velocity_m_s[axis];
            if state.velocity_m_s[axis].abs() < SETTLED_M_S && direct.abs() < largest_m_s2 {
                self.pushed_m_s2[axis] += INTEGRAL_SHARE * omega.powi(3) * missing_m * self.period_s;
            }
            *acceleration = (direct + self.pushed_m_s2[axis]).clamp(-largest_m_s2, largest_m_s2);
        }
        let (sin, cos) = angles.yaw_rad.sin_cos();
        let forward = cos * wanted_m_s2[0] + sin * wanted_m_s2[1];
        let left = cos * wanted_m_s2[1] - sin * wanted_m_s2[0];
        let tilt = |wanted_rad: f64, tilt_rad: f64, rate: f64| {
            (wanted_rad + gains.overdrive * (wanted_rad - tilt_rad) - gains.damping_s * rate) / self.tilt_rad_max
        };

        let missing_m = wanted.position_m[2] - state.position_m.z;
        let direct_m_s = gains.height_1_s * missing_m;
        if state.velocity_m_s.z.abs() < SETTLED_M_S && direct_m_s.abs() < self.climb_m_s_max {
            self.climbed_m_s += INTEGRAL_SHARE * gains.height_1_s.powi(2) * missing_m * self.period_s;
        }
        let turn_rad = (wanted.yaw_rad - angles.yaw_rad).sin().atan2((wanted.yaw_rad - angles.yaw_rad).cos());
        Command {
            roll: tilt((-left).atan2(self.gravity_m_s2), angles.roll_rad, roll_rate),
            pitch: tilt(forward.atan2(self.gravity_m_s2), angles.pitch_rad, pitch_rate),
            yaw_rate: gains.heading_1_s * turn_rad / self.yaw_rate_rad_s_max,
            climb: (direct_m_s + self.climbed_m_s) / self.climb_m_s_max,
        }
        .limited()
    }
}
