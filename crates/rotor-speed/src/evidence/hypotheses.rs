//! Hypotheses: speeds and numbers of blades, and the belief in each.

use super::companions::HALF_RANGE_MAX;
use super::excess::Excess;
use super::level_model::{LevelModel, RotorLevels};
use super::levels::levels_of_lines;
use super::prior::odds_nats;
use super::rotor_lines::RotorLines;
use super::search::{Multiple, VOTES_NATS_APART, is_family};
use crate::thresholds::{HOVER_WIDTH_SHARE, NEARLY_ALL};
use hovertone_signal::statistics::{log_sum_exp, mean};
use hovertone_vehicle::KnownRotor;
use std::ops::RangeInclusive;

/// Smallest share of the most votes that a path has which is no octave or family of the best one, less some nats.
const OTHER_VOTES_SHARE_MIN: f64 = NEARLY_ALL;
/// Slowest shaft whose lines stand apart in a frame of 0.1 s, rev/s. The lines of a slower comb lie so close that they meet those of anything.
/// So a slower rotor is heard only where the diameter, the vehicle or the band says that it may be there. *Decision.*
pub(super) const RESOLVED_REV_S: f64 = 30.0;

/// One shaft speed, with a number of blades.
#[derive(Clone, Debug)]
pub(crate) struct Hypothesis {
    /// Lines of the rotor.
    pub(crate) lines: RotorLines,
    /// Speed in each short frame.
    pub(super) speeds_rev_s: Vec<f64>,
    /// Mean speed along the path.
    pub(crate) speed_rev_s: f64,
    /// The speed near which the path is longest: that of the hover.
    pub(crate) hover_rev_s: f64,
    /// Index of the path that was found, of which this is a multiple.
    pub(super) path: usize,
    /// Its speed over that of the path.
    pub(super) factor: f64,
    /// Median over the frames of the votes for the path, in nats.
    pub(crate) votes_nats: f64,
    /// The same over the quieter frames, in which a voice pauses.
    pub(super) quiet_votes_nats: f64,
    /// Evidence of the levels of its lines, in nats: the mean of the looks. They are at the same lines, so that several tell no more than one.
    pub(super) levels_nats: f64,
    /// The same, with what is known of the vehicle.
    pub(super) nats: f64,
    /// Levels of its lines in short frames.
    pub(super) levels: RotorLevels,
    /// The same in long frames over the near floor, where they were looked at.
    pub(super) near_levels: Option<RotorLevels>,
    /// Probability among the hypotheses.
    pub(crate) belief: f64,
}

impl Hypothesis {
    /// Whether a speed is that of the same rotor, or of another one of the same vehicle near it, in the same octave.
    pub(crate) fn is_of_same_vehicle(&self, speed_rev_s: f64) -> bool {
        (self.speed_rev_s / speed_rev_s).ln().abs() < HALF_RANGE_MAX
    }

    /// Whether its lines are more probable than those of another one, at odds of `belief_min`.
    pub(crate) fn is_better_than(&self, other: &Self, belief_min: f64) -> bool {
        self.levels_nats - other.levels_nats >= odds_nats(belief_min)
    }
}

/// What a rotor is asked for.
#[derive(Clone, Debug)]
pub(crate) struct WantedRotor {
    /// The propellers that are possible.
    pub(crate) propellers: Vec<WantedPropeller>,
    /// What is known of the vehicle.
    pub(crate) known: KnownRotor,
    /// Whether something that is known says that the rotor may be slow.
    pub(crate) may_be_slow: bool,
    /// The propellers that would be possible if nothing were known; none where the answer is not compared with these.
    pub(crate) where_unknown: Vec<WantedPropeller>,
}

/// A propeller that is possible, with its gear.
#[derive(Clone, Debug)]
pub(crate) struct WantedPropeller {
    /// Its lines.
    pub(crate) lines: RotorLines,
    /// How common it is.
    pub(crate) share: f64,
    /// Slowest and fastest shaft that is possible.
    pub(crate) speeds_rev_s: RangeInclusive<f64>,
}

