//! The frequency of a peak, finer than its bins.

/// Offset of a tone from the middle bin, by a parabola through three log powers.
///
/// δ = (a − c) / (2 (a − 2b + c)) with the levels a, b, c of bins k−1, k, k+1.
///
/// - Units: powers in any unit, result in bins, within ±0.5.
/// - Bias with a Hann window, in bins of the unpadded frame: at most 0.016 without padding, 0.0017 with a transform of
///   two windows (measured by `the_interpolated_peak_has_the_stated_bias`).
/// - Reference: J. O. Smith, *Spectral Audio Signal Processing*, section on quadratic interpolation.
/// - `None` when the middle bin is no maximum; of two equal bins the first is.
pub fn peak_offset_bins(before: f64, middle: f64, after: f64) -> Option<f64> {
    if !(middle > before && middle >= after) {
        return None;
    }
    let smallest = middle * 1e-12; // keeps the logarithm of an empty neighbour finite
    let (a, b, c) = (before.max(smallest).ln(), middle.ln(), after.max(smallest).ln());
    Some((a - c) / (2.0 * (a - 2.0 * b + c)))
}
