//! Votes of the lines of a frame for each shaft speed.

use super::excess::ExcessFrame;
use super::level_table::{LEVELS, Level, level_db};
use super::levels::LINE_HZ_MIN;
use super::rotor_lines::RotorLines;

/// Largest vote of a line for or against, in nats. *Decision.*
const VOTE_NATS_MAX: f64 = 8.0;
/// Levels over the floor over which the likelihood of a line is averaged, dB: from the faintest that shows to the loudest. *Decision.*
const LINE_DB: std::ops::RangeInclusive<i32> = 3..=33;
/// Step of these levels, dB. *Numeric.*
const LINE_DB_STEP: usize = 2;
/// Probability that a line of the blade pass is audible in a frame. *Decision.*
const BLADE_PASS_AUDIBLE: f64 = 0.7;
/// Probability that another line of the shaft is audible in a frame. *Decision.*
const SHAFT_AUDIBLE: f64 = 0.35;
/// Harmonics of the blade pass over which both probabilities fall by a factor e. *Decision.*
const AUDIBLE_HARMONICS: f64 = 8.0;
/// Harmonics of the blade pass that vote, and that tell rotors apart. *Decision.*
pub(super) const HARMONICS: u32 = 12;
/// Harmonics of a gear mesh that vote: more are above what recorders keep. *Decision.*
pub(super) const MESH_HARMONICS: u32 = 3;
/// Probability that the propeller of a rotor with a gear is audible beside the mesh. *Decision.*
pub(super) const AUDIBLE_BESIDE_MESH: f64 = 0.5;
/// Weight of the vote of a line above the band of the recording, which cannot be heard: its absence proves little. *Decision.*
const BEYOND_WEIGHT: f32 = 0.5;

/// The votes of each order, as a table over the level of the line.
pub(super) struct VoteTable {
    /// Votes of the orders 1, 2, 3 … of the shaft.
    shaft: Vec<LineVotes>,
    /// Votes of the harmonics of the gear mesh.
    mesh: Vec<LineVotes>,
}

/// The votes of one line.
struct LineVotes {
    order: f64,
    /// `of_level[level]`.
    of_level: Vec<f32>,
    /// Vote where the line is above the band.
    beyond: f32,
}

impl VoteTable {
    /// Votes for rotors that make these lines.
    pub(super) fn of(lines: &RotorLines) -> Self {
        let ratios: Vec<f64> =
            (0..LEVELS).map(|level| ln_likelihood_ratio(10f64.powf(level_db(level as f64) / 10.0))).collect();
        let votes = |order: f64, audible: f64, harmonics: f64| {
            let audible = audible * (-(harmonics - 1.0).max(0.0) / AUDIBLE_HARMONICS).exp();
            LineVotes {
                order,
                of_level: ratios.iter().map(|ratio| (1.0 - audible + audible * ratio.exp()).ln() as f32).collect(),
                beyond: BEYOND_WEIGHT * (1.0 - audible).ln() as f32,
            }
        };
        let of_shaft = |blades: u32| {
            (1..=HARMONICS * blades).map(move |order| {
                let audible = if order.is_multiple_of(blades) { BLADE_PASS_AUDIBLE } else { SHAFT_AUDIBLE };
                votes(f64::from(order), audible, f64::from(order) / f64::from(blades))
            })
        };
        let of_mesh =
            |order: f64| (1..=MESH_HARMONICS).map(f64::from).map(move |k| votes(k * order, BLADE_PASS_AUDIBLE, k));
        Self {
            shaft: lines.blades.into_iter().flat_map(of_shaft).collect(),
            mesh: lines.mesh_order.into_iter().flat_map(of_mesh).collect(),
        }
    }

    /// The vote of a line of this order of the shaft, at a level.
    pub(super) fn vote(&self, order: u32, level: Level) -> f32 {
        self.shaft[order as usize - 1].of_level[usize::from(level)]
    }

    /// Whether a gear mesh votes.
    pub(super) fn has_mesh(&self) -> bool {
        !self.mesh.is_empty()
    }

    fn lines(&self) -> impl Iterator<Item = &LineVotes> {
        self.shaft.iter().chain(&self.mesh)
    }
}

/// The bin of an order outside the band: frames have fewer bins. *Numeric.*
const BEYOND: u16 = u16::MAX;

/// Places of all orders in a frame, for each speed of a grid.
pub(super) struct VotePlaces {
    /// The bin of one order after the other, or [`BEYOND`], at each speed.
    bins: Vec<u16>,
    speeds: usize,
}

