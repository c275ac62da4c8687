//! Stage 5: lines → decision whether their speed is held, and which rotors there are. It makes two more passes where several rotors are
//! separated.

use super::left_out::heard_instead;
use super::rotors::heard_rotors;
use super::{Candidates, Lines, Silence, Stop, Surveyed};
use crate::config::Config;
use crate::detection::{no_series, not_held_reason, or_mains_hum};
use crate::evidence::COMPANION_DISTANCE_MIN;
use crate::hover::restless_s;
use crate::rotors::RotorTracks;
use hovertone_analysis::{Hover, NoTone, Outcome, Reading, SpeedAnalysis, Warning, WeighedSpeed};
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
    /// Standard deviation of the speeds of the rotors for which one line stands, as a share.
    pub(crate) spread_share: f64,
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
    mut lines: Lines,
    config: &Config,
) -> Result<Decision, Stop> {
    let tone_hz = speed_rev_s * config.tone.order.lines_per_turn();
    let restless_s = restless_s(hover, &surveyed.survey, &candidates.map);
    let silence = |reason: NoTone| Silence { reason, hover: hover.clone(), warnings: lines.warnings.clone() };
    let sample_rate_hz = passes.sample_rate_hz();
    let lost = || {
        let instead = heard_instead(surveyed, sample_rate_hz, config);
        silence(or_mains_hum(no_series(&config.tone, instead), &surveyed.survey))
    };
    let wants_rotors = config.wants_rotors();
    // a faint rotor must keep its phase; where several sound, each keeps its own
    let keeps_phase = !candidates.is_faint || lines.keep_phase(hover, config);
    if !keeps_phase && !wants_rotors {
        return Err(lost().into());
    }
    if let Some(reason) = not_held_reason(restless_s, hover, tone_hz, &config.hover) {
        return Err(silence(reason).into());
    }
    let rotors =
        if wants_rotors { heard_rotors(passes, surveyed, hover, speed_rev_s, config)? } else { RotorTracks::default() };
    let rotors = rotors.unless_doubtful_beside(&lines.harmonic, config.tone.order);
    if !keeps_phase && !rotors.are_told_apart() {
        return Err(lost().into());
    }
    // beside rotors that are not separated, the other one may be one of these
    if rotors.another_s > 0.0 && config.rotors.is_count_known && rotors.are_all_resolved() {
        lines.warnings.push(Warning::OtherRotorsHeard { expected: config.rotors.count });
    }
    let alternatives = candidates.alternatives(config);
    lines.warnings.extend(candidates.warnings(config));
    let spread_share = candidates.spread_share(config);
    Ok(Decision { lines, rotors, alternatives, weighed: candidates.weighed(), spread_share })
}

/// Whether rotors are separated as far as others are looked for beside the first.
pub(crate) fn are_far_apart(analysis: &SpeedAnalysis) -> bool {
    let Outcome::Ok(tone) = &analysis.outcome else { return false };
    // fastest first
    let ends = tone.rotors.first().zip(tone.rotors.last());
    ends.is_some_and(|(fastest, slowest)| {
        (fastest.speed.speed.rev_s() / slowest.speed.speed.rev_s()).ln() >= COMPANION_DISTANCE_MIN
    })
}
