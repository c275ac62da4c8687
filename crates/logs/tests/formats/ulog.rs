//! Logs with known content, written here; damaged logs; real logs.

use crate::flight_of;
use crate::real::real;
use crate::writers::ulog::{Writer, escs, flight, floats};
use hovertone_logs::{ColumnNames, LogError, LoggedFlight, RateAxes, signals_from_log};
use proptest::prelude::*;
use std::path::PathBuf;

#[test]
fn speeds_commands_and_rates_each_on_their_own_times() {
    let log = flight_of(&flight()).unwrap();
    assert!(log.notes.is_empty(), "{:?}", log.notes);
    let rates = log.rates.unwrap();
    assert_eq!((rates.time_s.len(), rates.axes), (100, Some(RateAxes::ForwardRightDown)));
    // the time of the sample, not of the message
    assert!((rates.time_s[1] - 10.009).abs() < 1e-9);
    let row = [0, 1, 2].map(|axis| rates.rates_rad_s[axis][50]);
    assert_eq!(row, [0.5, -0.5, 0.5]);
    let commands = log.commands.unwrap();
    // the third channel does not move
    assert_eq!(commands.names, ["motor 1", "motor 2", "motor 4"]);
    assert_eq!(commands.time_s.len(), 50);
    assert!((commands.values[2][25] - 1.1).abs() < 1e-6);
    let speeds = log.speeds_rev_s.unwrap();
    assert_eq!(speeds.names, ["motor 1", "motor 2", "motor 3", "motor 4"]);
    let rows: Vec<i64> = speeds.time_s.iter().map(|time| (100.0 * (time - 10.0)).round() as i64).collect();
    assert_eq!(rows, [0, 10, 20, 40, 60, 70, 80, 90]);
    assert!((speeds.values[0][3] - 3040.0 / 60.0).abs() < 1e-9);
    // the sound does not depend on the direction of rotation
    assert!((speeds.values[1][3] - 3100.0 / 60.0).abs() < 1e-9);
}

#[test]
fn outputs_stand_in_for_motors_by_the_instance_that_moves() {
    let bytes = flight();
    let without = String::from_utf8_lossy(b"actuator_motors").into_owned();
    let mut bytes_without = bytes.clone();
    for at in 0..bytes.len() - without.len() {
        if &bytes[at..at + without.len()] == without.as_bytes() {
            bytes_without[at] = b'x';
        }
    }
    let commands = flight_of(&bytes_without).unwrap().commands.unwrap();
    assert_eq!(commands.names, ["output 1", "output 2", "output 3", "output 4"]);
    assert!((commands.values[3][10] - 1550.0).abs() < 1e-3 && commands.time_s.len() == 20);
}

#[test]
fn escs_that_say_whose_they_are_are_put_in_order_and_stale_ones_are_gaps() {
    let mut log = Writer::new();
    let status = log.topic("esc_status", 0);
    for row in 0..4_u64 {
        let now_us = 1_000_000 * (row + 1);
        // the third row has no news since the second
        let reported_us = if row == 2 { now_us - 1_000_000 } else { now_us };
        let functions = [103, 101, 104, 102];
        log.data(
            status,
            &[
                &now_us.to_le_bytes(),
                &(row as u16).to_le_bytes(),
                &[0; 6],
                &escs(reported_us, &[300, 100, 400, 200], &functions),
            ],
        );
    }
    let speeds = flight_of(&log.bytes).unwrap().speeds_rev_s.unwrap();
    assert_eq!(speeds.names, ["motor 1", "motor 2", "motor 3", "motor 4"]);
    let rpm: Vec<f64> = speeds.values.iter().map(|values| (values[0] * 60.0).round()).collect();
    assert_eq!((rpm, speeds.time_s), (vec![100.0, 200.0, 300.0, 400.0], vec![1.0, 2.0, 4.0]));
}

