//! Separated rotors → the speed of each rotor, the mean of all rotors, and their mean square.

use crate::harmonic::HarmonicTrack;
use crate::rotors::{RotorTrack, RotorTracks};
use crate::speed::{BudgetConfig, with_budget};
use crate::thresholds::{FEW, MOST};
use hovertone_analysis::{Method, RotorEstimate, Span, SpeedEstimate, TrackPoint};
use hovertone_signal::statistics::{mean, std};
use hovertone_vehicle::{Order, ROTOR_STD_SHARE, RotorSpeed};
use std::f64::consts::{SQRT_2, TAU};

/// Smallest share of the time in which a resolved rotor is heard, and separated from the others.
const RESOLVED_SHARE_MIN: f64 = MOST;
/// Largest share of the time in which a track may follow noise to count as a rotor, even where it is never separated from other rotors; and in
/// which one of more rotors than four may be merged with another.
/// With four equal rotors, three tracks follow noise at least 38 % of the time.
const LOST_SHARE_MAX: f64 = FEW;
/// Smallest share of the time in which the search would have heard a faint rotor, at which it counts as complete: then a rotor that is not
/// separated turns at the speed of a separated one. In 117 of 120 simulated clips (three equal rotors and a fainter one elsewhere, pairs, or
/// four equal rotors) the mean of the group was within its standard uncertainty.
const FAINT_SHARE_MIN: f64 = FEW;
/// Standard uncertainty of the mean of a rotor due to bobbing, in resolutions. Rms errors of simulated flights in a room with rotors 1 and
/// 2 % apart were 0.011 % in 37 flights, where this gives 0.063 %, and 0.08 % in 16 flights with ten times the gusts and commands.
/// *Decision.*
const BOBBING_RESOLUTIONS: f64 = 0.7;

/// Smallest distance in time of two points of a track with a gap between them, s. *Decision.*
const GAP_S_MAX: f64 = 0.1;
/// The same in steps of the track, where these are long. *Numeric.*
const GAP_STEPS_MAX: f64 = 2.0;

/// Largest distance of the mean by power of all rotors beyond the slowest or the fastest rotor, as a share. *Decision.*
const BEYOND_SHARE_MAX: f64 = 0.02;

impl RotorTracks {
    /// Decides whether the rotors count as separated, as one group, or not at all, with the speed `all` of all rotors together.
    ///
    /// Where at most half of the rotors are resolved, they form one group with a mean: the others turn at the same speeds, or the search would
    /// have heard them. No rotors remain where the search would not have heard them, or found some elsewhere whose own lines are not heard, or
    /// where all rotors that count lie on one side of the speed of all together, because then they may be parts of one rotor.
    pub(crate) fn unless_doubtful_beside(mut self, all: &HarmonicTrack, order: Order) -> Self {
        self.are_one_group = !self.are_mostly_resolved();
        let heard = self.heard(None).filter(|rotor| self.are_one_group || self.is_resolved(rotor, None));
        let speeds: Vec<f64> =
            heard.filter_map(|rotor| Some(rotor.track.speed_in(None, order)?.speed.rev_s())).collect();
        let slowest = speeds.iter().copied().fold(f64::INFINITY, f64::min);
        let fastest = speeds.iter().copied().fold(0.0, f64::max);
        let is_far = all.speed_in(None, order).is_some_and(|all| {
            let mean_rev_s = all.speed.rev_s();
            mean_rev_s < slowest * (1.0 - BEYOND_SHARE_MAX) || mean_rev_s > fastest * (1.0 + BEYOND_SHARE_MAX)
        });
        let is_denied = |rotor: &RotorTrack| rotor.track.blocks.is_empty() && self.is_resolved(rotor, None);
        let is_group = self.would_hear_faint() && !self.rotors.iter().any(is_denied);
        if is_far || self.are_one_group && !is_group { Self::default() } else { self }
    }

    /// Whether at least two rotors are separated, each with its own speed.
    pub(crate) fn are_told_apart(&self) -> bool {
        !self.are_one_group && self.resolved(None).count() >= 2
    }

    /// Whether each of them is separated from the others nearly all the time. Two tracks of one rotor are close to each other again and again.
    pub(crate) fn are_all_apart(&self) -> bool {
        let is_apart = |rotor: &RotorTrack| rotor.is_heard() && self.share_of(&rotor.merged, None) <= LOST_SHARE_MAX;
        self.close_s == 0.0 && self.rotors.iter().all(is_apart)
    }

