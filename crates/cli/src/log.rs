//! `hovertone log`: what a log holds, and its signals as CSV.

use crate::args::{ColumnName, LogArguments};
use crate::caller::command_word;
use crate::each_file::EachFile;
use crate::failure::{Ending, Failure};
use crate::inputs::{name_of, open_stream};
use crate::nearest::nearest;
use crate::outputs::{Outputs, is_recording, written};
use crate::terminal::Terminal;
use crate::text_file::{TextFormat, TextKind};
use crate::typed::{quoted, typed_command};
use hovertone_logs::{
    ColumnNames, ElectricalColumn, LogError, LogSummary, LoggedFlight, Loss, NamedColumn, SignalRow, log_summary,
    signal_rows,
};
use hovertone_report::{Notice, NoticeKind, counted, log_json, log_text, signal_headers};
use std::io::BufWriter;
use std::path::Path;

/// Name of a log in messages.
pub(crate) const THE_LOG: &str = "the log";
const IS_RECORDING: &str = "this is a recording, but a log is needed";
const HINT_OF_RECORDING: &str =
    "leave the recording out, or give the log of the flight in its place; `hovertone speed` hears a recording";
/// The commands that take names for columns.
const WITH_COLUMNS: [&str; 4] = ["log", "motor", "verify", "greybox"];
const SIGNALS: TextKind =
    TextKind { content: "a table of signals", format: TextFormat::Csv, example: "-o signals.csv" };
const HINT_OF_LOSS: &str = "hovertone used the part that it could read; download the log again. If the new copy has the same fault, log \
another flight, and do not cut the power before the log is closed";

/// Lists all logs, or writes signals of one.
pub(crate) fn run(arguments: &LogArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let names = column_names(&arguments.column)?;
    if let Some(output) = &arguments.output {
        return match arguments.files.as_slice() {
            [file] => write_signals(file, output, &names, arguments, terminal),
            files => {
                let what = format!("--signal writes the signals of one log, but {} logs are given", files.len());
                Err(Failure::usage(what, "give one log at a time"))
            }
        };
    }
    let read = |file: &Path| {
        let stream = open_stream(file, THE_LOG)?;
        log_summary(stream, &names).map_err(|error| log_failure(&error, file))
    };
    let files = EachFile { files: &arguments.files, has_gaps: !arguments.json };
    files.told(terminal, read, |file, log, terminal| tell(file, &log, arguments, terminal))
}

/// Writes what a log holds.
fn tell(file: &Path, log: &LogSummary, arguments: &LogArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let ending = warn_of_loss(&log.loss, terminal)?;
    if let Some(notice) = electrical_notice(&log.electrical_columns()) {
        terminal.flush()?;
        terminal.warning(&notice, "");
    }
    let name = &name_of(file);
    if arguments.json {
        terminal.data(&log_json(name, log).map_err(Failure::internal)?)?;
    } else {
        let width = terminal.fold_width();
        terminal.text(&log_text(name, log, arguments.signals, width))?;
    }
    Ok(ending)
}

pub(crate) fn column_names(typed: &[ColumnName]) -> Result<ColumnNames, Failure> {
    let mut names = ColumnNames::default();
    for ColumnName { header, name } in typed {
        names.add(header, name).map_err(|error| Failure::usage(error.to_string(), error.hint()))?;
    }
    Ok(names)
}

/// The failure of a log: a file of another kind, one that cannot be read, or content without a meaning.
pub(crate) fn log_failure(error: &LogError, path: &Path) -> Failure {
    match error {
        LogError::Write(error) => Failure::cannot_write(error, path),
        LogError::UnknownFormat if is_recording(path) => is_recording_failure(path),
        LogError::Read(_)
        | LogError::UnknownFormat
        | LogError::NoTable(_)
        | LogError::NotCsv(_)
        | LogError::WithoutData { .. }
        | LogError::WithoutSignal { .. }
        | LogError::OtherVersion { .. } => Failure::failed(error.to_string(), error.hint(), path),
        _ => Failure::Usage { what: error.to_string(), hint: hint_of(error), path: Some(path.to_owned()) },
    }
}

/// What to do, with the table of which the name was meant.
fn hint_of(error: &LogError) -> String {
    if let LogError::Twice { first, second } = error
        && let Some(hint) = hint_of_names(first, second)
    {
        return hint;
    }
    if let LogError::NoTime { columns } = error {
        if is_of_stand(columns) {
            return "a table of speeds and thrusts without times is no log: give it to `hovertone fit`".to_owned();
        }
        return format!("{}{}{}", error.hint(), flag_of_columns(), example_of_columns(columns));
    }
    let meant = match error {
        LogError::NoSuchSignal { meant: Some(meant), .. } => return format!("write --signal {}", quoted(meant)),
        LogError::NoSuchSignal { name, tables, .. } => nearest(name, tables.split(", ")),
        _ => None,
    };
    meant.map_or_else(|| error.hint().to_owned(), |meant| format!("did you mean {meant}? {}", error.hint()))
}

