//! Blocks of the harmonic likelihood → shaft speed over a stretch of time, and its track.

use crate::harmonic::{EndBlock, HarmonicBlock, HarmonicTrack, LENGTH_POWER, joined_variance_turns2};
use hovertone_analysis::{HarmonicSpeed, Method, Span, SpeedEstimate, TrackPoint};
use hovertone_signal::statistics::{mean, std, std_uncertainty_of_mean};
use hovertone_vehicle::{Order, RotorSpeed};

/// Uncertainty of the speed at the end of a block over that in its middle: a straight line through phases that scatter is
/// known four times as well in the middle.
const END_STDS: f64 = 4.0;

/// What a block counts for at its very ends.
const NEARNESS_MIN: f64 = 1e-3;

/// The mean of two that disagree is off by half of that if their errors are independent, and by more because both hear half of the
/// same sound.
const DISAGREEMENT_SHARE: f64 = 0.7;

/// Borders of blocks nearer than this are one.
const SAME_TIME_S: f64 = 1e-6;

impl HarmonicTrack {
    /// Mean speed over a stretch of time: the turns of the blocks and of the steps between them, over the time that they cover.
    /// `None` where nothing is heard.
    ///
    /// - Uncertainty: of a block, from the curvature of its likelihood, which noise makes, widened where its phases scatter more
    ///   than that explains; of blocks that are joined by phase, from the angle at their two ends.
    /// - The wander of the rotor itself is no uncertainty of its mean, as long as there are no gaps.
    pub(crate) fn speed_in(&self, span: Option<&Span>, order: Order) -> Option<SpeedEstimate> {
        let parts: Vec<Part> = self
            .blocks
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
                        weight: line.weight() / weights,
                    })
                })
                .collect(),
        })
    }

    /// Whether a stretch of sound begins or ends here: a block does, and no other ends or begins.
    fn is_edge(&self, time_s: f64) -> bool {
        let is_here = |border_s: f64| (border_s - time_s).abs() < SAME_TIME_S;
        let touches = |block: &&HarmonicBlock| is_here(block.span.from_s) || is_here(block.span.to_s);
        self.blocks.iter().filter(touches).count() == 1
    }

    /// The speed at every step of the track, gaps left out: of the block around it and the one whose middle is where that ends, each
    /// counting for how near its own middle is.
    pub(crate) fn points_in(&self, span: Option<&Span>, order: Order) -> Vec<TrackPoint> {
        let step_s = self.step_s;
        let is_wanted = |block: &&HarmonicBlock| {
            block.is_heard && span.is_none_or(|span| block.span.overlap(*span).length_s() > 0.0)
        };
        let blocks: Vec<&HarmonicBlock> = self.blocks.iter().filter(is_wanted).collect();
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

    /// By how much some blocks and those between them differ where each counts for half: by noise, by a speed that bends, and by lines
    /// that do not keep their phase, of which no block knows. Root mean square.
    fn disagreement_rev_s(&self, blocks: &[&HarmonicBlock]) -> f64 {
        let quarters =
            |block: &HarmonicBlock| [0.25, 0.75].map(|share| block.span.from_s + share * block.span.length_s());
        let differences: Vec<f64> = blocks
            .iter()
            .flat_map(|block| quarters(block).map(|time_s| (block, time_s)))
            .filter_map(|(block, time_s)| Some(self.between_at(time_s)?.speed_at(time_s) - block.speed_at(time_s)))
            .collect();
        let squares: Vec<f64> = differences.iter().map(|difference| difference * difference).collect();
        mean(&squares).unwrap_or(0.0).sqrt()
    }

    fn between_at(&self, time_s: f64) -> Option<&HarmonicBlock> {
        let begun = self.between.partition_point(|block| block.span.from_s <= time_s);
        self.between[..begun].last().filter(|block| block.span.contains(time_s))
    }
}

/// What a block says of an instant.
#[derive(Clone, Copy)]
struct BlockAt {
    speed_rev_s: f64,
    std_uncertainty_rev_s: f64,
    /// 1 in the middle of the block, 0 at its ends.
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

    /// Both together. They hear the same sound, so that their errors may be the same.
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

/// Variance of the mean of several rotors' speed: how their loudness shifts it, which all frames share, and how it scatters.
fn variance_of_several(blocks: &[&HarmonicBlock]) -> f64 {
    let speeds: Vec<f64> = blocks.iter().map(|block| block.speed_rev_s).collect();
    let shifts: Vec<f64> = blocks.iter().map(|block| block.std_uncertainty_rev_s).collect();
    std_uncertainty_of_mean(&speeds).unwrap_or(0.0).powi(2) + mean(&shifts).unwrap_or(0.0).powi(2)
}

/// A block, or what a stretch of time holds of it.
struct Part<'a> {
    block: &'a HarmonicBlock,
    span: Span,
}

/// Turns over parts that are joined by phase.
fn turns_of(run: &[Part]) -> f64 {
    let within: f64 = run.iter().map(|part| part.block.speed_at(part.span.middle_s()) * part.span.length_s()).sum();
    within + steps_of(run).sum::<f64>()
}

fn steps_of(run: &[Part]) -> impl Iterator<Item = f64> {
    run.iter().take(run.len() - 1).filter_map(|part| part.block.step_to_next_turns)
}

/// Variance of the turns over parts that are joined by phase.
fn turns_variance(run: &[Part], is_edge: &impl Fn(f64) -> bool) -> f64 {
    let (Some(first), Some(last)) = (run.first(), run.last()) else { return 0.0 };
    if run.len() == 1 {
        // of a part of a block less is known than of all of it
        let longer = first.block.span.length_s() / first.span.length_s();
        return (first.block.std_uncertainty_rev_s * longer.powf(LENGTH_POWER) * first.span.length_s()).powi(2);
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

    /// The straight line that a block draws through a speed which bends: n = n₀ + c t².
    fn block(from_s: f64, to_s: f64, (start_rev_s, bend_rev_s3): (f64, f64)) -> HarmonicBlock {
        let (middle_s, length_s) = ((from_s + to_s) / 2.0, to_s - from_s);
        HarmonicBlock {
            span: Span { from_s, to_s },
            speed_rev_s: start_rev_s + bend_rev_s3 * (middle_s * middle_s + length_s * length_s / 12.0),
            slope_rev_s2: 2.0 * bend_rev_s3 * middle_s,
            std_uncertainty_rev_s: 1e-3,
            step_to_next_turns: None,
            is_several: false,
            level_db: -20.0,
            is_heard: true,
            is_steady: false,
        }
    }

    /// What a bend leaves at the ends of straight blocks, c T² / 6 at most, is halved by those in between.
    #[test]
    fn a_bend_is_followed_across_the_ends_of_blocks() {
        let bend = (60.0, 2.0);
        let at = |index: i32| 0.2 * f64::from(index);
        let track = HarmonicTrack {
            step_s: 0.002,
            blocks: (0..4).map(|index| block(at(index), at(index + 1), bend)).collect(),
            between: (0..3).map(|index| block(at(index) + 0.1, at(index + 1) + 0.1, bend)).collect(),
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
                .map(|point| (point.speed_rev_s - bend.0 - bend.1 * point.time_s * point.time_s).abs())
                .collect()
        };
        let worst = |errors: &[f64]| errors.iter().copied().fold(0.0, f64::max);
        let (with, without) = (errors(&track), errors(&alone));
        assert!(worst(&without) > 0.8 * 2.0 * 0.04 / 6.0);
        assert!(worst(&with) < 0.55 * worst(&without), "{} of {}", worst(&with), worst(&without));
    }
}
