//! The frequency of a peak, finer than its bins.

/// Smallest power ratio of a neighbour to the peak that the logarithm distinguishes from zero: it keeps the logarithm of an
/// empty neighbour finite. *Numeric.*
const NEIGHBOUR_RATIO_MIN: f64 = 1e-12;
/// Exponent of the amplitude for which a parabola through the peak of a Hann window has the least bias (Werner and Germain, *Sinusoidal
/// parameter estimation using quadratic interpolation around power-scaled magnitude spectrum peaks*, Applied Sciences 6, 2016). *Numeric.*
const HANN_EXPONENT: f64 = 0.23;

/// Offset of a tone from the middle of the loudest bin, by a parabola through three log powers.
///
/// Formula: δ = (a − c) / (2 (a − 2b + c)) with the log powers a, b, c of the bins k − 1, k, k + 1.
///
/// - Input: powers of three neighbouring bins, in any unit. Output: offset in bins, within ±0.5.
/// - Bias with a Hann window, in bins of a transform without zero padding: at most 0.016 without padding, 0.0017 with a
///   transform of two windows (measured by the test `the_interpolated_peak_has_the_stated_bias` of `hovertone-rotor-speed`).
/// - Source: J. O. Smith, *Spectral Audio Signal Processing*, section on quadratic interpolation of spectral peaks.
/// - `None` where the middle bin is no maximum. Of two equal bins, the first counts as the maximum.
pub fn peak_offset_bins(before: f64, middle: f64, after: f64) -> Option<f64> {
    if !(middle > before && middle >= after) {
        return None;
    }
    let smallest = middle * NEIGHBOUR_RATIO_MIN;
    let (a, b, c) = (before.max(smallest).ln(), middle.ln(), after.max(smallest).ln());
    Some((a - c) / (2.0 * (a - 2.0 * b + c)))
}

/// Offset of a tone from the middle of the loudest bin of a Hann window, by a parabola through three amplitudes to the power p = 0.23.
///
/// Formula: δ = (a − c) / (2 (a − 2b + c)) with a, b, c = |X|^p of the bins k − 1, k, k + 1.
///
/// - Input: powers of three neighbouring bins, in any unit. Output: offset in bins, within ±0.5.
/// - Bias for a steady tone: at most 0.0005 bins, with transforms of 1 to 1.08 windows. A peak that is wider than the window's has its middle, as
///   with [`peak_offset_bins`].
/// - `None` where the middle bin is no maximum. Of two equal bins, the first counts as the maximum.
pub fn hann_peak_offset_bins(before: f64, middle: f64, after: f64) -> Option<f64> {
    if !(middle > before && middle >= after) {
        return None;
    }
    // amplitude is the root of power
    let [a, c] = [before, after].map(|power| (power / middle).powf(HANN_EXPONENT / 2.0));
    Some((a - c) / (2.0 * (a - 2.0 + c)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    /// Power of a steady tone at a distance from its place, in resolutions of a Hann window (Harris 1978).
    fn hann_power(distance: f64) -> f64 {
        // 0 and 1 are removable singularities
        let x = distance.abs() + 1e-9;
        ((PI * x).sin() / (PI * x) / (1.0 - x * x)).powi(2)
    }

    #[test]
    fn the_offset_of_a_steady_tone_has_the_stated_bias() {
        for windows in [1.0, 1.02, 1.08] {
            for step in -49..50 {
                let offset = f64::from(step) / 100.0;
                let [before, middle, after] = [-1.0, 0.0, 1.0].map(|bin| hann_power((bin - offset) / windows));
                let found = hann_peak_offset_bins(before, middle, after).unwrap();
                assert!((found - offset).abs() < 5e-4, "{windows} windows, {offset}: {found}");
            }
        }
    }

    #[test]
    fn what_is_no_maximum_has_no_offset() {
        assert_eq!(hann_peak_offset_bins(1.0, 2.0, 3.0), None);
        assert_eq!(hann_peak_offset_bins(2.0, 2.0, 2.0), None);
        assert_eq!(hann_peak_offset_bins(0.0, 4.0, 0.0), Some(0.0));
    }
}
