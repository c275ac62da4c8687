//! Hypotheses: paths of speeds in each octave, at each family, and the belief in each.

use super::excess::Excess;
use super::level_model::{LAST_HARMONIC, LevelModel, OrderLevel};
use super::levels::{level_db, noise_level};
use super::path::{best_path, gain_of_jumps_nats};
use super::settings::EvidenceConfig;
use super::votes::{VotePlaces, VoteTable, votes_of_frame};
use hovertone_signal::statistics::{log_sum_exp, mean, median};
use hovertone_vehicle::KnownRotor;
use std::ops::{Range, RangeInclusive};

/// Step of the logarithm of the speeds of the search: half the width of a line of a frame at the highest frequency. *Numeric.*
const GRID_STEP: f64 = 1e-3;
/// Ratio of the ends of a window of speeds in which the best path is looked for: a rotor keeps within it in hover. *Decision.*
const WINDOW_RATIO: f64 = 1.6;
/// Ratio of the starts of neighbouring windows; they overlap, so that each path is well inside of one. *Numeric.*
const WINDOW_STEP_RATIO: f64 = 1.25;
/// Speeds of the hypotheses over the speed of each path: octaves, and families of three. *Decision.*
const FACTORS: [f64; 10] = [1.0, 0.5, 2.0, 1.0 / 3.0, 3.0, 0.25, 4.0, 2.0 / 3.0, 1.5, 4.0 / 3.0];
/// An octave down, none, and one up. *Physics.*
const OCTAVES: [f64; 3] = [0.5, 1.0, 2.0];
/// Smallest share of the most votes that a rotor's path has, less some nats. *Decision.*
const VOTES_SHARE_MIN: f64 = 0.5;
/// These nats. *Decision.*
const VOTES_NATS_APART: f64 = 3.0;
/// The same for a path that is no octave or family of the best one. *Decision.*
const OTHER_VOTES_SHARE_MIN: f64 = 0.8;
/// Paths whose mean distance is at most this many points are one path. *Numeric.*
const SAME_POINTS: usize = 2;
/// Largest difference of the logarithms of a speed and of an octave or family of another that is the same rotor's. *Numeric.*
const RELATED: f64 = 0.05;
/// Largest difference of the logarithms of the speeds of two rotors of one vehicle. *Decision.*
const ROTORS_APART: f64 = 0.14;
/// Width of the speeds of a hover, as a share. *Decision.*
const HOVER_WIDTH_SHARE: f64 = 0.024;
/// Slowest shaft whose lines stand apart in a frame of 0.1 s, rev/s. The lines of a slower comb lie so close that they meet those of anything.
/// *Decision.*
const RESOLVED_REV_S: f64 = 30.0;
/// Density of air in the prior of the thrust coefficient, kg/m³. *Decision.*
pub(crate) const AIR_KG_M3: f64 = 1.2;

/// The beliefs that a recording gives rise to.
#[derive(Clone, Debug)]
pub(crate) struct Beliefs {
    /// All hypotheses that are possible, most probable first.
    pub(crate) hypotheses: Vec<Hypothesis>,
    /// Votes that a voice or an instrument has more than the most probable rotor, in nats a frame.
    jumps_nats: f64,
}

impl Beliefs {
    /// Whether the most probable speed has votes of its own, not those of its octaves alone.
    pub(crate) fn is_clear(&self, config: &EvidenceConfig) -> bool {
        self.hypotheses.first().is_some_and(|first| first.votes_nats >= config.votes_nats_min)
    }

    /// The speed of the hover of the most probable rotor.
    pub(crate) fn hover_rev_s(&self) -> Option<f64> {
        self.hypotheses.first().map(|first| first.hover_rev_s)
    }

    /// Those that remain possible where odds of `belief_min` decide; only one where it is decided.
    pub(crate) fn possible(&self, belief_min: f64) -> &[Hypothesis] {
        let is_decided = self.hypotheses.first().is_some_and(|first| first.belief >= belief_min);
        let possible =
            self.hypotheses.iter().take_while(|hypothesis| hypothesis.belief >= 1.0 - belief_min).count().max(2);
        &self.hypotheses[..if is_decided { 1 } else { possible.min(self.hypotheses.len()) }]
    }

