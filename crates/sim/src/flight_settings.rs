//! Settings of a flight.

use crate::control::Setpoint;
use crate::environment::{Air, Gusts};
use crate::seed::{Part, stream};
use hovertone_vehicle::{FlightParameters, GRAVITY_STANDARD_M_S2, QuantityError};
use rand::RngExt;
use rand_distr::StandardNormal;

/// Height of the paper's hovers.
const HOVER_HEIGHT_M: f64 = 1.0;

/// A point mass on the vehicle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Payload {
    /// Its mass.
    pub mass_kg: f64,
    /// Its position, body axes from the centre of mass of the vehicle without payloads, m.
    pub position_m: [f64; 3],
}

/// How the rotors and motors differ from the vehicle's numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spread {
    /// C_f of each rotor over the C_f of the vehicle's parameters.
    pub thrust_shares: [f64; 4],
    /// Gain of each motor: voltage felt over voltage given.
    pub motor_gains: [f64; 4],
}

impl Default for Spread {
    /// All alike.
    fn default() -> Self {
        Self { thrust_shares: [1.0; 4], motor_gains: [1.0; 4] }
    }
}

impl Spread {
    /// Drawn from Gaussians about 1, cut at three standard deviations; the same seed gives the same vehicle.
    pub fn random(thrust_std_share: f64, motor_gain_std_share: f64, seed: u64) -> Self {
        let draw = |index: u64, std_share: f64| {
            let mut random = stream(seed, Part::Spread, index);
            std::array::from_fn(|_| {
                let normal: f64 = random.sample(StandardNormal);
                1.0 + std_share * normal.clamp(-3.0, 3.0)
            })
        };
        Self { thrust_shares: draw(0, thrust_std_share), motor_gains: draw(1, motor_gain_std_share) }
    }
}

/// The random wander of each motor's gain in flight, independent for each motor: unsteady inflow, regulation of its controller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotorWander {
    /// Standard deviation of each gain over its mean. The speed wanders by about two thirds of it, since
    /// the controller counteracts.
    pub gain_std_share: f64,
    /// Time constant τ of its autocovariance e^(-t/τ).
    pub time_constant_s: f64,
}

impl MotorWander {
    fn check(&self) -> Result<(), QuantityError> {
        let refused = |name, value, must_be| Err(QuantityError { name, value, must_be });
        if !(0.0..=0.2).contains(&self.gain_std_share) {
            return refused("gain_std_share", self.gain_std_share, "between 0 and 0.2");
        }
        if !(self.time_constant_s > 0.0 && self.time_constant_s.is_finite()) {
            return refused("time_constant_s", self.time_constant_s, "above 0");
        }
        Ok(())
    }
}

/// The beginning of the flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Start {
    /// Hovering, trimmed, at a place.
    Hover(Setpoint),
    /// Standing on the ground at (x, y) with this heading, motors off.
    Ground {
        /// World axes, m.
        place_m: [f64; 2],
        /// Heading, rad.
        yaw_rad: f64,
    },
}

/// Settings of a flight: the paper's model, and effects beyond it, which are off by default.
#[derive(Clone, Debug, PartialEq)]
pub struct FlightSettings {
    /// The vehicle; numbers may be overridden.
    pub vehicle: FlightParameters,
    /// Gravity, m/s².
    pub gravity_m_s2: f64,
    /// Step of the integration.
    pub step_s: f64,
    /// The beginning of the flight.
    pub start: Start,
    /// Added masses. Masses off centre move the centre of mass; all add to the inertia.
    pub payloads: Vec<Payload>,
    /// Differences among the rotors; off when absent.
    pub spread: Option<Spread>,
    /// Unsteadiness of each motor; off when absent.
    pub motor_wander: Option<MotorWander>,
    /// Whether the battery's voltage falls with charge and current; otherwise it is the nominal voltage.
    pub battery_sag: bool,
    /// Whether thrust grows near the ground.
    pub ground_effect: bool,
    /// The air; when absent, the air in which the vehicle's constants were measured.
    pub air: Option<Air>,
    /// Steady wind: velocity of the air, world axes.
    pub wind_m_s: [f64; 3],
    /// Gusts; off when absent.
    pub gusts: Option<Gusts>,
    /// All random numbers come from this seed.
    pub seed: u64,
}

impl FlightSettings {
    /// The paper's flight: hover 1 m above the ground in still air, steps of 1 ms, everything else off.
    pub fn for_vehicle(vehicle: FlightParameters) -> Self {
        Self {
            vehicle,
            gravity_m_s2: GRAVITY_STANDARD_M_S2,
            step_s: 0.001,
            start: Start::Hover(Setpoint { position_m: [0.0, 0.0, HOVER_HEIGHT_M], yaw_rad: 0.0 }),
            payloads: Vec::new(),
            spread: None,
            battery_sag: false,
            ground_effect: false,
            air: None,
            wind_m_s: [0.0; 3],
            motor_wander: None,
            gusts: None,
            seed: 1,
        }
    }

    /// Refuses settings out of bounds, naming them.
    pub(crate) fn check(&self) -> Result<(), QuantityError> {
        let refused = |name, value, must_be| Err(QuantityError { name, value, must_be });
        self.vehicle.check()?;
        if !(self.gravity_m_s2 > 0.0 && self.gravity_m_s2 < 100.0) {
            return refused("gravity_m_s2", self.gravity_m_s2, "above 0 and below 100");
        }
        let period_s = self.vehicle.controller.period_s.value;
        let runs = period_s / self.step_s;
        if !(self.step_s > 0.0 && runs.round() >= 1.0 && (runs - runs.round()).abs() < 1e-6 * runs) {
            return refused(
                "step_s",
                self.step_s,
                "the controller's period divided by a whole number; 0.001 fits every preset",
            );
        }
        for payload in &self.payloads {
            if !(payload.mass_kg >= 0.0 && payload.mass_kg.is_finite()) {
                return refused("payload mass_kg", payload.mass_kg, "0 or above");
            }
            if let Some(bad) = payload.position_m.into_iter().find(|part| !part.is_finite()) {
                return refused("payload position_m", bad, "a number");
            }
        }
        let spread = self.spread.unwrap_or_default();
        for share in spread.thrust_shares.into_iter().chain(spread.motor_gains) {
            if !(0.5..=1.5).contains(&share) {
                return refused("spread", share, "between 0.5 and 1.5");
            }
        }
        if let Some(bad) = self.wind_m_s.into_iter().find(|part| !(-50.0..=50.0).contains(part)) {
            return refused("wind_m_s", bad, "between -50 and 50");
        }
        if let Start::Hover(setpoint) = self.start {
            if let Some(bad) = setpoint.position_m.into_iter().find(|part| !part.is_finite()) {
                return refused("start position_m", bad, "a number");
            }
            if setpoint.position_m[2] <= self.vehicle.standing_height_m.value {
                return refused("start height", setpoint.position_m[2], "above the standing height");
            }
        }
        self.air.map_or(Ok(()), |air| air.check())?;
        self.motor_wander.map_or(Ok(()), |wander| wander.check())?;
        self.gusts.map_or(Ok(()), |gusts| gusts.check())
    }
}
