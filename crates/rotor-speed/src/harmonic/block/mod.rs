//! The speed of a short stretch: the maximum of the likelihood of all lines together.
//!
//! Over a block the shaft turns at `n + γ τ`, τ from the middle of the block. Line o of it, in noise of variance V_o per
//! sample, has the log likelihood (amplitude and phase at their best, constants left out)
//!
//! `J_o(n, γ) = |Σ z_o exp(−j 2π o (n τ + γ τ² / 2))|² / (N_o V_o)`,
//!
//! and the lines add: J = Σ_o J_o (Whittle; harmonic maximum likelihood with coloured noise). The standard uncertainty is that
//! of the Cramér-Rao bound, 1/σ² = Σ_o 2 (2π o)² N_o |A_o|² ⟨τ²⟩ / V_o; an unknown γ does not widen it, because n is the speed in the middle.

mod seen;

use super::line::Line;
use super::path::SpeedPath;
use super::phasors::{OrderPhasors, small_turn};
use hovertone_signal::channels::TICKS_PER_HOP;
use realfft::num_complex::Complex;
use std::f64::consts::TAU;
use std::ops::Range;

/// What the likelihood says of one block.
#[derive(Clone, Copy, Debug)]
pub(crate) struct BlockFit {
    pub(crate) tick_from: usize,
    pub(crate) tick_to: usize,
    /// Speed in the middle.
    pub(crate) speed_rev_s: f64,
    /// How fast it changes.
    pub(crate) slope_rev_s2: f64,
    /// Log likelihood over that of noise alone; noise itself gives one for each line.
    pub(crate) likelihood: f64,
    /// The same, where strong lines have an amplitude of their own in each half hop, so that only phase counts.
    pub(crate) in_phase: f64,
    /// How much more the phases of the strong lines scatter along the block than the noise explains; 1 is what it explains.
    pub(crate) scatter: f64,
    /// Information on the speed, 1/σ².
    pub(crate) information: f64,
    /// Lines that stand out of the noise by themselves, and whether the first of a family is among them.
    pub(crate) lines_heard: u32,
    pub(crate) is_first_heard: bool,
    /// Power of the strongest line, 1 for a sine of full scale.
    pub(crate) strongest_power: f64,
    /// By how many turns the next block's line starts ahead of where this one ends, where phases say so.
    pub(crate) step_to_next_turns: Option<f64>,
}

impl BlockFit {
    /// Middle of the block.
    pub(crate) fn middle_s(&self, tick_s: f64) -> f64 {
        (self.tick_from + self.tick_to) as f64 / 2.0 * tick_s
    }

    /// Speed at a time.
    pub(crate) fn speed_at(&self, time_s: f64, tick_s: f64) -> f64 {
        self.speed_rev_s + self.slope_rev_s2 * (time_s - self.middle_s(tick_s))
    }
}

/// Ticks of a block, turned by a first guess and gathered into cells of equal length, ready for the search.
pub(crate) struct Cells {
    orders: Vec<f64>,
    are_strong: Vec<bool>,
    are_first: Vec<bool>,
    /// Where other lines of the same rotor are heard with each.
    company_hz: Vec<Range<f64>>,
    /// 1 / (N V) of each line, and N.
    scales: Vec<(f64, f64)>,
    /// Middle of each cell from the middle of the block.
    times_s: Vec<f64>,
    /// Line by line.
    sums: Vec<Complex<f64>>,
    /// The same in cells of half a hop, for the question whether all of them have one phase.
    half_hops: Vec<Complex<f64>>,
    half_hop_times_s: Vec<f64>,
    half_hop_shares: Vec<f64>,
    span_s: f64,
    guess: (f64, f64),
}

/// Cells of a block at most: fine enough that speed does not turn a cell by more than a sixteenth of the block's own
/// resolution for each line of resolution that it is off.
const CELLS_MAX: usize = 16;

