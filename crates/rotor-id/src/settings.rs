//! Settings of the labels.

use hovertone_vehicle::{ConfigError, check_range};
use serde::Serialize;

/// How tracks are compared with a log of the same flight, and when a label is given.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LabelsConfig {
    /// Smallest offset that is tried, in s: time to be added to the log's clock to get the recording's. Absent: all offsets at which log
    /// and hover share [`overlap_share_min`](Self::overlap_share_min) of the shorter of the two.
    pub offset_s_low: Option<f64>,
    /// Largest offset that is tried, in s. Absent: as for the smallest.
    pub offset_s_high: Option<f64>,
    /// Step of the offset, in s: a fifth of the 0.1 s in which a small multirotor's motors respond.
    pub offset_step_s: f64,
    /// Most log rows that are compared, summed over all offsets. A hover of one minute in a log of twelve minutes needs about
    /// this number, which takes one core about one minute.
    pub comparisons_max: usize,
    /// Smallest overlap of log and hover, as a share of the shorter of the two.
    pub overlap_share_min: f64,
    /// Length to which the rows of a faster log are averaged, in s: a track has one point every 0.04 s.
    pub row_s: f64,
    /// Fewest log rows that are compared: three seconds of a slow log at 3 Hz.
    pub rows_min: usize,
    /// Standard deviation of the ratio between a motor's logged mean speed and its track's, after a common factor, as a share of the
    /// speed. Telemetry of motor controllers has steps of 10 to 100 electrical turns per minute: 0.1 to 0.3 %.
    pub speed_level_std_share: f64,
    /// Standard deviation of the response time that the offset of a log of commands contains, in s: motors respond within 0.02 to 0.2 s.
    pub command_delay_std_s: f64,
    /// Exponent of the likelihood (a power likelihood, Miller and Dunson 2019): no noise is exactly as its model, and the difference
    /// looks like information. On simulated hovers in which next to nothing moves, the exponent 1 gives wrong labels in 5 to 8 % of the
    /// flights.
    pub evidence_share: f64,
    /// Smallest probability of a label that is given.
    pub probability_min: f64,
}

impl Default for LabelsConfig {
    fn default() -> Self {
        Self {
            offset_s_low: None,
            offset_s_high: None,
            offset_step_s: 0.02,
            comparisons_max: 50_000_000,
            overlap_share_min: 0.5,
            row_s: 0.04,
            rows_min: 10,
            speed_level_std_share: 0.003,
            command_delay_std_s: 0.05,
            evidence_share: 0.5,
            probability_min: 0.99,
        }
    }
}

/// Half width of the offsets about one that the speeds have told: commands precede their speeds by less, and telemetry lags by less. *Physics.*
const NEAR_S: f64 = 0.5;

impl LabelsConfig {
    /// The defaults, with offsets near one that is known already.
    pub fn near(offset_s: Option<f64>) -> Self {
        Self {
            offset_s_low: offset_s.map(|offset_s| offset_s - NEAR_S),
            offset_s_high: offset_s.map(|offset_s| offset_s + NEAR_S),
            ..Self::default()
        }
    }

    /// Checks that each setting is in its range.
    ///
    /// # Errors
    /// The first setting that is not: its name, value and limits.
    pub fn check(&self) -> Result<(), ConfigError> {
        let low_s = self.offset_s_low.unwrap_or(0.0);
        check_range("offset_s_low", low_s, -1e10, 1e10)?;
        check_range("offset_s_high", self.offset_s_high.unwrap_or(low_s), low_s, 1e10)?;
        check_range("offset_step_s", self.offset_step_s, 0.001, 1.0)?;
        check_range("overlap_share_min", self.overlap_share_min, 0.01, 1.0)?;
        check_range("row_s", self.row_s, 0.001, 1.0)?;
        check_range("speed_level_std_share", self.speed_level_std_share, 1e-6, 0.1)?;
        check_range("command_delay_std_s", self.command_delay_std_s, 0.0, 1.0)?;
        check_range("evidence_share", self.evidence_share, 0.01, 1.0)?;
        check_range("probability_min", self.probability_min, 0.5, 1.0)
    }
}
