//! Sticks, attitude and velocity of a DataFlash log.

use super::px4::commonest;
use super::series::{ControlSeries, Series};
use super::{ControlLoop, LoggedControl, base_name};
use crate::flight::LoggedFlight;
use crate::signals::SignalTable;

/// The signals of each type of message; of several sensors or filters the first.
const WANTED: [(&str, &[&str]); 7] = [
    ("RCIN", &["C1", "C2", "C3", "C4"]),
    ("ATT", &["Roll", "Pitch"]),
    ("XKF1", &["VD"]),
    ("NKF1", &["VD"]),
    ("EKF1", &["VD"]),
    ("MODE", &["ModeNum", "Mode"]),
    ("IMU", &["GyrX", "GyrY", "GyrZ"]),
];
/// Mode in which sticks command angles, yaw rate and climb: AltHold.
const ALTITUDE_MODE: f64 = 2.0;
/// Mode in which the throttle is the thrust: Stabilize.
const STABILIZE_MODE: f64 = 0.0;
/// Middle and half range of a stick, µs.
const STICK_US: [f64; 2] = [1500.0, 500.0];
/// Motors of ArduPilot at our places: front left, rear left, rear right, front right.
const MOTOR_OF_ROTOR: [u32; 4] = [3, 2, 4, 1];

pub(super) fn is_wanted(table: &str, signal: &str) -> bool {
    let kind = base_name(table);
    let is_of = |(name, signals): &(&str, &[&str])| *name == kind && signals.contains(&signal);
    WANTED.iter().any(is_of) || (kind.starts_with("ESC") && signal == "RPM")
}

pub(super) fn control(tables: &[SignalTable], flight: &LoggedFlight) -> LoggedControl {
    let kind = |name: &str| {
        tables.iter().filter(|table| !table.time_s.is_empty()).find(|table| base_name(&table.name) == name)
    };
    // high values: right side down, nose up, climb, and a turn to the right
    let stick = |name: &str, sign: f64| {
        let [middle_us, half_us] = STICK_US;
        Series::of(kind("RCIN")?, &[name], |us| (sign * (us - middle_us) / half_us).clamp(-1.0, 1.0))
    };
    let rate = |axis: usize, sign: f64| {
        let rates = flight.rates.as_ref()?;
        Some(Series { time_s: &rates.time_s, values: rates.rates_rad_s[axis].iter().map(|rate| sign * rate).collect() })
    };
    let tilt = |name: &str, sign: f64| Series::of(kind("ATT")?, &[name], |deg| sign * deg.to_radians());
    let velocity = ["XKF1", "NKF1", "EKF1"].into_iter().find_map(kind);
    let mut series = ControlSeries {
        command: [stick("C1", 1.0), stick("C2", -1.0), stick("C4", -1.0), stick("C3", 1.0)],
        tilt_rad: [tilt("Roll", 1.0), tilt("Pitch", -1.0)],
        rates_rad_s: [rate(0, 1.0), rate(1, -1.0), rate(2, -1.0)],
        climb_m_s: velocity.and_then(|table| Series::of(table, &["VD"], |down_m_s| -down_m_s)),
        speeds: flight.speeds_rev_s.clone(),
        motor_of_rotor: MOTOR_OF_ROTOR,
        missing: Vec::new(),
    };
    let hint = "fly in AltHold mode: then the sticks command angles, yaw rate and climb";
    let modes = kind("MODE").and_then(|table| table.values_of("ModeNum").or_else(|| table.values_of("Mode")));
    // a message is written where the mode changes: the last one is that of the flight
    if let Some(mode) =
        modes.filter(|modes| modes.len() < 3).and_then(<[f64]>::last).copied().or_else(|| commonest(modes?))
    {
        let is_tilt = mode == ALTITUDE_MODE || mode == STABILIZE_MODE;
        let wrong = [
            (ControlLoop::Roll, !is_tilt),
            (ControlLoop::Pitch, !is_tilt),
            (ControlLoop::Climb, mode != ALTITUDE_MODE),
        ];
        wrong.into_iter().filter(|(_, is_wrong)| *is_wrong).for_each(|(of, _)| series.leave_out(of, hint));
    }
    series.on_rows()
}
