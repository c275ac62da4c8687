//! Chunk → blocks: a block is as long as one straight line of speed explains the sound.
//!
//! A longer block knows its speed better, because the uncertainty falls with the length to the power 1.5. But where the speed wanders,
//! or a room disturbs the phases, one straight line explains a short block alone. So a chunk is divided into blocks of nearly equal
//! length: a *partition*. Block lengths from half a hop (0.04 s) to the whole chunk are tried, each twice the last, and the partition
//! with the greatest evidence is taken: the sum over its blocks of the log likelihood, less the expectation and five standard
//! deviations of the value that noise alone gives.

use super::block::{
    BlockFit, BlockSlices, Expansion, HALF_HOP_TICKS, LineSum, SpeedLine, best_on_grid, step_to_summit,
};
use super::demodulation::Line;
use super::speed_map::FRAME_HOPS;
use super::speed_path::{SpeedPath, SpeedPoint};
use crate::thresholds::SEARCHED_NOISE_STDS_MAX;
use hovertone_signal::channels::TICKS_PER_HOP;
use std::ops::Range;

/// Likelihood that a block must add beyond noise to pay for its own parameters, in standard deviations of the likelihood of noise.
const PENALTY_STDS: f64 = SEARCHED_NOISE_STDS_MAX;
/// Phase error, rad, that does not count against a block, for each time that its length doubles: lines that do not belong to the
/// rotor disturb the phases of short blocks by as much. *Decision.*
const PHASE_TOLERANCE_RAD: f64 = 0.07;
/// Number of partitions in sequence without greater evidence that ends the search. *Numeric.*
const WORSE_PARTITIONS_MAX: u32 = 2;
/// Half width of the search for the speed of a block around the first guess, in resolution cells of the highest line. *Numeric.*
const FIRST_GUESS_CELLS: f64 = 3.0;
/// The same around the guess from shorter blocks. *Numeric.*
const NEXT_GUESS_CELLS: f64 = 2.0;
/// Grid points in a resolution cell, in the search for one line of speed through all blocks. *Numeric.*
const STRAIGHT_GRID_PER_CELL: f64 = 4.0;
/// Largest number of steps of Newton's method in that search. *Numeric.*
const STRAIGHT_STEPS: u32 = 4;
/// Distance of the two points of a block from its middle, as a share of its length: just inside its ends, so that the points of
/// neighbouring blocks keep their order in time. *Numeric.*
const END_POINT_SHARE: f64 = 0.49;
/// Smallest determinant of the normal equations of a straight line, relative to the square of its weights: below, the times do not
/// determine a slope. *Numeric.*
const DETERMINANT_MIN: f64 = 1e-12;

/// A division of a chunk into blocks of nearly equal length.
#[derive(Clone, Debug)]
pub(crate) struct Partition {
    /// The blocks in order of time.
    pub(crate) blocks: Vec<BlockFit>,
    evidence: f64,
}

/// Smallest likelihood of a block with a number of lines that stands out of the noise.
pub(crate) fn likelihood_min(lines: usize) -> f64 {
    // Noise gives 1, with variance 1, for each pair of parameters: amplitude and phase of each line, speed and slope.
    let pairs = lines as f64 + 1.0;
    pairs + PENALTY_STDS * pairs.sqrt()
}

impl Partition {
    fn new(blocks: Vec<BlockFit>, lines: &[Line]) -> Self {
        let explained: f64 = blocks.iter().map(|block| block.phase_likelihood).sum();
        // In each block, noise gives 1/2 for a strong line (phase), 1 for a weak line (amplitude and phase), and 1 for speed and
        // slope, each with an equal variance.
        let strong = lines.iter().filter(|line| line.is_strong).count() as f64;
        let free = blocks.len() as f64 * (lines.len() as f64 - strong / 2.0 + 1.0);
        let tolerated = PHASE_TOLERANCE_RAD.powi(2) * explained * (blocks.len() as f64).log2();
        Self { evidence: explained - free - PENALTY_STDS * free.sqrt() - tolerated, blocks }
    }

    /// Likelihood of all blocks.
    pub(crate) fn likelihood(&self) -> f64 {
        self.blocks.iter().map(|block| block.likelihood).sum()
    }

    /// Likelihood of the blocks that stand out of the noise.
    pub(crate) fn likelihood_of_heard(&self, lines: usize) -> f64 {
        self.blocks.iter().map(|block| block.likelihood).filter(|&it| it >= likelihood_min(lines)).sum()
    }

    /// Likelihood of all blocks, less the expectation for noise.
    pub(crate) fn likelihood_over_noise(&self, lines: usize) -> f64 {
        self.blocks.iter().map(|block| (block.likelihood - lines as f64 - 1.0).max(0.0)).sum()
    }

