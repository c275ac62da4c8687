//! `hovertone motor`: constants of motors from the steps in a log or in a recording.

use crate::args::{AnalysisArguments, HearingArguments, KnownArguments, MotorArguments, ToneArguments};
use crate::each_file::EachFile;
use crate::failure::{Ending, Failure};
use crate::figure_file::FigureKind;
use crate::inputs::{STDIN, is_stdin, name_of, open_stream};
use crate::jobs::jobs_of;
use crate::log::{column_names, log_failure, notices_of, without_speeds};
use crate::of_recording::{flags_of, refuse_of_recording};
use crate::outputs::{Outputs, written};
use crate::progress::Progress;
use crate::recording::{Hearing, Requests, motor_in};
use crate::settings::{config_of, idle_mass};
use crate::terminal::Terminal;
use hovertone::motors::HeardCommands;
use hovertone::speed::Config;
use hovertone::tones::Discovery;
use hovertone_dynamics::{
    BenchTorque, CommandSeries, MotorConfig, MotorModel, MotorSeries, TorqueSeries, command_of_speed,
    motor_from_series, torque_of_motor,
};
use hovertone_figures::{DOTS_PER_INCH, DrawnStep, motor_steps_figure};
use hovertone_logs::{ColumnNames, LogError, LoggedFlight, LoggedMotors, flight_from_log};
use hovertone_report::{
    BENCH_RUN, LoggedMotor, MotorRecord, MotorSound, MotorSource, Notice, motor_json, motor_text, printable,
    significant,
};
use hovertone_vehicle::LOGGED_REV_S_MAX;
use std::path::Path;

/// Names of the one motor of a recording.
const ALL_ROTORS: &str = "all rotors";
const ONE_ROTOR: &str = "the rotor";

/// Tells the constants of the motors of all files.
pub(crate) fn run(arguments: &MotorArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let plan = Plan::of(arguments)?;
    let files = EachFile { files: &arguments.files, has_gaps: !arguments.json };
    files.told(terminal, |file| plan.told_of(file), |_, told, terminal| plan.tell(&told, terminal))
}

/// The meaning of the arguments.
struct Plan<'a> {
    arguments: &'a MotorArguments,
    names: ColumnNames,
    figure: Option<FigureFile<'a>>,
    config: Config,
    discovery: Option<Discovery>,
    commands: Option<LoggedMotors>,
    of_recording: Vec<String>,
}

/// What a file tells of its motors.
struct Told {
    record: MotorRecord,
    /// The speeds of each motor of the record.
    rows: Vec<MotorRows>,
    notices: Vec<Notice>,
    /// Whether nothing of the file is lost.
    is_whole: bool,
}

#[derive(Clone, Debug, Default)]
struct MotorRows {
    time_s: Vec<f64>,
    speed_rev_s: Vec<f64>,
}

impl<'a> Plan<'a> {
    fn of(arguments: &'a MotorArguments) -> Result<Self, Failure> {
        let names = column_names(&arguments.column)?;
        let figure = arguments.figure.as_deref().map(|place| FigureFile::of(place, arguments)).transpose()?;
        let analysis = AnalysisArguments {
            from: arguments.from,
            to: arguments.to,
            mean_only: true,
            ..AnalysisArguments::default()
        };
        let (config, discovery) = config_of(&arguments.tone, &arguments.known, &analysis)?;
        let commands = arguments.commands.as_deref().map(|path| commands_of(path, &names)).transpose()?;
        Ok(Self { arguments, names, figure, config, discovery, commands, of_recording: flags_of_recording() })
    }

    fn told_of(&self, file: &Path) -> Result<Told, Failure> {
        match flight_of(file, &self.names)? {
            Some(flight) if flight.speeds_rev_s.is_none() => Err(without_speeds(file, &flight)),
            Some(flight) => {
                refuse_of_recording(&self.of_recording, file)?;
                Ok(told_by_log(file, &flight))
            }
            None => self.told_by_sound(file),
        }
    }

