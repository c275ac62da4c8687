//! The same flight in each format: the commands and measurements of the embedded controller.

use crate::real::real;
use crate::writers::dataflash::{ATT, MODE, RCIN, Writer as DataFlash, XKF1};
use crate::writers::ulog::{Writer as Ulog, escs, floats};
use hovertone_logs::{ColumnNames, ControlLoop, LoggedControl, RateAxes, control_from_log};

const ROWS: u64 = 400;
/// Motors of PX4 and ArduPilot at the places front left, rear left, rear right, front right.
const MOTOR_OF_ROTOR: [usize; 4] = [3, 2, 4, 1];

fn control_of(bytes: &[u8]) -> LoggedControl {
    control_from_log(bytes, &ColumnNames::default(), RateAxes::ForwardLeftUp).unwrap()
}

/// The truth at a time, with x forward, y left, z up.
struct Truth {
    command: [f64; 4],
    roll_rad: f64,
    /// Positive with the nose down.
    pitch_rad: f64,
    rates_rad_s: [f64; 3],
    climb_m_s: f64,
}

impl Truth {
    fn at(time_s: f64) -> Self {
        // commands change twice per second
        let step = (2.0 * time_s).floor();
        Self {
            command: [0.3, -0.2, 0.4, -0.1].map(|size| size * (1.3 * step).sin()),
            roll_rad: 0.2 * (2.0 * time_s).sin(),
            pitch_rad: 0.1 * (3.0 * time_s).cos(),
            rates_rad_s: [0.4 * (2.0 * time_s).cos(), -0.3 * (3.0 * time_s).sin(), 0.5 * time_s.sin()],
            climb_m_s: 0.3 * (1.5 * time_s).sin(),
        }
    }
}

fn speed_rpm(motor: usize) -> i32 {
    3000 + 100 * motor as i32
}

/// Quaternion of a flight that points north, with y right and z down.
fn quaternion(roll_rad: f64, pitch_up_rad: f64) -> [f32; 4] {
    let ((sin_roll, cos_roll), (sin_pitch, cos_pitch)) = ((roll_rad / 2.0).sin_cos(), (pitch_up_rad / 2.0).sin_cos());
    [cos_roll * cos_pitch, sin_roll * cos_pitch, cos_roll * sin_pitch, -sin_roll * sin_pitch].map(|part| part as f32)
}

fn ulog(nav_state: u8, has_attitude: bool) -> Vec<u8> {
    let mut log = Ulog::new();
    let [sticks, attitude, velocity, rates, status, motors] = [
        "manual_control_setpoint",
        "vehicle_attitude",
        "vehicle_local_position",
        "vehicle_angular_velocity",
        "vehicle_status",
        "esc_status",
    ]
    .map(|name| log.topic(name, 0));
    for step in 0..ROWS {
        let now_us = 1_000_000 + 10_000 * step;
        let (now, truth) = (now_us.to_le_bytes(), Truth::at(now_us as f64 * 1e-6));
        let single = |value: f64| value as f32;
        if step % 10 == 0 {
            let [roll, pitch, yaw, climb] = truth.command.map(single);
            log.data(sticks, &[&now, &floats(&[pitch, roll, 0.5 * (climb + 1.0), -yaw])]);
            log.data(status, &[&now, &[nav_state], &[0; 7]]);
        }
        if has_attitude {
            log.data(attitude, &[&now, &floats(&quaternion(truth.roll_rad, -truth.pitch_rad))]);
        }
        let [x, y, z] = truth.rates_rad_s.map(single);
        log.data(rates, &[&now, &now, &floats(&[x, -y, -z]), &[0; 4]]);
        if step % 2 == 0 {
            log.data(velocity, &[&now, &floats(&[0.0, 0.0, single(-truth.climb_m_s)]), &[0; 4]]);
        }
        if step % 20 == 0 {
            let rpm = [1, 2, 3, 4].map(speed_rpm);
            log.data(motors, &[&now, &(step as u16).to_le_bytes(), &[0; 6], &escs(now_us, &rpm, &[])]);
        }
    }
    log.bytes
}

fn dataflash(mode: u8) -> Vec<u8> {
    let mut log = DataFlash::new(&[]);
    log.message(&MODE, &[&1_000_000_u64.to_le_bytes(), &[mode], &[0]]);
    for step in 0..ROWS {
        let now_us = 1_000_000 + 10_000 * step;
        let (now, truth) = (now_us.to_le_bytes(), Truth::at(now_us as f64 * 1e-6));
        if step % 10 == 0 {
            let [roll, pitch, yaw, climb] = truth.command;
            let us = [roll, -pitch, climb, -yaw].map(|stick| (1500.0 + 500.0 * stick).round() as u16);
            log.message(&RCIN, &[&now, &us.map(u16::to_le_bytes).concat()]);
        }
        let [roll, pitch] = [truth.roll_rad, -truth.pitch_rad].map(|angle| angle.to_degrees() as f32);
        log.message(&ATT, &[&now, &floats(&[0.0, roll, 0.0, pitch])]);
        log.message(&XKF1, &[&now, &[0], &floats(&[0.0, 0.0, -truth.climb_m_s as f32])]);
        let [x, y, z] = truth.rates_rad_s.map(|rate| rate as f32);
        log.imu(now_us, 0, [x, -y, -z, 0.0, 0.0, -9.8]);
        if step % 20 == 0 {
            (0..4).for_each(|esc| log.esc(now_us, esc, speed_rpm(usize::from(esc) + 1) as f32));
        }
    }
    log.bytes
}