    /// Whether each of them is resolved.
    pub(crate) fn are_all_resolved(&self) -> bool {
        self.resolved(None).count() == self.rotors.len()
    }

    /// Whether more than half of them are resolved.
    fn are_mostly_resolved(&self) -> bool {
        2 * self.resolved(None).count() > self.rotors.len()
    }

    /// Whether another rotor is heard most of the time beside these, and more than half of these are resolved: else they are parts of one.
    pub(crate) fn leave_another(&self) -> bool {
        self.are_mostly_resolved() && self.another_share() > RESOLVED_SHARE_MIN
    }

    /// Share of the time in which another rotor is heard beside all of these.
    fn another_share(&self) -> f64 {
        self.another_s / self.length_s.max(f64::MIN_POSITIVE)
    }

    /// Longest time between points of a track.
    pub(crate) fn step_s(&self) -> f64 {
        self.rotors.iter().map(|rotor| rotor.track.step_s).fold(0.0, f64::max)
    }

    /// Whether the search would have heard a faint rotor, so that a rotor that is not separated turns at the speed of a separated one.
    fn would_hear_faint(&self) -> bool {
        self.faint_s >= FAINT_SHARE_MIN * self.length_s
    }

    /// The resolved rotors, fastest first. Empty for one group.
    pub(crate) fn rotors(&self, order: Order, budget: &BudgetConfig) -> Vec<RotorEstimate> {
        if self.are_one_group {
            return Vec::new();
        }
        let speeds: Vec<f64> =
            self.resolved(None).filter_map(|rotor| Some(rotor.track.speed_in(None, order)?.speed.rev_s())).collect();
        let unknown_rotor_rev_s = self.unknown_rotor_std_rev_s(&speeds);
        let mut rotors: Vec<RotorEstimate> = self
            .resolved(None)
            .filter_map(|rotor| {
                let mut speed = rotor.track.speed_in(None, order)?;
                let doubt_rev_s = self.doubt_share(rotor, None) * unknown_rotor_rev_s;
                speed.std_uncertainty_rev_s = speed
                    .std_uncertainty_rev_s
                    .map(|std| std.hypot(doubt_rev_s).hypot(self.bobbing_std_rev_s()).hypot(rotor.exchange_std_rev_s));
                let mut track = rotor.track.points_in(None, order);
                for point in &mut track {
                    if rotor.lost.iter().any(|span| span.contains(point.time_s)) {
                        point.std_uncertainty_rev_s = point.std_uncertainty_rev_s.max(unknown_rotor_rev_s);
                    }
                    // where two rotors are not separated, the track may follow either
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

    /// Mean and mean square of the speeds of all rotors over a span of time, or over the whole track; and the standard uncertainty, as a share,
    /// that is common to all hovers. `None` where no rotor is heard.
    ///
    /// The uncertainty of the mean follows from the uncertainties of the rotors; a rotor that is lost, or close to others for much of the
    /// time, may turn at the speed of any other. Common to all hovers are the effect of bobbing, and the unknown speeds of `count − k` of
    /// `count` rotors of which k are resolved: `√(count − k) / count` times the standard deviation of one rotor. This deviation is the
    /// spread of the heard rotors with the resolution, or 6 % where the search would not have heard a faint rotor. Where another rotor is
    /// heard beside all of them for a share of the time, two more may turn: `√2 / (count + 2)` times this spread and this share.
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
        let unknown_rotor_rev_s = self.unknown_rotor_std_rev_s(&speeds);
        let of_doubt: f64 = heard
            .iter()
            .map(|(rotor, ..)| (self.doubt_share(rotor, span) * unknown_rotor_rev_s / heard_count).powi(2))
            .sum();
        let unknown_rev_s = if self.would_hear_faint() { unknown_rotor_rev_s } else { ROTOR_STD_SHARE * mean_rev_s };
        let of_unresolved = (count - resolved).max(0.0).sqrt() / count * unknown_rev_s;
        let of_others = self.another_share() * SQRT_2 / (count + 2.0) * unknown_rev_s;
        let rotors_std_share = of_unresolved.hypot(of_others).hypot(self.bobbing_std_rev_s()) / mean_rev_s;
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

    /// Standard uncertainty of the mean of a rotor due to bobbing, common to all hovers, rev/s: frames smooth the turning points of the
    /// speed, and weight the loud parts of the motion.
    fn bobbing_std_rev_s(&self) -> f64 {
        BOBBING_RESOLUTIONS * self.resolution_rev_s * self.bobbing_s / self.length_s.max(f64::MIN_POSITIVE)
    }

    /// Standard uncertainty of a rotor that may turn at any of these speeds, rev/s.
    fn unknown_rotor_std_rev_s(&self, speeds_rev_s: &[f64]) -> f64 {
        std(speeds_rev_s).unwrap_or(0.0).hypot(self.resolution_rev_s)
    }

    /// Share of a span of time in which a rotor may turn at the speed of any other: it is lost, or rotors are so close that beats of some
    /// look like others.
    fn doubt_share(&self, rotor: &RotorTrack, span: Option<&Span>) -> f64 {
        self.share_of(&rotor.lost, span).max(self.close_s / self.length_s.max(f64::MIN_POSITIVE))
    }

    /// Number of rotors in the mean of all.
    pub(crate) fn in_mean(&self) -> usize {
        self.heard(None).count()
    }

    /// The rotors that are resolved in a span of time.
    fn resolved(&self, span: Option<&Span>) -> impl Iterator<Item = &RotorTrack> {
        self.heard(span).filter(move |rotor| self.is_resolved(rotor, span))
    }

    /// Whether a rotor is separated from the others for most of a span of time.
    fn is_resolved(&self, rotor: &RotorTrack, span: Option<&Span>) -> bool {
        self.share_of(&rotor.merged, span) <= 1.0 - RESOLVED_SHARE_MIN
    }

    /// The rotors that are heard for most of a span of time, alone or together with others.
    fn heard(&self, span: Option<&Span>) -> impl Iterator<Item = &RotorTrack> {
        self.rotors.iter().filter(move |rotor| {
            let blocks = rotor.track.blocks_in(span).iter().filter(|block| block.is_heard).map(|block| &block.span);
            let is_apart = !self.are_one_group && self.is_resolved(rotor, span);
            self.share_of(blocks, span) >= RESOLVED_SHARE_MIN
                && (is_apart || self.share_of(&rotor.lost, span) <= LOST_SHARE_MAX)
        })
    }

    /// Share of a span of time, or of the whole track, that lies in other spans.
    fn share_of<'a>(&self, spans: impl IntoIterator<Item = &'a Span>, of: Option<&Span>) -> f64 {
        let within_s = |own: &Span| of.map_or(*own, |of| own.overlap(*of)).length_s().max(0.0);
        let length_s = of.map_or(self.length_s, Span::length_s).min(self.length_s);
        spans.into_iter().map(within_s).sum::<f64>() / length_s.max(f64::MIN_POSITIVE)
    }
}

/// The mean speed of all rotors over time, where each rotor has a speed. The points of their tracks are up to `step_s` apart.
pub(crate) fn mean_track(rotors: &[RotorEstimate], step_s: f64) -> Vec<TrackPoint> {
    let Some((first, others)) = rotors.split_first() else { return Vec::new() };
    let count = rotors.len() as f64;
    let gap_s = GAP_S_MAX.max(GAP_STEPS_MAX * step_s);
    let mean_at = |own: &TrackPoint| {
        let mut mean = *own;
        let mut variance = own.std_uncertainty_rev_s.powi(2);
        for other in others {
            let point = point_at(&other.track, own.time_s, gap_s)?;
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

/// A track at a time, linear between two points, or the point nearby. `None` in a gap.
fn point_at(track: &[TrackPoint], time_s: f64, gap_s: f64) -> Option<TrackPoint> {
    let after = track.partition_point(|point| point.time_s < time_s);
    let (before, after) = (after.checked_sub(1).and_then(|index| track.get(index)), track.get(after));
    let is_near = |point: &&TrackPoint| (point.time_s - time_s).abs() <= gap_s / 2.0;
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
    /// Mean square of the angular speed over a span of time, or over the whole track, `⟨(2π n)²⟩`, rad²/s². `None` where no block is heard.
    pub(crate) fn mean_square_rad2_s2(&self, span: Option<&Span>) -> Option<f64> {
        let (mut total, mut total_s) = (0.0, 0.0);
        for block in self.blocks_in(span).iter().filter(|block| block.is_heard) {
            let part = span.map_or(block.span, |span| block.span.overlap(*span));
            let length_s = part.length_s();
            if length_s > 0.0 {
                total += block.mean_square_in(part) * length_s;
                total_s += length_s;
            }
        }
        (total_s > 0.0).then(|| TAU * TAU * total / total_s)
    }
}
