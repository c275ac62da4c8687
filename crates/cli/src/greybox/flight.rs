//! A flight: its log as inputs of the model, and the speeds of its rotors.

use super::start::{Start, heard_mean, mean_of};
use crate::failure::Failure;
use crate::inputs::{name_of, open_stream};
use crate::log::{THE_LOG, column_names, log_failure, with_electrical_speeds};
use crate::motor::flight_of;
use crate::progress::Progress;
use crate::recording::{Hearing, better_rotor, lines_of};
use crate::vehicles::not_in_flight_model;
use hovertone::speed::{Config, OtherRotor};
use hovertone_dynamics::{
    ControlKnowns, ControlLog, Echoes, GreyBoxConfig, GreyBoxFit, GreyBoxModel, GreyBoxStop, HeardLines, LineOrders,
    LoopInputs, MotorVolts, SoundConfig, SoundFit, SpeedObservation, SpeedPrediction, checked, grey_box_from_sound,
    grey_box_from_speeds, log_offset_s, observations_of_rows, speeds_along,
};
use hovertone_logs::{ColumnNames, LoggedControl, MissingControl, RateAxes, control_from_log};
use hovertone_report::{Notice, OtherHover};
use hovertone_vehicle::{
    FlightParameters, GRAVITY_STANDARD_M_S2, KnownRotor, RotorSpeed, SaidOfVehicle, Vehicle, find_flight_parameters,
    find_preset,
};
use hovertone_workflow::Said;
use std::path::{Path, PathBuf};

/// Standard uncertainty of a logged speed as a share: half of the last digit of most telemetry. *Decision*: larger errors count as wander.
const LOGGED_STD_SHARE: f64 = 2e-4;
/// A clock that is so near is right: the delays of the model hold the rest, s. *Decision.*
const CLOCK_RIGHT_S: f64 = 0.051;
/// Beyond the range that the vehicle's numbers predict, the rotors are sought by this share. *Decision.*
const RANGE_SHARE: f64 = 0.15;

/// Smallest change of a command that is a manoeuvre, of 1 for the whole stick. *Decision.*
const COMMAND_CHANGE_MIN: f64 = 0.02;
/// Smallest rms change of the speeds, as a share, from which a model can be found: half of the last digit of most telemetry. *Decision.*
const SPEED_CHANGE_MIN: f64 = 2e-4;
/// What to fly where a flight shows no model.
const FLY_DOUBLETS: &str =
    "fly doublets (the stick to one side, then to the other) for a minute, in roll, pitch, yaw and climb";

/// Recording and log of a flight.
pub(crate) struct FlightFiles {
    /// The recording; absent where the log has the speeds.
    pub(crate) recording: Option<PathBuf>,
    /// The log.
    pub(crate) log: PathBuf,
}

impl FlightFiles {
    pub(crate) fn typed(files: &[PathBuf]) -> Self {
        match files {
            [recording, log, ..] => Self { recording: Some(recording.clone()), log: log.clone() },
            [log] => Self { recording: None, log: log.clone() },
            [] => Self { recording: None, log: PathBuf::new() },
        }
    }

    pub(crate) fn recording_name(&self) -> Option<String> {
        self.recording.as_deref().map(name_of)
    }

    pub(crate) fn log_name(&self) -> String {
        name_of(&self.log)
    }
}

/// The vehicle, whose numbers are the start.
pub(crate) struct GreyBoxVehicle {
    pub(crate) parameters: FlightParameters,
    pub(crate) mass_kg: f64,
    pub(crate) orders: LineOrders,
    preset: &'static Vehicle,
}

impl GreyBoxVehicle {
    /// A vehicle that can fly.
    pub(crate) fn find(name: &str, mass_kg: Option<f64>) -> Result<Self, Failure> {
        let unknown = || {
            let (what, hint) = not_in_flight_model(name);
            Failure::usage(what, hint)
        };
        let parameters = find_flight_parameters(name).ok_or_else(unknown)?.clone();
        let preset = find_preset(name).ok_or_else(unknown)?;
        KnownRotor { mass_kg, ..KnownRotor::default() }.check()?;
        preset.check_said(&SaidOfVehicle { mass_kg, is_hovering: true, ..SaidOfVehicle::default() })?;
        let orders = LineOrders::of(preset).ok_or_else(unknown)?;
        Ok(Self { mass_kg: mass_kg.unwrap_or(parameters.mass_kg.value), parameters, orders, preset })
    }

