//! `hovertone motor`: constants of motors from the steps in a log.

use crate::args::MotorArguments;
use crate::failure::{Ending, Failure};
use crate::figure_file::FigureKind;
use crate::inputs::{STDIN, is_stdin, open_stream};
use crate::log::{THE_LOG, column_names, log_failure, loss_notice};
use crate::outputs::{Outputs, written};
use crate::terminal::Terminal;
use hovertone_dynamics::{CommandSeries, MotorConfig, MotorSeries, command_of_speed, motor_from_series};
use hovertone_figures::{DOTS_PER_INCH, DrawnStep, motor_steps_figure};
use hovertone_logs::{ColumnNames, LogError, LoggedFlight, LoggedMotors, flight_from_log};
use hovertone_report::{LoggedMotor, MotorRecord, motor_json, motor_text};
use std::path::Path;

/// Largest speed of a log, rev/s. *Physics*: the electrical speed of the fastest motors, which logs hold where the pole pairs are not known, stays
/// below a million rpm.
const SPEED_REV_S_MAX: f64 = 17_000.0;

/// Tells the constants of the motors of all logs.
pub(crate) fn run(arguments: &MotorArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let names = column_names(&arguments.column)?;
    let figure = arguments.figure.as_deref().map(|place| FigureFile::of(place, arguments)).transpose()?;
    let mut ending = Ending::Done;
    for (index, file) in arguments.files.iter().enumerate() {
        let flight = match flight_of(file, &names) {
            Ok(flight) => flight,
            // the other logs are read all the same
            Err(failure @ Failure::Failed { .. }) if arguments.files.len() > 1 => {
                terminal.failure(&failure);
                ending = ending.max(Ending::FilesFailed);
                continue;
            }
            Err(failure) => return Err(failure),
        };
        let file = if is_stdin(file) { STDIN.to_owned() } else { file.display().to_string() };
        let record = MotorRecord { file, motors: motors_of(&flight) };
        if !record.has_time_constant() {
            ending = ending.max(Ending::Incomplete);
        }
        if arguments.json {
            terminal.data(&motor_json(&record).map_err(Failure::internal)?)?;
        } else {
            let gap = if index > 0 { "\n" } else { "" };
            let width = terminal.fold_width();
            terminal.text(&format!("{gap}{}", motor_text(&record, width)))?;
        }
        if !flight.notes.is_empty() {
            terminal.flush()?;
            flight.notes.iter().for_each(|words| terminal.warning(&loss_notice(words), ""));
            ending = ending.max(Ending::Incomplete);
        }
        if let Some(figure) = &figure {
            terminal.flush()?;
            figure.write(&record, &flight, terminal)?;
        }
    }
    Ok(ending)
}

/// Where the steps are drawn.
struct FigureFile<'a> {
    place: &'a Path,
    kind: FigureKind,
    outputs: Outputs,
}

impl<'a> FigureFile<'a> {
    /// Checks, before any log is read, that the figure can be written.
    fn of(place: &'a Path, arguments: &MotorArguments) -> Result<Self, Failure> {
        let kind = FigureKind::of(place, "use --figure steps.png or --figure steps.svg")?;
        if arguments.files.len() > 1 {
            let what = format!("--figure draws one log, and {} are given", arguments.files.len());
            return Err(Failure::usage(what, "give one log at a time"));
        }
        let outputs = Outputs::beside(&arguments.files, arguments.replace.force);
        outputs.check(place)?;
        Ok(Self { place, kind, outputs })
    }

    fn write(&self, record: &MotorRecord, flight: &LoggedFlight, terminal: &mut Terminal) -> Result<(), Failure> {
        let Some(speeds) = &flight.speeds_rev_s else { return Ok(()) };
        let values_of = |name: &str| speeds.names.iter().zip(&speeds.values).find(|(of, _)| *of == name);
        let drawn = record.motors.iter().filter_map(|motor| Some((motor, values_of(&motor.name)?.1)));
        let steps: Vec<DrawnStep> = drawn
            .flat_map(|(motor, values)| {
                let drawn = |step| DrawnStep { motor: &motor.name, step, time_s: &speeds.time_s, speed_rev_s: values };
                motor.model.steps.iter().map(drawn)
            })
            .collect();
        let Some(figure) = motor_steps_figure(&steps).map_err(Failure::internal)? else {
            terminal.say("no step with a time constant: no figure was written");
            return Ok(());
        };
        self.outputs.write(self.place, self.kind.bytes(figure, DOTS_PER_INCH)?)?;
        terminal.say(&written(self.place));
        Ok(())
    }
}

fn flight_of(file: &Path, names: &ColumnNames) -> Result<LoggedFlight, Failure> {
    let stream = open_stream(file, THE_LOG)?;
    let flight = flight_from_log(stream, names).map_err(|error| match error {
        LogError::UnknownFormat => {
            let what = "`motor` reads logs, and this is none; recordings are not supported";
            Failure::failed(what, error.hint(), file)
        }
        error => log_failure(&error, file),
    })?;
    let speeds = flight.speeds_rev_s.iter().flat_map(|speeds| speeds.values.iter().flatten());
    let fastest_rev_s = speeds.copied().fold(0.0, f64::max);
    if fastest_rev_s > SPEED_REV_S_MAX {
        let what =
            format!("a motor of this log has {fastest_rev_s:.3e} rev/s, and none exceeds {SPEED_REV_S_MAX} rev/s");
        let hint = "check the unit in the header of the speed, or name it: --column HEADER=rotor1_rpm".to_owned();
        return Err(Failure::Usage { what, hint, path: Some(file.to_owned()) });
    }
    Ok(flight)
}

/// The motors that turn, each with its command: that of the same name, else the one that its speed follows best.
fn motors_of(flight: &LoggedFlight) -> Vec<LoggedMotor> {
    let Some(speeds) = &flight.speeds_rev_s else { return Vec::new() };
    let config = MotorConfig::default();
    let motor = |(name, values): (&String, &Vec<f64>)| {
        let series = MotorSeries { time_s: &speeds.time_s, speed_rev_s: values };
        let of_commands =
            flight.commands.as_ref().and_then(|commands| Some((commands, command_at(commands, name, &series)?)));
        let command =
            of_commands.map(|(commands, at)| CommandSeries { time_s: &commands.time_s, command: &commands.values[at] });
        let model = motor_from_series(series, command, &config)?;
        let command = of_commands.map(|(commands, at)| commands.names[at].clone());
        Some(LoggedMotor { name: name.clone(), command, model })
    };
    speeds.names.iter().zip(&speeds.values).filter_map(motor).collect()
}

fn command_at(commands: &LoggedMotors, name: &str, series: &MotorSeries) -> Option<usize> {
    let named = commands.names.iter().position(|of_command| of_command == name);
    let all: Vec<CommandSeries> =
        commands.values.iter().map(|command| CommandSeries { time_s: &commands.time_s, command }).collect();
    named.or_else(|| command_of_speed(series, &all).map(|(at, _)| at))
}
