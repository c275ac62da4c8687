//! A track as a function of time: speed, and the integral of its square.

use hovertone_analysis::{Span, TrackPoint};
use hovertone_signal::statistics::{mean, median};
use std::f64::consts::TAU;

/// Points this many typical steps apart have a gap between them.
const GAP_STEPS: f64 = 2.5;

/// The speed of one rotor over time, straight between points, with its gaps.
pub(crate) struct SpeedCurve {
    time_s: Vec<f64>,
    speed_rad_s: Vec<f64>,
    /// ∫ (ω² − ω₀²) dt up to each point, with the mean speed ω₀.
    excess_rad2_s: Vec<f64>,
    /// Gaps before each point.
    stretch: Vec<usize>,
    mean_rad_s: f64,
}

/// A curve at one time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CurvePoint {
    pub(crate) speed_rad_s: f64,
    pub(crate) excess_rad2_s: f64,
    pub(crate) stretch: usize,
}

impl SpeedCurve {
    pub(crate) fn through(track: &[TrackPoint]) -> Self {
        let mut points: Vec<(f64, f64)> = track
            .iter()
            .map(|point| (point.time_s, TAU * point.speed_rev_s))
            .filter(|(time_s, speed)| time_s.is_finite() && speed.is_finite())
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points.dedup_by(|later, earlier| later.0 <= earlier.0);
        let (time_s, speed_rad_s): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
        let steps: Vec<f64> = time_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let gap_s = GAP_STEPS * median(&steps).unwrap_or(0.0);
        let mean_rad_s = mean(&speed_rad_s).unwrap_or(0.0);
        let square = |index: usize| speed_rad_s[index].powi(2) - mean_rad_s * mean_rad_s;
        let (mut excess_rad2_s, mut stretch) = (vec![0.0; time_s.len()], vec![0; time_s.len()]);
        for index in 1..time_s.len() {
            let step_s = steps[index - 1];
            excess_rad2_s[index] = excess_rad2_s[index - 1] + step_s * (square(index - 1) + square(index)) / 2.0;
            stretch[index] = stretch[index - 1] + usize::from(step_s > gap_s);
        }
        Self { time_s, speed_rad_s, excess_rad2_s, stretch, mean_rad_s }
    }

    /// The time that all curves cover, gaps or not.
    pub(crate) fn span_of_all(curves: &[Self]) -> Option<Span> {
        let from_s = curves.iter().map(|curve| curve.time_s.first().copied()).collect::<Option<Vec<f64>>>()?;
        let to_s = curves.iter().map(|curve| curve.time_s.last().copied()).collect::<Option<Vec<f64>>>()?;
        let span = Span {
            from_s: from_s.into_iter().fold(f64::NEG_INFINITY, f64::max),
            to_s: to_s.into_iter().fold(f64::INFINITY, f64::min),
        };
        (span.length_s() > 0.0).then_some(span)
    }

    /// The curve at a time; `None` in a gap and outside.
    pub(crate) fn at(&self, time_s: f64) -> Option<CurvePoint> {
        let next = self.time_s.partition_point(|&point_s| point_s < time_s).max(1);
        let (before, next) = (next - 1, (next < self.time_s.len()).then_some(next)?);
        if time_s < self.time_s[before] || self.stretch[before] != self.stretch[next] {
            return None;
        }
        let since_s = time_s - self.time_s[before];
        let share = since_s / (self.time_s[next] - self.time_s[before]);
        let speed_rad_s = self.speed_rad_s[before] + share * (self.speed_rad_s[next] - self.speed_rad_s[before]);
        let square = |speed: f64| speed * speed - self.mean_rad_s * self.mean_rad_s;
        let since = since_s * (square(self.speed_rad_s[before]) + square(speed_rad_s)) / 2.0;
        Some(CurvePoint {
            speed_rad_s,
            excess_rad2_s: self.excess_rad2_s[before] + since,
            stretch: self.stretch[before],
        })
    }
}
