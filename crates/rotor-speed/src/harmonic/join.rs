//! Blocks joined by phase: a shaft that turns does not jump from one block to the next.
//!
//! Each block's straight line of speed says where the shaft stands at its borders, as far as noise and a speed that bends within
//! it let it. The phases of all lines say how far the shaft really turned from the middle of one block to the middle of the
//! next. The step between the two lines at their border makes up for the difference: summed over blocks and steps, the turns
//! of a stretch are known as well as the shaft's angle at its two ends, however it wandered in between.

use super::block::{BlockFit, Cells};
use super::coherence::{Level, halved, likelihood_min, polished};
use super::line::Line;
use super::path::SpeedPath;
use realfft::num_complex::Complex;
use std::f64::consts::TAU;

/// So much of a stretch of sound says little at either end, where it fades in and out.
const FADED_S: f64 = 0.014;
/// A finer level is taken up to this much more variance: what noise does at the ends is known, what a bend does there is only known on
/// the mean over all blocks.
const FINER_RATIO: f64 = 2.5;
/// One or two steps say little of how steps scatter; at 95 % Student's t with two degrees of freedom asks for this.
const STEPS_FREEDOM_MIN: f64 = 0.4;
/// The step is looked for so many standard deviations around none …
const REACH_STDS: f64 = 6.0;
/// … and what a speed that bends within the block adds, as a phase of the lowest line.
const BEND_PHASE_RAD: f64 = 0.1;
/// Points of the search grid in a turn of the highest line's phase.
const GRID_PER_CYCLE: f64 = 12.0;
const NEWTON_STEPS: u32 = 6;
/// A second place for the step that is no less likely than this, as a logarithm of odds, leaves it unknown: so do lines that
/// do not agree on the first.
const ODDS_MIN: f64 = 6.0;

/// A block at the end of those that are joined.
#[derive(Clone, Copy)]
pub(crate) struct EndBlock {
    pub(crate) length_s: f64,
    pub(crate) speed_variance: f64,
    /// Whether the sound begins or ends there, so that it fades in or out.
    pub(crate) is_faded: bool,
}

impl EndBlock {
    /// Variance of the angle in the middle of the block, if the speed were known: one known to σ over a length T comes from an
    /// angle known to σ T / √12.
    fn middle_variance_turns2(&self) -> f64 {
        self.speed_variance * self.length_s * self.length_s / 12.0
    }

    /// Where the end lies from the middle of what is heard, over half the length of that.
    fn end_place(&self) -> f64 {
        let faded_s = if self.is_faded { FADED_S.min(self.length_s / 2.0) } else { 0.0 };
        (self.length_s + faded_s) / (self.length_s - faded_s)
    }

    /// Variance of the angle at the end: of a parabola through phases that scatter, or what steps between such ends show.
    fn end_variance_turns2(&self, step_variance: f64) -> f64 {
        let beyond = parabola_variance(self.end_place()) / parabola_variance(1.0);
        (parabola_variance(1.0) * self.middle_variance_turns2()).max(step_variance / 2.0) * beyond
    }
}

/// Variance of a parabola through evenly spread points, over that of their mean; at 1 is the end of the points (Legendre
/// polynomials).
fn parabola_variance(place: f64) -> f64 {
    let x2 = place * place;
    1.0 + 3.0 * x2 + 5.0 * (1.5 * x2 - 0.5).powi(2)
}

/// Variance of the turns over blocks that are joined by phase: that of the angle at the two ends. It is also that of a step
/// between two blocks, where one ends and the other begins. So the steps themselves tell how much more than noise there is:
/// a speed that bends within its block leaves the straight line at its ends.
pub(crate) fn joined_variance_turns2(ends: [EndBlock; 2], steps_turns: &[f64]) -> f64 {
    let squares: f64 = steps_turns.iter().map(|step| step * step).sum();
    // few steps may happen to be small: Student's t has this variance
    let of_steps = squares / (steps_turns.len() as f64 - 2.0).max(STEPS_FREEDOM_MIN);
    ends.iter().map(|end| end.end_variance_turns2(of_steps)).sum()
}

/// The level itself, or the finer one whose steps are smallest: a speed that bends within its blocks shows in them, and so does noise
/// where they are too short. The level as it came is the longest that straight lines explain, or nearly so.
pub(crate) fn joined(lines: &[Line], path: &SpeedPath, level: &Level) -> Level {
    let mut best = polished(lines, path, level);
    join(lines, path, &mut best);
    while let Some(variance) = turns_variance(&best, path.tick_s) {
        let mut finer = halved(lines, path, &best);
        join(lines, path, &mut finer);
        if finer.blocks.len() == best.blocks.len()
            || turns_variance(&finer, path.tick_s).is_none_or(|finer| finer >= FINER_RATIO * variance)
        {
            break;
        }
        best = finer;
    }
    best
}

/// Variance of the turns over a level; `None` where not all blocks are joined.
fn turns_variance(level: &Level, tick_s: f64) -> Option<f64> {
    let (first, last) = (level.blocks.first()?, level.blocks.last()?);
    let steps: Option<Vec<f64>> =
        level.blocks.iter().take(level.blocks.len() - 1).map(|block| block.step_to_next_turns).collect();
    let steps = steps.filter(|steps| !steps.is_empty())?;
    Some(joined_variance_turns2([first, last].map(|block| end_block(block, tick_s)), &steps))
}

fn end_block(block: &BlockFit, tick_s: f64) -> EndBlock {
    let length_s = (block.tick_to - block.tick_from) as f64 * tick_s;
    EndBlock { length_s, speed_variance: block.scatter / block.information, is_faded: true }
}

