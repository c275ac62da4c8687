//! Frames and bands → ridges: for each harmonic a curve of frequency over time, with explicit gaps.

mod gaussian;
mod maximum_trace;
mod peak;

pub use peak::peak_offset_bins;

use crate::config::{RidgeConfig, SpectrogramConfig};
use crate::listening::HoverListener;
use crate::method::Method;
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
            Method::Harmonic | Method::Separated | Method::MaximumTrace => self.maximum_hz,
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
    /// Step between frames.
    pub hop_s: f64,
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

    /// Frames that share no sound: how many observations the ridge is worth.
    pub fn independent_frames(&self) -> f64 {
        self.frames.len() as f64 * (self.hop_s / self.window_s).min(1.0)
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
    hop_s: f64,
    lobe_half_cells: f64,
    config: RidgeConfig,
    ridges: Vec<Drawn>,
    scratch: Vec<f64>,
}

/// A ridge that is being drawn.
struct Drawn {
    band: Band,
    /// Power over the surroundings above which a peak is a point.
    point_ratio: f64,
    frames: Vec<RidgeFrame>,
    line_count: usize,
}

impl RidgeTracer {
    pub(crate) fn new(
        (window_s, hop_s): (f64, f64),
        bands: &[Band],
        sample_rate_hz: f64,
        spectrogram: &SpectrogramConfig,
        config: &RidgeConfig,
    ) -> Self {
        Self {
            stft: Stft::new(sample_rate_hz, spectrogram.window, window_s, hop_s, spectrogram.zero_pad_factor),
            window_s,
            config: *config,
            hop_s,
            lobe_half_cells: spectrogram.window.main_lobe_half_bins(),
            ridges: bands
                .iter()
                .map(|&band| Drawn {
                    band,
                    point_ratio: peak::ratio_for_chance(band.width_hz() * window_s, config.false_point_chance),
                    frames: Vec::new(),
                    line_count: 0,
                })
                .collect(),
            scratch: Vec::new(),
        }
    }

    pub(crate) fn finish(self) -> Vec<Ridge> {
        let (window_s, hop_s, resolution_hz) = (self.window_s, self.hop_s, self.stft.resolution_hz());
        self.ridges
            .into_iter()
            .map(|Drawn { band, frames, line_count, .. }| {
                let line_share = line_count as f64 / frames.len().max(1) as f64;
                Ridge { band, window_s, hop_s, resolution_hz, frames, line_share }
            })
            .collect()
    }
}

impl HoverListener for RidgeTracer {
    fn restart(&mut self, start_s: f64, _length_s: f64) {
        self.stft.restart(start_s);
    }

    fn push(&mut self, samples: &[f32]) {
        let Self { stft, config, ridges, scratch, lobe_half_cells, .. } = self;
        let cell_hz = stft.resolution_hz();
        stft.push(samples, |frame| {
            for drawn in ridges.iter_mut() {
                let cells = (*lobe_half_cells, cell_hz / frame.bin_hz);
                let peak = peak_from_frame(&frame, drawn, cells, config.gaussian_threshold_share, scratch);
                drawn.line_count += usize::from(peak.is_some_and(|p| p.over_sides_db >= config.line_over_sides_db));
                drawn.frames.push(RidgeFrame { time_s: frame.centre_s, peak });
            }
        });
    }
}

/// What one frame shows in one band; `None` where the peak could be noise.
fn peak_from_frame(
    frame: &Frame<'_>,
    drawn: &Drawn,
    cells: (f64, f64),
    gaussian_threshold_share: f64,
    scratch: &mut Vec<f64>,
) -> Option<Peak> {
    let first = (drawn.band.band_hz_low / frame.bin_hz).ceil() as usize;
    let last = (drawn.band.band_hz_high / frame.bin_hz).floor() as usize;
    let bin = peak::loudest_bin(frame.power, first, last)?;
    let over_sides =
        peak::over_sides(frame.power, bin, cells, scratch).filter(|&over_sides| over_sides >= drawn.point_ratio)?;
    let maximum_hz = maximum_trace::maximum_hz(frame.power, bin, frame.bin_hz);
    let peak_power = frame.power[bin];
    let gaussian =
        gaussian::gaussian_peak(frame.power, first, last, peak_power, gaussian_threshold_share, frame.bin_hz);
    Some(Peak {
        maximum_hz,
        gaussian_hz: gaussian.map_or(maximum_hz, |gaussian| gaussian.centre_hz),
        gaussian_std_hz: gaussian.map_or(0.0, |gaussian| gaussian.std_hz),
        level_db: power_db(peak_power),
        over_sides_db: power_db(over_sides),
        is_on_edge: bin <= first || bin >= last,
    })
}
