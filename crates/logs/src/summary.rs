//! What a log holds: its tables, their signals, rates and spans. Memory does not grow with the length of the log.

use crate::electrical::{ElectricalColumn, electrical_columns};
use crate::log::read_log;
use crate::table::{RowSink, RowValues, SignalRole, TableSignal};
use crate::table_text::ColumnNames;
use crate::time_line::TimeLine;
use crate::{LogError, LogFormat, Loss};
use std::io::Read;

/// Lowest and highest value of a signal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ValueRange {
    /// Lowest.
    pub low: f64,
    /// Highest.
    pub high: f64,
}

/// A signal of a table.
#[derive(Clone, Debug, PartialEq)]
pub struct SignalSummary {
    /// Name, unit and role.
    pub signal: TableSignal,
    /// Its values, where it tells something about rotors and has any. For a speed without its sign, and without rows at rest.
    pub range: Option<ValueRange>,
}

/// Signals that share their times.
#[derive(Clone, Debug, PartialEq)]
pub struct TableSummary {
    /// Name in the log.
    pub name: String,
    /// Number of rows.
    pub row_count: u64,
    /// Lowest and highest time.
    pub span_s: Option<[f64; 2]>,
    /// Rows per second.
    pub rate_hz: Option<f64>,
    /// The signals.
    pub signals: Vec<SignalSummary>,
}

/// What a log holds.
#[derive(Clone, Debug, PartialEq)]
pub struct LogSummary {
    /// Its format.
    pub format: LogFormat,
    /// The tables with rows, sorted by name.
    pub tables: Vec<TableSummary>,
    /// What could not be read.
    pub loss: Loss,
}

impl LogSummary {
    /// The signals with a role and a value, with their tables.
    pub fn about_rotors(&self) -> impl Iterator<Item = (&TableSummary, &SignalSummary)> {
        let of_table = |table| move |signal| (table, signal);
        let signals = self.tables.iter().flat_map(move |table| table.signals.iter().map(of_table(table)));
        signals.filter(|(_, signal): &(&TableSummary, &SignalSummary)| signal.range.is_some())
    }

    /// Whether a rotor turns in this log: a speed that is 0 throughout is none.
    pub fn has_rotor_speed(&self) -> bool {
        self.about_rotors().any(|(_, signal)| matches!(signal.signal.role, Some(SignalRole::RotorSpeed(_))))
    }

    /// The columns of electrical speeds.
    pub fn electrical_columns(&self) -> Vec<ElectricalColumn> {
        electrical_columns(self.tables.iter().flat_map(|table| &table.signals).map(|summary| &summary.signal))
    }

    /// Lowest and highest time of the tables with two rows or more: the time of a single row may be that of another clock. Of all tables
    /// where none has two.
    pub fn span_s(&self) -> Option<[f64; 2]> {
        let spans = |row_count_min| {
            self.tables.iter().filter(move |table| table.row_count >= row_count_min).filter_map(|table| table.span_s)
        };
        let row_count_min = if spans(2).next().is_some() { 2 } else { 1 };
        spans(row_count_min)
            .reduce(|[from_s, to_s], [next_from_s, next_to_s]| [from_s.min(next_from_s), to_s.max(next_to_s)])
    }
}

/// Lists what a log holds. `names` gives the columns of a CSV other names.
///
/// # Errors
/// A log that cannot be read, is of no known format, or has no data; a CSV without times or with cells that are not numbers.
pub fn log_summary(source: impl Read, names: &ColumnNames) -> Result<LogSummary, LogError> {
    let mut survey = Survey::default();
    let (format, findings) = read_log(source, names, &mut survey)?;
    let mut tables: Vec<TableSummary> = survey.tables.into_iter().filter_map(Surveyed::summary).collect();
    if tables.is_empty() {
        return Err(LogError::WithoutData { format });
    }
    tables.sort_by(|a, b| a.name.cmp(&b.name));
    Ok(LogSummary { format, tables, loss: findings.loss })
}

#[derive(Default)]
struct Survey {
    tables: Vec<Surveyed>,
}

struct Surveyed {
    name: String,
    times: TimeLine,
    signals: Vec<SignalSummary>,
    /// The signals whose values are looked at.
    watched: Vec<Watched>,
}

/// Values of a signal.
struct Watched {
    signal: usize,
    is_speed: bool,
    range: ValueRange,
}

impl RowSink for Survey {
    fn table(&mut self, name: String, signals: Vec<TableSignal>) {
        let range = ValueRange { low: f64::INFINITY, high: f64::NEG_INFINITY };
        let watched = |(signal, TableSignal { role, .. }): (usize, &TableSignal)| {
            let is_speed = matches!((*role)?, SignalRole::RotorSpeed(_) | SignalRole::ElectricalSpeed(_));
            Some(Watched { signal, is_speed, range })
        };
        let watched = signals.iter().enumerate().filter_map(watched).collect();
        let signals = signals.into_iter().map(|signal| SignalSummary { signal, range: None }).collect();
        self.tables.push(Surveyed { name, times: TimeLine::default(), signals, watched });
    }

    fn row(&mut self, table: usize, time_s: f64, values: &impl RowValues) -> Result<(), LogError> {
        let Some(table) = self.tables.get_mut(table) else { return Ok(()) };
        table.times.take(time_s);
        for watched in &mut table.watched {
            watched.take(values.value(watched.signal));
        }
        Ok(())
    }
}

impl Watched {
    #[inline]
    fn take(&mut self, value: f64) {
        let value = if self.is_speed { value.abs() } else { value };
        let is_inside = self.range.low <= value && value <= self.range.high;
        if !is_inside {
            self.widen(value);
        }
    }

    /// Widens the range by a value outside. Most values lie inside.
    #[cold]
    fn widen(&mut self, value: f64) {
        if value.is_finite() && !(self.is_speed && value == 0.0) {
            let ValueRange { low, high } = self.range;
            self.range = ValueRange { low: low.min(value), high: high.max(value) };
        }
    }
}

impl Surveyed {
    /// `None` for a table without rows.
    fn summary(mut self) -> Option<TableSummary> {
        for Watched { signal, range, .. } in self.watched {
            self.signals[signal].range = (range.low <= range.high).then_some(range);
        }
        let times = self.times.finished();
        (times.row_count > 0).then(|| TableSummary {
            name: self.name,
            row_count: times.row_count,
            span_s: times.span_s(),
            rate_hz: times.rate_hz(),
            signals: self.signals,
        })
    }
}
