//! For stage 2: rotors that what is known leaves out.

use super::Surveyed;
use super::propellers::{any_propellers, geared_propellers};
use crate::config::Config;
use crate::evidence::{Beliefs, Hypothesis, WantedRotor};
use crate::tone::{DiscoveryConfig, ToneConfig};
use hovertone_analysis::OtherRotor;
use hovertone_vehicle::KnownRotor;

/// Behind a gear, the rotor without it, or behind that of another vehicle, whose lines are far more probable than those of the most probable one.
/// It is looked for where several speeds are possible, and where the blades are not known, because other lines may pass for those of a mesh.
pub(super) fn better_without_gear(
    surveyed: &Surveyed,
    beliefs: &Beliefs,
    sample_rate_hz: f64,
    config: &Config,
) -> Option<OtherRotor> {
    let belief_min = config.evidence.belief_min;
    let first = beliefs.hypotheses.first().filter(|first| first.lines.mesh_order.is_some())?;
    let is_open = beliefs.possible(belief_min).len() > 1 || config.tone.blades.is_none();
    let other = is_open.then(|| blind_beliefs(surveyed, sample_rate_hz, config)).flatten()?;
    let best = other.hypotheses.first().filter(|other| other.is_better_than(first, belief_min))?;
    // other blades at the same speed contradict nothing, because behind a gear they need not be known
    let is_same = |it: &&Hypothesis| it.is_of_same_vehicle(first.speed_rev_s) && !best.is_better_than(it, belief_min);
    if other.hypotheses.iter().any(|it| is_same(&it)) { None } else { rotor_of(best) }
}

/// The rotor that is heard where nothing is known. `None` where none is.
pub(crate) fn heard_instead(surveyed: &Surveyed, sample_rate_hz: f64, config: &Config) -> Option<OtherRotor> {
    rotor_of(blind_beliefs(surveyed, sample_rate_hz, config)?.hypotheses.first()?)
}

/// The beliefs where nothing is known, with the gears of known vehicles. `None` where no rotor is heard, or only a faint one.
fn blind_beliefs(surveyed: &Surveyed, sample_rate_hz: f64, config: &Config) -> Option<Beliefs> {
    let tone = ToneConfig { band_hz: None, ..config.tone.clone() };
    let geared = geared_propellers(sample_rate_hz, &tone, None, DiscoveryConfig::default().gear_share);
    let any = WantedRotor {
        propellers: any_propellers(sample_rate_hz).into_iter().chain(geared).collect(),
        known: KnownRotor::default(),
        may_be_slow: false,
        where_unknown: Vec::new(),
    };
    surveyed.clear_beliefs(&any, &config.evidence)
}

fn rotor_of(hypothesis: &Hypothesis) -> Option<OtherRotor> {
    Some(OtherRotor { blades: hypothesis.lines.blades?, speed_rev_s: hypothesis.hover_rev_s })
}
