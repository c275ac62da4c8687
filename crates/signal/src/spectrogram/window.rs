//! Window functions of a frame (Harris, Proc. IEEE 66, 1978).

use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Cosine terms a_k of the Hann window, `w[n] = Σ a_k cos(2πkn/N)`. *Physics.*
const HANN_TERMS: [f64; 2] = [0.5, -0.5];
/// Cosine terms of the Hamming window. *Physics.*
const HAMMING_TERMS: [f64; 2] = [0.54, -0.46];
/// Cosine terms of the Blackman window. *Physics.*
pub(super) const BLACKMAN_TERMS: [f64; 3] = [0.42, -0.5, 0.08];

/// Weights `w[n] = 0.5 − 0.5 cos(2π (n + ½) / N)`, n = 0 … N − 1: a Hann window symmetric about the middle of its N samples.
pub fn hann_weights(length: usize) -> impl Iterator<Item = f64> {
    (0..length).map(move |n| 0.5 - 0.5 * (TAU * (n as f64 + 0.5) / length as f64).cos())
}

/// Variance of the time in a Hann frame, as a share of its squared length: 1/12 − 1/2π², doubled for a weight of mean ½. *Physics.*
const HANN_TIME_VARIANCE: f64 = 1.0 / 12.0 - 2.0 / (TAU * TAU);

/// What a Hann frame sees of a frequency that changes within it: the frequency of highest power, for a line that keeps within a fraction of a
/// cycle of a steady one, is the mean of the instantaneous frequency with this weight. `share` is the distance from the middle of the frame over
/// its length, −½ to ½; the integral of the weight over `share` is 1.
///
/// To second order in the phase φ, the power at an offset ν is highest where Σ w (φ − 2πνt)² is least: ν is the slope of φ weighted by w, and by
/// parts the weight of the frequency at s is ∫ₛ w u du / ∫ w u² du, here with w = 1 + cos(2πu).
pub fn hann_frequency_weight(share: f64) -> f64 {
    let moment = |u: f64| 0.5 * u * u + (u * (TAU * u).sin() + (TAU * u).cos() / TAU) / TAU;
    if share.abs() >= 0.5 { 0.0 } else { (moment(0.5) - moment(share)) / HANN_TIME_VARIANCE }
}

/// Shape of the window `w[n]` in eq 5 of the paper, in the periodic form: N cosines of period N, as spectral analysis uses it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Window {
    /// Main lobe 4 bins wide; side lobes fall by 18 dB per octave from −31 dB.
    Hann,
    /// Main lobe 4 bins wide; side lobes flat near −43 dB.
    Hamming,
    /// Main lobe 6 bins wide; side lobes below −58 dB.
    Blackman,
    /// Main lobe 2 bins wide; side lobes from −13 dB, so that weak lines vanish beside strong ones.
    Rectangular,
}

impl Window {
    /// The weights `w[0] … w[N − 1]` of a frame of N = `sample_count` samples.
    pub fn values(self, sample_count: usize) -> Vec<f64> {
        let cosine = |terms: &[f64]| {
            (0..sample_count)
                .map(|n| {
                    let turn = TAU * n as f64 / sample_count as f64;
                    terms.iter().enumerate().map(|(k, a)| a * (turn * k as f64).cos()).sum()
                })
                .collect()
        };
        match self {
            Self::Hann => cosine(&HANN_TERMS),
            Self::Hamming => cosine(&HAMMING_TERMS),
            Self::Blackman => cosine(&BLACKMAN_TERMS),
            Self::Rectangular => cosine(&[1.0]),
        }
    }

    /// Half width of the main lobe, in bins of a transform without zero padding: two lines closer than this form one peak.
    pub fn main_lobe_half_bins(self) -> f64 {
        match self {
            Self::Hann | Self::Hamming => 2.0,
            Self::Blackman => 3.0,
            Self::Rectangular => 1.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_equivalent_noise_bandwidths_are_the_textbooks() {
        // Harris, Proc. IEEE 66 (1978), table 1
        for (window, bins) in
            [(Window::Hann, 1.5), (Window::Hamming, 1.36), (Window::Blackman, 1.73), (Window::Rectangular, 1.0)]
        {
            let values = window.values(1024);
            let bandwidth = 1024.0 * values.iter().map(|w| w * w).sum::<f64>() / values.iter().sum::<f64>().powi(2);
            assert!((bandwidth - bins).abs() < 0.005, "{window:?}: {bandwidth}");
        }
    }

    #[test]
    fn the_frequency_of_a_frame_is_the_weighted_mean_of_the_frequency() {
        let sum: f64 = (0..1000).map(|at| hann_frequency_weight((f64::from(at) + 0.5) / 1000.0 - 0.5) / 1000.0).sum();
        assert!((sum - 1.0).abs() < 1e-5, "{sum}");
        // a line that jumps by 0.2 cells at a place of the frame: the frequency of its highest power, by a search
        let weights: Vec<f64> = hann_weights(400).collect();
        for jump in [-0.3, -0.1, 0.0, 0.2] {
            let time = |n: usize| (n as f64 + 0.5) / 400.0 - 0.5;
            let power = |hz: f64| {
                let part = |(n, w): (usize, &f64)| {
                    let angle = TAU * (0.2 * (time(n) - jump).max(0.0) - hz * time(n));
                    [w * angle.cos(), w * angle.sin()]
                };
                let sums = weights.iter().enumerate().map(part).fold([0.0, 0.0], |a, b| [a[0] + b[0], a[1] + b[1]]);
                sums[0].hypot(sums[1])
            };
            let found =
                (0..=2000).map(|at| f64::from(at) * 1e-4).max_by(|a, b| power(*a).total_cmp(&power(*b))).unwrap();
            let places = (0..1000).map(|at| (f64::from(at) + 0.5) / 1000.0 - 0.5).filter(|place| *place > jump);
            let expected = 0.2 * places.map(|place| hann_frequency_weight(place) / 1000.0).sum::<f64>();
            assert!((found - expected).abs() < 2e-3, "{jump}: {found} {expected}");
        }
    }
}
