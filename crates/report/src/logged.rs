//! What a log holds: tables for people, a JSON line for programs, and signals as CSV.

use crate::number::{DASH, fixed, significant};
use crate::printable::printable;
use crate::quote::counted;
use crate::table_lines::table_text;
use crate::text_table::{Column, TextTable};
use crate::version::VERSION;
use hovertone_logs::{LogSummary, SignalRole, SignalSummary, TableSignal, TableSummary, ValueRange};
use serde::Serialize;

/// Digits of a rate.
const DIGITS: usize = 3;
/// Digits of a value.
const VALUE_DIGITS: usize = 4;

/// What a log holds as text: what tells about rotors, and all tables; with `has_names` also the names of all signals.
pub fn log_text(file: &str, log: &LogSummary, has_names: bool, width: Option<usize>) -> String {
    let signals: usize = log.tables.iter().map(|table| table.signals.len()).sum();
    let span = log.span_s().map_or(String::new(), |span_s| format!(", {} s", fixed(span_s[1] - span_s[0], 1)));
    let counts = format!("{}, {}", counted(log.tables.len(), "table"), counted(signals, "signal"));
    let mut text = format!("{}\n{}{span}, {counts}\n", printable(file), log.format);
    if !log.has_rotor_speed() {
        text += "no rotor speed in this log\n";
    }
    if log.about_rotors().next().is_some() {
        text += &format!("\n{}", table_text(&rotors_table(log), width));
    }
    text += &format!("\n{}", table_text(&tables_table(log), width));
    if has_names {
        text += "\nnames of the signals for --signal\n";
        text.extend(log.tables.iter().map(names_of));
    }
    text
}

/// One row for all signals of a table with the same role.
fn rotors_table(log: &LogSummary) -> TextTable {
    let mut shown = TextTable::new(vec![
        Column::words("signals"),
        Column::words("about rotors"),
        Column::numbers("smallest", ""),
        Column::numbers("largest", ""),
        Column::words("unit"),
        Column::numbers("rate", "Hz"),
    ]);
    for role in ["rotor speed", "electrical speed", "command", "body rate"] {
        for table in &log.tables {
            let is_of_role = |signal: &&SignalSummary| signal.signal.role.map(role_in_words) == Some(role);
            let signals: Vec<&SignalSummary> =
                table.signals.iter().filter(is_of_role).filter(|signal| signal.range.is_some()).collect();
            let ranges = signals.iter().filter_map(|signal| signal.range);
            let Some(range) = ranges.reduce(widened) else { continue };
            let names: Vec<&str> = signals.iter().map(|signal| signal.signal.name.as_str()).collect();
            shown.push(vec![
                format!("{}.{}", table.name, joined(&names).join(", ")),
                role.to_owned(),
                significant(range.low, VALUE_DIGITS),
                significant(range.high, VALUE_DIGITS),
                signals.first().map_or(String::new(), |signal| signal.signal.unit.clone()),
                rate_in_words(table),
            ]);
        }
    }
    shown
}

fn widened(a: ValueRange, b: ValueRange) -> ValueRange {
    ValueRange { low: a.low.min(b.low), high: a.high.max(b.high) }
}

fn role_in_words(role: SignalRole) -> &'static str {
    match role {
        SignalRole::RotorSpeed(_) => "rotor speed",
        SignalRole::ElectricalSpeed(_) => "electrical speed",
        SignalRole::Command(_) => "command",
        SignalRole::BodyRate(_) => "body rate",
        SignalRole::Torque => "torque",
    }
}

fn rate_in_words(table: &TableSummary) -> String {
    table.rate_hz.map_or(DASH.to_owned(), |rate_hz| significant(rate_hz, DIGITS))
}

fn tables_table(log: &LogSummary) -> TextTable {
    let mut shown = TextTable::new(vec![
        Column::words("table"),
        Column::numbers("signals", ""),
        Column::numbers("rows", ""),
        Column::numbers("rate", "Hz"),
        Column::numbers("from", "s"),
        Column::numbers("to", "s"),
    ]);
    for table in &log.tables {
        let time = |at: usize| table.span_s.map_or(DASH.to_owned(), |span_s| fixed(span_s[at], 2));
        shown.push(vec![
            table.name.clone(),
            table.signals.len().to_string(),
            table.row_count.to_string(),
            rate_in_words(table),
            time(0),
            time(1),
        ]);
    }
    shown
}

/// Names of all signals of a table, one on a line, with their units.
fn names_of(table: &TableSummary) -> String {
    let line = |signal: &SignalSummary| {
        let name = printable(&format!("{}.{}", table.name, signal.signal.name));
        match signal.signal.unit.as_str() {
            "" => format!("  {name}\n"),
            unit => format!("  {name}  ({})\n", printable(unit)),
        }
    };
    table.signals.iter().map(line).collect()
}

/// Names that differ in the number in their first brackets as one: "esc[0–7].esc_rpm".
fn joined(names: &[&str]) -> Vec<String> {
    /// Names that are joined, with the first and the last number.
    struct Group<'a> {
        parts: Option<[&'a str; 2]>,
        name: &'a str,
        numbers: Option<[u32; 2]>,
    }
    let mut groups: Vec<Group> = Vec::new();
    for name in names {
        let split = name.split_once('[').and_then(|(head, rest)| {
            let (number, tail) = rest.split_once(']')?;
            Some(([head, tail], number.parse::<u32>().ok()?))
        });
        let (parts, number) = split.unzip();
        let same = groups.iter_mut().find(|group| parts.is_some() && group.parts == parts);
        match (same, number) {
            (Some(Group { numbers: Some([low, high]), .. }), Some(number)) => {
                (*low, *high) = ((*low).min(number), (*high).max(number));
            }
            _ => groups.push(Group { parts, name, numbers: number.map(|number| [number; 2]) }),
        }
    }
    let in_words = |group: Group| match (group.parts, group.numbers) {
        (Some([head, tail]), Some([low, high])) if low < high => format!("{head}[{low}–{high}]{tail}"),
        _ => group.name.to_owned(),
    };
    groups.into_iter().map(in_words).collect()
}

