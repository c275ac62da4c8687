//! Blocks joined by phase: the angle of a shaft is continuous, so it does not jump from one block to the next.
//!
//! The line of speed of each block predicts the angle of the shaft at the borders of the block, up to noise and to curvature of the
//! speed within the block. The phases of all lines tell by how much the shaft turned from the middle of one block to the middle of
//! the next. The difference of the two is a *step* at the border. With these steps, the number of turns over many blocks is as
//! certain as the angle of the shaft at both ends, however the speed varied in between.

use super::block::{BlockFit, LineSum};
use super::demodulation::Line;
use super::partition::{Partition, PartitionWithSums, halved, likelihood_min, polished};
use super::phasors::small_turn;
use super::speed_path::SpeedPath;
use realfft::num_complex::Complex;
use std::f64::consts::TAU;

/// Time at either end of a stretch of sound that tells little, because the sound fades in and out, s. Of the answers to wandering simulated
/// rotors, 2 u hold in 94 % with 0.007 s, in 97 % with 0.009 s and in 99 % with 0.014 s. *Decision.*
const FADED_S: f64 = 0.008;
/// Largest ratio of variances at which shorter blocks replace longer ones: the noise at the ends of the blocks is known, but the
/// curvature of the speed there is known on average alone. Best of three values tried on wandering simulated rotors. *Decision.*
const FINER_RATIO: f64 = 2.5;
/// Smallest number of degrees of freedom of the scatter of the steps. For two steps, √(2 / 0.4) = 2.2 is the ratio of the 95 % limits of
/// Student's t distribution with two degrees of freedom (4.3) and of the normal distribution (1.96). *Numeric.*
const STEPS_FREEDOM_MIN: f64 = 0.4;
/// Half width of the search for a step, in standard deviations of the step. *Numeric.*
const REACH_STDS: f64 = 6.0;
/// Phase of the lowest line that curvature of the speed within a block may add to a step, rad. *Decision.*
const BEND_PHASE_RAD: f64 = 0.1;
/// Points of the search grid in a cycle of the highest line. *Numeric.*
const GRID_PER_CYCLE: f64 = 12.0;
/// Change that is Newton's last one, in steps of the grid: the next one would be below 1e-6 of them. *Numeric.*
const LAST_CHANGE_GRID_STEPS: f64 = 1e-3;
/// Most steps of Newton's method from the best grid point. *Numeric.*
const NEWTON_STEPS: u32 = 6;
/// Smallest log odds of the most likely step over the second: below, and where the lines do not agree, the step stays unknown.
/// *Decision.*
const ODDS_MIN: f64 = 6.0;

/// The first or last of the blocks that are joined.
#[derive(Clone, Copy)]
pub(crate) struct EndBlock {
    pub(crate) length_s: f64,
    pub(crate) speed_variance: f64,
    /// Whether the sound begins or ends here, so that it fades in or out.
    pub(crate) is_faded: bool,
}

impl EndBlock {
    /// Variance of the angle in the middle of the block for a known speed, turns². A speed with the standard deviation σ over a length T
    /// comes from angles whose mean has the standard deviation σ T / √12.
    fn middle_variance_turns2(&self) -> f64 {
        self.speed_variance * self.length_s * self.length_s / 12.0
    }

    /// Distance of the end from the middle of the audible part, over half the length of this part.
    fn end_place(&self) -> f64 {
        let faded_s = if self.is_faded { FADED_S.min(self.length_s / 2.0) } else { 0.0 };
        (self.length_s + faded_s) / (self.length_s - faded_s)
    }

    /// Variance of the angle at the end, turns²: of a parabola through phases with noise, or half the variance of the steps, whichever is
    /// greater.
    fn end_variance_turns2(&self, step_variance: f64) -> f64 {
        let beyond = parabola_variance(self.end_place()) / parabola_variance(1.0);
        (parabola_variance(1.0) * self.middle_variance_turns2()).max(step_variance / 2.0) * beyond
    }
}

/// Variance at a place x of a parabola fitted to evenly spread points on −1 … 1, over the variance of their mean:
/// 1 + 3 P₁² + 5 P₂² with the Legendre polynomials P₁ = x and P₂ = (3x² − 1) / 2.
fn parabola_variance(place: f64) -> f64 {
    let x2 = place * place;
    1.0 + 3.0 * x2 + 5.0 * ((3.0 * x2 - 1.0) / 2.0).powi(2)
}

