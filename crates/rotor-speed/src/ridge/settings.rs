//! Settings of frames and their spectra, and of the decision when a ridge is a tone.

use hovertone_analysis::HEARD_SHARE_MIN;
use hovertone_signal::spectrogram::Window;
use hovertone_vehicle::{ConfigError, check_range};
use serde::{Deserialize, Serialize};

/// Frames and their spectra (paper, eq 5).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SpectrogramConfig {
    /// Length of a frame, s. Where absent, the length between 0.0125 and 0.4 s that shows lines in most frames: short frames suit a high
    /// order of varying speed, long frames a low order of steady speed.
    pub window_s: Option<f64>,
    /// Step between frames, as a share of their length. With one half, Hann windows add up to a constant, so that every sample has the
    /// same weight.
    pub hop_share: f64,
    /// Largest number of frames of a ridge. In a longer hover the step between frames grows, so that memory does not grow with the length
    /// of the recording. 12 000 of the shortest frames cover 75 s without gaps.
    pub frames_max: u32,
    /// Largest number of frames of each length where the question is only whether there are lines. The standard error of a share of 256
    /// frames is 3 %.
    pub verdict_frames_max: u32,
    /// Shape of the window.
    pub window: Window,
    /// Length of the transform in windows. With 2, the bias of an interpolated peak is 0.0017 bins of a transform without zero padding.
    pub zero_pad_factor: u32,
}

/// Frame lengths that are tried where none is given, s. *Decision.*
const WINDOW_LADDER_S: [f64; 6] = [0.0125, 0.025, 0.05, 0.1, 0.2, 0.4];

impl Default for SpectrogramConfig {
    fn default() -> Self {
        Self {
            window_s: None,
            hop_share: 0.5,
            frames_max: 12_000,
            verdict_frames_max: 256,
            window: Window::Hann,
            zero_pad_factor: 2,
        }
    }
}

impl SpectrogramConfig {
    pub(crate) fn check(&self) -> Result<(), ConfigError> {
        if let Some(window_s) = self.window_s {
            check_range("window_s", window_s, 0.005, 2.0)?;
        }
        check_range("hop_share", self.hop_share, 0.02, 1.0)?;
        check_range("frames_max", f64::from(self.frames_max), 100.0, 1e5)?;
        check_range("verdict_frames_max", f64::from(self.verdict_frames_max), 20.0, 1e5)?;
        check_range("zero_pad_factor", f64::from(self.zero_pad_factor), 1.0, 8.0)
    }

    /// Step between frames of length `window_s` in a hover of length `hover_s`, s.
    pub(crate) fn hop_s(&self, window_s: f64, hover_s: f64, frames_max: u32) -> f64 {
        (self.hop_share * window_s).max(hover_s / f64::from(frames_max))
    }

    /// The frame lengths for a tone whose first band has a width of `band_width_hz`, s. The main lobe must fit in the band on either side of
    /// the tone; in a shorter frame, noise in the band would look like a line.
    pub(crate) fn ladder_s(&self, band_width_hz: f64) -> Vec<f64> {
        let window_s_min = self.window.main_lobe_half_bins() / (band_width_hz / 2.0);
        let longest_s = WINDOW_LADDER_S[WINDOW_LADDER_S.len() - 1];
        WINDOW_LADDER_S.into_iter().filter(|&s| s >= window_s_min || s == longest_s).collect()
    }
}

/// Settings of a ridge, and of the decision when it is a tone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RidgeConfig {
    /// Smallest modulus that counts for the Gaussian, as a share of the peak. The paper uses 0.8; by its remark 5, values from 0.5 to 0.9
    /// change little.
    pub gaussian_threshold_share: f64,
    /// Probability that noise alone gives a point of the ridge in a frame. With 0.02, one in fifty frames without the tone has a point
    /// somewhere in the band.
    pub false_point_chance: f64,
    /// Smallest height of a line over the median of its surroundings, dB. Noise reaches 16 dB in one frame of a hundred, the lines of
    /// real hovers in 60 to 100 % of the frames.
    pub line_over_sides_db: f64,
    /// Share of the hover in which lines keep their phase in blocks of a second and more, from which they are those of one rotor: on a bench or in a
    /// simulation it can be so steady; no rotor in flight is.
    pub steady_share_min: f64,
    /// Smallest share of frames with a point at which a ridge is used.
    pub point_share_min: f64,
    /// Largest difference of the mean speed of a harmonic from the reference harmonic at which the harmonic is used, as a share.
    pub harmonic_disagreement_share_max: f64,
}

impl Default for RidgeConfig {
    fn default() -> Self {
        Self {
            gaussian_threshold_share: 0.8,
            false_point_chance: 0.02,
            line_over_sides_db: 16.0,
            steady_share_min: 0.8,
            point_share_min: HEARD_SHARE_MIN,
            harmonic_disagreement_share_max: 0.01,
        }
    }
}

impl RidgeConfig {
    pub(crate) fn check(&self) -> Result<(), ConfigError> {
        check_range("gaussian_threshold_share", self.gaussian_threshold_share, 0.3, 0.95)?;
        check_range("false_point_chance", self.false_point_chance, 1e-9, 0.5)?;
        check_range("line_over_sides_db", self.line_over_sides_db, 3.0, 60.0)?;
        check_range("steady_share_min", self.steady_share_min, 0.0, 1.0)?;
        check_range("point_share_min", self.point_share_min, 0.0, 1.0)?;
        check_range("harmonic_disagreement_share_max", self.harmonic_disagreement_share_max, 0.0, 0.2)
    }
}
