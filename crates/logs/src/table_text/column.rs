//! From the headers of a CSV to the quantities of its columns.

use crate::electrical::{HUNDREDS_RPM, rev_s_of_electrical_rpm};
use std::f64::consts::TAU;

/// Most magnetic poles of a motor of a multirotor. *Physics.*
const POLES_MAX: u32 = 100;

/// Quantity of a column. Factors are units of the signal (s, rad/s) per unit of the column.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum LogColumn {
    Time {
        factor: f64,
    },
    /// A time in an unknown unit.
    TimeWithoutUnit,
    /// Rate about x, y or z: 0, 1 or 2.
    Rate {
        axis: usize,
        factor: f64,
    },
    /// Speed of a motor, in rev/s per unit of the column.
    MotorSpeed {
        motor: u32,
        rev_s: f64,
    },
    /// Electrical speed of a motor, in hundreds of rpm or in an unknown unit. Its number of magnetic poles is not known.
    ElectricalSpeed {
        motor: u32,
        is_in_hundreds: bool,
    },
    MotorCommand {
        motor: u32,
    },
    /// Torque of a test stand, in N m per unit of the column.
    Torque {
        factor: f64,
    },
}

const ABOUT: [&[&str]; 3] = [&["x", "roll", "p"], &["y", "pitch", "q"], &["z", "yaw", "r"]];

/// Quantity of a header; `None` for columns without information about rotors.
pub(super) fn column_of(header: &str) -> Option<LogColumn> {
    let words = words_of(header);
    let has = |any: &[&str]| words.iter().any(|word| any.contains(&word.as_str()));
    if has(&["time", "timestamp"]) || words.first().is_some_and(|word| word == "t") {
        let units = [("s", 1.0), ("sec", 1.0), ("ms", 1e-3), ("us", 1e-6), ("µs", 1e-6), ("ns", 1e-9)];
        let unit = units.iter().find(|(unit, _)| has(&[unit]));
        return Some(match unit {
            Some(&(_, factor)) => LogColumn::Time { factor },
            // the logs of PX4 never name the unit, which is always this one
            None if words == ["timestamp"] => LogColumn::Time { factor: 1e-6 },
            None => LogColumn::TimeWithoutUnit,
        });
    }
    if has(&["torque"]) && !has(&["setpoint", "desired", "target"]) && !words.iter().any(|it| it.parse::<u32>().is_ok())
    {
        // what names no unit may be a share of the largest torque
        let units: [(&[&str], f64); 3] = [(&["n", "m"], 1.0), (&["nm"], 1.0), (&["mn", "m"], 1e-3)];
        let ends_with = |unit: &[&str]| words.len() > unit.len() && words[words.len() - unit.len()..] == *unit;
        return units.iter().find(|(unit, _)| ends_with(unit)).map(|&(_, factor)| LogColumn::Torque { factor });
    }
    if has(&[
        "squares",
        "square",
        "setpoint",
        "desired",
        "target",
        "torque",
        "thrust",
        "current",
        "temperature",
        "temp",
        "power",
    ]) {
        return None;
    }
    if let Some(at) = words.iter().position(|word| word == "erpm") {
        return electrical_column(&words, at);
    }
    let number = words.iter().find_map(|word| word.parse::<u32>().ok());
    if has(&["gyro", "gyroadc", "rate", "rates", "rollspeed", "pitchspeed", "yawspeed", "p", "q", "r"])
        && !has(&["motor", "rotor", "esc"])
    {
        let named = ["rollspeed", "pitchspeed", "yawspeed"].iter().position(|name| has(&[name]));
        let lettered = ABOUT.iter().position(|names| has(names));
        let axis = named.or(lettered).or(number.map(|number| number as usize).filter(|axis| *axis < 3))?;
        let factor = match () {
            () if has(&["rad", "rads"]) => 1.0,
            () if has(&["deg", "degrees", "dps"]) => TAU / 360.0,
            () => return None,
        };
        return Some(LogColumn::Rate { axis, factor });
    }
    let motor = number?;
    if has(&["rpm"]) {
        return Some(LogColumn::MotorSpeed { motor, rev_s: 1.0 / 60.0 });
    }
    if has(&["rad"]) && has(&["s"]) {
        return Some(LogColumn::MotorSpeed { motor, rev_s: 1.0 / TAU });
    }
    if has(&["rps", "hz"]) || has(&["rev"]) && has(&["s"]) {
        return Some(LogColumn::MotorSpeed { motor, rev_s: 1.0 });
    }
    // what an ESC measures of its battery is no command
    let is_measured = has(&["esc"]) && has(&["voltage"]);
    let is_command = !is_measured && has(&["pwm", "command", "cmd", "duty", "output", "throttle", "voltage"]);
    let is_bare = words.first().is_some_and(|word| ["motor", "rotor", "esc", "m"].contains(&word.as_str()))
        && words.iter().skip(1).all(|word| word.parse::<u32>().is_ok() || ["us", "v"].contains(&word.as_str()));
    (is_command || is_bare).then_some(LogColumn::MotorCommand { motor })
}