/// Variance of the number of turns over blocks that are joined by phase, turns²: the sum of the variances of the angle at both ends.
///
/// A step has the variance of two ends as well, because it lies where one block ends and the next begins. So the scatter of the steps
/// contains the curvature of the speed within the blocks, in addition to noise.
pub(crate) fn joined_variance_turns2(ends: [EndBlock; 2], steps_turns: &[f64]) -> f64 {
    let squares: f64 = steps_turns.iter().map(|step| step * step).sum();
    // Few steps may be small by chance: Student's t distribution for n steps has the variance (squares / n) n / (n − 2).
    let of_steps = squares / (steps_turns.len() as f64 - 2.0).max(STEPS_FREEDOM_MIN);
    ends.iter().map(|end| end.end_variance_turns2(of_steps)).sum()
}

/// The blocks of a partition joined by phase, or shorter blocks whose turns have a smaller variance, or one not much greater.
///
/// Steps grow with the curvature of the speed where blocks are long, and with noise where they are short. The given partition has about
/// the longest blocks that straight lines of speed explain.
pub(crate) fn joined(lines: &[Line], path: &SpeedPath, partition: &Partition) -> Partition {
    let mut best = with_steps(path, polished(lines, path, partition));
    while let Some(variance) = turns_variance(&best, path.tick_s) {
        let finer = with_steps(path, halved(lines, path, &best));
        if finer.blocks.len() == best.blocks.len()
            || turns_variance(&finer, path.tick_s).is_none_or(|finer| finer >= FINER_RATIO * variance)
        {
            break;
        }
        best = finer;
    }
    best
}

/// Variance of the turns over a partition, turns². `None` where a step is unknown or there is none.
fn turns_variance(partition: &Partition, tick_s: f64) -> Option<f64> {
    let (first, last) = (partition.blocks.first()?, partition.blocks.last()?);
    let steps: Option<Vec<f64>> =
        partition.blocks.iter().take(partition.blocks.len() - 1).map(|block| block.step_to_next_turns).collect();
    let steps = steps.filter(|steps| !steps.is_empty())?;
    Some(joined_variance_turns2([first, last].map(|block| end_block(block, tick_s)), &steps))
}

fn end_block(block: &BlockFit, tick_s: f64) -> EndBlock {
    let length_s = (block.tick_to - block.tick_from) as f64 * tick_s;
    EndBlock { length_s, speed_variance: block.phase_scatter / block.information, is_faded: true }
}

/// The partition with the step to the next block in each block, where the phases determine it.
fn with_steps(path: &SpeedPath, joined: PartitionWithSums) -> Partition {
    let PartitionWithSums { mut partition, sums } = joined;
    let steps: Vec<Option<f64>> = partition
        .blocks
        .windows(2)
        .zip(sums.windows(2))
        .map(|(blocks, sums)| {
            let are_heard = blocks.iter().zip(sums).all(|(block, sums)| block.likelihood >= likelihood_min(sums.len()));
            are_heard.then(|| step_between([&blocks[0], &blocks[1]], [&sums[0], &sums[1]], path))?
        })
        .collect();
    for (block, step) in partition.blocks.iter_mut().zip(steps) {
        block.step_to_next_turns = step;
    }
    partition
}

/// Evidence of one line on a step: its phase advances by `rad_per_turn` times the step, and `product` is its sum in the second block
/// times the conjugate of its sum in the first, without the advance that the lines of speed predict.
struct StepLine {
    rad_per_turn: f64,
    product: Complex<f64>,
}

/// The step between two blocks, from the sums of their lines, which are referred to the angle of the path in the middle of each block.
fn step_between(blocks: [&BlockFit; 2], sums: [&[LineSum]; 2], path: &SpeedPath) -> Option<f64> {
    let turns = blocks.map(|block| path.turns_at(block.middle_s(path.tick_s)));
    let half_s = blocks.map(|block| (block.tick_to - block.tick_from) as f64 * path.tick_s / 2.0);
    // turns from the middle of each block to the border, by its own line of speed
    let after = half_s[0] * (blocks[0].speed_rev_s + blocks[0].slope_rev_s2 * half_s[0] / 2.0);
    let before = half_s[1] * (blocks[1].speed_rev_s - blocks[1].slope_rev_s2 * half_s[1] / 2.0);
    let along_path = (turns[1] - before) - (turns[0] + after);
    let lines: Vec<StepLine> = sums[0]
        .iter()
        .zip(sums[1])
        .map(|(LineSum { order, sum: first }, LineSum { sum: second, .. })| StepLine {
            rad_per_turn: TAU * order,
            product: second * first.conj() * cycles(order * along_path),
        })
        .collect();
    let variance: f64 = blocks.iter().map(|block| end_block(block, path.tick_s).end_variance_turns2(0.0)).sum();
    most_likely_step(&lines, variance.sqrt())
}

