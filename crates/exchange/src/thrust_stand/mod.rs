//! From tables of speed and thrust to speeds and forces in SI units: CSV of RCbenchmark, or any CSV with a header.

mod column;
mod column_notes;
mod copies;
mod coverage;
mod error;
mod grouping;
mod header;
mod note;
mod plausible;
#[cfg(test)]
mod tests;

pub use error::TableError;
pub use note::TableNote;

use crate::csv_text::{CsvError, CsvText, line_of};
use column::{Column, columns_of, rotors_in};
use column_notes::column_notes;
use copies::copies_notes;
use csv::StringRecord;
use grouping::grouping_columns;
use header::Quantity;
use plausible::MeasuredColumns;
use std::f64::consts::TAU;

/// Rows below this share of the fastest speed count as at rest: idling rotors and offsets of the scale.
const AT_REST_SHARE: f64 = 0.1;

/// The force of a row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum StandForce {
    /// A thrust.
    Thrust {
        /// Thrust.
        thrust_n: f64,
    },
    /// A mass that hovers.
    Mass {
        /// Mass.
        mass_kg: f64,
    },
}

/// One row.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StandRow {
    /// Line of the file, counted from 1.
    pub line_number: u64,
    /// Shaft speed.
    pub speed_rad_s: f64,
    /// Standard uncertainty of the speed, where the table has it.
    pub speed_std_rad_s: Option<f64>,
    /// Thrust or mass.
    pub force: StandForce,
    /// Standard uncertainty of the force, in its unit.
    pub force_std: Option<f64>,
    /// Shaft power from a torque; else electrical power, from its column or from voltage and current.
    pub power_w: Option<f64>,
    /// Torque.
    pub torque_n_m: Option<f64>,
    /// Voltage of the supply.
    pub voltage_v: Option<f64>,
}

/// The rows of one rotor.
#[derive(Clone, Debug, PartialEq)]
pub struct StandGroup {
    /// Content of the columns that make groups; empty without such columns.
    pub name: String,
    /// Its rows.
    pub rows: Vec<StandRow>,
}

/// Header of the column of this project's tables that holds the number of rotors.
const ROTORS_RUNNING: &str = "rotors_running";

/// A row and the name of its group.
struct GroupedRow {
    group: String,
    row: StandRow,
}

/// A table.
#[derive(Clone, Debug, PartialEq)]
pub struct StandTable {
    /// Its groups, in the order of their first rows.
    pub groups: Vec<StandGroup>,
    /// Header of the column with the speed.
    pub speed_column: String,
    /// Header of the column with the force.
    pub force_column: String,
    /// Number of rotors that this header names, as in `thrust_g_4rotors`, or that the column `rotors_running` has in all rows.
    pub rotor_count: Option<u32>,
    /// Headers of the columns with the standard uncertainties of force and speed.
    pub std_columns: Vec<String>,
    /// Notes about columns that are not used, and about rows that were left out or turned round.
    pub notes: Vec<TableNote>,
}

