//! Stage 2: survey → candidate shaft speeds that may explain its lines.

use super::left_out::{better_without_gear, heard_instead};
use super::propellers::{any_propellers, geared_propellers, with_any_blades};
use super::{Silence, Stop, Surveyed};
use crate::config::Config;
use crate::detection::{no_series, or_mains_hum};
use crate::error::Error;
use crate::evidence::{Beliefs, Companions, Hypothesis, RotorLines, WantedPropeller, WantedRotor};
use crate::tone::{CombMap, DiscoveryConfig, blades_of_tone, reading_at, search_range_rev_s};
use hovertone_analysis::{Hover, Meaning, OtherRotor, Reading, Span, Warning, WeighedSpeed};
use hovertone_vehicle::{AIR_KG_M3, KnownRotor, Order, RotorSpeed};
use std::ops::RangeInclusive;

/// A rotor that was heard before.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HeardRotor {
    pub(crate) speed_rev_s: f64,
    /// Whether only long frames hear it.
    pub(crate) is_faint: bool,
    /// What is heard of other rotors beside it; `None` where that is not known.
    pub(crate) companions: Option<Companions>,
}

/// Shaft speeds that may explain the lines of a survey.
pub(crate) struct Candidates {
    /// Score of each shaft speed in each row of the survey.
    pub(crate) map: CombMap,
    /// The speed that explains most of the survey.
    pub(crate) leading_rev_s: f64,
    /// The beliefs in its speeds; `None` where the speed was found before.
    beliefs: Option<Beliefs>,
    /// A rotor that something known leaves out, whose lines are far more probable.
    pub(crate) better: Option<OtherRotor>,
    /// What is heard of other rotors beside the leading one; `None` where that is not known.
    companions: Option<Companions>,
    /// Whether only long frames hear the rotor: then it must keep its phase.
    pub(crate) is_faint: bool,
}

impl Candidates {
    /// Only this speed, for which a rotor was heard.
    ///
    /// # Errors
    /// A tone above half the sample rate.
    pub(crate) fn of_heard_rotor(
        surveyed: &Surveyed,
        HeardRotor { speed_rev_s, is_faint, companions }: HeardRotor,
        sample_rate_hz: f64,
        config: &Config,
    ) -> Result<Self, Error> {
        let search_rev_s = search_range_rev_s(&config.tone, sample_rate_hz)?;
        Ok(Self {
            map: CombMap::from_survey(&surveyed.survey, &config.tone, &search_rev_s),
            leading_rev_s: speed_rev_s,
            beliefs: None,
            better: None,
            companions,
            is_faint,
        })
    }

    /// The middle of the speeds of all rotors in a hover, near the leading one: the evidence hears the loudest rotor, and the lines of all are
    /// followed.
    pub(crate) fn middle_rev_s(&self, surveyed: &Surveyed, hover: &Hover, config: &Config) -> f64 {
        let is_hover = |span: &Span| hover.segments.iter().any(|segment| segment.contains(span.middle_s()));
        let rows = surveyed.survey.rows.iter().enumerate().filter(|(_, row)| is_hover(&row.span)).map(|(row, _)| row);
        self.map.middle_near(rows, self.leading_rev_s, config.tone.band_half_width_share)
    }

    /// The speed around which the rotors are separated, near the leading one: the lines of a mesh stand apart, so that the loudest rotor is not in
    /// the middle of all.
    pub(crate) fn rotors_rev_s(&self, config: &Config) -> f64 {
        match blades_of_tone(&config.tone) {
            Some(_) => self.leading_rev_s,
            None => self.map.refined_rev_s(self.leading_rev_s),
        }
    }

    /// The speeds that remain possible, most probable first; empty where one is decided.
    pub(crate) fn alternatives(&self, config: &Config) -> Vec<Reading> {
        match self.beliefs.as_ref().map_or(&[][..], |beliefs| beliefs.possible(config.evidence.belief_min)) {
            [] | [_] => Vec::new(),
            possible => {
                let meaning =
                    blades_of_tone(&config.tone).map_or(Meaning::GivenOrder, |blades| Meaning::BladePass { blades });
                let reading = |hypothesis| reading_of(hypothesis, config.tone.order, meaning, &config.known);
                possible.iter().map(reading).collect()
            }
        }
    }

    /// Whether several rotors are heard, where their number is not known.
    pub(crate) fn are_several(&self, config: &Config) -> bool {
        !config.rotors.is_count_known && self.are_others_heard(config)
    }

    /// Whether there may be others, where their number is not known: they are likely, or nothing can be said of them.
    pub(crate) fn may_be_several(&self, config: &Config) -> bool {
        let are_likely = || self.companions.is_some_and(|companions| companions.are_likely());
        !config.rotors.is_count_known && (self.is_faint || are_likely())
    }

    fn are_others_heard(&self, config: &Config) -> bool {
        self.companions.is_some_and(|companions| companions.are_heard(&config.evidence))
    }

    /// Standard deviation of the speeds of the rotors for which one line stands, as a share: by what is heard beside it, and at least that of
    /// the settings.
    pub(crate) fn spread_share(&self, config: &Config) -> f64 {
        let heard = self.companions.map_or(0.0, |companions| companions.spread_share(config.rotors.is_count_known));
        heard.max(config.budget.rotor_spread_share)
    }

