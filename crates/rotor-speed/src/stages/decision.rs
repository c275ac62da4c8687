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
use crate::tone::{blades_of_tone, lines_and_between};
use hovertone_analysis::{Hover, Method, NoTone, Reading, WeighedSpeed};
use hovertone_signal::passes::Passes;

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
///
/// The evidence has compared what it hears with mains hum, machines and voices. Where it hears no blade pass, only a rotor that keeps its phase may
/// sound, whose weak lines show in spectra that are longer than its frames. It knows no gears.
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
    let hum = || mains_hum_reason(&lines.clearest, survey);
    let why_no_lines = match blades_of_tone(&config.tone) {
        Some(_) if candidates.is_heard => None,
        Some(blades) if is_steady(surveyed, hover, lines, speed_rev_s, blades, config) => {
            slower_shaft(passes, hover, lines, speed_rev_s, config)?.or_else(hum)
        }
        Some(_) => Some(NoTone::NoSeries),
        None => no_tone_reason(&lines.clearest, &config.ridge).or_else(hum),
    };
    let tone_hz = speed_rev_s * config.tone.order.lines_per_turn();
    let restless_s = restless_s(hover, survey, &candidates.map);
    Ok(why_no_lines.or_else(|| not_held_reason(restless_s, hover, tone_hz, &config.hover)))
}

/// Whether the lines keep their phase, and have the levels of a rotor in both looks together.
fn is_steady(
    surveyed: &Surveyed,
    hover: &Hover,
    lines: &Lines,
    speed_rev_s: f64,
    blades: u32,
    config: &Config,
) -> bool {
    let propeller = OwnPropeller { blades, prior: &config.evidence.levels };
    let nats = || surveyed.excess.as_ref().and_then(|looks| nats_near(looks, speed_rev_s, &propeller));
    lines.harmonic.steady_share(hover.length_s()) >= config.ridge.steady_share_min
        && nats().is_some_and(|nats| nats >= config.evidence.levels_nats_min)
}

/// Tests in one pass whether lines between the assumed ones sound as well, so that a slower shaft explains them better: the comb cannot
/// decide this for a weak, steady tone.
fn slower_shaft(
    passes: &mut Passes<'_>,
    hover: &Hover,
    lines: &Lines,
    speed_rev_s: f64,
    config: &Config,
) -> Result<Option<NoTone>, Error> {
    let order = config.tone.order.lines_per_turn();
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
