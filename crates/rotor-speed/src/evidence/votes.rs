//! Votes of the lines of a frame for each shaft speed.

use super::excess::ExcessFrame;
use super::level_table::{LEVELS, Level, UNKNOWN, level_db};
use super::levels::LINE_HZ_MIN;
use super::rotor_lines::RotorLines;
use crate::thresholds::{LINE_NATS_MAX, MESH_LINES, SERIES_LINES};
use std::ops::Range;

/// Largest vote of a line for or against, in nats.
const VOTE_NATS_MAX: f64 = LINE_NATS_MAX;
/// Levels over the floor over which the likelihood of a line is averaged, dB: from the faintest that shows to the loudest. *Decision.*
const LINE_DB: std::ops::RangeInclusive<i32> = 3..=33;
/// Step of these levels, dB. *Numeric.*
const LINE_DB_STEP: usize = 2;
/// Probability that a line of the blade pass is audible in a frame. *Decision.*
const BLADE_PASS_AUDIBLE: f64 = 0.7;
/// Probability that another line of the shaft is audible in a frame. *Decision.*
const SHAFT_AUDIBLE: f64 = 0.35;
/// Harmonics of the blade pass over which both probabilities fall by a factor e.
const AUDIBLE_HARMONICS: f64 = SERIES_LINES as f64;
/// Harmonics of the blade pass that vote, and that tell rotors apart. *Decision.*
pub(super) const HARMONICS: u32 = 12;
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
        let ratio = |level: usize| {
            if level < LEVELS { ln_likelihood_ratio(10f64.powf(level_db(level as f64) / 10.0)) } else { 0.0 }
        };
        let ratios: Vec<f64> = (0..=usize::from(UNKNOWN)).map(ratio).collect();
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
            |order: f64| (1..=MESH_LINES).map(f64::from).map(move |k| votes(k * order, BLADE_PASS_AUDIBLE, k));
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

/// Frames whose votes are counted together. *Numeric.*
const FRAMES_TOGETHER: usize = 16;
/// Speeds whose votes are counted together: their sums stay in the cache nearest to the processor. *Numeric.*
const SPEEDS_TOGETHER: usize = 256;

/// The votes of each frame for each speed of the grid, in nats: `votes[frame][speed]`. Beside a gear mesh, the propeller may be inaudible.
pub(super) fn votes_of_frames(frames: &[ExcessFrame], table: &VoteTable, places: &VotePlaces) -> Vec<Vec<f32>> {
    frames
        .chunks(FRAMES_TOGETHER)
        .flat_map(|frames| Together::<FRAMES_TOGETHER>::of(frames).votes(frames.len(), table, places))
        .collect()
}

/// The same of one frame.
pub(super) fn votes_of_frame(frame: &ExcessFrame, table: &VoteTable, places: &VotePlaces) -> Vec<f32> {
    Together::<1>::of(std::slice::from_ref(frame)).votes(1, table, places).remove(0)
}

/// Levels of some frames, side by side: a line is at the same bin in all of them.
struct Together<const FRAMES: usize> {
    /// `levels[bin][frame]`.
    levels: Vec<[Level; FRAMES]>,
}

impl<const FRAMES: usize> Together<FRAMES> {
    fn of(frames: &[ExcessFrame]) -> Self {
        let bins = frames.iter().map(|frame| frame.levels.len()).min().unwrap_or_default();
        let mut levels = vec![[0; FRAMES]; bins];
        for (place, frame) in frames.iter().enumerate() {
            levels.iter_mut().zip(&*frame.levels).for_each(|(levels, level)| levels[place] = *level);
        }
        Self { levels }
    }

    /// The votes of the first `frames` of them.
    fn votes(&self, frames: usize, table: &VoteTable, places: &VotePlaces) -> Vec<Vec<f32>> {
        let mut votes: Vec<Vec<f32>> = vec![Vec::with_capacity(places.speeds); frames];
        for from in (0..places.speeds).step_by(SPEEDS_TOGETHER) {
            let sums = self.sums(from..(from + SPEEDS_TOGETHER).min(places.speeds), table, places);
            for (place, votes) in votes.iter_mut().enumerate() {
                votes.extend(sums.iter().map(|sums| sums[place]));
            }
        }
        votes
    }