    pub(crate) fn id(&self) -> &'static str {
        self.parameters.id
    }

    /// The model by the vehicle's numbers with a mass.
    pub(super) fn model_of(&self, mass_kg: f64) -> GreyBoxModel {
        GreyBoxModel::of(&self.parameters, mass_kg, GRAVITY_STANDARD_M_S2)
    }

    /// The settings with which its rotors are heard in a hover.
    fn config(&self) -> Result<Config, Failure> {
        let said = Said { vehicle: Some(self.preset), mass_kg: Some(self.mass_kg), ..Said::default() };
        Ok(said.settings()?.0)
    }

    /// The settings with which their mean is heard, without the given mass.
    pub(super) fn mean_config(&self) -> Result<Config, Failure> {
        let said = Said { vehicle: Some(self.preset), mean_only: true, ..Said::default() };
        Ok(said.settings()?.0)
    }

    pub(crate) fn slope_v_s_rad(&self, fit: &GreyBoxFit) -> f64 {
        MotorVolts::of(&self.parameters).slope_v_s_rad(fit.model.mean_hover_rad_s())
    }
}

/// A log that was read.
pub(crate) struct FlownLog {
    pub(crate) log: ControlLog,
    pub(crate) inputs: LoopInputs,
    /// Logged speeds, rad/s, of all four rotors.
    pub(crate) speeds_rad_s: Option<[Vec<f64>; 4]>,
    pub(crate) loss: Option<String>,
    /// By how much the sound has moved the clock of the log, s; 0 where the given one is right.
    pub(crate) moved_s: f64,
    /// The loops that are left out, since the log lacks a signal.
    pub(crate) left_out: Vec<Notice>,
}

impl FlownLog {
    pub(crate) fn read(
        path: &Path,
        names: &ColumnNames,
        axes: RateAxes,
        offset_s: f64,
        vehicle: &GreyBoxVehicle,
    ) -> Result<Self, Failure> {
        let control =
            control_from_log(open_stream(path, THE_LOG)?, names, axes).map_err(|error| log_failure(&error, path))?;
        let refused = |what: &str| {
            let hint = "`hovertone greybox --help` lists the columns that are needed; `hovertone log FILE --signals` lists the columns of a log";
            Failure::failed(what, hint, path)
        };
        let beyond = control.command.iter().flatten().flatten().find(|command| command.abs() > 1.0 + 1e-9);
        if let Some(command) = beyond {
            let what = format!(
                "a command of this log is {command}, but commands must be from −1 to 1: 0 is the stick in the middle, \
                 and 1 the full stick"
            );
            let hint =
                "for a stick from 1000 to 2000 µs, write (value − 1500) / 500; for a stick in percent, value / 100";
            return Err(Failure::Usage { what, hint: hint.to_owned(), path: Some(path.to_owned()) });
        }
        let speeds_rad_s = speeds_rad_s(&control);
        let log = control_log(control.clone(), offset_s);
        let inputs = LoopInputs::from_log(&log, &ControlKnowns::of(&vehicle.parameters))
            .ok_or_else(|| refused("this log has fewer than two rows with both commands and measurements"))?;
        if !inputs.has_loop.contains(&true) {
            return Err(without_loops(&control.missing, path));
        }
        let left_out = control.missing.iter().map(left_out).collect();
        Ok(Self { log, inputs, speeds_rad_s, loss: control.loss, moved_s: 0.0, left_out })
    }

