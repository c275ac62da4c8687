//! Frames and bands → ridges: for each harmonic a curve of frequency over time, with explicit gaps.

mod gaussian;
mod maximum_trace;
mod peak;

pub use peak::peak_offset_bins;

use crate::config::{Method, RidgeConfig, SpectrogramConfig};
use crate::spectrogram::{Frame, Stft, power_db};
use crate::tone::Band;
use serde::Serialize;

/// What a frame shows of a tone.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Peak {
    /// Frequency by Maximum Trace.
    pub maximum_hz: f64,
    /// Frequency by the Gaussian approximation.
    pub gaussian_hz: f64,
    /// Width of that Gaussian.
    pub gaussian_std_hz: f64,
    /// Level of the peak, dB re a full-scale sine.
    pub level_db: f64,
    /// Level of the peak over the median of its surroundings.
    pub over_sides_db: f64,
    /// Whether the peak is the band's first or last bin.
    pub is_on_edge: bool,
}

impl Peak {
    /// Frequency by a method.
    pub fn hz(&self, method: Method) -> f64 {
        match method {
            Method::MaximumTrace => self.maximum_hz,
            Method::Gaussian => self.gaussian_hz,
        }
    }
}

/// One frame of a ridge: a peak, or a gap where nothing stands out of the noise.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RidgeFrame {
    /// Middle of the frame on the recording's clock.
    pub time_s: f64,
    /// What the frame shows.
    pub peak: Option<Peak>,
}

/// The curve of one harmonic.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Ridge {
    /// Where it was looked for.
    pub band: Band,
    /// Length of its frames.
    pub window_s: f64,
    /// Distance between bins that are independent in noise.
    pub resolution_hz: f64,
    /// All frames in order of time, gaps included.
    pub frames: Vec<RidgeFrame>,
    /// Share of the frames whose peak is a line beyond doubt.
    pub line_share: f64,
}

impl Ridge {
    /// The frequencies of a method, gaps left out.
    pub fn points_hz(&self, method: Method) -> Vec<f64> {
        self.frames.iter().filter_map(|frame| frame.peak.map(|peak| peak.hz(method))).collect()
    }

    /// Share of the frames that have a point.
    pub fn point_share(&self) -> f64 {
        self.frames.iter().filter(|frame| frame.peak.is_some()).count() as f64 / self.frames.len().max(1) as f64
    }
}

/// Draws the ridges of all bands at one frame length, from a stream of samples.
pub(crate) struct RidgeTracer {
    stft: Stft,
    window_s: f64,
    config: RidgeConfig,
    ridges: Vec<(Band, Vec<RidgeFrame>, usize)>,
    scratch: Vec<f64>,
}

impl RidgeTracer {
    pub(crate) fn new(
        (window_s, hover_s): (f64, f64),
        bands: &[Band],
        sample_rate_hz: f64,
        spectrogram: &SpectrogramConfig,
        config: &RidgeConfig,
    ) -> Self {
        let hop_s = spectrogram.hop_s(window_s, hover_s);
        Self {
            stft: Stft::new(sample_rate_hz, spectrogram.window, window_s, hop_s, spectrogram.zero_pad_factor),
            window_s,
            config: *config,
            ridges: bands.iter().map(|&band| (band, Vec::new(), 0)).collect(),
            scratch: Vec::new(),
        }
    }

    /// A new stretch of sound begins at `start_s`.
    pub(crate) fn restart(&mut self, start_s: f64) {
        self.stft.restart(start_s);
    }

    pub(crate) fn push(&mut self, samples: &[f32]) {
        let Self { stft, config, ridges, scratch, .. } = self;
        let resolution_hz = stft.resolution_hz();
        stft.push(samples, |frame| {
            for (band, frames, line_count) in ridges.iter_mut() {
                let peak = peak_from_frame(&frame, band, resolution_hz, config, scratch);
                *line_count += usize::from(peak.is_some_and(|p| p.over_sides_db >= config.line_over_sides_db));
                frames.push(RidgeFrame { time_s: frame.centre_s, peak });
            }
        });
    }

    pub(crate) fn finish(self) -> Vec<Ridge> {
        let resolution_hz = self.stft.resolution_hz();
        let window_s = self.window_s;
        self.ridges
            .into_iter()
            .map(|(band, frames, line_count)| {
                let line_share = line_count as f64 / frames.len().max(1) as f64;
                Ridge { band, window_s, resolution_hz, frames, line_share }
            })
            .collect()
    }
}

/// What one frame shows in one band; `None` where the peak could be noise.
///
/// In noise the power of a cell is exponential with median ln 2 times its mean, so the loudest of N cells exceeds
/// ln(N / p) / ln 2 times the median with chance p.
fn peak_from_frame(
    frame: &Frame<'_>,
    band: &Band,
    resolution_hz: f64,
    config: &RidgeConfig,
    scratch: &mut Vec<f64>,
) -> Option<Peak> {
    let first = (band.band_hz_low / frame.bin_hz).ceil() as usize;
    let last = (band.band_hz_high / frame.bin_hz).floor() as usize;
    let bin = peak::loudest_bin(frame.power, first, last)?;
    let over_sides = peak::over_sides(frame.power, bin, resolution_hz / frame.bin_hz, scratch)?;
    let cells = ((band.band_hz_high - band.band_hz_low) / resolution_hz).max(1.0);
    if over_sides < (cells / config.false_point_chance).ln() / std::f64::consts::LN_2 {
        return None;
    }
    let maximum_hz = maximum_trace::maximum_hz(frame.power, bin, frame.bin_hz);
    let gaussian = gaussian::gaussian_peak(
        frame.power,
        first,
        last,
        frame.power[bin],
        config.gaussian_threshold_share,
        frame.bin_hz,
    );
    Some(Peak {
        maximum_hz,
        gaussian_hz: gaussian.map_or(maximum_hz, |gaussian| gaussian.centre_hz),
        gaussian_std_hz: gaussian.map_or(0.0, |gaussian| gaussian.std_hz),
        level_db: power_db(frame.power[bin]),
        over_sides_db: power_db(over_sides),
        is_on_edge: bin <= first || bin >= last,
    })
}
