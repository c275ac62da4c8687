//! Rotors told apart → the speed of each, their mean and their mean square.

use crate::harmonic::HarmonicTrack;
use crate::rotors::{RotorTrack, RotorTracks};
use crate::speed::{BudgetConfig, with_budget};
use hovertone_analysis::{Method, RotorEstimate, Span, SpeedEstimate, TrackPoint};
use hovertone_signal::statistics::{mean, std};
use hovertone_vehicle::{Order, RotorSpeed};
use std::f64::consts::TAU;

/// A rotor is told apart if it is heard, and apart from the others, for this share of the time.
const RESOLVED_SHARE_MIN: f64 = 0.5;
/// A track that goes through noise for no more than this share of the time is that of a rotor, even if it is never apart from others: of
/// four steady rotors that turn alike, what three of the tracks find is lost for 0.38 of it or more.
const LOST_SHARE_MAX: f64 = 0.2;
/// Where a faint rotor would have been heard for this share of the time, the search has found it, and one that is not told apart turns like
/// one that is: in 120 simulated clips with three rotors alike and one of down to a tenth of their power elsewhere, in pairs, or all alike, the mean of the
/// group was within its u in 117.
const FAINT_SHARE_MIN: f64 = 0.2;
/// How far bobbing takes the mean of a rotor from its track's, in resolutions.
const BOBBING_RESOLUTIONS: f64 = 0.7;
/// How far another one may turn from the mean of those that are told apart, as a standard deviation: rotors of real quadrotors
/// spread over 13 to 22 % from slowest to fastest (PHYSICS section 4).
const UNKNOWN_SPREAD_SHARE: f64 = 0.06;

/// Points of a track further apart than this have a gap between them.
const GAP_S_MAX: f64 = 0.1;

/// The mean by power of all rotors lies between the slowest and the fastest, or no further beyond than this share.
const BEYOND_SHARE_MAX: f64 = 0.02;

impl RotorTracks {
    /// One group, where no more than half of the rotors are told apart: the others would be heard if they turned unlike these.
    /// Nothing, where they would not, or where all that are told apart, or are in the group, lie on one side of what is heard of all
    /// together: then they may be parts of one.
    pub(crate) fn unless_doubtful_beside(mut self, all: &HarmonicTrack, order: Order) -> Self {
        self.are_one_group = 2 * self.resolved(None).count() <= self.rotors.len();
        let heard = self.heard(None).filter(|rotor| self.are_one_group || self.is_resolved(rotor, None));
        let speeds: Vec<f64> =
            heard.filter_map(|rotor| Some(rotor.track.speed_in(None, order)?.speed.rev_s())).collect();
        let slowest = speeds.iter().copied().fold(f64::INFINITY, f64::min);
        let fastest = speeds.iter().copied().fold(0.0, f64::max);
        let is_far = all.speed_in(None, order).is_some_and(|all| {
            let mean_rev_s = all.speed.rev_s();
            mean_rev_s < slowest * (1.0 - BEYOND_SHARE_MAX) || mean_rev_s > fastest * (1.0 + BEYOND_SHARE_MAX)
        });
        if is_far || self.are_one_group && !self.would_hear_faint() { Self::default() } else { self }
    }

    /// Whether a faint rotor would have been heard, so that one that is not told apart turns like one that is.
    fn would_hear_faint(&self) -> bool {
        self.faint_s >= FAINT_SHARE_MIN * self.length_s
    }

    /// The rotors that are told apart, fastest first; none of one group.
    pub(crate) fn rotors(&self, order: Order, budget: &BudgetConfig) -> Vec<RotorEstimate> {
        if self.are_one_group {
            return Vec::new();
        }
        let speeds: Vec<f64> =
            self.resolved(None).filter_map(|rotor| Some(rotor.track.speed_in(None, order)?.speed.rev_s())).collect();
        let among_rev_s = self.among_rev_s(&speeds);
        let mut rotors: Vec<RotorEstimate> = self
            .resolved(None)
            .filter_map(|rotor| {
                let mut speed = rotor.track.speed_in(None, order)?;
                let doubt_rev_s = self.doubt_share(rotor, None) * among_rev_s;
                speed.std_uncertainty_rev_s =
                    speed.std_uncertainty_rev_s.map(|std| std.hypot(doubt_rev_s).hypot(self.of_bobbing_rev_s()));
                let mut track = rotor.track.points_in(None, order);
                for point in &mut track {
                    if rotor.lost.iter().any(|span| span.contains(point.time_s)) {
                        point.std_uncertainty_rev_s = point.std_uncertainty_rev_s.max(among_rev_s);
                    }
                    // where it is not apart from another rotor, it may be either
                    if rotor.merged.iter().any(|span| span.contains(point.time_s)) {
                        point.std_uncertainty_rev_s = point.std_uncertainty_rev_s.max(self.resolution_rev_s);
                    }
                }
                let mean_square_rad2_s2 = rotor.track.mean_square_rad2_s2(None);
                let speed = SpeedEstimate { method: Method::Separated, mean_square_rad2_s2, ..speed };
                Some(RotorEstimate {
                    speed: with_budget(speed, budget, 0.0, self.length_s),
                    merged: rotor.merged.clone(),
                    track,
                    condition: None,
                })
            })
            .collect();
        rotors.sort_by(|a, b| b.speed.speed.rev_s().total_cmp(&a.speed.speed.rev_s()));
        rotors
    }

