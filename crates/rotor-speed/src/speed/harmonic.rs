//! Blocks of the harmonic likelihood → mean shaft speed over a span of time, and the track of the speed.

use crate::harmonic::{EndBlock, HarmonicBlock, HarmonicTrack, SAME_TIME_S, joined_variance_turns2};
use hovertone_analysis::{HarmonicSpeed, Method, Span, SpeedEstimate, TrackPoint};
use hovertone_signal::statistics::{mean, std, std_uncertainty_of_mean};
use hovertone_vehicle::{Order, RotorSpeed};

/// Standard uncertainty of the speed at the end of a block, over the uncertainty in its middle: the variance of the slope of a parabola
/// fitted to evenly spread phases is 16 times as large at the ends. *Physics.*
const END_STDS: f64 = 4.0;

/// Smallest weight of a block, at its ends. *Numeric.*
const NEARNESS_MIN: f64 = 1e-3;

/// Standard uncertainty of a track point, as a share of the difference between the two blocks there. Independent errors would give one
/// half; the blocks share half of their sound, which gives more. *Decision.*
const DISAGREEMENT_SHARE: f64 = 0.7;

/// Places in a block, as shares of its length, at which it has the same weight as the block between it and its neighbour. *Numeric.*
const QUARTERS: [f64; 2] = [0.25, 0.75];

impl HarmonicTrack {
    /// Mean speed over a span of time, or over the whole track: the turns of the blocks and of the steps between them, over the length of
    /// the blocks. `None` where no block is heard.
    ///
    /// - The uncertainty of a block follows from the curvature of its likelihood and the scatter of its phases. The uncertainty of blocks that
    ///   are joined by phase follows from the angle at both ends.
    /// - The variation of the speed itself is no uncertainty of its mean, except for the time in which no block is heard.
    /// - For several rotors at once, the uncertainty is at least the one of their mean with unknown loudness.
    pub(crate) fn speed_in(&self, span: Option<&Span>, order: Order) -> Option<SpeedEstimate> {
        let parts: Vec<Part> = self
            .blocks_in(span)
            .iter()
            .filter(|block| block.is_heard)
            .map(|block| Part { block, span: span.map_or(block.span, |span| block.span.overlap(*span)) })
            .filter(|part| part.span.length_s() > 0.0)
            .collect();
        let total_s: f64 = parts.iter().map(|part| part.span.length_s()).sum();
        if parts.is_empty() {
            return None;
        }
        let runs: Vec<&[Part]> = parts.chunk_by(|part, _| part.block.step_to_next_turns.is_some()).collect();
        let mean_rev_s = runs.iter().map(|run| turns_of(run)).sum::<f64>() / total_s;
        let is_edge = |time_s: f64| self.is_edge(time_s);
        let variance = runs.iter().map(|run| turns_variance(run, &is_edge)).sum::<f64>() / (total_s * total_s);
        let several: Vec<&HarmonicBlock> =
            parts.iter().map(|part| part.block).filter(|block| block.is_several).collect();
        let variance = if several.is_empty() { variance } else { variance.max(variance_of_several(&several)) };
        let points: Vec<TrackPoint> = self.points_in(span, order);
        let speeds: Vec<f64> = points.iter().map(|point| point.speed_rev_s).collect();
        let spread_rev_s = std(&speeds);
        let variance = variance + self.gap_share_squared(span) * spread_rev_s.unwrap_or(0.0).powi(2);
        let weights: f64 = self.lines.iter().map(|line| line.weight()).sum();
        Some(SpeedEstimate {
            method: Method::Harmonic,
            order,
            speed: RotorSpeed::from_rev_s(mean_rev_s),
            std_uncertainty_rev_s: Some(variance.sqrt()),
            spread_rev_s,
            mean_square_rad2_s2: None,
            frame_count: points.len(),
            budget: Vec::new(),
            harmonics: self
                .lines
                .iter()
                .filter_map(|line| {
                    let times = line.order / order.lines_per_turn();
                    Some(HarmonicSpeed {
                        harmonic: (times.fract() == 0.0).then_some(times as u32)?,
                        order: Order::new(line.order).ok()?,
                        mean_hz: line.order * mean_rev_s,
                        std_hz: spread_rev_s.map(|spread| line.order * spread),
                        frame_count: points.len(),
                        weight: line.weight() / weights.max(f64::MIN_POSITIVE),
                    })
                })
                .collect(),
        })
    }

