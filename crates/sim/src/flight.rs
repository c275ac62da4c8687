//! The whole model: commands in, one state out per step. Memory does not grow with the length of the flight.

use crate::airframe::Airframe;
use crate::body::{BODY_NUMBERS, BodyState, Euler, normalised, rotation};
use crate::control::{Command, Controller, Pilot, PilotGains, Setpoint};
use crate::environment::{Battery, Wind};
use crate::flight_settings::{FlightSettings, Start};
use crate::forces::{Wrench, gyroscopic_torque_n_m, rotor_wrench};
use crate::ornstein_uhlenbeck::OrnsteinUhlenbeck;
use crate::rk4::rk4;
use crate::rotor::ground_effect;
use crate::seed::{Part, stream};
use crate::trim::{HoverTrim, hover_trim};
use hovertone_vehicle::QuantityError;
use nalgebra::Vector3;

/// Body, four speeds, charge used.
const NUMBERS: usize = BODY_NUMBERS + 5;
const CHARGE: usize = BODY_NUMBERS + 4;

/// The state at one instant; a row of the truth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FlightState {
    /// Time since the start.
    pub time_s: f64,
    /// The commands in force, ±1.
    pub command: Command,
    /// Voltage at each motor.
    pub voltage_v: [f64; 4],
    /// Speed of each rotor's shaft, 0 or above.
    pub speed_rad_s: [f64; 4],
    /// Thrust of each rotor, along the body's z.
    pub thrust_n: [f64; 4],
    /// Load torque of each rotor, against its turning.
    pub torque_n_m: [f64; 4],
    /// Centre of mass, world axes (z up, the ground is at 0).
    pub position_m: [f64; 3],
    /// Its velocity, world axes.
    pub velocity_m_s: [f64; 3],
    /// Body to world, unit quaternion, scalar first.
    pub attitude: [f64; 4],
    /// Roll, pitch and yaw rate of the body, body axes.
    pub rates_rad_s: [f64; 3],
    /// Voltage of the battery.
    pub battery_v: f64,
    /// Velocity of the air at the vehicle, world axes.
    pub wind_m_s: [f64; 3],
    /// The rotors' hubs from the centre of mass, body axes; constant during the flight.
    pub hub_m: [[f64; 3]; 4],
}

impl FlightState {
    /// The rotors' hubs in the world, m.
    pub fn rotor_positions_m(&self) -> [[f64; 3]; 4] {
        let (turn, centre) = (rotation(&self.attitude), Vector3::from(self.position_m));
        self.hub_m.map(|hub| (centre + turn * Vector3::from(hub)).into())
    }

    /// Velocities of the hubs in the world, m/s.
    pub fn rotor_velocities_m_s(&self) -> [[f64; 3]; 4] {
        let (turn, rates) = (rotation(&self.attitude), Vector3::from(self.rates_rad_s));
        let velocity = Vector3::from(self.velocity_m_s);
        self.hub_m.map(|hub| (velocity + turn * rates.cross(&Vector3::from(hub))).into())
    }

    /// The body's z in the world, a unit vector: where all four thrusts point.
    pub fn thrust_axis(&self) -> [f64; 3] {
        rotation(&self.attitude).column(2).into_owned().into()
    }

    /// Roll, pitch and yaw.
    pub fn euler(&self) -> Euler {
        Euler::from_attitude(&self.attitude)
    }
}

/// A flight, step by step.
///
/// The controller runs every [`period_s`](hovertone_vehicle::ControllerParameters::period_s), from the first instant
/// on, and its voltages hold in between; the gusts hold for one step. Everything else is integrated together by
/// [`rk4`].
#[derive(Clone, Debug)]
pub struct Flight {
    settings: FlightSettings,
    airframe: Airframe,
    trim: HoverTrim,
    controller: Controller,
    battery: Option<Battery>,
    wind: Wind,
    /// Wander of each motor's gain about its mean.
    motor_wander: Option<[OrnsteinUhlenbeck; 4]>,
    /// Each motor's present gain over its mean.
    gain_shares: [f64; 4],
    numbers: [f64; NUMBERS],
    steps: u64,
    steps_per_run: u64,
    motors_on: bool,
    /// v_o in the controller: the trim's voltage, or more where the battery gives less than its nominal voltage.
    hover_demand_v: [f64; 4],
    command: Command,
    demand_v: [f64; 4],
}