impl Cells {
    /// The cells of the ticks `from..to`, turned by speed and slope `guess` instead of by `path`.
    pub(crate) fn new(
        lines: &[Line],
        path: &SpeedPath,
        (tick_from, tick_to): (usize, usize),
        guess: (f64, f64),
    ) -> Self {
        let tick_s = path.tick_s;
        let ticks = tick_to - tick_from;
        let per_cell = ticks.div_ceil(CELLS_MAX);
        let cells = ticks.div_ceil(per_cell);
        let middle_s = (tick_from + tick_to) as f64 / 2.0 * tick_s;
        let turns_middle = path.turns_at(middle_s);
        let (speed, slope) = guess;
        // by how far, and how fast, the guess runs ahead of the path
        let (turns, speeds): (Vec<f64>, Vec<f64>) = (tick_from..tick_to)
            .map(|tick| {
                let t = (tick as f64 + 0.5) * tick_s - middle_s;
                let turns = speed * t + slope * t * t / 2.0 - (path.turns_at_middle(tick) - turns_middle);
                (turns, speed + slope * t - (path.speed_rev_s(tick) + path.speed_rev_s(tick + 1)) / 2.0)
            })
            .unzip();
        let mut phasors = OrderPhasors::new(&turns);
        let halves = ticks.div_ceil(TICKS_PER_HOP / 2);
        let mut turned = Vec::with_capacity(ticks);
        let mut sums = vec![Complex::default(); lines.len() * cells];
        let mut half_hops = vec![Complex::default(); lines.len() * halves];
        for ((line, sums), half_hops) in
            lines.iter().zip(sums.chunks_exact_mut(cells)).zip(half_hops.chunks_exact_mut(halves))
        {
            // the mean time of a tick's samples lies half a sample before its middle
            let half_sample = TAU * line.order * tick_s / line.samples_per_tick / 2.0;
            let ticks = line.ticks[tick_from..tick_to].iter().zip(phasors.of(line.order)).zip(&speeds);
            turned.clear();
            turned.extend(ticks.map(|((z, phasor), speed)| z * phasor * small_turn(speed * half_sample)));
            add_up(&turned, per_cell, sums);
            add_up(&turned, TICKS_PER_HOP / 2, half_hops);
        }
        let times_of = |cells: usize, per_cell: usize| -> Vec<f64> {
            (0..cells)
                .map(|cell| {
                    let (first, last) = (cell * per_cell, ((cell + 1) * per_cell).min(ticks));
                    ((first + last) as f64 - ticks as f64) / 2.0 * tick_s
                })
                .collect()
        };
        Self {
            orders: lines.iter().map(|line| line.order).collect(),
            are_strong: lines.iter().map(|line| line.is_strong).collect(),
            are_first: lines.iter().map(|line| line.is_first).collect(),
            company_hz: lines.iter().map(|line| line.company_hz.clone()).collect(),
            scales: lines
                .iter()
                .map(|line| {
                    let samples = line.samples_per_tick * ticks as f64;
                    (1.0 / (samples * line.noise_variance), samples)
                })
                .collect(),
            times_s: times_of(cells, per_cell),
            sums,
            half_hops,
            half_hop_times_s: times_of(halves, TICKS_PER_HOP / 2),
            half_hop_shares: (0..halves)
                .map(|half| (ticks - half * TICKS_PER_HOP / 2).min(TICKS_PER_HOP / 2) as f64 / ticks as f64)
                .collect(),
            span_s: ticks as f64 * tick_s,
            guess,
        }
    }

    fn lines(&self) -> impl Iterator<Item = (f64, f64, &[Complex<f64>])> {
        let cells = self.times_s.len();
        self.orders.iter().zip(&self.scales).zip(self.sums.chunks_exact(cells)).map(|((o, s), sums)| (*o, s.0, sums))
    }

    /// J of each line at the guess.
    pub(crate) fn line_likelihoods(&self) -> Vec<f64> {
        self.lines().map(|(_, scale, sums)| scale * sums.iter().sum::<Complex<f64>>().norm_sqr()).collect()
    }

    /// Order of each line, and its sum at the guess over √(N V): the square of its magnitude is J.
    pub(crate) fn line_sums(&self) -> Vec<(f64, Complex<f64>)> {
        self.lines().map(|(order, scale, sums)| (order, scale.sqrt() * sums.iter().sum::<Complex<f64>>())).collect()
    }