    /// The votes for some of the speeds: `sums[speed][frame]`.
    fn sums(&self, speeds: Range<usize>, table: &VoteTable, places: &VotePlaces) -> Vec<[f32; FRAMES]> {
        let mut sums = vec![[0.0; FRAMES]; speeds.len()];
        let mut of_lines = places.bins.chunks_exact(places.speeds).map(|bins| &bins[speeds.clone()]);
        for (line, bins) in table.shaft.iter().zip(&mut of_lines) {
            self.add_votes(&mut sums, line, bins);
        }
        if table.has_mesh() {
            let [audible, inaudible] = [AUDIBLE_BESIDE_MESH, 1.0 - AUDIBLE_BESIDE_MESH].map(|share| share.ln() as f32);
            let either = |sum: &mut f32| *sum = ln_sum_of_two(audible + *sum, inaudible);
            sums.iter_mut().flatten().for_each(either);
            for (line, bins) in table.mesh.iter().zip(of_lines) {
                self.add_votes(&mut sums, line, bins);
            }
        }
        sums
    }

    /// Adds the votes of one line, whose bins these are for each speed.
    fn add_votes(&self, sums: &mut [[f32; FRAMES]], line: &LineVotes, bins: &[u16]) {
        let mut votes = [0.0; FRAMES];
        let mut bin_before = None;
        for (sums, &bin) in sums.iter_mut().zip(bins) {
            // slow shafts are less than a bin apart
            if bin_before != Some(bin) {
                bin_before = Some(bin);
                votes = match bin {
                    BEYOND => [line.beyond; FRAMES],
                    bin => self.levels[usize::from(bin)].map(|level| line.of_level[usize::from(level)]),
                };
            }
            sums.iter_mut().zip(&votes).for_each(|(sum, vote)| *sum += vote);
        }
    }
}

/// `ln(eᵃ + eᵇ)`.
fn ln_sum_of_two(a: f32, b: f32) -> f32 {
    a.max(b) + (-(a - b).abs()).exp().ln_1p()
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
    use crate::evidence::excess::Excess;
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
    fn frames_together_have_the_votes_that_each_has_alone() {
        let levels: Vec<Level> = (0..800u32).map(|bin| (bin * 7919 % 251) as Level).collect();
        let mut excess = Excess::of_levels(2.5, 0.05, 37, &levels);
        for (frame, shift) in excess.frames.iter_mut().zip(0..) {
            frame.levels = levels.iter().cycle().skip(shift).take(levels.len()).copied().collect();
        }
        let speeds_rev_s: Vec<f64> = (0..700).map(|step| 5.0 * (7e-3 * f64::from(step)).exp()).collect();
        let mesh = RotorLines { blades: Some(2), mesh_order: Some(8.625) };
        for lines in [RotorLines::of_blades(3), mesh] {
            let table = VoteTable::of(&lines);
            let places = VotePlaces::new(&speeds_rev_s, &table, excess.bin_hz, levels.len());
            let together = votes_of_frames(&excess.frames, &table, &places);
            let alone: Vec<Vec<f32>> =
                excess.frames.iter().map(|frame| votes_of_frame(frame, &table, &places)).collect();
            assert_eq!(together, alone);
            // the votes of one speed, line by line
            let (frame, speed) = (20, 400);
            let vote_of = |(line, at): (&LineVotes, usize)| match places.bins[at * places.speeds + speed] {
                BEYOND => line.beyond,
                bin => line.of_level[usize::from(excess.frames[frame].levels[usize::from(bin)])],
            };
            let of_shaft: f32 = table.shaft.iter().zip(0..).map(vote_of).sum();
            let of_mesh: f32 = table.mesh.iter().zip(table.shaft.len()..).map(vote_of).sum();
            let of_shaft = if table.has_mesh() { (0.5 + 0.5 * of_shaft.exp()).ln() } else { of_shaft };
            assert!((together[frame][speed] - of_shaft - of_mesh).abs() < 1e-3);
        }
    }

    #[test]
    fn the_table_holds_the_votes() {
        let table = VoteTable::of(&RotorLines::of_blades(2));
        // what is left out of the sound votes neither for nor against
        assert!((1..=4).all(|order| table.vote(order, UNKNOWN) == 0.0));
        for excess in [0.05, 1.0, 7.0, 300.0] {
            let level = level_of(excess);
            let excess = 10f64.powf(level_db(f64::from(level)) / 10.0);
            let expected = (1.0 - BLADE_PASS_AUDIBLE + BLADE_PASS_AUDIBLE * ln_likelihood_ratio(excess).exp()).ln();
            let found = f64::from(table.shaft[1].of_level[usize::from(level)]);
            assert!((found - expected).abs() < 1e-5 * (1.0 + expected.abs()), "{excess}: {found} {expected}");
        }
    }
}
