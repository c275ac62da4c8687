//! How long a block may be: as long as one straight line of speed explains what is heard.
//!
//! A rotor that holds its speed for seconds is measured best in one block, because uncertainty falls with the length to the
//! power of 1.5; one that wanders, or whose sound loses its phase in a room, needs short ones. Blocks from half a hop (0.04 s)
//! to the whole quantum are fitted, each level twice as long as the one before, and the level with the greatest evidence
//! is taken: the sum over its blocks of the likelihood, less what noise alone would give and five standard deviations of it.

use super::block::{BlockFit, Cells, best_on_grid, step_to_summit};
use super::line::Line;
use super::map::FRAME_HOPS;
use super::path::SpeedPath;
use hovertone_signal::channels::TICKS_PER_HOP;

/// What a block must explain beyond the noise to pay for its own parameters, in standard deviations of what noise gives.
const PENALTY_STDS: f64 = 5.0;
/// Phase errors below this do not count against a block, each time it is doubled: lines nearby that are not among the rotor's
/// own shake the phase of short blocks by as much.
const PHASE_TOLERANCE_RAD: f64 = 0.07;
/// Levels without a better one after which longer blocks are not tried.
const WORSE_LEVELS_MAX: u32 = 2;
/// The speed of a block is looked for this far from the first guess, in resolution cells of the highest line.
const FIRST_GUESS_CELLS: f64 = 3.0;
/// And this far from what shorter blocks say.
const NEXT_GUESS_CELLS: f64 = 2.0;
/// Points in a resolution cell when one line of speed is looked for in all blocks together.
const STRAIGHT_GRID_PER_CELL: f64 = 4.0;
const STRAIGHT_STEPS: u32 = 4;
/// How fast a hovering rotor changes its speed, as a share per second.
const SLOPE_STD_SHARE_PER_S: f64 = 0.1;

/// The blocks of one level.
#[derive(Clone, Debug)]
pub(crate) struct Level {
    pub(crate) blocks: Vec<BlockFit>,
    evidence: f64,
}

/// What a block of so many lines must reach to count as heard.
pub(crate) fn likelihood_min(lines: usize) -> f64 {
    // amplitude and phase of each line, and speed and slope: noise gives one for each pair, with a variance of one
    let pairs = lines as f64 + 1.0;
    pairs + PENALTY_STDS * pairs.sqrt()
}

impl Level {
    fn new(blocks: Vec<BlockFit>, lines: &[Line]) -> Self {
        let explained: f64 = blocks.iter().map(|block| block.in_phase).sum();
        // what noise gives: for each block and strong line a half (its phase), for each weak one 1 (amplitude too), and 1 for
        // speed and slope, each with as much variance
        let strong = lines.iter().filter(|line| line.is_strong).count() as f64;
        let free = blocks.len() as f64 * (lines.len() as f64 - strong / 2.0 + 1.0);
        let tolerated = PHASE_TOLERANCE_RAD.powi(2) * explained * (blocks.len() as f64).log2();
        Self { evidence: explained - free - PENALTY_STDS * free.sqrt() - tolerated, blocks }
    }

    /// Likelihood of all blocks.
    pub(crate) fn likelihood(&self) -> f64 {
        self.blocks.iter().map(|block| block.likelihood).sum()
    }

    /// The same, less what noise gives.
    pub(crate) fn likelihood_over_noise(&self, lines: usize) -> f64 {
        self.blocks.iter().map(|block| (block.likelihood - lines as f64 - 1.0).max(0.0)).sum()
    }

    /// Share of the blocks that stand out of the noise by so many times what they must.
    pub(crate) fn heard_share(&self, lines: usize, times: f64) -> f64 {
        let heard = self.blocks.iter().filter(|block| block.likelihood >= times * likelihood_min(lines)).count();
        heard as f64 / self.blocks.len().max(1) as f64
    }

