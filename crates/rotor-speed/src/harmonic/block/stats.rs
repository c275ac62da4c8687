//! What a block says beside its speed: how well that is known, and whether its lines keep their phase.

use super::super::phasors::OrderPhasors;
use super::Cells;
use realfft::num_complex::Complex;
use std::f64::consts::{PI, TAU};

/// Noise alone gives a line this likelihood once in 160 000 times.
const LINE_LIKELIHOOD_MIN: f64 = 12.0;
/// Pieces of a block whose phases are compared.
const PHASE_PIECES: usize = 8;
const SCATTER_STDS: f64 = 3.0;
/// Speed and slope are fitted to the phases.
const FITTED: f64 = 2.0;

/// What a block shows at its maximum.
pub(crate) struct Seen {
    pub(crate) lines_heard: u32,
    pub(crate) is_first_heard: bool,
    pub(crate) strongest_power: f64,
    pub(crate) information: f64,
    pub(crate) in_phase: f64,
    pub(crate) scatter: f64,
}

impl Cells {
    /// What is to be said of the block once its speed is known.
    pub(crate) fn seen_at(&self, offset: f64, bend: f64) -> Seen {
        let mean_square_s2 = self.span_s * self.span_s / 12.0;
        let halves = self.half_hop_times_s.len();
        let mut seen = Seen {
            information: 0.0,
            in_phase: 0.0,
            scatter: 1.0,
            strongest_power: 0.0,
            lines_heard: 0,
            is_first_heard: false,
        };
        let mut turned = vec![Complex::<f64>::default(); halves];
        let turns: Vec<f64> = self.half_hop_times_s.iter().map(|t| t * (offset + bend * t / 2.0)).collect();
        let mut phasors = OrderPhasors::new(&turns);
        // phases are compared in so many pieces that what rotates quickly has mostly averaged out
        let piece = halves.div_ceil(PHASE_PIECES);
        let pieces = halves.div_ceil(piece);
        let mut across_of_lines = Vec::with_capacity(self.orders.len());
        let mut amplitudes = Vec::with_capacity(self.orders.len());
        for (index, half_hops) in self.half_hops.chunks_exact(halves).enumerate() {
            let (order, scale) = (self.orders[index], self.scales[index].0);
            let mut sum = Complex::<f64>::default();
            for ((into, z), phasor) in turned.iter_mut().zip(half_hops).zip(phasors.of(order)) {
                *into = z * phasor;
                sum += *into;
            }
            let amplitude = sum.norm() / self.scales[index].1;
            amplitudes.push(amplitude);
            seen.strongest_power = seen.strongest_power.max(amplitude * amplitude);
            let is_heard = scale * sum.norm_sqr() > LINE_LIKELIHOOD_MIN;
            seen.lines_heard += u32::from(is_heard);
            seen.is_first_heard |= is_heard && self.are_first[index];
            // noise itself adds N V to |Σ z|²
            seen.information += 2.0 * (TAU * order).powi(2) * (scale * sum.norm_sqr() - 1.0) * mean_square_s2;
            if !self.are_strong[index] {
                seen.in_phase += scale * sum.norm_sqr();
                continue;
            }
            let phase = (sum / sum.norm().max(f64::MIN_POSITIVE)).conj();
            // of N samples in all, each half hop has its share
            seen.in_phase += scale
                * turned
                    .iter()
                    .zip(&self.half_hop_shares)
                    .map(|(z, share)| (z * phase).re.powi(2) / share)
                    .sum::<f64>();
            let of_pieces = turned.chunks(piece).zip(self.half_hop_shares.chunks(piece)).map(|(turned, shares)| {
                let across = (turned.iter().sum::<Complex<f64>>() * phase).im;
                2.0 * scale * across * across / shares.iter().sum::<f64>()
            });
            across_of_lines.push((index, of_pieces.sum::<f64>()));
        }
        seen.information = seen.information.max(f64::MIN_POSITIVE);
        if pieces >= 4 {
            let share = piece as f64 / halves as f64;
            let (mut squares, mut explained) = (0.0, 0.0);
            for (index, across) in &across_of_lines {
                let company = self.company(*index, self.guess.0 + offset, &amplitudes, share);
                squares += across;
                explained += (pieces - 1) as f64 * (1.0 + company);
            }
            let freedom = (across_of_lines.len() * (pieces - 1)) as f64 - FITTED;
            let excess = squares / (explained - FITTED);
            // only scatter that noise gives less than once in a few hundred blocks says something
            if freedom > 0.0 && excess > 1.0 + SCATTER_STDS * (2.0 / freedom).sqrt() {
                seen.scatter = excess;
            }
        }
        seen
    }

    /// What other lines in its channel leave in a line's sum over a share of the block at most, as power over that of the noise there: a
    /// line Δf away turns, and leaves up to A / (π Δf) where the line itself leaves A times that time.
    fn company(&self, index: usize, speed_rev_s: f64, amplitudes: &[f64], share: f64) -> f64 {
        let (scale, samples) = self.scales[index];
        let share_s = share * self.span_s;
        self.orders
            .iter()
            .zip(amplitudes)
            .filter(|&(&order, _)| {
                order != self.orders[index] && self.company_hz[index].contains(&(order * speed_rev_s))
            })
            .map(|(order, amplitude)| {
                let apart_hz = (order - self.orders[index]) * speed_rev_s;
                (amplitude / (PI * apart_hz * share_s)).powi(2) * samples * share * samples * scale
            })
            .sum()
    }
}

#[cfg(test)]
mod tests {
    use super::super::super::line::Line;
    use super::super::super::path::SpeedPath;
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    /// Three lines of a blade pass, each of whose channels holds the other two, with a phase that sways by so much every second.
    fn scatter_in_company(is_known: bool, sway_rad: f64) -> f64 {
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
                    company_hz: if is_known { 1900.0..2700.0 } else { 0.0..0.0 },
                    samples_per_tick: samples_per_tick as f64,
                    ticks: samples.chunks(samples_per_tick).map(|tick| tick.iter().sum()).collect(),
                }
            })
            .collect();
        let path = SpeedPath::from_borders(tick_s, vec![speed_rev_s; ticks + 1]);
        Cells::new(&lines, &path, (0, ticks), (speed_rev_s, 0.0)).seen_at(0.0, 0.0).scatter
    }

    #[test]
    fn lines_of_one_channel_do_not_pass_for_phases_that_scatter() {
        assert!(scatter_in_company(false, 0.0) > 1.5, "{}", scatter_in_company(false, 0.0));
        assert_eq!(scatter_in_company(true, 0.0), 1.0);
        assert!(scatter_in_company(true, 0.1) > 1.5, "{}", scatter_in_company(true, 0.1));
    }
}
