//! A log of a flight: commands or speeds of the motors, or body rates.

use hovertone_analysis::LabelSource;
use hovertone_vehicle::RotorPlace;

/// A log of a flight, on a clock of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct FlightLog {
    /// Times of the rows, increasing.
    pub(super) time_s: Vec<f64>,
    signals: LogSignals,
}

/// The series of a log, one value for each row.
#[derive(Clone, Debug, PartialEq)]
#[non_exhaustive]
pub enum LogSignals {
    /// One series for each motor.
    Motors {
        /// The quantity.
        signal: MotorSignal,
        /// Names of the motors.
        names: Vec<String>,
        /// `values[motor][row]`: the speed of the rotor's shaft in rad/s; or the command, in any unit that grows with the speed.
        values: Vec<Vec<f64>>,
    },
    /// Angular velocity of the vehicle about its axes.
    BodyRates {
        /// Place of each rotor on the vehicle.
        places: Vec<RotorPlace>,
        /// Roll, pitch and yaw rate of each row, about the axes x forward, y left and z up.
        rates_rad_s: [Vec<f64>; 3],
    },
}

/// The quantity that a log holds for each motor.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MotorSignal {
    /// A command or PWM. Its changes are compared, its mean is not: motors differ in the speed that a command gives.
    Command,
    /// A measured speed. Its changes and its mean are compared.
    Speed,
}

/// Why a log is refused.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum LogError {
    /// Series of different lengths.
    #[error("a signal has {length} values, but the log has {times} times")]
    UnequalLengths {
        /// Length of the series.
        length: usize,
        /// Number of times.
        times: usize,
    },
    /// Names for another number of motors than there are series.
    #[error("{names} names are given for {series} motors")]
    UnequalNames {
        /// Number of names.
        names: usize,
        /// Number of series.
        series: usize,
    },
    /// Times that do not increase.
    #[error("row {row} (counted from 0) has the time {time_s} s, which is not later than the time of the row before")]
    NotInOrder {
        /// Row, counted from 0.
        row: usize,
        /// Its time.
        time_s: f64,
    },
    /// A value that is no number.
    #[error("row {row} (counted from 0) holds a value that is no number")]
    NotFinite {
        /// Row, counted from 0.
        row: usize,
    },
}

impl FlightLog {
    /// Checks the series of a log. Leave out a row in which a value is missing: the times then show a gap.
    ///
    /// # Errors
    /// Series of different lengths, another number of names than of series, times that do not increase, values that are not finite.
    pub fn new(time_s: Vec<f64>, signals: LogSignals) -> Result<Self, LogError> {
        let log = Self { time_s, signals };
        if let LogSignals::Motors { names, values, .. } = &log.signals
            && names.len() != values.len()
        {
            return Err(LogError::UnequalNames { names: names.len(), series: values.len() });
        }
        let times = log.time_s.len();
        for series in log.series() {
            if series.len() != times {
                return Err(LogError::UnequalLengths { length: series.len(), times });
            }
            if let Some(row) = series.iter().position(|value| !value.is_finite()) {
                return Err(LogError::NotFinite { row });
            }
        }
        if let Some(row) = log.time_s.iter().position(|time_s| !time_s.is_finite()) {
            return Err(LogError::NotFinite { row });
        }
        if let Some(before) = log.time_s.windows(2).position(|pair| pair[1] <= pair[0]) {
            return Err(LogError::NotInOrder { row: before + 1, time_s: log.time_s[before + 1] });
        }
        Ok(log)
    }

    /// The series.
    pub fn signals(&self) -> &LogSignals {
        &self.signals
    }

    pub(super) fn series(&self) -> &[Vec<f64>] {
        match &self.signals {
            LogSignals::Motors { values, .. } => values,
            LogSignals::BodyRates { rates_rad_s, .. } => rates_rad_s,
        }
    }

    pub(super) fn source(&self) -> LabelSource {
        match self.signals {
            LogSignals::Motors { signal: MotorSignal::Command, .. } => LabelSource::MotorCommands,
            LogSignals::Motors { signal: MotorSignal::Speed, .. } => LabelSource::MotorSpeeds,
            LogSignals::BodyRates { .. } => LabelSource::BodyRates,
        }
    }

    /// Names of the rotors, in the order of their numbers.
    pub(super) fn names(&self) -> Vec<String> {
        match &self.signals {
            LogSignals::Motors { names, .. } => names.clone(),
            LogSignals::BodyRates { places, .. } => places.iter().map(|place| place.name.to_owned()).collect(),
        }
    }
}
