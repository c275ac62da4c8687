//! Hypotheses: one path of speeds at each octave and family, and the belief in each.

use super::excess::Excess;
use super::level_model::{OrderLevel, evidence_nats};
use super::levels::{NoiseLevel, level_db, noise_level};
use super::path::best_path;
use super::settings::EvidenceConfig;
use super::votes::{VotePlaces, VoteTable, votes_of_frame};
use hovertone_signal::statistics::{log_sum_exp, mean, median};
use hovertone_vehicle::KnownRotor;
use std::ops::RangeInclusive;

/// Step of the logarithm of the speeds of the search. *Numeric.*
const GRID_STEP: f64 = 5e-4;
/// Speeds of the hypotheses over the speed of the path with the most votes: octaves, and families of three. *Decision.*
const FACTORS: [f64; 10] = [0.25, 1.0 / 3.0, 0.5, 2.0 / 3.0, 1.0, 4.0 / 3.0, 1.5, 2.0, 3.0, 4.0];
/// Highest frequency of the compared lines, in turns of the path: all hypotheses are judged in one band. *Decision.*
const COMPARED_ORDERS: f64 = 40.0;
/// Density of air in the prior of the thrust coefficient, kg/m³. *Decision.*
pub(crate) const AIR_KG_M3: f64 = 1.2;

/// The beliefs that a recording gives rise to.
#[derive(Clone, Debug)]
pub(crate) struct Beliefs {
    /// Median over the frames of the votes for the path, in nats.
    pub(crate) votes_nats: f64,
    /// All hypotheses that are possible, most probable first.
    pub(crate) hypotheses: Vec<Hypothesis>,
}

impl Beliefs {
    /// The most probable speed.
    pub(crate) fn most_probable_rev_s(&self) -> Option<f64> {
        self.hypotheses.first().map(|hypothesis| hypothesis.speed_rev_s)
    }
}

/// One shaft speed.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Hypothesis {
    /// Mean speed along the path.
    pub(crate) speed_rev_s: f64,
    /// Evidence of the levels of its lines, and of what is known of the vehicle, in nats.
    pub(crate) nats: f64,
    /// Probability among the hypotheses.
    pub(crate) belief: f64,
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

/// Compares the hypotheses on all frames. `None` without frames.
pub(crate) fn beliefs_from_excess(excess: &Excess, wanted: &WantedRotor, config: &EvidenceConfig) -> Option<Beliefs> {
    let bins = excess.frames.first()?.power.len();
    let grid = grid_rev_s(&wanted.speeds_rev_s);
    let table = VoteTable::for_blades(wanted.blades);
    let places = VotePlaces::new(&grid, &table, excess.bin_hz, bins);
    let votes: Vec<Vec<f32>> = excess.frames.iter().map(|frame| votes_of_frame(frame, &table, &places)).collect();
    let path = best_path(&votes, &excess.hops(), GRID_STEP);
    let speeds_rev_s: Vec<f64> = path.iter().map(|&point| grid[point]).collect();
    let along: Vec<f64> = path.iter().zip(&votes).map(|(&point, votes)| f64::from(votes[point])).collect();
    let votes_nats = median(&along)?;
    let mean_rev_s = mean(&speeds_rev_s)?;
    let noise = noise_level(excess, &speeds_rev_s)?;
    let hz_max = excess.hz_max().min(COMPARED_ORDERS * mean_rev_s);
    let mut hypotheses: Vec<Hypothesis> = FACTORS
        .iter()
        .filter(|&&factor| wanted.speeds_rev_s.contains(&(factor * mean_rev_s)))
        .map(|&factor| {
            let scaled: Vec<f64> = speeds_rev_s.iter().map(|speed| factor * speed).collect();
            let speed_rev_s = factor * mean_rev_s;
            let nats = nats_of_levels(excess, &scaled, hz_max, noise, wanted.blades, config)
                + nats_of_vehicle(speed_rev_s, &wanted.known, config);
            Hypothesis { speed_rev_s, nats, belief: 0.0 }
        })
        .collect();
    let sum = log_sum_exp(hypotheses.iter().map(|hypothesis| hypothesis.nats));
    hypotheses.iter_mut().for_each(|hypothesis| hypothesis.belief = (hypothesis.nats - sum).exp());
    hypotheses.sort_by(|a, b| b.nats.total_cmp(&a.nats));
    Some(Beliefs { votes_nats, hypotheses })
}

fn grid_rev_s(range: &RangeInclusive<f64>) -> Vec<f64> {
    let steps = ((range.end() / range.start()).ln() / GRID_STEP).ceil() as u32;
    (0..=steps).map(|step| range.start() * (GRID_STEP * f64::from(step)).exp()).collect()
}

fn nats_of_levels(
    excess: &Excess,
    speeds_rev_s: &[f64],
    hz_max: f64,
    noise: NoiseLevel,
    blades: u32,
    config: &EvidenceConfig,
) -> f64 {
    let orders = (hz_max / mean(speeds_rev_s).unwrap_or(f64::INFINITY)) as u32;
    let levels: Vec<OrderLevel> = (1..=orders)
        .filter_map(|order| Some(OrderLevel { order, level_db: level_db(excess, speeds_rev_s, f64::from(order))? }))
        .collect();
    evidence_nats(&levels, noise, blades, &config.levels)
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
