//! Input of the figures about one recording.

use crate::geometry::Point;
use crate::picture::{Picture, Pictures};
use hovertone_analysis::{
    Band, Hover, Method, Outcome, Reading, RidgeFrame, RotorTone, Span, SpeedAnalysis, TrackPoint,
};

/// Most points of a curve: five per millimetre of a panel. More are invisible in print, and make pages large.
const POINTS_MAX: usize = 720;
/// Most points of a curve over all frequencies, where its wander is as high as its line is wide.
const COARSE_POINTS_MAX: usize = 200;
/// Frames that are further apart than this number of steps have a gap between them.
const GAP_STEPS: f64 = 1.6;

/// One recording of an experiment, or a single one.
#[derive(Clone, Copy, Debug)]
pub struct Trial<'a> {
    /// Name of its load; empty for a single recording.
    pub load: &'a str,
    /// Name of the recording.
    pub recording: &'a str,
    /// Its analysis; absent where the file could not be read.
    pub analysis: Option<&'a SpeedAnalysis>,
    /// Reason for a missing speed; absent where there is a speed.
    pub reason: Option<&'a str>,
    /// The readings of an ambiguous tone, most plausible first; empty where a speed is decided.
    pub readings: &'a [Reading],
    /// The reported method.
    pub method: Method,
    /// Its pictures, where they exist.
    pub pictures: Option<&'a Pictures>,
}

impl<'a> Trial<'a> {
    /// The tone of the rotor, if there is one with a settled order.
    pub(crate) fn tone(&self) -> Option<&'a RotorTone> {
        self.heard_tone().filter(|_| self.reason.is_none())
    }

    /// The tone of the rotor, also where its order is not settled: then that of the most plausible reading.
    pub(crate) fn heard_tone(&self) -> Option<&'a RotorTone> {
        match &self.analysis?.outcome {
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

    /// The same, also where the order is not settled.
    pub(crate) fn heard_bands(&self) -> &'a [Band] {
        self.heard_tone().map_or(&[], |tone| &tone.bands)
    }

    /// Lowest frequency of a line that the heard rotor may have: that of its shaft. 0 without a rotor.
    pub(crate) fn lowest_line_hz(&self) -> f64 {
        self.heard_bands().first().map_or(0.0, |band| band.band_hz_low / band.order.lines_per_turn())
    }

    /// Order of the lowest followed harmonic over its number: the divisor of the right axes.
    pub(crate) fn tone_order(&self) -> Option<f64> {
        order_of_first(self.bands())
    }

    /// The same, also where the order is not settled.
    pub(crate) fn heard_tone_order(&self) -> Option<f64> {
        order_of_first(self.heard_bands())
    }
}

fn order_of_first(bands: &[Band]) -> Option<f64> {
    let band = bands.first()?;
    Some(band.order.lines_per_turn() / f64::from(band.harmonic))
}

/// The same lines with fewer points, for a panel in which they are nearly straight.
pub(crate) fn coarser(lines: Vec<Vec<Point>>) -> Vec<Vec<Point>> {
    let count: usize = lines.iter().map(Vec::len).sum();
    let group = (2 * count).div_ceil(COARSE_POINTS_MAX).max(1);
    let coarse = |line: Vec<Point>| if group <= 2 { line } else { line.chunks(group).flat_map(extremes).collect() };
    lines.into_iter().map(coarse).collect()
}

/// A ridge as lines between its gaps: frequency by a method over time.
pub(crate) fn ridge_lines(frames: &[RidgeFrame], hop_s: f64, method: Method) -> Vec<Vec<Point>> {
    let points = frames.iter().filter_map(|frame| Some(Point::new(frame.time_s, frame.peak?.hz(method))));
    lines_of(points.collect(), hop_s)
}

/// A track as lines between its gaps: shaft speed in turns per second over time.
pub(crate) fn track_lines(track: &[TrackPoint]) -> Vec<Vec<Point>> {
    let points: Vec<Point> = track.iter().map(|point| Point::new(point.time_s, point.speed_rev_s)).collect();
    let mut steps_s: Vec<f64> = points.windows(2).map(|pair| pair[1].x - pair[0].x).collect();
    steps_s.sort_by(f64::total_cmp);
    let step_s = steps_s.get(steps_s.len() / 2).copied().unwrap_or(f64::INFINITY);
    lines_of(points, step_s)
}

/// The line that stands for all rotors: the ridge, if a method of the paper was requested, else the track of the speed.
pub(crate) fn common_lines(trial: &Trial<'_>, tone: &RotorTone, band: &Band) -> Vec<Vec<Point>> {
    if !trial.method.reads_ridges() && !tone.track.is_empty() {
        return in_hz(track_lines(&tone.track), band);
    }
    let method = if trial.method == Method::Gaussian { Method::Gaussian } else { Method::MaximumTrace };
    let ridge = tone.ridges.iter().find(|ridge| ridge.band.harmonic == band.harmonic);
    ridge.map_or(Vec::new(), |ridge| ridge_lines(&ridge.frames, ridge.hop_s, method))
}

/// Shaft speeds as frequencies of a band.
pub(crate) fn in_hz(lines: Vec<Vec<Point>>, band: &Band) -> Vec<Vec<Point>> {
    let order = band.order.lines_per_turn();
    let line = |line: Vec<Point>| line.into_iter().map(|point| Point { y: order * point.y, ..point }).collect();
    lines.into_iter().map(line).collect()
}

/// Splits a curve at its gaps. A curve with more points than are visible keeps the lowest and the highest point of each group.
fn lines_of(points: Vec<Point>, step_s: f64) -> Vec<Vec<Point>> {
    let group = points.len().div_ceil(POINTS_MAX / 2).max(1);
    points
        .chunk_by(|a, b| b.x - a.x <= GAP_STEPS * step_s)
        .map(|line| if group <= 2 { line.to_vec() } else { line.chunks(group).flat_map(extremes).collect() })
        .collect()
}

/// The lowest and the highest of the points, in order of time.
fn extremes(points: &[Point]) -> Vec<Point> {
    let by_value = |a: &&Point, b: &&Point| a.y.total_cmp(&b.y);
    let mut kept: Vec<Point> =
        [points.iter().min_by(by_value), points.iter().max_by(by_value)].into_iter().flatten().copied().collect();
    kept.sort_by(|a, b| a.x.total_cmp(&b.x));
    kept.dedup();
    kept
}

/// The span from the earliest start to the latest end.
pub(crate) fn hull(spans: impl IntoIterator<Item = Span>) -> Option<Span> {
    spans.into_iter().reduce(|a, b| Span { from_s: a.from_s.min(b.from_s), to_s: a.to_s.max(b.to_s) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn curves_are_parted_at_gaps_and_keep_their_extremes() {
        let points: Vec<Point> = (0..100_000)
            .filter(|n| !(50_000..60_000).contains(n))
            .map(|n| Point::new(f64::from(n) * 0.01, if n == 777 { 9.0 } else { f64::from(n % 7) }))
            .collect();
        let lines = lines_of(points, 0.01);
        assert_eq!(lines.len(), 2);
        let count: usize = lines.iter().map(Vec::len).sum();
        assert!(count <= POINTS_MAX + 4, "{count}");
        assert!(lines[0].iter().any(|point| point.y == 9.0), "the highest point was thinned away");
        assert!(lines.iter().flatten().is_sorted_by(|a, b| a.x <= b.x));
    }
}
