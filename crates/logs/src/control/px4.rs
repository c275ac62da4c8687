//! Sticks, attitude and velocity of a ULog.

use super::series::{ControlSeries, Series};
use super::{ControlLoop, LoggedControl, base_name};
use crate::flight::LoggedFlight;
use crate::signals::SignalTable;

/// The signals of each topic.
const WANTED: [(&str, &[&str]); 4] = [
    ("manual_control_setpoint", &["x", "y", "z", "r", "roll", "pitch", "yaw", "throttle"]),
    ("vehicle_attitude", &["q[0]", "q[1]", "q[2]", "q[3]"]),
    ("vehicle_local_position", &["vz"]),
    ("vehicle_status", &["nav_state"]),
];
/// `nav_state` in which sticks command angles, yaw rate and climb: Altitude mode.
const ALTITUDE_MODE: f64 = 1.0;
/// `nav_state` in which the throttle is the thrust: Stabilized mode.
const STABILIZED_MODE: f64 = 15.0;
/// Motors of PX4 at our places: front left, rear left, rear right, front right.
const MOTOR_OF_ROTOR: [u32; 4] = [3, 2, 4, 1];

pub(super) fn is_wanted(table: &str, signal: &str) -> bool {
    let topic = base_name(table);
    let is_of = |(name, signals): &(&str, &[&str])| *name == topic && signals.contains(&signal);
    let has_motors_or_rates = matches!(topic, "esc_status" | "vehicle_angular_velocity" | "sensor_combined");
    WANTED.iter().any(is_of) || has_motors_or_rates
}

pub(super) fn control(tables: &[SignalTable], flight: &LoggedFlight) -> LoggedControl {
    let topic = |name: &str| tables.iter().filter(|table| !table.time_s.is_empty()).find(|table| table.name == name);
    let sticks = topic("manual_control_setpoint");
    // sticks: forward and right are positive, and in our axes nose down, right side down, and turns to the left
    let stick = |names: &[&str], sign: f64| Series::of(sticks?, names, |value| sign * value);
    // the throttle was 0 to 1 as long as it was called z
    let throttle = stick(&["throttle"], 1.0).or_else(|| Series::of(sticks?, &["z"], |value| 2.0 * value - 1.0));
    let rate = |axis: usize, sign: f64| {
        let rates = flight.rates.as_ref()?;
        let values = rates.rates_rad_s[axis].iter().map(|rate| sign * rate).collect();
        Some(Series { time_s: &rates.time_s, values })
    };
    let attitude = topic("vehicle_attitude");
    let mut series = ControlSeries {
        command: [stick(&["roll", "y"], 1.0), stick(&["pitch", "x"], 1.0), stick(&["yaw", "r"], -1.0), throttle],
        tilt_rad: [
            attitude.and_then(|table| angle(table, roll_rad)),
            attitude.and_then(|table| angle(table, nose_down_rad)),
        ],
        rates_rad_s: [rate(0, 1.0), rate(1, -1.0), rate(2, -1.0)],
        climb_m_s: topic("vehicle_local_position").and_then(|table| Series::of(table, &["vz"], |down_m_s| -down_m_s)),
        speeds: flight.speeds_rev_s.clone(),
        motor_of_rotor: MOTOR_OF_ROTOR,
        missing: Vec::new(),
    };
    let hint = "fly in Altitude mode: then the sticks command angles, yaw rate and climb";
    if let Some(mode) = topic("vehicle_status").and_then(|table| commonest(table.values_of("nav_state")?)) {
        let is_tilt = mode == ALTITUDE_MODE || mode == STABILIZED_MODE;
        let wrong = [
            (ControlLoop::Roll, !is_tilt),
            (ControlLoop::Pitch, !is_tilt),
            (ControlLoop::Climb, mode != ALTITUDE_MODE),
        ];
        wrong.into_iter().filter(|(_, is_wrong)| *is_wrong).for_each(|(of, _)| series.leave_out(of, hint));
    }
    series.on_rows()
}

fn angle(table: &SignalTable, of: fn([f64; 4]) -> f64) -> Option<Series<'_>> {
    let parts = ["q[0]", "q[1]", "q[2]", "q[3]"].map(|name| table.values_of(name));
    let [Some(w), Some(x), Some(y), Some(z)] = parts else { return None };
    let values = (0..table.time_s.len()).map(|row| of([w[row], x[row], y[row], z[row]])).collect();
    Some(Series { time_s: &table.time_s, values })
}

fn roll_rad([w, x, y, z]: [f64; 4]) -> f64 {
    (2.0 * (w * x + y * z)).atan2(1.0 - 2.0 * (x * x + y * y))
}

/// Pitch with y to the left: PX4's has the nose up.
fn nose_down_rad([w, x, y, z]: [f64; 4]) -> f64 {
    -(2.0 * (w * y - z * x)).clamp(-1.0, 1.0).asin()
}

/// The value of most rows.
pub(super) fn commonest(values: &[f64]) -> Option<f64> {
    let count = |value: &f64| values.iter().filter(|other| *other == value).count();
    let mut distinct = values.to_vec();
    distinct.sort_by(f64::total_cmp);
    distinct.dedup();
    distinct.into_iter().max_by_key(count)
}
