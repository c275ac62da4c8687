//! The peak of a band, finer than its bins, and how far it stands out.

use hovertone_signal::statistics::median;

/// A peak must stand out of this many resolution cells on either side, which begin half a cell beyond its own main lobe:
/// near enough that the noise has the same colour.
const SIDE_CELLS: f64 = 5.0;
/// So many cells make an independent value of the median: neighbouring cells of a Hann window are correlated, but a
/// transform of two windows shows two values for each. Chosen so that noise passes as often as it is set to (measured by
/// `noise_passes_for_a_point_as_often_as_the_setting_says`).
const CELLS_PER_INDEPENDENT: f64 = 0.8;

/// Index of the loudest bin of a band that is a maximum of its neighbourhood; `None` where the band only slopes.
pub(super) fn loudest_bin(power: &[f64], first: usize, last: usize) -> Option<usize> {
    let (first, last) = (first.max(1), last.min(power.len().saturating_sub(2)));
    (first..=last)
        .filter(|&bin| power[bin] > power[bin - 1] && power[bin] >= power[bin + 1])
        .max_by(|&a, &b| power[a].total_cmp(&power[b]))
}

/// Power ratio over the median of its surroundings that noise exceeds in a band of so many cells with a chance.
///
/// With a median of M independent cells in place of the noise's true one, the chance of a single cell to exceed α times
/// it is Π (M − i) / (M − i + α), i = 0 … M/2 − 1 (order-statistic CFAR: Rohling, IEEE Trans. AES 19, 1983); a band of N
/// cells has N times that.
pub(super) fn ratio_for_chance(band_cells: f64, chance: f64) -> f64 {
    let reference_cells = (2.0 * SIDE_CELLS / CELLS_PER_INDEPENDENT).floor();
    let half = (reference_cells / 2.0) as u32;
    let chance_of = |ratio: f64| -> f64 {
        let single: f64 = (0..half).map(|i| reference_cells - f64::from(i)).map(|left| left / (left + ratio)).product();
        band_cells.max(1.0) * single
    };
    // the chance falls with the ratio: halve the interval, on a scale of ratios, until it is known to a thousandth
    let (mut low, mut high) = (1.0f64, 1e9f64);
    while high / low > 1.001 {
        let middle = (low * high).sqrt();
        if chance_of(middle) > chance { low = middle } else { high = middle }
    }
    high
}

/// Power ratio of a peak over the median of its surroundings, which begin beyond a main lobe of `lobe_half_cells`. `None`
/// where the surroundings are empty or silent.
pub(super) fn over_sides(
    power: &[f64],
    peak: usize,
    (lobe_half_cells, cell_bins): (f64, f64),
    scratch: &mut Vec<f64>,
) -> Option<f64> {
    let near_cells = lobe_half_cells + 0.5;
    let near = (near_cells * cell_bins).round() as usize;
    let far = ((near_cells + SIDE_CELLS) * cell_bins).round() as usize;
    scratch.clear();
    // bin 0 holds the offset of the sound card, not sound
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
                let over = loudest_bin(frame.power, first, last)
                    .and_then(|bin| over_sides(frame.power, bin, (2.0, cell_hz / frame.bin_hz), &mut scratch));
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
