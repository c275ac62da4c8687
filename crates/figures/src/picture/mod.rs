//! From samples to pictures: the spectrogram pooled to a bounded number of columns and rows, and the mean spectrum of the hover.
//!
//! This is a separate pass over the sound after the analysis, only where a figure is wanted. A cell has the largest power of its frames
//! and bins, so that a line of one bin stays visible at any size. Memory does not grow with the length of the recording: when all columns
//! are used, neighbours are pooled in pairs.

mod pooling;
mod settings;
mod view;
mod whitening;

pub use settings::PictureConfig;
pub use view::{PictureView, views_of_recording};
pub use whitening::whitened;

use hovertone_analysis::Span;
use hovertone_signal::passes::{Passes, Piece};
use hovertone_signal::spectrogram::{Frame, Stft, power_db};
use hovertone_signal::{SignalError, SignalSource};
use hovertone_vehicle::ConfigError;
use pooling::Pooling;

/// A spectrogram of bounded size.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// The requested view.
    pub view: PictureView,
    /// From the left edge of the first column to the right edge of the last, on the clock of the recording.
    pub span: Span,
    /// Lower edge of the first row.
    pub hz_low: f64,
    /// Upper edge of the last row.
    pub hz_high: f64,
    /// Number of columns, in order of time.
    pub column_count: usize,
    /// Number of rows, from low frequency to high.
    pub row_count: usize,
    /// Level of every cell, dB re a full-scale sine, column by column: the level of row r and column c has the index `c * row_count + r`.
    pub level_db: Vec<f32>,
}

impl Picture {
    /// The levels of one column, from low frequency to high.
    pub fn column(&self, column: usize) -> &[f32] {
        self.level_db.get(column * self.row_count..(column + 1) * self.row_count).unwrap_or_default()
    }
}

/// Mean power over the frames within a hover.
#[derive(Clone, Debug, PartialEq)]
pub struct MeanSpectrum {
    /// Distance between bins; the first bin is at 0 Hz.
    pub bin_hz: f64,
    /// Level of each bin, dB re a full-scale sine.
    pub level_db: Vec<f32>,
    /// Number of frames.
    pub frame_count: usize,
}

/// The pictures of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Pictures {
    /// One picture for each view, in the order of the views; views without a frame are left out.
    pub pictures: Vec<Picture>,
    /// The mean spectrum of the hover; absent where no frame fits into it.
    pub spectrum: Option<MeanSpectrum>,
}

/// Reason for a missing picture.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PictureError {
    /// A setting out of range.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The sound could not be read.
    #[error(transparent)]
    Signal(#[from] SignalError),
}

/// Reads a source once. Pools the spectrogram of the part `shown` into one picture for each view, and the frames within `hover` into a
/// mean spectrum. The length of the frames is that of the view; for the mean spectrum it is [`PictureConfig::zoom_window_s`].
///
/// # Errors
/// Settings out of range, a source that fails.
pub fn pictures_from_source(
    source: &mut dyn SignalSource,
    shown: Span,
    views: &[PictureView],
    hover: &[Span],
    config: &PictureConfig,
) -> Result<Pictures, PictureError> {
    config.check()?;
    let on_progress = &mut |_| {};
    let mut passes = Passes::planned(source, 1, on_progress)?;
    let sample_rate_hz = passes.sample_rate_hz();
    let hop_s = |window_s: f64| window_s * config.hop_share;
    let mut windows_s: Vec<f64> = views.iter().map(|view| view.window_s).chain([config.zoom_window_s]).collect();
    windows_s.sort_by(f64::total_cmp);
    windows_s.dedup();
    let mut transforms: Vec<(f64, Stft)> = windows_s
        .into_iter()
        .map(|window_s| (window_s, Stft::new(sample_rate_hz, config.window, window_s, hop_s(window_s), 1)))
        .collect();
    let mut poolings: Vec<Option<Pooling>> = views
        .iter()
        .map(|view| {
            let (_, stft) = transforms.iter().find(|(window_s, _)| *window_s == view.window_s)?;
            Pooling::new(*view, stft.bin_hz(), sample_rate_hz / 2.0, config)
        })
        .collect();
    let mut spectrum = SpectrumSum::default();
    let shown_s = shown.from_s..shown.to_s;
    passes.pieces(std::slice::from_ref(&shown_s), |piece| match piece {
        Piece::Start(start_s) => transforms.iter_mut().for_each(|(_, stft)| stft.restart(start_s)),
        Piece::Samples(samples) => {
            for (window_s, stft) in &mut transforms {
                stft.push(samples, |frame| {
                    let of_this_length =
                        poolings.iter_mut().flatten().filter(|pooling| pooling.view().window_s == *window_s);
                    of_this_length.for_each(|pooling| pooling.push(&frame));
                    if *window_s == config.zoom_window_s {
                        spectrum.push(&frame, *window_s, hover);
                    }
                });
            }
        }
        Piece::Heard(_) => {}
    })?;
    let finished = |pooling: Option<Pooling>| {
        let pooling = pooling?;
        let hop_s = hop_s(pooling.view().window_s);
        pooling.finish(hop_s)
    };
    Ok(Pictures { pictures: poolings.into_iter().filter_map(finished).collect(), spectrum: spectrum.finish() })
}

/// The sum of the spectra of a hover.
#[derive(Default)]
struct SpectrumSum {
    power: Vec<f64>,
    bin_hz: f64,
    frame_count: usize,
}

impl SpectrumSum {
    fn push(&mut self, frame: &Frame<'_>, window_s: f64, hover: &[Span]) {
        let (from_s, to_s) = (frame.centre_s - window_s / 2.0, frame.centre_s + window_s / 2.0);
        if !hover.iter().any(|span| span.from_s <= from_s && to_s <= span.to_s) {
            return;
        }
        self.power.resize(frame.power.len(), 0.0);
        self.power.iter_mut().zip(frame.power).for_each(|(sum, power)| *sum += power);
        self.bin_hz = frame.bin_hz;
        self.frame_count += 1;
    }

    fn finish(self) -> Option<MeanSpectrum> {
        let mean_db = |sum: f64| power_db(sum / self.frame_count as f64) as f32;
        (self.frame_count > 0).then(|| MeanSpectrum {
            bin_hz: self.bin_hz,
            level_db: self.power.iter().map(|&sum| mean_db(sum)).collect(),
            frame_count: self.frame_count,
        })
    }
}

#[cfg(test)]
mod tests;
