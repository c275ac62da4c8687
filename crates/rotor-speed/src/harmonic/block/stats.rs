//! What a block shows at its most likely speed: how well this speed is known, and whether the lines keep their phase.

use super::slices::{BlockLine, BlockSlices};
use crate::harmonic::phasors::OrderPhasors;
use crate::thresholds::NOISE_STDS_MAX;
use realfft::num_complex::Complex;
use std::f64::consts::{PI, TAU};

/// Smallest J of a line that stands out of the noise by itself: noise alone reaches it once in 160 000 lines (e⁻¹²). *Decision.*
const LINE_LIKELIHOOD_MIN: f64 = 12.0;
/// Largest number of pieces of a block whose phases are compared: in so few pieces, other lines of the channel have mostly averaged
/// out. *Numeric.*
const PHASE_PIECES: usize = 8;
/// Smallest number of pieces whose phases are compared. *Numeric.*
const PHASE_PIECES_MIN: usize = 4;
/// Smallest excess of the phase scatter over the scatter from noise that counts, in standard deviations of the scatter from noise, and smallest
/// bend, in standard deviations of the bend from noise: noise alone reaches it once in a few hundred blocks.
const SCATTER_STDS: f64 = NOISE_STDS_MAX;
/// Degree of the Legendre polynomial of a bend: the lowest that a line of speed leaves, and that is unlike at both ends. *Numeric.*
const BEND_DEGREE: usize = 3;
/// Number of parameters that were fitted to the phases: speed and slope. *Physics.*
const FITTED: f64 = 2.0;

/// What a block shows at its most likely speed. The fields are those of [`super::BlockFit`].
pub(super) struct BlockStats {
    pub(super) lines_heard: u32,
    pub(super) is_first_heard: bool,
    pub(super) strongest_power: f64,
    pub(super) information: f64,
    pub(super) phase_likelihood: f64,
    pub(super) phase_scatter: f64,
    pub(super) bend_variance: f64,
}

/// The phases of one strong line in the pieces of a block.
struct PhaseSpread {
    /// Index of the line.
    line: usize,
    /// Sum over the pieces of the squared deviation of the phase, over the variance from noise.
    squares: f64,
}

/// Half hops of a block, gathered into pieces.
struct Pieces {
    /// Half hops of a piece.
    halves: usize,
    count: usize,
    /// Share of the block in a piece.
    share: f64,
    /// Ends of the pieces, on −1 … 1 over the block.
    ends: Vec<f64>,
}

/// Mean of a Legendre polynomial from `from` to `to`, by `(2n + 1) P_n = (P_{n+1} − P_{n−1})′`.
fn legendre_mean(degree: usize, from: f64, to: f64) -> f64 {
    let integral = |x: f64| (legendre(degree + 1, x) - legendre(degree - 1, x)) / (2 * degree + 1) as f64;
    (integral(to) - integral(from)) / (to - from)
}

/// Legendre polynomial P_n(x) by Bonnet's recursion.
fn legendre(degree: usize, x: f64) -> f64 {
    let (mut before, mut last) = (1.0, x);
    for n in 1..degree {
        (before, last) = (last, ((2 * n + 1) as f64 * x * last - n as f64 * before) / (n + 1) as f64);
    }
    if degree == 0 { 1.0 } else { last }
}

