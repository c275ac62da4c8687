//! Logs of the flights of an experiment: read before the recordings are heard, and compared with them after.

use super::recordings::LogFile;
use crate::failure::Failure;
use crate::files::sha256_of_file;
use crate::labels::{labels_of_record, logs_of_motors};
use crate::log::{column_names, electrical_in_words, loss_notice};
use crate::motor::{flight_of, motors_of_log};
use crate::recording::Job;
use crate::verify::verification_of;
use hovertone::rotors::{FlightLog, LabelsConfig, LoggedSpeeds, NotVerified};
use hovertone_logs::{ElectricalColumn, LoggedFlight};
use hovertone_report::{FlightLogRecord, Notice, SpeedRecord};

/// A log that was read.
pub(crate) struct FlownLog {
    file: LogFile,
    sha256: Option<String>,
    flight: LoggedFlight,
    /// Its speeds and commands, the more informative first.
    signals: Vec<FlightLog>,
}

impl FlownLog {
    /// Reads a log that has speeds or commands of motors.
    pub(crate) fn read(file: LogFile, wants_hash: bool) -> Result<Self, Failure> {
        let path = &file.path;
        let refused = |what: &str, hint: &str| Failure::failed(what, hint, path);
        let flight = flight_of(path, &column_names(&[])?)?
            .ok_or_else(|| refused("this is no log", "name the log of the flight, as in log = \"a.ulg\""))?;
        let signals = logs_of_motors(&flight, path)?;
        if signals.is_empty() {
            let hint = "in a CSV, name these columns rotor1_rpm or motor1_pwm, and so on; else log the speeds that the ESCs \
                        report (telemetry), or the motor commands. Without a log, write the name of the recording alone";
            return Err(refused("this log has no rotor speeds and no motor commands that hovertone knows", hint));
        }
        let sha256 = wants_hash.then(|| sha256_of_file(path)).transpose();
        let sha256 = sha256.map_err(|error| refused(&format!("the log cannot be read: {error}"), "check the disk"))?;
        Ok(Self { sha256, flight, signals, file })
    }

    /// That the log has electrical speeds in place of rotor speeds.
    fn electrical_notice(&self) -> Option<Notice> {
        let columns = self.flight.electrical_columns();
        let ElectricalColumn { header, name_with_poles } =
            columns.first().filter(|_| self.flight.speeds_rev_s.is_none())?;
        let hint = format!(
            "count the magnets in the bell of a motor, and write their number into the headers of the CSV. For 14 magnets, as in most small motors, \
             write {name_with_poles} in place of {header}, and so on"
        );
        Some(Notice::new(electrical_in_words(columns)?, hint))
    }

    /// Compares the log with its recording, whose record gets the warnings that follow.
    pub(crate) fn compared(&self, record: &mut SpeedRecord, job: &Job) -> FlightLogRecord {
        let has_tone = record.speed().is_some();
        let verification = match &self.flight.speeds_rev_s {
            Some(speeds) if has_tone => {
                let logged =
                    LoggedSpeeds { time_s: &speeds.time_s, names: &speeds.names, speeds_rev_s: &speeds.values };
                verification_of(record, logged, None).map(Some)
            }
            _ => Ok(None),
        };
        let (verification, not_verified) = match verification {
            Ok(verification) => (verification, self.electrical_notice().filter(|_| has_tone)),
            Err(reason) => (None, Some(Notice::new(reason.to_string(), hint_of(reason)))),
        };
        let near = verification.as_ref().filter(|found| found.is_offset_told).map(|found| found.offset_s);
        let labels = || labels_of_record(record, job.config.rotors.count, &self.signals, &LabelsConfig::near(near));
        let compared = FlightLogRecord {
            file: self.file.name.clone(),
            sha256: self.sha256.clone(),
            labels: has_tone.then(labels).flatten(),
            verification,
            not_verified,
            motors: motors_of_log(&self.file.name, &self.flight),
        };
        let losses = self.flight.notes.iter().map(|words| loss_notice(&format!("{}: {words}", self.file.name)));
        record.notices.splice(0..0, compared.notices().into_iter().chain(losses));
        compared
    }
}

/// What to do, in an experiment file.
fn hint_of(reason: NotVerified) -> &'static str {
    match reason {
        NotVerified::TooFewMotors { .. } => "give the log of the same vehicle, or correct rotors under [vehicle]",
        NotVerified::TooLong => "cut the log to the flight",
        reason => reason.hint(),
    }
}