    /// J, its gradient and its second derivatives at an offset.
    pub(crate) fn expansion(&self, offset: f64, bend: f64) -> (f64, [f64; 2], [f64; 3]) {
        let (mut value, mut gradient, mut second) = (0.0, [0.0; 2], [0.0; 3]);
        let turns: Vec<f64> = self.times_s.iter().map(|t| t * (offset + bend * t / 2.0)).collect();
        let mut phasors = OrderPhasors::new(&turns);
        for (order, scale, sums) in self.lines() {
            let w = TAU * order;
            // moments Σ z τ^m, m = 0 … 4
            let mut moments = [Complex::<f64>::default(); 5];
            for ((z, phasor), &t) in sums.iter().zip(phasors.of(order)).zip(&self.times_s) {
                let mut z = z * phasor;
                for moment in &mut moments {
                    *moment += z;
                    z *= t;
                }
            }
            let [s, s1, s2, s3, s4] = moments;
            // ∂S/∂n = −jw S₁, ∂S/∂γ = −jw S₂/2, and so on
            let j = Complex::new(0.0, 1.0);
            let (dn, dg) = (-j * w * s1, -j * w * s2 / 2.0);
            let (nn, ng, gg) = (-w * w * s2, -w * w * s3 / 2.0, -w * w * s4 / 4.0);
            let of = |a: Complex<f64>, b: Complex<f64>| (a.conj() * b).re;
            value += scale * s.norm_sqr();
            gradient[0] += 2.0 * scale * of(s, dn);
            gradient[1] += 2.0 * scale * of(s, dg);
            second[0] += 2.0 * scale * (dn.norm_sqr() + of(s, nn));
            second[1] += 2.0 * scale * (of(dn, dg) + of(s, ng));
            second[2] += 2.0 * scale * (dg.norm_sqr() + of(s, gg));
        }
        (value, gradient, second)
    }

    /// J on a grid of speeds around the guess, `points` to either side.
    fn on_grid(&self, step_rev_s: f64, points: usize, values: &mut [f64]) {
        let turns_at = |offset: f64| -> Vec<f64> { self.times_s.iter().map(|t| t * offset).collect() };
        let (first, step) = (turns_at(-step_rev_s * points as f64), turns_at(step_rev_s));
        let (mut firsts, mut steps) = (OrderPhasors::new(&first), OrderPhasors::new(&step));
        for (order, scale, sums) in self.lines() {
            let turned = sums.iter().zip(firsts.of(order)).map(|(z, first)| z * first);
            let mut cells: Vec<(Complex<f64>, Complex<f64>)> = turned.zip(steps.of(order).iter().copied()).collect();
            for value in values.iter_mut() {
                let mut sum = Complex::<f64>::default();
                for (z, step) in &mut cells {
                    sum += *z;
                    *z *= *step;
                }
                *value += scale * sum.norm_sqr();
            }
        }
    }

    /// A resolution cell of the highest line.
    pub(crate) fn cell_rev_s(&self) -> f64 {
        1.0 / (self.orders.iter().copied().fold(1.0, f64::max) * self.span_s)
    }