    /// Share of the blocks whose likelihood is `times` the likelihood that stands out of the noise, or more.
    pub(crate) fn heard_share(&self, lines: usize, times: f64) -> f64 {
        let heard = self.blocks.iter().filter(|block| block.likelihood >= times * likelihood_min(lines)).count();
        heard as f64 / self.blocks.len().max(1) as f64
    }

    /// Speeds near both ends of each block whose likelihood reaches the threshold.
    pub(crate) fn points(&self, threshold: f64, tick_s: f64) -> Vec<SpeedPoint> {
        let heard = self.blocks.iter().filter(|block| block.likelihood >= threshold);
        heard
            .flat_map(|block| {
                let reach_s = END_POINT_SHARE * (block.tick_to - block.tick_from) as f64 * tick_s;
                let middle_s = block.middle_s(tick_s);
                [middle_s - reach_s, middle_s + reach_s]
                    .map(|time_s| SpeedPoint { time_s, speed_rev_s: block.speed_at(time_s, tick_s) })
            })
            .collect()
    }

    /// This partition, or the other one if its evidence is greater.
    pub(crate) fn or_better(self, other: Self) -> Self {
        if other.evidence > self.evidence { other } else { self }
    }
}

/// Blocks of one hop each, around a first guess of the path.
pub(crate) fn first_partition(lines: &[Line], path: &SpeedPath) -> Partition {
    let guess = |ticks: Range<usize>| guess_from_path(path, ticks);
    partition(lines, path, path.ticks().div_ceil(TICKS_PER_HOP), FIRST_GUESS_CELLS, guess)
}

/// The partition with the greatest evidence, from a good path and from `coarse`: blocks of a hop around a rougher path.
///
/// Where one block for the whole chunk has greater evidence than `coarse`, block lengths are halved from there; otherwise they are
/// doubled from one hop. Either ends where the evidence no longer rises.
pub(crate) fn best_partition(lines: &[Line], path: &SpeedPath, coarse: &Partition) -> Partition {
    let whole = partition(lines, path, 1, NEXT_GUESS_CELLS, |ticks| guess_from_blocks(&coarse.blocks, path, ticks));
    if whole.evidence > coarse.evidence {
        return best_of(whole, |longer| {
            let guess = |ticks: Range<usize>| guess_from_longer(longer, path, ticks);
            Some(partition(lines, path, half_lengths(path, longer), 0.0, guess))
        });
    }
    doubled_partition(lines, path)
}

/// The partition with the greatest evidence, from blocks of half a hop and of a hop around a good path upwards.
pub(crate) fn doubled_partition(lines: &[Line], path: &SpeedPath) -> Partition {
    let hops = path.ticks().div_ceil(TICKS_PER_HOP);
    let single = partition(lines, path, hops, 0.0, |ticks| guess_from_path(path, ticks));
    let half_hops = partition(lines, path, 2 * hops, 0.0, |ticks| guess_from_blocks(&single.blocks, path, ticks));
    let doubled = |shorter: &Partition| {
        let count = shorter.blocks.len().div_ceil(2);
        let guess = |ticks: Range<usize>| guess_from_blocks(&shorter.blocks, path, ticks);
        (shorter.blocks.len() > 1).then(|| partition(lines, path, count, 0.0, guess))
    };
    best_of(single, doubled).or_better(half_hops)
}

/// The best of a partition and its successors, each made from the last, until several in sequence are worse.
fn best_of(first: Partition, next: impl Fn(&Partition) -> Option<Partition>) -> Partition {
    let (mut best, mut last, mut worse) = (first.clone(), first, 0);
    while worse < WORSE_PARTITIONS_MAX
        && let Some(partition) = next(&last)
    {
        worse = if partition.evidence > best.evidence { 0 } else { worse + 1 };
        if worse == 0 {
            best = partition.clone();
        }
        last = partition;
    }
    best
}

/// A block, and the time of its middle from the middle of the chunk.
struct TimedBlock {
    t: f64,
    slices: BlockSlices,
}

