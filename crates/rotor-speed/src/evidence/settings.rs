//! Settings of the evidence: when an answer is sure, with the table of levels of real rotors.

use hovertone_vehicle::{ConfigError, LineLevels, check_range};
use serde::{Deserialize, Serialize};

/// When a rotor counts as heard, and its octave as decided.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct EvidenceConfig {
    /// Smallest median over frames of the votes for the path of a rotor, in nats. The path is the best of many, so that machines reach 1.1 nats.
    pub votes_nats_min: f64,
    /// Smallest evidence of the levels for a rotor in each look, against levels of nothing, in nats: odds of 99 to 1.
    pub levels_nats_min: f64,
    /// Smallest evidence of both looks for a separated rotor by its own lines, in nats: odds of 20 to 1. Rotors that turn had 4.5 and more, others
    /// up to 2.9.
    pub own_lines_nats_min: f64,
    /// Smallest evidence for another rotor of the vehicle, in nats: its path is the best of many, and the tail rotor of a helicopter beside its
    /// main rotor had 16.
    pub companion_nats_min: f64,
    /// Most votes that a voice or an instrument, which jumps, may have more than the rotor, in nats a frame. Flights have up to 6, tunes and
    /// speech 8 to 80.
    pub jumps_nats_max: f64,
    /// Smallest belief with which an octave counts as decided: odds of 99 to 1.
    pub belief_min: f64,
    /// Levels of the lines of real rotors.
    pub levels: LineLevels,
}

impl Default for EvidenceConfig {
    fn default() -> Self {
        Self {
            votes_nats_min: 1.4,
            levels_nats_min: 4.6,
            own_lines_nats_min: 3.0,
            companion_nats_min: 18.4,
            jumps_nats_max: 7.8,
            belief_min: 0.99,
            levels: LineLevels::default(),
        }
    }
}

impl EvidenceConfig {
    pub(crate) fn check(&self) -> Result<(), ConfigError> {
        check_range("votes_nats_min", self.votes_nats_min, 0.0, 100.0)?;
        check_range("levels_nats_min", self.levels_nats_min, 0.0, 100.0)?;
        check_range("own_lines_nats_min", self.own_lines_nats_min, 0.0, 100.0)?;
        check_range("companion_nats_min", self.companion_nats_min, 0.0, 1000.0)?;
        check_range("jumps_nats_max", self.jumps_nats_max, 0.0, 100.0)?;
        check_range("belief_min", self.belief_min, 0.5, 1.0)
    }
}