#[derive(Serialize)]
struct LogLine<'a> {
    file: &'a str,
    format: String,
    from_s: Option<f64>,
    to_s: Option<f64>,
    has_rotor_speed: bool,
    all_bytes: u64,
    lost_bytes: u64,
    lost_places: Vec<LostLine>,
    lost_place_count: u64,
    tables: Vec<TableLine<'a>>,
    version: &'static str,
}

#[derive(Serialize)]
struct LostLine {
    from_byte: u64,
    bytes: u64,
    after_s: Option<f64>,
}

#[derive(Serialize)]
struct TableLine<'a> {
    name: &'a str,
    row_count: u64,
    rate_hz: Option<f64>,
    from_s: Option<f64>,
    to_s: Option<f64>,
    signals: Vec<SignalLine<'a>>,
}

#[derive(Serialize)]
struct SignalLine<'a> {
    name: &'a str,
    unit: Option<&'a str>,
    about: Option<&'static str>,
    /// Rotor or motor, from 1; axis 0 to 2.
    number: Option<usize>,
    low: Option<f64>,
    high: Option<f64>,
}

/// What a log holds as one JSON object on a line.
///
/// # Errors
/// None is known, since all types can be serialised.
pub fn log_json(file: &str, log: &LogSummary) -> Result<String, serde_json::Error> {
    let loss = &log.loss;
    let lost = loss.places.iter();
    let line = LogLine {
        file,
        format: log.format.to_string(),
        from_s: log.span_s().map(|span_s| span_s[0]),
        to_s: log.span_s().map(|span_s| span_s[1]),
        has_rotor_speed: log.has_rotor_speed(),
        all_bytes: loss.all_bytes,
        lost_bytes: loss.lost_bytes,
        lost_places: lost
            .map(|place| LostLine { from_byte: place.from_byte, bytes: place.bytes, after_s: place.after_s })
            .collect(),
        lost_place_count: loss.place_count,
        tables: log.tables.iter().map(table_line).collect(),
        version: VERSION,
    };
    Ok(serde_json::to_string(&line)? + "\n")
}

fn signal_line(summary: &SignalSummary) -> SignalLine<'_> {
    let TableSignal { name, unit, role } = &summary.signal;
    SignalLine {
        name,
        unit: Some(unit.as_str()).filter(|unit| !unit.is_empty()),
        about: role.map(role_in_words),
        number: role.and_then(|role| match role {
            SignalRole::RotorSpeed(number) | SignalRole::ElectricalSpeed(number) | SignalRole::Command(number) => {
                Some(number as usize)
            }
            SignalRole::BodyRate(axis) => Some(axis),
            SignalRole::Torque => None,
        }),
        low: summary.range.map(|range| range.low),
        high: summary.range.map(|range| range.high),
    }
}

fn table_line(table: &TableSummary) -> TableLine<'_> {
    TableLine {
        name: &table.name,
        row_count: table.row_count,
        rate_hz: table.rate_hz,
        from_s: table.span_s.map(|span_s| span_s[0]),
        to_s: table.span_s.map(|span_s| span_s[1]),
        signals: table.signals.iter().map(signal_line).collect(),
    }
}

/// Headers of a CSV with these signals: the time, and each name with its unit as `hovertone speed --log` knows them.
pub fn signal_headers(signals: &[TableSignal]) -> Vec<String> {
    let header = |signal: &TableSignal| {
        let name = signal.name.as_str();
        match signal.unit.as_str() {
            "rev/s" => {
                let bare = ["_rpm", "rpm", "RPM"].iter().find_map(|ending| name.strip_suffix(ending)).unwrap_or(name);
                format!("{}{}speed_rev_s", bare, if bare.is_empty() || bare.ends_with('_') { "" } else { "_" })
            }
            "rad/s" if !name.ends_with("rad_s") => format!("{name}_rad_s"),
            _ => name.to_owned(),
        }
    };
    std::iter::once("time_s".to_owned()).chain(signals.iter().map(header)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_that_differ_in_a_number_are_one() {
        let names = ["counter", "esc[0].esc_rpm", "esc[0].x", "esc[1].esc_rpm", "esc[1].x", "xyz[2]"];
        assert_eq!(joined(&names), ["counter", "esc[0–1].esc_rpm", "esc[0–1].x", "xyz[2]"]);
        assert_eq!(joined(&["a[0]", "a[0]"]), ["a[0]"]);
    }

    #[test]
    fn headers_name_the_unit_that_the_values_have() {
        let signal = |name: &str, unit: &str| TableSignal { name: name.to_owned(), unit: unit.to_owned(), role: None };
        let signals = [
            signal("esc[0].esc_rpm", "rev/s"),
            signal("RPM", "rev/s"),
            signal("gyroADC[0]", "rad/s"),
            signal("gyro_x_rad_s", "rad/s"),
            signal("volts", "V"),
        ];
        let headers = signal_headers(&signals);
        assert_eq!(
            headers,
            ["time_s", "esc[0].esc_speed_rev_s", "speed_rev_s", "gyroADC[0]_rad_s", "gyro_x_rad_s", "volts"]
        );
    }
}
