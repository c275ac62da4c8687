//! The paper's database as a table: one line for each load, trial, sample and method.

use hovertone::{Method, ThrustTable};
use serde::Serialize;

/// `samples.csv`: the speed and the constant of every sample by every method. Trials and samples are counted from 1.
///
/// # Errors
/// None that is known of: memory is written to.
pub fn samples_csv(tables: &[ThrustTable]) -> Result<String, csv::Error> {
    #[derive(Serialize)]
    struct Line<'a> {
        load: &'a str,
        trial: usize,
        recording: &'a str,
        sample: usize,
        method: Method,
        from_s: f64,
        to_s: f64,
        speed_rev_s: f64,
        speed_rpm: f64,
        speed_rad_s: f64,
        std_uncertainty_rev_s: Option<f64>,
        spread_rev_s: Option<f64>,
        frame_count: usize,
        thrust_constant_total_n_s2: f64,
    }
    let mut writer = csv::Writer::from_writer(Vec::new());
    for table in tables {
        for load in &table.loads {
            for (trial, trial_number) in load.trials.iter().zip(1..) {
                for (sample, sample_number) in trial.samples.iter().zip(1..) {
                    writer.serialize(Line {
                        load: &load.name,
                        trial: trial_number,
                        recording: &trial.recording,
                        sample: sample_number,
                        method: table.method,
                        from_s: sample.speed.span.from_s,
                        to_s: sample.speed.span.to_s,
                        speed_rev_s: sample.speed.speed.rev_s(),
                        speed_rpm: sample.speed.speed.rpm(),
                        speed_rad_s: sample.speed.speed.rad_s(),
                        std_uncertainty_rev_s: sample.speed.std_uncertainty_rev_s,
                        spread_rev_s: sample.speed.spread_rev_s,
                        frame_count: sample.speed.frame_count,
                        thrust_constant_total_n_s2: sample.thrust_constant_total_n_s2,
                    })?;
                }
            }
        }
    }
    text_of(writer)
}

/// What a writer into memory has written.
pub(crate) fn text_of(writer: csv::Writer<Vec<u8>>) -> Result<String, csv::Error> {
    let bytes = writer.into_inner().map_err(|error| csv::Error::from(error.into_error()))?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}