impl BlockSlices {
    /// Statistics of the block at a difference of speed and slope from the guess.
    pub(super) fn stats_at(&self, d_speed: f64, d_slope: f64) -> BlockStats {
        let mean_square_s2 = self.length_s * self.length_s / 12.0;
        let halves = self.half_hop_times_s.len();
        let mut stats = BlockStats {
            information: 0.0,
            phase_likelihood: 0.0,
            phase_scatter: 1.0,
            bend_variance: 0.0,
            strongest_power: 0.0,
            lines_heard: 0,
            is_first_heard: false,
        };
        let mut turned = vec![Complex::<f64>::default(); halves];
        let turns: Vec<f64> = self.half_hop_times_s.iter().map(|t| t * (d_speed + d_slope * t / 2.0)).collect();
        let mut phasors = OrderPhasors::new(&turns);
        let pieces = Pieces::of(halves);
        let mut spreads = Vec::with_capacity(self.lines.len());
        let mut amplitudes = Vec::with_capacity(self.lines.len());
        let mut bend = Bend::new(&pieces);
        for (index, (line, half_hops)) in self.lines.iter().zip(self.half_hops.chunks_exact(halves)).enumerate() {
            let mut sum = Complex::<f64>::default();
            for ((into, z), phasor) in turned.iter_mut().zip(half_hops).zip(phasors.of(line.order)) {
                *into = z * phasor;
                sum += *into;
            }
            let power = sum.norm_sqr();
            let amplitude = power.sqrt() / line.samples;
            let likelihood = line.scale * power;
            amplitudes.push(amplitude);
            stats.strongest_power = stats.strongest_power.max(amplitude * amplitude);
            let is_heard = likelihood > LINE_LIKELIHOOD_MIN;
            stats.lines_heard += u32::from(is_heard);
            stats.is_first_heard |= is_heard && line.is_first;
            // noise adds N V to |Σ z|²
            stats.information += 2.0 * (TAU * line.order).powi(2) * (likelihood - 1.0) * mean_square_s2;
            if line.is_strong {
                let phase = (sum / power.sqrt().max(f64::MIN_POSITIVE)).conj();
                stats.phase_likelihood += line.scale * self.in_phase_energy(&turned, phase);
                let squares = self.piece_squares(&turned, phase, line.scale, pieces.halves);
                spreads.push(PhaseSpread { line: index, squares });
                bend.add(&turned, phase, line, likelihood);
            } else {
                stats.phase_likelihood += likelihood;
            }
        }
        stats.information = stats.information.max(f64::MIN_POSITIVE);
        if let Some(scatter) = self.phase_scatter(&spreads, &amplitudes, self.guess.speed_rev_s + d_speed, &pieces) {
            stats.phase_scatter = scatter;
        }
        stats.bend_variance = bend.variance_turns2() / self.length_s.powi(2);
        stats
    }

    /// N Σ (in-phase part)² / N_i over the half hops i, each with N_i of the N samples of the block.
    fn in_phase_energy(&self, turned: &[Complex<f64>], phase: Complex<f64>) -> f64 {
        turned.iter().zip(&self.half_hop_shares).map(|(z, share)| (z * phase).re.powi(2) / share).sum::<f64>()
    }

    /// Sum over the pieces of (quadrature part)², over its variance from noise.
    fn piece_squares(&self, turned: &[Complex<f64>], phase: Complex<f64>, scale: f64, piece: usize) -> f64 {
        let of_pieces = turned.chunks(piece).zip(self.half_hop_shares.chunks(piece)).map(|(turned, shares)| {
            let across = (turned.iter().sum::<Complex<f64>>() * phase).im;
            2.0 * scale * across * across / shares.iter().sum::<f64>()
        });
        of_pieces.sum::<f64>()
    }

    /// Variance of the phases over the variance from noise and from the leakage of other lines (reduced χ²). `None` where it is not
    /// significantly above 1.
    fn phase_scatter(
        &self,
        spreads: &[PhaseSpread],
        amplitudes: &[f64],
        speed_rev_s: f64,
        pieces: &Pieces,
    ) -> Option<f64> {
        if pieces.count < PHASE_PIECES_MIN {
            return None;
        }
        let (mut squares, mut explained) = (0.0, 0.0);
        for spread in spreads {
            let leakage = self.leakage_ratio(spread.line, speed_rev_s, amplitudes, pieces.share);
            squares += spread.squares;
            explained += (pieces.count - 1) as f64 * (1.0 + leakage);
        }
        let freedom = (spreads.len() * (pieces.count - 1)) as f64 - FITTED;
        let excess = squares / (explained - FITTED);
        (freedom > 0.0 && excess > 1.0 + SCATTER_STDS * (2.0 / freedom).sqrt()).then_some(excess)
    }

    /// Largest power that other lines in the channel of a line leak into its sum over a share of the block, over the power of the noise
    /// in that sum. A line of amplitude A at a distance Δf rotates and leaves up to A / (π Δf), where the line itself leaves A times
    /// the length of the share.
    fn leakage_ratio(&self, index: usize, speed_rev_s: f64, amplitudes: &[f64], share: f64) -> f64 {
        let own = &self.lines[index];
        let share_s = share * self.length_s;
        self.lines
            .iter()
            .zip(amplitudes)
            .filter(|(other, _)| other.order != own.order && own.leakage_band_hz.contains(&(other.order * speed_rev_s)))
            .map(|(other, amplitude)| {
                let apart_hz = (other.order - own.order) * speed_rev_s;
                (amplitude / (PI * apart_hz * share_s)).powi(2) * own.samples * share * own.samples * own.scale
            })
            .sum()
    }
}