    /// Whether a rotor is heard: by the levels of the most probable speed, and by the votes for it or one of its octaves.
    pub(crate) fn is_heard(&self, config: &EvidenceConfig) -> bool {
        let Some(first) = self.hypotheses.first() else { return false };
        let is_octave = |other: &&Hypothesis| is_multiple(other.speed_rev_s, first.speed_rev_s, &OCTAVES);
        let has_votes = |other: &Hypothesis| other.votes_nats >= config.votes_nats_min;
        first.nats >= config.levels_nats_min
            && first.speed_rev_s >= RESOLVED_REV_S
            && self.jumps_nats < config.jumps_nats_max
            && self.hypotheses.iter().filter(is_octave).any(has_votes)
    }
}

/// One shaft speed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hypothesis {
    /// Mean speed along the path.
    pub(crate) speed_rev_s: f64,
    /// The speed near which the path is longest: that of the hover.
    pub(crate) hover_rev_s: f64,
    /// Index of the path that was found, of which this is a multiple.
    path: usize,
    /// Its speed over that of the path.
    factor: f64,
    /// Median over the frames of the votes for the path, in nats.
    pub(crate) votes_nats: f64,
    /// Evidence of the levels of its lines, and of what is known of the vehicle, in nats.
    pub(crate) nats: f64,
    /// Probability among the hypotheses.
    pub(crate) belief: f64,
}

impl Hypothesis {
    /// Another speed, with the belief that this one leaves.
    pub(crate) fn or_else(&self, speed_rev_s: f64) -> Self {
        Self { speed_rev_s, hover_rev_s: speed_rev_s, belief: 1.0 - self.belief, ..*self }
    }

    /// Whether a rotor at another speed may belong to the same vehicle, in the same octave.
    pub(crate) fn is_of_same_vehicle(&self, speed_rev_s: f64) -> bool {
        (self.speed_rev_s / speed_rev_s).ln().abs() < ROTORS_APART
    }
}

/// What a rotor is asked for.
#[derive(Clone, Debug)]
pub(crate) struct WantedRotor {
    /// Blades of the propeller.
    pub(crate) blades: u32,
    /// Slowest and fastest shaft that is possible.
    pub(crate) speeds_rev_s: RangeInclusive<f64>,
    /// What is known of the vehicle.
    pub(crate) known: KnownRotor,
}

/// Compares the hypotheses on all frames. `None` without frames, or without votes for any speed.
///
/// The path with the most votes of all may be that of a slow comb, whose dense lines cover the wide lines of several rotors. Therefore each
/// octave has its path, and the levels decide among them. The noise is what the path that explains most leaves.
pub(crate) fn beliefs_from_excess(excess: &Excess, wanted: &WantedRotor, config: &EvidenceConfig) -> Option<Beliefs> {
    let search = Search::of(excess, wanted)?;
    let paths = search.best_paths(&excess.hops());
    let multiples = search.multiples(&paths, config.votes_nats_min)?;
    let speeds_rev_s = |path: &[usize]| search.grid.speeds_of(path);
    let noise = paths
        .iter()
        .filter_map(|path| noise_level(excess, &speeds_rev_s(path)))
        .min_by(|a, b| a.lines_share.total_cmp(&b.lines_share))?;
    let mut model = LevelModel::new(noise, wanted.blades, &config.levels);
    let mut hypotheses: Vec<Hypothesis> = Vec::new();
    for Multiple { path, factor, points, votes_nats } in multiples {
        let speeds_rev_s = speeds_rev_s(&points);
        let speed_rev_s = mean(&speeds_rev_s)?;
        let hover_rev_s = most_frequent_rev_s(&speeds_rev_s)?;
        let nats = model.evidence_nats(&levels_of_orders(excess, &speeds_rev_s, wanted.blades))
            + nats_of_vehicle(speed_rev_s, &wanted.known, config);
        hypotheses.push(Hypothesis { speed_rev_s, hover_rev_s, path, factor, votes_nats, nats, belief: 0.0 });
    }
    let hypotheses = with_beliefs(hypotheses);
    let first = hypotheses.first()?;
    let jumps_nats = search.jumps_nats(&paths[first.path], first.factor)?;
    Some(Beliefs { hypotheses, jumps_nats })
}

