//! Maximum Trace (paper, section 4.1): the frequency of the highest modulus in the band of each frame.

use hovertone_signal::peak::peak_offset_bins;

/// Frequency of the peak at `bin`, Hz, interpolated between bins by [`peak_offset_bins`]. At an end of the spectrum, the middle of the bin.
pub(super) fn maximum_hz(power: &[f64], bin: usize, bin_hz: f64) -> f64 {
    let offset = match (power.get(bin.wrapping_sub(1)), power.get(bin + 1)) {
        (Some(&before), Some(&after)) => peak_offset_bins(before, power[bin], after).unwrap_or(0.0),
        _ => 0.0,
    };
    (bin as f64 + offset) * bin_hz
}
