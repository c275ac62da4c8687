//! Signal → survey: the whole recording as a coarse spectrogram that fits in memory whatever its length.

use crate::config::HoverConfig;
use crate::span::Span;
use crate::spectrogram::{Stft, Window, power_db};
use crate::verdict::NoTone;

/// Sound below this is handling, wind and traffic; it does not count for how loud a row is.
const LEVEL_HZ_MIN: f64 = 60.0;

/// One row of the survey: the mean power spectrum of a stretch of sound.
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

/// The recording in rows of equal length.
#[derive(Clone, Debug, Default)]
pub(crate) struct Survey {
    pub(crate) rows: Vec<Row>,
    pub(crate) bin_hz: f64,
}

/// Sound quieter than this is silence: below the last bit of 24.
const SILENCE_DB: f64 = -150.0;

impl Survey {
    /// Why nothing can be found in it; `None` when something sounds.
    pub(crate) fn why_nothing(&self, heard_s: f64) -> Option<NoTone> {
        if self.rows.is_empty() {
            return Some(NoTone::TooShort { heard_s });
        }
        self.rows.iter().all(|row| row.level_db(self.bin_hz) < SILENCE_DB).then_some(NoTone::Silence)
    }
}

/// Builds a survey from a stream of samples. When there are too many rows, neighbours are merged and rows become twice
/// as long, so that memory stays the same for a minute and for a day.
pub(crate) struct SurveyBuilder {
    stft: Stft,
    hop_s: f64,
    frames_per_row: u32,
    rows_max: usize,
    rows: Vec<Row>,
}

impl SurveyBuilder {
    pub(crate) fn new(config: &HoverConfig, sample_rate_hz: f64, start_s: f64) -> Self {
        Self::with_hop(config, config.survey_window_s / 2.0, sample_rate_hz, start_s)
    }

    /// With another step between frames than half their length.
    pub(crate) fn with_hop(config: &HoverConfig, hop_s: f64, sample_rate_hz: f64, start_s: f64) -> Self {
        let mut stft = Stft::new(sample_rate_hz, Window::Hann, config.survey_window_s, hop_s, 1);
        stft.restart(start_s);
        Self {
            stft,
            hop_s,
            frames_per_row: (config.survey_row_s / hop_s).round().max(1.0) as u32,
            rows_max: config.survey_rows_max,
            rows: Vec::new(),
        }
    }

    pub(crate) fn push(&mut self, samples: &[f32]) {
        let Self { stft, hop_s, frames_per_row, rows_max, rows } = self;
        stft.push(samples, |frame| {
            let (from_s, to_s) = (frame.centre_s - *hop_s / 2.0, frame.centre_s + *hop_s / 2.0);
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
                    rows.push(Row { span: Span { from_s, to_s }, power: frame.power.to_vec(), frame_count: 1 });
                }
            }
        });
    }

    pub(crate) fn finish(self, end_s: f64) -> Survey {
        let bin_hz = self.stft.bin_hz();
        let mut rows = self.rows;
        for row in &mut rows {
            row.power.iter_mut().for_each(|sum| *sum /= f64::from(row.frame_count));
        }
        // the first and last half window belong to the first and last row
        if let Some(first) = rows.first_mut() {
            first.span.from_s -= self.hop_s / 2.0;
        }
        if let Some(last) = rows.last_mut() {
            last.span.to_s = end_s;
        }
        Survey { rows, bin_hz }
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

#[cfg(test)]
mod tests {
    use super::*;

    fn survey(seconds: usize, rows_max: usize) -> Survey {
        let config = HoverConfig { survey_rows_max: rows_max, ..HoverConfig::default() };
        let mut builder = SurveyBuilder::new(&config, 1000.0, 2.0);
        for second in 0..seconds {
            let level = if second == 3 { 0.5 } else { 0.0 };
            let block: Vec<f32> = (0..1000).map(|n| level * ((n as f32) * 1.3).sin()).collect();
            builder.push(&block);
        }
        builder.finish(2.0 + seconds as f64)
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
    }
}