impl Flight {
    /// Builds the vehicle and finds its hover. Fails on a setting out of bounds, naming it, and if the vehicle cannot hover.
    pub fn new(settings: FlightSettings) -> Result<Self, QuantityError> {
        settings.check()?;
        let airframe = Airframe::new(&settings)?;
        let vehicle = &settings.vehicle;
        let standing_m = airframe.contact.resting_height_m(airframe.body.weight_n());
        let trim_height_m = match settings.start {
            Start::Hover(setpoint) => setpoint.position_m[2],
            Start::Ground { .. } => standing_m,
        };
        let trim = hover_trim(&airframe, trim_height_m, vehicle.battery.voltage_v.value)?;
        let (place_m, yaw_rad, speeds, motors_on) = match settings.start {
            Start::Hover(setpoint) => (setpoint.position_m, setpoint.yaw_rad, trim.speed_rad_s, true),
            Start::Ground { place_m: [x, y], yaw_rad } => ([x, y, standing_m], yaw_rad, [0.0; 4], false),
        };
        let battery = settings.battery_sag.then(|| Battery::new(&vehicle.battery));
        let hover_demand_v = battery.map_or(trim.voltage_v, |battery| {
            let motors = &airframe.motors;
            let current_a = |k: usize| motors[k].current_a(trim.speed_rad_s[k], trim.voltage_v[k]);
            let hover_w = (0..4).map(|k| trim.voltage_v[k] * current_a(k)).sum();
            trim.voltage_v.map(|volts| battery.demand_v(volts, hover_w))
        });
        let motor_wander = settings.motor_wander.map(|wander| {
            let random = |motor: u64| stream(settings.seed, Part::MotorGain, motor);
            [0, 1, 2, 3].map(|motor| {
                OrnsteinUhlenbeck::new(wander.gain_std_share, wander.time_constant_s, settings.step_s, random(motor))
            })
        });
        let mut body = BodyState::at_rest(place_m);
        body.attitude = Euler { roll_rad: 0.0, pitch_rad: 0.0, yaw_rad }.attitude();
        let mut numbers = [0.0; NUMBERS];
        numbers[..BODY_NUMBERS].copy_from_slice(&body.to_array());
        numbers[BODY_NUMBERS..CHARGE].copy_from_slice(&speeds);
        Ok(Self {
            controller: Controller::new(&vehicle.controller, vehicle.layout.value),
            battery,
            wind: Wind::new(settings.wind_m_s, settings.gusts.as_ref(), settings.step_s, settings.seed),
            motor_wander,
            gain_shares: [1.0; 4],
            steps_per_run: (vehicle.controller.period_s.value / settings.step_s).round() as u64,
            demand_v: if motors_on { hover_demand_v } else { [0.0; 4] },
            hover_demand_v,
            command: Command::HOVER,
            steps: 0,
            settings,
            airframe,
            trim,
            numbers,
            motors_on,
        })
    }

    /// The settings.
    pub fn settings(&self) -> &FlightSettings {
        &self.settings
    }

    /// The vehicle.
    pub fn airframe(&self) -> &Airframe {
        &self.airframe
    }

    /// The vehicle's hover.
    pub fn trim(&self) -> &HoverTrim {
        &self.trim
    }

    /// Switches the motors on or off. Off means no voltage, which brakes them. On takes effect at the controller's next run.
    pub fn switch_motors(&mut self, on: bool) {
        self.motors_on = on;
    }

    /// Whether the controller runs in the next step, so that a new command counts.
    pub fn controller_is_due(&self) -> bool {
        self.steps.is_multiple_of(self.steps_per_run)
    }

    /// The body's state.
    pub fn body(&self) -> BodyState {
        body_of(&self.numbers)
    }

    /// Sets the body's state; for tests of the model.
    pub fn place_body(&mut self, body: &BodyState) {
        self.numbers[..BODY_NUMBERS].copy_from_slice(&body.to_array());
    }