    fn tell(&self, told: &Told, terminal: &mut Terminal) -> Result<Ending, Failure> {
        let mut ending = if told.record.has_time_constant() { Ending::Done } else { Ending::Incomplete };
        if !told.notices.is_empty() {
            terminal.warning_count(told.notices.len());
            told.notices.iter().for_each(|notice| terminal.warning(notice, ""));
            ending = ending.max(if told.is_whole { Ending::Done } else { Ending::Incomplete });
        }
        if self.arguments.json {
            terminal.data(&motor_json(&told.record).map_err(Failure::internal)?)?;
        } else {
            let width = terminal.fold_width();
            terminal.text(&motor_text(&told.record, width))?;
        }
        if let Some(figure) = &self.figure {
            terminal.flush()?;
            figure.write(told, terminal)?;
        }
        Ok(ending)
    }

    fn told_by_sound(&self, file: &Path) -> Result<Told, Failure> {
        let jobs = jobs_of(&[file.to_owned()], &self.config, self.discovery, Requests::default())?;
        let Some(job) = jobs.first() else { return Err(Failure::internal("a file without a job")) };
        let hearing = Hearing::of(&self.arguments.hearing);
        let progress = Progress::new("listening to", 1, !self.arguments.hearing.no_progress);
        // one microphone hears all rotors together: the first command stands for all
        let commands = self.commands.as_ref().and_then(|commands| Some((commands, commands.values.first()?)));
        let heard_commands = commands.map(|(commands, command)| HeardCommands {
            series: CommandSeries { time_s: &commands.time_s, command },
            offset_s: self.arguments.offset,
        });
        let heard = motor_in(job, hearing, heard_commands, &progress);
        progress.finish();
        let heard = heard.map_err(|reason| {
            let what = format!("this file is neither a log nor a recording that hovertone can hear: {reason}");
            Failure::failed(what, "", file)
        })?;
        let mut sound = MotorSound {
            has_commands: commands.is_some(),
            blades: self.arguments.tone.blades,
            order: self.arguments.tone.order,
            ..MotorSound::default()
        };
        let (mut motors, mut rows, mut unused) = (Vec::new(), Vec::new(), None);
        match heard.motor {
            Err(reason) => sound.no_tone = Some(reason.to_string()),
            Ok(motor) => {
                (sound.frame_s, sound.offset_s) = (motor.frame_s, motor.offset_s);
                let is_used = motor.model.as_ref().is_some_and(|model| model.static_map.is_some());
                let command = commands.and_then(|(commands, _)| commands.names.first()).filter(|_| is_used).cloned();
                unused = self
                    .misaligned(motor.other_offset_s)
                    .or_else(|| self.unused_commands(motor.model.as_ref()).filter(|_| !is_used));
                let name = if self.arguments.known.rotors == Some(1) { ONE_ROTOR } else { ALL_ROTORS };
                motors.extend(motor.model.map(|model| LoggedMotor { name: name.to_owned(), command, model }));
                sound.no_tone = motors.is_empty().then(|| self.nothing_held());
                rows.push(MotorRows { time_s: motor.time_s, speed_rev_s: motor.speed_rev_s });
            }
        }
        let record = MotorRecord { file: name_of(file), source: MotorSource::Sound(sound), motors, torque: None };
        let idle_mass = idle_mass(&self.arguments.known, &self.config.known);
        let notices = idle_mass.into_iter().chain(heard.notices).chain(unused.clone()).collect();
        Ok(Told { record, rows, notices, is_whole: unused.is_none() })
    }
}

