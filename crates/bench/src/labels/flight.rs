//! Simulated hovers, what a log on board holds of them, and what an ear makes of their rotors.

use hovertone::rotors::{FlightLog, LogSignals, MotorSignal};
use hovertone::speed::TrackPoint;
use hovertone_sim::scenario::{ScenarioFile, ScenarioRun};
use hovertone_sim::{FlightSound, FlightState, RotorState, SoundState};
use hovertone_vehicle::find_flight_parameters;
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rand_pcg::Pcg64;
use std::collections::BTreeMap;
use std::f64::consts::TAU;

/// Rows of the truth, per second.
const TRUTH_HZ: f64 = 200.0;
/// Points of a track, as the separation gives them.
const TRACK_STEP_S: f64 = 0.04;
/// Gyro: white noise, as asked for.
const GYRO_STD_RAD_S: f64 = 0.02;
const GYRO_HZ: f64 = 20.0;
/// Commands in steps of a thousandth of the battery's voltage, at the rate of common logs of actuators.
const COMMAND_HZ: f64 = 10.0;
const COMMAND_STEP_V: f64 = 0.011;
/// Telemetry of ESCs, in steps of 0.1 % or so.
const ESC_HZ: f64 = 3.0;
const ESC_STEP_RAD_S: f64 = 0.5;

/// A flight that was flown: its truth at every row, and what microphones heard of it, if any did.
pub(super) struct Flown {
    file: ScenarioFile,
    states: Vec<FlightState>,
    channels: Vec<Vec<f32>>,
    random: Pcg64,
}

/// What a log holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Logged {
    BodyRates,
    Commands,
    Speeds,
}

impl Flown {
    /// Flies a scenario, which somebody may hear.
    pub(super) fn of(file: ScenarioFile, is_heard: bool) -> Result<Self, String> {
        let file = ScenarioFile { truth_rate_hz: TRUTH_HZ, ..file };
        let scenario = file.resolve(&BTreeMap::new()).map_err(|error| error.to_string())?;
        let run = if is_heard { ScenarioRun::new(scenario) } else { ScenarioRun::silent(scenario) };
        let mut run = run.map_err(|error| error.to_string())?;
        let (mut channels, mut states) = (Vec::new(), Vec::new());
        while run.advance(&mut channels, &mut states).map_err(|error| error.to_string())? {}
        run.finish(&mut channels);
        let random = Pcg64::seed_from_u64(file.seed);
        Ok(Self { file, states, channels, random })
    }

    /// Tracks as an ear has them, fastest first, and which rotor each is: the true speeds with an error of their own.
    pub(super) fn tracks(&mut self, error_share: f64) -> (Vec<Vec<TrackPoint>>, Vec<usize>) {
        let end_s = self.states.last().map_or(0.0, |state| state.time_s);
        let count = (end_s / TRACK_STEP_S) as usize;
        let times: Vec<f64> = (0..count).map(|step| (step as f64 + 0.5) * TRACK_STEP_S).collect();
        let mut rotors: Vec<usize> = (0..4).collect();
        rotors.shuffle(&mut self.random);
        let mut tracks: Vec<(f64, Vec<TrackPoint>, usize)> = Vec::new();
        for rotor in rotors {
            let mut total = 0.0;
            let mut track = Vec::new();
            for &time_s in &times {
                let speed_rev_s = self.at(time_s).speed_rad_s[rotor] / TAU;
                let error: f64 = self.random.sample(StandardNormal);
                let std_uncertainty_rev_s = error_share * speed_rev_s;
                let speed_rev_s = speed_rev_s + error * std_uncertainty_rev_s;
                track.push(TrackPoint {
                    time_s,
                    tone_hz: 2.0 * speed_rev_s,
                    speed_rev_s,
                    std_uncertainty_rev_s,
                    level_db: -40.0,
                });
                total += speed_rev_s;
            }
            tracks.push((total, track, rotor));
        }
        tracks.sort_by(|a, b| b.0.total_cmp(&a.0));
        let rotors = tracks.iter().map(|(_, _, rotor)| *rotor).collect();
        (tracks.into_iter().map(|(_, track, _)| track).collect(), rotors)
    }

