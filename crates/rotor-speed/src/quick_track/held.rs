//! Where a path holds its speed.

use super::path::SpeedPath;
use crate::thresholds::{BESIDE_SHARE, HEARD_S_MIN};
use std::ops::Range;

/// Largest change of a speed that is held, as a share: wander and the grid of the path.
const HELD_SHARE: f64 = BESIDE_SHARE;
/// Shortest time: the survey needs some rows.
const HELD_S_MIN: f64 = HEARD_S_MIN;
/// Part at either end that is left out: the frames there see the step. *Numeric.*
const MARGIN_S: f64 = 0.1;

/// The longest stretches first.
pub(super) fn held_spans(path: &SpeedPath) -> Vec<Range<f64>> {
    let mut spans: Vec<Range<f64>> = Vec::new();
    let mut first = 0;
    let (mut low, mut high) = (f64::INFINITY, 0.0_f64);
    for (at, &speed_rev_s) in path.speed_rev_s.iter().enumerate() {
        (low, high) = (low.min(speed_rev_s), high.max(speed_rev_s));
        if high > (1.0 + HELD_SHARE) * low {
            spans.push(path.time_s[first]..path.time_s[at]);
            (first, low, high) = (at, speed_rev_s, speed_rev_s);
        }
    }
    if let Some(&last_s) = path.time_s.last() {
        spans.push(path.time_s[first]..last_s);
    }
    let inner = spans.into_iter().map(|span| span.start + MARGIN_S..span.end - MARGIN_S);
    let mut long: Vec<Range<f64>> = inner.filter(|span| span.end - span.start >= HELD_S_MIN).collect();
    long.sort_by(|a, b| (b.end - b.start).total_cmp(&(a.end - a.start)));
    long
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_level_comes_first() {
        let level = |at: usize| [50.0, 70.0, 60.0][[0, 300, 450].iter().rposition(|&from| at >= from).unwrap()];
        let path = SpeedPath {
            time_s: (0..700).map(|at| at as f64 * 0.01).collect(),
            speed_rev_s: (0..700).map(|at| level(at) * (1.0 + 0.01 * (at as f64).sin())).collect(),
        };
        let spans = held_spans(&path);
        assert_eq!(spans.len(), 3);
        assert!((spans[0].start - 0.1).abs() < 1e-9 && (spans[0].end - 2.9).abs() < 1e-9, "{spans:?}");
        assert!(spans[1].start > 4.5 && spans[2].start > 3.0);
    }
}
