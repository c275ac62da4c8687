//! Settings of the discovery of tones: every default with its unit and its reason.

use hovertone_vehicle::{ConfigError, THRUST_COEFFICIENT, TIP_MACH_MAX, check_range};
use serde::Serialize;

/// How tone families are found, and when their meaning counts as settled.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct DiscoveryConfig {
    /// Lowest fundamental that is scanned for: the blade pass of the largest multirotors, two blades at 15 rev/s.
    pub fundamental_hz_min: f64,
    /// Highest: above the blade pass of the smallest racers (four blades at 670 rev/s) and common beeps of controllers.
    pub fundamental_hz_max: f64,
    /// Rows of the survey that are scanned at most, evenly chosen: a long recording costs no more than half a minute.
    pub scan_rows_max: usize,
    /// Families that are listed at most; a search for the rotor alone ends at the first that can be one.
    pub families_max: usize,
    /// A family must show a line this far over the floor to be listed. Rotors far off that part from each other show 6 dB.
    pub listed_db_min: f64,
    /// Frame of the finer spectrum in which shaft lines of slow rotors are told apart: resolves 2 Hz.
    pub detail_window_s: f64,
    /// Families below this are read in the finer spectrum: there the survey's 5 Hz blur lines at sixths of the blade pass;
    /// above, the wander of a rotor within a long frame blurs them more.
    pub detail_below_hz: f64,
    /// A line is heard when it stands this far over the places between lines, in the mean over its rows. The mean of a
    /// second of noise stays below 3 dB in 99 % of all places.
    pub line_over_floor_db: f64,
    /// The mean level of the eight first lines, less that of the places between, that makes a row of the survey one in
    /// which a family is present. Noise reaches 2 dB.
    pub row_score_db_min: f64,
    /// Lines between the harmonics are those of a slower shaft when at least this share of their places holds one.
    pub between_share_min: f64,
    /// Every b-th line of a series stands over the lines between by this where blade pass and octave are equally likely.
    /// Series of blade passes recorded so far show at most 2 dB from line to line alternately, shaft lines are 10 to
    /// 25 dB below the blade pass.
    pub contrast_even_db: f64,
    /// How fast that likelihood turns: 0.95 is reached 3 of these above, where 4 dB of scatter from line to line lead one
    /// series in a thousand.
    pub contrast_scale_db: f64,
    /// Lines of the blade pass that must show the contrast; fewer leave it open. An echo that swallows odd harmonics does so
    /// four times in a row only within 6 % of one delay.
    pub contrast_lines_min: usize,
    /// For two blades the strongest line must stand this far over the floor, so that lines at half orders would be seen:
    /// shaft lines are seldom more than 30 dB below the blade pass.
    pub range_db_min: f64,
    /// A reading counts as settled when all others together have less than the rest of this.
    pub settled_plausibility_min: f64,
    /// A reading below this is no longer shown as plausible.
    pub plausible_min: f64,
    /// How common propellers of 2, 3, 4, 5 and 6 blades are on multirotors, for where the sound does not tell: of 14 vehicles (those of the
    /// presets and of public recordings whose blades are known) ten have two and four have three; one is added to each number.
    /// Never enough to settle anything.
    pub blade_shares: [f64; 5],
    /// Fastest tip as a share of the speed of sound: propellers of multirotors stay below 0.6.
    pub tip_mach_max: f64,
    /// Smallest thrust coefficient T/(ρ n² D⁴) of a hovering propeller.
    pub thrust_coefficient_min: f64,
    /// Largest. Measured propellers have 0.06 to 0.15.
    pub thrust_coefficient_max: f64,
    /// Density of the air for that, kg/m³.
    pub air_density_kg_m3: f64,
    /// Speed of sound for the tip, m/s.
    pub sound_speed_m_s: f64,
    /// Share of frames in which a second harmonic must be a line. More than where the order is given, because here it was
    /// not said that there is a rotor: found hovers give 0.37 or more, a machine's hum 0.24.
    pub company_share_min: f64,
    /// Lines of a gear mesh stand this far over the places beside them, in the mean over rows and harmonics …
    pub mesh_over_db: f64,
    /// … and this many times further than those places scatter.
    pub mesh_over_stds: f64,
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
            detail_below_hz: 250.0,
            line_over_floor_db: 4.0,
            row_score_db_min: 3.0,
            between_share_min: 0.55,
            contrast_even_db: 6.5,
            contrast_scale_db: 1.2,
            contrast_lines_min: 4,
            range_db_min: 30.0,
            settled_plausibility_min: 0.95,
            plausible_min: 0.01,
            blade_shares: [0.58, 0.26, 0.05, 0.05, 0.05],
            tip_mach_max: TIP_MACH_MAX,
            thrust_coefficient_min: *THRUST_COEFFICIENT.start(),
            thrust_coefficient_max: *THRUST_COEFFICIENT.end(),
            air_density_kg_m3: 1.2,
            sound_speed_m_s: 343.0,
            company_share_min: 0.3,
            mesh_over_db: 2.0,
            mesh_over_stds: 4.0,
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
        check_range("detail_below_hz", self.detail_below_hz, 0.0, 1e5)?;
        check_range("settled_plausibility_min", self.settled_plausibility_min, 0.5, 1.0)?;
        check_range("plausible_min", self.plausible_min, 0.0, 0.5)
    }
}