/// Which name to give the other of two columns, where --column gives one of them the name of both; `None` without such a name.
fn hint_of_names(first: &NamedColumn, second: &NamedColumn) -> Option<String> {
    let (name, other) = match (&first.name, &second.name) {
        (Some(name), _) => (name, second),
        (None, name) => (name.as_ref()?, first),
    };
    if other.name.is_some() {
        return Some("give each column another name: for rotor 2, rotor2 in place of rotor1".to_owned());
    }
    // the next number is that of the next motor
    let from = name.find(|letter: char| letter.is_ascii_digit())?;
    let rest = &name[from..];
    let (number, rest) = rest.split_at(rest.find(|letter: char| !letter.is_ascii_digit()).unwrap_or(rest.len()));
    let next = number.parse::<u32>().ok()?.checked_add(1)?;
    let example = quoted(&format!("{}={}{next}{rest}", other.header, &name[..from]));
    Some(format!("give the columns of the other motors other names too, as in --column {example}"))
}

/// Whether the columns are those of a thrust stand: a force or a mass, and no time.
fn is_of_stand(columns: &str) -> bool {
    let columns = columns.to_lowercase();
    let is_any = |names: &[&str]| names.iter().any(|name| columns.contains(name));
    is_any(&["thrust", "force", "mass_"]) && is_any(&SPEEDS) && !is_any(&TIMES)
}

/// The flag that names a column, where the command has it.
fn flag_of_columns() -> &'static str {
    if WITH_COLUMNS.contains(&command_word().as_str()) {
        ", or give --column HEADER=time_s with the header of the time column; a table without times is no log"
    } else {
        ""
    }
}

/// Beginnings of headers of a time, in some languages.
const TIMES: [&str; 7] = ["time", "zeit", "temps", "tiempo", "tempo", "tijd", "sec"];
/// Parts of headers of columns that hold names or counts.
const NAMES: [&str; 7] = ["motor", "prop", "load", "name", "trial", "file", "recording"];
/// Parts of headers of a rotor's speed, in some languages.
const SPEEDS: [&str; 11] =
    ["rpm", "drehzahl", "umdreh", "u/min", "1/min", "upm", "speed", "vitesse", "velocidad", "giri", "toeren"];

/// The whole command that was typed, with names for the time and the speed among the columns; empty where the command has no such names, or where no
/// column is a time.
fn example_of_columns(columns: &str) -> String {
    let headers: Vec<&str> = columns.split(", ").collect();
    let is_any = |header: &str, names: &[&str]| names.iter().any(|name| header.to_lowercase().contains(name));
    let is_speed = |header: &str| is_any(header, &SPEEDS) || ["rad_s", "rev_s"].iter().any(|it| header.ends_with(it));
    let named = headers.iter().find(|header| is_any(header, &TIMES));
    // the time is the first column of most logs, unless it names a part or a load
    let first = headers.first().filter(|header| !is_any(header, &NAMES));
    let time = named.or(first).copied().filter(|time| headers.len() > 1 && !is_speed(time));
    let Some(time) = time.filter(|_| WITH_COLUMNS.contains(&command_word().as_str())) else { return String::new() };
    let column = |header: &str, name: &str| format!("--column {}", quoted(&format!("{header}={name}")));
    let command = format!("{} {}", typed_command(), column(time, "time_s"));
    match headers.iter().find(|header| **header != time && is_speed(header)) {
        Some(speed) => format!(
            ". If \"{time}\" is the time in seconds and \"{speed}\" is the speed of a rotor in {unit}, run: {command} {} (if the time is in milliseconds, write time_ms in place of time_s)",
            column(speed, &format!("rotor1_{}", unit_of(speed))),
            unit = unit_of(speed)
        ),
        None => {
            format!(
                ". If \"{time}\" is the time in seconds, run: {command} (if it is in milliseconds, write time_ms in place of time_s)"
            )
        }
    }
}

/// The unit in the header of a speed; turns per minute where it has none.
fn unit_of(header: &str) -> &'static str {
    ["rev_s", "rad_s"].into_iter().find(|unit| header.ends_with(unit)).unwrap_or("rpm")
}

/// The failure of a recording in the place of a log.
pub(crate) fn is_recording_failure(path: &Path) -> Failure {
    Failure::failed(IS_RECORDING, HINT_OF_RECORDING, path)
}

/// The failure of a log whose speeds are needed.
pub(crate) fn without_speeds(path: &Path, flight: &LoggedFlight) -> Failure {
    with_electrical_speeds(path, flight).unwrap_or_else(|| {
        let hint = "let the ESCs report their speeds (telemetry), and log them";
        Failure::failed("no rotor speed in this log", hint, path)
    })
}