    /// Fails where no command changes.
    fn require_doublets(&self, path: &Path) -> Result<(), Failure> {
        let range = |commands: &[f64]| {
            let finite = || commands.iter().copied().filter(|command| command.is_finite());
            finite().fold(f64::NEG_INFINITY, f64::max) - finite().fold(f64::INFINITY, f64::min)
        };
        let is_flown = self.log.command.iter().flatten().any(|commands| range(commands) >= COMMAND_CHANGE_MIN);
        let what = format!(
            "no doublets were flown: no command of this log changes by {COMMAND_CHANGE_MIN} or more, where 1 is the full stick"
        );
        if is_flown { Ok(()) } else { Err(Failure::failed(what, FLY_DOUBLETS, path)) }
    }

    /// Moves the clock of the log to where the sound follows the log. Returns whether it follows it anywhere.
    fn align(&mut self, lines: &HeardLines, model: &GreyBoxModel) -> bool {
        let Some(offset_s) = log_offset_s(lines, &self.inputs, model, &SoundConfig::default()) else { return false };
        if offset_s.abs() > CLOCK_RIGHT_S {
            self.log.time_s.iter_mut().for_each(|time_s| *time_s += offset_s);
            self.inputs.start_s += offset_s;
            self.moved_s = offset_s;
        }
        true
    }
}

fn left_out(missing: &MissingControl) -> Notice {
    let MissingControl { control_loop, what, hint } = missing;
    Notice::new(format!("the model leaves out the control of {}: the log lacks {what}", control_loop.name()), *hint)
}

/// The failure of a log in which every loop lacks something.
fn without_loops(missing: &[MissingControl], path: &Path) -> Failure {
    let mut hints: Vec<&str> = missing.iter().map(|missing| missing.hint).collect();
    hints.dedup();
    let lacks: Vec<String> =
        missing.iter().map(|missing| format!("{} lacks {}", missing.control_loop.name(), missing.what)).collect();
    let what = format!(
        "this log has no command together with the angle or rate that the command controls: {}",
        lacks.join("; ")
    );
    Failure::failed(what, hints.join("; "), path)
}

fn speeds_rad_s(control: &LoggedControl) -> Option<[Vec<f64>; 4]> {
    let in_rad_s = |speeds: &Vec<f64>| speeds.iter().map(|rev_s| RotorSpeed::from_rev_s(*rev_s).rad_s()).collect();
    let [Some(one), Some(two), Some(three), Some(four)] = &control.speeds_rev_s else { return None };
    Some([one, two, three, four].map(in_rad_s))
}

/// Euler rates from the body rates where these are logged, and the clock of the recording.
fn control_log(control: LoggedControl, offset_s: f64) -> ControlLog {
    let LoggedControl { time_s, command, tilt_rad, rates_rad_s, climb_m_s, .. } = control;
    let rows = time_s.len();
    let at = |series: &Option<Vec<f64>>, row: usize| series.as_ref().map(|values| values[row]);
    let angle = |axis: usize, row: usize| at(&tilt_rad[axis], row).unwrap_or(0.0);
    let euler = |row: usize| -> Option<[f64; 3]> {
        let [p, q, r] = [at(&rates_rad_s[0], row)?, at(&rates_rad_s[1], row)?, at(&rates_rad_s[2], row)?];
        let ((sin_roll, cos_roll), (sin_pitch, cos_pitch)) = (angle(0, row).sin_cos(), angle(1, row).sin_cos());
        let turn = (q * sin_roll + r * cos_roll) / cos_pitch;
        Some([p + turn * sin_pitch, q * cos_roll - r * sin_roll, turn])
    };
    let whole: Option<Vec<[f64; 3]>> = (0..rows).map(euler).collect();
    let rate = |axis: usize| match &whole {
        Some(rates) => Some(rates.iter().map(|rates| rates[axis]).collect::<Vec<f64>>()),
        None => rates_rad_s[axis].clone(),
    };
    ControlLog {
        time_s: time_s.iter().map(|time_s| time_s + offset_s).collect(),
        command,
        measured: [tilt_rad[0].clone(), tilt_rad[1].clone(), rate(2), climb_m_s],
        tilt_rate_rad_s: [rate(0), rate(1)],
    }
}