/// The votes of all frames for all speeds.
struct Search {
    grid: SpeedGrid,
    /// `votes[frame][speed]`.
    votes: Vec<Vec<f32>>,
}

/// A path with all speeds multiplied by a factor.
struct Multiple {
    /// Index of the path.
    path: usize,
    factor: f64,
    points: Vec<usize>,
    /// Median over the frames of the votes for it, in nats.
    votes_nats: f64,
}

impl Search {
    fn of(excess: &Excess, wanted: &WantedRotor) -> Option<Self> {
        let bins = excess.frames.first()?.levels.len();
        let grid = SpeedGrid::of(&wanted.speeds_rev_s);
        let table = VoteTable::for_blades(wanted.blades);
        let places = VotePlaces::new(&grid.speeds_rev_s, &table, excess.bin_hz, bins);
        let votes = excess.frames.iter().map(|frame| votes_of_frame(frame, &table, &places)).collect();
        Some(Self { grid, votes })
    }

    /// The best path in each window of speeds.
    fn best_paths(&self, hops: &[usize]) -> Vec<Vec<usize>> {
        self.grid.windows().into_iter().map(|window| best_path(&self.votes, window, hops, GRID_STEP)).collect()
    }

    /// The paths at all factors. One with far fewer votes than another is left out: the lines of a rotor sound in most frames. `None` where
    /// none has the least votes of a rotor.
    fn multiples(&self, paths: &[Vec<usize>], votes_nats_min: f64) -> Option<Vec<Multiple>> {
        let mut found: Vec<Multiple> = Vec::new();
        for factor in FACTORS {
            for (path, points) in paths.iter().enumerate() {
                let Some(points) = self.grid.times(points, factor) else { continue };
                if !found.iter().any(|other| is_same_path(&other.points, &points)) {
                    let votes_nats = median(&self.votes_along(&points))?;
                    found.push(Multiple { path, factor, points, votes_nats });
                }
            }
        }
        let most_nats = found.iter().map(|multiple| multiple.votes_nats).fold(f64::MIN, f64::max);
        found.retain(|multiple| multiple.votes_nats >= VOTES_SHARE_MIN * most_nats - VOTES_NATS_APART);
        (most_nats >= votes_nats_min).then_some(found)
    }

    fn votes_along(&self, path: &[usize]) -> Vec<f64> {
        path.iter().zip(&self.votes).map(|(&point, votes)| f64::from(votes[point])).collect()
    }

    /// Votes that a voice or an instrument, which jumps, has more than this multiple of a path or the best of its octaves.
    fn jumps_nats(&self, path: &[usize], factor: f64) -> Option<f64> {
        let octaves = OCTAVES.iter().filter_map(|octave| self.grid.times(path, octave * factor));
        let sum = |path: &[usize]| self.votes_along(path).into_iter().sum::<f64>();
        let best_octave = octaves.max_by(|a, b| sum(a).total_cmp(&sum(b)))?;
        let is_near = |shift: isize| {
            let ratio = shift as f64 * GRID_STEP;
            OCTAVES.iter().any(|octave| (ratio - octave.ln()).abs() < ROTORS_APART)
        };
        Some(gain_of_jumps_nats(&self.votes, &best_octave, GRID_STEP, is_near))
    }
}