/// The hypothesis that a rotor turns at this multiple of a path, with the evidence of its lines. `None` without speeds.
pub(super) fn hypothesis_of(
    multiple: &Multiple,
    lines: &RotorLines,
    excess: &Excess,
    model: &mut LevelModel<'_>,
) -> Option<Hypothesis> {
    let &Multiple { path, factor, votes_nats, quiet_votes_nats, speed_rev_s, ref speeds_rev_s } = multiple;
    let levels = levels_of_lines(excess, speeds_rev_s, lines);
    let levels_nats = model.evidence_nats(&levels, lines);
    Some(Hypothesis {
        lines: *lines,
        speeds_rev_s: speeds_rev_s.clone(),
        speed_rev_s,
        hover_rev_s: most_frequent_rev_s(speeds_rev_s)?,
        path,
        factor,
        votes_nats,
        quiet_votes_nats,
        levels_nats,
        nats: 0.0,
        levels,
        near_levels: None,
        belief: 0.0,
    })
}

/// The mean of the speeds about which most lie. `None` without speeds.
fn most_frequent_rev_s(speeds_rev_s: &[f64]) -> Option<f64> {
    let mut sorted = speeds_rev_s.to_vec();
    sorted.sort_by(f64::total_cmp);
    let near = |first: usize| {
        let end = sorted.partition_point(|&speed_rev_s| speed_rev_s <= sorted[first] * (1.0 + HOVER_WIDTH_SHARE));
        first..end
    };
    let most = (0..sorted.len()).map(near).max_by_key(ExactSizeIterator::len)?;
    mean(&sorted[most])
}

/// The best path of each speed, most probable first. Paths of rotors of one vehicle are one hypothesis.
pub(super) fn one_of_each_speed(mut paths: Vec<Hypothesis>) -> Vec<Hypothesis> {
    // octaves are compared along one path; another path that is no family of it explains the frames as well, or it is none
    let sum_nats = |path: &Hypothesis| path.nats + path.votes_nats;
    let best = paths.iter().max_by(|a, b| sum_nats(a).total_cmp(&sum_nats(b)));
    let Some(&Hypothesis { path: best, speed_rev_s, votes_nats, .. }) = best else { return paths };
    let least_nats = OTHER_VOTES_SHARE_MIN * votes_nats - VOTES_NATS_APART;
    let is_of_best = |path: &Hypothesis| path.path == best || is_family(path.speed_rev_s, speed_rev_s);
    paths.retain(|path| is_of_best(path) || path.votes_nats >= least_nats);
    paths.sort_by(|a, b| (b.path == best).cmp(&(a.path == best)).then(b.nats.total_cmp(&a.nats)));
    let mut hypotheses: Vec<Hypothesis> = Vec::new();
    for path in paths {
        if !hypotheses.iter().any(|other| other.is_of_same_vehicle(path.speed_rev_s)) {
            hypotheses.push(path);
        }
    }
    hypotheses.sort_by(|a, b| b.nats.total_cmp(&a.nats));
    hypotheses
}

/// The hypotheses with their beliefs, most probable first. The belief in a speed is that of all numbers of blades; the most probable of them is
/// told.
pub(super) fn with_beliefs(mut all: Vec<Hypothesis>) -> Vec<Hypothesis> {
    all.sort_by(|a, b| b.nats.total_cmp(&a.nats));
    let mut hypotheses: Vec<Hypothesis> = Vec::new();
    for it in all {
        match hypotheses.iter_mut().find(|other| other.is_of_same_vehicle(it.speed_rev_s)) {
            Some(same) => same.nats = log_sum_exp([same.nats, it.nats].into_iter()),
            None => hypotheses.push(it),
        }
    }
    hypotheses.sort_by(|a, b| b.nats.total_cmp(&a.nats));
    let sum = log_sum_exp(hypotheses.iter().map(|hypothesis| hypothesis.nats));
    hypotheses.iter_mut().for_each(|hypothesis| hypothesis.belief = (hypothesis.nats - sum).exp());
    hypotheses
}