    /// Square of the standard deviation of the mean over all time from the mean over the time that is heard, over the spread of the speed:
    /// `g² (1/m + 1/n)` for a share g of the time in m gaps between n heard stretches, whose mean speeds are independent.
    fn gap_share_squared(&self, span: Option<&Span>) -> f64 {
        let stretches: Vec<&[HarmonicBlock]> =
            self.blocks_in(span).chunk_by(|block, next| block.is_heard == next.is_heard).collect();
        let lengths_s = |is_heard: bool| {
            let of_kind = stretches.iter().filter(move |stretch| stretch[0].is_heard == is_heard);
            of_kind.map(|stretch| stretch.iter().map(|block| block.span.length_s()).sum::<f64>()).collect::<Vec<f64>>()
        };
        let (heard_s, gaps_s) = (lengths_s(true), lengths_s(false));
        if heard_s.is_empty() || gaps_s.is_empty() {
            return 0.0;
        }
        let gap_s: f64 = gaps_s.iter().sum();
        let gap_share = gap_s / (gap_s + heard_s.iter().sum::<f64>());
        gap_share.powi(2) * (1.0 / gaps_s.len() as f64 + 1.0 / heard_s.len() as f64)
    }

    /// Whether a stretch of sound begins or ends at this time: one block begins or ends here, and no other.
    fn is_edge(&self, time_s: f64) -> bool {
        let is_here = |border_s: f64| (border_s - time_s).abs() < SAME_TIME_S;
        let touches = |block: &&HarmonicBlock| is_here(block.span.from_s) || is_here(block.span.to_s);
        let near = Span { from_s: time_s - SAME_TIME_S, to_s: time_s + SAME_TIME_S };
        self.blocks_in(Some(&near)).iter().filter(touches).count() == 1
    }

    /// The speed at every step of the track, without points in gaps: the mean of the block around the time and of the block between it and
    /// its neighbour, each weighted by the nearness of its own middle.
    pub(crate) fn points_in(&self, span: Option<&Span>, order: Order) -> Vec<TrackPoint> {
        let step_s = self.step_s;
        let is_wanted = |block: &&HarmonicBlock| {
            block.is_heard && span.is_none_or(|span| block.span.overlap(*span).length_s() > 0.0)
        };
        let blocks: Vec<&HarmonicBlock> = self.blocks_in(span).iter().filter(is_wanted).collect();
        let disagreement_rev_s = self.disagreement_rev_s(&blocks);
        blocks
            .iter()
            .flat_map(|block| {
                let count = (block.span.length_s() / step_s).round().max(1.0);
                (0..count as usize).map(move |index| {
                    let time_s = block.span.from_s + block.span.length_s() * (index as f64 + 0.5) / count;
                    let own = BlockAt::new(block, time_s);
                    let at = self.between_at(time_s).map_or(own, |between| own.with(&BlockAt::new(between, time_s)));
                    TrackPoint {
                        time_s,
                        tone_hz: at.speed_rev_s * order.lines_per_turn(),
                        speed_rev_s: at.speed_rev_s,
                        std_uncertainty_rev_s: at.std_uncertainty_rev_s.max(DISAGREEMENT_SHARE * disagreement_rev_s),
                        level_db: block.level_db,
                    }
                })
            })
            .filter(|point| span.is_none_or(|span| span.contains(point.time_s)))
            .collect()
    }

