//! The log of a recording's flight beside what was heard: names of rotors, order check, constants of motors; and its part of `results.json`.

use crate::motor_json::{CombinedLine, combined_line};
use crate::motor_record::{LoggedMotor, MotorRecord};
use crate::notice::Notice;
use crate::quote::counted;
use crate::verification::{failed_check, status_of, undecided_check};
use hovertone_analysis::{LabelSource, NotTold, RotorLabels, Verification, VerifiedRotor};
use hovertone_dynamics::constants_of;
use serde::Serialize;

/// The log of a flight, compared with its recording.
#[derive(Clone, Debug, PartialEq)]
pub struct FlightLogRecord {
    /// Name of the log in the experiment file.
    pub file: String,
    /// SHA-256 of its bytes, in hexadecimal; absent where it was not requested.
    pub sha256: Option<String>,
    /// Heard against logged speeds; absent where the log has no speeds, and without a rotor tone.
    pub verification: Option<Verification>,
    /// Why speeds of the log could not be compared.
    pub not_verified: Option<Notice>,
    /// Names of the separated rotors; absent without a rotor tone.
    pub labels: Option<RotorLabels>,
    /// The motors of the log that turn.
    pub motors: MotorRecord,
}

impl FlightLogRecord {
    /// Whether the log contradicts the order or the clock of the recording.
    pub fn has_failed_check(&self) -> bool {
        self.verification.as_ref().is_some_and(|found| !found.is_right())
    }

    /// The warnings that follow: an order check that failed or is not decided, or a log that cannot be compared.
    pub fn notices(&self) -> Vec<Notice> {
        let failed = self.verification.as_ref().and_then(failed_check).map(|Notice { text, hint, .. }| {
            Notice::new(format!("the speeds in {} do not fit the sound: {text}", self.file), hint)
        });
        let undecided = self.verification.as_ref().and_then(undecided_check).map(|Notice { text, hint, .. }| {
            Notice::new(format!("the check of the sound against {} is not decided: {text}", self.file), hint)
        });
        let not_compared = self.not_verified.as_ref().map(|Notice { text, hint, .. }| {
            Notice::new(format!("the sound was not compared with {}: {text}", self.file), hint.clone())
        });
        failed.into_iter().chain(undecided).chain(not_compared).chain(self.unused()).collect()
    }

    /// The warning that the log tells nothing: it has no speeds to compare, and does not name the rotors.
    fn unused(&self) -> Option<Notice> {
        let has_check = self.verification.is_some() || self.not_verified.is_some();
        let is_unused = !has_check && self.motors.motors.is_empty();
        let reason = match self.labels.as_ref().filter(|_| is_unused)?.not_told.as_ref()? {
            NotTold::OtherCount { rotors, of_log } => {
                format!("the log has {}, but the vehicle has {}", counted(*of_log, "motor"), counted(*rotors, "rotor"))
            }
            other => other.to_string(),
        };
        Some(Notice::new(
            format!(
                "{} is not used: it has no rotor speed, and it cannot tell which rotor is which: {reason}",
                self.file
            ),
            "give a log that has the speeds of this vehicle's motors; `hovertone log FILE` lists what a log has",
        ))
    }

    /// The heard rotors, each with what the log tells of it.
    pub(crate) fn rotors(&self) -> Vec<RotorInLog<'_>> {
        let verified = self.verification.as_ref().map_or(&[][..], |found| &found.rotors);
        let labels = self.labels.as_ref().map_or(&[][..], |labels| &labels.rotors);
        let count = verified.iter().map(|rotor| rotor.track + 1).fold(labels.len(), usize::max);
        let rotor = |track: usize| {
            let label = labels.get(track).and_then(Option::as_ref);
            let verified = verified.iter().find(|rotor| rotor.track == track);
            RotorInLog {
                number: track + 1,
                motor: label.map(|label| label.name.as_str()).or_else(|| Some(verified?.name.as_str())),
                probability: label.map(|label| label.probability),
                verified,
            }
        };
        (0..count).map(rotor).collect()
    }

    /// Why rotors have no name, or only a guessed one.
    pub(crate) fn reason_of_labels(&self) -> Option<String> {
        self.labels.as_ref()?.not_told.as_ref().map(ToString::to_string)
    }
}

