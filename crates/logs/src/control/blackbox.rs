//! Sticks, attitude and velocity of a blackbox log, whose axes are ours.

use super::series::{ControlSeries, Series};
use super::{ControlLoop, LoggedControl};
use crate::flight::LoggedFlight;
use crate::signals::SignalTable;

/// Largest value of `rcCommand` of roll, pitch and yaw.
const COMMAND_MAX: f64 = 500.0;
/// Middle of `rcCommand` of the throttle.
const THROTTLE_MIDDLE: f64 = 1500.0;
/// `attitude` is in tenths of a degree, `navVel` in cm/s.
const TENTHS: f64 = 10.0;
const CM_PER_M: f64 = 100.0;
/// Motors of Betaflight and INAV at our places: front left, rear left, rear right, front right.
const MOTOR_OF_ROTOR: [u32; 4] = [4, 3, 1, 2];

pub(super) fn control(tables: &[SignalTable], flight: &LoggedFlight) -> LoggedControl {
    let Some(table) = tables.iter().rev().max_by_key(|table| table.time_s.len()) else {
        return LoggedControl::default();
    };
    let stick = |name: &str| Series::of(table, &[name], |value| (value / COMMAND_MAX).clamp(-1.0, 1.0));
    let throttle = |value: f64| ((value - THROTTLE_MIDDLE) / COMMAND_MAX).clamp(-1.0, 1.0);
    let tilt = |name: &str| Series::of(table, &[name], |tenths: f64| (tenths / TENTHS).to_radians());
    let rate = |axis: usize| {
        let rates = flight.rates.as_ref()?;
        Some(Series { time_s: &rates.time_s, values: rates.rates_rad_s[axis].clone() })
    };
    let mut series = ControlSeries {
        command: [
            stick("rcCommand[0]"),
            stick("rcCommand[1]"),
            stick("rcCommand[2]"),
            Series::of(table, &["rcCommand[3]"], throttle),
        ],
        tilt_rad: [tilt("attitude[0]"), tilt("attitude[1]")],
        rates_rad_s: [0, 1, 2].map(rate),
        climb_m_s: Series::of(table, &["navVel[2]"], |cm_s| cm_s / CM_PER_M),
        speeds: flight.speeds_rev_s.clone(),
        motor_of_rotor: MOTOR_OF_ROTOR,
        missing: Vec::new(),
    };
    if series.climb_m_s.is_none() {
        series.leave_out(ControlLoop::Climb, "fly in altitude hold and log navVel: INAV has it, Betaflight does not");
    }
    series.on_rows()
}
