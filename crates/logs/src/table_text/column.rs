//! From the headers of a CSV to the quantities of its columns.

use std::f64::consts::TAU;

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
    if has(&["rpm", "erpm"]) {
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
        use LogColumn::{MotorCommand, MotorSpeed, Rate, Time, TimeWithoutUnit, Torque};
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
        ] {
            assert_eq!(column_of(header), None, "{header}");
        }
    }
}
