//! Settings of the pictures of a recording.

use hovertone_signal::spectrogram::Window;
use hovertone_vehicle::ConfigError;
use hovertone_vehicle::check_range;
use serde::Serialize;

/// How the spectrogram of a recording is pooled into pictures that no length of the recording makes larger.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PictureConfig {
    /// Shape of the window.
    pub window: Window,
    /// Frame of the picture of all frequencies: its lines are 30 Hz wide, a row of a printed picture, and speech stays apart in time.
    pub window_s: f64,
    /// Frame of the pictures around one harmonic and of the mean spectrum: lines of rotors 0.2 % apart stay apart at 10 kHz.
    pub zoom_window_s: f64,
    /// Step between frames as a share of their length: a click between two frames would be missed beyond a half.
    pub hop_share: f64,
    /// Columns at most, even: what 180 mm hold at 300 dpi.
    pub columns_max: usize,
    /// Rows at most: what 90 mm hold at 150 dpi.
    pub rows_max: usize,
    /// A picture around a harmonic is so much wider than its band, on each side as a share of the band's width.
    pub margin_share: f64,
}

impl Default for PictureConfig {
    fn default() -> Self {
        Self {
            window: Window::Hann,
            window_s: 0.064,
            zoom_window_s: 0.1,
            hop_share: 0.5,
            columns_max: 2048,
            rows_max: 512,
            margin_share: 0.1,
        }
    }
}

impl PictureConfig {
    /// Refuses settings that mean nothing, by name, value and limit.
    pub fn check(&self) -> Result<(), ConfigError> {
        check_range("picture.window_s", self.window_s, 0.001, 10.0)?;
        check_range("picture.zoom_window_s", self.zoom_window_s, 0.001, 10.0)?;
        check_range("picture.hop_share", self.hop_share, 0.05, 1.0)?;
        check_range("picture.columns_max", self.columns_max as f64, 16.0, 16_384.0)?;
        check_range("picture.rows_max", self.rows_max as f64, 16.0, 16_384.0)?;
        check_range("picture.margin_share", self.margin_share, 0.0, 10.0)
    }
}
