//! A track as a function of time: speed, shaft angle, and the integral of the squared speed.

use hovertone_analysis::{Span, TrackPoint};
use hovertone_signal::statistics::{mean, median};
use std::f64::consts::TAU;

/// Distance of two points of a track, in median steps, above which a gap lies between them: one missing point is no gap. *Decision.*
const GAP_STEPS: f64 = 2.5;

/// The speed of one rotor over time: linear between the points of its track, unknown in gaps and outside.
pub(crate) struct SpeedCurve {
    time_s: Vec<f64>,
    speed_rev_s: Vec<f64>,
    /// Turns of the shaft since the first point.
    turns: Vec<f64>,
    /// `∫ (ω² − ω₀²) dt` since the first point, ω₀ the mean speed. Subtracting ω₀² keeps the sum small.
    excess_rad2_s: Vec<f64>,
    /// Number of the stretch between gaps in which each point lies, from 0.
    stretch: Vec<usize>,
    /// Mean over the points.
    pub(crate) mean_rad_s: f64,
    /// First point at or after the time of the last call of [`SpeedCurve::turns_at`].
    next: usize,
}

/// A curve at one time.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CurvePoint {
    pub(crate) speed_rad_s: f64,
    /// `∫ (ω² − ω₀²) dt` since the first point of the track, ω₀ the mean speed.
    pub(crate) excess_rad2_s: f64,
    /// Number of the stretch between gaps, from 0.
    pub(crate) stretch: usize,
}

impl SpeedCurve {
    /// The curve through the points of a track, in any sequence. Points that are not finite, and all but the first of one time, are left out.
    pub(crate) fn through(track: &[TrackPoint]) -> Self {
        let mut points: Vec<(f64, f64)> = track
            .iter()
            .map(|point| (point.time_s, point.speed_rev_s))
            .filter(|(time_s, speed)| time_s.is_finite() && speed.is_finite())
            .collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        points.dedup_by(|later, earlier| later.0 <= earlier.0);
        let (time_s, speed_rev_s): (Vec<f64>, Vec<f64>) = points.into_iter().unzip();
        let steps: Vec<f64> = time_s.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let gap_s = GAP_STEPS * median(&steps).unwrap_or(0.0);
        let speed_rad_s: Vec<f64> = speed_rev_s.iter().map(|speed| TAU * speed).collect();
        let mean_rad_s = mean(&speed_rad_s).unwrap_or(0.0);
        let excess = |index: usize| speed_rad_s[index].powi(2) - mean_rad_s * mean_rad_s;
        let (mut turns, mut excess_rad2_s) = (vec![0.0; time_s.len()], vec![0.0; time_s.len()]);
        let mut stretch = vec![0; time_s.len()];
        for index in 1..time_s.len() {
            let step_s = steps[index - 1];
            turns[index] = turns[index - 1] + step_s * (speed_rev_s[index - 1] + speed_rev_s[index]) / 2.0;
            excess_rad2_s[index] = excess_rad2_s[index - 1] + step_s * (excess(index - 1) + excess(index)) / 2.0;
            stretch[index] = stretch[index - 1] + usize::from(step_s > gap_s);
        }
        Self { time_s, speed_rev_s, turns, excess_rad2_s, stretch, mean_rad_s, next: 0 }
    }

    /// The span that all curves cover, gaps included.
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
        let (from_rad_s, to_rad_s) = (TAU * self.speed_rev_s[before], TAU * self.speed_rev_s[next]);
        let speed_rad_s = from_rad_s + share * (to_rad_s - from_rad_s);
        let excess = |speed: f64| speed * speed - self.mean_rad_s * self.mean_rad_s;
        let since = since_s * (excess(from_rad_s) + excess(speed_rad_s)) / 2.0;
        Some(CurvePoint {
            speed_rad_s,
            excess_rad2_s: self.excess_rad2_s[before] + since,
            stretch: self.stretch[before],
        })
    }

    /// Turns of the shaft since the first point; `None` in a gap and outside. `time_s` must not decrease from call to call: then the cost
    /// per call does not grow with the length of the track, which allows a call for every audio sample.
    pub(crate) fn turns_at(&mut self, time_s: f64) -> Option<f64> {
        while self.time_s.get(self.next).is_some_and(|&point_s| point_s < time_s) {
            self.next += 1;
        }
        let (before, next) = (self.next.checked_sub(1)?, self.next);
        if *self.stretch.get(next)? != self.stretch[before] {
            return None;
        }
        let since_s = time_s - self.time_s[before];
        let rate_rev_s2 =
            (self.speed_rev_s[next] - self.speed_rev_s[before]) / (self.time_s[next] - self.time_s[before]);
        Some(self.turns[before] + since_s * (self.speed_rev_s[before] + rate_rev_s2 * since_s / 2.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn track(points: &[(f64, f64)]) -> Vec<TrackPoint> {
        let point = |&(time_s, speed_rev_s): &(f64, f64)| TrackPoint {
            time_s,
            tone_hz: 2.0 * speed_rev_s,
            speed_rev_s,
            std_uncertainty_rev_s: 0.1,
            level_db: -30.0,
        };
        points.iter().map(point).collect()
    }

    #[test]
    fn a_ramp_has_the_turns_and_the_speed_of_its_formula() {
        // n = 50 + 2 t: turns 50 t + t², through points that lie on it
        let points: Vec<(f64, f64)> = (0..11).map(|k| 0.1 * f64::from(k)).map(|t| (t, 50.0 + 2.0 * t)).collect();
        let mut curve = SpeedCurve::through(&track(&points));
        for step in 1..100 {
            let t = 0.01 * f64::from(step);
            assert!((curve.turns_at(t).unwrap() - (50.0 * t + t * t)).abs() < 1e-12, "{t}");
            assert!((curve.at(t).unwrap().speed_rad_s - TAU * (50.0 + 2.0 * t)).abs() < 1e-9, "{t}");
        }
        assert!(curve.turns_at(1.01).is_none() && curve.at(1.01).is_none());
    }

    #[test]
    fn a_gap_holds_nothing() {
        let points = [(0.0, 60.0), (0.1, 60.0), (0.2, 60.0), (0.9, 61.0), (1.0, 61.0)];
        let mut curve = SpeedCurve::through(&track(&points));
        assert!((curve.turns_at(0.15).unwrap() - 9.0).abs() < 1e-12);
        assert!(curve.turns_at(0.5).is_none() && curve.at(0.5).is_none());
        assert!(curve.turns_at(0.95).is_some());
        assert_eq!((curve.at(0.1).unwrap().stretch, curve.at(0.95).unwrap().stretch), (0, 1));
    }
}
