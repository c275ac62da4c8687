//! Frames → rows: mean power spectra of stretches of equal length, never more than a number of them.

use hovertone_analysis::Span;
use hovertone_signal::spectrogram::{Stft, Window, power_db};

/// Sound below this is handling, wind and traffic; it does not count for how loud a row is.
const LEVEL_HZ_MIN: f64 = 60.0;
/// Rows of more frames than this know their mean well enough without frames that overlap.
const OVERLAPPING_FRAMES_MAX: u32 = 20;

/// One row: the mean power spectrum of a stretch of sound.
#[derive(Clone, Debug)]
pub(crate) struct Row {
    pub(crate) span: Span,
    pub(crate) power: Vec<f64>,
    frame_count: u32,
}

impl Row {
    /// Loudness of the row above the lowest frequencies, in dB re a full-scale sine.
    pub(crate) fn level_db(&self, bin_hz: f64) -> f64 {
        let first = ((LEVEL_HZ_MIN / bin_hz).ceil() as usize).min(self.power.len());
        power_db(self.power[first..].iter().sum())
    }
}

/// A recording in rows of equal length.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rows {
    pub(crate) rows: Vec<Row>,
    pub(crate) bin_hz: f64,
}

impl Rows {
    /// Mean power spectrum of the rows that are wanted; `None` where there are none.
    pub(crate) fn mean_power(&self, is_wanted: impl Fn(&Row) -> bool) -> Option<Vec<f64>> {
        mean_power(self.rows.iter().filter(|row| is_wanted(row)))
    }
}

/// Mean power spectrum of rows; `None` of nothing.
pub(super) fn mean_power<'a>(rows: impl Iterator<Item = &'a Row> + Clone) -> Option<Vec<f64>> {
    let count = rows.clone().count();
    let mut sum = vec![0.0; rows.clone().next()?.power.len()];
    for row in rows {
        sum.iter_mut().zip(&row.power).for_each(|(sum, power)| *sum += power / count as f64);
    }
    Some(sum)
}

/// Builds rows from a stream of samples. When there are too many, neighbours are merged and rows become twice as long, so
/// that memory stays the same for a minute and for a day; and once they hold many frames, these stand side by side.
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
    /// Frames of `window_s` that overlap by half, rows of `row_s`.
    pub(crate) fn new(sample_rate_hz: f64, start_s: f64, window_s: f64, row_s: f64, rows_max: usize) -> Self {
        Self::with_hop(sample_rate_hz, start_s, (window_s, window_s / 2.0), row_s, rows_max)
    }

    /// Frames of another step than half their length.
    pub(crate) fn with_hop(
        sample_rate_hz: f64,
        start_s: f64,
        (window_s, hop_s): (f64, f64),
        row_s: f64,
        rows_max: usize,
    ) -> Self {
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
                    row.power.iter_mut().zip(frame.power).for_each(|(sum, power)| *sum += power);
                    row.frame_count += 1;
                    row.span.to_s = to_s;
                }
                None => {
                    if rows.len() == *rows_max {
                        merge_pairs(rows);
                        *frames_per_row *= 2;
                    }
                    let from_s = rows.last().map_or(*start_s, |row| row.span.to_s);
                    rows.push(Row { span: Span { from_s, to_s }, power: frame.power.to_vec(), frame_count: 1 });
                }
            }
        });
        // from the next block on: where that begins makes rows differ by less than a frame or two
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
            row.power.iter_mut().for_each(|sum| *sum /= f64::from(row.frame_count));
        }
        // the last half window belongs to the last row
        if let Some(last) = rows.last_mut() {
            last.span.to_s = end_s;
        }
        Rows { rows, bin_hz }
    }
}

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
