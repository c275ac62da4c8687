//! What real rotors sound like: one table, for the estimator, which weighs levels by it, and for the simulator, which draws levels from it.

use serde::{Deserialize, Serialize};

/// Distribution of the powers of the lines of a rotor, in dB over the mean floor of the recording in frames of 0.1 s, measured on real recordings
/// (`docs/measurements.md`). All distributions are normal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct LineLevels {
    /// Mean level of the first line of the blade pass.
    pub blade_pass_db: f64,
    /// Its standard deviation over recordings.
    pub blade_pass_std_db: f64,
    /// Standard deviation of the loudness of the rotors of one vehicle at one microphone.
    pub rotors_std_db: f64,
    /// Fall of the levels for a tenfold order, in units of 10 dB.
    pub fall: f64,
    /// Its standard deviation over recordings.
    pub fall_std: f64,
    /// Share of recordings whose lines are smeared: their speed changes within a frame, or several rotors turn.
    pub smeared: f64,
    /// Standard deviation of the level of one line of the blade pass about its mean.
    pub line_std_db: f64,
    /// Mean level of the shaft lines of unlike blades, against the blade pass.
    pub shaft_db: f64,
    /// Its standard deviation over recordings.
    pub shaft_std_db: f64,
    /// Mean level of the shaft lines of alike blades, against the blade pass: most of them are below the noise.
    pub faint_shaft_db: f64,
    /// Its standard deviation over recordings.
    pub faint_shaft_std_db: f64,
    /// Share of recordings with alike blades.
    pub faint_shaft: f64,
    /// Standard deviation of the level of one shaft line about its mean.
    pub shaft_line_std_db: f64,
    /// Mean level of shaft lines below the blade pass, against the blade pass.
    pub below_db: f64,
    /// Its standard deviation over recordings and lines.
    pub below_std_db: f64,
    /// Share of lines below the blade pass that are missing.
    pub below_missing: f64,
    /// Share of recordings whose shaft lines are inaudible at any noise.
    pub shaft_inaudible: f64,
    /// Share of lines of the blade pass that are missing.
    pub blade_pass_missing: f64,
    /// Share of lines of the blade pass that are in a notch: a reflection takes most of them away.
    pub notched: f64,
    /// Mean level of a line in a notch, against its level without.
    pub notch_db: f64,
    /// Its standard deviation.
    pub notch_std_db: f64,
    /// Share of shaft lines that are missing, where the others are audible.
    pub shaft_missing: f64,
    /// Share of places without a line of this rotor that hold a line of something else.
    pub foreign: f64,
    /// Places that this share is worth beside those of one recording.
    pub foreign_places: f64,
    /// Share of recordings in which an echo weakens every other line of the blade pass.
    pub echo: f64,
    /// Shaft speed below which multirotors get rare, rev/s.
    pub slow_rev_s: f64,
    /// Standard deviation of the logarithm of slower speeds.
    pub slow_std: f64,
    /// Mean thrust coefficient C_T = F/(ρ n² D⁴) of hovering propellers.
    pub thrust_coefficient: f64,
    /// Standard deviation of its logarithm.
    pub thrust_coefficient_std: f64,
    /// Standard deviation of the logarithm of speeds outside the range of a known vehicle.
    pub range_std: f64,
}

impl LineLevels {
    /// Scatter of the lines of a recording over that of most, and the share of the recordings that have it. *Decision.*
    pub const SCATTERS: [(f64, f64); 3] = [(1.0, 0.65), (1.6, 0.25), (2.4, 0.1)];
}

impl Default for LineLevels {
    fn default() -> Self {
        Self {
            blade_pass_db: 25.0,
            blade_pass_std_db: 25.0,
            rotors_std_db: 12.0,
            fall: 1.5,
            fall_std: 1.0,
            smeared: 0.3,
            line_std_db: 3.0,
            shaft_db: -9.0,
            shaft_std_db: 5.5,
            faint_shaft_db: -18.0,
            faint_shaft_std_db: 7.0,
            faint_shaft: 0.45,
            shaft_line_std_db: 5.5,
            below_db: -18.0,
            below_std_db: 6.0,
            below_missing: 0.2,
            shaft_inaudible: 0.15,
            blade_pass_missing: 0.05,
            notched: 0.1,
            notch_db: -10.0,
            notch_std_db: 5.0,
            shaft_missing: 0.15,
            foreign: 0.05,
            foreign_places: 60.0,
            echo: 0.03,
            slow_rev_s: 30.0,
            slow_std: 0.3,
            thrust_coefficient: 0.11,
            thrust_coefficient_std: 0.35,
            range_std: 0.1,
        }
    }
}
