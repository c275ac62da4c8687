//! Survey → rows of levels over the floor, in which series of lines are looked for.

use super::skirts::level_skirts;
use crate::survey::Survey;
use hovertone_analysis::Span;
use hovertone_signal::peak::hann_peak_offset_bins;
use hovertone_signal::spectrogram::whitened_db;
use hovertone_signal::statistics::median;

/// Levels are cut here, so that one line cannot outweigh a series. *Decision.*
const LEVEL_DB_MAX: f32 = 60.0;

/// Share of a normal distribution that is more than one standard deviation below its median. *Numeric.*
const BELOW_ONE_STD: f64 = 0.1587;

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
    /// Standard deviation of the levels of noise in a row.
    pub(crate) noise_std_db: f64,
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
        let rows: Vec<LevelRow<'_>> = rows.collect();
        let noise_std_db = median(&rows.iter().map(LevelRow::noise_std_db).collect::<Vec<_>>()).unwrap_or_default();
        Self { rows, bin_hz: survey.bin_hz, noise_std_db }
    }

    /// Highest frequency that the rows hold.
    pub(crate) fn hz_max(&self) -> f64 {
        self.bin_hz * self.rows.first().map_or(0.0, |row| row.level_db.len().saturating_sub(1) as f64)
    }
}

impl LevelRow<'_> {
    /// Highest level of a bin and its neighbours; `None` beyond the spectrum.
    pub(crate) fn level_near_db(&self, bin: isize) -> Option<f64> {
        let first = usize::try_from(bin - 1).ok()?;
        self.level_db.get(first..first + 3)?.iter().copied().reduce(f32::max).map(f64::from)
    }

    /// Standard deviation of the levels of noise, from those below the median: lines lie above.
    fn noise_std_db(&self) -> f64 {
        let mut levels = self.level_db.clone();
        levels.sort_by(f32::total_cmp);
        let at = |share: f64| levels.get((share * levels.len() as f64) as usize).copied().map_or(0.0, f64::from);
        at(0.5) - at(BELOW_ONE_STD)
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
