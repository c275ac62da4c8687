//! Speeds over time: what a program says, what is true, and how far apart they are. The scores are those of the peers'
//! own bench (`run_all.py` and `summary.py` of `../shared/peers`), so that both can be read side by side.

use hovertone::speed::{Span, TrackPoint};

/// Not scored this near to either end.
const EDGE_S: f64 = 0.5;
const WITHIN_SHARE: f64 = 0.01;
const GROSS_SHARE: f64 = 0.2;
/// The truth is straight between nodes 0.05 s apart: a mean in these steps is exact to a millisecond's share of a span.
const MEAN_STEP_S: f64 = 0.001;

/// One frame of what a program says.
#[derive(Clone, Debug)]
pub(super) struct TrackFrame {
    pub(super) time_s: f64,
    /// The speed that it gives for all rotors; `None` where it hears none.
    pub(super) rev_s: Option<f64>,
    /// The rotors one by one, slowest first; empty where it does not tell them apart.
    pub(super) rotors_rev_s: Vec<f64>,
}

impl From<&TrackPoint> for TrackFrame {
    fn from(point: &TrackPoint) -> Self {
        Self { time_s: point.time_s, rev_s: Some(point.speed_rev_s), rotors_rev_s: Vec::new() }
    }
}

/// Frames of a CSV of time, speed and maybe more (`t,rev[,conf]` or `t,rev,r1,r2,r3,r4`); not-a-number is a gap. Speeds
/// are multiplied by `factor`.
pub(super) fn frames_from_csv(text: &str, factor: f64) -> Vec<TrackFrame> {
    text.lines()
        .skip(1)
        .filter_map(|line| {
            let numbers: Vec<f64> = line.split(',').map(|cell| cell.trim().parse().unwrap_or(f64::NAN)).collect();
            let (time_s, rev_s) = (*numbers.first()?, *numbers.get(1)?);
            let rotors_rev_s =
                numbers.get(2..6).map_or_else(Vec::new, |rotors| rotors.iter().map(|r| r * factor).collect());
            time_s.is_finite().then(|| TrackFrame {
                time_s,
                rev_s: rev_s.is_finite().then_some(rev_s * factor),
                rotors_rev_s,
            })
        })
        .collect()
}

/// True speed of each rotor over time, straight between its nodes.
pub(super) struct TrueTrack {
    time_s: Vec<f64>,
    /// For each node, each rotor's speed.
    rotors_rev_s: Vec<Vec<f64>>,
}

impl TrueTrack {
    /// From a CSV without head: time, then one column for each rotor.
    pub(super) fn from_csv(text: &str) -> Result<Self, String> {
        let (mut time_s, mut rotors_rev_s) = (Vec::new(), Vec::new());
        for line in text.lines() {
            let numbers: Result<Vec<f64>, _> = line.split(',').map(|cell| cell.trim().parse::<f64>()).collect();
            let numbers = numbers.map_err(|error| format!("truth: {line}: {error}"))?;
            let (time, rotors) = numbers.split_first().ok_or("truth: an empty line")?;
            time_s.push(*time);
            rotors_rev_s.push(rotors.to_vec());
        }
        if time_s.len() < 2 || rotors_rev_s.iter().any(Vec::is_empty) {
            return Err("the truth has fewer than two rows, or no rotor".to_owned());
        }
        Ok(Self { time_s, rotors_rev_s })
    }

    pub(super) fn rotor_count(&self) -> usize {
        self.rotors_rev_s.first().map_or(0, Vec::len)
    }

    /// Time that is scored: all but the ends.
    pub(super) fn scored_s(&self) -> f64 {
        self.end_s() - 2.0 * EDGE_S
    }

    fn end_s(&self) -> f64 {
        self.time_s.last().copied().unwrap_or_default()
    }