/// Whether a speed is one of these multiples of another one.
fn is_multiple(speed_rev_s: f64, of_rev_s: f64, factors: &[f64]) -> bool {
    factors.iter().any(|factor| (speed_rev_s / (factor * of_rev_s)).ln().abs() < RELATED)
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

/// Whether two paths are equal but for the grid.
fn is_same_path(a: &[usize], b: &[usize]) -> bool {
    let apart: usize = a.iter().zip(b).map(|(a, b)| a.abs_diff(*b)).sum();
    apart <= SAME_POINTS * a.len()
}

/// The best path of each speed, most probable first, with its belief. Paths of rotors of one vehicle are one hypothesis.
fn with_beliefs(mut paths: Vec<Hypothesis>) -> Vec<Hypothesis> {
    // octaves are compared along one path; another path that is no family of it explains the frames as well, or it is none
    let sum_nats = |path: &Hypothesis| path.nats + path.votes_nats;
    let best = paths.iter().max_by(|a, b| sum_nats(a).total_cmp(&sum_nats(b)));
    let Some(&Hypothesis { path: best, speed_rev_s, votes_nats, .. }) = best else { return paths };
    let is_family = |path: &Hypothesis| is_multiple(path.speed_rev_s, speed_rev_s, &FACTORS);
    let least_nats = OTHER_VOTES_SHARE_MIN * votes_nats - VOTES_NATS_APART;
    paths.retain(|path| path.path == best || is_family(path) || path.votes_nats >= least_nats);
    paths.sort_by(|a, b| (b.path == best).cmp(&(a.path == best)).then(b.nats.total_cmp(&a.nats)));
    let mut hypotheses: Vec<Hypothesis> = Vec::new();
    for path in paths {
        if !hypotheses.iter().any(|other| other.is_of_same_vehicle(path.speed_rev_s)) {
            hypotheses.push(path);
        }
    }
    hypotheses.sort_by(|a, b| b.nats.total_cmp(&a.nats));
    let sum = log_sum_exp(hypotheses.iter().map(|hypothesis| hypothesis.nats));
    hypotheses.iter_mut().for_each(|hypothesis| hypothesis.belief = (hypothesis.nats - sum).exp());
    hypotheses
}

/// Speeds with a constant step of the logarithm.
struct SpeedGrid {
    speeds_rev_s: Vec<f64>,
}

impl SpeedGrid {
    fn of(range: &RangeInclusive<f64>) -> Self {
        let steps = ((range.end() / range.start()).ln() / GRID_STEP).ceil() as u32;
        Self { speeds_rev_s: (0..=steps).map(|step| range.start() * (GRID_STEP * f64::from(step)).exp()).collect() }
    }

    /// Overlapping windows that cover the grid.
    fn windows(&self) -> Vec<Range<usize>> {
        let points = self.speeds_rev_s.len();
        let width = (WINDOW_RATIO.ln() / GRID_STEP) as usize;
        let step = (WINDOW_STEP_RATIO.ln() / GRID_STEP) as usize;
        let starts = (0..).step_by(step);
        let last = points.saturating_sub(width).div_ceil(step);
        starts.take(last + 1).map(|start| start..(start + width).min(points)).collect()
    }

    /// The speeds along a path.
    fn speeds_of(&self, path: &[usize]) -> Vec<f64> {
        path.iter().map(|&point| self.speeds_rev_s[point]).collect()
    }

    /// The path with all speeds multiplied by a factor; `None` where it leaves the grid.
    fn times(&self, path: &[usize], factor: f64) -> Option<Vec<usize>> {
        let shift = (factor.ln() / GRID_STEP).round() as isize;
        let shifted = |&point: &usize| point.checked_add_signed(shift).filter(|&point| point < self.speeds_rev_s.len());
        path.iter().map(shifted).collect()
    }
}

/// Levels of all orders that are compared, along a path.
fn levels_of_orders(excess: &Excess, speeds_rev_s: &[f64], blades: u32) -> Vec<OrderLevel> {
    (1..=LAST_HARMONIC * blades)
        .filter_map(|order| Some(OrderLevel { order, level_db: level_db(excess, speeds_rev_s, f64::from(order))? }))
        .collect()
}

/// Logarithm of the prior of a speed: by the thrust coefficient of the hover where mass, rotors and diameter are known, else slow shafts are
/// rare; and by the distance from the range of speeds of a known vehicle.
fn nats_of_vehicle(speed_rev_s: f64, known: &KnownRotor, config: &EvidenceConfig) -> f64 {
    let prior = &config.levels;
    let deviations = match known.hover_thrust_coefficient(speed_rev_s, AIR_KG_M3) {
        Some(coefficient) => (coefficient / prior.thrust_coefficient).ln() / prior.thrust_coefficient_std,
        None => (speed_rev_s / prior.slow_rev_s).ln().min(0.0) / prior.slow_std,
    };
    let outside = known.shaft_speed.map_or(0.0, |range| {
        (range.rev_s_low / speed_rev_s).ln().max(0.0) + (speed_rev_s / range.rev_s_high).ln().max(0.0)
    });
    -0.5 * (deviations.powi(2) + (outside / prior.range_std).powi(2))
}