/// A heard rotor, with what the log tells of it.
pub(crate) struct RotorInLog<'a> {
    /// Its number by speed, from 1.
    pub(crate) number: usize,
    /// Its motor: the named one, else the nearest.
    pub(crate) motor: Option<&'a str>,
    /// Probability of the name.
    pub(crate) probability: Option<f64>,
    pub(crate) verified: Option<&'a VerifiedRotor>,
}

/// A log of `results.json`.
#[derive(Serialize)]
pub(crate) struct FlightLogLine<'a> {
    file: &'a str,
    sha256: Option<&'a str>,
    order_check: Option<&'static str>,
    reason: Option<&'a str>,
    offset_s: Option<f64>,
    is_offset_told: Option<bool>,
    clock_rate_share: Option<f64>,
    speed_ratio: Option<f64>,
    near_ratio: Option<f64>,
    label_source: Option<LabelSource>,
    label_reason: Option<String>,
    rotors: Vec<RotorLine<'a>>,
    motors: Vec<MotorLine<'a>>,
}

#[derive(Serialize)]
struct RotorLine<'a> {
    motor: Option<&'a str>,
    probability: Option<f64>,
    speed_rev_s: Option<f64>,
    bias_rev_s: Option<f64>,
    scatter_rev_s: Option<f64>,
    coverage: Option<f64>,
    point_count: Option<usize>,
}

#[derive(Serialize)]
struct MotorLine<'a> {
    name: &'a str,
    command: Option<&'a str>,
    time_constant_up_s: Option<CombinedLine>,
    time_constant_down_s: Option<CombinedLine>,
    dead_time_s: Option<CombinedLine>,
    gain_rev_s: Option<f64>,
    gain_std_rev_s: Option<f64>,
    speed_rev_s_max: f64,
}

impl<'a> FlightLogLine<'a> {
    pub(crate) fn of(log: &'a FlightLogRecord) -> Self {
        let found = log.verification.as_ref();
        Self {
            file: &log.file,
            sha256: log.sha256.as_deref(),
            order_check: found.map(status_of),
            reason: log.not_verified.as_ref().map(|notice| notice.text.as_str()),
            offset_s: found.map(|found| found.offset_s),
            is_offset_told: found.map(|found| found.is_offset_told),
            clock_rate_share: found.and_then(|found| found.clock_rate_share),
            speed_ratio: found.map(|found| found.speed_ratio),
            near_ratio: found.and_then(|found| found.near_ratio),
            label_source: log.labels.as_ref().map(|labels| labels.source),
            label_reason: log.reason_of_labels(),
            rotors: log.rotors().into_iter().map(rotor_line).collect(),
            motors: log.motors.motors.iter().map(motor_line).collect(),
        }
    }
}

fn rotor_line(rotor: RotorInLog<'_>) -> RotorLine<'_> {
    let RotorInLog { motor, probability, verified, .. } = rotor;
    RotorLine {
        motor,
        probability,
        speed_rev_s: verified.map(|verified| verified.speed_rev_s),
        bias_rev_s: verified.map(|verified| verified.bias_rev_s),
        scatter_rev_s: verified.map(|verified| verified.scatter_rev_s),
        coverage: verified.map(|verified| verified.coverage),
        point_count: verified.map(|verified| verified.point_count),
    }
}

fn motor_line(motor: &LoggedMotor) -> MotorLine<'_> {
    let constants = constants_of(std::slice::from_ref(&motor.model));
    let gain = motor.model.static_map.as_ref().and_then(|map| map.gain_rev_s);
    MotorLine {
        name: &motor.name,
        command: motor.command.as_deref(),
        time_constant_up_s: constants.time_constant_up_s.map(combined_line),
        time_constant_down_s: constants.time_constant_down_s.map(combined_line),
        dead_time_s: constants.dead_time_s.map(combined_line),
        gain_rev_s: gain.map(|gain| gain.value),
        gain_std_rev_s: gain.and_then(|gain| gain.std_uncertainty),
        speed_rev_s_max: motor.model.speed_rev_s_max,
    }
}
