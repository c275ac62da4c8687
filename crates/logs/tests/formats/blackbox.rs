//! Blackbox logs of Betaflight.

use crate::writers::blackbox::{FIRST_LINE, flight, is_written, truth};
use crate::{flight_of, signals_of};
use hovertone_logs::{LogError, LogFormat, RateAxes};
use std::f64::consts::TAU;

/// Loops of a log.
const LOOPS: u32 = 5000;

#[test]
fn every_value_of_every_frame_is_the_truth() {
    let log = signals_of(&flight(LOOPS));
    assert_eq!((log.format, log.loss.is_some()), (LogFormat::Blackbox, false));
    let table = &log.tables[0];
    let iterations: Vec<u32> = (0..LOOPS).filter(|iteration| is_written(*iteration).is_some()).collect();
    assert_eq!(table.time_s.len(), iterations.len());
    let factor = |name: &str| match name {
        "gyroADC[0]" | "gyroADC[1]" | "gyroADC[2]" => TAU / 360.0,
        // 12 poles are 6 pairs, and the log has hundreds of electrical rpm
        "eRPM[0]" | "eRPM[1]" => 100.0 / 60.0 / 6.0,
        _ => 1.0,
    };
    for (row, &iteration) in iterations.iter().enumerate() {
        let truth = truth(iteration);
        assert!((table.time_s[row] - 1e-6 * truth[1] as f64).abs() < 1e-9, "{iteration}");
        for (at, (signal, values)) in table.signals.iter().zip(&table.values).enumerate() {
            let expected = factor(&signal.name) * truth[at + 2] as f64;
            assert!(
                (values[row] - expected).abs() < 1e-9,
                "{} at {iteration}: {} {expected}",
                signal.name,
                values[row]
            );
        }
    }
}

#[test]
fn motors_count_from_one_and_the_gyro_has_its_axes() {
    let flight = flight_of(&flight(LOOPS)).unwrap();
    assert_eq!(flight.commands.unwrap().names, ["motor 1", "motor 2", "motor 3", "motor 4"]);
    let speeds = flight.speeds_rev_s.unwrap();
    assert_eq!(speeds.names, ["motor 1", "motor 2"]);
    assert!((speeds.values[0][0] - 1000.0 * 100.0 / 60.0 / 6.0).abs() < 1e-9);
    assert_eq!(flight.rates.unwrap().axes, Some(RateAxes::ForwardLeftUp));
}

#[test]
fn a_file_of_several_logs_gives_the_longest_and_lists_all() {
    let empty_memory = [0xff; 5000];
    let file = [&flight(200)[..], &flight(LOOPS), &empty_memory, &flight(300), &empty_memory].concat();
    let log = signals_of(&file);
    assert_eq!(log.table_names, ["main", "main[2]", "main[3]"]);
    assert!(!log.loss.is_some(), "{}", log.loss);
    let whole = flight_of(&flight(LOOPS)).unwrap();
    assert_eq!(flight_of(&file).unwrap(), whole);
}

#[test]
fn a_log_that_breaks_off_without_its_end_is_read_up_to_there() {
    let whole = flight(LOOPS);
    let cut = [&whole[..whole.len() / 2], &flight(40)].concat();
    let log = signals_of(&cut);
    let rows = log.tables[0].time_s.len();
    assert!(rows > LOOPS as usize / 5 && log.tables[1].time_s.len() == 20, "{rows}");
    assert!(log.loss.lost_bytes < 60, "{}", log.loss);
}

#[test]
fn another_version_of_the_format_is_refused_with_what_to_do() {
    let text = format!("{FIRST_LINE}H Data version:1\nI\0\0");
    let error = flight_of(text.as_bytes()).unwrap_err();
    assert!(matches!(error, LogError::OtherVersion { .. }) && error.to_string().contains("version 1"), "{error}");
    assert!(error.hint().contains("blackbox_decode"));
    // without the description of the frames there are no data
    let text = format!("{FIRST_LINE}H Data version:2\nI\0\0");
    assert!(matches!(flight_of(text.as_bytes()), Err(LogError::WithoutData { .. })));
}
