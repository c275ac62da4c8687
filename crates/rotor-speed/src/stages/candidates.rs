//! Stage 2: survey → candidate shaft speeds that may explain its lines.

use super::{Silence, Stop, Surveyed};
use crate::config::Config;
use crate::detection::or_mains_hum;
use crate::error::Error;
use crate::evidence::{AIR_KG_M3, Beliefs, Hypothesis, WantedPropeller, WantedRotor};
use crate::tone::{CombMap, blades_of_tone, search_range_rev_s};
use hovertone_analysis::{Hover, Meaning, NoTone, Outcome, Reading, Span, SpeedAnalysis, WeighedSpeed};
use hovertone_vehicle::{KnownRotor, Order, RotorSpeed};
use std::ops::RangeInclusive;

/// Shaft speeds that may explain the lines of a survey.
pub(crate) struct Candidates {
    /// Score of each shaft speed in each row of the survey.
    pub(crate) map: CombMap,
    /// The speed that explains most of the survey.
    pub(crate) leading_rev_s: f64,
    /// The beliefs in the speeds of a blade pass; `None` where the tone is something else, or no rotor is heard.
    beliefs: Option<Beliefs>,
    /// Whether the evidence has heard a rotor: then it decides. Otherwise the thresholds do.
    pub(crate) is_heard: bool,
    /// Whether the tone was named, and not found among families of lines.
    pub(crate) is_named: bool,
    /// Whether several rotors are heard, where their number is not known.
    pub(crate) are_several: bool,
    /// Lowest speed of the search.
    rev_s_min: f64,
}

impl Candidates {
    /// Only this speed, for which a rotor was heard.
    ///
    /// # Errors
    /// A tone above half the sample rate.
    pub(crate) fn of_heard_rotor(
        surveyed: &Surveyed,
        speed_rev_s: f64,
        sample_rate_hz: f64,
        config: &Config,
    ) -> Result<Self, Error> {
        let search_rev_s = search_range_rev_s(&config.tone, sample_rate_hz)?;
        Ok(Self {
            map: CombMap::from_survey(&surveyed.survey, &config.tone, &search_rev_s),
            leading_rev_s: speed_rev_s,
            beliefs: None,
            is_heard: true,
            is_named: true,
            are_several: false,
            rev_s_min: *search_rev_s.start(),
        })
    }

    /// The same for a tone that was found, and that nobody has named.
    pub(crate) fn of_found_tone(self) -> Self {
        Self { is_named: false, ..self }
    }

    /// The speed of a slower shaft, where an analysis found that it explains a weak, steady tone better. `None` below the range of the search.
    pub(crate) fn slower_than(&self, analysis: &SpeedAnalysis) -> Option<f64> {
        match &analysis.outcome {
            Outcome::NoRotorTone { reason: NoTone::SlowerShaft { speed_rev_s, .. } } => {
                speed_rev_s.filter(|&speed_rev_s| speed_rev_s >= self.rev_s_min)
            }
            _ => None,
        }
    }

    /// The middle of the speeds of all rotors in a hover, near one of them: the evidence hears the loudest rotor, and the lines of all are followed.
    pub(crate) fn middle_rev_s(&self, surveyed: &Surveyed, hover: &Hover, speed_rev_s: f64, config: &Config) -> f64 {
        if !self.is_heard {
            return speed_rev_s;
        }
        let is_hover = |span: &Span| hover.segments.iter().any(|segment| segment.contains(span.middle_s()));
        let rows = surveyed.survey.rows.iter().enumerate().filter(|(_, row)| is_hover(&row.span)).map(|(row, _)| row);
        self.map.middle_near(rows, speed_rev_s, config.tone.band_half_width_share)
    }

    /// The speeds that remain possible, most probable first; empty where one is decided.
    pub(crate) fn alternatives(&self, config: &Config) -> Vec<Reading> {
        match self.beliefs.as_ref().map_or(&[][..], |beliefs| beliefs.possible(config.evidence.belief_min)) {
            [] | [_] => Vec::new(),
            possible => {
                possible.iter().map(|hypothesis| reading_of(hypothesis, config.tone.order, &config.known)).collect()
            }
        }
    }

