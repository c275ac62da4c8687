//! From a log to the commands and measurements of an embedded controller.
//!
//! ```text
//! px4        sticks, attitude and velocity of a ULog      ardupilot   the same of a DataFlash log
//! blackbox   one table                                    series      series with times of their own, on common rows
//! missing    what a log lacks, and what to log
//! ```

mod ardupilot;
mod blackbox;
mod missing;
mod px4;
mod series;

pub use missing::{ControlLoop, MissingControl};

use crate::flight::flight_of_tables;
use crate::signals::{CollectedSignals, SignalTable, collected};
use crate::table::{SignalRole, TableSignal};
use crate::{ColumnNames, LogError, LogFormat, RateAxes};
use missing::missing_of;
use std::io::Read;

/// Tables of formats with one table: blackbox, CSV.
const IN_ONE_TABLE: [&str; 2] = ["main", "table"];
/// Headers of the commands: roll, pitch, yaw rate, climb. The symbols are those of the paper.
const COMMANDS: [&[&str]; 4] = [
    &["command_roll", "roll_command", "u_phi", "u_φ"],
    &["command_pitch", "pitch_command", "u_theta", "u_θ"],
    &["command_yaw_rate", "command_yaw", "yaw_command", "u_psi", "u_ψ"],
    &["command_climb", "climb_command", "u_z"],
];
/// Headers of the angles in rad; in degrees with the ending `_deg`.
const ANGLES: [&[&str]; 2] = [&["roll_rad", "phi_rad"], &["pitch_rad", "theta_rad"]];
/// Headers of the vertical rate.
const CLIMBS: [&str; 4] = ["climb_m_s", "velocity_z_m_s", "vz_m_s", "climb_rate_m_s"];

/// Commands and measurements of the embedded controller of a multirotor with four rotors, with the axes x forward, y left, z up: a
/// positive pitch has the nose down, a positive yaw rate turns left.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct LoggedControl {
    /// Times of the log rows, increasing.
    pub time_s: Vec<f64>,
    /// Commands of roll, pitch, yaw rate and climb, ±1.
    pub command: [Option<Vec<f64>>; 4],
    /// Roll and pitch angle.
    pub tilt_rad: [Option<Vec<f64>>; 2],
    /// Body rates about x, y and z.
    pub rates_rad_s: [Option<Vec<f64>>; 3],
    /// Vertical rate, positive up.
    pub climb_m_s: Option<Vec<f64>>,
    /// Shaft speeds of rotors 1 to 4, rev/s.
    pub speeds_rev_s: [Option<Vec<f64>>; 4],
    /// Loops that lack a signal.
    pub missing: Vec<MissingControl>,
    /// What could not be read.
    pub loss: Option<String>,
}

/// Reads the control signals of a log. Rows without a time later than the one before, and rows with a gap, are left out.
///
/// - *CSV*: by its headers; `axes` are those of angles, body rates and velocity. Other formats define their axes.
/// - *PX4 ULog*: the sticks of `manual_control_setpoint`, where they command angles; `vehicle_attitude`, `vehicle_angular_velocity`,
///   `vehicle_local_position`, `esc_status`.
/// - *ArduPilot DataFlash*: the sticks of `RCIN`, where they command angles; `ATT`, `IMU`, the estimated velocity, `ESC`.
/// - *Blackbox*: `rcCommand`, `attitude` (INAV), `gyroADC`, `navVel` (INAV), `eRPM`.
///
/// The rows of a ULog or a DataFlash log are those of its attitude.
///
/// # Errors
/// Those of [`crate::log_summary`].
pub fn control_from_log(source: impl Read, names: &ColumnNames, axes: RateAxes) -> Result<LoggedControl, LogError> {
    let is_wanted = |table: &str, signal: &TableSignal| {
        let is_of_vehicle = px4::is_wanted(table, &signal.name) || ardupilot::is_wanted(table, &signal.name);
        is_of_vehicle || IN_ONE_TABLE.contains(&base_name(table))
    };
    let CollectedSignals { signals: log, findings } = collected(source, names, is_wanted)?;
    let flight = flight_of_tables(log.format, &log.tables, &findings);
    let mut control = match log.format {
        LogFormat::Ulog => px4::control(&log.tables, &flight),
        LogFormat::DataFlash => ardupilot::control(&log.tables, &flight),
        LogFormat::Blackbox => blackbox::control(&log.tables, &flight),
        LogFormat::Csv | LogFormat::RcBenchmark => {
            let control = log.tables.first().map_or_else(LoggedControl::default, control_of);
            if axes == RateAxes::ForwardRightDown { turned(control) } else { control }
        }
    };
    control.keep_whole_rows();
    control.missing.extend(missing_of(&control, log.format));
    control.loss = log.loss.in_words();
    Ok(control)
}

/// "IMU" of "IMU[0]".
fn base_name(table: &str) -> &str {
    table.split('[').next().unwrap_or(table)
}

