//! Stage 2: survey → candidate shaft speeds that may explain its lines.

use super::{Silence, Stop, Surveyed};
use crate::config::Config;
use crate::detection::or_mains_hum;
use crate::tone::{CombMap, search_range_rev_s};
use hovertone_analysis::{NoTone, Outcome, SpeedAnalysis};

/// Shaft speeds that may explain the lines of a survey.
pub(crate) struct Candidates {
    /// Score of each shaft speed in each row of the survey.
    pub(crate) map: CombMap,
    /// The speed that explains most of the survey.
    pub(crate) leading_rev_s: f64,
    /// Lowest speed of the search.
    rev_s_min: f64,
}

impl Candidates {
    /// The speed of a slower shaft, where an analysis found that it explains a weak, steady tone better. `None` below the range of the search.
    pub(crate) fn slower_than(&self, analysis: &SpeedAnalysis) -> Option<f64> {
        match &analysis.outcome {
            Outcome::NoRotorTone { reason: NoTone::SlowerShaft { speed_rev_s, .. } } => {
                speed_rev_s.filter(|&speed_rev_s| speed_rev_s >= self.rev_s_min)
            }
            _ => None,
        }
    }
}

/// Scores all shaft speeds in the range of the settings, and takes the best.
///
/// # Errors
/// A tone above half the sample rate; "no rotor tone" where the survey is too short, silent, or holds no series of lines.
pub(crate) fn candidates_from_survey(
    surveyed: &Surveyed,
    sample_rate_hz: f64,
    config: &Config,
) -> Result<Candidates, Stop> {
    let search_rev_s = search_range_rev_s(&config.tone, sample_rate_hz)?;
    surveyed.check(config)?;
    let map = CombMap::from_survey(&surveyed.survey, &config.tone, search_rev_s);
    match map.leading_speed_rev_s() {
        Some(leading_rev_s) => Ok(Candidates { map, leading_rev_s, rev_s_min: search_rev_s.0 }),
        None => Err(Silence::because(or_mains_hum(NoTone::NoSeries, &surveyed.survey)).into()),
    }
}
