//! Frames and bands → ridges: for each harmonic, the frequency of its peak in each frame, with gaps where the peak may be noise.

mod gaussian;
mod maximum_trace;
mod peak;
mod settings;

pub use settings::{RidgeConfig, SpectrogramConfig};

use hovertone_analysis::{Band, Peak, Ridge, RidgeFrame};
use hovertone_signal::passes::StretchListener;
use hovertone_signal::spectrogram::{Frame, Stft, power_db};
use peak::Resolution;

/// Traces the ridges of all bands at one frame length, from a stream of samples.
pub(crate) struct RidgeTracer {
    stft: Stft,
    window_s: f64,
    hop_s: f64,
    lobe_half_cells: f64,
    config: RidgeConfig,
    ridges: Vec<PartialRidge>,
    scratch: Vec<f64>,
}

/// A ridge up to the latest frame.
struct PartialRidge {
    band: Band,
    /// Smallest ratio of a peak's power to its surroundings at which the peak is a point of the ridge.
    point_ratio: f64,
    frames: Vec<RidgeFrame>,
    /// Number of frames whose peak is a line.
    line_count: usize,
}

impl RidgeTracer {
    /// A tracer with frames of length `window_s` at steps of `hop_s`.
    pub(crate) fn new(
        window_s: f64,
        hop_s: f64,
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
                .map(|&band| PartialRidge {
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
            .map(|PartialRidge { band, frames, line_count, .. }| {
                let line_share = line_count as f64 / frames.len().max(1) as f64;
                Ridge { band, window_s, hop_s, resolution_hz, frames, line_share }
            })
            .collect()
    }
}

impl StretchListener for RidgeTracer {
    fn restart(&mut self, start_s: f64, _length_s: f64) {
        self.stft.restart(start_s);
    }

    fn push(&mut self, samples: &[f32]) {
        let Self { stft, config, ridges, scratch, lobe_half_cells, .. } = self;
        let cell_hz = stft.resolution_hz();
        stft.push(samples, |frame| {
            for ridge in ridges.iter_mut() {
                let resolution = Resolution { lobe_half_cells: *lobe_half_cells, cell_bins: cell_hz / frame.bin_hz };
                let peak = peak_from_frame(&frame, ridge, resolution, config.gaussian_threshold_share, scratch);
                ridge.line_count += usize::from(peak.is_some_and(|p| p.over_sides_db >= config.line_over_sides_db));
                ridge.frames.push(RidgeFrame { time_s: frame.centre_s, peak });
            }
        });
    }
}

/// The peak of one frame in one band; `None` where the band has no peak or the peak may be noise.
fn peak_from_frame(
    frame: &Frame<'_>,
    ridge: &PartialRidge,
    resolution: Resolution,
    gaussian_threshold_share: f64,
    scratch: &mut Vec<f64>,
) -> Option<Peak> {
    let first = (ridge.band.band_hz_low / frame.bin_hz).ceil() as usize;
    let last = (ridge.band.band_hz_high / frame.bin_hz).floor() as usize;
    let bin = peak::loudest_bin(frame.power, first, last)?;
    let over_sides = peak::over_sides(frame.power, bin, resolution, scratch)
        .filter(|&over_sides| over_sides >= ridge.point_ratio)?;
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