impl Plan<'_> {
    /// That a tone is heard, but no speed, and what to do.
    fn nothing_held(&self) -> String {
        let is_part = self.arguments.from.or(self.arguments.to).is_some();
        let advice = if is_part { "choose a longer part with --from and --to" } else { "record a longer run" };
        format!(
            "no speed stays the same for a second, or the rotor is too faint; {advice}, in which each speed stays \
             the same for a second or longer, or place the microphone nearer"
        )
    }

    /// That the commands of a log do not belong to this sound; `None` where none are given.
    fn unused_commands(&self, model: Option<&MotorModel>) -> Option<Notice> {
        let log = printable(&name_of(self.arguments.commands.as_ref()?));
        let has_steps = model.is_some_and(|model| !model.steps.is_empty());
        let (why, hint) = match has_steps {
            true => (
                "they and the heard speeds do not change at the same times",
                "check that the log and the recording are of the same run".to_owned(),
            ),
            // the text gives the advice below
            false => (
                "no step of the speed is heard, from one steady value to another",
                match self.arguments.json {
                    true => format!("record {BENCH_RUN}"),
                    false => String::new(),
                },
            ),
        };
        Some(Notice::new(format!("the commands of {log} are not used: {why}"), hint))
    }

    /// That the steps of commands and sound agree at another offset than the given one.
    fn misaligned(&self, other_offset_s: Option<f64>) -> Option<Notice> {
        let (given_s, other_s) = self.arguments.offset.zip(other_offset_s)?;
        let what = format!(
            "with --offset {given_s}, commands and speed do not change at the same times, so the commands are not used"
        );
        let hint = format!(
            "check the offset; without --offset, hovertone uses {other_s:.2} s, because then they change at the same times, and tells no dead time"
        );
        Some(Notice::new(what, hint))
    }
}

/// The flags that mean nothing for a log.
fn flags_of_recording() -> Vec<String> {
    let of_motor = ["--commands", "--from", "--to"].map(str::to_owned).to_vec();
    let of_groups = [flags_of::<ToneArguments>(), flags_of::<KnownArguments>(), flags_of::<HearingArguments>()];
    of_motor.into_iter().chain(of_groups.concat()).collect()
}

fn told_by_log(file: &Path, flight: &LoggedFlight) -> Told {
    let record = motors_of_log(&name_of(file), flight);
    let values_of = |name: &str| {
        let speeds = flight.speeds_rev_s.as_ref()?;
        let (_, values) = speeds.names.iter().zip(&speeds.values).find(|(of, _)| *of == name)?;
        Some(MotorRows { time_s: speeds.time_s.clone(), speed_rev_s: values.clone() })
    };
    let rows = record.motors.iter().map(|motor| values_of(&motor.name).unwrap_or_default()).collect();
    Told { record, rows, is_whole: flight.notes.is_empty(), notices: notices_of(flight) }
}

/// Where the steps are drawn.
struct FigureFile<'a> {
    place: &'a Path,
    kind: FigureKind,
    outputs: Outputs,
}

impl<'a> FigureFile<'a> {
    /// Checks, before any file is read, that the figure can be written.
    fn of(place: &'a Path, arguments: &MotorArguments) -> Result<Self, Failure> {
        let kind = FigureKind::of(place, "use --figure steps.png or --figure steps.svg")?;
        if arguments.files.len() > 1 {
            let what = format!("--figure draws one file, but {} files are given", arguments.files.len());
            return Err(Failure::usage(what, "give one file at a time"));
        }
        let outputs = Outputs::beside(arguments.files.iter().chain(&arguments.commands), arguments.replace.force);
        outputs.check(place)?;
        Ok(Self { place, kind, outputs })
    }

    fn write(&self, told: &Told, terminal: &mut Terminal) -> Result<(), Failure> {
        let steps: Vec<DrawnStep> = (told.record.motors.iter().zip(&told.rows))
            .flat_map(|(motor, rows)| {
                let MotorRows { time_s, speed_rev_s } = rows;
                let drawn = move |step| DrawnStep { motor: &motor.name, step, time_s, speed_rev_s };
                motor.model.steps.iter().map(drawn)
            })
            .collect();
        let Some(figure) = motor_steps_figure(&steps).map_err(Failure::internal)? else {
            terminal.say("no figure was written, because no step of the speed has a time constant");
            return Ok(());
        };
        self.outputs.write(self.place, self.kind.bytes(figure, DOTS_PER_INCH)?)?;
        terminal.say(&written(self.place));
        Ok(())
    }
}