    /// What the lines say against what is known.
    pub(crate) fn warnings(&self, config: &Config) -> impl Iterator<Item = Warning> {
        let is_one = config.rotors.is_count_known && config.rotors.count == 1;
        let others = (is_one && self.are_others_heard(config)).then_some(Warning::OtherRotorsHeard { expected: 1 });
        self.better.map(Warning::FitsElsewhere).into_iter().chain(others)
    }

    /// The chosen speed and its runner-up.
    pub(crate) fn weighed(&self) -> Vec<WeighedSpeed> {
        let hypotheses = self.beliefs.iter().flat_map(|beliefs| beliefs.hypotheses.iter().take(2));
        let weighed = hypotheses.map(|hypothesis| WeighedSpeed {
            speed: RotorSpeed::from_rev_s(hypothesis.hover_rev_s),
            plausibility: hypothesis.belief,
        });
        weighed.collect()
    }
}

/// A hypothesis as a reading of a tone.
pub(crate) fn reading_of(hypothesis: &Hypothesis, order: Order, meaning: Meaning, known: &KnownRotor) -> Reading {
    Reading {
        thrust_coefficient: known.hover_thrust_coefficient(hypothesis.hover_rev_s, AIR_KG_M3),
        plausibility: hypothesis.belief,
        why: fit_in_words(hypothesis.belief).to_owned(),
        ..reading_at(RotorSpeed::from_rev_s(hypothesis.hover_rev_s), order, meaning)
    }
}

/// Why a speed is hardly possible.
pub(crate) const HARDLY_FITS: &str = "its lines hardly fit the sound";

/// How well the strengths of the lines fit a speed.
fn fit_in_words(belief: f64) -> &'static str {
    match belief {
        well if well >= 0.5 => "the lines of this speed fit the sound best",
        fair if fair >= 0.1 => "its lines fit the sound less well",
        _ => HARDLY_FITS,
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

/// Compares all shaft speeds in the range of the settings, and takes the most probable one.
///
/// # Errors
/// A tone above half the sample rate; "no rotor tone" where the survey is too short, silent, or holds no rotor.
pub(crate) fn candidates_from_survey(
    surveyed: &Surveyed,
    sample_rate_hz: f64,
    config: &Config,
) -> Result<Candidates, Stop> {
    let search_rev_s = search_range_rev_s(&config.tone, sample_rate_hz)?;
    surveyed.check(config)?;
    let where_unknown = any_propellers(sample_rate_hz);
    let wanted = wanted_rotor(search_rev_s.clone(), where_unknown, config);
    let beliefs = surveyed.beliefs(&wanted, config);
    let is_decided = |beliefs: &Beliefs| beliefs.possible(config.evidence.belief_min).len() == 1;
    let beliefs = match beliefs {
        Some(beliefs) if is_decided(&beliefs) => Some(beliefs),
        open => with_all_lines(surveyed, wanted, sample_rate_hz, config).filter(is_decided).or(open),
    };
    let Some((beliefs, leading_rev_s)) = beliefs.and_then(|beliefs| beliefs.hover_rev_s().map(|it| (beliefs, it)))
    else {
        let instead = heard_instead(surveyed, sample_rate_hz, config);
        return Err(Silence::because(or_mains_hum(no_series(&config.tone, instead), &surveyed.survey)).into());
    };
    Ok(Candidates {
        map: CombMap::from_survey(&surveyed.survey, &config.tone, &search_rev_s),
        leading_rev_s,
        is_faint: beliefs.is_faint,
        companions: beliefs.companions(&surveyed.looks, &config.evidence),
        better: beliefs.better.or_else(|| better_without_gear(surveyed, &beliefs, sample_rate_hz, config)),
        beliefs: Some(beliefs),
    })
}

/// The beliefs where lines that nobody named may tell the speed as well: the mesh of a gear, where the blades alone are said, and the blade pass,
/// where the gear alone is said. `None` where all lines are named, or no rotor is heard.
fn with_all_lines(
    surveyed: &Surveyed,
    mut wanted: WantedRotor,
    sample_rate_hz: f64,
    config: &Config,
) -> Option<Beliefs> {
    let named = wanted.propellers.first()?;
    let more = match named.lines {
        RotorLines { blades: Some(blades), mesh_order: None } => {
            geared_propellers(sample_rate_hz, &config.tone, Some(blades), DiscoveryConfig::default().gear_share)
        }
        RotorLines { blades: None, mesh_order: Some(_) } => with_any_blades(named),
        _ => return None,
    };
    wanted.propellers.extend(more);
    Some(surveyed.beliefs(&wanted, config)?.with_equal_speeds_joined())
}

/// The beliefs in the speeds of a rotor with the tone of the settings. `None` where no rotor is heard.
pub(crate) fn beliefs_of(surveyed: &Surveyed, speeds_rev_s: RangeInclusive<f64>, config: &Config) -> Option<Beliefs> {
    surveyed.beliefs(&wanted_rotor(speeds_rev_s, Vec::new(), config), config)
}

/// A rotor with the tone of the settings, compared with the propellers that are possible where nothing is known.
fn wanted_rotor(
    speeds_rev_s: RangeInclusive<f64>,
    where_unknown: Vec<WantedPropeller>,
    config: &Config,
) -> WantedRotor {
    let propeller = WantedPropeller { lines: RotorLines::of_tone(&config.tone), share: 1.0, speeds_rev_s };
    let may_be_slow =
        config.tone.is_named_by_band() || config.known.diameter_m.is_some() || config.known.shaft_speed.is_some();
    WantedRotor { propellers: vec![propeller], known: config.known, may_be_slow, where_unknown }
}