/// One block for the whole chunk, where single blocks are too weak to be heard.
///
/// Its line of speed is the maximum of the sum of the likelihoods of shorter blocks, each with phases of its own, over one speed and one
/// slope. The block length is doubled until one block is left: each length determines the line well enough for the next, which resolves
/// it twice as finely.
pub(crate) fn straight_partition(lines: &[Line], path: &SpeedPath) -> Partition {
    let ticks = path.ticks();
    let middle_s = ticks as f64 / 2.0 * path.tick_s;
    let mut line = guess_from_path(path, 0..ticks);
    let mut count = ticks.div_ceil(FRAME_HOPS * TICKS_PER_HOP);
    let mut reach_cells = FIRST_GUESS_CELLS;
    loop {
        let blocks: Vec<TimedBlock> = block_ticks(ticks, count)
            .map(|ticks| {
                let t = (ticks.start + ticks.end) as f64 / 2.0 * path.tick_s - middle_s;
                let guess = SpeedLine { speed_rev_s: line.speed_rev_s + line.slope_rev_s2 * t, ..line };
                TimedBlock { t, slices: BlockSlices::new(lines, path, ticks, guess) }
            })
            .collect();
        let Some(cell) = blocks.first().map(|block| block.slices.cell_rev_s()) else { break };
        let highest = best_on_grid(blocks.iter().map(|block| &block.slices), reach_cells, STRAIGHT_GRID_PER_CELL);
        let climbed = climbed(&blocks, highest, cell);
        line.speed_rev_s += climbed.speed_rev_s;
        line.slope_rev_s2 += climbed.slope_rev_s2;
        if count == 1 {
            break;
        }
        count = count.div_ceil(2);
        reach_cells = NEXT_GUESS_CELLS;
    }
    // noise may have led the slope of a weak line astray: the best line without a slope is tried as well
    let sloping = partition(lines, path, 1, 0.0, |_| line);
    let flat = partition(lines, path, 1, FIRST_GUESS_CELLS, |_| SpeedLine { slope_rev_s2: 0.0, ..line });
    if flat.likelihood() > sloping.likelihood() { flat } else { sloping }
}

/// Newton's method on the summed likelihood of blocks, from a difference of speed. It ends at a step that does not climb. Returns the
/// differences of speed and slope from the guess.
fn climbed(blocks: &[TimedBlock], d_speed: f64, cell_rev_s: f64) -> SpeedLine {
    let expansion = |place: SpeedLine| {
        let mut sum = Expansion { value: 0.0, gradient: [0.0; 2], second: [0.0; 3] };
        for TimedBlock { t, slices } in blocks {
            let Expansion { value, gradient, second } =
                slices.expansion(place.speed_rev_s + place.slope_rev_s2 * t, place.slope_rev_s2);
            sum.value += value;
            sum.gradient[0] += gradient[0];
            sum.gradient[1] += gradient[0] * t + gradient[1];
            sum.second[0] += second[0];
            sum.second[1] += second[0] * t + second[1];
            sum.second[2] += second[0] * t * t + 2.0 * second[1] * t + second[2];
        }
        sum
    };
    let mut place = SpeedLine { speed_rev_s: d_speed, slope_rev_s2: 0.0 };
    let mut here = expansion(place);
    for _ in 0..STRAIGHT_STEPS {
        let Some(step) = step_to_summit(here.gradient, here.second).filter(|step| step.0.abs() <= cell_rev_s) else {
            break;
        };
        let next_place =
            SpeedLine { speed_rev_s: place.speed_rev_s + step.0, slope_rev_s2: place.slope_rev_s2 + step.1 };
        let next = expansion(next_place);
        if next.value <= here.value {
            break;
        }
        (place, here) = (next_place, next);
    }
    place
}

/// Blocks from the middle of each block to the middle of the next, where both stand out of the noise. A block knows its speed best in
/// its middle, and the middle of these blocks lies where the others meet.
pub(crate) fn blocks_between(lines: &[Line], path: &SpeedPath, partition: &Partition) -> Vec<BlockFit> {
    let threshold = likelihood_min(lines.len());
    let pairs = partition.blocks.windows(2).filter(|pair| pair.iter().all(|block| block.likelihood >= threshold));
    pairs
        .map(|pair| {
            let ticks = (pair[0].tick_from + pair[0].tick_to) / 2..(pair[1].tick_from + pair[1].tick_to) / 2;
            let middle_s = (ticks.start + ticks.end) as f64 / 2.0 * path.tick_s;
            let speeds = [0, 1].map(|index: usize| pair[index].speed_at(middle_s, path.tick_s));
            let apart_s = pair[1].middle_s(path.tick_s) - pair[0].middle_s(path.tick_s);
            let guess = SpeedLine {
                speed_rev_s: (speeds[0] + speeds[1]) / 2.0,
                slope_rev_s2: (pair[1].speed_rev_s - pair[0].speed_rev_s) / apart_s,
            };
            BlockSlices::new(lines, path, ticks, guess).fit(0.0)
        })
        .collect()
}

/// A partition, and the sums of the lines of each of its blocks.
pub(crate) struct PartitionWithSums {
    pub(crate) partition: Partition,
    pub(crate) sums: Vec<Vec<LineSum>>,
}

/// The same blocks, fitted again from their own speeds.
pub(crate) fn polished(lines: &[Line], path: &SpeedPath, partition: &Partition) -> PartitionWithSums {
    let blocks = partition.blocks.iter();
    with_sums(lines, blocks.map(|block| BlockSlices::new(lines, path, block.ticks(), block.speed_line())))
}

