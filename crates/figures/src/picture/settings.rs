//! Settings of the pictures of a recording.

use hovertone_signal::spectrogram::Window;
use hovertone_vehicle::ConfigError;
use hovertone_vehicle::check_range;
use serde::Serialize;

/// Settings of the pooling, which bounds the size of the pictures for recordings of any length.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct PictureConfig {
    /// Window function.
    pub window: Window,
    /// Frame of the picture of all frequencies. Its lines are 30 Hz wide, a row of a printed picture, and syllables of speech stay
    /// separate.
    pub window_s: f64,
    /// Frame of the pictures around one harmonic and of the mean spectrum. Lines of rotors 0.2 % apart stay separate at 10 kHz.
    pub zoom_window_s: f64,
    /// Step between frames as a share of their length. With more than a half, a click between two frames would be missed.
    pub hop_share: f64,
    /// Most columns, an even number: 180 mm at 300 dpi.
    pub columns_max: usize,
    /// Most rows: 90 mm at 150 dpi.
    pub rows_max: usize,
    /// Margin of a picture around a harmonic on each side of its band, as a share of the width of the band.
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
    /// Checks every setting against its limits.
    pub fn check(&self) -> Result<(), ConfigError> {
        check_range("picture.window_s", self.window_s, 0.001, 10.0)?;
        check_range("picture.zoom_window_s", self.zoom_window_s, 0.001, 10.0)?;
        check_range("picture.hop_share", self.hop_share, 0.05, 1.0)?;
        check_range("picture.columns_max", self.columns_max as f64, 16.0, 16_384.0)?;
        check_range("picture.rows_max", self.rows_max as f64, 16.0, 16_384.0)?;
        check_range("picture.margin_share", self.margin_share, 0.0, 10.0)
    }
}
