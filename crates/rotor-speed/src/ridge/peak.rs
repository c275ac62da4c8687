//! The peak of a band, and its height over its surroundings.

use hovertone_signal::statistics::median;

/// Number of resolution cells on either side of a peak that form its surroundings. They begin half a cell beyond the main lobe, and are
/// near enough for the noise to have the same density. *Decision.*
const SIDE_CELLS: f64 = 5.0;
/// Number of resolution cells for each independent value in the median of the surroundings: neighbouring cells of a Hann window are
/// correlated, but a transform of two windows gives two values for each cell. The test
/// `noise_passes_for_a_point_as_often_as_the_setting_says` measures that noise then passes at the chosen rate. *Decision.*
const CELLS_PER_INDEPENDENT: f64 = 0.8;

/// Relative accuracy of the threshold from [`ratio_for_chance`]. *Numeric.*
const RATIO_TOLERANCE: f64 = 1e-3;
/// Highest threshold that [`ratio_for_chance`] gives. *Numeric.*
const RATIO_MAX: f64 = 1e9;

/// Frequency resolution of a spectrum in its bins.
#[derive(Clone, Copy, Debug)]
pub(super) struct Resolution {
    /// Half width of the main lobe of the window, in resolution cells.
    pub(super) lobe_half_cells: f64,
    /// Bins in a resolution cell.
    pub(super) cell_bins: f64,
}

/// Index of the loudest local maximum of a band; `None` where the band has none.
pub(super) fn loudest_bin(power: &[f64], first: usize, last: usize) -> Option<usize> {
    let (first, last) = (first.max(1), last.min(power.len().saturating_sub(2)));
    (first..=last)
        .filter(|&bin| power[bin] > power[bin - 1] && power[bin] >= power[bin + 1])
        .max_by(|&a, &b| power[a].total_cmp(&power[b]))
}

/// Ratio α of a peak's power to the median of its surroundings that noise alone exceeds with probability `chance`, in a band of
/// `band_cells` resolution cells.
///
/// The probability that one cell exceeds α times the median of M independent cells is Π (M − i) / (M − i + α), i = 0 … M/2 − 1
/// (order-statistic CFAR; Rohling, IEEE Trans. Aerospace and Electronic Systems 19, 1983). A band of N cells has N times this
/// probability.
pub(super) fn ratio_for_chance(band_cells: f64, chance: f64) -> f64 {
    let reference_cells = (2.0 * SIDE_CELLS / CELLS_PER_INDEPENDENT).floor();
    let half = (reference_cells / 2.0) as u32;
    let chance_of = |ratio: f64| -> f64 {
        let single: f64 = (0..half).map(|i| reference_cells - f64::from(i)).map(|left| left / (left + ratio)).product();
        band_cells.max(1.0) * single
    };
    // the chance falls with the ratio: bisection on a logarithmic scale
    let (mut low, mut high) = (1.0f64, RATIO_MAX);
    while high / low > 1.0 + RATIO_TOLERANCE {
        let middle = (low * high).sqrt();
        if chance_of(middle) > chance { low = middle } else { high = middle }
    }
    high
}

