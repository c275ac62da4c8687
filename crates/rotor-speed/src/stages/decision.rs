//! Stage 5: lines → decision whether they belong to a rotor, whether its speed is right or a multiple, and which rotors there are. It
//! makes one more pass where a weak tone is steady, and two more where several rotors are separated.

use super::rotors::heard_rotors;
use super::{Candidates, Lines, Silence, Stop, Surveyed};
use crate::config::Config;
use crate::detection::{mains_hum_reason, no_tone_reason, not_held_reason, or_mains_hum};
use crate::error::Error;
use crate::evidence::{OwnPropeller, nats_near};
use crate::harmonic::HarmonicTracer;
use crate::hover::restless_s;
use crate::rotors::RotorTracks;
use crate::tone::{blades_of_tone, foreign_series, lines_and_between};
use hovertone_analysis::{Hover, Method, NoTone, Reading, WeighedSpeed};
use hovertone_signal::passes::Passes;
use hovertone_vehicle::BLADES_MAX;

/// A candidate that is one rotor, or several.
pub(crate) struct Decision {
    pub(crate) lines: Lines,
    /// The track of each rotor; empty where the rotors are not separated.
    pub(crate) rotors: RotorTracks,
    /// The speeds that remain possible; empty where one is decided.
    pub(crate) alternatives: Vec<Reading>,
    /// The chosen speed and its runner-up.
    pub(crate) weighed: Vec<WeighedSpeed>,
}

/// Decides whether the lines belong to a rotor, and separates the rotors where the settings ask for it.
///
/// # Errors
/// A source that fails; "no rotor tone" where the lines belong to something else.
pub(crate) fn decision_from_lines(
    passes: &mut Passes<'_>,
    surveyed: &Surveyed,
    candidates: &Candidates,
    hover: &Hover,
    speed_rev_s: f64,
    lines: Lines,
    config: &Config,
) -> Result<Decision, Stop> {
    let why_none = why_no_rotor(passes, surveyed, candidates, hover, speed_rev_s, &lines, config)?;
    if let Some(reason) = why_none {
        let reason = or_mains_hum(reason, &surveyed.survey);
        return Err(Silence { reason, hover: hover.clone(), warnings: lines.warnings }.into());
    }
    let wants_rotors = config.methods().any(|method| method == Method::Separated);
    let rotors =
        if wants_rotors { heard_rotors(passes, surveyed, hover, speed_rev_s, config)? } else { RotorTracks::default() };
    let rotors = rotors.unless_doubtful_beside(&lines.harmonic, config.tone.order);
    let alternatives = candidates.alternatives(config);
    Ok(Decision { lines, rotors, alternatives, weighed: candidates.weighed(speed_rev_s) })
}

/// The reason why the lines do not belong to a rotor at this speed. `None` where they do.
fn why_no_rotor(
    passes: &mut Passes<'_>,
    surveyed: &Surveyed,
    candidates: &Candidates,
    hover: &Hover,
    speed_rev_s: f64,
    lines: &Lines,
    config: &Config,
) -> Result<Option<NoTone>, Error> {
    let survey = &surveyed.survey;
    let tone_hz = speed_rev_s * config.tone.order.lines_per_turn();
    let not_held = not_held_reason(restless_s(hover, survey, &candidates.map), hover, tone_hz, &config.hover);
    // the evidence has compared the rotor with mains hum, by all its lines: one that meets a line of the hum says nothing
    if candidates.is_heard {
        return Ok(not_held);
    }
    if candidates.is_named && evidence_is_too_small(surveyed, speed_rev_s, config) {
        return Ok(Some(NoTone::NoSeries));
    }
    let mut not_a_line = no_tone_reason(&lines.clearest, &config.ridge);
    if not_a_line.is_some() && lines.harmonic.steady_share(hover.length_s()) >= config.ridge.steady_share_min {
        not_a_line = slower_shaft(passes, hover, lines, speed_rev_s, config)?;
    }
    Ok(not_a_line
        .or(not_held)
        .or_else(|| mains_hum_reason(&lines.clearest, survey))
        .or_else(|| foreign_series(survey, hover, &config.tone, config.rotors.are_several(), speed_rev_s)))
}

/// Whether the levels of all orders are too little evidence for a rotor at this speed, where they can be compared: where a single line is
/// followed, others need not sound. Who gives a band says that a tone is in it; then evidence against it alone refutes it.
fn evidence_is_too_small(surveyed: &Surveyed, speed_rev_s: f64, config: &Config) -> bool {
    let blades = blades_of_tone(&config.tone).filter(|_| config.tone.harmonics > 1);
    let heard = surveyed.excess.as_ref().zip(blades);
    let nats = heard.and_then(|(looks, blades)| {
        nats_near(looks, speed_rev_s, &OwnPropeller { blades, prior: &config.evidence.levels })
    });
    let nats_min = if config.tone.band_hz.is_some() { 0.0 } else { config.evidence.levels_nats_min };
    nats.is_some_and(|nats| nats < nats_min)
}

/// Tests in one pass whether lines between the assumed ones sound as well, so that a slower shaft explains them better: the comb cannot
/// decide this for a weak, steady tone. A gear mesh has too high an order for the question.
fn slower_shaft(
    passes: &mut Passes<'_>,
    hover: &Hover,
    lines: &Lines,
    speed_rev_s: f64,
    config: &Config,
) -> Result<Option<NoTone>, Error> {
    let order = config.tone.order.lines_per_turn();
    if order > BLADES_MAX {
        return Ok(None);
    }
    let found = lines.harmonic.speed_in(None, config.tone.order);
    let steady_rev_s = found.map_or(speed_rev_s, |found| found.speed.rev_s());
    let bands = lines_and_between(&lines.channel_bands, order, steady_rev_s);
    let mut harmonic = HarmonicTracer::new(passes.sample_rate_hz(), &bands);
    passes.expect_more(1);
    passes.listen(&hover.spans_s(), &mut harmonic)?;
    Ok(harmonic.finish().lines_between(order).map(|between| NoTone::SlowerShaft {
        line_count: between.count,
        speed_rev_s: between.times_slower.map(|times| steady_rev_s / f64::from(times)),
    }))
}
