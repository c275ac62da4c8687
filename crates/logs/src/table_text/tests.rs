//! Logs as programs write them, and as they should not be.

use crate::{ColumnNames, ElectricalColumn, LogError, LoggedFlight, flight_from_log};
use std::f64::consts::TAU;

fn flight_log_from_csv(text: &str) -> Result<LoggedFlight, LogError> {
    flight_from_log(text.as_bytes(), &ColumnNames::default())
}

#[test]
fn columns_are_found_wherever_they_stand_and_gaps_are_gaps() {
    let text = "\u{feff}loop,motor[1],time (us),motor[0],gyroADC[0] (deg/s),gyroADC[1] (deg/s),gyroADC[2] (deg/s)\n\
                1,1100,1000000,1000,180,0,0\n2,1110,1010000,1010,90,1,2\n3,,1020000,1020,0,0,360\n3,1,1020000,1,1,1,1\n";
    let log = flight_log_from_csv(text).unwrap();
    let commands = log.commands.unwrap();
    assert_eq!(commands.names, ["motor 0", "motor 1"]);
    // the third row lacks a motor, but not the rates; the fourth has its time, and then it is the motors' turn
    assert_eq!(commands.time_s, [1.0, 1.01, 1.02]);
    assert_eq!(commands.values, [[1000.0, 1010.0, 1.0], [1100.0, 1110.0, 1.0]]);
    let rates = log.rates.unwrap();
    assert_eq!(rates.time_s.len(), 3);
    assert!((rates.rates_rad_s[0][0] - TAU / 2.0).abs() < 1e-12 && (rates.rates_rad_s[2][2] - TAU).abs() < 1e-12);
    assert_eq!(log.speeds_rev_s, None);
}

#[test]
fn speeds_are_in_rev_s_and_in_the_order_of_their_numbers() {
    let log = flight_log_from_csv("time_s;rotor2_rpm;rotor1_rpm\n0;120;60\n0.5;120;60\n").unwrap();
    let speeds = log.speeds_rev_s.unwrap();
    assert_eq!(speeds.names, ["motor 1", "motor 2"]);
    assert!((speeds.values[0][1] - 1.0).abs() < 1e-12 && (speeds.values[1][0] - 2.0).abs() < 1e-12);
}

#[test]
fn tabs_part_cells_and_a_comma_can_be_a_decimal_one() {
    let comma = flight_log_from_csv("time_s,motor1_pwm\n0,1.5\n0.5,2\n").unwrap();
    for text in ["time_s\tmotor1_pwm\n0\t1.5\n0.5\t2\n", "time_s;motor1_pwm\n0;1,5\n0,5;2\n"] {
        assert_eq!(flight_log_from_csv(text).unwrap(), comma, "{text:?}");
    }
    assert_eq!(comma.commands.unwrap().values, [[1.5, 2.0]]);
}

#[test]
fn what_means_nothing_is_refused_with_what_to_do() {
    for (text, words) in [
        ("time,motor1_pwm\n0,1\n", ["unit", "time, motor1_pwm"]),
        ("motor1_pwm,motor2_pwm\n0,1\n", ["time", "columns are"]),
        ("time_s,x_m\n0,1\n", ["a motor or a body rate", "time_s, x_m"]),
        ("time_s,gyro_x_rad_s\n0,1\n", ["a motor or a body rate", "gyro_x_rad_s"]),
        ("time_s,motor1_pwm,m1\n0,1,2\n", ["motor1_pwm", "m1"]),
        ("time_s,motor1_rpm\n0,3600\n0,1,3600,5\n", ["line 3", "4 cells, but the header has 2"]),
        ("time_s,motor1_pwm\n0,fast\n", ["line 2", "fast"]),
        ("time_s,motor1_pwm\n0,inf\n", ["line 2", "inf"]),
        ("time_s,motor1_pwm\n1,1\n0.5,1\n", ["line 3", "earlier than the time of the line above"]),
    ] {
        let error = flight_log_from_csv(text).unwrap_err();
        let message = error.to_string();
        assert!(words.iter().all(|word| message.contains(word)), "{text:?}: {message}");
        assert!(!error.hint().is_empty());
    }
    assert_eq!(flight_log_from_csv("").unwrap_err().to_string(), "this file is empty");
}

/// Some programs end each row with a comma, and a log that was cut off ends within a row.
#[test]
fn empty_cells_behind_the_last_header_and_missing_cells_are_no_fault() {
    let log = flight_log_from_csv("time_s,motor1_pwm\n0,1,\n1,2, ,\n2\n").unwrap();
    assert_eq!(log.commands.unwrap().values[0][..2], [1.0, 2.0]);
}

/// The eRPM columns of Betaflight are no speeds of rotors before the number of magnetic poles is known; motors count from 0 there.
#[test]
fn electrical_speeds_need_the_number_of_poles() {
    let text = "loopIteration, time (us), motor[0], motor[1], eRPM[0], eRPM[1]\n0,1000000,1700,1710,253,252\n1,1004000,1700,1710,254,252\n";
    let log = flight_log_from_csv(text).unwrap();
    assert_eq!(log.commands.unwrap().names, ["motor 1", "motor 2"]);
    assert_eq!(log.speeds_rev_s, None);
    let electrical = log.electrical.unwrap();
    assert_eq!(electrical.motors.names, ["motor 1", "motor 2"]);
    assert_eq!(electrical.motors.values, [[253.0, 254.0], [252.0, 252.0]]);
    let named = |columns: &[ElectricalColumn]| -> Vec<(String, String)> {
        columns.iter().map(|column| (column.header.clone(), column.name_with_poles.clone())).collect()
    };
    let columns = named(&electrical.columns);
    assert_eq!(columns[1], ("eRPM[1]".to_owned(), "rotor2_erpm100_14_poles".to_owned()));
    // each proposed name makes its column a rotor speed
    let mut names = ColumnNames::default();
    columns.iter().for_each(|(header, name)| names.add(header, name).unwrap());
    let named = flight_from_log(text.as_bytes(), &names).unwrap();
    let speeds = named.speeds_rev_s.unwrap();
    assert_eq!((speeds.names.len(), named.electrical), (2, None));
    assert!((speeds.values[0][0] - 253.0 * 100.0 / 7.0 / 60.0).abs() < 1e-9, "{:?}", speeds.values);
    // without the other columns of blackbox_decode, unit and first number are not known
    let log = flight_log_from_csv("time_s,erpm_0\n0,25300\n1,25300\n").unwrap();
    let electrical = log.electrical.unwrap();
    assert_eq!(
        (electrical.motors.names, &*electrical.columns[0].name_with_poles),
        (vec!["motor 0".to_owned()], "rotor0_erpm_14_poles")
    );
}

/// A new name may be that of another column: the message says where the name comes from.
#[test]
fn a_name_that_another_column_has_is_told_with_its_source() {
    let mut names = ColumnNames::default();
    names.add("rpm[0]", "rotor1_rpm").unwrap();
    let error = flight_from_log(b"time_s,rpm[0],rpm[1]\n0,1,1\n".as_slice(), &names).unwrap_err();
    assert_eq!(
        error.to_string(),
        "columns \"rpm[0]\" (with the name rotor1_rpm from --column) and \"rpm[1]\" are read as the same signal"
    );
    assert!(error.hint().contains("different names"), "{}", error.hint());
}