    /// A log of the flight on a clock of its own, and what is to be added to its times.
    pub(super) fn log(&mut self, logged: Logged) -> Result<(FlightLog, f64), String> {
        let rate_hz = match logged {
            Logged::BodyRates => GYRO_HZ,
            Logged::Commands => COMMAND_HZ,
            Logged::Speeds => ESC_HZ,
        };
        let end_s = self.states.last().map_or(0.0, |state| state.time_s);
        let offset_s = self.random.random_range(-100.0..100.0);
        let phase_s = self.random.random_range(0.0..1.0 / rate_hz);
        let times: Vec<f64> =
            (0..).map(|row| phase_s + f64::from(row) / rate_hz).take_while(|time_s| *time_s < end_s).collect();
        let states: Vec<FlightState> = times.iter().map(|&time_s| self.at(time_s)).collect();
        let stepped = |value: f64, step: f64| (value / step).round() * step;
        let motors = |value: &dyn Fn(&FlightState, usize) -> f64| -> Vec<Vec<f64>> {
            (0..4).map(|rotor| states.iter().map(|state| value(state, rotor)).collect()).collect()
        };
        let signals = match logged {
            Logged::BodyRates => {
                let parameters =
                    find_flight_parameters(&self.file.vehicle.preset).ok_or("no flight parameters".to_owned())?;
                let places = parameters.layout.value.places(parameters.arm_length_m.value).to_vec();
                let random = &mut self.random;
                let mut axis = |axis: usize| -> Vec<f64> {
                    let noisy = |state: &FlightState| {
                        let noise: f64 = random.sample(StandardNormal);
                        state.rates_rad_s[axis] + GYRO_STD_RAD_S * noise
                    };
                    states.iter().map(noisy).collect()
                };
                LogSignals::BodyRates { places, rates_rad_s: [axis(0), axis(1), axis(2)] }
            }
            Logged::Commands => LogSignals::Motors {
                signal: MotorSignal::Command,
                names: names(),
                values: motors(&|state, rotor| stepped(state.voltage_v[rotor], COMMAND_STEP_V)),
            },
            Logged::Speeds => LogSignals::Motors {
                signal: MotorSignal::Speed,
                names: names(),
                values: motors(&|state, rotor| stepped(state.speed_rad_s[rotor], ESC_STEP_RAD_S)),
            },
        };
        let log_s = times.iter().map(|time_s| time_s - offset_s).collect();
        Ok((FlightLog::new(log_s, signals).map_err(|error| error.to_string())?, offset_s))
    }

    fn at(&self, time_s: f64) -> FlightState {
        let place = (time_s * TRUTH_HZ).round() as usize;
        self.states[place.min(self.states.len() - 1)]
    }

    /// What the first microphone heard, and its rate.
    pub(super) fn sound(&self) -> Option<(Vec<f32>, f64)> {
        Some((self.channels.first()?.clone(), f64::from(self.file.sound.sample_rate_hz)))
    }

    /// What all microphones of the scenario hear, and its rate: those that stand, or those that fly along with a vehicle about its start.
    pub(super) fn heard_by_all(&self, fly_along: bool) -> Result<(Vec<Vec<f32>>, f64), String> {
        let scenario = self.file.resolve(&BTreeMap::new()).map_err(|error| error.to_string())?;
        let sample_rate_hz = f64::from(scenario.sound.sample_rate_hz);
        let mut sound = FlightSound::new(scenario.sound).map_err(|error| error.to_string())?;
        let mut channels = Vec::new();
        for state in &self.states {
            let still = FlightState { position_m: self.states[0].position_m, attitude: [1.0, 0.0, 0.0, 0.0], ..*state };
            let seen = if fly_along { still } else { *state };
            let (places, axis) = (seen.rotor_positions_m(), seen.thrust_axis());
            let rotors = (0..4).map(|rotor| RotorState {
                speed_rad_s: state.speed_rad_s[rotor],
                position_m: places[rotor],
                axis,
            });
            let seen = SoundState { time_s: state.time_s, rotors: rotors.collect() };
            sound.push(&seen, &mut channels).map_err(|error| error.to_string())?;
        }
        sound.finish(&mut channels);
        Ok((channels, sample_rate_hz))
    }

    /// Which rotor a track is nearest to, on the average.
    pub(super) fn rotor_of(&self, track: &[TrackPoint]) -> usize {
        let off = |rotor: usize| -> f64 {
            let errors = track.iter().map(|point| point.speed_rev_s - self.at(point.time_s).speed_rad_s[rotor] / TAU);
            errors.map(|error| error * error).sum()
        };
        (0..4).min_by(|&a, &b| off(a).total_cmp(&off(b))).unwrap_or(0)
    }
}

fn names() -> Vec<String> {
    (1..=4).map(|number| format!("motor {number}")).collect()
}