    /// Root mean square difference between the blocks and the blocks between them, at the places where both have equal weight, rev/s. It
    /// contains noise, curvature of the speed, and lines that do not keep their phase; the uncertainty of a block does not contain the
    /// last.
    fn disagreement_rev_s(&self, blocks: &[&HarmonicBlock]) -> f64 {
        let quarters = |block: &HarmonicBlock| QUARTERS.map(|share| block.span.from_s + share * block.span.length_s());
        let differences: Vec<f64> = blocks
            .iter()
            .flat_map(|block| quarters(block).map(|time_s| (block, time_s)))
            .filter_map(|(block, time_s)| Some(self.between_at(time_s)?.speed_at(time_s) - block.speed_at(time_s)))
            .collect();
        let squares: Vec<f64> = differences.iter().map(|difference| difference * difference).collect();
        mean(&squares).unwrap_or(0.0).sqrt()
    }

    /// The block between two blocks at a time.
    fn between_at(&self, time_s: f64) -> Option<&HarmonicBlock> {
        let begun = self.between.partition_point(|block| block.span.from_s <= time_s);
        self.between[..begun].last().filter(|block| block.span.contains(time_s))
    }
}

/// The speed by one block at an instant.
#[derive(Clone, Copy)]
struct BlockAt {
    speed_rev_s: f64,
    std_uncertainty_rev_s: f64,
    /// Weight: 1 in the middle of the block, nearly 0 at its ends.
    nearness: f64,
}

impl BlockAt {
    fn new(block: &HarmonicBlock, time_s: f64) -> Self {
        let aside = 2.0 * (time_s - block.span.middle_s()) / block.span.length_s();
        Self {
            speed_rev_s: block.speed_at(time_s),
            std_uncertainty_rev_s: block.std_uncertainty_rev_s
                * (1.0 + (END_STDS * END_STDS - 1.0) * aside * aside).sqrt(),
            nearness: (1.0 - aside.abs()).max(NEARNESS_MIN),
        }
    }

    /// The weighted mean of both. Its uncertainty is the mean of theirs, because they share sound and so may share errors.
    fn with(&self, other: &Self) -> Self {
        let share = self.nearness / (self.nearness + other.nearness);
        let mixed = |own: f64, other: f64| share * own + (1.0 - share) * other;
        Self {
            speed_rev_s: mixed(self.speed_rev_s, other.speed_rev_s),
            std_uncertainty_rev_s: mixed(self.std_uncertainty_rev_s, other.std_uncertainty_rev_s),
            nearness: self.nearness + other.nearness,
        }
    }
}

/// Variance of the mean speed of several rotors: the shift due to their loudness, which is common to all frames, and the scatter.
fn variance_of_several(blocks: &[&HarmonicBlock]) -> f64 {
    let speeds: Vec<f64> = blocks.iter().map(|block| block.speed_rev_s).collect();
    let shifts: Vec<f64> = blocks.iter().map(|block| block.std_uncertainty_rev_s).collect();
    std_uncertainty_of_mean(&speeds).unwrap_or(0.0).powi(2) + mean(&shifts).unwrap_or(0.0).powi(2)
}

/// A block, or the part of it in a span of time.
struct Part<'a> {
    block: &'a HarmonicBlock,
    span: Span,
}

/// Number of turns over parts that are joined by phase.
fn turns_of(run: &[Part]) -> f64 {
    let within: f64 = run.iter().map(|part| part.block.speed_at(part.span.middle_s()) * part.span.length_s()).sum();
    within + steps_of(run).sum::<f64>()
}

/// The steps between the parts of a run.
fn steps_of(run: &[Part]) -> impl Iterator<Item = f64> {
    run.iter().take(run.len() - 1).filter_map(|part| part.block.step_to_next_turns)
}

