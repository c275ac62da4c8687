//! Rows of a log, and what the tracks say at their times.

use super::log::FlightLog;
use crate::speed_curve::{CurvePoint, SpeedCurve};
use hovertone_analysis::Span;
use hovertone_signal::statistics::median;

/// Rows this many typical steps apart have a gap between them.
const GAP_STEPS: f64 = 4.0;

/// A log, averaged to rows that are no closer than the points of a track.
pub(super) struct LogRows {
    pub(super) time_s: Vec<f64>,
    /// `series[which][row]`.
    pub(super) series: Vec<Vec<f64>>,
    /// Gaps before each row.
    pub(super) stretch: Vec<usize>,
}

/// The rows of which all tracks know something, at one offset of the clocks.
pub(super) struct HeardRows {
    /// Which rows of the log.
    pub(super) rows: Vec<usize>,
    /// On the log's clock.
    pub(super) time_s: Vec<f64>,
    /// A new run begins after every gap, of the log or of any track.
    pub(super) run: Vec<usize>,
    /// `points[track][row]`.
    pub(super) points: Vec<Vec<CurvePoint>>,
}

impl HeardRows {
    pub(super) fn len(&self) -> usize {
        self.rows.len()
    }

    /// Runs that are not joined to each other.
    pub(super) fn run_count(&self) -> usize {
        self.run.last().map_or(0, |last| last + 1)
    }
}

impl LogRows {
    /// The rows of a log, in each of which neighbours are averaged that lie within `row_s`.
    pub(super) fn of(log: &FlightLog, row_s: f64) -> Self {
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

    /// What the curves say at the rows' times.
    pub(super) fn heard_at(&self, offset_s: f64, curves: &[SpeedCurve], hover: Span) -> HeardRows {
        let from = self.time_s.partition_point(|time_s| time_s + offset_s < hover.from_s);
        let mut heard =
            HeardRows { rows: Vec::new(), time_s: Vec::new(), run: Vec::new(), points: vec![Vec::new(); curves.len()] };
        let mut before: Option<Vec<usize>> = None;
        for row in from..self.time_s.len() {
            let time_s = self.time_s[row] + offset_s;
            if time_s > hover.to_s {
                break;
            }
            let Some(points) = curves.iter().map(|curve| curve.at(time_s)).collect::<Option<Vec<CurvePoint>>>() else {
                continue;
            };
            let place: Vec<usize> = points.iter().map(|point| point.stretch).chain([self.stretch[row]]).collect();
            let run = match (&before, heard.run.last()) {
                (Some(before), Some(&run)) => run + usize::from(*before != place),
                _ => 0,
            };
            heard.rows.push(row);
            heard.time_s.push(self.time_s[row]);
            heard.run.push(run);
            heard.points.iter_mut().zip(points).for_each(|(all, point)| all.push(point));
            before = Some(place);
        }
        heard
    }
}
