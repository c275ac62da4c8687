//! Settings of telling which rotor is which.

use hovertone_vehicle::{ConfigError, check_range};
use serde::Serialize;

/// How tracks are compared with what was recorded in the same flight.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LabelsConfig {
    /// Smallest and largest offset that is tried: what is to be added to the log's times to have the recording's. Where absent,
    /// all at which log and hover share [`overlap_share_min`](Self::overlap_share_min) of the shorter.
    pub offset_s_low: Option<f64>,
    /// See above.
    pub offset_s_high: Option<f64>,
    /// Step of the offset: a fifth of the 0.1 s in which a small multirotor's motors answer.
    pub offset_step_s: f64,
    /// Rows that are compared at most, over all offsets: a minute's work of one core. A minute of hover in a log of twelve holds so many.
    pub comparisons_max: usize,
    /// Share of the shorter of log and hover that must be compared.
    pub overlap_share_min: f64,
    /// A faster log is averaged to rows of this length: tracks have a point every 0.04 s, and know nothing between.
    pub row_s: f64,
    /// Fewer rows than this say nothing: three seconds of a slow log at 3 Hz.
    pub rows_min: usize,
    /// How well measured speeds of motors agree with those heard, against each other, as a share of the speed: telemetry of ESCs
    /// comes in steps of 10 to 100 electrical turns per minute, 0.1 to 0.3 %.
    pub speed_level_std_share: f64,
    /// Standard deviation of what the offset of a log of commands takes over from the motors' delay: they answer within 0.02 to 0.2 s.
    pub command_delay_std_s: f64,
    /// Power of the likelihood that is believed: no noise is as the models have it, and what they leave out looks like evidence. On
    /// simulated hovers in which next to nothing moves, the full likelihood is sure of wrong labels in 5 to 8 % of flights.
    pub evidence_share: f64,
    /// A rotor is labelled if the label has this probability.
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

impl LabelsConfig {
    /// Refuses settings that mean nothing, by name, value and limit.
    pub fn check(&self) -> Result<(), ConfigError> {
        let low_s = self.offset_s_low.unwrap_or(0.0);
        check_range("offset_s_low", low_s, -1e9, 1e9)?;
        check_range("offset_s_high", self.offset_s_high.unwrap_or(low_s), low_s, 1e9)?;
        check_range("offset_step_s", self.offset_step_s, 0.001, 1.0)?;
        check_range("overlap_share_min", self.overlap_share_min, 0.01, 1.0)?;
        check_range("row_s", self.row_s, 0.001, 1.0)?;
        check_range("speed_level_std_share", self.speed_level_std_share, 1e-6, 0.1)?;
        check_range("command_delay_std_s", self.command_delay_std_s, 0.0, 1.0)?;
        check_range("evidence_share", self.evidence_share, 0.01, 1.0)?;
        check_range("probability_min", self.probability_min, 0.5, 1.0)
    }
}
