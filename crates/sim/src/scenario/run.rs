//! The run of a scenario: commands, flight and sound, step by step.

use super::jitter::Jitter;
use super::truth::{Means, ScenarioTruth, SpanTruth};
use super::{Scenario, ScenarioError};
use crate::control::{Command, Pilot};
use crate::flight::{Flight, FlightState};
use crate::flight_settings::Start;
use crate::sound::{FlightSound, RotorState, SoundState};

/// A run. Its memory grows only by one entry per hover.
///
/// ```
/// use hovertone_sim::scenario::{ScenarioFile, ScenarioRun};
/// use std::collections::BTreeMap;
///
/// let file = ScenarioFile { duration_s: Some(0.5), ..ScenarioFile::default() };
/// let mut run = ScenarioRun::new(file.resolve(&BTreeMap::new())?)?;
/// let (mut channels, mut rows) = (Vec::new(), Vec::new());
/// while run.advance(&mut channels, &mut rows)? {}
/// let truth = run.finish(&mut channels);
/// assert_eq!((channels[0].len(), rows.len()), (24_000, 51));
/// let expected = 0.413 * 9.806_65 / 7.0775e-6;
/// let found = truth.flight.mean_sum_of_squares_rad2_s2;
/// assert!((found / expected - 1.0).abs() < 1e-6);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub struct ScenarioRun {
    scenario: Scenario,
    flight: Flight,
    pilot: Pilot,
    jitter: Option<Jitter>,
    command: Command,
    /// None for a silent run.
    sound: Option<FlightSound>,
    /// Steps flown; none before the first state.
    steps: Option<u64>,
    state: FlightState,
    was_hover: bool,
    hovers: Vec<SpanTruth>,
    hover: Option<Means>,
    all_hovers: Means,
    all: Means,
}

impl ScenarioRun {
    /// Builds vehicle and sound. Fails on a number out of bounds, naming it, and if the vehicle cannot hover.
    pub fn new(scenario: Scenario) -> Result<Self, ScenarioError> {
        let sound = FlightSound::new(scenario.sound.clone())?;
        Ok(Self { sound: Some(sound), ..Self::silent(scenario)? })
    }

    /// The same flight without sound: no samples, in a hundredth of the time.
    pub fn silent(scenario: Scenario) -> Result<Self, ScenarioError> {
        let mut flight = Flight::new(scenario.flight.clone())?;
        let first = scenario.schedule.at(0.0);
        flight.switch_motors(first.motors_on);
        let pilot = flight.pilot(first.setpoint);
        let period_s = scenario.flight.vehicle.controller.period_s.value;
        let jitter = scenario.jitter.map(|jitter| Jitter::new(&jitter, period_s, scenario.flight.seed));
        if let (Some(jitter), Start::Hover(_)) = (&jitter, scenario.flight.start) {
            // begin with the commanded climb, as after a longer hover: a sudden change of command would kick all rotors
            let mut body = flight.body();
            body.velocity_m_s.z +=
                jitter.now().limited().climb * scenario.flight.vehicle.controller.climb_m_s_max.value;
            flight.place_body(&body);
        }
        let state = flight.state();
        Ok(Self {
            scenario,
            flight,
            pilot,
            jitter,
            command: Command::HOVER,
            sound: None,
            steps: None,
            state,
            was_hover: false,
            hovers: Vec::new(),
            hover: None,
            all_hovers: Means::default(),
            all: Means::default(),
        })
    }

    /// The scenario.
    pub fn scenario(&self) -> &Scenario {
        &self.scenario
    }

    /// Progress of the flight, 0 to 1.
    pub fn share_done(&self) -> f64 {
        self.steps.unwrap_or(0) as f64 / self.scenario.step_count as f64
    }

    /// Time of the last state.
    pub fn time_s(&self) -> f64 {
        self.state.time_s
    }

    /// Goes on by one step. Appends the finished samples to `channels`, one for each microphone, and the state to `rows` if
    /// a row of the truth is due. Returns `false` and does nothing at the end.
    ///
    /// # Errors
    /// If the vehicle leaves the room or flies too far away.
    pub fn advance(
        &mut self,
        channels: &mut Vec<Vec<f32>>,
        rows: &mut Vec<FlightState>,
    ) -> Result<bool, ScenarioError> {
        let steps = match self.steps {
            None => 0,
            Some(steps) if steps >= self.scenario.step_count => return Ok(false),
            Some(steps) => {
                self.step();
                steps + 1
            }
        };
        self.steps = Some(steps);
        if let Some(sound) = &mut self.sound {
            sound.push(&sound_state(&self.state), channels)?;
        }
        if steps.is_multiple_of(self.scenario.steps_per_row) {
            rows.push(self.state);
        }
        Ok(true)
    }

    /// Appends the last samples and returns the truth about the flight so far.
    pub fn finish(mut self, channels: &mut Vec<Vec<f32>>) -> ScenarioTruth {
        self.end_hover();
        if let Some(sound) = self.sound.take() {
            sound.finish(channels);
        }
        let weight_n = self.flight.airframe().body.weight_n();
        let settings = &self.scenario.flight;
        ScenarioTruth {
            mass_kg: settings.vehicle.mass_kg.value
                + settings.payloads.iter().map(|payload| payload.mass_kg).sum::<f64>(),
            gravity_m_s2: settings.gravity_m_s2,
            rotor_thrust_constants_n_s2: self.flight.airframe().rotors.map(|rotor| rotor.thrust_constant_n_s2),
            trim_speed_rad_s: self.flight.trim().speed_rad_s,
            hover: self.all_hovers.span(weight_n),
            hovers: self.hovers,
            flight: self.all.span(weight_n).unwrap_or_default(),
        }
    }

    fn step(&mut self) {
        let before = self.state;
        let wanted = self.scenario.schedule.at(before.time_s);
        if self.flight.controller_is_due() {
            self.flight.switch_motors(wanted.motors_on);
            self.pilot.fly_to(wanted.setpoint);
            let piloted = match self.scenario.holds_place && wanted.motors_on {
                true => self.pilot.command(&self.flight.body()),
                false => Command::HOVER,
            };
            let mut parts = piloted.to_array();
            for (part, driven) in parts.iter_mut().zip(wanted.driven) {
                *part = driven.unwrap_or(*part);
            }
            let command = Command::from_array(parts);
            self.command = self.jitter.as_mut().map_or(command, |jitter| jitter.shaken(command)).limited();
        }
        self.state = self.flight.step(&self.command);
        self.all.add(&before, &self.state);
        if wanted.is_hover {
            self.all_hovers.add(&before, &self.state);
            self.hover.get_or_insert_default().add(&before, &self.state);
        } else if self.was_hover {
            self.end_hover();
        }
        self.was_hover = wanted.is_hover;
    }

    fn end_hover(&mut self) {
        let weight_n = self.flight.airframe().body.weight_n();
        self.hovers.extend(self.hover.take().and_then(|means| means.span(weight_n)));
    }
}

fn sound_state(state: &FlightState) -> SoundState {
    let (positions, axis) = (state.rotor_positions_m(), state.thrust_axis());
    let rotor = |k: usize| RotorState { speed_rad_s: state.speed_rad_s[k], position_m: positions[k], axis };
    SoundState { time_s: state.time_s, rotors: (0..4).map(rotor).collect() }
}
