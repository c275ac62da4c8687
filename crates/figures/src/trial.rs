//! What the figures show of one recording.

use crate::picture::{Picture, Pictures};
use hovertone_analysis::{Band, Hover, Method, Outcome, RidgeFrame, RotorTone, Span, SpeedAnalysis, TrackPoint};

/// Points of a curve at most: more are not seen in print.
const POINTS_MAX: usize = 1200;
/// Frames further apart than so many steps are a gap.
const GAP_STEPS: f64 = 1.6;

/// One recording of an experiment, or one by itself.
#[derive(Clone, Copy, Debug)]
pub struct Trial<'a> {
    /// Name of its load; empty for a recording by itself.
    pub load: &'a str,
    /// Name of the recording.
    pub recording: &'a str,
    /// What was heard; absent where the file could not be read.
    pub analysis: Option<&'a SpeedAnalysis>,
    /// Why there is no speed; absent where there is one.
    pub reason: Option<&'a str>,
    /// The method whose speed is reported.
    pub method: Method,
    /// Its pictures, where they could be made.
    pub pictures: Option<&'a Pictures>,
}

impl<'a> Trial<'a> {
    /// The tone of the rotor, where one was heard and its order is settled.
    pub(crate) fn tone(&self) -> Option<&'a RotorTone> {
        match &self.analysis.filter(|_| self.reason.is_none())?.outcome {
            Outcome::Ok(tone) => Some(tone),
            Outcome::NoRotorTone { .. } => None,
        }
    }

    pub(crate) fn hover(&self) -> Option<&'a Hover> {
        self.analysis.map(|analysis| &analysis.hover)
    }

    /// The picture of all frequencies.
    pub(crate) fn whole(&self) -> Option<&'a Picture> {
        self.pictures?.pictures.iter().find(|picture| picture.view.harmonic.is_none())
    }

    /// The picture around a harmonic.
    pub(crate) fn around(&self, harmonic: u32) -> Option<&'a Picture> {
        self.pictures?.pictures.iter().find(|picture| picture.view.harmonic == Some(harmonic))
    }

    /// The bands of its harmonics.
    pub(crate) fn bands(&self) -> &'a [Band] {
        self.tone().map_or(&[], |tone| &tone.bands)
    }

    /// Lines per turn of the lowest harmonic that was followed: what the right axes divide by.
    pub(crate) fn tone_order(&self) -> Option<f64> {
        let band = self.bands().first()?;
        Some(band.order.lines_per_turn() / f64::from(band.harmonic))
    }
}

/// A ridge as lines without its gaps: time and frequency by a method.
pub(crate) fn ridge_lines(frames: &[RidgeFrame], hop_s: f64, method: Method) -> Vec<Vec<(f64, f64)>> {
    let points = frames.iter().filter_map(|frame| Some((frame.time_s, frame.peak?.hz(method))));
    lines_of(points.collect(), hop_s)
}

/// A track as lines without its gaps: time and shaft speed in turns per second.
pub(crate) fn track_lines(track: &[TrackPoint]) -> Vec<Vec<(f64, f64)>> {
    let points: Vec<(f64, f64)> = track.iter().map(|point| (point.time_s, point.speed_rev_s)).collect();
    let mut steps_s: Vec<f64> = points.windows(2).map(|pair| pair[1].0 - pair[0].0).collect();
    steps_s.sort_by(f64::total_cmp);
    let step_s = steps_s.get(steps_s.len() / 2).copied().unwrap_or(f64::INFINITY);
    lines_of(points, step_s)
}

/// Parts a curve at its gaps, and thins it where it has more points than can be seen: of each group the lowest and the highest stay.
fn lines_of(points: Vec<(f64, f64)>, step_s: f64) -> Vec<Vec<(f64, f64)>> {
    let group = points.len().div_ceil(POINTS_MAX / 2).max(1);
    points
        .chunk_by(|a, b| b.0 - a.0 <= GAP_STEPS * step_s)
        .map(|line| if group <= 2 { line.to_vec() } else { line.chunks(group).flat_map(extremes).collect() })
        .collect()
}

fn extremes(points: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let by_value = |a: &&(f64, f64), b: &&(f64, f64)| a.1.total_cmp(&b.1);
    let mut kept: Vec<(f64, f64)> =
        [points.iter().min_by(by_value), points.iter().max_by(by_value)].into_iter().flatten().copied().collect();
    kept.sort_by(|a, b| a.0.total_cmp(&b.0));
    kept.dedup();
    kept
}

/// From the earliest start to the latest end.
pub(crate) fn hull(spans: impl IntoIterator<Item = Span>) -> Option<Span> {
    spans.into_iter().reduce(|a, b| Span { from_s: a.from_s.min(b.from_s), to_s: a.to_s.max(b.to_s) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_are_parted_at_gaps_and_keep_their_extremes() {
        let points: Vec<(f64, f64)> = (0..100_000)
            .filter(|n| !(50_000..60_000).contains(n))
            .map(|n| (f64::from(n) * 0.01, if n == 777 { 9.0 } else { f64::from(n % 7) }))
            .collect();
        let lines = lines_of(points, 0.01);
        assert_eq!(lines.len(), 2);
        let count: usize = lines.iter().map(Vec::len).sum();
        assert!(count <= POINTS_MAX + 4, "{count}");
        assert!(lines[0].iter().any(|point| point.1 == 9.0), "the highest point was thinned away");
        assert!(lines.iter().flatten().is_sorted_by(|a, b| a.0 <= b.0));
    }
}
