//! The samples of the experiment and the paper's tables as columns for programs.

use crate::data_table::{DataTable, Rows};
use hovertone_thrust::{LoadThrust, SampleThrust, ThrustTable};
use hovertone_vehicle::RotorSpeed;

/// A sample with its trial, load and method.
struct SampleRow<'a> {
    table: &'a ThrustTable,
    load: &'a LoadThrust,
    trial: i64,
    recording: &'a str,
    sample: i64,
    of: &'a SampleThrust,
}

/// A load with its method.
struct LoadRow<'a> {
    table: &'a ThrustTable,
    load: &'a LoadThrust,
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
    let rows = Rows(&rows);
    DataTable {
        name: "samples",
        columns: vec![
            rows.text("load", |row| row.load.name.clone()),
            rows.whole("trial", |row| row.trial),
            rows.text("recording", |row| row.recording.to_owned()),
            rows.whole("sample", |row| row.sample),
            rows.text("method", |row| row.table.method.name().to_owned()),
            rows.number("from_s", |row| Some(row.of.speed.span.from_s)),
            rows.number("to_s", |row| Some(row.of.speed.span.to_s)),
            rows.number("speed_rev_s", |row| Some(row.of.speed.speed.rev_s())),
            rows.number("speed_rpm", |row| Some(row.of.speed.speed.rpm())),
            rows.number("speed_rad_s", |row| Some(row.of.speed.speed.rad_s())),
            rows.number("std_uncertainty_rev_s", |row| row.of.speed.std_uncertainty_rev_s),
            rows.number("spread_rev_s", |row| row.of.speed.spread_rev_s),
            rows.whole("frame_count", |row| row.of.speed.frame_count as i64),
            rows.number("thrust_constant_total_n_s2", |row| Some(row.of.thrust_constant_total_n_s2)),
        ],
    }
}

/// One row for each method and load, like the paper's tables.
pub fn loads_data(tables: &[ThrustTable]) -> DataTable {
    let rows: Vec<LoadRow<'_>> =
        tables.iter().flat_map(|table| table.loads.iter().map(move |load| LoadRow { table, load })).collect();
    let rows = Rows(&rows);
    DataTable {
        name: "loads",
        columns: vec![
            rows.text("method", |row| row.table.method.name().to_owned()),
            rows.text("load", |row| row.load.name.clone()),
            rows.number("mass_kg", |row| row.load.mass_kg),
            rows.number("force_n", |row| Some(row.load.force_n)),
            rows.whole("rotors_running", |row| i64::from(row.load.rotors_running)),
            rows.whole("trial_count", |row| row.load.trials.len() as i64),
            rows.number("speed_rpm", |row| row.load.speed.map(RotorSpeed::rpm)),
            rows.number("speed_rad_s", |row| row.load.speed.map(RotorSpeed::rad_s)),
            rows.number("std_uncertainty_rad_s", |row| row.load.std_uncertainty_rad_s),
            rows.number("spread_rad_s", |row| row.load.spread_rad_s),
            rows.number("thrust_constant_total_n_s2", |row| Some(row.load.thrust_constant_total_n_s2?.value)),
            rows.number("thrust_constant_total_std_n_s2", |row| row.load.thrust_constant_total_n_s2?.std_uncertainty),
            rows.number("thrust_constant_per_rotor_n_s2", |row| Some(row.load.thrust_constant_per_rotor_n_s2?.value)),
            rows.number("thrust_constant_per_rotor_std_n_s2", |row| {
                row.load.thrust_constant_per_rotor_n_s2?.std_uncertainty
            }),
            rows.number("p_value", |row| row.load.p_value),
        ],
    }
}