    /// Each rotor's speed at an instant; before the first and after the last node those stand.
    fn at(&self, time_s: f64) -> Vec<f64> {
        let after = self.time_s.partition_point(|&node| node <= time_s).clamp(1, self.time_s.len() - 1);
        let (from_s, to_s) = (self.time_s[after - 1], self.time_s[after]);
        let share = ((time_s - from_s) / (to_s - from_s)).clamp(0.0, 1.0);
        let ends = self.rotors_rev_s[after - 1].iter().zip(&self.rotors_rev_s[after]);
        ends.map(|(from, to)| from + share * (to - from)).collect()
    }

    /// Mean of the rotors over these spans together, from 1 ms to 1 ms. `None` for no length of time.
    pub(super) fn mean_over(&self, spans: &[Span]) -> Option<f64> {
        let instants = |span: &Span| {
            let count = (span.length_s() / MEAN_STEP_S).round() as usize;
            let from_s = span.from_s;
            (0..count).map(move |step| from_s + (step as f64 + 0.5) * MEAN_STEP_S)
        };
        let speeds: Vec<f64> = spans.iter().flat_map(instants).map(|time_s| mean(&self.at(time_s))).collect();
        (!speeds.is_empty()).then(|| mean(&speeds))
    }

    fn mean_rev_s(&self) -> f64 {
        self.rotors_rev_s.iter().map(|rotors| mean(rotors)).sum::<f64>() / self.rotors_rev_s.len() as f64
    }
}

/// How far a program's track is off. Shares, not percent.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Score {
    /// Share of the frames with a speed.
    pub(super) answered: f64,
    /// Median |error| against the mean of the rotors.
    pub(super) median_error: f64,
    /// Frames within 1 %, and off by more than 20 %, as shares of all frames.
    pub(super) within: f64,
    pub(super) gross: f64,
    /// Median distance to the nearest rotor.
    pub(super) nearest: f64,
    /// Error of a thrust constant from the whole file: true mean over time and rotors of ω² over the track's, less 1.
    pub(super) thrust_constant_error: f64,
    /// Median |error| of each rotor where the program tells them apart.
    pub(super) each_rotor: Vec<f64>,
}

/// Scores a track. `frame_count` is how many frames there would be without gaps; `None` where gaps are frames too.
/// `None` where no frame has a speed.
pub(super) fn score_of_track(frames: &[TrackFrame], truth: &TrueTrack, frame_count: Option<f64>) -> Option<Score> {
    let counted = |frame: &&TrackFrame| frame.time_s > EDGE_S && frame.time_s < truth.end_s() - EDGE_S;
    let frame_count = frame_count.unwrap_or_else(|| frames.iter().filter(counted).count() as f64);
    let (mut errors, mut nearest, mut squares, mut true_squares) = (Vec::new(), Vec::new(), 0.0, 0.0);
    for (frame, rev_s) in frames.iter().filter(counted).filter_map(|frame| Some((frame, frame.rev_s?))) {
        let rotors = truth.at(frame.time_s);
        errors.push((rev_s / mean(&rotors) - 1.0).abs());
        nearest.push(rotors.iter().map(|rotor| (rev_s - rotor).abs()).fold(f64::INFINITY, f64::min));
        squares += rev_s * rev_s;
        true_squares += rotors.iter().map(|rotor| rotor * rotor).sum::<f64>() / rotors.len() as f64;
    }
    let share = |count: usize| (count as f64 / frame_count).min(1.0);
    Some(Score {
        answered: share(errors.len()),
        within: share(errors.iter().filter(|&&error| error < WITHIN_SHARE).count()),
        gross: share(errors.iter().filter(|&&error| error > GROSS_SHARE).count()),
        median_error: median(errors)?,
        nearest: median(nearest)? / truth.mean_rev_s(),
        thrust_constant_error: true_squares / squares - 1.0,
        each_rotor: errors_of_each_rotor(frames, truth),
    })
}

