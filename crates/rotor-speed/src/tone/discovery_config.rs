//! Settings of the discovery of tones: every default with its unit and its reason.

use hovertone_vehicle::{ConfigError, check_range};
use serde::Serialize;

/// How tone families are found, and what is known of multirotors in general.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct DiscoveryConfig {
    /// Lowest fundamental that is scanned for: the blade pass of the largest multirotors, two blades at 15 rev/s.
    pub fundamental_hz_min: f64,
    /// Highest: above the blade pass of the smallest racers (four blades at 670 rev/s) and common beeps of controllers.
    pub fundamental_hz_max: f64,
    /// Rows of the survey that are scanned at most, evenly chosen: a long recording costs no more than half a minute.
    pub scan_rows_max: usize,
    /// Families that are listed at most.
    pub families_max: usize,
    /// A family must show a line this far over the floor to be listed. Rotors far off that part from each other show 6 dB.
    pub listed_db_min: f64,
    /// Frame of the finer spectrum in which the frequency of a family is measured: resolves 2 Hz.
    pub detail_window_s: f64,
    /// A line is heard when it stands this far over the places between lines, in the mean over its rows. The mean of a
    /// second of noise stays below 3 dB in 99 % of all places.
    pub line_over_floor_db: f64,
    /// The mean level of the eight first lines, less that of the places between, that makes a row of the survey one in
    /// which a family is present. Noise reaches 2 dB.
    pub row_score_db_min: f64,
    /// A reading below this is no longer shown as plausible.
    pub plausible_min: f64,
    /// How common propellers of 2, 3, 4, 5 and 6 blades are on multirotors, for where the sound does not tell: of 14 vehicles (those of the
    /// presets and of public recordings whose blades are known) ten have two and four have three; one is added to each number.
    /// Never enough to settle anything.
    pub blade_shares: [f64; 5],
    /// Share of vehicles whose propellers turn behind a known gear.
    pub gear_share: f64,
    /// Share of recordings whose levels deceive about the blades and the octave, where neither blades nor diameter are known: 4 of the 37 real
    /// ones.
    pub deceived_share: f64,
}

impl Default for DiscoveryConfig {
    fn default() -> Self {
        Self {
            fundamental_hz_min: 30.0,
            fundamental_hz_max: 3200.0,
            scan_rows_max: 64,
            families_max: 6,
            listed_db_min: 5.0,
            detail_window_s: 0.5,
            line_over_floor_db: 4.0,
            row_score_db_min: 3.0,
            plausible_min: 0.002,
            blade_shares: [0.58, 0.26, 0.05, 0.05, 0.05],
            gear_share: 0.03,
            deceived_share: 0.1,
        }
    }
}

impl DiscoveryConfig {
    /// Refuses settings that mean nothing, by name, value and limit.
    pub(crate) fn check(&self) -> Result<(), ConfigError> {
        check_range("fundamental_hz_min", self.fundamental_hz_min, 20.0, 1e4)?;
        check_range("fundamental_hz_max", self.fundamental_hz_max, 2.0 * self.fundamental_hz_min, 1e5)?;
        check_range("scan_rows_max", self.scan_rows_max as f64, 4.0, 4096.0)?;
        check_range("families_max", self.families_max as f64, 1.0, 50.0)?;
        check_range("detail_window_s", self.detail_window_s, 0.1, 1.0)?;
        check_range("plausible_min", self.plausible_min, 0.0, 0.5)?;
        check_range("gear_share", self.gear_share, 0.0, 1.0)?;
        check_range("deceived_share", self.deceived_share, 0.0, 0.5)
    }
}
