//! A track → the angle of its rotor at every sample.

use hovertone_analysis::TrackPoint;
use hovertone_signal::statistics::median;

/// Points this many typical steps apart have a gap between them.
const GAP_STEPS: f64 = 2.5;

/// The turns of one rotor, asked for in order of time.
pub(crate) struct RotorTurns {
    /// Time, speed and turns of each point; turns begin anew after a gap.
    points: Vec<(f64, f64, f64)>,
    gap_s: f64,
    next: usize,
}

impl RotorTurns {
    pub(crate) fn of(track: &[TrackPoint]) -> Self {
        let steps: Vec<f64> = track.windows(2).map(|pair| pair[1].time_s - pair[0].time_s).collect();
        let gap_s = GAP_STEPS * median(&steps).unwrap_or(0.0);
        let mut points: Vec<(f64, f64, f64)> = Vec::with_capacity(track.len());
        for point in track {
            let turns = points.last().map_or(0.0, |&(time_s, speed_rev_s, turns)| {
                turns + (point.time_s - time_s) * (speed_rev_s + point.speed_rev_s) / 2.0
            });
            points.push((point.time_s, point.speed_rev_s, turns));
        }
        Self { points, gap_s, next: 0 }
    }

    /// Turns at a time no earlier than the last that was asked for; `None` in a gap, and outside.
    pub(crate) fn at(&mut self, time_s: f64) -> Option<f64> {
        while self.points.get(self.next).is_some_and(|point| point.0 < time_s) {
            self.next += 1;
        }
        let &(from_s, from_rev_s, turns) = self.points.get(self.next.checked_sub(1)?)?;
        let &(to_s, to_rev_s, _) = self.points.get(self.next)?;
        if to_s - from_s > self.gap_s {
            return None;
        }
        let since_s = time_s - from_s;
        let bend = (to_rev_s - from_rev_s) / (to_s - from_s) * since_s / 2.0;
        Some(turns + since_s * (from_rev_s + bend))
    }
}
