//! Blocks of the harmonic likelihood → shaft speed over a stretch of time, and its track.

use super::{HarmonicSpeed, SpeedEstimate, TrackPoint};
use crate::harmonic::{HarmonicBlock, HarmonicTrack};
use crate::method::Method;
use crate::span::Span;
use crate::statistics::{mean, std, std_uncertainty_of_mean};
use hovertone_vehicle::{Order, RotorSpeed};

/// Uncertainty of the speed at the end of a block over that in its middle: a straight line through phases that scatter is
/// known four times as well in the middle.
const END_STDS: f64 = 4.0;
/// Steps from block to block that scatter this many standard deviations more than their uncertainties explain widen them.
const STEP_SCATTER_STDS: f64 = 3.0;

impl HarmonicTrack {
    /// Mean speed over a stretch of time: the blocks' own straight lines, each counted for the time that it covers. `None`
    /// where nothing is heard.
    ///
    /// - Uncertainty: from the curvature of each block's likelihood, which noise makes; widened where the phases within the
    ///   blocks, or the steps between them, scatter more than that explains.
    /// - The wander of the rotor itself is no uncertainty of its mean, as long as there are no gaps.
    pub(crate) fn speed_in(&self, span: Option<&Span>, order: Order) -> Option<SpeedEstimate> {
        let parts: Vec<(&HarmonicBlock, Span)> = self
            .blocks
            .iter()
            .filter(|block| block.is_heard)
            .map(|block| (block, span.map_or(block.span, |span| block.span.overlap(*span))))
            .filter(|(_, part)| part.length_s() > 0.0)
            .collect();
        let total_s: f64 = parts.iter().map(|(_, part)| part.length_s()).sum();
        if parts.is_empty() {
            return None;
        }
        let mean_rev_s: f64 =
            parts.iter().map(|(block, part)| block.speed_at(part.middle_s()) * part.length_s()).sum::<f64>() / total_s;
        let variance: f64 = parts
            .iter()
            .map(|(block, part)| {
                // of a part of a block less is known than of all of it
                let longer = block.span.length_s() / part.length_s();
                (block.std_uncertainty_rev_s * longer.powf(1.5) * part.length_s() / total_s).powi(2)
            })
            .sum();
        let blocks: Vec<&HarmonicBlock> = parts.iter().map(|(block, _)| *block).collect();
        let several: Vec<&HarmonicBlock> = blocks.iter().copied().filter(|block| block.is_several).collect();
        let variance = if several.is_empty() { variance } else { variance.max(variance_of_several(&several)) };
        let steps = steps_between(&blocks);
        let variance = (variance * step_scatter(&steps)).max(step_variance(&steps, blocks.len()));
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

    /// The speed at every step of the track, gaps left out.
    pub(crate) fn points_in(&self, span: Option<&Span>, order: Order) -> Vec<TrackPoint> {
        let step_s = self.step_s;
        self.blocks
            .iter()
            .filter(|block| block.is_heard)
            .flat_map(|block| {
                let count = (block.span.length_s() / step_s).round().max(1.0);
                (0..count as usize).map(move |index| {
                    let time_s = block.span.from_s + block.span.length_s() * (index as f64 + 0.5) / count;
                    let aside = 2.0 * (time_s - block.span.middle_s()) / block.span.length_s();
                    let speed_rev_s = block.speed_at(time_s);
                    TrackPoint {
                        time_s,
                        tone_hz: speed_rev_s * order.lines_per_turn(),
                        speed_rev_s,
                        std_uncertainty_rev_s: block.std_uncertainty_rev_s
                            * (1.0 + (END_STDS * END_STDS - 1.0) * aside * aside).sqrt(),
                        level_db: block.level_db,
                    }
                })
            })
            .filter(|point| span.is_none_or(|span| span.contains(point.time_s)))
            .collect()
    }
}

/// Variance of the mean of several rotors' speed: how their loudness shifts it, which all frames share, and how it scatters.
fn variance_of_several(blocks: &[&HarmonicBlock]) -> f64 {
    let speeds: Vec<f64> = blocks.iter().map(|block| block.speed_rev_s).collect();
    let shifts: Vec<f64> = blocks.iter().map(|block| block.std_uncertainty_rev_s).collect();
    std_uncertainty_of_mean(&speeds).unwrap_or(0.0).powi(2) + mean(&shifts).unwrap_or(0.0).powi(2)
}

/// How the speed steps from one block to the next, and the standard uncertainty of that step; gaps and several rotors left out.
fn steps_between(blocks: &[&HarmonicBlock]) -> Vec<(f64, f64)> {
    blocks
        .windows(2)
        .filter(|pair| !pair[0].is_several && !pair[1].is_several)
        .filter(|pair| (pair[1].span.from_s - pair[0].span.to_s).abs() < 1e-6)
        .map(|pair| {
            let border_s = pair[0].span.to_s;
            let step = pair[1].speed_at(border_s) - pair[0].speed_at(border_s);
            (step, END_STDS * pair[0].std_uncertainty_rev_s.hypot(pair[1].std_uncertainty_rev_s))
        })
        .collect()
}

/// Variance of the mean of so many blocks that the steps between them show: a speed that bends within a block is not its
/// straight line. Wide rather than narrow: each step counts in full.
fn step_variance(steps: &[(f64, f64)], blocks: usize) -> f64 {
    let squares: Vec<f64> = steps.iter().map(|(step, _)| step.powi(2)).collect();
    mean(&squares).map_or(0.0, |square| square / blocks as f64)
}

/// How much larger the steps are than the blocks' uncertainties explain, as a variance ratio; 1 where they explain them.
fn step_scatter(steps: &[(f64, f64)]) -> f64 {
    let ratios: Vec<f64> = steps.iter().map(|(step, std)| (step / std).powi(2)).collect();
    let limit = 1.0 + STEP_SCATTER_STDS * (2.0 / ratios.len() as f64).sqrt();
    mean(&ratios).filter(|&ratio| ratio > limit).unwrap_or(1.0)
}
