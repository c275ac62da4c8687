//! Gaussian approximation (paper, section 4.2): the weighted mean frequency of all bins of the band that reach a share of the peak.

/// Mean and standard deviation of the Gaussian of one frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct GaussianPeak {
    pub(super) centre_hz: f64,
    pub(super) std_hz: f64,
}

/// The Gaussian γ(ζ) = exp(−(ζ − ζ̄)² / 2σ²) / (σ √2π) of one frame: ζ̄ and σ are the mean and the standard deviation of all
/// frequencies whose modulus reaches `threshold_share` of the modulus of the peak, weighted by the modulus. This is eq 10 of the paper
/// with the square that the printed exponent lacks.
///
/// The modulus is linear between bins, so that the threshold cuts between bins; otherwise a steady tone of one or two bins would give
/// the middle of a bin.
///
/// - `power`: power spectrum, any unit; `first` and `last`: bins of the band; `peak_power`: power of the loudest bin. Output in Hz.
/// - Bias for a steady tone with a Hann window and a transform of two windows, in bins without zero padding: at most 0.01 with a
///   threshold of 0.8, 0.035 with 0.9 (measured by the test `a_steady_tone_is_right_between_bins`).
/// - `None` where no bin reaches the threshold.
pub(super) fn gaussian_peak(
    power: &[f64],
    first: usize,
    last: usize,
    peak_power: f64,
    threshold_share: f64,
    bin_hz: f64,
) -> Option<GaussianPeak> {
    let threshold = threshold_share * peak_power.sqrt();
    let last = last.min(power.len().saturating_sub(1));
    // moments of the modulus m over the place x, above the threshold: ∫m, ∫mx, ∫mx²
    let (mut mass, mut first_moment, mut second_moment) = (0.0, 0.0, 0.0);
    for bin in first..last {
        let (left, right) = (power[bin].sqrt(), power[bin + 1].sqrt());
        let Some((from, to)) = part_above(left, right, threshold) else { continue };
        let at = |share: f64| left + share * (right - left);
        let (a, b, length) = (at(from), at(to), to - from);
        // Simpson's rule is exact, because the integrands are cubic at most
        let middle = (from + to) / 2.0;
        for (weight, share, modulus) in [(1.0, from, a), (4.0, middle, at(middle)), (1.0, to, b)] {
            let place = bin as f64 + share;
            let part = weight / 6.0 * length * modulus;
            mass += part;
            first_moment += part * place;
            second_moment += part * place * place;
        }
    }
    if mass <= 0.0 {
        return None;
    }
    let centre = first_moment / mass;
    let variance = (second_moment / mass - centre * centre).max(0.0);
    Some(GaussianPeak { centre_hz: centre * bin_hz, std_hz: variance.sqrt() * bin_hz })
}

/// The part of the unit interval in which a straight line from `left` to `right` is above the threshold.
fn part_above(left: f64, right: f64, threshold: f64) -> Option<(f64, f64)> {
    let crossing = (threshold - left) / (right - left);
    match (left >= threshold, right >= threshold) {
        (true, true) => Some((0.0, 1.0)),
        (true, false) => Some((0.0, crossing)),
        (false, true) => Some((crossing, 1.0)),
        (false, false) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ridge::peak::loudest_bin;
    use hovertone_signal::spectrogram::{Stft, Window};
    use std::f64::consts::TAU;

    #[test]
    fn a_triangle_has_its_centre_and_width() {
        // modulus 0, 1, 0 cut at 0.5: a trapezium-topped triangle from -1/2 to 1/2, heights 0.5, 1, 0.5
        let got = gaussian_peak(&[0.0, 0.0, 1.0, 0.0, 0.0], 0, 4, 1.0, 0.5, 10.0).unwrap();
        assert!((got.centre_hz - 20.0).abs() < 1e-12);
        // ∫(1-|x|)x² over ±1/2 = 2 (1/24 - 1/64) = 5/96; ∫(1-|x|) = 3/4
        assert!((got.std_hz - 10.0 * (5.0f64 / 72.0).sqrt()).abs() < 1e-9, "{}", got.std_hz);
    }

    #[test]
    fn a_steady_tone_is_right_between_bins() {
        let (rate, window_s) = (8000.0, 0.1);
        for (threshold_share, bias_cells) in [(0.5, 0.01), (0.8, 0.01), (0.9, 0.035)] {
            let mut worst_cells = 0.0f64;
            for step in 0..100 {
                let hz = 1000.0 + 10.0 * f64::from(step) / 100.0;
                let signal: Vec<f32> = (0..800).map(|n| (TAU * hz * f64::from(n) / rate).cos() as f32).collect();
                let mut stft = Stft::<f64>::new(rate, Window::Hann, window_s, window_s, 2);
                stft.push(&signal, |frame| {
                    let bin = loudest_bin(frame.power, 0, frame.power.len()).unwrap();
                    let got = gaussian_peak(frame.power, 190, 215, frame.power[bin], threshold_share, frame.bin_hz);
                    worst_cells = worst_cells.max((got.unwrap().centre_hz - hz).abs() * window_s);
                });
            }
            assert!(worst_cells > 0.0 && worst_cells < bias_cells, "{threshold_share}: {worst_cells}");
        }
    }
}
