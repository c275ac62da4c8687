//! Survey → rows of levels over the floor, in which series of lines are looked for.

use super::skirts::level_skirts;
use crate::survey::Survey;
use hovertone_analysis::Span;
use hovertone_signal::peak::hann_peak_offset_bins;
use hovertone_signal::spectrogram::whitened_db;

/// Levels are cut here, so that one line cannot outweigh a series. *Decision.*
const LEVEL_DB_MAX: f32 = 60.0;

/// One stretch of sound.
#[derive(Clone, Debug)]
pub(crate) struct LevelRow<'a> {
    pub(crate) span: Span,
    level_db: Vec<f32>,
    /// The spectrum, in whose peaks the frequency of a line is measured: levels are cut.
    power: &'a [f32],
}

/// Levels over the floor of a recording, row by row.
#[derive(Clone, Debug)]
pub(crate) struct LevelRows<'a> {
    pub(crate) rows: Vec<LevelRow<'a>>,
    pub(crate) bin_hz: f64,
}

impl<'a> LevelRows<'a> {
    /// At most `rows_max` rows of a survey, evenly chosen.
    pub(crate) fn from_survey(survey: &'a Survey, rows_max: usize) -> Self {
        let rows = survey.rows_with_hum();
        let step = rows.len().div_ceil(rows_max.max(1)).max(1);
        let rows = rows.iter().step_by(step).map(|row| {
            let mut level_db: Vec<f32> = whitened_db(&row.power).into_iter().map(|level| level as f32).collect();
            level_skirts(&row.power, &mut level_db);
            level_db.iter_mut().for_each(|level| *level = level.min(LEVEL_DB_MAX));
            LevelRow { span: row.span, level_db, power: &row.power }
        });
        Self { rows: rows.collect(), bin_hz: survey.bin_hz }
    }

    /// Highest frequency that the rows hold.
    pub(crate) fn hz_max(&self) -> f64 {
        self.bin_hz * self.rows.first().map_or(0.0, |row| row.level_db.len().saturating_sub(1) as f64)
    }
}

impl LevelRow<'_> {
    /// Highest level between two places, in bins; `None` beyond the spectrum.
    pub(crate) fn highest_db(&self, first: f64, last: f64) -> Option<f64> {
        let levels = self.level_db.get(first.round().max(0.0) as usize..=last.round().max(0.0) as usize)?;
        Some(f64::from(levels.iter().copied().fold(f32::MIN, f32::max)))
    }

    /// For every bin the highest level within a share of its frequency on either side.
    pub(crate) fn widened(&self, half_width_share: f64) -> Vec<f32> {
        let highest = |bin: usize| {
            let half = half_width_share * bin as f64;
            let (first, last) = ((bin as f64 - half).round() as usize, (bin as f64 + half).round() as usize);
            let levels = &self.level_db[first..(last + 1).min(self.level_db.len())];
            levels.iter().copied().fold(f32::MIN, f32::max)
        };
        (0..self.level_db.len()).map(highest).collect()
    }

    /// Place and height of the peak between two places, in bins, where there is one inside.
    pub(crate) fn peak(&self, first: f64, last: f64) -> Option<(f64, f64)> {
        let (first, last) = (first.round().max(1.0) as usize, last.round() as usize);
        let levels = self.level_db.get(first..=last)?;
        let (index, _) = levels.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
        let at = first + index;
        let [before, top, after] = [at - 1, at, at + 1].map(|bin| self.level_db.get(bin).copied().map(f64::from));
        let (before, top, after) = (before?, top?, after?);
        let curve = before - 2.0 * top + after;
        let is_peak = top >= before && top >= after && curve < 0.0;
        is_peak.then(|| (at as f64 + 0.5 * (before - after) / curve, top))
    }

    /// The same by power, in which the peak of a steady tone is placed to a thousandth of a bin, however loud it is: levels are cut.
    pub(crate) fn power_peak(&self, first: f64, last: f64) -> Option<(f64, f64)> {
        let (first, last) = (first.round().max(1.0) as usize, last.round() as usize);
        let bins = self.power.get(first..=last)?;
        let (index, _) = bins.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1))?;
        let at = first + index;
        let [before, top, after] = [at - 1, at, at + 1].map(|bin| self.power.get(bin).copied().map(f64::from));
        let offset = hann_peak_offset_bins(before?, top?, after?)?;
        Some((at as f64 + offset, f64::from(*self.level_db.get(at)?)))
    }

    /// Levels all bins between two places to the floor.
    pub(crate) fn level_to_floor(&mut self, first: f64, last: f64) {
        let end = (last.round().max(0.0) as usize + 1).min(self.level_db.len());
        let start = (first.round().max(0.0) as usize).min(end);
        self.level_db[start..end].iter_mut().for_each(|level| *level = level.min(0.0));
    }
}