    /// Mean of all rotors' speeds over a stretch of time, and their mean square; and how far, as a share, that of all may be from it,
    /// in each hover alike. `None` where none is heard.
    ///
    /// Uncertainty: that of each rotor, which may be anywhere among the others while it is lost, or close to others for much of the
    /// time. And in each hover alike: what bobbing does; and of `count` rotors of which k are told apart, what is not known of the
    /// others, each for itself, `√(count − k) / count` times how far a rotor is from the mean of those that are heard, or from where
    /// the resolution has it; where a faint rotor would not have been heard, 6 %.
    pub(crate) fn speed_in(&self, span: Option<&Span>, order: Order) -> Option<(SpeedEstimate, f64)> {
        let heard: Vec<(&RotorTrack, SpeedEstimate, f64)> = self
            .heard(span)
            .filter_map(|rotor| {
                Some((rotor, rotor.track.speed_in(span, order)?, rotor.track.mean_square_rad2_s2(span)?))
            })
            .collect();
        let (count, resolved) = (self.rotors.len() as f64, self.resolved(span).count() as f64);
        let heard_count = heard.len() as f64;
        let speeds: Vec<f64> = heard.iter().map(|(_, speed, _)| speed.speed.rev_s()).collect();
        let squares: Vec<f64> = heard.iter().map(|(_, _, square)| *square).collect();
        let spreads: Vec<f64> = heard.iter().filter_map(|(_, speed, _)| speed.spread_rev_s).collect();
        let mean_rev_s = mean(&speeds)?;
        let stds = heard.iter().filter_map(|(_, speed, _)| speed.std_uncertainty_rev_s);
        let of_rotors: f64 = stds.map(|std| (std / heard_count).powi(2)).sum();
        let among_rev_s = self.among_rev_s(&speeds);
        let of_doubt: f64 =
            heard.iter().map(|(rotor, ..)| (self.doubt_share(rotor, span) * among_rev_s / heard_count).powi(2)).sum();
        let unknown_rev_s = if self.would_hear_faint() { among_rev_s } else { UNKNOWN_SPREAD_SHARE * mean_rev_s };
        let of_unresolved = (count - resolved).max(0.0).sqrt() / count * unknown_rev_s;
        let rotors_std_share = of_unresolved.hypot(self.of_bobbing_rev_s()) / mean_rev_s;
        let (_, first, _) = heard.into_iter().next()?;
        let speed = SpeedEstimate {
            method: Method::Separated,
            speed: RotorSpeed::from_rev_s(mean_rev_s),
            std_uncertainty_rev_s: Some((of_rotors + of_doubt).sqrt()),
            spread_rev_s: mean(&spreads),
            mean_square_rad2_s2: mean(&squares),
            harmonics: Vec::new(),
            ..first
        };
        Some((speed, rotors_std_share))
    }

    /// How far the mean of a rotor may be from its track's, in each hover alike: where all bob, frames cut off where they turn round, and hear
    /// more of where they are loud. Of 37 simulated flights in a room with rotors 1 and 2 % apart, 0.011 % rms where this is 0.063 %; where
    /// gusts and commands are ten times as strong, 0.08 % of 16.
    fn of_bobbing_rev_s(&self) -> f64 {
        BOBBING_RESOLUTIONS * self.resolution_rev_s * self.bobbing_s / self.length_s.max(f64::MIN_POSITIVE)
    }

    /// How far a rotor that may be anywhere among these is from where it is looked for.
    fn among_rev_s(&self, speeds_rev_s: &[f64]) -> f64 {
        std(speeds_rev_s).unwrap_or(0.0).hypot(self.resolution_rev_s)
    }

    /// Share of a stretch of time in which a rotor may be anywhere among the others: it is lost, or rotors are so close to each other
    /// that beats of some can pass for others.
    fn doubt_share(&self, rotor: &RotorTrack, span: Option<&Span>) -> f64 {
        self.share_of(&rotor.lost, span).max(self.close_s / self.length_s.max(f64::MIN_POSITIVE))
    }

