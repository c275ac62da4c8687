//! The speed of one block: the maximum of the likelihood of all lines together.
//!
//! In a block the shaft turns at the speed `n + γ τ`, where τ is the time from the middle of the block, n the speed there and γ the
//! slope. Line o has amplitude A_o and N_o samples z_o, in noise of variance V_o per sample. Its log likelihood, with the best
//! amplitude and phase and without constants, is
//!
//! `J_o(n, γ) = |Σ z_o exp(−j 2π o (n τ + γ τ² / 2))|² / (N_o V_o)`,
//!
//! and the sum over all lines is J = Σ_o J_o: the harmonic likelihood (nonlinear least squares; Christensen and Jakobsson,
//! *Multi-Pitch Estimation*, 2009) with the noise of each line (Whittle, Arkiv för Matematik 2, 1953).
//!
//! The standard uncertainty σ of n is the Cramér-Rao bound (Rife and Boorstyn, IEEE Trans. Information Theory 20, 1974):
//! `1 / σ² = Σ_o 2 (2π o)² N_o |A_o|² ⟨τ²⟩ / V_o`. An unknown γ does not change it, because n is the speed in the middle.

mod slices;
mod stats;

pub(crate) use slices::{BlockSlices, Expansion, HALF_HOP_TICKS, LineSum};

use crate::thresholds::SLOPE_SHARE_PER_S;
use stats::BlockStats;
use std::ops::Range;

/// Points of the search grid in a resolution cell of the highest line. *Numeric.*
const GRID_PER_CELL: f64 = 3.0;
/// Largest number of steps of Newton's method. From a grid point it needs three or four. *Numeric.*
const NEWTON_STEPS: u32 = 8;
/// Largest number of times that a step of Newton's method is halved until it climbs. *Numeric.*
const HALVINGS_MAX: u32 = 4;
/// Step that is Newton's last one, in resolution cells of the speed, and of its change over the block: the method converges quadratically, and the
/// step after this one would be below 1e-5. *Numeric.*
const STEP_MIN_CELLS: f64 = 1e-3;
/// The same where the likelihood is not concave, or where the slope is not found yet. *Numeric.*
const SURE_STEP_MIN_CELLS: f64 = 1e-6;
/// Largest step of the slope, as a change of speed over the block in resolution cells. *Numeric.*
const SLOPE_STEP_CELLS_MAX: f64 = 4.0;
/// Largest distance of the maximum from the range of the grid, in resolution cells; beyond, it belongs to another peak. *Decision.*
const STRAY_CELLS: f64 = 3.0;
/// Step uphill where the likelihood is not concave, in resolution cells. *Numeric.*
const UPHILL_CELLS: f64 = 0.1;
/// Standard deviation of the slope of a hovering rotor, as a share of its speed per second: the prior of the slope, which bounds it in
/// weak blocks.
const SLOPE_STD_SHARE_PER_S: f64 = SLOPE_SHARE_PER_S;

/// A speed that is linear in time: the speed in the middle of a block, and its rate of change.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpeedLine {
    pub(crate) speed_rev_s: f64,
    pub(crate) slope_rev_s2: f64,
}

/// The most likely speed of one block, and what its lines show there.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BlockFit {
    /// First tick of the block in its chunk.
    pub(crate) tick_from: usize,
    /// Tick after the last one of the block.
    pub(crate) tick_to: usize,
    /// Speed in the middle of the block.
    pub(crate) speed_rev_s: f64,
    /// Rate of change of the speed.
    pub(crate) slope_rev_s2: f64,
    /// J at its maximum: log likelihood relative to noise alone. Noise gives 1 for each line.
    pub(crate) likelihood: f64,
    /// J where each strong line has an amplitude of its own in each half hop, so that only its phase counts.
    pub(crate) phase_likelihood: f64,
    /// Variance of the phases of the strong lines along the block, over the variance from noise; at least 1.
    pub(crate) phase_scatter: f64,
    /// Variance of the mean speed because the speed bends within the block, (rev/s)².
    pub(crate) bend_variance: f64,
    /// Information on the speed, 1/σ², s².
    pub(crate) information: f64,
    /// Number of lines that stand out of the noise by themselves.
    pub(crate) lines_heard: u32,
    /// Whether the first line of a family is among these.
    pub(crate) is_first_heard: bool,
    /// Power of the strongest line; 1 for a sine of full scale.
    pub(crate) strongest_power: f64,
    /// Angle in turns from the end of this block's line of speed to the start of the next block's, where the phases determine it.
    pub(crate) step_to_next_turns: Option<f64>,
}

impl BlockFit {
    /// Middle of the block from the start of the chunk.
    pub(crate) fn middle_s(&self, tick_s: f64) -> f64 {
        (self.tick_from + self.tick_to) as f64 / 2.0 * tick_s
    }

    /// Speed at a time from the start of the chunk.
    pub(crate) fn speed_at(&self, time_s: f64, tick_s: f64) -> f64 {
        self.speed_rev_s + self.slope_rev_s2 * (time_s - self.middle_s(tick_s))
    }

    /// The ticks of the block.
    pub(crate) fn ticks(&self) -> Range<usize> {
        self.tick_from..self.tick_to
    }

    /// The line of speed of the block.
    pub(crate) fn speed_line(&self) -> SpeedLine {
        SpeedLine { speed_rev_s: self.speed_rev_s, slope_rev_s2: self.slope_rev_s2 }
    }
}

/// A maximum of J, as differences of speed and slope from the first guess.
struct Summit {
    d_speed: f64,
    d_slope: f64,
    value: f64,
}