/// Blocks of half the length, from the speeds of the longer ones.
pub(crate) fn halved(lines: &[Line], path: &SpeedPath, longer: &Partition) -> PartitionWithSums {
    let blocks = block_ticks(path.ticks(), half_lengths(path, longer));
    with_sums(
        lines,
        blocks.map(|ticks| BlockSlices::new(lines, path, ticks.clone(), guess_from_longer(longer, path, ticks))),
    )
}

fn with_sums(lines: &[Line], blocks: impl Iterator<Item = BlockSlices>) -> PartitionWithSums {
    let (blocks, sums) = blocks.map(|block| block.fit_with_sums()).unzip();
    PartitionWithSums { partition: Partition::new(blocks, lines), sums }
}

/// The number of blocks of half the length.
fn half_lengths(path: &SpeedPath, longer: &Partition) -> usize {
    (2 * longer.blocks.len()).min(path.ticks().div_ceil(HALF_HOP_TICKS))
}

/// The line of speed of the nearest of some longer blocks.
fn guess_from_longer(longer: &Partition, path: &SpeedPath, ticks: Range<usize>) -> SpeedLine {
    let middle_s = (ticks.start + ticks.end) as f64 / 2.0 * path.tick_s;
    let distance = |block: &&BlockFit| (block.middle_s(path.tick_s) - middle_s).abs();
    let nearest = longer.blocks.iter().min_by(|a, b| distance(a).total_cmp(&distance(b)));
    nearest.map_or_else(
        || guess_from_path(path, ticks),
        |block| SpeedLine { speed_rev_s: block.speed_at(middle_s, path.tick_s), ..block.speed_line() },
    )
}

/// A partition into `count` blocks, each fitted around its guess on a grid of `grid_cells` resolution cells to either side.
fn partition(
    lines: &[Line],
    path: &SpeedPath,
    count: usize,
    grid_cells: f64,
    guess: impl Fn(Range<usize>) -> SpeedLine,
) -> Partition {
    let blocks = block_ticks(path.ticks(), count)
        .map(|ticks| BlockSlices::new(lines, path, ticks.clone(), guess(ticks)).fit(grid_cells))
        .collect();
    Partition::new(blocks, lines)
}

/// The ticks of each of `count` blocks; empty blocks are left out.
fn block_ticks(ticks: usize, count: usize) -> impl Iterator<Item = Range<usize>> {
    (0..count)
        .map(move |index| border(ticks, index, count)..border(ticks, index + 1, count))
        .filter(|ticks| !ticks.is_empty())
}

/// First tick of a block. Borders lie between half hops, so that blocks of all lengths consist of the same half hops.
fn border(ticks: usize, index: usize, count: usize) -> usize {
    let halves = ticks.div_ceil(HALF_HOP_TICKS);
    if index == count { ticks } else { (index * halves + count / 2) / count * HALF_HOP_TICKS }
}

/// The straight line between the ends of a part of the path.
fn guess_from_path(path: &SpeedPath, ticks: Range<usize>) -> SpeedLine {
    let (from, to) = (ticks.start, ticks.end);
    SpeedLine {
        speed_rev_s: (path.speed_rev_s(from) + path.speed_rev_s(to)) / 2.0,
        slope_rev_s2: (path.speed_rev_s(to) - path.speed_rev_s(from)) / ((to - from) as f64 * path.tick_s),
    }
}

/// The straight line through the speeds of shorter blocks: least squares, weighted by their information.
fn guess_from_blocks(blocks: &[BlockFit], path: &SpeedPath, ticks: Range<usize>) -> SpeedLine {
    let tick_s = path.tick_s;
    let middle_s = (ticks.start + ticks.end) as f64 / 2.0 * tick_s;
    let within: Vec<&BlockFit> =
        blocks.iter().filter(|block| block.tick_to > ticks.start && block.tick_from < ticks.end).collect();
    if let [only] = within[..] {
        return SpeedLine { speed_rev_s: only.speed_at(middle_s, tick_s), ..only.speed_line() };
    }
    // sums of weight w, time t and speed n
    let (mut w, mut wt, mut wtt, mut wn, mut wnt) = (0.0, 0.0, 0.0, 0.0, 0.0);
    for block in within {
        let (weight, t) = (block.information, block.middle_s(tick_s) - middle_s);
        w += weight;
        wt += weight * t;
        wtt += weight * t * t;
        wn += weight * block.speed_rev_s;
        wnt += weight * t * block.speed_rev_s;
    }
    let determinant = w * wtt - wt * wt;
    if determinant > DETERMINANT_MIN * w * w {
        SpeedLine { speed_rev_s: (wtt * wn - wt * wnt) / determinant, slope_rev_s2: (w * wnt - wt * wn) / determinant }
    } else {
        guess_from_path(path, ticks)
    }
}
