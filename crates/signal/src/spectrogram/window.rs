//! Windows of a frame.

use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Weights of a Hann window that is symmetric about the middle of its samples.
pub fn hann_weights(length: usize) -> impl Iterator<Item = f64> {
    (0..length).map(move |n| 0.5 - 0.5 * (TAU * (n as f64 + 0.5) / length as f64).cos())
}

/// Shape of the window `w[n]` in eq 5, periodic form (as spectral analysis wants it).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Window {
    /// Main lobe 4 bins wide, side lobes falling by 18 dB per octave from -31 dB.
    Hann,
    /// Main lobe 4 bins wide, side lobes flat near -43 dB.
    Hamming,
    /// Main lobe 6 bins wide, side lobes below -58 dB.
    Blackman,
    /// Main lobe 2 bins wide, side lobes from -13 dB: hides weak lines beside strong ones.
    Rectangular,
}

impl Window {
    /// The window's values over a frame of `sample_count` samples.
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
            Self::Hann => cosine(&[0.5, -0.5]),
            Self::Hamming => cosine(&[0.54, -0.46]),
            Self::Blackman => cosine(&[0.42, -0.5, 0.08]),
            Self::Rectangular => cosine(&[1.0]),
        }
    }

    /// Half the width of the main lobe, in bins of an unpadded frame: lines closer than this melt into one.
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
}