/// Reads a table, separated by commas, semicolons or tabs. The headers give the quantities of the columns: a speed (rpm, rad/s, rev/s), a
/// thrust (N, mN, g, gf, kg, kgf, lbf, ozf) or a mass that hovers (kg, g), their standard uncertainties (the same with "std") or expanded
/// ones (with "k=2", "95%", "U" or "±"), power, voltage, current, torque (N m, or a force and a length). Columns of words make groups, unless
/// they name the rows. An unknown unit is never guessed.
///
/// Commas are decimal commas where a cell proves it ("3,5").
///
/// # Errors
/// No header, no row, no speed, no force, a row that is too short or too long, a cell that is not a number, masses that are zero or negative,
/// negative speeds, speeds and masses in another unit than that of the header, no usable row.
pub fn table_from_csv(text: &str) -> Result<StandTable, TableError> {
    let csv = CsvText::open(text)?;
    let records: Vec<StringRecord> = csv.records().collect::<Result<_, _>>()?;
    if records.is_empty() {
        return Err(TableError::HeaderAlone);
    }
    let columns = columns_of(&csv.headers, &records);
    let used = columns.iter().filter(|column| column.quantity.is_some());
    let last_used = used.map(|column| column.index).max().unwrap_or(0);
    records.iter().try_for_each(|record| csv.check_length(record, last_used))?;
    let missing = |what| TableError::NoColumn { what, columns: csv.names() };
    let speed =
        best(&csv, &columns, &records, Quantity::Speed).ok_or_else(|| missing("a speed (rpm, rad/s or rev/s)"))?;
    let force = best(&csv, &columns, &records, Quantity::Thrust)
        .or_else(|| best(&csv, &columns, &records, Quantity::Mass))
        .ok_or_else(|| match columns.iter().find(|column| column.is_force_without_unit()) {
            Some(column) => TableError::NoUnit { column: column.header.clone() },
            None => missing("a thrust (N, g, kg or lbf) or a mass (kg or g)"),
        })?;
    let groups_by = grouping_columns(&columns, &records);
    let reader = RowReader { csv: &csv, columns: &columns, groups_by, speed, force };
    let (mut rows, mut empty): (Vec<GroupedRow>, Vec<(String, u64)>) = (Vec::new(), Vec::new());
    for record in &records {
        let group = reader.group(record);
        match reader.row(record)? {
            Some(row) => rows.push(GroupedRow { group, row }),
            None => empty.push((group, line_of(record))),
        }
    }
    plausible::check(&rows, MeasuredColumns { speed, force })?;
    let mut notes = column_notes(&csv, &columns, &records, MeasuredColumns { speed, force });
    notes.extend(empty_notes(empty));
    turn_round(&mut rows, &mut notes);
    leave_out_resting(&mut rows, &mut notes);
    if rows.is_empty() {
        return Err(TableError::NoRow);
    }
    let mut groups: Vec<StandGroup> = Vec::new();
    for GroupedRow { group: name, row } in rows {
        match groups.iter_mut().find(|group| group.name == name) {
            Some(group) => group.rows.push(row),
            None => groups.push(StandGroup { name, rows: vec![row] }),
        }
    }
    notes.extend(copies_notes(&groups, &records));
    let std_header = |measured: &Column| Some(std_of(&columns, measured)?.header.clone());
    for group in &groups {
        check_stds(group, std_header(force), |row| row.force_std)?;
        check_stds(group, std_header(speed), |row| row.speed_std_rad_s)?;
    }
    Ok(StandTable {
        std_columns: [force, speed].into_iter().filter_map(std_header).collect(),
        groups,
        speed_column: speed.header.clone(),
        force_column: force.header.clone(),
        rotor_count: rotors_in(&force.header).or_else(|| rotors_running(&columns, &records)),
        notes,
    })
}

/// The column with the standard uncertainties of another one.
fn std_of<'a>(columns: &'a [Column], measured: &Column) -> Option<&'a Column> {
    let quantity = measured.std_quantity()?;
    columns.iter().find(|column| column.quantity == Some(quantity))
}

/// Checks that all rows of a group state an uncertainty, or none: a row without one would count as exact.
fn check_stds(
    group: &StandGroup,
    header: Option<String>,
    std: impl Fn(&StandRow) -> Option<f64>,
) -> Result<(), TableError> {
    let Some(column) = header.filter(|_| group.rows.iter().any(|row| std(row).is_some())) else { return Ok(()) };
    match group.rows.iter().find(|row| std(row).is_none()) {
        Some(row) => Err(TableError::EmptyStd { line: row.line_number, column }),
        None => Ok(()),
    }
}

/// The number of rotors in all rows, as this project's own tables of loads have it.
fn rotors_running(columns: &[Column], records: &[StringRecord]) -> Option<u32> {
    let column = columns.iter().find(|column| column.header == ROTORS_RUNNING)?;
    let mut counts = records.iter().map(|record| record.get(column.index)?.trim().parse::<u32>().ok());
    let first = counts.next()??;
    counts.all(|count| count == Some(first)).then_some(first)
}

/// The column of a quantity with most numbers other than zero: a missing optical tachometer leaves a column of zeros. Of equals, one that
/// names the rotor: with a gear, the motor has another speed.
fn best<'a>(csv: &CsvText, columns: &'a [Column], records: &[StringRecord], quantity: Quantity) -> Option<&'a Column> {
    let candidates: Vec<&Column> = columns.iter().filter(|column| column.quantity == Some(quantity)).collect();
    // with equal counts the first column wins
    candidates.into_iter().rev().max_by_key(|column| (numbers_in(csv, column, records), column.names_rotor()))
}

/// Number of rows where a column has a number other than zero.
fn numbers_in(csv: &CsvText, column: &Column, records: &[StringRecord]) -> usize {
    let tells = |record: &&StringRecord| column.number(csv, record).is_some_and(|number| number.abs() > 0.0);
    records.iter().filter(tells).count()
}

struct RowReader<'a> {
    csv: &'a CsvText<'a>,
    columns: &'a [Column],
    /// Indices of the columns that make groups.
    groups_by: Vec<usize>,
    speed: &'a Column,
    force: &'a Column,
}