/// Why a log has no rotor speeds, where it has electrical ones.
pub(crate) fn with_electrical_speeds(path: &Path, flight: &LoggedFlight) -> Option<Failure> {
    let Notice { text, hint, .. } = electrical_notice(flight.electrical_columns())?;
    Some(Failure::failed(text, hint, path))
}

/// That columns have electrical speeds, which are no speeds of rotors without the number of magnetic poles, and how to give it; `None` without
/// such a column.
fn electrical_notice(columns: &[ElectricalColumn]) -> Option<Notice> {
    let what = electrical_in_words(columns)?;
    let names = columns.iter().map(|ElectricalColumn { header, name_with_poles }| {
        format!(" --column {}", quoted(&format!("{header}={name_with_poles}")))
    });
    let unit = match columns.iter().any(|column| column.name_with_poles.contains("erpm100")) {
        true => "",
        false => "; if the columns have hundreds of rpm, as in Betaflight, write erpm100 in place of erpm",
    };
    let hint = format!(
        "count the magnets in the bell of a motor (Betaflight's setting motor_poles), and give their number with --column. For 14 magnets, as in most \
         small motors (for another number, write it in place of 14), run: {}{}{unit}",
        typed_command(),
        names.collect::<String>()
    );
    Some(Notice::new(what, hint))
}

/// That columns have electrical speeds, and the number that is missing; `None` without such a column.
pub(crate) fn electrical_in_words(columns: &[ElectricalColumn]) -> Option<String> {
    let columns = match columns {
        [] => return None,
        [one] => format!("the column {} has electrical speeds", one.header),
        [first, .., last] => format!("the columns {} to {} have electrical speeds", first.header, last.header),
    };
    Some(format!(
        "{columns} (speeds of the magnetic field); to compute rotor speeds, hovertone needs the number of magnetic poles of the motors, which the log \
         does not have"
    ))
}

/// What is wrong with a log whose speeds are used: lost parts, and motors whose speeds are electrical.
pub(crate) fn notices_of(flight: &LoggedFlight) -> Vec<Notice> {
    let of_columns = electrical_notice(flight.electrical_columns());
    flight.notes.iter().map(|words| loss_notice(words)).chain(of_columns).collect()
}

/// The notice of what a log has lost.
pub(crate) fn loss_notice(words: &str) -> Notice {
    Notice::new(words, HINT_OF_LOSS).of_kind(NoticeKind::DamagedLog)
}

fn warn_of_loss(loss: &Loss, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let Some(words) = loss.in_words() else { return Ok(Ending::Done) };
    terminal.flush()?;
    terminal.warning(&loss_notice(&words), "");
    Ok(Ending::Incomplete)
}

/// Writes signals row by row: the log is never held in memory.
fn write_signals(
    file: &Path,
    output: &Path,
    names: &ColumnNames,
    arguments: &LogArguments,
    terminal: &mut Terminal,
) -> Result<Ending, Failure> {
    let begun = Outputs::beside([file], arguments.replace.force).create_text(output, SIGNALS)?;
    let mut writer = csv::Writer::from_writer(BufWriter::new(begun.handle()?));
    let mut has_header = false;
    let mut row_count = 0_usize;
    let mut cells: Vec<String> = Vec::new();
    let take = |row: &SignalRow| {
        if !std::mem::replace(&mut has_header, true) {
            writer.write_record(signal_headers(row.signals))?;
        }
        cells.clear();
        let cell = |value: &f64| if value.is_finite() { value.to_string() } else { String::new() };
        cells.extend(std::iter::once(&row.time_s).chain(row.values).map(cell));
        row_count += 1;
        Ok(writer.write_record(&cells)?)
    };
    let stream = open_stream(file, THE_LOG)?;
    // a pasted line of the list has its unit behind two spaces
    let without_unit = |line: &String| line.split("  ").next().unwrap_or(line).to_owned();
    let signals: Vec<String> = arguments.signal.iter().map(without_unit).collect();
    let loss = signal_rows(stream, names, &signals, take).map_err(|error| match error {
        LogError::Write(error) => Failure::cannot_write(&error, output),
        error => log_failure(&error, file),
    })?;
    writer.flush().map_err(|error| Failure::cannot_write(&error, output))?;
    drop(writer);
    if row_count == 0 {
        let what = "these signals have no rows in this log: nothing was written";
        return Err(Failure::failed(what, "`hovertone log FILE` lists the tables with rows", file));
    }
    begun.keep()?;
    let ending = warn_of_loss(&loss, terminal)?;
    terminal.say(&format!("{}, {}", written(output), counted(row_count, "row")));
    Ok(ending)
}