/// An electrical speed: "erpm" stands at a place among the words. "erpm100" means hundreds of rpm, and "14_poles" the motor.
fn electrical_column(words: &[String], at: usize) -> Option<LogColumn> {
    let number = |index: usize| words.get(index)?.parse::<u32>().ok();
    let hundreds = Some(at + 1).filter(|index| number(*index) == Some(100));
    let of_poles = words.iter().position(|word| word == "poles");
    let poles_at = of_poles.and_then(|index| index.checked_sub(1));
    let motor =
        (0..words.len()).filter(|index| Some(*index) != hundreds && Some(*index) != poles_at).find_map(number)?;
    if of_poles.is_none() {
        return Some(LogColumn::ElectricalSpeed { motor, is_in_hundreds: hundreds.is_some() });
    }
    let poles = number(poles_at?).filter(|poles| (2..=POLES_MAX).contains(poles) && poles.is_multiple_of(2))?;
    let rpm = if hundreds.is_some() { HUNDREDS_RPM } else { 1.0 };
    Some(LogColumn::MotorSpeed { motor, rev_s: rpm * rev_s_of_electrical_rpm(f64::from(poles)) })
}

/// Quantity of a header of `blackbox_decode`, Betaflight's own: motors count from 0, and electrical speeds are in hundreds of rpm.
pub(super) fn column_of_blackbox(header: &str) -> Option<LogColumn> {
    let is_of_motor = header.starts_with("motor[") || is_electrical_of_blackbox(header);
    Some(match column_of(header)? {
        LogColumn::MotorCommand { motor } if is_of_motor => LogColumn::MotorCommand { motor: motor + 1 },
        LogColumn::ElectricalSpeed { motor, .. } if is_of_motor => {
            LogColumn::ElectricalSpeed { motor: motor + 1, is_in_hundreds: true }
        }
        other => other,
    })
}

/// Whether these are headers of `blackbox_decode`.
pub(super) fn are_of_blackbox(headers: &[String]) -> bool {
    let has = |wanted: &str| headers.iter().any(|header| header == wanted);
    has("loopIteration") || has("time (us)") && headers.iter().any(|header| is_electrical_of_blackbox(header))
}

/// "eRPM[0]" or, from older versions, "eRPM(/100)[0]".
fn is_electrical_of_blackbox(header: &str) -> bool {
    header.starts_with("eRPM[") || header.starts_with("eRPM(/100)[")
}

/// The unit in the brackets of a header, as in "Torque (N·m)"; empty without one.
pub(super) fn unit_of(header: &str) -> String {
    let inside = |open: char, close: char| Some(header.strip_suffix(close)?.rsplit_once(open)?.1.trim().to_owned());
    inside('(', ')').or_else(|| inside('[', ']').filter(|unit| unit.parse::<u32>().is_err())).unwrap_or_default()
}

