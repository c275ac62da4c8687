//! Samples → pictures: the spectrogram pooled to a bounded number of columns and rows, and the mean spectrum of the hover.
//!
//! An own reading of the sound, after the analysis and only where somebody wants to see it. Cells hold the largest power of the frames
//! and bins that fall into them, so that a line one bin wide is seen at any size. Memory does not grow with the length of the recording:
//! when the columns are used up, neighbours are pooled in pairs.

mod pooling;
mod settings;
mod view;

pub use settings::PictureConfig;
pub use view::{PictureView, views_of_recording};

use hovertone_analysis::Span;
use hovertone_signal::passes::{Passes, Piece};
use hovertone_signal::spectrogram::{Frame, Stft, power_db};
use hovertone_signal::{SignalError, SignalSource};
use hovertone_vehicle::ConfigError;
use pooling::Pooling;

/// A spectrogram of bounded size.
#[derive(Clone, Debug, PartialEq)]
pub struct Picture {
    /// What it was meant to show.
    pub view: PictureView,
    /// From the left edge of the first column to the right edge of the last, on the recording's clock.
    pub span: Span,
    /// Lower edge of the first row.
    pub hz_low: f64,
    /// Upper edge of the last row.
    pub hz_high: f64,
    /// Columns, in order of time.
    pub column_count: usize,
    /// Rows, from low frequency to high.
    pub row_count: usize,
    /// Level of every cell, dB re a full-scale sine, column by column: that of row r and column c is at `c * row_count + r`.
    pub level_db: Vec<f32>,
}

impl Picture {
    /// The levels of one column, from low frequency to high.
    pub fn column(&self, column: usize) -> &[f32] {
        self.level_db.get(column * self.row_count..(column + 1) * self.row_count).unwrap_or_default()
    }
}

/// Mean power over the frames that lie within a hover.
#[derive(Clone, Debug, PartialEq)]
pub struct MeanSpectrum {
    /// Distance between bins; the first is at 0 Hz.
    pub bin_hz: f64,
    /// Level of each bin, dB re a full-scale sine.
    pub level_db: Vec<f32>,
    /// Frames that it is the mean of.
    pub frame_count: usize,
}

/// What a reading of a recording gives to look at.
#[derive(Clone, Debug, PartialEq)]
pub struct Pictures {
    /// One picture for each view, in the order of the views; views without a single frame are left out.
    pub pictures: Vec<Picture>,
    /// The mean spectrum of the hover; absent where no frame fits into it.
    pub spectrum: Option<MeanSpectrum>,
}

/// A picture that could not be made.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum PictureError {
    /// A setting without a meaning.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// The sound could not be read.
    #[error(transparent)]
    Signal(#[from] SignalError),
}

/// Reads a source once and pools the spectrogram of the part `shown` into one picture for each view, and the frames within `hover` into a
/// mean spectrum.
/// Frames have the length of the view; those of the spectrum that of [`PictureConfig::zoom_window_s`].
///
/// # Errors
/// Settings that mean nothing, a source that fails.
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
