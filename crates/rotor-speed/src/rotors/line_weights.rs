//! What each line counts: one that no rotor sounds says nothing but noise.

use super::grid::OffsetGrid;
use super::spectra::{LineSpectra, Spectra};
use crate::thresholds::{FEW, NOISE_STDS_MAX};

/// Resolution cells that a rotor fills in a frame: `∫ lobe⁴`, and a little for what its speed changes within. *Numeric.*
const FILLED_CELLS: f64 = 1.2;
/// Where rotors fill no more than this share of a band, the square of the likelihood tells them from noise, however coloured that is.
const SPARSE_SHARE_MAX: f64 = FEW;
/// What so many standard deviations of chance explain is no rotor.
const CHANCE_DEVIATIONS: f64 = NOISE_STDS_MAX;

/// `S / (1 + S)` of each line, the weight of its likelihood in that of a rotor against noise; S is the power of `count` rotors in it,
/// each alike, in units of the noise, or 0 where they do not stand out.
///
/// Noise has likelihoods J with `⟨J²⟩ = 2 ⟨J⟩²`; rotors that fill a share p of band and time add `p S²`. Where they fill more of
/// it, `⟨J⟩ = 1 + p S`.
pub(super) fn line_weights(spectra: &Spectra, grid: &OffsetGrid, count: usize) -> Vec<f64> {
    let power_of = |line: &LineSpectra| {
        let bins = grid.bins_of(line);
        let (mut sum, mut sum_of_squares) = (0.0, 0.0);
        for frame in 0..spectra.frames() {
            for z in &line.frame(frame)[bins.clone()] {
                let likelihood = f64::from(z.norm_sqr());
                sum += likelihood;
                sum_of_squares += likelihood * likelihood;
            }
        }
        let seen = (spectra.frames() * bins.len()).max(1) as f64;
        let (mean, mean_square) = (sum / seen, sum_of_squares / seen);
        let cells = bins.len() as f64 * (line.cells_of(1) - line.cells_of(0));
        let filled_share = (count as f64 * FILLED_CELLS / cells).min(1.0);
        let independent = (cells * spectra.length_s() / line.frame_s).max(1.0);
        // the variance of ⟨J²⟩ - 2 ⟨J⟩² of noise is 4 ⟨J⟩⁴ over the number of values
        let chance = CHANCE_DEVIATIONS * 2.0 * mean * mean / independent.sqrt();
        let by_square = ((mean_square - 2.0 * mean * mean - chance).max(0.0) / filled_share).sqrt();
        let by_mean = if filled_share > SPARSE_SHARE_MAX { (mean - 1.0).max(0.0) / filled_share } else { 0.0 };
        by_square.max(by_mean)
    };
    spectra.lines.iter().map(power_of).map(|power| power / (1.0 + power)).collect()
}

#[cfg(test)]
mod tests {
    use super::super::atoms::hann_lobe;
    use super::*;
    use rand::{RngExt, SeedableRng};
    use rand_distr::StandardNormal;
    use realfft::num_complex::Complex;

    #[test]
    fn a_line_counts_for_what_rotors_sound_in_it() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(3);
        let mut weight = |power: f64| {
            let frames: Vec<Vec<Complex<f32>>> = (0..100)
                .map(|_| {
                    let rotors: Vec<(f64, Complex<f64>)> = (0..4)
                        .map(|rotor| {
                            let phase: f64 = rng.random_range(0.0..std::f64::consts::TAU);
                            (f64::from(rotor) * 20.0 - 31.3, Complex::from_polar(power.sqrt(), phase))
                        })
                        .collect();
                    let mut normal = || rng.sample::<f64, _>(StandardNormal) / 2f64.sqrt();
                    (0..400)
                        .map(|bin| {
                            let cells = (f64::from(bin) - 200.0) / 2.0;
                            let lines = rotors.iter().map(|(place, amplitude)| amplitude * hann_lobe(cells - place));
                            let z = Complex::new(normal(), normal()) + lines.sum::<Complex<f64>>();
                            Complex::new(z.re as f32, z.im as f32)
                        })
                        .collect()
                })
                .collect();
            let spectra = Spectra::of_line(&frames);
            line_weights(&spectra, &OffsetGrid::new(-400.0..=400.0, &spectra), 4)[0]
        };
        assert_eq!(weight(0.0), 0.0);
        for power in [5.0, 30.0, 1000.0] {
            let wanted = power / (1.0 + power);
            assert!((weight(power) - wanted).abs() < 0.1 * (1.0 - wanted) + 0.03, "{power}");
        }
    }
}
