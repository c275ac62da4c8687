//! From frames of one length to the cells of one picture.

use super::PictureConfig;
use super::{Picture, PictureView};
use hovertone_analysis::Span;
use hovertone_signal::spectrogram::{Frame, power_db};

/// An unfinished picture.
pub(super) struct Pooling {
    view: PictureView,
    bin_hz: f64,
    first_bin: usize,
    /// First bin of each row, relative to `first_bin`, and the end of the last row.
    row_starts: Vec<usize>,
    columns_max: usize,
    /// Power of every cell, column by column.
    power: Vec<f32>,
    frames_per_column: usize,
    frames_in_last: usize,
    first_centre_s: f64,
}

impl Pooling {
    /// `None` where the view contains no bin.
    pub(super) fn new(view: PictureView, bin_hz: f64, hz_max: f64, config: &PictureConfig) -> Option<Self> {
        let first_bin = (view.hz_low.max(0.0) / bin_hz).ceil() as usize;
        let end_bin = (view.hz_high.min(hz_max) / bin_hz).floor() as usize + 1;
        let bin_count = end_bin.checked_sub(first_bin).filter(|&bin_count| bin_count > 0)?;
        let row_count = bin_count.min(config.rows_max);
        Some(Self {
            view,
            bin_hz,
            first_bin,
            row_starts: (0..=row_count).map(|row| row * bin_count / row_count).collect(),
            columns_max: config.columns_max.next_multiple_of(2),
            power: Vec::new(),
            frames_per_column: 1,
            frames_in_last: 0,
            first_centre_s: 0.0,
        })
    }

    pub(super) fn view(&self) -> &PictureView {
        &self.view
    }

    pub(super) fn push(&mut self, frame: &Frame<'_>) {
        let row_count = self.row_starts.len() - 1;
        if self.power.is_empty() {
            self.first_centre_s = frame.centre_s;
        }
        if self.power.is_empty() || self.frames_in_last == self.frames_per_column {
            if self.power.len() == self.columns_max * row_count {
                self.halve(row_count);
            }
            self.power.resize(self.power.len() + row_count, 0.0);
            self.frames_in_last = 0;
        }
        self.frames_in_last += 1;
        let Some(bins) = frame.power.get(self.first_bin..) else { return };
        let last = self.power.len() - row_count;
        for (cell, row) in self.power[last..].iter_mut().zip(self.row_starts.windows(2)) {
            let loudest = bins.get(row[0]..row[1]).unwrap_or_default().iter().fold(0.0, |a: f64, &b| a.max(b));
            *cell = cell.max(loudest as f32);
        }
    }

    /// Pools the columns in pairs. All of them are full, and their number is even.
    fn halve(&mut self, row_count: usize) {
        let half = self.power.len() / row_count / 2;
        for column in 0..half {
            for row in 0..row_count {
                let of_pair = |which: usize| self.power[(2 * column + which) * row_count + row];
                self.power[column * row_count + row] = of_pair(0).max(of_pair(1));
            }
        }
        self.power.truncate(half * row_count);
        self.frames_per_column *= 2;
    }

    /// `None` without frames.
    pub(super) fn finish(self, hop_s: f64) -> Option<Picture> {
        let row_count = self.row_starts.len() - 1;
        let column_count = self.power.len() / row_count;
        let from_s = self.first_centre_s - hop_s / 2.0;
        let bin_count = self.row_starts.last().copied().unwrap_or_default();
        let edge_hz = |bin: usize| (bin as f64 - 0.5) * self.bin_hz;
        (column_count > 0).then(|| Picture {
            view: self.view,
            span: Span { from_s, to_s: from_s + (column_count * self.frames_per_column) as f64 * hop_s },
            hz_low: edge_hz(self.first_bin),
            hz_high: edge_hz(self.first_bin + bin_count),
            column_count,
            row_count,
            level_db: self.power.iter().map(|&power| power_db(f64::from(power)) as f32).collect(),
        })
    }
}