impl BlockSlices {
    /// The maximum near the guess: the best point of a grid of `grid_cells` resolution cells to either side, then Newton's method. Where
    /// that leads too far away, the guess itself.
    pub(crate) fn fit(&self, grid_cells: f64) -> BlockFit {
        let start = if grid_cells > 0.0 { best_on_grid([self], grid_cells, GRID_PER_CELL) } else { 0.0 };
        let mut summit = self.climbed(start);
        if summit.d_speed.abs() > (grid_cells + STRAY_CELLS) * self.cell_rev_s() {
            summit = Summit { d_speed: 0.0, d_slope: 0.0, value: self.expansion(0.0, 0.0).value };
        }
        let stats: BlockStats = self.stats_at(summit.d_speed, summit.d_slope);
        BlockFit {
            tick_from: self.ticks.start,
            tick_to: self.ticks.end,
            speed_rev_s: self.guess.speed_rev_s + summit.d_speed,
            slope_rev_s2: self.guess.slope_rev_s2 + summit.d_slope,
            likelihood: summit.value,
            phase_likelihood: stats.phase_likelihood,
            phase_scatter: stats.phase_scatter,
            bend_variance: stats.bend_variance,
            information: stats.information,
            lines_heard: stats.lines_heard,
            is_first_heard: stats.is_first_heard,
            strongest_power: stats.strongest_power,
            step_to_next_turns: None,
        }
    }

    /// The same near a good guess, with the sums of the lines along the speed that is found.
    pub(crate) fn fit_with_sums(&self) -> (BlockFit, Vec<LineSum>) {
        let block = self.fit(0.0);
        (block, self.line_sums(block.speed_line()))
    }

    /// Newton's method on J less the prior of the slope, from a difference of speed. Steps are halved until they climb.
    fn climbed(&self, start: f64) -> Summit {
        let slope_std_rev_s2 = SLOPE_STD_SHARE_PER_S * self.guess.speed_rev_s;
        let prior = slope_std_rev_s2.powi(-2);
        let guess_slope = self.guess.slope_rev_s2;
        let penalised = |value: f64, d_slope: f64| value - prior * (guess_slope + d_slope).powi(2) / 2.0;
        let cell = self.cell_rev_s();
        let slope_step_max = SLOPE_STEP_CELLS_MAX * self.cell_rev_s() / self.length_s;
        let (mut d_speed, mut d_slope) = (start, 0.0);
        let mut here = self.expansion(d_speed, d_slope);
        for _ in 0..NEWTON_STEPS {
            let (g0, g1) = (here.gradient[0], here.gradient[1] - prior * (guess_slope + d_slope));
            let h = [here.second[0], here.second[1], here.second[2] - prior];
            // where J is not concave, a fixed step uphill
            let uphill = (g0.signum() * UPHILL_CELLS * cell, 0.0);
            let to_summit = step_to_summit([g0, g1], h);
            let is_concave = to_summit.is_some();
            let (step_speed, step_slope) = to_summit.unwrap_or(uphill);
            // J repeats itself far away, because slices have a finite length: a step must not reach that far
            let mut step_speed = step_speed.clamp(-cell, cell);
            let mut step_slope = step_slope.clamp(-slope_step_max, slope_step_max);
            if is_concave
                && step_speed.abs() < STEP_MIN_CELLS * cell
                && step_slope.abs() * self.length_s < STEP_MIN_CELLS * cell
            {
                let value = here.value_after(step_speed, step_slope);
                return Summit { d_speed: d_speed + step_speed, d_slope: d_slope + step_slope, value };
            }
            let before = penalised(here.value, d_slope);
            let mut halvings = 0;
            loop {
                let next = self.expansion(d_speed + step_speed, d_slope + step_slope);
                if penalised(next.value, d_slope + step_slope) >= before || halvings == HALVINGS_MAX {
                    here = next;
                    (d_speed, d_slope) = (d_speed + step_speed, d_slope + step_slope);
                    break;
                }
                (step_speed, step_slope, halvings) = (step_speed / 2.0, step_slope / 2.0, halvings + 1);
            }
            if step_speed.abs() < SURE_STEP_MIN_CELLS * cell {
                break;
            }
        }
        Summit { d_speed, d_slope, value: here.value }
    }
}

/// The difference of speed from the guess with the greatest J, on a grid of `cells` resolution cells to either side. Of several blocks
/// with guesses of their own, the greatest sum of J.
pub(crate) fn best_on_grid<'a>(
    blocks: impl IntoIterator<Item = &'a BlockSlices>,
    cells: f64,
    points_per_cell: f64,
) -> f64 {
    let mut blocks = blocks.into_iter().peekable();
    let Some(step) = blocks.peek().map(|first| first.cell_rev_s() / points_per_cell) else { return 0.0 };
    let points = (cells * points_per_cell).round() as usize;
    let mut values = vec![0.0; 2 * points + 1];
    blocks.for_each(|block| block.add_grid(step, points, &mut values));
    let best = (0..values.len()).max_by(|&a, &b| values[a].total_cmp(&values[b])).unwrap_or(points);
    (best as f64 - points as f64) * step
}

/// Newton's step (speed, slope) from the gradient and the second derivatives ∂²/∂n², ∂²/∂n∂γ, ∂²/∂γ². `None` where the function is not
/// concave.
pub(crate) fn step_to_summit(gradient: [f64; 2], second: [f64; 3]) -> Option<(f64, f64)> {
    let (g, h) = (gradient, second);
    let determinant = h[0] * h[2] - h[1] * h[1];
    (h[0] < 0.0 && determinant > 0.0)
        .then(|| ((-h[2] * g[0] + h[1] * g[1]) / determinant, (h[1] * g[0] - h[0] * g[1]) / determinant))
}