impl RowReader<'_> {
    /// A row with speed and force; `None` where either is empty.
    fn row(&self, record: &StringRecord) -> Result<Option<StandRow>, TableError> {
        let (Some(speed_rad_s), Some(force)) = (self.checked(self.speed, record)?, self.checked(self.force, record)?)
        else {
            return Ok(None);
        };
        let is_mass = self.force.quantity == Some(Quantity::Mass);
        if is_mass && force <= 0.0 {
            return Err(TableError::OutOfRange {
                line: line_of(record),
                column: self.force.header.clone(),
                value: plausible::in_unit(force, self.force),
                fault: "not above 0, but a mass that hovers must be",
            });
        }
        let std = |measured: &Column, size: f64| -> Result<Option<f64>, TableError> {
            let Some(column) = std_of(self.columns, measured) else { return Ok(None) };
            match self.checked(column, record)? {
                Some(value) if value < 0.0 => Err(TableError::OutOfRange {
                    line: line_of(record),
                    column: column.header.clone(),
                    value: plausible::in_unit(value, column),
                    fault: "negative, but a standard uncertainty must be 0 or more",
                }),
                value => Ok(value.map(|std| if column.is_share() { std * size.abs() } else { std })),
            }
        };
        let other = |quantity: Quantity| {
            let column = self.columns.iter().find(|column| column.quantity == Some(quantity))?;
            column.number(self.csv, record)
        };
        let torque_n_m = other(Quantity::Torque);
        let shaft_w = other(Quantity::ShaftPower).or(torque_n_m.map(|torque| (torque * speed_rad_s).abs()));
        let electrical_w =
            other(Quantity::ElectricalPower).or_else(|| Some(other(Quantity::Voltage)? * other(Quantity::Current)?));
        let power_w = shaft_w.filter(|power| *power > 0.0).or(electrical_w.filter(|power| *power > 0.0));
        Ok(Some(StandRow {
            line_number: line_of(record),
            speed_rad_s,
            speed_std_rad_s: std(self.speed, speed_rad_s)?,
            force: if is_mass { StandForce::Mass { mass_kg: force } } else { StandForce::Thrust { thrust_n: force } },
            force_std: std(self.force, force)?,
            power_w,
            torque_n_m,
            voltage_v: other(Quantity::Voltage),
        }))
    }

    /// A number in SI units; `None` for an empty cell.
    fn checked(&self, column: &Column, record: &StringRecord) -> Result<Option<f64>, CsvError> {
        Ok(self.csv.number_at(column.index, record)?.map(|number| number * column.si_per_unit))
    }

    fn group(&self, record: &StringRecord) -> String {
        let words = self.groups_by.iter().filter_map(|&column| record.get(column));
        words.collect::<Vec<_>>().join(", ")
    }
}

/// A note for each group that has rows without a speed or a force.
fn empty_notes(empty: Vec<(String, u64)>) -> Vec<TableNote> {
    let mut notes: Vec<TableNote> = Vec::new();
    for (group, line) in empty {
        let of_group = notes.iter_mut().find_map(|note| match note {
            TableNote::Empty { group: named, lines } if *named == group => Some(lines),
            _ => None,
        });
        match of_group {
            Some(lines) => lines.push(line),
            None => notes.push(TableNote::Empty { group, lines: vec![line] }),
        }
    }
    notes
}

/// Reverses the sign of all thrusts of a stand that pulls, and leaves out rows against the sign of most others.
fn turn_round(rows: &mut Vec<GroupedRow>, notes: &mut Vec<TableNote>) {
    let thrust = |row: &StandRow| match row.force {
        StandForce::Thrust { thrust_n } => thrust_n,
        StandForce::Mass { mass_kg } => mass_kg,
    };
    let fastest = fastest_rad_s(rows);
    let turning = rows.iter().map(|of| &of.row).filter(|row| row.speed_rad_s.abs() >= AT_REST_SHARE * fastest);
    let sum: f64 = turning.map(thrust).sum();
    if sum < 0.0 {
        notes.push(TableNote::TurnedRound);
        for GroupedRow { row, .. } in rows.iter_mut() {
            if let StandForce::Thrust { thrust_n } = &mut row.force {
                *thrust_n = -*thrust_n;
            }
        }
    }
    let against = |row: &StandRow| thrust(row) <= 0.0 && row.speed_rad_s >= AT_REST_SHARE * fastest;
    for GroupedRow { group, row } in rows.iter().filter(|of| against(&of.row)) {
        notes.push(TableNote::AgainstTheOthers { group: group.clone(), line: row.line_number });
    }
    rows.retain(|of| !against(&of.row));
}

/// Leaves out rows at rest.
fn leave_out_resting(rows: &mut Vec<GroupedRow>, notes: &mut Vec<TableNote>) {
    let fastest = fastest_rad_s(rows);
    let before = rows.len();
    rows.retain(|of| of.row.speed_rad_s > 0.0 && of.row.speed_rad_s >= AT_REST_SHARE * fastest);
    if rows.len() < before {
        let speed_rpm = AT_REST_SHARE * fastest * 60.0 / TAU;
        notes.push(TableNote::AtRest { count: before - rows.len(), speed_rpm });
    }
}

fn fastest_rad_s(rows: &[GroupedRow]) -> f64 {
    rows.iter().map(|of| of.row.speed_rad_s.abs()).fold(0.0, f64::max)
}