    /// Times and speeds near both ends of every block that reaches a likelihood.
    pub(crate) fn points(&self, threshold: f64, tick_s: f64) -> Vec<(f64, f64)> {
        let heard = self.blocks.iter().filter(|block| block.likelihood >= threshold);
        heard
            .flat_map(|block| {
                let reach_s = 0.49 * (block.tick_to - block.tick_from) as f64 * tick_s;
                let middle_s = block.middle_s(tick_s);
                [middle_s - reach_s, middle_s + reach_s].map(|time_s| (time_s, block.speed_at(time_s, tick_s)))
            })
            .collect()
    }

    /// Whichever explains more.
    pub(crate) fn or_better(self, other: Self) -> Self {
        if other.evidence > self.evidence { other } else { self }
    }
}

/// Blocks of one hop each around a first guess of the path.
pub(crate) fn first_level(lines: &[Line], path: &SpeedPath) -> Level {
    let guess = |from: usize, to: usize| guess_from_path(path, from, to);
    level(lines, path, path.ticks().div_ceil(TICKS_PER_HOP), FIRST_GUESS_CELLS, guess)
}

/// The level with the greatest evidence, from a path that is already good and blocks of a hop around a rougher one.
///
/// Where one block for all explains more than those did, it is halved for as long as that helps; where not, blocks of a hop are
/// doubled for as long as that helps.
pub(crate) fn best_level(lines: &[Line], path: &SpeedPath, coarse: &Level) -> Level {
    let whole = level(lines, path, 1, NEXT_GUESS_CELLS, |from, to| guess_from_blocks(&coarse.blocks, path, from, to));
    if whole.evidence > coarse.evidence {
        return best_of(whole, |above| Some(halved(lines, path, above)));
    }
    doubled_level(lines, path)
}

/// The level with the greatest evidence, from blocks of a hop around a good path upwards.
pub(crate) fn doubled_level(lines: &[Line], path: &SpeedPath) -> Level {
    let hops = path.ticks().div_ceil(TICKS_PER_HOP);
    let single = level(lines, path, hops, 0.0, |from, to| guess_from_path(path, from, to));
    let half_hops = level(lines, path, 2 * hops, 0.0, |from, to| guess_from_blocks(&single.blocks, path, from, to));
    let doubled = |below: &Level| {
        let count = below.blocks.len().div_ceil(2);
        let guess = |from: usize, to: usize| guess_from_blocks(&below.blocks, path, from, to);
        (below.blocks.len() > 1).then(|| level(lines, path, count, 0.0, guess))
    };
    best_of(single, doubled).or_better(half_hops)
}

/// The best of a level and of those that follow it, each from the one before, until some are worse.
fn best_of(first: Level, next: impl Fn(&Level) -> Option<Level>) -> Level {
    let (mut best, mut last, mut worse) = (first.clone(), first, 0);
    while worse < WORSE_LEVELS_MAX
        && let Some(level) = next(&last)
    {
        worse = if level.evidence > best.evidence { 0 } else { worse + 1 };
        if worse == 0 {
            best = level.clone();
        }
        last = level;
    }
    best
}