/// Bend of the speed within a block: the deviation of the angle of the shaft from the line of speed, as a multiple c of the Legendre polynomial
/// `P₃` of the time from −1 to 1 over the block. The turns over the block are then `2 c` more than the line of speed says.
///
/// A fitted line of speed leaves no deviation of lower degree, and degree 4 is alike at both ends.
struct Bend<'a> {
    pieces: &'a Pieces,
    /// Mean of the polynomial over each piece.
    shape: Vec<f64>,
    /// Sum over lines and pieces of angle, precision and polynomial, turns⁻¹.
    sum: f64,
    /// Sum over lines of the precision of the angle over the whole block, turns⁻².
    precision: f64,
}

impl<'a> Bend<'a> {
    fn new(pieces: &'a Pieces) -> Self {
        let shape = pieces.ends.windows(2).map(|ends| legendre_mean(BEND_DEGREE, ends[0], ends[1]));
        Self { pieces, shape: shape.collect(), sum: 0.0, precision: 0.0 }
    }

    /// Adds a line that is turned along the line of speed.
    fn add(&mut self, turned: &[Complex<f64>], phase: Complex<f64>, line: &BlockLine, likelihood: f64) {
        let rad_per_turn = TAU * line.order;
        // angle = across / (|sum| share rad_per_turn), precision = 2 J share rad_per_turn², J = scale |sum|²
        let factor = 2.0 * rad_per_turn * (likelihood * line.scale).sqrt();
        for (turned, shape) in turned.chunks(self.pieces.halves).zip(&self.shape) {
            self.sum += factor * shape * (turned.iter().sum::<Complex<f64>>() * phase).im;
        }
        self.precision += 2.0 * rad_per_turn * rad_per_turn * likelihood;
    }

    /// Square of `2 c`, less its expectation from noise, turns²: the variance of the turns over the block, estimated from this block alone. 0
    /// where noise explains the bend, and where the pieces are few.
    fn variance_turns2(&self) -> f64 {
        if self.pieces.count <= BEND_DEGREE || self.precision <= 0.0 {
            return 0.0;
        }
        let squares =
            self.shape.iter().zip(self.pieces.ends.windows(2)).map(|(p, ends)| p * p * (ends[1] - ends[0]) / 2.0);
        let precision = self.precision * squares.sum::<f64>();
        let (turns, variance) = (2.0 * self.sum / precision, 4.0 / precision);
        if turns * turns > SCATTER_STDS * SCATTER_STDS * variance { turns * turns - variance } else { 0.0 }
    }
}

impl Pieces {
    /// Pieces of a block of a number of half hops.
    fn of(half_hops: usize) -> Self {
        let halves = half_hops.div_ceil(PHASE_PIECES);
        let count = half_hops.div_ceil(halves);
        let end = |piece: usize| 2.0 * (piece * halves).min(half_hops) as f64 / half_hops as f64 - 1.0;
        Self { halves, count, share: halves as f64 / half_hops as f64, ends: (0..=count).map(end).collect() }
    }
}

#[cfg(test)]
mod tests {
    use super::super::SpeedLine;
    use super::*;
    use crate::harmonic::demodulation::Line;
    use crate::harmonic::speed_path::SpeedPath;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    /// Variance of the turns over a block of 1 s that the block states, where the angle of the shaft deviates by `bend_turns` P₃ from a line of
    /// speed.
    fn stated_turns2(bend_turns: f64) -> f64 {
        let (tick_s, ticks, samples_per_tick, speed_rev_s) = (0.01, 100, 12, 60.3);
        let noise_variance: f64 = 1e-3;
        let mut rng = rand_pcg::Pcg64::seed_from_u64(12);
        let line_of = |order: f64| {
            let samples = (0..ticks * samples_per_tick).map(|sample| {
                let place = 2.0 * (sample as f64 + 0.5) / (ticks * samples_per_tick) as f64 - 1.0;
                let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
                let noise = Complex::new(normal(), normal()) * (noise_variance / 2.0).sqrt();
                Complex::from_polar(1.0, TAU * order * bend_turns * legendre(3, place)) + noise
            });
            let samples: Vec<Complex<f64>> = samples.collect();
            Line {
                order,
                is_first: order == 2.0,
                is_strong: true,
                noise_variance,
                leakage_band_hz: 0.0..0.0,
                samples_per_tick: samples_per_tick as f64,
                ticks: samples.chunks(samples_per_tick).map(|tick| tick.iter().sum()).collect(),
            }
        };
        let lines = [2.0, 4.0].map(line_of);
        let path = SpeedPath::from_borders(tick_s, vec![speed_rev_s; ticks + 1]);
        let guess = SpeedLine { speed_rev_s, slope_rev_s2: 0.0 };
        let length_s = tick_s * ticks as f64;
        BlockSlices::new(&lines, &path, 0..ticks, guess).stats_at(0.0, 0.0).bend_variance * length_s.powi(2)
    }