    /// Goes on by one step. The command counts if the controller is due.
    pub fn step(&mut self, command: &Command) -> FlightState {
        if self.controller_is_due() {
            self.command = command.limited();
            let change_v = self.controller.run(&self.command, &self.body());
            let limit_v = self.settings.vehicle.battery.voltage_v.value;
            self.demand_v = std::array::from_fn(|k| match self.motors_on {
                true => (self.hover_demand_v[k] + change_v[k]).clamp(0.0, limit_v),
                false => 0.0,
            });
        }
        let air_m_s = self.wind.velocity_m_s();
        for (share, wander) in self.gain_shares.iter_mut().zip(self.motor_wander.iter_mut().flatten()) {
            *share = 1.0 + wander.step();
        }
        let mut next = rk4(&self.numbers, self.settings.step_s, |numbers| self.rate(numbers, &air_m_s));
        let attitude = normalised([next[6], next[7], next[8], next[9]]);
        next[6..10].copy_from_slice(&attitude);
        self.numbers = next;
        self.wind.step();
        self.steps += 1;
        self.state()
    }

    /// The present state.
    pub fn state(&self) -> FlightState {
        let body = self.body();
        let speed_rad_s = speeds_of(&self.numbers);
        let (voltage_v, battery_v) = self.voltages_v(&speed_rad_s, self.numbers[CHARGE]);
        FlightState {
            time_s: self.steps as f64 * self.settings.step_s,
            command: self.command,
            voltage_v,
            speed_rad_s,
            thrust_n: self.thrusts_n(&speed_rad_s, body.position_m.z, &rotation(&body.attitude)),
            torque_n_m: std::array::from_fn(|k| self.airframe.rotors[k].load_torque_n_m(speed_rad_s[k])),
            position_m: body.position_m.into(),
            velocity_m_s: body.velocity_m_s.into(),
            attitude: body.attitude,
            rates_rad_s: body.rates_rad_s.into(),
            battery_v,
            wind_m_s: self.wind.velocity_m_s().into(),
            hub_m: self.airframe.hubs.map(|hub| hub.position_m.into()),
        }
    }

    /// Time derivative of everything.
    fn rate(&self, numbers: &[f64; NUMBERS], air_m_s: &Vector3<f64>) -> [f64; NUMBERS] {
        let (body, speeds, airframe) = (body_of(numbers), speeds_of(numbers), &self.airframe);
        let (voltages, battery_v) = self.voltages_v(&speeds, numbers[CHARGE]);
        let turn = rotation(&body.attitude);
        let accelerations: [f64; 4] = std::array::from_fn(|k| {
            airframe.motors[k].acceleration_rad_s2(speeds[k], self.gain_shares[k] * voltages[k])
        });
        let thrusts = self.thrusts_n(&speeds, body.position_m.z, &turn);
        let loads = std::array::from_fn(|k| airframe.rotors[k].load_torque_n_m(speeds[k]));
        let mut wrench: Wrench = rotor_wrench(&airframe.hubs, &thrusts, &loads);
        wrench.torque_n_m += gyroscopic_torque_n_m(&airframe.hubs, &body.rates_rad_s, &speeds, &accelerations);
        let airspeed_m_s = turn.tr_mul(&(body.velocity_m_s - air_m_s));
        wrench.force_n -= airframe.drag_n_s_m.component_mul(&airspeed_m_s);
        let ground = airframe.contact.wrench(&body.position_m, &body.velocity_m_s, &turn, &body.rates_rad_s);
        if let Some(ground) = ground {
            wrench.force_n += ground.force_n;
            wrench.torque_n_m += ground.torque_n_m;
        }
        let mut rate = [0.0; NUMBERS];
        rate[..BODY_NUMBERS].copy_from_slice(&airframe.body.rate(&body, &turn, &wrench));
        rate[BODY_NUMBERS..CHARGE].copy_from_slice(&accelerations);
        if self.battery.is_some() && battery_v > 0.0 {
            let watts: f64 = (0..4).map(|k| voltages[k] * airframe.motors[k].current_a(speeds[k], voltages[k])).sum();
            rate[CHARGE] = watts / battery_v;
        }
        rate
    }

    /// Voltages at the motors, and the battery's.
    fn voltages_v(&self, speed_rad_s: &[f64; 4], used_c: f64) -> ([f64; 4], f64) {
        let Some(battery) = &self.battery else {
            return (self.demand_v, self.settings.vehicle.battery.voltage_v.value);
        };
        let motors = &self.airframe.motors;
        let duties = self.demand_v.map(|demand_v| battery.duty(demand_v));
        let emf_v = std::array::from_fn(|k| motors[k].back_emf_v(speed_rad_s[k]));
        let gains = motors.map(|motor| motor.gain);
        let ohm = self.settings.vehicle.motor.resistance_ohm.value;
        let volts = battery.voltage_v(used_c, &duties, &gains, &emf_v, ohm);
        (duties.map(|duty| duty * volts), volts)
    }

