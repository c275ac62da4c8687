//! How hovering is told from the rest.

use crate::survey::SurveySettings;
use hovertone_vehicle::{ConfigError, check_range};
use serde::{Deserialize, Serialize};

/// How hovering is told from silence, handling noise, take-off and landing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct HoverConfig {
    /// Frame of the survey: resolves 5 Hz, enough to find lines, short enough for their wander.
    pub survey_window_s: f64,
    /// Time step of the survey: cuts are made to this.
    pub survey_row_s: f64,
    /// Rows kept at most; a longer recording gets longer rows, so that memory does not grow with its length.
    pub survey_rows_max: usize,
    /// Frame of the survey's low frequencies: resolves 1 Hz, so that mains hum is told from a rotor that wanders by 0.1 % and
    /// more, and a helicopter's lines, 10 Hz and more apart, from each other.
    pub fine_window_s: f64,
    /// Highest frequency of those: mains hum has been heard to its fiftieth multiple, and that must not pass for a gear mesh.
    pub fine_hz_max: f64,
    /// Rows this much quieter than the typical row of the hover are not hover.
    pub quieter_db: f64,
    /// Rows this much louder are handling noise.
    pub louder_db: f64,
    /// A row's comb must reach this share of the hover's typical comb to count as hover.
    pub comb_share_min: f64,
    /// Rows whose speed differs from the hover's around them by so many of the hover's own wanders (standard deviations) are a
    /// manoeuvre. Wander alone reaches it in one row of 16 000.
    pub manoeuvre_wanders: f64,
    /// A difference below this share is no manoeuvre, however steady the hover: twice the spread of the paper's hovers.
    pub manoeuvre_share_min: f64,
    /// The hover around a row reaches this far: long against a doublet, short against a battery.
    pub manoeuvre_reach_s: f64,
    /// A tone that is never held for so long, while others sound for longer than it, is no rotor's: music does that. The
    /// shortest hover between manoeuvres that is worth a sample of the paper's is longer.
    pub held_s_min: f64,
    /// Shorter hovers are not used: they hold too few frames to tell a tone from noise.
    pub length_s_min: f64,
}

impl Default for HoverConfig {
    fn default() -> Self {
        Self {
            survey_window_s: 0.2,
            survey_row_s: 0.5,
            survey_rows_max: 256,
            fine_window_s: 1.0,
            fine_hz_max: 3000.0,
            quieter_db: 12.0,
            louder_db: 12.0,
            comb_share_min: 0.35,
            manoeuvre_wanders: 4.0,
            manoeuvre_share_min: 0.025,
            manoeuvre_reach_s: 15.0,
            held_s_min: 3.0,
            length_s_min: 1.0,
        }
    }
}

impl HoverConfig {
    /// The settings of the survey among them.
    pub(crate) fn survey(&self) -> SurveySettings {
        SurveySettings {
            window_s: self.survey_window_s,
            row_s: self.survey_row_s,
            rows_max: self.survey_rows_max,
            fine_window_s: self.fine_window_s,
            fine_hz_max: self.fine_hz_max,
        }
    }

    pub(crate) fn check(&self) -> Result<(), ConfigError> {
        check_range("survey_window_s", self.survey_window_s, 0.02, 1.0)?;
        check_range("survey_row_s", self.survey_row_s, self.survey_window_s, 60.0)?;
        check_range("survey_rows_max", self.survey_rows_max as f64, 8.0, 4096.0)?;
        check_range("fine_window_s", self.fine_window_s, 0.2, 10.0)?;
        check_range("fine_hz_max", self.fine_hz_max, 200.0, 20_000.0)?;
        check_range("quieter_db", self.quieter_db, 1.0, 100.0)?;
        check_range("louder_db", self.louder_db, 1.0, 100.0)?;
        check_range("comb_share_min", self.comb_share_min, 0.0, 1.0)?;
        check_range("manoeuvre_wanders", self.manoeuvre_wanders, 1.0, 1e6)?;
        check_range("manoeuvre_share_min", self.manoeuvre_share_min, 0.001, 1.0)?;
        check_range("manoeuvre_reach_s", self.manoeuvre_reach_s, 1.0, 1e4)?;
        check_range("held_s_min", self.held_s_min, 0.0, 60.0)?;
        check_range("length_s_min", self.length_s_min, 0.1, 1e4)
    }
}

/// The part of the hover that is analysed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum HoverPart {
    /// All of it.
    #[default]
    Whole,
    /// The later half of its first seconds: the rotors turn by then, even if the recording begins before they start.
    LaterHalf {
        /// Length of the first seconds.
        of_s_max: f64,
    },
    /// All after a time: before it the rotors run up.
    After {
        /// The time on the recording's clock.
        time_s: f64,
    },
}