/// A fit with the speeds that it was made from.
pub(crate) struct Heard {
    pub(crate) fit: GreyBoxFit,
    pub(crate) observations: Vec<SpeedObservation>,
    pub(crate) names_nats: Option<f64>,
    /// The echoes of the place; `None` in the open.
    pub(crate) echoes: Option<Echoes>,
    /// A rotor of another vehicle that fits the sound far better.
    pub(crate) better: Option<OtherRotor>,
    /// Where the mass of the vehicle means another hover speed than that of the flight.
    pub(crate) other_hover: Option<OtherHover>,
}

impl Heard {
    pub(crate) fn speeds(&self, flown: &FlownLog) -> Speeds {
        Speeds { observations: self.observations.clone(), prediction: self.fit.prediction(&flown.inputs) }
    }
}

/// Observed and predicted speeds.
pub(crate) struct Speeds {
    pub(crate) observations: Vec<SpeedObservation>,
    pub(crate) prediction: SpeedPrediction,
}

/// Fits the model to a flight.
pub(crate) fn fit_of(
    files: &FlightFiles,
    flown: &mut FlownLog,
    vehicle: &GreyBoxVehicle,
    hearing: Hearing,
    progress: &Progress,
) -> Result<Heard, Failure> {
    let stopped = |stop: GreyBoxStop| {
        let what = match stop {
            GreyBoxStop::NotConverged => {
                format!("the model of the vehicle \"{}\" could not be fitted to this flight", vehicle.id())
            }
            _ => stop.to_string(),
        };
        let of_sound = files.recording.is_some();
        let hint = match stop {
            GreyBoxStop::NotConverged => format!("check --vehicle and --log-axes; if both are right, {FLY_DOUBLETS}"),
            GreyBoxStop::TooShort { .. } if of_sound => {
                format!(
                    "{FLY_DOUBLETS}, and record the whole flight; or give the log alone, if it has the speeds of the rotors"
                )
            }
            GreyBoxStop::TooShort { .. } => {
                "log the speeds more often, or fly longer (the stick to one side, then to the other, again and again)"
                    .to_owned()
            }
            GreyBoxStop::TooFew { .. } if of_sound => format!(
                "check that the log belongs to this recording; if the clocks of the two differ, give --log-offset-s; if both are right, {FLY_DOUBLETS}"
            ),
            _ => format!("{FLY_DOUBLETS}; log the commands and the angles"),
        };
        match stop {
            // a flag may be wrong
            GreyBoxStop::NotConverged => Failure::Usage { what, hint, path: Some(files.log.clone()) },
            _ => Failure::failed(what, hint, &files.log),
        }
    };
    match &files.recording {
        None => {
            let observations = logged_observations(flown, files)?;
            let Start { model: start, other_hover } = Start::near(vehicle, mean_of(&observations));
            let fit = grey_box_from_speeds(&observations, &flown.inputs, &start, &GreyBoxConfig::default());
            // a log that is too short is told first
            if matches!(fit, Ok(_) | Err(GreyBoxStop::NotConverged)) {
                flown.require_doublets(&files.log)?;
            }
            let fit = fit.map_err(stopped)?;
            let change = checked(&observations, &fit.prediction(&flown.inputs)).map(|checked| checked.change_share);
            if change.is_some_and(|change| change < SPEED_CHANGE_MIN) {
                let what = "the rotor speeds of this log do not change, so no model can be found";
                return Err(Failure::failed(what, FLY_DOUBLETS, &files.log));
            }
            Ok(Heard { fit, observations, names_nats: None, echoes: None, better: None, other_hover })
        }
        Some(recording) => {
            let mean = heard_mean(recording, vehicle, hearing, progress)?;
            let Start { model: start, other_hover } = Start::near(vehicle, mean);
            let lines = heard_lines(recording, flown, &start, vehicle, hearing, progress)?;
            flown.require_doublets(&files.log)?;
            if !flown.align(&lines, &start) {
                return Err(not_followed(&files.log));
            }
            let better = better_rotor(recording, &vehicle.config()?, hearing, progress)?;
            let fitting = &mut progress.next("fitting the model to the sound");
            let told = &mut |share| fitting.set(share);
            let heard = grey_box_from_sound(&lines, &flown.inputs, &start, &SoundConfig::default(), told);
            let SoundFit { fit, observations, names_nats, echoes } = heard.map_err(stopped)?;
            Ok(Heard { fit, observations, names_nats: Some(names_nats), echoes, better, other_hover })
        }
    }
}