/// One straight line of speed through the whole quantum, where single blocks are too weak to be heard: the sum of the
/// likelihoods of all blocks, each with phases of its own, as a function of one speed and one slope. The blocks are doubled
/// until there is one; each time the line is known well enough for the next, which resolves twice as finely.
pub(crate) fn straight_level(lines: &[Line], path: &SpeedPath) -> Level {
    let ticks = path.ticks();
    let middle_s = ticks as f64 / 2.0 * path.tick_s;
    let (mut speed, mut slope) = guess_from_path(path, 0, ticks);
    let mut count = ticks.div_ceil(FRAME_HOPS * TICKS_PER_HOP);
    let mut reach_cells = FIRST_GUESS_CELLS;
    loop {
        let blocks: Vec<(f64, Cells)> = (0..count)
            .map(|index| (border(ticks, index, count), border(ticks, index + 1, count)))
            .filter(|(from, to)| from < to)
            .map(|(from, to)| {
                let t = (from + to) as f64 / 2.0 * path.tick_s - middle_s;
                (t, Cells::new(lines, path, (from, to), (speed + slope * t, slope)))
            })
            .collect();
        let Some(cell) = blocks.first().map(|(_, cells)| cells.cell_rev_s()) else { break };
        let highest = best_on_grid(blocks.iter().map(|(_, cells)| cells), reach_cells, STRAIGHT_GRID_PER_CELL);
        let (offset, bend) = climbed(&blocks, highest, cell);
        (speed, slope) = (speed + offset, slope + bend);
        if count == 1 {
            break;
        }
        count = count.div_ceil(2);
        reach_cells = NEXT_GUESS_CELLS;
    }
    // a weak line may have been led astray with its slope: the one without is looked for as well
    let sloping = level(lines, path, 1, 0.0, |_, _| (speed, slope));
    let flat = level(lines, path, 1, FIRST_GUESS_CELLS, |_, _| (speed, 0.0));
    if flat.likelihood() > sloping.likelihood() { flat } else { sloping }
}

/// Newton's method on the sum of all blocks, from a point of the grid; steps that do not climb are not taken.
fn climbed(blocks: &[(f64, Cells)], offset: f64, cell: f64) -> (f64, f64) {
    let expansion = |offset: f64, bend: f64| {
        let (mut value, mut g, mut h) = (0.0, [0.0; 2], [0.0; 3]);
        for (t, cells) in blocks {
            let (of_block, gradient, second) = cells.expansion(offset + bend * t, bend);
            value += of_block;
            g[0] += gradient[0];
            g[1] += gradient[0] * t + gradient[1];
            h[0] += second[0];
            h[1] += second[0] * t + second[1];
            h[2] += second[0] * t * t + 2.0 * second[1] * t + second[2];
        }
        (value, g, h)
    };
    let mut place = (offset, 0.0);
    let (mut value, mut g, mut h) = expansion(place.0, place.1);
    for _ in 0..STRAIGHT_STEPS {
        let Some(step) = step_to_summit(g, h).filter(|step| step.0.abs() <= cell) else { break };
        let next = expansion(place.0 + step.0, place.1 + step.1);
        if next.0 <= value {
            break;
        }
        place = (place.0 + step.0, place.1 + step.1);
        (value, g, h) = next;
    }
    place
}

/// J of each line, over all blocks of a level.
pub(crate) fn line_likelihoods(lines: &[Line], path: &SpeedPath, level: &Level) -> Vec<f64> {
    let mut sums = vec![0.0; lines.len()];
    for block in &level.blocks {
        let cells = Cells::new(lines, path, (block.tick_from, block.tick_to), (block.speed_rev_s, block.slope_rev_s2));
        sums.iter_mut().zip(cells.line_likelihoods()).for_each(|(sum, likelihood)| *sum += likelihood);
    }
    sums
}

/// Blocks from the middle of each to the middle of the next, where both stand out of the noise: a block knows its speed best in its
/// middle, and these have theirs where the others end.
pub(crate) fn blocks_between(lines: &[Line], path: &SpeedPath, level: &Level) -> Vec<BlockFit> {
    let threshold = likelihood_min(lines.len());
    let pairs = level.blocks.windows(2).filter(|pair| pair.iter().all(|block| block.likelihood >= threshold));
    pairs
        .map(|pair| {
            let ticks = ((pair[0].tick_from + pair[0].tick_to) / 2, (pair[1].tick_from + pair[1].tick_to) / 2);
            let middle_s = (ticks.0 + ticks.1) as f64 / 2.0 * path.tick_s;
            let speeds = [0, 1].map(|index: usize| pair[index].speed_at(middle_s, path.tick_s));
            let apart_s = pair[1].middle_s(path.tick_s) - pair[0].middle_s(path.tick_s);
            let guess = ((speeds[0] + speeds[1]) / 2.0, (pair[1].speed_rev_s - pair[0].speed_rev_s) / apart_s);
            Cells::new(lines, path, ticks, guess).fit(ticks, 0.0, slope_std(guess.0))
        })
        .collect()
}

