//! Whether the lines of a rotor keep their phase for as long as a frame lasts.

use super::spectra::FRAME_TICKS;
use crate::harmonic::demodulation::Line;
use crate::harmonic::speed_path::SpeedPath;
use hovertone_signal::statistics::median;
use realfft::num_complex::Complex;
use std::f64::consts::TAU;

/// From one stretch of sound to the other, in steps of a frame: 0.2 s. *Numeric.*
const LAG_FRAMES: usize = 5;

/// How much of its phase a line keeps over 0.2 s, from 1 for all to 0 for nothing: `|Σ z(t + T) z*(t)| / Σ |z(t)|²`, noise taken off
/// and turned by `path` in place of `traced`; the median of the strong lines. `None` where there is none.
pub(super) fn phase_kept(lines: &[Line], traced: &SpeedPath, path: &SpeedPath) -> Option<f64> {
    let turns: Vec<f64> = (0..path.ticks()).map(|tick| path.tick(tick).turns - traced.tick(tick).turns).collect();
    let kept_by = |line: &Line| {
        let cells: Vec<Complex<f64>> = line
            .ticks
            .chunks_exact(FRAME_TICKS)
            .zip(turns.chunks_exact(FRAME_TICKS))
            .map(|(ticks, turns)| {
                let turned = ticks.iter().zip(turns).map(|(z, turns)| z * Complex::cis(-TAU * line.order * turns));
                turned.sum()
            })
            .collect();
        let noise = line.noise_variance * line.samples_per_tick * FRAME_TICKS as f64;
        let power: f64 = cells.iter().map(|z| z.norm_sqr() - noise).sum::<f64>() / cells.len().max(1) as f64;
        let pairs = cells.iter().zip(cells.get(LAG_FRAMES..)?);
        let count = pairs.len().max(1) as f64;
        let together: Complex<f64> = pairs.map(|(before, after)| after * before.conj()).sum();
        (power > noise).then(|| together.norm() / count / power)
    };
    let kept: Vec<f64> = lines.iter().filter(|line| line.is_strong).filter_map(kept_by).collect();
    median(&kept)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    #[test]
    fn a_line_keeps_what_its_coherence_leaves() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(4);
        let (tick_s, ticks, rate_rev_s) = (0.01, 1200, 60.0);
        let traced = SpeedPath::from_borders(tick_s, vec![rate_rev_s; ticks + 1]);
        // the path by which the line was turned is off by 0.05 rev/s, which is six turns of this line in all
        let path = SpeedPath::from_borders(tick_s, vec![rate_rev_s + 0.05; ticks + 1]);
        for (coherence_s, wanted) in [(f64::INFINITY, 1.0), (0.4, (-0.2f64 / 0.4).exp()), (0.1, (-0.2f64 / 0.1).exp())]
        {
            let step = (2.0 * tick_s / coherence_s).sqrt();
            let order = 10.0;
            let mut phase = 0.0;
            let turned = (0..ticks).map(|tick| {
                let normal: f64 = StandardNormal.sample(&mut rng);
                phase += step * normal;
                let noise = Complex::new(StandardNormal.sample(&mut rng), StandardNormal.sample(&mut rng));
                Complex::from_polar(20.0, phase + TAU * order * 0.05 * (tick as f64 + 0.5) * tick_s) + noise
            });
            let line = Line {
                order,
                is_first: true,
                is_strong: true,
                noise_variance: 0.2,
                leakage_band_hz: 0.0..0.0,
                samples_per_tick: 10.0,
                ticks: turned.collect(),
            };
            let lag_s = (LAG_FRAMES * FRAME_TICKS) as f64 * tick_s;
            let kept = phase_kept(&[line], &traced, &path).unwrap_or(f64::NAN);
            assert!((kept - wanted.powf(lag_s / 0.2)).abs() < 0.15, "{coherence_s}: {kept}, lag {lag_s}");
        }
        assert!(phase_kept(&[], &traced, &path).is_none());
    }
}
