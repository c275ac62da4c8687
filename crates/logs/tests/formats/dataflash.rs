//! DataFlash logs of ArduPilot.

use crate::writers::dataflash::{Writer, flight, rpm};
use crate::{flight_of, signals_of};
use hovertone_logs::{LogError, LogFormat, RateAxes};

#[test]
fn speeds_commands_and_rates_have_the_numbers_of_their_motors() {
    let flight = flight_of(&flight(3)).unwrap();
    assert!(flight.notes.is_empty(), "{:?}", flight.notes);
    let speeds = flight.speeds_rev_s.unwrap();
    assert_eq!(speeds.names, ["motor 1", "motor 2", "motor 3", "motor 4"]);
    // motor 1 is on output 3; between its reports at 10 Hz the speed is a straight line
    let esc_of_motor = [2, 1, 3, 0];
    let bend_rev_s = 200.0 / 60.0 * (5.0_f64 * 0.1).powi(2) / 8.0;
    assert!(speeds.time_s.len() >= 28, "{}", speeds.time_s.len());
    for (values, esc) in speeds.values.iter().zip(esc_of_motor) {
        for (time_s, speed) in speeds.time_s.iter().zip(values) {
            assert!(
                (speed - f64::from(rpm(esc, *time_s)) / 60.0).abs() < bend_rev_s,
                "ESC {esc} at {time_s} s: {speed}"
            );
        }
    }
    let commands = flight.commands.unwrap();
    assert_eq!(commands.names, ["motor 1", "motor 2", "motor 3", "motor 4"]);
    let first: Vec<f64> = commands.values.iter().map(|values| values[0]).collect();
    assert_eq!((first, commands.time_s.len()), (vec![1520.0, 1510.0, 1530.0, 1500.0], 150));
    let rates = flight.rates.unwrap();
    assert_eq!((rates.axes, rates.time_s.len()), (Some(RateAxes::ForwardRightDown), 300));
    assert!((rates.rates_rad_s[2][7] - 0.3).abs() < 1e-6 && rates.rates_rad_s[0][7] > 0.0);
}

#[test]
fn every_value_has_its_unit_and_each_sensor_a_table() {
    let log = signals_of(&flight(1));
    assert_eq!(log.format, LogFormat::DataFlash);
    assert_eq!(log.table_names, ["ESC[0]", "ESC[1]", "ESC[2]", "ESC[3]", "IMU[0]", "IMU[1]", "RCOU"]);
    let esc = log.tables.iter().find(|table| table.name == "ESC[2]").unwrap();
    let about: Vec<(&str, &str, f64)> = (esc.signals.iter().zip(&esc.values))
        .map(|(signal, values)| (signal.name.as_str(), signal.unit.as_str(), (1e4 * values[0]).round() / 1e4))
        .collect();
    let speed_rev_s = (1e4 * f64::from(rpm(2, 1.001)) / 60.0).round() / 1e4;
    assert_eq!(about, [("RPM", "rev/s", speed_rev_s), ("Volt", "V", 16.5), ("Temp", "", 0.45), ("Curr", "A", 12.34)]);
    assert!((esc.time_s[0] - 1.001).abs() < 1e-12);
}

#[test]
fn without_functions_of_outputs_the_ones_that_move_are_named_as_outputs() {
    let mut log = Writer::new(&[]);
    for step in 0..10_u64 {
        log.outputs(1000 * step, [1500, 1000 + step as u16, 1100 + step as u16, 0, 0, 0]);
        log.esc(1000 * step, 1, 600.0);
    }
    let flight = flight_of(&log.bytes).unwrap();
    assert_eq!(flight.commands.unwrap().names, ["output 2", "output 3"]);
    let speeds = flight.speeds_rev_s.unwrap();
    assert_eq!((speeds.names, speeds.values[0][0]), (vec!["motor 2".to_owned()], 10.0));
}

#[test]
fn a_log_without_rotors_or_without_data_is_refused_with_what_to_do() {
    let head = Writer::new(&[]).bytes;
    assert!(matches!(flight_of(&head), Err(LogError::WithoutData { format: LogFormat::DataFlash })));
    let mut log = Writer::new(&[]);
    log.esc(1000, 0, 0.0);
    let error = flight_of(&log.bytes).unwrap_err();
    assert!(error.to_string().contains("its tables are: ESC[0]") && error.hint().contains("ESC telemetry"), "{error}");
}