    /// This speed and its runner-up: by the beliefs where they decide, else by the comb.
    pub(crate) fn weighed(&self, speed_rev_s: f64) -> Vec<WeighedSpeed> {
        match &self.beliefs {
            Some(beliefs) => beliefs
                .hypotheses
                .iter()
                .take(2)
                .map(|hypothesis| WeighedSpeed {
                    speed: RotorSpeed::from_rev_s(hypothesis.hover_rev_s),
                    plausibility: Some(hypothesis.belief),
                    lines_db: None,
                })
                .collect(),
            None => self
                .map
                .best_two(speed_rev_s)
                .into_iter()
                .map(|(speed_rev_s, lines_db)| WeighedSpeed {
                    speed: RotorSpeed::from_rev_s(speed_rev_s),
                    plausibility: None,
                    lines_db: Some(lines_db),
                })
                .collect(),
        }
    }
}

/// A hypothesis as a reading of the blade pass.
pub(crate) fn reading_of(hypothesis: &Hypothesis, order: Order, known: &KnownRotor) -> Reading {
    let speed = RotorSpeed::from_rev_s(hypothesis.hover_rev_s);
    Reading {
        order,
        tone_hz: speed.tone_hz(order),
        meaning: Meaning::BladePass { blades: hypothesis.blades },
        speed,
        motor_speed: speed,
        tip_mach: None,
        thrust_coefficient: known.hover_thrust_coefficient(hypothesis.hover_rev_s, AIR_KG_M3),
        plausibility: hypothesis.belief,
        why: fit_in_words(hypothesis.belief).to_owned(),
    }
}

/// How well the levels of the harmonics fit a speed.
fn fit_in_words(belief: f64) -> &'static str {
    match belief {
        well if well >= 0.5 => "the levels of the harmonics fit well",
        fair if fair >= 0.1 => "the levels of the harmonics fit",
        _ => "the levels of the harmonics fit badly",
    }
}

/// A reading whose speed is multiplied by this ratio.
pub(crate) fn at_ratio(reading: &Reading, ratio: f64) -> Reading {
    let scaled = |speed: RotorSpeed| RotorSpeed::from_rad_s(ratio * speed.rad_s());
    Reading {
        tone_hz: ratio * reading.tone_hz,
        speed: scaled(reading.speed),
        motor_speed: scaled(reading.motor_speed),
        tip_mach: reading.tip_mach.map(|mach| ratio * mach),
        thrust_coefficient: reading.thrust_coefficient.map(|coefficient| coefficient / ratio.powi(2)),
        ..reading.clone()
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
    let map = CombMap::from_survey(&surveyed.survey, &config.tone, &search_rev_s);
    let beliefs = beliefs_of(surveyed, search_rev_s.clone(), config).map_err(Silence::because)?;
    let believed_rev_s = beliefs.as_ref().and_then(Beliefs::hover_rev_s);
    let leading_rev_s = believed_rev_s.or_else(|| map.leading_speed_rev_s());
    match leading_rev_s {
        Some(leading_rev_s) => Ok(Candidates {
            map,
            leading_rev_s,
            is_heard: beliefs.as_ref().is_some_and(Beliefs::is_resolved),
            is_named: true,
            are_several: !config.rotors.is_count_known && are_several(surveyed, beliefs.as_ref(), config),
            beliefs,
            rev_s_min: *search_rev_s.start(),
        }),
        None => Err(Silence::because(or_mains_hum(NoTone::NoSeries, &surveyed.survey)).into()),
    }
}

/// Whether other rotors are heard beside the most probable one.
fn are_several(surveyed: &Surveyed, beliefs: Option<&Beliefs>, config: &Config) -> bool {
    let heard = beliefs.zip(surveyed.excess.as_ref());
    heard.is_some_and(|(beliefs, looks)| beliefs.are_several(looks, &config.evidence))
}

/// The beliefs in the speeds of a blade pass. `None` where the tone is something else, or no rotor is heard.
///
/// # Errors
/// Mains hum.
pub(crate) fn beliefs_of(
    surveyed: &Surveyed,
    speeds_rev_s: RangeInclusive<f64>,
    config: &Config,
) -> Result<Option<Beliefs>, NoTone> {
    let Some(blades) = blades_of_tone(&config.tone) else { return Ok(None) };
    let propeller = WantedPropeller { blades, share: 1.0, speeds_rev_s };
    surveyed.beliefs(&WantedRotor { propellers: vec![propeller], known: config.known }, config)
}