/// The failure of a log that the sound does not follow.
fn not_followed(log: &Path) -> Failure {
    let what = "the rotor speeds in the sound do not follow the commands of this log, even if one clock is moved by up to 10 s";
    let hint = "give the recording and the log of the same flight; check --vehicle; if the clocks differ by more than 10 s, give --log-offset-s";
    Failure::failed(what, hint, log)
}

/// Observed and predicted speeds of another flight. Where its speeds hardly change, its clock is taken as given.
pub(crate) fn speeds_of(
    files: &FlightFiles,
    flown: &mut FlownLog,
    fitted: &Heard,
    vehicle: &GreyBoxVehicle,
    hearing: Hearing,
    progress: &Progress,
) -> Result<Speeds, Failure> {
    match &files.recording {
        None => Ok(Speeds {
            observations: logged_observations(flown, files)?,
            prediction: fitted.fit.prediction(&flown.inputs),
        }),
        Some(recording) => {
            let lines = heard_lines(recording, flown, &fitted.fit.model, vehicle, hearing, progress)?;
            flown.align(&lines, &fitted.fit.model);
            let (observations, prediction) = speeds_along(&lines, &flown.inputs, &fitted.fit, &SoundConfig::default());
            Ok(Speeds { observations, prediction })
        }
    }
}

fn logged_observations(flown: &FlownLog, files: &FlightFiles) -> Result<Vec<SpeedObservation>, Failure> {
    let Some(speeds) = &flown.speeds_rad_s else {
        let what = "this log does not have the speeds of four rotors, and no recording is given";
        let hint = "give the recording before the log, or a log with speed_1_rad_s to speed_4_rad_s";
        let flight = flight_of(&files.log, &column_names(&[])?).ok().flatten();
        let electrical = flight.and_then(|flight| with_electrical_speeds(&files.log, &flight));
        return Err(electrical.unwrap_or_else(|| Failure::failed(what, hint, &files.log)));
    };
    let finite = speeds.iter().flatten().copied().filter(|speed| speed.is_finite());
    let (sum, count) = finite.fold((0.0, 0.0), |(sum, count), speed| (sum + speed, count + 1.0));
    let std_rad_s = LOGGED_STD_SHARE * sum / f64::max(count, 1.0);
    if std_rad_s <= 0.0 {
        return Err(Failure::failed("the rotors of this log do not turn", "give the log of a flight", &files.log));
    }
    let speeds = std::array::from_fn(|rotor| speeds[rotor].as_slice());
    Ok(observations_of_rows(&flown.log.time_s, speeds, std_rad_s))
}

/// The lines of a recording, in the range of speeds that a model predicts.
fn heard_lines(
    recording: &Path,
    flown: &FlownLog,
    model: &GreyBoxModel,
    vehicle: &GreyBoxVehicle,
    hearing: Hearing,
    progress: &Progress,
) -> Result<HeardLines, Failure> {
    let prediction = SpeedPrediction::new(&flown.inputs, model);
    let (slowest, fastest) = prediction.range_rad_s();
    let rev_s = |rad_s: f64| RotorSpeed::from_rad_s(rad_s).rev_s();
    let mean_rad_s = model.mean_hover_rad_s();
    let (slowest, fastest) = (slowest.clamp(0.5 * mean_rad_s, mean_rad_s), fastest.clamp(mean_rad_s, 1.6 * mean_rad_s));
    let range = rev_s(slowest * (1.0 - RANGE_SHARE))..rev_s(fastest * (1.0 + RANGE_SHARE));
    lines_of(recording, hearing, &vehicle.orders, range, progress)
}
