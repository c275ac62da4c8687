//! Frames → rows: mean power spectra of spans of equal length, in a bounded number.

use hovertone_analysis::Span;
use hovertone_signal::spectrogram::{Stft, Window, power_db};

/// Lowest frequency that counts for the loudness of a row, Hz: below are handling noise, wind and traffic. *Decision.*
const LEVEL_HZ_MIN: f64 = 60.0;
/// Largest number of overlapping frames in a row: a row of more frames has a precise mean without overlap. *Numeric.*
const OVERLAPPING_FRAMES_MAX: u32 = 20;

/// One row: the mean power spectrum of a span of time.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    pub(crate) span: Span,
    /// Mean power of each bin; the sum over the frames while the row is built. 24 bits of it suffice, and these rows are most of the memory of an
    /// analysis.
    pub(crate) power: Vec<f32>,
    frame_count: u32,
}

impl Row {
    /// Level of the power above 60 Hz, dB re a sine of full scale.
    pub(crate) fn level_db(&self, bin_hz: f64) -> f64 {
        let first = ((LEVEL_HZ_MIN / bin_hz).ceil() as usize).min(self.power.len());
        power_db(self.power[first..].iter().copied().map(f64::from).sum())
    }
}

/// A recording in rows of equal length.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rows {
    pub(crate) rows: Vec<Row>,
    pub(crate) bin_hz: f64,
}

impl Rows {
    /// Mean power spectrum of all rows. `None` without rows.
    pub(crate) fn mean_power(&self) -> Option<Vec<f64>> {
        mean_power(self.rows.iter())
    }
}

/// Mean power spectrum of rows. `None` without rows.
pub(super) fn mean_power<'a>(rows: impl Iterator<Item = &'a Row> + Clone) -> Option<Vec<f64>> {
    let count = rows.clone().count();
    let mut sum = vec![0.0; rows.clone().next()?.power.len()];
    for row in rows {
        sum.iter_mut().zip(&row.power).for_each(|(sum, power)| *sum += f64::from(*power) / count as f64);
    }
    Some(sum)
}

/// Frames and rows of a spectrogram.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RowSettings {
    /// Length of a frame.
    pub(crate) window_s: f64,
    /// Step between frames.
    pub(crate) hop_s: f64,
    /// Length of a row.
    pub(crate) row_s: f64,
    /// Largest number of rows.
    pub(crate) rows_max: usize,
}

/// Builds rows from a stream of samples. Where their number reaches the limit, pairs of neighbours are merged and the length of a row
/// doubles, so that memory does not grow with the length of the recording. Once a row holds many frames, frames no longer overlap.
pub(crate) struct RowsBuilder {
    stft: Stft<f32>,
    start_s: f64,
    window_s: f64,
    hop_s: f64,
    frames_per_row: u32,
    rows_max: usize,
    rows: Vec<Row>,
}

impl RowsBuilder {
    /// Rows of a recording that starts at `start_s`.
    pub(crate) fn new(sample_rate_hz: f64, start_s: f64, settings: RowSettings) -> Self {
        let RowSettings { window_s, hop_s, row_s, rows_max } = settings;
        let mut stft = Stft::new(sample_rate_hz, Window::Hann, window_s, hop_s, 1);
        stft.restart(start_s);
        let frames_per_row = (row_s / hop_s).round().max(1.0) as u32;
        Self { stft, start_s, window_s, hop_s, frames_per_row, rows_max, rows: Vec::new() }
    }

    pub(crate) fn push(&mut self, samples: &[f32]) {
        let Self { stft, start_s, hop_s, frames_per_row, rows_max, rows, .. } = self;
        stft.push(samples, |frame| {
            let to_s = frame.centre_s + *hop_s / 2.0;
            match rows.last_mut().filter(|row| row.frame_count < *frames_per_row) {
                Some(row) => {
                    row.power.iter_mut().zip(frame.power).for_each(|(sum, power)| *sum += *power as f32);
                    row.frame_count += 1;
                    row.span.to_s = to_s;
                }
                None => {
                    if rows.len() == *rows_max {
                        merge_pairs(rows);
                        *frames_per_row *= 2;
                    }
                    let from_s = rows.last().map_or(*start_s, |row| row.span.to_s);
                    rows.push(Row {
                        span: Span { from_s, to_s },
                        power: frame.power.iter().map(|&power| power as f32).collect(),
                        frame_count: 1,
                    });
                }
            }
        });
        // This takes effect with the next call: the size of the pushed pieces changes rows by less than two frames.
        if self.frames_per_row > OVERLAPPING_FRAMES_MAX && self.hop_s < self.window_s {
            self.frames_per_row = (f64::from(self.frames_per_row) * self.hop_s / self.window_s).round().max(1.0) as u32;
            self.hop_s = self.window_s;
            self.stft.set_hop(self.hop_s);
        }
    }

    /// The rows of a recording that ends at `end_s`.
    pub(crate) fn finish(self, end_s: f64) -> Rows {
        let bin_hz = self.stft.bin_hz();
        let mut rows = self.rows;
        for row in &mut rows {
            row.power.iter_mut().for_each(|sum| *sum /= row.frame_count as f32);
        }
        // the last half frame belongs to the last row
        if let Some(last) = rows.last_mut() {
            last.span.to_s = end_s;
        }
        Rows { rows, bin_hz }
    }
}

/// Merges each pair of neighbouring rows.
fn merge_pairs(rows: &mut Vec<Row>) {
    let mut merged: Vec<Row> = Vec::with_capacity(rows.len());
    for (index, row) in rows.drain(..).enumerate() {
        match merged.last_mut().filter(|_| index % 2 == 1) {
            Some(before) => {
                before.power.iter_mut().zip(&row.power).for_each(|(sum, power)| *sum += power);
                before.frame_count += row.frame_count;
                before.span.to_s = row.span.to_s;
            }
            None => merged.push(row),
        }
    }
    *rows = merged;
}