/// Ratio of the power of a peak to the median power of its surroundings. `None` where the surroundings are empty or silent.
pub(super) fn over_sides(
    power: &[f64],
    peak: usize,
    Resolution { lobe_half_cells, cell_bins }: Resolution,
    scratch: &mut Vec<f64>,
) -> Option<f64> {
    let near_cells = lobe_half_cells + 0.5;
    let near = (near_cells * cell_bins).round() as usize;
    let far = ((near_cells + SIDE_CELLS) * cell_bins).round() as usize;
    scratch.clear();
    // bin 0 holds the offset of the converter, not sound
    scratch
        .extend_from_slice(power.get(peak.saturating_sub(far).max(1)..peak.saturating_sub(near)).unwrap_or_default());
    scratch.extend_from_slice(power.get(peak + near + 1..(peak + far + 1).min(power.len())).unwrap_or_default());
    median(scratch).filter(|&floor| floor > 0.0).map(|floor| power[peak] / floor)
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone_signal::peak::peak_offset_bins;
    use hovertone_signal::spectrogram::{Stft, Window};
    use std::f64::consts::TAU;

    fn bias_cells(zero_pad_factor: u32) -> f64 {
        let (rate, window_s) = (8000.0, 0.1);
        (0..200)
            .map(|step| {
                let hz = 1000.0 + 10.0 * f64::from(step) / 200.0;
                let signal: Vec<f32> = (0..800).map(|n| (TAU * hz * f64::from(n) / rate).cos() as f32).collect();
                let mut stft = Stft::<f64>::new(rate, Window::Hann, window_s, window_s, zero_pad_factor);
                let mut error = f64::NAN;
                stft.push(&signal, |frame| {
                    let bin = loudest_bin(frame.power, 0, frame.power.len()).unwrap();
                    let offset =
                        peak_offset_bins(frame.power[bin - 1], frame.power[bin], frame.power[bin + 1]).unwrap_or(0.0);
                    error = ((bin as f64 + offset) * frame.bin_hz - hz).abs() * window_s;
                });
                assert!(error.is_finite());
                error
            })
            .fold(0.0, f64::max)
    }

    #[test]
    fn the_interpolated_peak_has_the_stated_bias() {
        let (plain, padded) = (bias_cells(1), bias_cells(2));
        assert!((0.012..0.017).contains(&plain), "{plain}");
        assert!(padded < 0.0017, "{padded}");
    }

    #[test]
    fn noise_passes_for_a_point_as_often_as_the_setting_says() {
        use rand::SeedableRng;
        use rand_distr::{Distribution, StandardNormal};
        let mut rng = rand_pcg::Pcg64::seed_from_u64(7);
        let signal: Vec<f32> = (0..16000 * 60).map(|_| StandardNormal.sample(&mut rng)).collect();
        for (hz, band_hz, window_s) in
            [(4000.0, 640.0, 0.05), (4000.0, 640.0, 0.2), (180.0, 28.0, 0.2), (180.0, 28.0, 0.4)]
        {
            let mut stft = Stft::<f64>::new(16000.0, Window::Hann, window_s, window_s, 2);
            let (cell_hz, chance) = (stft.resolution_hz(), 0.02);
            let ratio = ratio_for_chance(band_hz / cell_hz, chance);
            let (mut frames, mut points, mut scratch) = (0, 0, Vec::new());
            stft.push(&signal, |frame| {
                let first = ((hz - band_hz / 2.0) / frame.bin_hz).ceil() as usize;
                let last = ((hz + band_hz / 2.0) / frame.bin_hz).floor() as usize;
                frames += 1;
                let resolution = Resolution { lobe_half_cells: 2.0, cell_bins: cell_hz / frame.bin_hz };
                let over = loudest_bin(frame.power, first, last)
                    .and_then(|bin| over_sides(frame.power, bin, resolution, &mut scratch));
                points += usize::from(over.is_some_and(|over| over >= ratio));
            });
            let share = points as f64 / f64::from(frames);
            // three standard deviations of a count, and a factor of two for cells that are not quite independent
            let slack = 3.0 * (chance / f64::from(frames)).sqrt();
            assert!(share < 2.0 * chance + slack, "{hz} Hz in {window_s} s: {share}");
            assert!(share + slack > chance / 3.0, "{hz} Hz in {window_s} s: {share}");
        }
    }

    #[test]
    fn a_slope_has_no_peak() {
        assert_eq!(peak_offset_bins(1.0, 2.0, 3.0), None);
        assert_eq!(peak_offset_bins(2.0, 2.0, 2.0), None);
        assert_eq!(loudest_bin(&[5.0, 4.0, 3.0, 2.0, 1.0], 0, 4), None);
        assert_eq!(loudest_bin(&[], 0, 4), None);
        assert_eq!(peak_offset_bins(1.0, 4.0, 1.0), Some(0.0));
        assert_eq!(peak_offset_bins(1.0, 4.0, 4.0), Some(0.5));
    }
}