/// From x forward, y right, z down to y left, z up.
fn turned(mut control: LoggedControl) -> LoggedControl {
    let commands = control.command[1..3].iter_mut();
    let measured = control.tilt_rad[1..].iter_mut().chain(&mut control.rates_rad_s[1..]);
    commands.chain(measured).flatten().flatten().for_each(|value| *value = -*value);
    control
}

fn control_of(table: &SignalTable) -> LoggedControl {
    let series = |wanted: &[&str]| {
        let is_wanted = |name: &str| wanted.iter().any(|known| name.eq_ignore_ascii_case(known));
        let index = table.signals.iter().position(|signal| is_wanted(&signal.name))?;
        Some(table.values[index].clone())
    };
    let in_degrees = |names: &[&str]| {
        let names: Vec<String> = names.iter().map(|name| name.replace("_rad", "_deg")).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        Some(series(&names)?.into_iter().map(f64::to_radians).collect::<Vec<f64>>())
    };
    let with_role = |role: SignalRole| {
        let index = table.signals.iter().position(|signal| signal.role == Some(role))?;
        Some(table.values[index].clone())
    };
    LoggedControl {
        time_s: table.time_s.clone(),
        command: COMMANDS.map(series),
        tilt_rad: ANGLES.map(|names| series(names).or_else(|| in_degrees(names))),
        rates_rad_s: [0, 1, 2].map(|axis| with_role(SignalRole::BodyRate(axis))),
        climb_m_s: series(&CLIMBS),
        speeds_rev_s: [1, 2, 3, 4].map(|rotor| with_role(SignalRole::RotorSpeed(rotor))),
        missing: Vec::new(),
        loss: None,
    }
}

impl LoggedControl {
    fn all(&mut self) -> impl Iterator<Item = &mut Vec<f64>> {
        let controls = self.command.iter_mut().chain(&mut self.tilt_rad).chain(&mut self.rates_rad_s);
        controls.chain([&mut self.climb_m_s]).flatten()
    }

    /// Leaves out rows with a gap in a control signal, and rows at the time of the one before. Speeds may have gaps.
    fn keep_whole_rows(&mut self) {
        let times_s = self.time_s.clone();
        let mut keep: Vec<bool> = times_s.iter().map(|time_s| time_s.is_finite()).collect();
        for series in self.all() {
            keep.iter_mut().zip(series).for_each(|(keep, value)| *keep &= value.is_finite());
        }
        let mut before_s = f64::NEG_INFINITY;
        for (keep, time_s) in keep.iter_mut().zip(times_s) {
            *keep &= time_s > before_s;
            if *keep {
                before_s = time_s;
            }
        }
        let kept = |series: &mut Vec<f64>| {
            let mut flags = keep.iter();
            series.retain(|_| flags.next().copied().unwrap_or(false));
        };
        kept(&mut self.time_s);
        self.speeds_rev_s.iter_mut().flatten().for_each(kept);
        self.all().for_each(kept);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn read(csv: &str, axes: RateAxes) -> LoggedControl {
        control_from_log(csv.as_bytes(), &ColumnNames::default(), axes).unwrap()
    }

    #[test]
    fn headers_tell_the_signals_and_rows_with_gaps_are_left_out() {
        let csv = "time_s,command_roll,u_theta,roll_deg,pitch_rad,yaw_rate_rad_s,velocity_z_m_s,speed_1_rad_s\n\
                   0,0.1,0.5,90,0.2,0.3,1,6.283185307179586\n0.1,,0.5,90,0.2,0.3,1,\n0.2,0.2,0.5,45,0.2,0.3,1,\n";
        let control = read(csv, RateAxes::ForwardLeftUp);
        assert_eq!(control.time_s, [0.0, 0.2]);
        assert_eq!(control.command[0].as_deref(), Some(&[0.1, 0.2][..]));
        assert!(control.command[2].is_none() && control.command[3].is_none());
        let roll = control.tilt_rad[0].as_ref().unwrap();
        assert!((roll[0] - std::f64::consts::FRAC_PI_2).abs() < 1e-12 && (roll[1] * 2.0 - roll[0]).abs() < 1e-12);
        assert_eq!(control.climb_m_s.as_deref(), Some(&[1.0, 1.0][..]));
        let speed = control.speeds_rev_s[0].as_ref().unwrap();
        assert!((speed[0] - 1.0).abs() < 1e-12 && speed[1].is_nan());
        let turned = read(csv, RateAxes::ForwardRightDown);
        assert_eq!((turned.command[1].as_ref().unwrap()[0], turned.tilt_rad[1].as_ref().unwrap()[0]), (-0.5, -0.2));
        assert_eq!((turned.command[0].as_ref().unwrap()[0], turned.rates_rad_s[2].as_ref().unwrap()[0]), (0.1, -0.3));
    }
}
