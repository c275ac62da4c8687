//! Rows of a log, averaged to the rate of the tracks, and the tracks' values at their times.

use super::flight_log::FlightLog;
use crate::speed_curve::{CurvePoint, SpeedCurve};
use hovertone_analysis::Span;
use hovertone_signal::statistics::median;

/// Distance of two rows, in median steps, above which a gap lies between them: up to three missing rows are no gap. *Decision.*
const GAP_STEPS: f64 = 4.0;

/// The rows of a log, averaged so that they are no closer than the points of a track.
pub(super) struct LogRows {
    pub(super) time_s: Vec<f64>,
    /// `series[which][row]`.
    pub(super) series: Vec<Vec<f64>>,
    /// Number of the stretch between gaps in which each row lies, from 0.
    pub(super) stretch: Vec<usize>,
}

/// The rows at which every track has a value, at one offset of the clocks.
pub(super) struct MatchedRows {
    /// Indices of the rows in the log.
    pub(super) rows: Vec<usize>,
    /// Times of the rows, on the log's clock.
    pub(super) time_s: Vec<f64>,
    /// Number of the run in which each row lies, from 0: a new run begins after every gap of the log or of a track.
    pub(super) run: Vec<usize>,
    /// `points[track][row]`.
    pub(super) points: Vec<Vec<CurvePoint>>,
}

impl MatchedRows {
    pub(super) fn len(&self) -> usize {
        self.rows.len()
    }

    pub(super) fn run_count(&self) -> usize {
        self.run.last().map_or(0, |last| last + 1)
    }
}

impl LogRows {
    /// The means of neighbouring rows that lie within `row_s`; no mean crosses a gap.
    pub(super) fn from_log(log: &FlightLog, row_s: f64) -> Self {
        let times = &log.time_s;
        let steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let step_s = median(&steps).unwrap_or(0.0);
        let per_row = if step_s > 0.0 { ((row_s / step_s).round() as usize).max(1) } else { 1 };
        let gap_s = GAP_STEPS * step_s;
        let mut rows = Self { time_s: Vec::new(), series: vec![Vec::new(); log.series().len()], stretch: Vec::new() };
        let (mut from, mut stretch) = (0, 0);
        while from < times.len() {
            let is_joined = |row: &usize| times[*row] - times[*row - 1] <= gap_s;
            let count = 1 + (from + 1..times.len()).take(per_row - 1).take_while(is_joined).count();
            let mean = |values: &[f64]| values.iter().sum::<f64>() / count as f64;
            if from > 0 && times[from] - times[from - 1] > gap_s {
                stretch += 1;
            }
            rows.time_s.push(mean(&times[from..from + count]));
            rows.stretch.push(stretch);
            for (row, series) in rows.series.iter_mut().zip(log.series()) {
                row.push(mean(&series[from..from + count]));
            }
            from += count;
        }
        rows
    }

    pub(super) fn len(&self) -> usize {
        self.time_s.len()
    }

    pub(super) fn span(&self) -> Option<Span> {
        Some(Span { from_s: *self.time_s.first()?, to_s: *self.time_s.last()? })
    }

    /// The rows within the hover at which all curves have a value, with these values. `offset_s` is added to the log's times.
    pub(super) fn matched_at(&self, offset_s: f64, curves: &[SpeedCurve], hover: Span) -> MatchedRows {
        let from = self.time_s.partition_point(|time_s| time_s + offset_s < hover.from_s);
        let mut matched = MatchedRows {
            rows: Vec::new(),
            time_s: Vec::new(),
            run: Vec::new(),
            points: vec![Vec::new(); curves.len()],
        };
        let mut stretches_before: Option<Vec<usize>> = None;
        for row in from..self.time_s.len() {
            let time_s = self.time_s[row] + offset_s;
            if time_s > hover.to_s {
                break;
            }
            let Some(points) = curves.iter().map(|curve| curve.at(time_s)).collect::<Option<Vec<CurvePoint>>>() else {
                continue;
            };
            let stretches: Vec<usize> = points.iter().map(|point| point.stretch).chain([self.stretch[row]]).collect();
            let run = match (&stretches_before, matched.run.last()) {
                (Some(before), Some(&run)) => run + usize::from(*before != stretches),
                _ => 0,
            };
            matched.rows.push(row);
            matched.time_s.push(self.time_s[row]);
            matched.run.push(run);
            matched.points.iter_mut().zip(points).for_each(|(all, point)| all.push(point));
            stretches_before = Some(stretches);
        }
        matched
    }
}
