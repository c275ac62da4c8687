//! The chosen signals of a log, held in memory or row by row.

use crate::log::read_log;
use crate::table::{Findings, RowSink, RowValues, TableSignal};
use crate::table_text::ColumnNames;
use crate::{LogError, LogFormat, Loss};
use std::io::{self, Read};

/// Signals of one table, which share their times.
#[derive(Clone, Debug, PartialEq)]
pub struct SignalTable {
    /// Name of the table in the log.
    pub name: String,
    /// The chosen signals.
    pub signals: Vec<TableSignal>,
    /// Times of the rows, as they stand in the log.
    pub time_s: Vec<f64>,
    /// `values[signal][row]`; NaN is a gap.
    pub values: Vec<Vec<f64>>,
}

impl SignalTable {
    /// The values of a signal.
    pub fn values_of(&self, name: &str) -> Option<&[f64]> {
        let index = self.signals.iter().position(|signal| signal.name == name)?;
        Some(&self.values[index])
    }
}

/// Signals of a log.
#[derive(Clone, Debug, PartialEq)]
pub struct LogSignals {
    /// Format of the log.
    pub format: LogFormat,
    /// The tables with a chosen signal, in the sequence of the log.
    pub tables: Vec<SignalTable>,
    /// Names of all tables with rows, sorted.
    pub table_names: Vec<String>,
    /// What could not be read.
    pub loss: Loss,
}

/// Reads the signals that `is_wanted`, by the name of the table and the signal.
///
/// # Errors
/// Those of [`crate::log_summary`], but a log may be without data.
pub fn signals_from_log(
    source: impl Read,
    names: &ColumnNames,
    is_wanted: impl Fn(&str, &TableSignal) -> bool,
) -> Result<LogSignals, LogError> {
    collected(source, names, is_wanted).map(|collected| collected.signals)
}

/// Chosen signals, and what else the log tells.
pub(crate) struct CollectedSignals {
    pub(crate) signals: LogSignals,
    pub(crate) findings: Findings,
}

pub(crate) fn collected(
    source: impl Read,
    names: &ColumnNames,
    is_wanted: impl Fn(&str, &TableSignal) -> bool,
) -> Result<CollectedSignals, LogError> {
    let mut collector = Collector { is_wanted, tables: Vec::new() };
    let (format, findings) = read_log(source, names, &mut collector)?;
    let mut table_names: Vec<String> = Vec::new();
    let mut tables = Vec::new();
    for Collected { table, has_rows, .. } in collector.tables {
        if has_rows {
            table_names.push(table.name.clone());
        }
        if !table.signals.is_empty() {
            tables.push(table);
        }
    }
    table_names.sort_unstable();
    table_names.dedup();
    let loss = findings.loss.clone();
    Ok(CollectedSignals { signals: LogSignals { format, tables, table_names, loss }, findings })
}

struct Collector<F> {
    is_wanted: F,
    tables: Vec<Collected>,
}

struct Collected {
    table: SignalTable,
    /// Indices of the chosen signals in the table of the log.
    chosen: Vec<usize>,
    has_rows: bool,
}

impl<F: Fn(&str, &TableSignal) -> bool> RowSink for Collector<F> {
    fn table(&mut self, name: String, signals: Vec<TableSignal>) {
        let chosen: Vec<usize> = (0..signals.len()).filter(|&index| (self.is_wanted)(&name, &signals[index])).collect();
        let signals: Vec<TableSignal> = chosen.iter().map(|&index| signals[index].clone()).collect();
        let values = vec![Vec::new(); signals.len()];
        let table = SignalTable { name, signals, time_s: Vec::new(), values };
        self.tables.push(Collected { table, chosen, has_rows: false });
    }

    fn row(&mut self, table: usize, time_s: f64, values: &impl RowValues) -> Result<(), LogError> {
        let Some(collected) = self.tables.get_mut(table) else { return Ok(()) };
        collected.has_rows = true;
        if !collected.chosen.is_empty() {
            collected.table.time_s.push(time_s);
            for (series, &index) in collected.table.values.iter_mut().zip(&collected.chosen) {
                series.push(values.value(index));
            }
        }
        Ok(())
    }
}

