//! Numbers that no rotor and no multirotor has: they come from a unit that is not that of the header.

use super::column::Column;
use super::{AT_REST_SHARE, GroupedRow, StandForce, StandRow, TableError, fastest_rad_s};
use hovertone_vehicle::{MASS_ALONE_KG_MAX, RotorSpeed};

/// Fastest shaft speed, rev/s. The smallest racers' propellers make 670. *Physics.*
const SPEED_REV_S_MAX: f64 = 1500.0;
/// Slowest shaft speed of the fastest row, rev/s. *Physics.*
const SPEED_REV_S_MIN: f64 = 1.0;
/// Smallest mass of the heaviest row, kg. *Physics.*
const MASS_KG_MIN: f64 = 1e-3;
/// Millionths of a unit are kept in messages.
const DECIMALS: f64 = 1e6;

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
    let refuse = |row: &StandRow, column: &Column, si: f64, must_be| {
        let value = (si / column.si_per_unit * DECIMALS).round() / DECIMALS;
        Err(TableError::OutOfRange { line: row.line_number, column: column.header.clone(), value, must_be })
    };
    // a sensor at rest may show a little less than zero
    let is_backwards = |row: &&StandRow| row.speed_rad_s < -AT_REST_SHARE * fastest_rad_s;
    if let Some(row) = rows().find(is_backwards) {
        return refuse(
            row,
            columns.speed,
            row.speed_rad_s,
            "a speed must be 0 or more, in either direction of turning",
        );
    }
    if let Some(row) = rows().max_by(|a, b| a.speed_rad_s.total_cmp(&b.speed_rad_s)) {
        let rev_s = RotorSpeed::from_rad_s(row.speed_rad_s).rev_s();
        let must_be = match rev_s {
            _ if rev_s > SPEED_REV_S_MAX => {
                "too fast for a rotor, at most 1500 rev/s (90000 rpm); check the unit in the header"
            }
            _ if rev_s > 0.0 && rev_s < SPEED_REV_S_MIN => {
                "too slow for a rotor that flies, at least 1 rev/s (60 rpm); check the unit in the header"
            }
            _ => "",
        };
        if !must_be.is_empty() {
            return refuse(row, columns.speed, row.speed_rad_s, must_be);
        }
    }
    let mass = |row: &StandRow| match row.force {
        StandForce::Mass { mass_kg } => Some(mass_kg),
        StandForce::Thrust { .. } => None,
    };
    let masses = rows().filter_map(|row| Some(WeighedRow { row, mass_kg: mass(row)? }));
    match masses.max_by(|a, b| a.mass_kg.total_cmp(&b.mass_kg)) {
        Some(WeighedRow { row, mass_kg }) if mass_kg > MASS_ALONE_KG_MAX => refuse(
            row,
            columns.force,
            mass_kg,
            "heavier than most multirotors: is this in grams, as mass_g? (else give a thrust_n)",
        ),
        Some(WeighedRow { row, mass_kg }) if mass_kg < MASS_KG_MIN => {
            refuse(row, columns.force, mass_kg, "no multirotor is lighter than 1 g: is this in kilograms, as mass_kg?")
        }
        _ => Ok(()),
    }
}

/// A row with the mass that hovers.
struct WeighedRow<'a> {
    row: &'a StandRow,
    mass_kg: f64,
}