#[test]
fn what_tells_nothing_is_refused_with_what_to_do() {
    let mut silent = Writer::new();
    let cpu = silent.topic("cpuload", 0);
    silent.data(cpu, &[&1_u64.to_le_bytes(), &floats(&[0.5])]);
    let header = &flight()[..16];
    for (bytes, words) in [
        (silent.bytes.as_slice(), ["motor speeds", "cpuload"]),
        (&silent.bytes[..400], ["before its data", "ULog"]),
        (header, ["before its data", "ULog"]),
        (&header[..7], ["before its data", "ULog"]),
        (b"\xa3\x95\x80\0FMT", ["before its data", "DataFlash"]),
        (b"PK\x03\x04\0\0", ["neither a CSV", "ULog"]),
        (b"time_s,x\n0,1\n", ["a motor or a body rate", "time_s"]),
    ] {
        let error = flight_of(bytes).unwrap_err();
        let message = error.to_string();
        assert!(words.iter().all(|word| message.contains(word)), "{message}");
        assert!(!error.hint().is_empty());
    }
}

/// Whether every series has the length of its times, which increase.
fn is_sound(log: &LoggedFlight) -> bool {
    let rises = |time_s: &[f64]| time_s.windows(2).all(|pair| pair[0] < pair[1]) && !time_s.is_empty();
    let motors = [&log.speeds_rev_s, &log.commands].into_iter().flatten();
    let are_motors_sound = motors.into_iter().all(|motors| {
        let length = motors.time_s.len();
        rises(&motors.time_s)
            && motors.names.len() == motors.values.len()
            && motors.values.iter().all(|values| values.len() == length && values.iter().all(|value| value.is_finite()))
    });
    are_motors_sound
        && log
            .rates
            .iter()
            .all(|rates| rises(&rates.time_s) && rates.rates_rad_s.iter().all(|axis| axis.len() == rates.time_s.len()))
}

#[test]
fn a_log_that_breaks_off_is_read_up_to_there() {
    let whole = flight();
    let mut read = 0;
    for length in (0..whole.len()).step_by(7) {
        match flight_of(&whole[..length]) {
            Ok(log) => {
                read += 1;
                assert!(is_sound(&log));
                // all rates of the result are rates of the log
                let is_rate = |table: &str, _: &_| table == "vehicle_angular_velocity";
                let read = signals_from_log(&whole[..length], &ColumnNames::default(), is_rate).unwrap();
                let expected = read.tables[0].time_s.len();
                let rows = log.rates.map_or(0, |rates| rates.time_s.len());
                assert_eq!(rows, expected);
                assert!(log.notes.len() <= 1, "{:?}", log.notes);
            }
            Err(error) => assert!(!error.to_string().is_empty()),
        }
    }
    assert!(read > whole.len() / 7 / 2, "{read} of {}", whole.len() / 7);
    let cut = flight_of(&whole[..whole.len() - 3]).unwrap();
    assert!(cut.notes[0].contains("breaks off"), "{:?}", cut.notes);
}

#[test]
fn reading_goes_on_behind_damage() {
    let whole = flight();
    let sound = flight_of(&whole).unwrap().rates.unwrap();
    let middle = whole.len() / 2;
    let mut damaged = whole.clone();
    damaged[middle..middle + 200].fill(0xff);
    let log = flight_of(&damaged).unwrap();
    let rates = log.rates.as_ref().unwrap();
    assert!(log.notes[0].contains("in 1 place,"), "{:?}", log.notes);
    assert_eq!(rates.time_s.last(), sound.time_s.last());
    // 200 bytes hold at most 200 / 41 rates
    assert!(rates.time_s.len() >= 100 - 200 / 41 - 2, "{}", rates.time_s.len());
    let is_known = |time: &f64| sound.time_s.contains(time);
    assert!(rates.time_s.iter().all(is_known) && is_sound(&log));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    #[test]
    fn flipped_bytes_are_answered(
        flips in prop::collection::vec((0_usize..1 << 20, any::<u8>()), 1..40),
        kept in 0.0..1.0_f64,
    ) {
        let mut bytes = flight();
        let length = bytes.len();
        flips.iter().for_each(|&(at, with)| bytes[7 + at % (length - 7)] ^= with);
        bytes.truncate(7 + (kept * length as f64) as usize);
        if let Ok(log) = flight_of(&bytes) {
            prop_assert!(is_sound(&log));
        }
    }

    #[test]
    fn any_bytes_are_answered(bytes in prop::collection::vec(any::<u8>(), 0..2000), as_ulog in any::<bool>()) {
        let magic: &[u8] = if as_ulog { &[0x55, 0x4c, 0x6f, 0x67, 0x01, 0x12, 0x35, 1, 0, 0, 0, 0, 0, 0, 0, 0] } else { &[] };
        if let Ok(log) = flight_of(&[magic, &bytes].concat()) {
            prop_assert!(is_sound(&log));
        }
    }
}

