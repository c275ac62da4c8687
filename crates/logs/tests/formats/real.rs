//! Real logs, where the test data are installed.

use crate::flight_of;
use hovertone_logs::{ColumnNames, LogFormat, log_summary};
use std::path::PathBuf;

/// A real log.
pub(crate) fn real(name: &str) -> Option<Vec<u8>> {
    let shared = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data"));
    let path = std::env::var_os("HOVERTONE_TEST_DATA").map_or_else(shared, PathBuf::from).join("logs").join(name);
    let bytes = std::fs::read(&path).ok();
    if bytes.is_none() {
        println!("skipped: no test recordings at {} (set HOVERTONE_TEST_DATA)", path.display());
    }
    bytes
}

#[test]
fn escs_of_a_real_flight_report_three_times_a_second() {
    let Some(bytes) = real("px4_esc_status.ulg") else { return };
    let log = log_summary(&bytes[..], &ColumnNames::default()).unwrap();
    assert!(log.has_rotor_speed() && !log.loss.is_some() && log.loss.all_bytes == bytes.len() as u64);
    let table = |name: &str| log.tables.iter().find(|table| table.name == name).unwrap();
    assert!((table("esc_status").rate_hz.unwrap() - 3.2).abs() < 0.1);
    assert!((table("actuator_outputs[1]").rate_hz.unwrap() - 9.2).abs() < 0.1);
    let [from_s, to_s] = log.span_s().unwrap();
    assert!((to_s - from_s - 44.0).abs() < 0.1);
    let speeds = table("esc_status").signals.iter().filter(|signal| signal.signal.name.ends_with("esc_rpm"));
    let ranges: Vec<_> = speeds.filter_map(|signal| signal.range).collect();
    // 1334 to 2976 rpm
    let low = ranges.iter().map(|range| range.low).fold(f64::INFINITY, f64::min);
    let high = ranges.iter().map(|range| range.high).fold(0.0, f64::max);
    assert!(((60.0 * low).round(), (60.0 * high).round(), ranges.len()) == (1334.0, 2976.0, 4), "{low} {high}");
}

#[test]
fn a_real_log_without_escs_has_no_rotor_speed() {
    let Some(bytes) = real("px4_sample_small.ulg") else { return };
    let log = log_summary(&bytes[..], &ColumnNames::default()).unwrap();
    assert!(!log.has_rotor_speed() && log.about_rotors().count() > 10);
    // one entry of a table of its own is 1167 s later
    let [from_s, to_s] = log.span_s().unwrap();
    assert!((6.0..8.0).contains(&(to_s - from_s)), "{from_s} to {to_s} s");
}

#[test]
fn a_thrust_stand_has_a_command_and_the_sensor_that_sees_the_motor() {
    let Some(bytes) = real("rcbenchmark_command_steps.csv") else { return };
    let log = log_summary(&bytes[..], &ColumnNames::default()).unwrap();
    assert_eq!((log.format, log.has_rotor_speed()), (LogFormat::RcBenchmark, true));
    assert!((log.tables[0].rate_hz.unwrap() - 44.0).abs() < 0.5);
    let flight = flight_of(&bytes).unwrap();
    let (speeds, commands) = (flight.speeds_rev_s.unwrap(), flight.commands.unwrap());
    // 21 240 rpm of the electrical speed; the optical sensor of this stand saw nothing
    let highest = speeds.values[0].iter().copied().fold(0.0, f64::max);
    assert_eq!((highest, speeds.names.len(), commands.names.len()), (21_240.0 / 60.0, 1, 1));
    let commanded: Vec<f64> = [1150.0, 1290.0, 1430.0, 1570.0, 1710.0].to_vec();
    let mut seen = commands.values[0].clone();
    seen.dedup();
    assert_eq!(seen, commanded);
}
