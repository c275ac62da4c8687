//! The views of a recording: bands of frequencies for its pictures.

use super::PictureConfig;
use hovertone_analysis::RotorTone;

/// A band of frequencies with the length of its frames.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PictureView {
    /// Number of the harmonic in its middle, 1 for the tone itself; absent for all frequencies.
    pub harmonic: Option<u32>,
    /// Lowest frequency.
    pub hz_low: f64,
    /// Highest frequency.
    pub hz_high: f64,
    /// Length of its frames.
    pub window_s: f64,
}

/// All frequencies up to a little above the highest followed harmonic, and each of these harmonics alone, of all rotors. Without a tone, all
/// frequencies of the recording.
pub fn views_of_recording(tone: Option<&RotorTone>, sample_rate_hz: f64, config: &PictureConfig) -> Vec<PictureView> {
    let nyquist_hz = sample_rate_hz / 2.0;
    let bands = tone.map_or(&[][..], |tone| &tone.bands);
    let top_hz =
        bands.iter().map(|band| band.band_hz_high + 2.0 * config.margin_share * band.width_hz()).reduce(f64::max);
    let whole = PictureView {
        harmonic: None,
        hz_low: 0.0,
        hz_high: top_hz.map_or(nyquist_hz, |top_hz| top_hz.min(nyquist_hz)),
        window_s: config.window_s,
    };
    let zooms = bands.iter().map(|band| {
        // separated rotors may lie beside the band
        let rotors = tone.map_or(&[][..], |tone| &tone.rotors);
        let points = || rotors.iter().flat_map(|rotor| &rotor.track);
        let lines_hz = || points().map(|point| band.order.lines_per_turn() * point.speed_rev_s);
        let (low_hz, high_hz) =
            (lines_hz().fold(band.band_hz_low, f64::min), lines_hz().fold(band.band_hz_high, f64::max));
        let margin_hz = config.margin_share * (high_hz - low_hz);
        PictureView {
            harmonic: Some(band.harmonic),
            hz_low: (low_hz - margin_hz).max(0.0),
            hz_high: (high_hz + margin_hz).min(nyquist_hz),
            window_s: config.zoom_window_s,
        }
    });
    [whole].into_iter().chain(zooms).collect()
}