impl VotePlaces {
    pub(super) fn new(speeds_rev_s: &[f64], table: &VoteTable, bin_hz: f64, bins: usize) -> Self {
        let place = |order: f64, speed_rev_s: f64| {
            let hz = speed_rev_s * order;
            let bin = (hz / bin_hz + 0.5) as usize;
            u16::try_from(bin).ok().filter(|_| bin < bins && hz >= LINE_HZ_MIN).unwrap_or(BEYOND)
        };
        let bins = table.lines().flat_map(|line| speeds_rev_s.iter().map(move |&speed| place(line.order, speed)));
        let bins = bins.collect();
        Self { bins, speeds: speeds_rev_s.len() }
    }
}

/// The votes of a frame for each speed of the grid, in nats. Beside a gear mesh, the propeller may be inaudible.
pub(super) fn votes_of_frame(frame: &ExcessFrame, table: &VoteTable, places: &VotePlaces) -> Vec<f32> {
    let mut sums = vec![0.0; places.speeds];
    let (of_shaft, of_mesh) = places.bins.split_at(table.shaft.len() * places.speeds);
    add_votes(&mut sums, frame, &table.shaft, of_shaft);
    if table.has_mesh() {
        let [audible, inaudible] = [AUDIBLE_BESIDE_MESH, 1.0 - AUDIBLE_BESIDE_MESH].map(|share| share.ln() as f32);
        sums.iter_mut().for_each(|sum| *sum = ln_sum_of_two(audible + *sum, inaudible));
        add_votes(&mut sums, frame, &table.mesh, of_mesh);
    }
    sums
}

/// `ln(eᵃ + eᵇ)`.
fn ln_sum_of_two(a: f32, b: f32) -> f32 {
    a.max(b) + (-(a - b).abs()).exp().ln_1p()
}

/// Adds the votes of lines at these places.
fn add_votes(sums: &mut [f32], frame: &ExcessFrame, lines: &[LineVotes], bins: &[u16]) {
    for (line, bins) in lines.iter().zip(bins.chunks_exact(sums.len())) {
        for (sum, &bin) in sums.iter_mut().zip(bins) {
            *sum += match bin {
                BEYOND => line.beyond,
                bin => line.of_level[usize::from(frame.levels[usize::from(bin)])],
            };
        }
    }
}

/// `ln Λ(R)`: likelihood of the excess power R of a line with the mean 1 + s, averaged over levels s, against noise with the mean 1.
fn ln_likelihood_ratio(excess: f64) -> f64 {
    let levels = LINE_DB.step_by(LINE_DB_STEP).map(|db| 10f64.powf(f64::from(db) / 10.0));
    let likelihoods: Vec<f64> =
        levels.map(|s| (excess * s / (1.0 + s) - s.ln_1p()).min(VOTE_NATS_MAX * 10.0).exp()).collect();
    let mean = likelihoods.iter().sum::<f64>() / likelihoods.len() as f64;
    mean.ln().clamp(-VOTE_NATS_MAX, VOTE_NATS_MAX)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::level_table::level_of;

    #[test]
    fn a_vote_is_bounded_and_noise_votes_against_on_average() {
        assert_eq!(ln_likelihood_ratio(1e6), VOTE_NATS_MAX);
        // mean of the vote over noise, ∫ e^(−R) ln Λ(R) dR, is below 0 (Gibbs), and that of Λ at most 1: less, as the vote is bounded
        let step = 1e-3;
        let (mut vote, mut ratio) = (0.0, 0.0);
        for n in 0..20_000 {
            let excess = (f64::from(n) + 0.5) * step;
            vote += step * (-excess).exp() * ln_likelihood_ratio(excess);
            ratio += step * (-excess).exp() * ln_likelihood_ratio(excess).exp();
        }
        assert!(vote < 0.0, "{vote}");
        assert!(ratio < 1.001, "{ratio}");
    }

    #[test]
    fn the_table_holds_the_votes() {
        let table = VoteTable::of(&RotorLines::of_blades(2));
        for excess in [0.05, 1.0, 7.0, 300.0] {
            let level = level_of(excess);
            let excess = 10f64.powf(level_db(f64::from(level)) / 10.0);
            let expected = (1.0 - BLADE_PASS_AUDIBLE + BLADE_PASS_AUDIBLE * ln_likelihood_ratio(excess).exp()).ln();
            let found = f64::from(table.shaft[1].of_level[usize::from(level)]);
            assert!((found - expected).abs() < 1e-5 * (1.0 + expected.abs()), "{excess}: {found} {expected}");
        }
    }
}