/// Both sides sorted by speed at each instant, as the peers' bench does.
fn errors_of_each_rotor(frames: &[TrackFrame], truth: &TrueTrack) -> Vec<f64> {
    let told_apart: Vec<&TrackFrame> =
        frames.iter().filter(|frame| frame.rotors_rev_s.len() == truth.rotor_count()).collect();
    let sorted = |frame: &TrackFrame| {
        let mut rotors = truth.at(frame.time_s);
        rotors.sort_by(f64::total_cmp);
        rotors
    };
    (0..truth.rotor_count())
        .filter_map(|index| {
            let error = |frame: &&TrackFrame| (frame.rotors_rev_s[index] / sorted(frame)[index] - 1.0).abs();
            median(told_apart.iter().map(error).collect())
        })
        .collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// The middle value, or the mean of the middle two.
pub(super) fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    let upper = *values.get(values.len() / 2)?;
    let lower = values[(values.len() - 1) / 2];
    Some((lower + upper) / 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn truth() -> TrueTrack {
        TrueTrack::from_csv("0,50,70\n10,60,80\n").unwrap()
    }

    fn frame(time_s: f64, rev_s: Option<f64>) -> TrackFrame {
        TrackFrame { time_s, rev_s, rotors_rev_s: Vec::new() }
    }

    #[test]
    fn a_track_is_scored_against_the_mean_of_the_rotors() {
        let frames = [
            frame(0.2, Some(1.0)),
            frame(2.0, Some(62.0)),
            frame(4.0, Some(70.4)),
            frame(6.0, None),
            frame(8.0, Some(34.0)),
        ];
        let score = score_of_track(&frames, &truth(), None).unwrap();
        assert_eq!((score.answered, score.within, score.gross), (0.75, 0.25, 0.25));
        assert!((score.median_error - 0.1).abs() < 1e-12, "{score:?}");
        // rotors at 4 s: 54 and 74
        assert!((score.nearest - median(vec![10.0, 3.6, 24.0]).unwrap() / 65.0).abs() < 1e-12);
        let squares = 62.0_f64.powi(2) + 70.4_f64.powi(2) + 34.0_f64.powi(2);
        let true_squares = (52.0_f64.powi(2) + 72.0_f64.powi(2) + 54.0_f64.powi(2) + 74.0_f64.powi(2)) / 2.0
            + (58.0_f64.powi(2) + 78.0_f64.powi(2)) / 2.0;
        assert!((score.thrust_constant_error - (true_squares / squares - 1.0)).abs() < 1e-12);
        assert_eq!(score_of_track(&frames[..1], &truth(), None), None);
        assert_eq!(score_of_track(&frames, &truth(), Some(6.0)).unwrap().answered, 0.5);
    }

    #[test]
    fn the_mean_of_the_truth_is_that_of_the_spans() {
        let spans = [Span { from_s: 0.0, to_s: 1.0 }, Span { from_s: 3.0, to_s: 5.0 }];
        assert!((truth().mean_over(&spans).unwrap() - (60.5 + 2.0 * 64.0) / 3.0).abs() < 1e-9);
        assert_eq!(truth().mean_over(&[]), None);
    }

    #[test]
    fn rotors_that_are_told_apart_are_scored_one_by_one() {
        let frames = frames_from_csv("t,rev,r1,r2,r3,r4\n2,62,52,72.72,0,0\n", 1.0);
        assert_eq!(frames[0].rotors_rev_s.len(), 4);
        let two = TrackFrame { rotors_rev_s: vec![52.0, 72.72], ..frames[0].clone() };
        let score = score_of_track(&[two], &truth(), None).unwrap();
        assert!(score.each_rotor[0].abs() < 1e-12 && (score.each_rotor[1] - 0.01).abs() < 1e-12);
        assert!(score_of_track(&frames, &truth(), None).unwrap().each_rotor.is_empty());
    }

    #[test]
    fn gaps_of_a_csv_are_gaps() {
        let frames = frames_from_csv("t,rev\n1,nan\n2,30\n", 2.0);
        assert_eq!(frames.iter().map(|frame| frame.rev_s).collect::<Vec<_>>(), [None, Some(60.0)]);
        assert!(TrueTrack::from_csv("0,x\n1,2\n").is_err() && TrueTrack::from_csv("0,1\n").is_err());
    }
}