    /// The rotors that are told apart for most of a stretch of time.
    fn resolved(&self, span: Option<&Span>) -> impl Iterator<Item = &RotorTrack> {
        self.heard(span).filter(move |rotor| self.is_resolved(rotor, span))
    }

    /// Whether a rotor is apart from the others for most of a stretch of time.
    fn is_resolved(&self, rotor: &RotorTrack, span: Option<&Span>) -> bool {
        self.share_of(&rotor.merged, span) <= 1.0 - RESOLVED_SHARE_MIN
    }

    /// The rotors that are heard for most of a stretch of time, by themselves or with others.
    fn heard(&self, span: Option<&Span>) -> impl Iterator<Item = &RotorTrack> {
        self.rotors.iter().filter(move |rotor| {
            let blocks = rotor.track.blocks.iter().filter(|block| block.is_heard).map(|block| &block.span);
            let is_apart = !self.are_one_group && self.is_resolved(rotor, span);
            self.share_of(blocks, span) >= RESOLVED_SHARE_MIN
                && (is_apart || self.share_of(&rotor.lost, span) <= LOST_SHARE_MAX)
        })
    }

    /// Share that some spans have in a stretch of time.
    fn share_of<'a>(&self, spans: impl IntoIterator<Item = &'a Span>, of: Option<&Span>) -> f64 {
        let within_s = |own: &Span| of.map_or(*own, |of| own.overlap(*of)).length_s().max(0.0);
        let length_s = of.map_or(self.length_s, Span::length_s).min(self.length_s);
        spans.into_iter().map(within_s).sum::<f64>() / length_s.max(f64::MIN_POSITIVE)
    }
}

/// The mean of rotors over time, where each of them has a speed.
pub(crate) fn mean_track(rotors: &[RotorEstimate]) -> Vec<TrackPoint> {
    let Some((first, others)) = rotors.split_first() else { return Vec::new() };
    let count = rotors.len() as f64;
    let mean_at = |own: &TrackPoint| {
        let mut mean = *own;
        let mut variance = own.std_uncertainty_rev_s.powi(2);
        for other in others {
            let point = point_at(&other.track, own.time_s)?;
            mean.speed_rev_s += point.speed_rev_s;
            mean.tone_hz += point.tone_hz;
            mean.level_db = mean.level_db.max(point.level_db);
            variance += point.std_uncertainty_rev_s.powi(2);
        }
        mean.speed_rev_s /= count;
        mean.tone_hz /= count;
        mean.std_uncertainty_rev_s = variance.sqrt() / count;
        Some(mean)
    };
    first.track.iter().filter_map(mean_at).collect()
}

/// A track at a time between two of its points, or near one.
fn point_at(track: &[TrackPoint], time_s: f64) -> Option<TrackPoint> {
    let after = track.partition_point(|point| point.time_s < time_s);
    let (before, after) = (after.checked_sub(1).and_then(|index| track.get(index)), track.get(after));
    let is_near = |point: &&TrackPoint| (point.time_s - time_s).abs() <= GAP_S_MAX / 2.0;
    match (before.filter(is_near), after.filter(is_near)) {
        (Some(a), Some(b)) => {
            let share = (time_s - a.time_s) / (b.time_s - a.time_s).max(f64::MIN_POSITIVE);
            let between = |a: f64, b: f64| a + share * (b - a);
            Some(TrackPoint {
                time_s,
                tone_hz: between(a.tone_hz, b.tone_hz),
                speed_rev_s: between(a.speed_rev_s, b.speed_rev_s),
                std_uncertainty_rev_s: a.std_uncertainty_rev_s.max(b.std_uncertainty_rev_s),
                level_db: a.level_db.max(b.level_db),
            })
        }
        (near, other) => near.or(other).copied(),
    }
}

impl HarmonicTrack {
    /// Mean of the squared angular speed over a stretch of time, `⟨(2π n)²⟩`: of each block's straight line exactly,
    /// `n² + γ² T² / 12`.
    fn mean_square_rad2_s2(&self, span: Option<&Span>) -> Option<f64> {
        let (mut total, mut total_s) = (0.0, 0.0);
        for block in self.blocks.iter().filter(|block| block.is_heard) {
            let part = span.map_or(block.span, |span| block.span.overlap(*span));
            let length_s = part.length_s();
            if length_s > 0.0 {
                let square = block.speed_at(part.middle_s()).powi(2) + (block.slope_rev_s2 * length_s).powi(2) / 12.0;
                total += square * length_s;
                total_s += length_s;
            }
        }
        (total_s > 0.0).then(|| TAU * TAU * total / total_s)
    }
}
