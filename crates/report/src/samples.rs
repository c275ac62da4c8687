//! The paper's database and its tables as columns for programs.

use crate::data_table::{Cell, DataTable};
use hovertone_thrust::{LoadThrust, SampleThrust, ThrustTable};
use hovertone_vehicle::RotorSpeed;

/// A sample and whose it is.
struct SampleRow<'a> {
    table: &'a ThrustTable,
    load: &'a LoadThrust,
    trial: i64,
    recording: &'a str,
    sample: i64,
    of: &'a SampleThrust,
}

/// One row for each load, trial, sample and method: the speed and the constant. Trials and samples are counted from 1.
pub fn samples_data(tables: &[ThrustTable]) -> DataTable {
    let mut rows = Vec::new();
    for table in tables {
        for load in &table.loads {
            for (trial, of_trial) in (1..).zip(&load.trials) {
                rows.extend((1..).zip(&of_trial.samples).map(|(sample, of)| SampleRow {
                    table,
                    load,
                    trial,
                    recording: &of_trial.recording,
                    sample,
                    of,
                }));
            }
        }
    }
    DataTable::of_rows(
        "samples",
        &rows,
        &[
            ("load", Cell::Text(&|row: &SampleRow<'_>| row.load.name.clone())),
            ("trial", Cell::Whole(&|row| row.trial)),
            ("recording", Cell::Text(&|row| row.recording.to_owned())),
            ("sample", Cell::Whole(&|row| row.sample)),
            ("method", Cell::Text(&|row| row.table.method.name().to_owned())),
            ("from_s", Cell::Number(&|row| Some(row.of.speed.span.from_s))),
            ("to_s", Cell::Number(&|row| Some(row.of.speed.span.to_s))),
            ("speed_rev_s", Cell::Number(&|row| Some(row.of.speed.speed.rev_s()))),
            ("speed_rpm", Cell::Number(&|row| Some(row.of.speed.speed.rpm()))),
            ("speed_rad_s", Cell::Number(&|row| Some(row.of.speed.speed.rad_s()))),
            ("std_uncertainty_rev_s", Cell::Number(&|row| row.of.speed.std_uncertainty_rev_s)),
            ("spread_rev_s", Cell::Number(&|row| row.of.speed.spread_rev_s)),
            ("frame_count", Cell::Whole(&|row| row.of.speed.frame_count as i64)),
            ("thrust_constant_total_n_s2", Cell::Number(&|row| Some(row.of.thrust_constant_total_n_s2))),
        ],
    )
}

/// One row for each method and load: the paper's tables.
pub fn loads_data(tables: &[ThrustTable]) -> DataTable {
    type LoadRow<'a> = (&'a ThrustTable, &'a LoadThrust);
    let rows: Vec<LoadRow<'_>> =
        tables.iter().flat_map(|table| table.loads.iter().map(move |load| (table, load))).collect();
    DataTable::of_rows(
        "loads",
        &rows,
        &[
            ("method", Cell::Text(&|(table, _): &LoadRow<'_>| table.method.name().to_owned())),
            ("load", Cell::Text(&|(_, load)| load.name.clone())),
            ("mass_kg", Cell::Number(&|(_, load)| load.mass_kg)),
            ("force_n", Cell::Number(&|(_, load)| Some(load.force_n))),
            ("rotors_running", Cell::Whole(&|(_, load)| i64::from(load.rotors_running))),
            ("trial_count", Cell::Whole(&|(_, load)| load.trials.len() as i64)),
            ("speed_rpm", Cell::Number(&|(_, load)| load.speed.map(RotorSpeed::rpm))),
            ("speed_rad_s", Cell::Number(&|(_, load)| load.speed.map(RotorSpeed::rad_s))),
            ("std_uncertainty_rad_s", Cell::Number(&|(_, load)| load.std_uncertainty_rad_s)),
            ("spread_rad_s", Cell::Number(&|(_, load)| load.spread_rad_s)),
            ("thrust_constant_total_n_s2", Cell::Number(&|(_, load)| Some(load.thrust_constant_total_n_s2?.value))),
            (
                "thrust_constant_total_std_n_s2",
                Cell::Number(&|(_, load)| load.thrust_constant_total_n_s2?.std_uncertainty),
            ),
            (
                "thrust_constant_per_rotor_n_s2",
                Cell::Number(&|(_, load)| Some(load.thrust_constant_per_rotor_n_s2?.value)),
            ),
            (
                "thrust_constant_per_rotor_std_n_s2",
                Cell::Number(&|(_, load)| load.thrust_constant_per_rotor_n_s2?.std_uncertainty),
            ),
            ("p_value", Cell::Number(&|(_, load)| load.p_value)),
        ],
    )
}

/// What a writer into memory has written.
pub(crate) fn text_of(writer: csv::Writer<Vec<u8>>) -> Result<String, csv::Error> {
    let bytes = writer.into_inner().map_err(|error| csv::Error::from(error.into_error()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