/// The same blocks once more, around themselves.
pub(crate) fn polished(lines: &[Line], path: &SpeedPath, level: &Level) -> Level {
    let blocks = level
        .blocks
        .iter()
        .map(|block| {
            let ticks = (block.tick_from, block.tick_to);
            let guess = (block.speed_rev_s, block.slope_rev_s2);
            Cells::new(lines, path, ticks, guess).fit(ticks, 0.0, slope_std(block.speed_rev_s))
        })
        .collect();
    Level::new(blocks, lines)
}

/// The next finer level, from what this one says.
pub(crate) fn halved(lines: &[Line], path: &SpeedPath, above: &Level) -> Level {
    let count = (2 * above.blocks.len()).min(path.ticks().div_ceil(TICKS_PER_HOP / 2));
    let line_at = |from: usize, to: usize| {
        let middle_s = (from + to) as f64 / 2.0 * path.tick_s;
        let of_block = |block: &&BlockFit| (block.middle_s(path.tick_s) - middle_s).abs();
        let nearest = above.blocks.iter().min_by(|a, b| of_block(a).total_cmp(&of_block(b)));
        nearest.map_or_else(
            || guess_from_path(path, from, to),
            |block| (block.speed_at(middle_s, path.tick_s), block.slope_rev_s2),
        )
    };
    level(lines, path, count, 0.0, line_at)
}

fn level(
    lines: &[Line],
    path: &SpeedPath,
    count: usize,
    grid_cells: f64,
    guess: impl Fn(usize, usize) -> (f64, f64),
) -> Level {
    let blocks = (0..count)
        .map(|index| (border(path.ticks(), index, count), border(path.ticks(), index + 1, count)))
        .filter(|(from, to)| from < to)
        .map(|(from, to)| {
            let guess = guess(from, to);
            Cells::new(lines, path, (from, to), guess).fit((from, to), grid_cells, slope_std(guess.0))
        })
        .collect();
    Level::new(blocks, lines)
}

/// Start of a block among so many: between half hops, so that blocks of all levels hold the same ones.
fn border(ticks: usize, index: usize, count: usize) -> usize {
    let half_hop = TICKS_PER_HOP / 2;
    let halves = ticks.div_ceil(half_hop);
    if index == count { ticks } else { (index * halves + count / 2) / count * half_hop }
}

fn slope_std(speed_rev_s: f64) -> f64 {
    SLOPE_STD_SHARE_PER_S * speed_rev_s
}

fn guess_from_path(path: &SpeedPath, from: usize, to: usize) -> (f64, f64) {
    let speed = (path.speed_rev_s(from) + path.speed_rev_s(to)) / 2.0;
    (speed, (path.speed_rev_s(to) - path.speed_rev_s(from)) / ((to - from) as f64 * path.tick_s))
}

/// The straight line through shorter blocks, each counting for what it knows.
fn guess_from_blocks(blocks: &[BlockFit], path: &SpeedPath, from: usize, to: usize) -> (f64, f64) {
    let tick_s = path.tick_s;
    let middle_s = (from + to) as f64 / 2.0 * tick_s;
    let within: Vec<&BlockFit> = blocks.iter().filter(|block| block.tick_to > from && block.tick_from < to).collect();
    if let [only] = within[..] {
        return (only.speed_at(middle_s, tick_s), only.slope_rev_s2);
    }
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
    if determinant > 1e-12 * w * w {
        ((wtt * wn - wt * wnt) / determinant, (w * wnt - wt * wn) / determinant)
    } else {
        guess_from_path(path, from, to)
    }
}
