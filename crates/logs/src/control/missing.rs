//! What a log lacks for a loop of the embedded controller, and what to log.

use super::LoggedControl;
use crate::LogFormat;

/// A loop of eq 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ControlLoop {
    /// Roll angle.
    Roll,
    /// Pitch angle.
    Pitch,
    /// Yaw rate.
    Yaw,
    /// Vertical speed.
    Climb,
}

impl ControlLoop {
    const ALL: [Self; 4] = [Self::Roll, Self::Pitch, Self::Yaw, Self::Climb];

    /// Name of its quantity.
    pub fn name(self) -> &'static str {
        match self {
            Self::Roll => "roll",
            Self::Pitch => "pitch",
            Self::Yaw => "yaw rate",
            Self::Climb => "climb",
        }
    }
}

/// A loop that cannot be used, and what to log.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct MissingControl {
    /// The loop.
    pub control_loop: ControlLoop,
    /// What is missing: "its command".
    pub what: &'static str,
    /// What to log or to fly.
    pub hint: &'static str,
}

/// The loops without command or measurement, apart from those that are missing for another reason already.
pub(super) fn missing_of(control: &LoggedControl, format: LogFormat) -> Vec<MissingControl> {
    let measured = [
        control.tilt_rad[0].is_some(),
        control.tilt_rad[1].is_some(),
        control.rates_rad_s[2].is_some(),
        control.climb_m_s.is_some(),
    ];
    let loops = ControlLoop::ALL.into_iter().zip(&control.command).zip(measured);
    let missing = |((control_loop, command), is_measured): ((ControlLoop, &Option<Vec<f64>>), bool)| {
        let what = match (command.is_some(), is_measured) {
            (true, true) => return None,
            (false, true) => "its command",
            (true, false) => "its measured value",
            (false, false) => "its command and its measured value",
        };
        let Advice { of_command, of_measured } = advice(format, control_loop, is_measured);
        let hint = if command.is_none() { of_command } else { measured_hint(control_loop, of_measured) };
        Some(MissingControl { control_loop, what, hint })
    };
    let is_new =
        |missing: &MissingControl| control.missing.iter().all(|known| known.control_loop != missing.control_loop);
    loops.filter_map(missing).filter(is_new).collect()
}

/// What to log.
struct Advice {
    of_command: &'static str,
    /// Of attitude, yaw rate and vertical speed.
    of_measured: [&'static str; 3],
}

fn advice(format: LogFormat, control_loop: ControlLoop, is_measured: bool) -> Advice {
    match format {
        LogFormat::Ulog => Advice {
            of_command: "let PX4 log your sticks (the topic manual_control_setpoint), and fly with them in Altitude mode",
            of_measured: [
                "let PX4 log the topic vehicle_attitude",
                "let PX4 log the topic vehicle_angular_velocity",
                "let PX4 log the topic vehicle_local_position",
            ],
        },
        LogFormat::DataFlash => Advice {
            of_command: "let ArduPilot log your sticks (the message RCIN: RC Input in LOG_BITMASK), and fly with them in AltHold mode",
            of_measured: [
                "let ArduPilot log the message ATT",
                "let ArduPilot log the message IMU",
                "let ArduPilot log the message XKF1 (of the EKF)",
            ],
        },
        LogFormat::Blackbox => Advice {
            of_command: "let the blackbox log your sticks (rcCommand), and fly in angle mode (for climb: in altitude hold of INAV)",
            of_measured: [
                "let the blackbox log the attitude: INAV has it, Betaflight does not",
                "let the blackbox log the gyro (gyroADC)",
                "let the blackbox log the vertical speed (navVel): INAV has it, Betaflight does not",
            ],
        },
        LogFormat::Csv | LogFormat::RcBenchmark => Advice {
            of_command: if is_measured { csv_command(control_loop) } else { csv_both(control_loop) },
            of_measured: [
                "log a column roll_deg or pitch_deg",
                "log a column yaw_rate_rad_s",
                "log a column velocity_z_m_s",
            ],
        },
    }
}

/// Of attitude, yaw rate and vertical speed the one that a loop needs.
fn measured_hint(control_loop: ControlLoop, [attitude, rate, climb]: [&'static str; 3]) -> &'static str {
    match control_loop {
        ControlLoop::Roll | ControlLoop::Pitch => attitude,
        ControlLoop::Yaw => rate,
        ControlLoop::Climb => climb,
    }
}

fn csv_both(control_loop: ControlLoop) -> &'static str {
    match control_loop {
        ControlLoop::Roll => "log the columns command_roll (from −1 to 1) and roll_deg",
        ControlLoop::Pitch => "log the columns command_pitch (from −1 to 1) and pitch_deg",
        ControlLoop::Yaw => "log the columns command_yaw_rate (from −1 to 1) and yaw_rate_rad_s",
        ControlLoop::Climb => "log the columns command_climb (from −1 to 1) and velocity_z_m_s",
    }
}

fn csv_command(control_loop: ControlLoop) -> &'static str {
    match control_loop {
        ControlLoop::Roll => "log a column command_roll with values from −1 to 1",
        ControlLoop::Pitch => "log a column command_pitch with values from −1 to 1",
        ControlLoop::Yaw => "log a column command_yaw_rate with values from −1 to 1",
        ControlLoop::Climb => "log a column command_climb with values from −1 to 1",
    }
}