/// Writes into each block by how many turns the next one's line starts ahead of where its own ends, where phases say so.
fn join(lines: &[Line], path: &SpeedPath, level: &mut Level) {
    let threshold = likelihood_min(lines.len());
    let middles: Vec<Middle> = level.blocks.iter().map(|block| Middle::of(block, lines, path)).collect();
    let steps: Vec<Option<f64>> = level
        .blocks
        .windows(2)
        .zip(middles.windows(2))
        .map(|(blocks, middles)| {
            let are_heard = blocks.iter().all(|block| block.likelihood >= threshold);
            are_heard.then(|| step_between([&blocks[0], &blocks[1]], [&middles[0], &middles[1]], path))?
        })
        .collect();
    for (block, step) in level.blocks.iter_mut().zip(steps) {
        block.step_to_next_turns = step;
    }
}

/// What a block says of the shaft's angle in its middle.
struct Middle {
    /// Order, and sum of the line over the root of N V.
    sums: Vec<(f64, Complex<f64>)>,
    turns: f64,
}

impl Middle {
    fn of(block: &BlockFit, lines: &[Line], path: &SpeedPath) -> Self {
        let ticks = (block.tick_from, block.tick_to);
        let cells = Cells::new(lines, path, ticks, (block.speed_rev_s, block.slope_rev_s2));
        Self { sums: cells.line_sums(), turns: path.turns_at(block.middle_s(path.tick_s)) }
    }
}

fn step_between(blocks: [&BlockFit; 2], middles: [&Middle; 2], path: &SpeedPath) -> Option<f64> {
    let half_s = blocks.map(|block| (block.tick_to - block.tick_from) as f64 * path.tick_s / 2.0);
    // from the middle to the border, by each block's own line
    let after = half_s[0] * (blocks[0].speed_rev_s + blocks[0].slope_rev_s2 * half_s[0] / 2.0);
    let before = half_s[1] * (blocks[1].speed_rev_s - blocks[1].slope_rev_s2 * half_s[1] / 2.0);
    let along_path = (middles[1].turns - before) - (middles[0].turns + after);
    let lines: Vec<(f64, Complex<f64>)> = middles[0]
        .sums
        .iter()
        .zip(&middles[1].sums)
        .map(|((order, first), (_, second))| {
            let across = second * first.conj() * Complex::from_polar(1.0, TAU * (order * along_path).fract());
            (TAU * order, across)
        })
        .collect();
    let variance: f64 = blocks.iter().map(|block| end_block(block, path.tick_s).end_variance_turns2(0.0)).sum();
    most_likely_step(&lines, variance.sqrt())
}

/// The step δ with the greatest Σ Re(z exp(−j w δ)), if there is only one.
fn most_likely_step(lines: &[(f64, Complex<f64>)], std_turns: f64) -> Option<f64> {
    let (low, high) = lines.iter().fold((f64::INFINITY, 0.0f64), |(low, high), (w, _)| (low.min(*w), high.max(*w)));
    let likely_turns = std_turns + BEND_PHASE_RAD / low;
    // in a turn of the lowest line all that it can be has come up
    let reach = (REACH_STDS * likely_turns).min(TAU / low);
    let grid_step = TAU / high / GRID_PER_CYCLE;
    let points = (reach / grid_step).ceil() as i32;
    let mut turning: Vec<(Complex<f64>, Complex<f64>)> = lines
        .iter()
        .map(|(w, z)| {
            let first = Complex::from_polar(1.0, w * f64::from(points) * grid_step);
            (z * first, Complex::from_polar(1.0, -w * grid_step))
        })
        .collect();
    let values: Vec<f64> = (-points..=points)
        .map(|point| {
            let mut value = -(f64::from(point) * grid_step / likely_turns).powi(2) / 2.0;
            for (z, turn) in &mut turning {
                value += z.re;
                *z *= *turn;
            }
            value
        })
        .collect();
    let best = (0..values.len()).max_by(|&a, &b| values[a].total_cmp(&values[b]))?;
    let is_summit = |index: &usize| {
        values.get(index.wrapping_sub(1)).is_none_or(|v| *v <= values[*index])
            && values.get(index + 1).is_none_or(|v| *v <= values[*index])
    };
    let second = (0..values.len()).filter(|index| *index != best).filter(is_summit).map(|index| values[index]);
    if values[best] < second.fold(0.0, f64::max) + ODDS_MIN {
        return None;
    }
    let mut step = (best as i32 - points) as f64 * grid_step;
    for _ in 0..NEWTON_STEPS {
        let (gradient, curvature) = lines.iter().fold((0.0, 0.0), |(g, c), (w, z)| {
            let turned = z * Complex::from_polar(1.0, -w * step);
            (g + w * turned.im, c + w * w * turned.re)
        });
        if curvature <= 0.0 {
            break;
        }
        step += (gradient / curvature).clamp(-grid_step, grid_step);
    }
    Some(step)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_read_from_lines_that_agree_and_from_no_others() {
        let step = 1.7e-3;
        let orders = [69.0, 138.0, 207.0];
        let at = |order: f64, turns: f64| (TAU * order, Complex::from_polar(50.0, TAU * order * turns));
        let agreeing: Vec<_> = orders.iter().map(|&order| at(order, step)).collect();
        assert!((most_likely_step(&agreeing, 1e-3).unwrap() - step).abs() < 1e-12);
        let weak: Vec<_> = agreeing.iter().map(|(w, z)| (*w, z / 100.0)).collect();
        assert!(most_likely_step(&weak, 1e-3).is_none());
        // a line alone repeats itself every 1/207 turn
        assert!(most_likely_step(&[at(207.0, step)], 1e-3).is_none());
    }
}