/// Asserts that a log has the whole flight, with commands right to `command_error`.
fn is_the_flight(control: &LoggedControl, command_error: f64) {
    assert!(control.missing.is_empty() && control.loss.is_none(), "{:?} {:?}", control.missing, control.loss);
    assert!(control.time_s.len() as u64 >= ROWS - 2, "{}", control.time_s.len());
    let value = |series: &Option<Vec<f64>>, row: usize| series.as_ref().unwrap()[row];
    for (row, &time_s) in control.time_s.iter().enumerate() {
        let truth = Truth::at(time_s);
        // sticks are logged ten times per second, and a step between two log rows is seen at the later one
        let at_log_row = Truth::at((10.0 * time_s + 1e-6).floor() / 10.0);
        for (at, of_truth) in at_log_row.command.iter().enumerate() {
            assert!((value(&control.command[at], row) - of_truth).abs() < command_error, "{at} at {time_s}");
        }
        let measured = [
            (value(&control.tilt_rad[0], row), truth.roll_rad),
            (value(&control.tilt_rad[1], row), truth.pitch_rad),
            (value(&control.rates_rad_s[0], row), truth.rates_rad_s[0]),
            (value(&control.rates_rad_s[1], row), truth.rates_rad_s[1]),
            (value(&control.rates_rad_s[2], row), truth.rates_rad_s[2]),
            (value(&control.climb_m_s, row), truth.climb_m_s),
        ];
        for (at, (logged, of_truth)) in measured.into_iter().enumerate() {
            assert!((logged - of_truth).abs() < 3e-4, "{at} at {time_s}: {logged} {of_truth}");
        }
    }
    for (speeds, motor) in control.speeds_rev_s.iter().zip(MOTOR_OF_ROTOR) {
        let told: Vec<f64> = speeds.as_ref().unwrap().iter().copied().filter(|speed| speed.is_finite()).collect();
        // a row between two reports has none
        assert!((15..=20).contains(&told.len()), "{}", told.len());
        assert!(told.iter().all(|speed| (speed - f64::from(speed_rpm(motor)) / 60.0).abs() < 1e-6), "{motor}");
    }
}

#[test]
fn sticks_attitude_and_rates_of_px4_are_those_of_the_flight() {
    is_the_flight(&control_of(&ulog(1, true)), 1e-6);
}

#[test]
fn sticks_attitude_and_rates_of_ardupilot_are_those_of_the_flight() {
    // a stick has whole microseconds
    is_the_flight(&control_of(&dataflash(2)), 0.5 / 500.0 + 1e-9);
}

fn missing(control: &LoggedControl) -> Vec<(ControlLoop, &str, &str)> {
    control.missing.iter().map(|missing| (missing.control_loop, missing.what, missing.hint)).collect()
}

#[test]
fn what_a_log_lacks_is_said_for_each_loop_with_what_to_log() {
    let stabilized = control_of(&ulog(15, true));
    let [(ControlLoop::Climb, what, hint)] = missing(&stabilized)[..] else { panic!("{:?}", stabilized.missing) };
    assert!(what.contains("in this flight mode") && hint.contains("Altitude mode") && stabilized.command[0].is_some());
    let by_itself = control_of(&dataflash(3));
    assert_eq!(by_itself.missing.len(), 3, "{:?}", by_itself.missing);
    assert!(by_itself.command[2].is_some() && missing(&by_itself)[0].2.contains("AltHold"));

    let without = control_of(&ulog(1, false));
    let told: Vec<(ControlLoop, &str)> = missing(&without).iter().map(|(of, _, hint)| (*of, *hint)).collect();
    let attitude = "let PX4 log the topic vehicle_attitude";
    assert_eq!(told, [(ControlLoop::Roll, attitude), (ControlLoop::Pitch, attitude)]);
    // the rows are those of the rates then
    assert!(without.time_s.len() as u64 >= ROWS - 2 && without.rates_rad_s[2].is_some());

    let blackbox = control_of(&crate::writers::blackbox::flight(2000));
    let loops: Vec<ControlLoop> = blackbox.missing.iter().map(|missing| missing.control_loop).collect();
    assert_eq!(loops, [ControlLoop::Climb, ControlLoop::Roll, ControlLoop::Pitch]);
    assert!(missing(&blackbox)[1].2.contains("INAV"), "{:?}", blackbox.missing);
    assert!(blackbox.command[2].as_ref().unwrap().iter().all(|command| command.abs() < 1e-12));
    let turned = crate::writers::blackbox::truth(0)[13] as f64;
    assert!((blackbox.rates_rad_s[2].as_ref().unwrap()[0] - turned.to_radians()).abs() < 1e-9);

    let csv = control_of(b"time_s,command_roll,roll_deg\n0,0.1,1\n1,0.1,1\n");
    let told: Vec<(ControlLoop, &str)> = missing(&csv).iter().map(|(of, _, hint)| (*of, *hint)).collect();
    assert_eq!(told[0], (ControlLoop::Pitch, "log the columns command_pitch (from −1 to 1) and pitch_deg"));
    assert_eq!(told.len(), 3);
}

#[test]
fn a_real_flight_in_another_mode_says_which_commands_it_lacks() {
    let Some(bytes) = real("px4_esc_status.ulg") else { return };
    let control = control_of(&bytes);
    assert!(control.time_s.len() > 1000, "{}", control.time_s.len());
    assert!(control.tilt_rad.iter().all(Option::is_some) && control.climb_m_s.is_some());
    let loops: Vec<ControlLoop> = control.missing.iter().map(|missing| missing.control_loop).collect();
    assert_eq!(loops, [ControlLoop::Roll, ControlLoop::Pitch, ControlLoop::Climb]);
}