/// Lower-case words and whole numbers: "rotor1_speed_rad_s" becomes rotor, 1, speed, rad, s.
fn words_of(header: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let mut before: Option<char> = None;
    for character in header.to_lowercase().chars() {
        if character.is_alphanumeric() {
            let goes_on = before.is_some_and(|before| {
                before.is_alphanumeric() && before.is_ascii_digit() == character.is_ascii_digit()
            });
            match words.last_mut().filter(|_| goes_on) {
                Some(word) => word.push(character),
                None => words.push(character.to_string()),
            }
        }
        before = Some(character);
    }
    words
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_unit_is_what_the_brackets_hold() {
        for (header, unit) in
            [("Torque (N·m)", "N·m"), ("acc [m/s²]", "m/s²"), ("motor[3]", ""), ("battery_v", ""), ("a)", "")]
        {
            assert_eq!(unit_of(header), unit, "{header}");
        }
    }

    #[test]
    fn a_sum_of_squares_is_no_motor() {
        assert_eq!(column_of("mean_sum_of_squares_rad2_s2"), None);
        assert!(matches!(column_of("rotor_2_mean_speed_rev_s"), Some(LogColumn::MotorSpeed { motor: 2, .. })));
    }

    #[test]
    fn headers_as_programs_write_them() {
        use LogColumn::{ElectricalSpeed, MotorCommand, MotorSpeed, Rate, Time, TimeWithoutUnit, Torque};
        let deg = TAU / 360.0;
        for (header, column) in [
            ("time_s", Time { factor: 1.0 }),
            ("time (us)", Time { factor: 1e-6 }),
            ("Time [ms]", Time { factor: 1e-3 }),
            ("timestamp", Time { factor: 1e-6 }),
            ("time", TimeWithoutUnit),
            ("gyro_x_rad_s", Rate { axis: 0, factor: 1.0 }),
            ("gyro.y (deg/s)", Rate { axis: 1, factor: deg }),
            ("gyroADC[2] (deg/s)", Rate { axis: 2, factor: deg }),
            ("roll_rate_rad_s", Rate { axis: 0, factor: 1.0 }),
            ("pitch_rate_rad_s", Rate { axis: 1, factor: 1.0 }),
            ("r_rad_s", Rate { axis: 2, factor: 1.0 }),
            ("yawspeed_rad_s", Rate { axis: 2, factor: 1.0 }),
            ("motor1_pwm", MotorCommand { motor: 1 }),
            ("motor[0]", MotorCommand { motor: 0 }),
            ("m4", MotorCommand { motor: 4 }),
            ("output[3]", MotorCommand { motor: 3 }),
            ("motor2 (us)", MotorCommand { motor: 2 }),
            ("voltage_3_v", MotorCommand { motor: 3 }),
            ("rotor1_speed_rad_s", MotorSpeed { motor: 1, rev_s: 1.0 / TAU }),
            ("speed_2_rad_s", MotorSpeed { motor: 2, rev_s: 1.0 / TAU }),
            ("esc[0].esc_rpm", MotorSpeed { motor: 0, rev_s: 1.0 / 60.0 }),
            ("rotor3_speed_rev_s", MotorSpeed { motor: 3, rev_s: 1.0 }),
            ("eRPM[2]", ElectricalSpeed { motor: 2, is_in_hundreds: false }),
            ("eRPM(2)", ElectricalSpeed { motor: 2, is_in_hundreds: false }),
            ("erpm_2", ElectricalSpeed { motor: 2, is_in_hundreds: false }),
            ("eRPM(/100)[2]", ElectricalSpeed { motor: 2, is_in_hundreds: true }),
            ("rotor2_erpm_14_poles", MotorSpeed { motor: 2, rev_s: 2.0 / 14.0 / 60.0 }),
            ("rotor2_erpm100_12_poles", MotorSpeed { motor: 2, rev_s: 100.0 * (2.0 / 12.0 / 60.0) }),
            ("Torque (N·m)", Torque { factor: 1.0 }),
            ("torque_n_m", Torque { factor: 1.0 }),
            ("torque [mN m]", Torque { factor: 1e-3 }),
        ] {
            assert_eq!(column_of(header), Some(column), "{header}");
        }
        for header in [
            "x_m",
            "gyro_x",
            "velocity_x_m_s",
            "thrust_1_n",
            "torque_1_n_m",
            "torque",
            "torque_setpoint_n_m",
            "command_roll",
            "roll_deg",
            "battery_v",
            "motor1_temperature_c",
            "esc[0].esc_current",
            "acc[0]",
            "rotor1_speed_setpoint_rad_s",
            "erpm",
            "rotor1_erpm100_7_poles",
            "rotor1_erpm_0_poles",
        ] {
            assert_eq!(column_of(header), None, "{header}");
        }
    }
}
