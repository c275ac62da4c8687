//! Stage 2: survey → candidate shaft speeds that may explain its lines.

use super::{Silence, Stop, Surveyed};
use crate::config::Config;
use crate::detection::or_mains_hum;
use crate::evidence::{AIR_KG_M3, Beliefs, Hypothesis, WantedRotor, beliefs_from_excess};
use crate::tone::{CombMap, blades_of_tone, search_range_rev_s};
use hovertone_analysis::{Meaning, NoTone, Outcome, Reading, SpeedAnalysis};
use hovertone_vehicle::RotorSpeed;
use std::ops::RangeInclusive;

/// Shaft speeds that may explain the lines of a survey.
pub(crate) struct Candidates {
    /// Score of each shaft speed in each row of the survey.
    pub(crate) map: CombMap,
    /// The speed that explains most of the survey.
    pub(crate) leading_rev_s: f64,
    /// The beliefs in the octaves of the leading speed, where the blade pass was heard.
    pub(crate) beliefs: Option<Beliefs>,
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

    /// The speeds that remain possible, most probable first; empty where one is decided.
    pub(crate) fn alternatives(&self, config: &Config) -> Vec<Reading> {
        let hypotheses = self.beliefs.as_ref().map_or(&[][..], |beliefs| &beliefs.hypotheses);
        if hypotheses.first().is_none_or(|first| first.belief >= config.evidence.belief_min) {
            return Vec::new();
        }
        let possible = hypotheses.iter().filter(|hypothesis| hypothesis.belief >= 1.0 - config.evidence.belief_min);
        possible.map(|hypothesis| reading_of(hypothesis, config)).collect()
    }
}

/// A hypothesis as a reading of the blade pass.
fn reading_of(hypothesis: &Hypothesis, config: &Config) -> Reading {
    let speed = RotorSpeed::from_rev_s(hypothesis.speed_rev_s);
    let order = config.tone.order;
    Reading {
        order,
        tone_hz: speed.tone_hz(order),
        meaning: Meaning::BladePass { blades: blades_of_tone(&config.tone).unwrap_or(1) },
        speed,
        motor_speed: speed,
        tip_mach: None,
        thrust_coefficient: config.known.hover_thrust_coefficient(hypothesis.speed_rev_s, AIR_KG_M3),
        plausibility: hypothesis.belief,
        why: format!("{:.1} nats by the levels of its lines", hypothesis.nats),
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
    let beliefs = beliefs_of(surveyed, search_rev_s.0..=search_rev_s.1, config);
    let believed_rev_s = beliefs.as_ref().and_then(Beliefs::most_probable_rev_s);
    match believed_rev_s.or_else(|| map.leading_speed_rev_s()) {
        Some(leading_rev_s) => Ok(Candidates { map, leading_rev_s, beliefs, rev_s_min: search_rev_s.0 }),
        None => Err(Silence::because(or_mains_hum(NoTone::NoSeries, &surveyed.survey)).into()),
    }
}

/// The beliefs in the octaves of a blade pass. `None` where they are not asked for ([`Config::blades_with_thrust`]), or no rotor is heard.
fn beliefs_of(surveyed: &Surveyed, speeds_rev_s: RangeInclusive<f64>, config: &Config) -> Option<Beliefs> {
    let wanted = WantedRotor { blades: config.blades_with_thrust()?, speeds_rev_s, known: config.known };
    let beliefs = beliefs_from_excess(surveyed.excess.as_ref()?, &wanted, &config.evidence)?;
    (beliefs.votes_nats >= config.evidence.votes_nats_min).then_some(beliefs)
}
