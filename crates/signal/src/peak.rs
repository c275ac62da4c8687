//! The frequency of a peak, finer than its bins.

/// Smallest power ratio of a neighbour to the peak that the logarithm distinguishes from zero: it keeps the logarithm of an
/// empty neighbour finite. *Numeric.*
const NEIGHBOUR_RATIO_MIN: f64 = 1e-12;

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
