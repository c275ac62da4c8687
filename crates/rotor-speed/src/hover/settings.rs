//! Settings: how hovering is separated from the rest of a recording.

use crate::survey::SurveySettings;
use hovertone_vehicle::{ConfigError, check_range};
use serde::{Deserialize, Serialize};

/// How hovering is separated from silence, handling noise, take-off and landing.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct HoverConfig {
    /// Length of a frame of the survey, s. 0.2 s resolves 5 Hz, which separates lines, and is short enough for their varying frequency.
    pub survey_window_s: f64,
    /// Length of a row of the survey, s: the time resolution of cuts.
    pub survey_row_s: f64,
    /// Largest number of rows. A longer recording gets longer rows, so that memory does not grow with its length.
    pub survey_rows_max: usize,
    /// Length of a frame of the low frequencies, s. 1 s resolves 1 Hz, which separates mains hum from a rotor whose speed varies by 0.1 % or
    /// more, and the lines of a helicopter, 10 Hz apart or more, from each other.
    pub fine_window_s: f64,
    /// Highest of the low frequencies, Hz. Recordings hold mains hum up to its 50th multiple, which must not count as a gear mesh.
    pub fine_hz_max: f64,
    /// Level below the median level of the hover at which a row is no hover, dB.
    pub quieter_db: f64,
    /// Level above the median level of the hover at which a row is handling noise, dB.
    pub louder_db: f64,
    /// Smallest comb score of a row of the hover, as a share of the typical score.
    pub comb_share_min: f64,
    /// Difference of a row's speed from the median around it that is a manoeuvre, in standard deviations of the wander of the hover. Normal
    /// wander reaches 4 in one row of 16 000.
    pub manoeuvre_wanders: f64,
    /// Smallest difference that is a manoeuvre, as a share of the speed, in a hover of any steadiness. 0.025 is twice the spread of the
    /// hovers of the paper.
    pub manoeuvre_share_min: f64,
    /// Reach of the median around a row to either side, s: long against a doublet, short against the discharge of a battery.
    pub manoeuvre_reach_s: f64,
    /// Shortest time, s, for which a rotor must hold its speed where other tones sound for longer in total: music does not. The shortest
    /// hover between manoeuvres that gives a sample of the paper is longer.
    pub held_s_min: f64,
    /// Shortest hover that is used, s: a shorter one has too few frames to separate a tone from noise.
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
    /// The settings of the survey.
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

/// The part of a hover that is analysed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum HoverPart {
    /// The whole hover.
    #[default]
    Whole,
    /// The second half of the first seconds of hover: the rotors turn there, even where the recording begins before they start.
    LaterHalf {
        /// Length of the first seconds, s.
        of_s_max: f64,
    },
    /// The hover after a time: before, the rotors run up.
    After {
        /// Time on the recording's clock, s.
        time_s: f64,
    },
}