/// The commands of a log.
fn commands_of(path: &Path, names: &ColumnNames) -> Result<LoggedMotors, Failure> {
    let flight = flight_of(path, names)?.ok_or_else(|| log_failure(&LogError::UnknownFormat, path))?;
    let commands = flight.commands.filter(|commands| !commands.values.is_empty());
    commands.ok_or_else(|| {
        let hint = "give a log with motor commands, or a CSV with columns such as time_s and motor1_pwm (--column renames columns)";
        Failure::failed("this file of --commands has no motor commands", hint, path)
    })
}

/// The motors of a log; `None` if the file is none.
pub(crate) fn flight_of(file: &Path, names: &ColumnNames) -> Result<Option<LoggedFlight>, Failure> {
    let stream = open_stream(file, "the log or recording")?;
    let flight = match flight_from_log(stream, names) {
        Ok(flight) => flight,
        Err(LogError::UnknownFormat) if !is_stdin(file) => return Ok(None),
        Err(LogError::UnknownFormat) => {
            let hint = "send a log to stdin; give a recording by the name of its file, in place of -";
            return Err(Failure::failed("this is no log", hint, Path::new(STDIN)));
        }
        Err(error) => return Err(log_failure(&error, file)),
    };
    let speeds = flight.speeds_rev_s.iter().flat_map(|speeds| speeds.values.iter().flatten());
    let fastest_rev_s = speeds.copied().fold(0.0, f64::max);
    if fastest_rev_s > LOGGED_REV_S_MAX {
        let what = format!(
            "in this log, a motor turns at {} rev/s, but no motor exceeds {LOGGED_REV_S_MAX} rev/s",
            significant(fastest_rev_s, 4)
        );
        let hint =
            "check the unit in the header of the speed column, or give the unit, as in --column HEADER=rotor1_rpm"
                .to_owned();
        return Err(Failure::Usage { what, hint, path: Some(file.to_owned()) });
    }
    Ok(Some(flight))
}

/// The motors of a log, with C_τ where it has a torque.
pub(crate) fn motors_of_log(file: &str, flight: &LoggedFlight) -> MotorRecord {
    let motors = motors_of(flight);
    let torque = torque_of(flight, &motors);
    MotorRecord { file: file.to_owned(), source: MotorSource::Log, motors, torque }
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

/// C_τ by the torque of a log, or why the log does not tell it. `None` where no motor turns.
fn torque_of(flight: &LoggedFlight, motors: &[LoggedMotor]) -> Option<BenchTorque> {
    let speeds = flight.speeds_rev_s.as_ref()?;
    let Some(torque) = &flight.torque else { return motors.first().map(|_| BenchTorque::NoTorque) };
    let [motor] = motors else { return motors.first().map(|_| BenchTorque::SeveralMotors) };
    let (_, speed_rev_s) = speeds.names.iter().zip(&speeds.values).find(|(name, _)| **name == motor.name)?;
    let series = MotorSeries { time_s: &speeds.time_s, speed_rev_s };
    let command = flight.commands.as_ref().and_then(|commands| {
        let at = commands.names.iter().position(|name| Some(name) == motor.command.as_ref())?;
        Some(CommandSeries { time_s: &commands.time_s, command: &commands.values[at] })
    });
    let torque = TorqueSeries { time_s: &torque.time_s, torque_n_m: &torque.torque_n_m };
    Some(torque_of_motor(&series, command.as_ref(), &torque, &MotorConfig::default()))
}

fn command_at(commands: &LoggedMotors, name: &str, series: &MotorSeries) -> Option<usize> {
    let named = commands.names.iter().position(|of_command| of_command == name);
    let all: Vec<CommandSeries> =
        commands.values.iter().map(|command| CommandSeries { time_s: &commands.time_s, command }).collect();
    named.or_else(|| command_of_speed(series, &all).map(|(at, _)| at))
}