/// The step δ with the greatest log likelihood Σ Re(z exp(−j w δ)) − δ² / 2σ², with z the product and w the phase per turn of each line.
/// `None` where a second maximum is nearly as likely.
fn most_likely_step(lines: &[StepLine], std_turns: f64) -> Option<f64> {
    let (low, high) = lines
        .iter()
        .map(|line| line.rad_per_turn)
        .fold((f64::INFINITY, 0.0f64), |(low, high), w| (low.min(w), high.max(w)));
    let likely_turns = std_turns + BEND_PHASE_RAD / low;
    // the likelihood of the lowest line repeats itself after one cycle
    let reach = (REACH_STDS * likely_turns).min(TAU / low);
    let grid_step = TAU / high / GRID_PER_CYCLE;
    let points = (reach / grid_step).ceil() as i32;
    let values = step_likelihoods(lines, likely_turns, grid_step, points);
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
        let (gradient, curvature) = lines.iter().fold((0.0, 0.0), |(g, c), StepLine { rad_per_turn: w, product }| {
            let turned = product * cycles(-w * step / TAU);
            (g + w * turned.im, c + w * w * turned.re)
        });
        if curvature <= 0.0 {
            break;
        }
        let change = (gradient / curvature).clamp(-grid_step, grid_step);
        step += change;
        if change.abs() < LAST_CHANGE_GRID_STEPS * grid_step {
            break;
        }
    }
    Some(step)
}

/// `exp(j 2π cycles)`.
fn cycles(cycles: f64) -> Complex<f64> {
    small_turn(TAU * (cycles - cycles.round()))
}

/// Log likelihood of each step on a grid of `points` points to either side of 0.
fn step_likelihoods(lines: &[StepLine], std_turns: f64, grid_step: f64, points: i32) -> Vec<f64> {
    let mut sums = vec![[0.0; 4]; (2 * points + 1) as usize];
    for lines in lines.chunks(4) {
        let mut four = FourLines::default();
        for (lane, StepLine { rad_per_turn: w, product }) in lines.iter().enumerate() {
            four.set(lane, product * cycles(w * f64::from(points) * grid_step / TAU), cycles(-w * grid_step / TAU));
        }
        // all points of four lines, which stay in the registers of the processor
        sums.iter_mut().for_each(|sums| four.add_and_turn(sums));
    }
    let prior_nats = |point: i32| (f64::from(point) * grid_step / std_turns).powi(2) / 2.0;
    (-points..=points).zip(sums).map(|(point, sums)| sums.iter().sum::<f64>() - prior_nats(point)).collect()
}

/// Four complex numbers that turn, each by a step of its own, with real and imaginary parts apart: the processor computes them in parallel.
#[derive(Clone, Copy, Default)]
struct FourLines {
    re: [f64; 4],
    im: [f64; 4],
    step_re: [f64; 4],
    step_im: [f64; 4],
}

impl FourLines {
    fn set(&mut self, lane: usize, z: Complex<f64>, step: Complex<f64>) {
        (self.re[lane], self.im[lane]) = (z.re, z.im);
        (self.step_re[lane], self.step_im[lane]) = (step.re, step.im);
    }

    /// Adds the real parts to `sums`, and turns all by their steps.
    fn add_and_turn(&mut self, sums: &mut [f64; 4]) {
        let steps = self.step_re.iter().zip(&self.step_im);
        for (((re, im), (step_re, step_im)), sum) in self.re.iter_mut().zip(&mut self.im).zip(steps).zip(sums) {
            *sum += *re;
            (*re, *im) = (*re * step_re - *im * step_im, *re * step_im + *im * step_re);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_is_found_from_lines_that_agree_and_from_no_others() {
        let step = 1.7e-3;
        let orders = [69.0, 138.0, 207.0];
        let at = |order: f64, turns: f64| StepLine {
            rad_per_turn: TAU * order,
            product: Complex::from_polar(50.0, TAU * order * turns),
        };
        let agreeing: Vec<_> = orders.iter().map(|&order| at(order, step)).collect();
        assert!((most_likely_step(&agreeing, 1e-3).unwrap() - step).abs() < 1e-12);
        let weak: Vec<_> = agreeing.iter().map(|line| StepLine { product: line.product / 100.0, ..*line }).collect();
        assert!(most_likely_step(&weak, 1e-3).is_none());
        // a line alone repeats itself every 1/207 turn
        assert!(most_likely_step(&[at(207.0, step)], 1e-3).is_none());
    }
}