/// Variance of the number of turns over parts that are joined by phase.
fn turns_variance(run: &[Part], is_edge: &impl Fn(f64) -> bool) -> f64 {
    let (Some(first), Some(last)) = (run.first(), run.last()) else { return 0.0 };
    if run.len() == 1 {
        let part = first.block.within(first.span);
        return part.map_or(0.0, |part| (part.std_uncertainty_rev_s * part.span.length_s()).powi(2));
    }
    let ends = [(first, first.span.from_s), (last, last.span.to_s)].map(|(part, end_s)| EndBlock {
        length_s: part.block.span.length_s(),
        speed_variance: part.block.std_uncertainty_rev_s.powi(2),
        is_faded: is_edge(end_s),
    });
    joined_variance_turns2(ends, &steps_of(run).collect::<Vec<f64>>())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A speed n = n₀ + c t².
    struct CurvedSpeed {
        start_rev_s: f64,
        bend_rev_s3: f64,
    }

    /// The block with the straight line that fits a curved speed best.
    fn block(from_s: f64, to_s: f64, CurvedSpeed { start_rev_s, bend_rev_s3 }: &CurvedSpeed) -> HarmonicBlock {
        let (middle_s, length_s) = ((from_s + to_s) / 2.0, to_s - from_s);
        HarmonicBlock {
            span: Span { from_s, to_s },
            speed_rev_s: start_rev_s + bend_rev_s3 * (middle_s * middle_s + length_s * length_s / 12.0),
            slope_rev_s2: 2.0 * bend_rev_s3 * middle_s,
            variance_rev2_s2: 0.0,
            std_uncertainty_rev_s: 1e-3,
            step_to_next_turns: None,
            is_several: false,
            level_db: -20.0,
            is_heard: true,
            is_steady: false,
        }
    }

    /// Of a speed that wanders, stretches of 1 s are heard at random: the mean over all time is within its ± as often as it should be.
    #[test]
    fn what_is_not_heard_makes_the_mean_uncertain() {
        let order = Order::new(2.0).unwrap();
        let mut state = 7u64;
        let mut random = move || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        let mut squares = Vec::new();
        for _ in 0..400 {
            // independent speeds, one for each second
            let speeds: Vec<f64> = (0..12).map(|_| 60.0 + (0..12).map(|_| random() - 0.5).sum::<f64>()).collect();
            let blocks = (0..).zip(&speeds).map(|(index, &speed)| {
                let still = CurvedSpeed { start_rev_s: speed, bend_rev_s3: 0.0 };
                HarmonicBlock { is_heard: random() < 0.5, ..block(f64::from(index), f64::from(index + 1), &still) }
            });
            let track = HarmonicTrack { step_s: 0.1, blocks: blocks.collect(), ..HarmonicTrack::default() };
            let Some(found) = track.speed_in(None, order) else { continue };
            let error = found.speed.rev_s() - mean(&speeds).unwrap();
            squares.push((error / found.std_uncertainty_rev_s.unwrap()).powi(2).min(100.0));
        }
        let rms = mean(&squares).unwrap().sqrt();
        assert!((0.7..1.3).contains(&rms), "{rms}");
    }

    /// The error of straight blocks at their ends, c T² / 6 at most, is halved by the blocks between them.
    #[test]
    fn a_bend_is_followed_across_the_ends_of_blocks() {
        let bend = CurvedSpeed { start_rev_s: 60.0, bend_rev_s3: 2.0 };
        let at = |index: i32| 0.2 * f64::from(index);
        let track = HarmonicTrack {
            step_s: 0.002,
            blocks: (0..4).map(|index| block(at(index), at(index + 1), &bend)).collect(),
            between: (0..3).map(|index| block(at(index) + 0.1, at(index + 1) + 0.1, &bend)).collect(),
            ..HarmonicTrack::default()
        };
        let alone = HarmonicTrack { between: Vec::new(), ..track.clone() };
        let order = Order::new(2.0).unwrap();
        let errors = |track: &HarmonicTrack| -> Vec<f64> {
            let points = track.points_in(None, order);
            assert_eq!(points.len(), 400);
            points
                .iter()
                .filter(|point| (0.1..0.7).contains(&point.time_s))
                .map(|point| {
                    (point.speed_rev_s - bend.start_rev_s - bend.bend_rev_s3 * point.time_s * point.time_s).abs()
                })
                .collect()
        };
        let worst = |errors: &[f64]| errors.iter().copied().fold(0.0, f64::max);
        let (with, without) = (errors(&track), errors(&alone));
        assert!(worst(&without) > 0.8 * 2.0 * 0.04 / 6.0);
        assert!(worst(&with) < 0.55 * worst(&without), "{} of {}", worst(&with), worst(&without));
    }
}
