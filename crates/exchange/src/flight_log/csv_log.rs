//! From a CSV with a header to motors and body rates over time, in SI units.

use super::column::{LogColumn, column_of};
use super::{FlightLogError, LoggedFlight, LoggedMotors, LoggedRates};
use crate::csv_text::{CsvError, CsvText, line_of};
use csv::StringRecord;

/// Largest number of motors in a log.
const MOTORS_MAX: usize = 16;

/// A column with a known quantity.
struct Known {
    index: usize,
    header: String,
    kind: LogColumn,
}

/// Reads a log, separated by commas, semicolons or tabs. The words and units of the headers give the quantities of the columns
/// (`docs/formats.md`); other columns are ignored. A row with an empty cell is a gap in the series of that cell. Of several rows with
/// equal times the first counts.
///
/// # Errors
/// No header, no time with a unit, neither motors nor body rates, a cell that is not a number, times that decrease.
pub fn flight_log_from_csv(text: &str) -> Result<LoggedFlight, FlightLogError> {
    let csv = CsvText::open(text)?;
    let columns: Vec<Known> = csv
        .headers
        .iter()
        .enumerate()
        .filter_map(|(index, header)| Some(Known { index, header: header.to_owned(), kind: column_of(header)? }))
        .collect();
    refuse_twice(&columns)?;
    let factor_of = |column: &Known| match column.kind {
        LogColumn::Time { factor } => Some(factor),
        _ => None,
    };
    let Some((time, factor)) = columns.iter().find_map(|column| Some((column, factor_of(column)?))) else {
        return Err(FlightLogError::NoTime { columns: csv.names() });
    };
    let (speeds, commands) = (motors_of(&columns, true), motors_of(&columns, false));
    let rates: Vec<&Known> = (0..3)
        .filter_map(|wanted| {
            columns.iter().find(|column| matches!(column.kind, LogColumn::Rate { axis, .. } if axis == wanted))
        })
        .collect();
    let rates = if rates.len() == 3 { rates } else { Vec::new() };
    if speeds.is_empty() && commands.is_empty() && rates.is_empty() {
        return Err(FlightLogError::NoSignal { columns: csv.names() });
    }
    let mut tables = [&speeds, &commands, &rates].map(|columns| Table::of(columns));
    let mut before_s = f64::NEG_INFINITY;
    for record in csv.records() {
        let record = record?;
        let Some(time) = number(&csv, time, &record)? else { continue };
        let time_s = time * factor;
        if time_s < before_s {
            return Err(FlightLogError::NotInOrder { line: line_of(&record), time_s });
        }
        before_s = time_s;
        for (table, columns) in tables.iter_mut().zip([&speeds, &commands, &rates]) {
            table.take(time_s, columns, &csv, &record)?;
        }
    }
    let [of_speeds, of_commands, of_rates] = tables;
    let motors = |columns: &[&Known], table: Table| {
        (!columns.is_empty()).then(|| LoggedMotors {
            time_s: table.time_s,
            names: columns.iter().filter_map(|column| Some(format!("motor {}", motor_of(column)?))).collect(),
            values: table.values,
        })
    };
    let has_rates = !rates.is_empty();
    Ok(LoggedFlight {
        speeds: motors(&speeds, of_speeds),
        commands: motors(&commands, of_commands),
        rates: of_rates.values.try_into().ok().filter(|_| has_rates).map(|rates_rad_s| LoggedRates {
            time_s: of_rates.time_s,
            rates_rad_s,
            axes: None,
        }),
        notes: Vec::new(),
    })
}

/// Rows of some columns, in SI units.
struct Table {
    time_s: Vec<f64>,
    values: Vec<Vec<f64>>,
}

impl Table {
    fn of(columns: &[&Known]) -> Self {
        Self { time_s: Vec::new(), values: vec![Vec::new(); columns.len()] }
    }

    /// Adds a row, unless one of its cells is empty or its time equals the time of the previous row.
    fn take(
        &mut self,
        time_s: f64,
        columns: &[&Known],
        csv: &CsvText,
        record: &StringRecord,
    ) -> Result<(), FlightLogError> {
        let cells: Vec<Option<f64>> =
            columns.iter().map(|column| number(csv, column, record)).collect::<Result<_, _>>()?;
        let Some(cells) = cells.into_iter().collect::<Option<Vec<f64>>>() else { return Ok(()) };
        if self.time_s.last().is_some_and(|last_s| *last_s >= time_s) {
            return Ok(());
        }
        self.time_s.push(time_s);
        for ((values, cell), column) in self.values.iter_mut().zip(cells).zip(columns) {
            let factor = match column.kind {
                LogColumn::Rate { factor, .. } | LogColumn::MotorSpeed { factor, .. } => factor,
                _ => 1.0,
            };
            values.push(cell * factor);
        }
        Ok(())
    }
}

fn motor_of(column: &Known) -> Option<u32> {
    match column.kind {
        LogColumn::MotorSpeed { motor, .. } | LogColumn::MotorCommand { motor } => Some(motor),
        _ => None,
    }
}

/// The columns of the motors, in the order of their numbers.
fn motors_of(columns: &[Known], are_speeds: bool) -> Vec<&Known> {
    let is_wanted = |column: &&Known| match column.kind {
        LogColumn::MotorSpeed { .. } => are_speeds,
        LogColumn::MotorCommand { .. } => !are_speeds,
        _ => false,
    };
    let mut motors: Vec<&Known> = columns.iter().filter(is_wanted).collect();
    motors.sort_by_key(|column| motor_of(column));
    motors.truncate(MOTORS_MAX);
    motors
}

fn refuse_twice(columns: &[Known]) -> Result<(), FlightLogError> {
    let same = |a: &LogColumn, b: &LogColumn| match (a, b) {
        (LogColumn::Rate { axis: a, .. }, LogColumn::Rate { axis: b, .. }) => a == b,
        (LogColumn::MotorSpeed { motor: a, .. }, LogColumn::MotorSpeed { motor: b, .. })
        | (LogColumn::MotorCommand { motor: a }, LogColumn::MotorCommand { motor: b }) => a == b,
        _ => false,
    };
    for (index, column) in columns.iter().enumerate() {
        if let Some(first) = columns[..index].iter().find(|first| same(&first.kind, &column.kind)) {
            return Err(FlightLogError::Twice { first: first.header.clone(), second: column.header.clone() });
        }
    }
    Ok(())
}

/// The finite number of a cell; `None` for an empty cell.
fn number(csv: &CsvText, column: &Known, record: &StringRecord) -> Result<Option<f64>, CsvError> {
    let is_gap = record.get(column.index).is_some_and(|cell| cell.eq_ignore_ascii_case("nan"));
    if is_gap { Ok(None) } else { csv.number_at(column.index, record) }
}