    /// The maximum near the guess: a grid of `grid_cells` to either side, then Newton's method. `slope_std_rev_s2` is how fast
    /// the speed may be expected to change; it keeps the slope of a weak block from running away.
    pub(crate) fn fit(&self, ticks: (usize, usize), grid_cells: f64, slope_std_rev_s2: f64) -> BlockFit {
        let prior = slope_std_rev_s2.powi(-2);
        let mut offset = if grid_cells > 0.0 { best_on_grid([self], grid_cells, GRID_PER_CELL) } else { 0.0 };
        let mut bend = 0.0;
        let penalised = |value: f64, bend: f64| value - prior * (self.guess.1 + bend).powi(2) / 2.0;
        let (cell, bend_max) = (self.cell_rev_s(), BEND_CELLS * self.cell_rev_s() / self.span_s);
        let (mut value, mut gradient, mut second) = self.expansion(offset, bend);
        for _ in 0..NEWTON_STEPS {
            let (g0, g1) = (gradient[0], gradient[1] - prior * (self.guess.1 + bend));
            let uphill = (g0.signum() * UPHILL_CELLS * cell, 0.0);
            // not on top yet: uphill by what the curvature of a clean line would ask for
            let (mut d_offset, mut d_bend) =
                step_to_summit([g0, g1], [second[0], second[1], second[2] - prior]).unwrap_or(uphill);
            // the likelihood repeats itself far away: cells are finite; a step must not jump there
            d_offset = d_offset.clamp(-cell, cell);
            d_bend = d_bend.clamp(-bend_max, bend_max);
            let before = penalised(value, bend);
            let mut halvings = 0;
            loop {
                let next = self.expansion(offset + d_offset, bend + d_bend);
                if penalised(next.0, bend + d_bend) >= before || halvings == HALVINGS_MAX {
                    (value, gradient, second) = next;
                    (offset, bend) = (offset + d_offset, bend + d_bend);
                    break;
                }
                (d_offset, d_bend, halvings) = (d_offset / 2.0, d_bend / 2.0, halvings + 1);
            }
            if d_offset.abs() < STEP_MIN_CELLS * cell {
                break;
            }
        }
        if offset.abs() > (grid_cells + STRAY_CELLS) * cell {
            (offset, bend) = (0.0, 0.0);
            value = self.expansion(offset, bend).0;
        }
        let seen = self.seen_at(offset, bend);
        BlockFit {
            tick_from: ticks.0,
            tick_to: ticks.1,
            speed_rev_s: self.guess.0 + offset,
            slope_rev_s2: self.guess.1 + bend,
            likelihood: value,
            in_phase: seen.in_phase,
            scatter: seen.scatter,
            information: seen.information,
            lines_heard: seen.lines_heard,
            is_first_heard: seen.is_first_heard,
            strongest_power: seen.strongest_power,
            step_to_next_turns: None,
        }
    }
}

/// Sums of so many values each.
fn add_up(values: &[Complex<f64>], per_sum: usize, sums: &mut [Complex<f64>]) {
    sums.iter_mut().zip(values.chunks(per_sum)).for_each(|(sum, values)| *sum = values.iter().sum());
}

/// The offset of the highest point of a grid that reaches `cells` resolution cells to either side; of several blocks, all around
/// their own guesses, the highest point of their sum.
pub(crate) fn best_on_grid<'a>(blocks: impl IntoIterator<Item = &'a Cells>, cells: f64, points_per_cell: f64) -> f64 {
    let mut blocks = blocks.into_iter().peekable();
    let Some(step) = blocks.peek().map(|first| first.cell_rev_s() / points_per_cell) else { return 0.0 };
    let points = (cells * points_per_cell).round() as usize;
    let mut values = vec![0.0; 2 * points + 1];
    blocks.for_each(|block| block.on_grid(step, points, &mut values));
    let best = (0..values.len()).max_by(|&a, &b| values[a].total_cmp(&values[b])).unwrap_or(points);
    (best as f64 - points as f64) * step
}

/// Newton's step from a gradient and second derivatives ∂²/∂n², ∂²/∂n∂γ, ∂²/∂γ²; `None` where they are not those of a summit.
pub(crate) fn step_to_summit(g: [f64; 2], h: [f64; 3]) -> Option<(f64, f64)> {
    let determinant = h[0] * h[2] - h[1] * h[1];
    (h[0] < 0.0 && determinant > 0.0)
        .then(|| ((-h[2] * g[0] + h[1] * g[1]) / determinant, (h[1] * g[0] - h[0] * g[1]) / determinant))
}

/// Points of the search grid in a resolution cell of the highest line.
const GRID_PER_CELL: f64 = 3.0;
/// From a grid point Newton's method needs three or four steps.
const NEWTON_STEPS: u32 = 8;
const HALVINGS_MAX: u32 = 4;
/// Steps below this are none.
const STEP_MIN_CELLS: f64 = 1e-6;
/// A slope changes by so many cells over the block's length in one step at most.
const BEND_CELLS: f64 = 4.0;
/// A maximum this far beyond where it was looked for is another one.
const STRAY_CELLS: f64 = 3.0;
/// A step uphill where the likelihood is not yet curved like a summit.
const UPHILL_CELLS: f64 = 0.1;