/// A value as read by the `px4_ulog` reader.
fn as_px4_reads(name: &str, topic: &str, instance: u8, field: &str) -> Vec<f64> {
    use px4_ulog::full_parser::{MultiId, SomeVec, read_file};
    let shared = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data"));
    let path = std::env::var_os("HOVERTONE_TEST_DATA").map_or_else(shared, PathBuf::from).join("logs").join(name);
    let parsed = read_file(path.to_str().unwrap()).unwrap();
    match &parsed.messages[topic][&MultiId::new(instance)][field] {
        SomeVec::Float(values) => values.iter().map(|value| f64::from(*value)).collect(),
        SomeVec::Int32(values) => values.iter().map(|value| f64::from(*value)).collect(),
        SomeVec::UInt64(values) => values.iter().map(|value| *value as f64).collect(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_real_flight_with_escs_is_read_as_px4_reads_it() {
    let name = "px4_esc_status.ulg";
    let Some(bytes) = real(name) else { return };
    let log = flight_of(&bytes).unwrap();
    assert!(log.notes.is_empty() && is_sound(&log), "{:?}", log.notes);
    let (speeds, commands, rates) = (log.speeds_rev_s.unwrap(), log.commands.unwrap(), log.rates.unwrap());
    assert_eq!(speeds.names, ["motor 1", "motor 2", "motor 3", "motor 4"]);
    assert_eq!(commands.names, ["output 1", "output 2", "output 3", "output 4"]);
    let rpm = as_px4_reads(name, "esc_status", 0, "esc[2].esc_rpm");
    let times = as_px4_reads(name, "esc_status", 0, "timestamp");
    let mut compared = 0;
    for (time_s, speed) in speeds.time_s.iter().zip(&speeds.values[2]) {
        let row = times.iter().position(|time| (time * 1e-6 - time_s).abs() < 1e-9).unwrap();
        assert!((speed - rpm[row].abs() / 60.0).abs() < 1e-9);
        compared += 1;
    }
    assert!(compared > rpm.len() / 2, "{compared} of {}", rpm.len());
    // a heavy multirotor: 1334 to 2976 rpm
    let all = || speeds.values.iter().flatten().map(|speed| speed * 60.0);
    assert!(all().all(|rpm| (1000.0..3500.0).contains(&rpm)));
    assert_eq!(commands.values[1], as_px4_reads(name, "actuator_outputs", 1, "output[1]"));
    assert_eq!(rates.rates_rad_s[2], as_px4_reads(name, "sensor_combined", 0, "gyro_rad[2]"));
}

#[test]
fn a_real_log_without_escs_has_rates() {
    let name = "px4_sample_small.ulg";
    let Some(bytes) = real(name) else { return };
    let log = flight_of(&bytes).unwrap();
    assert!(is_sound(&log) && log.speeds_rev_s.is_none());
    let rates = log.rates.unwrap();
    assert_eq!(rates.rates_rad_s[0], as_px4_reads(name, "vehicle_angular_velocity", 0, "xyz[0]"));
    assert!(matches!(flight_of(&bytes[..200]), Err(LogError::WithoutData { .. })));
}