    fn thrusts_n(&self, speed_rad_s: &[f64; 4], height_m: f64, turn: &nalgebra::Matrix3<f64>) -> [f64; 4] {
        let airframe = &self.airframe;
        std::array::from_fn(|k| {
            let rotor = &airframe.rotors[k];
            let free_n = rotor.thrust_n(speed_rad_s[k]);
            if !airframe.has_ground_effect {
                return free_n;
            }
            let hub_m = height_m + turn.row(2).transpose().dot(&airframe.hubs[k].position_m);
            free_n * ground_effect(rotor.radius_m, hub_m)
        })
    }

    /// A pilot that holds a place, with gains from the vehicle's own dynamics. The bandwidth of the attitude is at least
    /// 4 rad/s (a slower controller is overdriven), that of the place a fifth of it, and that of the heading a third of the
    /// yaw loop's.
    pub fn pilot(&self, setpoint: Setpoint) -> Pilot {
        let controller = &self.settings.vehicle.controller;
        let (mut roll, mut yaw) = (0.0, 0.0);
        for k in 0..4 {
            let speed = self.trim.speed_rad_s[k];
            let per_volt = 2.0 * speed * self.airframe.motors[k].linearised(speed).gain_rad_s_v;
            let hub = &self.airframe.hubs[k];
            roll += hub.position_m.y.abs() * self.airframe.rotors[k].thrust_constant_n_s2 * per_volt;
            yaw += self.airframe.rotors[k].torque_constant_n_m_s2 * per_volt;
        }
        let inertia = self.airframe.body.inertia_kg_m2();
        let stiffness = controller.roll.value.proportional * roll / inertia[(0, 0)];
        let damping = controller.roll.value.derivative * roll / inertia[(0, 0)];
        let wanted_rad_s = stiffness.sqrt().max(SLOWEST_ATTITUDE_RAD_S);
        let gains = PilotGains {
            position_rad_s: wanted_rad_s / 5.0,
            height_1_s: 1.5,
            heading_1_s: (controller.yaw_rate.value.proportional * yaw / inertia[(2, 2)] / 3.0).min(1.5),
            overdrive: wanted_rad_s * wanted_rad_s / stiffness - 1.0,
            damping_s: ((1.6 * wanted_rad_s - damping) / stiffness).max(0.0),
        };
        Pilot::new(gains, controller, self.settings.gravity_m_s2, setpoint)
    }
}

/// A flight with its pilot: an endless iterator of states, beginning with the present state.
#[derive(Clone, Debug)]
pub struct PilotedFlight {
    flight: Flight,
    pilot: Pilot,
    command: Command,
    is_started: bool,
}

impl PilotedFlight {
    /// Joins a flight and a pilot.
    pub fn new(flight: Flight, pilot: Pilot) -> Self {
        Self { flight, pilot, command: Command::HOVER, is_started: false }
    }

    /// The flight.
    pub fn flight(&self) -> &Flight {
        &self.flight
    }

    /// The flight, to switch its motors.
    pub fn flight_mut(&mut self) -> &mut Flight {
        &mut self.flight
    }

    /// The pilot, to send it elsewhere.
    pub fn pilot_mut(&mut self) -> &mut Pilot {
        &mut self.pilot
    }
}

impl Iterator for PilotedFlight {
    type Item = FlightState;

    fn next(&mut self) -> Option<FlightState> {
        if !std::mem::replace(&mut self.is_started, true) {
            return Some(self.flight.state());
        }
        if self.flight.controller_is_due() {
            self.command = self.pilot.command(&self.flight.body());
        }
        Some(self.flight.step(&self.command))
    }
}

/// A pilot cannot hold a place with an attitude slower than this.
const SLOWEST_ATTITUDE_RAD_S: f64 = 4.0;

fn body_of(numbers: &[f64; NUMBERS]) -> BodyState {
    BodyState::from_array(&std::array::from_fn(|k| numbers[k]))
}

fn speeds_of(numbers: &[f64; NUMBERS]) -> [f64; 4] {
    std::array::from_fn(|k| numbers[BODY_NUMBERS + k])
}
