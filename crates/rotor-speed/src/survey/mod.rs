//! Signal → survey: a coarse spectrogram of the whole recording in bounded memory, and a fine one of its low frequencies.

mod mains_hum;
mod rows;
mod span;

pub(crate) use rows::{Row, RowSettings, Rows, RowsBuilder};
pub use span::SpanConfig;

use hovertone_analysis::NoTone;
use hovertone_signal::SteadyLines;
use hovertone_signal::line_frequency::SILENT_DB;
use hovertone_signal::spectrogram::Decimator;
use mains_hum::mains_hum;
use rows::mean_power;

/// The recording in rows of equal length.
#[derive(Clone, Debug, Default)]
pub(crate) struct Survey {
    /// Coarse rows of all frequencies, without mains hum.
    pub(crate) rows: Vec<Row>,
    /// Distance between bins of the coarse rows.
    pub(crate) bin_hz: f64,
    /// The coarse rows with hum, where there is hum.
    pub(crate) rows_with_hum: Option<Vec<Row>>,
    /// The mains hum that is left out of the coarse rows.
    pub(crate) hum: Option<SteadyLines>,
}

impl Survey {
    /// A survey of coarse rows alone.
    pub(crate) fn of_rows(Rows { rows, bin_hz }: Rows) -> Self {
        Self { rows, bin_hz, ..Self::default() }
    }

    /// The coarse rows with hum.
    pub(crate) fn rows_with_hum(&self) -> &[Row] {
        self.rows_with_hum.as_ref().unwrap_or(&self.rows)
    }

    /// Mean power spectrum of the coarse rows. `None` without rows.
    pub(crate) fn mean_power(&self) -> Option<Vec<f64>> {
        mean_power(self.rows.iter())
    }

    /// The reason why the survey can hold no tone: it is too short, or silent. `None` otherwise.
    pub(crate) fn why_nothing(&self, heard_s: f64) -> Option<NoTone> {
        if self.rows.is_empty() {
            return Some(NoTone::TooShort { heard_s });
        }
        self.rows.iter().all(|row| row.level_db(self.bin_hz) < SILENT_DB).then_some(NoTone::Silence)
    }
}

/// Settings of a survey.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SurveySettings {
    /// Length of a frame of the coarse rows.
    pub(crate) window_s: f64,
    /// Length of a coarse row.
    pub(crate) row_s: f64,
    /// Largest number of coarse rows: a longer recording gets longer rows. The fine rows are at most half as many.
    pub(crate) rows_max: usize,
    /// Length of a frame and of a row of the low frequencies.
    pub(crate) fine_window_s: f64,
    /// Highest frequency of the fine rows.
    pub(crate) fine_hz_max: f64,
}

#[cfg(test)]
impl Default for SurveySettings {
    fn default() -> Self {
        Self { window_s: 0.2, row_s: 0.5, rows_max: 256, fine_window_s: 1.0, fine_hz_max: 3000.0 }
    }
}

impl SurveySettings {
    /// Frames and rows of all frequencies.
    pub(crate) fn coarse_rows(&self) -> RowSettings {
        let Self { window_s, row_s, rows_max, .. } = *self;
        RowSettings { window_s, hop_s: window_s / 2.0, row_s, rows_max }
    }

    /// Frames and rows of the low frequencies.
    fn fine_rows(&self) -> RowSettings {
        let window_s = self.fine_window_s;
        RowSettings { window_s, hop_s: window_s / 2.0, row_s: window_s, rows_max: self.rows_max / 2 }
    }
}

/// Finds the mains hum in a stream of samples.
pub(crate) struct HumFinder {
    decimator: Decimator,
    fine: RowsBuilder,
}

impl HumFinder {
    pub(crate) fn new(settings: SurveySettings, sample_rate_hz: f64, start_s: f64) -> Self {
        let decimator = Decimator::new(sample_rate_hz, settings.fine_hz_max);
        let fine = RowsBuilder::new(decimator.rate_hz(), start_s + decimator.delay_s(), settings.fine_rows());
        Self { fine, decimator }
    }

    pub(crate) fn push(&mut self, samples: &[f32]) {
        self.fine.push(self.decimator.push(samples));
    }

    /// `None` where there is no hum.
    pub(crate) fn finish(self, end_s: f64) -> Option<SteadyLines> {
        mains_hum(&self.fine.finish(end_s), self.decimator.hz_max())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn survey(seconds: usize, rows_max: usize) -> Survey {
        let settings = SurveySettings { rows_max, ..SurveySettings::default() };
        let mut builder = RowsBuilder::new(1000.0, 2.0, settings.coarse_rows());
        for second in 0..seconds {
            let level = if second == 3 { 0.5 } else { 0.0 };
            let block: Vec<f32> = (0..1000).map(|n| level * ((n as f32) * 1.3).sin()).collect();
            block.chunks(100).for_each(|samples| builder.push(samples));
        }
        Survey::of_rows(builder.finish(2.0 + seconds as f64))
    }

    /// Rounded to 16 bits, a pure tone has lines at multiples of 20 Hz. Below the rounding noise they are no hum.
    #[test]
    fn the_rounding_of_a_pure_tone_is_no_hum() {
        for hz in [440.0, 880.0, 1000.0, 2000.0] {
            let mut finder = HumFinder::new(SurveySettings::default(), 44_100.0, 0.0);
            let turns = |n: u32| (hz * f64::from(n) / 44_100.0).fract();
            let sine = |n: u32| ((4095.0 * (std::f64::consts::TAU * turns(n)).sin()).round() / 32_768.0) as f32;
            let samples: Vec<f32> = (0..10 * 44_100).map(sine).collect();
            samples.chunks(4096).for_each(|samples| finder.push(samples));
            assert_eq!(finder.finish(10.0), None, "{hz}");
        }
    }

    #[test]
    fn rows_cover_the_recording_on_its_own_clock() {
        let survey = survey(10, 256);
        assert_eq!(survey.rows.len(), 20);
        assert!((survey.rows[0].span.from_s - 2.0).abs() < 1e-9);
        assert!((survey.rows[19].span.to_s - 12.0).abs() < 1e-9);
        for pair in survey.rows.windows(2) {
            assert!((pair[0].span.to_s - pair[1].span.from_s).abs() < 1e-9);
        }
        let loudest = survey.rows.iter().max_by(|a, b| a.level_db(survey.bin_hz).total_cmp(&b.level_db(survey.bin_hz)));
        assert!(loudest.is_some_and(|row| row.span.from_s > 4.9 && row.span.to_s < 6.2));
    }

    #[test]
    fn a_long_recording_has_longer_rows_and_not_more_of_them() {
        let survey = survey(100, 16);
        assert!((9..=16).contains(&survey.rows.len()), "{}", survey.rows.len());
        for pair in survey.rows.windows(2) {
            assert!((pair[0].span.to_s - pair[1].span.from_s).abs() < 1e-9);
        }
        let lengths = || survey.rows.iter().map(|row| row.span.length_s());
        assert!((lengths().sum::<f64>() - 100.0).abs() < 1e-9);
        assert!(
            lengths().rev().skip(1).all(|length_s| (7.5..8.5).contains(&length_s)),
            "{:?}",
            lengths().collect::<Vec<_>>()
        );
        // one second of a sine of half of full scale, under windows that spread it over 1.5 bins
        let energy: f64 = survey
            .rows
            .iter()
            .map(|row| row.power.iter().copied().map(f64::from).sum::<f64>() * row.span.length_s())
            .sum();
        assert!((energy / (1.5 * 0.25) - 1.0).abs() < 0.05, "{energy}");
    }
}
