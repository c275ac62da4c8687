//! The whole chain on one screen: survey → candidates → hover → lines → decision → speeds. No arithmetic here.

use crate::config::Config;
use crate::error::Error;
use crate::stages::{
    Candidates, HeardRotor, Stop, Surveyed, are_far_apart, candidates_from_survey, decision_from_lines,
    hover_from_candidate, lines_from_hover, passes_of_survey, rotors_from_hover, speeds_from_decision,
    survey_from_source,
};
use crate::tone::search_range_rev_s;
use hovertone_analysis::{Hover, Method, OtherRotor, RotorEstimate, SpeedAnalysis};
use hovertone_signal::SignalSource;
use hovertone_signal::passes::{Passes, Progress};

/// From a recording to the speed of its rotors. Memory does not grow with the length of the recording, but for the list of samples.
///
/// # Errors
/// Settings without a meaning, a source that fails, a band above half the sample rate. "No rotor tone" is no error but
/// [`Outcome::NoRotorTone`](hovertone_analysis::Outcome::NoRotorTone).
pub fn speed_from_source(
    source: &mut dyn SignalSource,
    config: &Config,
    on_progress: &mut dyn FnMut(Progress),
) -> Result<SpeedAnalysis, Error> {
    speed_from_passes(&mut Passes::planned(source, passes_of_speed(config), on_progress)?, config)
}

/// The same, where the caller has planned the passes: [`passes_of_speed`] of them are made here.
///
/// # Errors
/// As [`speed_from_source`].
pub fn speed_from_passes(passes: &mut Passes<'_>, config: &Config) -> Result<SpeedAnalysis, Error> {
    let surveyed = survey_from_passes(passes, config)?;
    speed_from_survey(passes, &surveyed, config)
}

/// Passes that a speed needs: one for the survey, one for the lines, and two where a known number of rotors is separated. Where several are
/// heard, two more separate them, and two more look for others beside these. These are announced when they turn out to be needed.
pub fn passes_of_speed(config: &Config) -> u32 {
    passes_of_survey() + passes_after_survey(config)
}

pub(crate) fn passes_after_survey(config: &Config) -> u32 {
    if config.wants_rotors() { 3 } else { 1 }
}

/// The first stage by itself, for several analyses of one recording.
///
/// # Errors
/// As [`speed_from_source`].
pub fn survey_from_passes(passes: &mut Passes<'_>, config: &Config) -> Result<Surveyed, Error> {
    config.check()?;
    // a tone that the recording cannot hold is refused before a pass is made
    search_range_rev_s(&config.tone, passes.sample_rate_hz())?;
    survey_from_source(passes, config, None)
}

/// The stages after the survey.
///
/// # Errors
/// As [`speed_from_source`].
pub fn speed_from_survey(
    passes: &mut Passes<'_>,
    surveyed: &Surveyed,
    config: &Config,
) -> Result<SpeedAnalysis, Error> {
    match candidates_from_survey(surveyed, passes.sample_rate_hz(), config) {
        Ok(candidates) => speed_from_candidates(passes, surveyed, &candidates, config),
        Err(stop) => stop.answer(surveyed.heard),
    }
}

/// Where other rotors are heard beside the first, and their number is not known, several are separated. Where there may be others, the same is
/// tried, and holds where rotors are as far apart as others would be: louder and softer sounds of one rotor look like rotors that are closer.
fn speed_from_candidates(
    passes: &mut Passes<'_>,
    surveyed: &Surveyed,
    candidates: &Candidates,
    config: &Config,
) -> Result<SpeedAnalysis, Error> {
    let are_several = candidates.are_several(config);
    if are_several || candidates.may_be_several(config) && config.method == Method::Separated {
        let as_several = config.with_several_rotors();
        passes.expect_more(passes_after_survey(&as_several) - passes_after_survey(config));
        let several = speed_of_candidate(passes, surveyed, candidates, &as_several)?;
        if are_several || are_far_apart(&several) {
            return Ok(several);
        }
        passes.expect_more(passes_after_survey(config));
    }
    speed_of_candidate(passes, surveyed, candidates, config)
}

/// The stages after the survey, for a rotor that was heard at this speed.
///
/// # Errors
/// As [`speed_from_source`].
pub(crate) fn speed_of_heard_rotor(
    passes: &mut Passes<'_>,
    surveyed: &Surveyed,
    rotor: HeardRotor,
    config: &Config,
) -> Result<SpeedAnalysis, Error> {
    let candidates = Candidates::of_heard_rotor(surveyed, rotor, passes.sample_rate_hz(), config)?;
    speed_from_candidates(passes, surveyed, &candidates, config)
}

/// The rotors in the hover of the leading candidate, separated without a decision whether they are rotors; two passes. For analyses that
/// come before the speeds, such as the search for the start of each motor.
///
/// # Errors
/// As [`speed_from_source`].
pub fn rotors_from_survey(passes: &mut Passes<'_>, surveyed: &Surveyed, config: &Config) -> Result<HoverRotors, Error> {
    let candidates = match candidates_from_survey(surveyed, passes.sample_rate_hz(), config) {
        Ok(candidates) => candidates,
        Err(stop) => return stop.answer(surveyed.heard).map(|_| HoverRotors::default()),
    };
    let hover = hover_from_candidate(surveyed, &candidates, config);
    let tracks = rotors_from_hover(passes, surveyed, &hover, candidates.leading_rev_s, config)?;
    Ok(HoverRotors { rotors: tracks.rotors(config.tone.order, &config.budget), hover })
}

/// A rotor that something known leaves out, such as the vehicle, and whose lines are far more probable than those of a rotor as said. One pass.
///
/// # Errors
/// As [`speed_from_source`].
pub fn better_rotor_from_passes(passes: &mut Passes<'_>, config: &Config) -> Result<Option<OtherRotor>, Error> {
    let surveyed = survey_from_passes(passes, config)?;
    let candidates = candidates_from_survey(&surveyed, passes.sample_rate_hz(), config);
    Ok(candidates.ok().and_then(|candidates| candidates.better))
}

/// A hover and the rotors that were separated in it.
#[derive(Clone, Debug, Default)]
pub struct HoverRotors {
    /// The stretches of the hover.
    pub hover: Hover,
    /// The rotors, fastest first.
    pub rotors: Vec<RotorEstimate>,
}

fn speed_of_candidate(
    passes: &mut Passes<'_>,
    surveyed: &Surveyed,
    candidates: &Candidates,
    config: &Config,
) -> Result<SpeedAnalysis, Error> {
    let hover = hover_from_candidate(surveyed, candidates, config);
    let middle_rev_s = candidates.middle_rev_s(surveyed, &hover, config);
    let rotors_rev_s = candidates.rotors_rev_s(config);
    lines_from_hover(passes, surveyed, &hover, middle_rev_s, config)
        .and_then(|lines| decision_from_lines(passes, surveyed, candidates, &hover, rotors_rev_s, lines, config))
        .and_then(|decision| speeds_from_decision(surveyed.heard, hover, decision, config))
        .or_else(|stop: Stop| stop.answer(surveyed.heard))
}
