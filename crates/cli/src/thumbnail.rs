//! A small spectrogram of a recording, for a page with many of them.

use hovertone::speed::SpeedAnalysis;
use hovertone_figures::{PictureConfig, PictureView, Thumbnail, pictures_from_source, thumbnail_uri, whitened};
use hovertone_media::Recording;

/// Pixels from left to right.
const WIDTH: usize = 120;
/// Pixels from bottom to top.
const HEIGHT: usize = 48;
/// Highest frequency, the same in all pictures so that they can be compared: gear meshes lie below it.
pub(crate) const HZ_HIGH: f64 = 5000.0;
/// Level over the floor that is white.
const LEVEL_DB_LOW: f64 = 3.0;
/// Level over the floor that is black.
const LEVEL_DB_HIGH: f64 = 25.0;
/// Length of a frame.
const WINDOW_S: f64 = 0.064;

/// The spectrogram over its floor as the URI of a PNG; `None` where the recording is too short for one, or cannot be read again.
pub(crate) fn thumbnail_of(recording: &mut Recording, analysis: &SpeedAnalysis) -> Option<String> {
    let hz_high = HZ_HIGH.min(recording.info().sample_rate_hz / 2.0);
    let config = PictureConfig {
        window_s: WINDOW_S,
        zoom_window_s: WINDOW_S,
        columns_max: 2 * WIDTH,
        rows_max: HEIGHT,
        ..PictureConfig::default()
    };
    let view = PictureView { harmonic: None, hz_low: 0.0, hz_high, window_s: WINDOW_S };
    let pictures = pictures_from_source(recording, analysis.heard, &[view], &[], &config).ok()?.pictures;
    let thumbnail = Thumbnail {
        hz_high: HZ_HIGH,
        level_db_low: LEVEL_DB_LOW,
        level_db_high: LEVEL_DB_HIGH,
        width_max: WIDTH,
        height_max: HEIGHT,
    };
    thumbnail_uri(&whitened(pictures.first()?), &thumbnail).ok()
}
