//! Frames and their spectra, and when a ridge counts as a tone.

use hovertone_signal::spectrogram::Window;
use hovertone_vehicle::{ConfigError, check_range};
use serde::{Deserialize, Serialize};

/// Frames and their spectra (paper, eq 5).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SpectrogramConfig {
    /// Length of a frame. Where absent, the clearest of 0.0125 to 0.4 s is taken: a wandering high order wants short
    /// frames, a steady low one long frames.
    pub window_s: Option<f64>,
    /// Step between frames as a share of their length. At one half, Hann frames use every sample of the sound equally.
    pub hop_share: f64,
    /// Frames of a ridge at most. On a hover so long that the step above would give more, the step grows, so that memory
    /// does not grow with the length of a recording. 12 000 frames cover 75 s in the shortest frames without a gap.
    pub frames_max: u32,
    /// Frames of each length at most where only the question is asked whether there are lines at all: a share of 256 is known to
    /// 3 %.
    pub verdict_frames_max: u32,
    /// Shape of the window.
    pub window: Window,
    /// Length of the transform in windows: 2 brings the bias of the interpolated peak to 0.0017 of a window's bin.
    pub zero_pad_factor: u32,
}

/// Frame lengths that are tried where none is given.
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

    /// Step between frames of a length in a hover of a length.
    pub(crate) fn hop_s(&self, window_s: f64, hover_s: f64, frames_max: u32) -> f64 {
        (self.hop_share * window_s).max(hover_s / f64::from(frames_max))
    }

    /// The frame lengths in which to look for lines of a tone whose first band is this wide. The main lobe must fit in the
    /// band on either side of the tone: in a shorter frame noise of the band's width would look like a line.
    pub(crate) fn ladder_s(&self, band_width_hz: f64) -> Vec<f64> {
        let window_s_min = self.window.main_lobe_half_bins() / (band_width_hz / 2.0);
        let longest_s = WINDOW_LADDER_S[WINDOW_LADDER_S.len() - 1];
        WINDOW_LADDER_S.into_iter().filter(|&s| s >= window_s_min || s == longest_s).collect()
    }
}

/// How a ridge is drawn and when it counts as a tone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RidgeConfig {
    /// Share of a frame's peak that takes part in the Gaussian (paper: 0.8, remark 5: 0.5 to 0.9 change little).
    pub gaussian_threshold_share: f64,
    /// Chance that noise alone puts a point on the ridge of a frame. A frame with the tone has its point there; among the
    /// frames without, one in fifty then has one somewhere in the band.
    pub false_point_chance: f64,
    /// A peak is a line when it stands this far above the median of its surroundings. Noise reaches it in one frame of
    /// a hundred; the lines of real hovers in 60 to 100 % of frames.
    pub line_over_sides_db: f64,
    /// Share of frames in which the clearest harmonic must be a line. Rotors recorded in flight give 0.64 to 1.00,
    /// machinery and traffic that only resembles a rotor up to 0.45.
    pub line_share_min: f64,
    /// Share of frames in which a second harmonic must be a line too …
    pub company_share_min: f64,
    /// … unless the clearest is one in this share of frames.
    pub lonely_line_share_min: f64,
    /// … or lines keep their phase, in blocks of a second and more, over this share of the hover: a tone so steady is a tone
    /// however weak it is. No rotor in flight is; one on a bench, or a simulated one, can be.
    pub steady_share_min: f64,
    /// Share of frames with a point below which a ridge is not used.
    pub point_share_min: f64,
    /// Harmonics whose mean differs from the clearest one's by more than this share are left out.
    pub harmonic_disagreement_share_max: f64,
}

impl Default for RidgeConfig {
    fn default() -> Self {
        Self {
            gaussian_threshold_share: 0.8,
            false_point_chance: 0.02,
            line_over_sides_db: 16.0,
            line_share_min: 0.5,
            company_share_min: 0.1,
            lonely_line_share_min: 0.85,
            steady_share_min: 0.8,
            point_share_min: 0.3,
            harmonic_disagreement_share_max: 0.01,
        }
    }
}

impl RidgeConfig {
    pub(crate) fn check(&self) -> Result<(), ConfigError> {
        check_range("gaussian_threshold_share", self.gaussian_threshold_share, 0.3, 0.95)?;
        check_range("false_point_chance", self.false_point_chance, 1e-9, 0.5)?;
        check_range("line_over_sides_db", self.line_over_sides_db, 3.0, 60.0)?;
        check_range("line_share_min", self.line_share_min, 0.0, 1.0)?;
        check_range("company_share_min", self.company_share_min, 0.0, 1.0)?;
        check_range("lonely_line_share_min", self.lonely_line_share_min, 0.0, 1.0)?;
        check_range("steady_share_min", self.steady_share_min, 0.0, 1.0)?;
        check_range("point_share_min", self.point_share_min, 0.0, 1.0)?;
        check_range("harmonic_disagreement_share_max", self.harmonic_disagreement_share_max, 0.0, 0.2)
    }
}
