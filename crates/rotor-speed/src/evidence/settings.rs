//! Settings of the evidence: what real rotors sound like, and when an answer is sure.

use hovertone_vehicle::{ConfigError, check_range};
use serde::{Deserialize, Serialize};

/// When a rotor counts as heard, and its octave as decided.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct EvidenceConfig {
    /// Smallest median over frames of the votes for the path of a rotor, in nats.
    pub votes_nats_min: f64,
    /// Smallest belief with which an octave counts as decided: odds of 99 to 1.
    pub belief_min: f64,
    /// Levels of the lines of real rotors.
    pub levels: LevelPrior,
}

impl Default for EvidenceConfig {
    fn default() -> Self {
        Self { votes_nats_min: 1.0, belief_min: 0.99, levels: LevelPrior::default() }
    }
}

impl EvidenceConfig {
    pub(crate) fn check(&self) -> Result<(), ConfigError> {
        check_range("votes_nats_min", self.votes_nats_min, 0.0, 100.0)?;
        check_range("belief_min", self.belief_min, 0.5, 1.0)
    }
}

/// Distribution of the levels of the lines of a rotor, in dB over the local floor in frames of 0.1 s, measured on real recordings
/// (`docs/measurements.md`). All distributions are normal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LevelPrior {
    /// Mean level of the first line of the blade pass.
    pub blade_pass_db: f64,
    /// Its standard deviation over recordings.
    pub blade_pass_std_db: f64,
    /// Fall of the levels for a tenfold order, in units of 10 dB.
    pub fall: f64,
    /// Its standard deviation over recordings.
    pub fall_std: f64,
    /// Standard deviation of the level of one line of the blade pass about its mean.
    pub line_std_db: f64,
    /// Mean level of shaft lines, where they are audible, against the blade pass.
    pub shaft_db: f64,
    /// Its standard deviation over recordings.
    pub shaft_std_db: f64,
    /// Standard deviation of the level of one shaft line about its mean.
    pub shaft_line_std_db: f64,
    /// Share of recordings in which shaft lines are inaudible.
    pub shaft_inaudible: f64,
    /// Share of lines of the blade pass that are missing.
    pub blade_pass_missing: f64,
    /// Share of shaft lines that are missing, where the others are audible.
    pub shaft_missing: f64,
    /// Share of places without a line of this rotor that hold a line of something else.
    pub foreign: f64,
    /// Shaft speed below which multirotors get rare, rev/s.
    pub slow_rev_s: f64,
    /// Standard deviation of the logarithm of slower speeds.
    pub slow_std: f64,
    /// Mean thrust coefficient C_T = T/(ρ n² D⁴) of hovering propellers.
    pub thrust_coefficient: f64,
    /// Standard deviation of its logarithm.
    pub thrust_coefficient_std: f64,
    /// Standard deviation of the logarithm of speeds outside the range of a known vehicle.
    pub range_std: f64,
}

impl Default for LevelPrior {
    fn default() -> Self {
        Self {
            blade_pass_db: 13.0,
            blade_pass_std_db: 10.0,
            fall: 1.3,
            fall_std: 1.0,
            line_std_db: 4.0,
            shaft_db: -6.5,
            shaft_std_db: 5.0,
            shaft_line_std_db: 5.5,
            shaft_inaudible: 0.5,
            blade_pass_missing: 0.05,
            shaft_missing: 0.15,
            foreign: 0.1,
            slow_rev_s: 30.0,
            slow_std: 0.3,
            thrust_coefficient: 0.1,
            thrust_coefficient_std: 0.4,
            range_std: 0.1,
        }
    }
}