    #[test]
    fn a_bend_within_a_block_widens_its_uncertainty_and_noise_does_not() {
        assert_eq!(stated_turns2(0.0), 0.0);
        let bend_turns = 0.01;
        let stated = stated_turns2(bend_turns).sqrt();
        assert!((stated / (2.0 * bend_turns) - 1.0).abs() < 0.1, "{stated}");
    }

    #[test]
    fn legendre_polynomials_have_their_values_and_means() {
        assert!((legendre(3, 0.5) + 0.4375).abs() < 1e-12 && (legendre(0, 0.3) - 1.0).abs() < 1e-12);
        let steps = 1000;
        let sum: f64 = (0..steps).map(|n| legendre(5, 0.5 + 0.25 * (f64::from(n) + 0.5) / f64::from(steps))).sum();
        assert!((legendre_mean(5, 0.5, 0.75) - sum / f64::from(steps)).abs() < 1e-6);
    }

    /// Phase scatter of three lines of a blade pass, each in a channel that holds the other two, with a phase that oscillates by
    /// `sway_rad` once a second.
    fn scatter_with_leakage(is_known: bool, sway_rad: f64) -> f64 {
        let (tick_s, ticks, samples_per_tick, speed_rev_s) = (0.0106, 470, 12, 60.3);
        let orders = [36.0, 38.0, 40.0];
        let noise_variance: f64 = 1e-3;
        let mut rng = rand_pcg::Pcg64::seed_from_u64(11);
        let lines: Vec<Line> = orders
            .iter()
            .map(|&own| {
                let samples = (0..ticks * samples_per_tick).map(|sample| {
                    let t = sample as f64 * tick_s / samples_per_tick as f64;
                    let of_line = |order: &f64| Complex::from_polar(1.0, TAU * (order - own) * speed_rev_s * t);
                    let mut normal = || -> f64 { StandardNormal.sample(&mut rng) };
                    let noise = Complex::new(normal(), normal()) * (noise_variance / 2.0).sqrt();
                    let sway = Complex::from_polar(1.0, sway_rad * (TAU * t).sin());
                    orders.iter().map(of_line).sum::<Complex<f64>>() * sway + noise
                });
                let samples: Vec<Complex<f64>> = samples.collect();
                Line {
                    order: own,
                    is_first: own == 36.0,
                    is_strong: true,
                    noise_variance,
                    leakage_band_hz: if is_known { 1900.0..2700.0 } else { 0.0..0.0 },
                    samples_per_tick: samples_per_tick as f64,
                    ticks: samples.chunks(samples_per_tick).map(|tick| tick.iter().sum()).collect(),
                }
            })
            .collect();
        let path = SpeedPath::from_borders(tick_s, vec![speed_rev_s; ticks + 1]);
        let guess = SpeedLine { speed_rev_s, slope_rev_s2: 0.0 };
        BlockSlices::new(&lines, &path, 0..ticks, guess).stats_at(0.0, 0.0).phase_scatter
    }

    #[test]
    fn lines_of_one_channel_do_not_pass_for_phases_that_scatter() {
        assert!(scatter_with_leakage(false, 0.0) > 1.5, "{}", scatter_with_leakage(false, 0.0));
        assert_eq!(scatter_with_leakage(true, 0.0), 1.0);
        assert!(scatter_with_leakage(true, 0.1) > 1.5, "{}", scatter_with_leakage(true, 0.1));
    }
}
