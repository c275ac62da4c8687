//! Numbers that no rotor and no multirotor has: they come from a unit that is not that of the header.

use super::column::Column;
use super::header::RPM_RAD_S;
use super::{AT_REST_SHARE, GroupedRow, StandForce, StandRow, TableError, fastest_rad_s};
use hovertone_vehicle::{MASS_ALONE_KG_MAX, RotorSpeed, SHAFT_REV_S};
use std::f64::consts::TAU;

/// Smallest mass of the heaviest row, kg. *Physics.*
const MASS_KG_MIN: f64 = 1e-3;
/// Millionths of a unit are kept in messages.
const DECIMALS: f64 = 1e6;
/// Larger numbers have no decimals to round.
const ROUNDED_MAX: f64 = 1e9;

/// The columns of speed and force.
#[derive(Clone, Copy)]
pub(super) struct MeasuredColumns<'a> {
    pub(super) speed: &'a Column,
    pub(super) force: &'a Column,
}

/// Refuses rows that turn backwards, speeds that no rotor has, and masses that no multirotor has.
pub(super) fn check(rows: &[GroupedRow], columns: MeasuredColumns<'_>) -> Result<(), TableError> {
    let fastest_rad_s = fastest_rad_s(rows);
    let rows = || rows.iter().map(|of| &of.row);
    // a sensor at rest may show a little less than zero
    let is_backwards = |row: &&StandRow| row.speed_rad_s < -AT_REST_SHARE * fastest_rad_s;
    if let Some(row) = rows().find(is_backwards) {
        let fault = "negative, but a speed must be 0 or more, in both directions of turning";
        let cell = Cell { line: row.line_number, si: row.speed_rad_s };
        return Err(out_of_range(&cell, columns.speed, fault));
    }
    let is_in = |unit_rad_s: f64| (columns.speed.si_per_unit / unit_rad_s - 1.0).abs() < 1e-9;
    let speeds: Vec<Cell> = rows().map(|row| Cell { line: row.line_number, si: row.speed_rad_s }).collect();
    let is_fast = |rad_s: f64| RotorSpeed::from_rad_s(rad_s).rev_s() > *SHAFT_REV_S.end();
    let is_slow = |rad_s: f64| rad_s > 0.0 && RotorSpeed::from_rad_s(rad_s).rev_s() < *SHAFT_REV_S.start();
    let fast = Limit {
        fault: "too fast for a rotor, which turns at 1500 rev/s (90000 rpm) or less",
        header: (!is_in(RPM_RAD_S)).then_some("speed_rpm"),
    };
    let slow = Limit {
        fault: "too slow for a rotor that flies, which turns at 1 rev/s (60 rpm) or more",
        header: (!is_in(TAU)).then_some("speed_rev_s"),
    };
    refuse_beyond(&speeds, columns.speed, &fast, &is_fast)?;
    if is_slow(fastest_rad_s) {
        refuse_beyond(&speeds, columns.speed, &slow, &is_slow)?;
    }
    let mass = |row: &StandRow| match row.force {
        StandForce::Mass { mass_kg } => Some(Cell { line: row.line_number, si: mass_kg }),
        StandForce::Thrust { .. } => None,
    };
    let masses: Vec<Cell> = rows().filter_map(mass).collect();
    let heavy = Limit { fault: "heavier than most multirotors, which weigh 50 kg or less", header: Some("mass_g") };
    let light = Limit { fault: "lighter than any multirotor, which weighs 1 g or more", header: Some("mass_kg") };
    refuse_beyond(&masses, columns.force, &heavy, &|mass_kg| mass_kg > MASS_ALONE_KG_MAX)?;
    if masses.iter().all(|cell| cell.si < MASS_KG_MIN) {
        refuse_beyond(&masses, columns.force, &light, &|mass_kg| mass_kg < MASS_KG_MIN)?;
    }
    Ok(())
}

/// A limit of what is possible.
struct Limit {
    /// The limit in words, after "is" or "are".
    fault: &'static str,
    /// A header with the unit that is probably meant, where many numbers are beyond the limit.
    header: Option<&'static str>,
}

/// A number of the table, in SI units.
struct Cell {
    line: u64,
    si: f64,
}

/// Refuses numbers beyond a limit: one by its line, several as those of another unit.
fn refuse_beyond(
    cells: &[Cell],
    column: &Column,
    limit: &Limit,
    is_beyond: &dyn Fn(f64) -> bool,
) -> Result<(), TableError> {
    let beyond = || cells.iter().filter(|cell| is_beyond(cell.si));
    let Some(largest) = beyond().max_by(|a, b| a.si.total_cmp(&b.si)) else { return Ok(()) };
    Err(match beyond().count() {
        1 => out_of_range(largest, column, limit.fault),
        count => TableError::OtherUnit {
            column: column.header.clone(),
            count,
            of: cells.len(),
            largest: in_unit(largest.si, column),
            fault: limit.fault,
            header: limit.header,
        },
    })
}

fn out_of_range(cell: &Cell, column: &Column, fault: &'static str) -> TableError {
    let value = in_unit(cell.si, column);
    TableError::OutOfRange { line: cell.line, column: column.header.clone(), value, fault }
}

pub(super) fn in_unit(si: f64, column: &Column) -> f64 {
    let value = si / column.si_per_unit;
    if value.abs() < ROUNDED_MAX { (value * DECIMALS).round() / DECIMALS } else { value }
}