/// A row of [`signal_rows`].
#[derive(Debug)]
pub struct SignalRow<'a> {
    /// The signals, the same in every row.
    pub signals: &'a [TableSignal],
    /// Time on the clock of the log.
    pub time_s: f64,
    /// Their values; NaN is a gap.
    pub values: &'a [f64],
}

/// Hands the rows of some signals of one table over, one by one: memory does not grow with the length of the log. A name is "table.signal",
/// or "table" for all its signals. Returns what could not be read.
///
/// # Errors
/// Those of [`crate::log_summary`]; a name without signal, names of several tables, an error of `take`.
pub fn signal_rows(
    source: impl Read,
    names: &ColumnNames,
    wanted: &[String],
    take: impl FnMut(&SignalRow) -> io::Result<()>,
) -> Result<Loss, LogError> {
    let mut streamer = Streamer {
        wanted,
        take,
        found: vec![false; wanted.len()],
        meant: vec![None; wanted.len()],
        table_names: Vec::new(),
        chosen: None,
        other: None,
        row: Vec::new(),
    };
    let (_, findings) = read_log(source, names, &mut streamer)?;
    streamer.table_names.sort_unstable();
    if let Some(at) = streamer.found.iter().position(|is_found| !is_found) {
        let (tables, meant) = (streamer.table_names.join(", "), streamer.meant[at].take());
        return Err(LogError::NoSuchSignal { name: wanted[at].clone(), tables, meant });
    }
    streamer.refuse_several_tables()?;
    Ok(findings.loss)
}

struct Streamer<'a, F> {
    wanted: &'a [String],
    take: F,
    /// Whether a signal of each name is there.
    found: Vec<bool>,
    /// The whole name of a signal whose own name was typed without its table.
    meant: Vec<Option<String>>,
    table_names: Vec<String>,
    /// The table of the chosen signals.
    chosen: Option<ChosenTable>,
    /// A chosen signal of another table.
    other: Option<String>,
    row: Vec<f64>,
}

struct ChosenTable {
    number: usize,
    name: String,
    indices: Vec<usize>,
    signals: Vec<TableSignal>,
}

impl<F> Streamer<'_, F> {
    fn refuse_several_tables(&self) -> Result<(), LogError> {
        let first =
            self.chosen.as_ref().and_then(|chosen| Some(format!("{}.{}", chosen.name, chosen.signals.first()?.name)));
        match (first, &self.other) {
            (Some(first), Some(second)) => Err(LogError::SeveralTables { first, second: second.clone() }),
            _ => Ok(()),
        }
    }
}

impl<F: FnMut(&SignalRow) -> io::Result<()>> RowSink for Streamer<'_, F> {
    fn table(&mut self, name: String, signals: Vec<TableSignal>) {
        let number = self.table_names.len();
        let mut chosen = ChosenTable { number, name: name.clone(), indices: Vec::new(), signals: Vec::new() };
        for (at, wanted) in self.wanted.iter().enumerate() {
            let rest = wanted.strip_prefix(name.as_str());
            for (index, signal) in signals.iter().enumerate() {
                let is_named = rest.is_some_and(|rest| rest.is_empty() || rest.strip_prefix('.') == Some(&signal.name));
                if signal.name == *wanted {
                    self.meant[at].get_or_insert_with(|| format!("{name}.{wanted}"));
                }
                if is_named {
                    self.found[at] = true;
                    if !chosen.indices.contains(&index) {
                        chosen.indices.push(index);
                        chosen.signals.push(signal.clone());
                    }
                }
            }
        }
        self.table_names.push(name);
        match (&self.chosen, chosen.signals.first()) {
            (_, None) => {}
            (None, Some(_)) => self.chosen = Some(chosen),
            (Some(_), Some(first)) => self.other = Some(format!("{}.{}", chosen.name, first.name)),
        }
    }

    fn row(&mut self, table: usize, time_s: f64, values: &impl RowValues) -> Result<(), LogError> {
        let Some(chosen) = self.chosen.as_ref().filter(|chosen| chosen.number == table) else { return Ok(()) };
        self.row.clear();
        self.row.extend(chosen.indices.iter().map(|&index| values.value(index)));
        let row = SignalRow { signals: &chosen.signals, time_s, values: &self.row };
        (self.take)(&row).map_err(LogError::Write)
    }
}
