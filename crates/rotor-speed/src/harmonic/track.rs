//! The result of the harmonic likelihood for a hover: blocks of speed, and the contribution of each line.

use hovertone_analysis::Span;

/// Rounding error of the times at which blocks or rows meet, s. *Numeric.*
pub(crate) const SAME_TIME_S: f64 = 1e-6;

/// Largest number of blocks of a track: half a hop each, they last for 11 minutes. *Numeric.*
const BLOCKS_MAX: usize = 1 << 14;

/// The uncertainty of a mean speed falls with the length of a block to this power (Rife and Boorstyn 1974). *Physics.*
const LENGTH_POWER: f64 = 1.5;

/// The speed in one block of sound.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HarmonicBlock {
    pub(crate) span: Span,
    /// Speed in the middle of the block.
    pub(crate) speed_rev_s: f64,
    /// Rate of change of the speed.
    pub(crate) slope_rev_s2: f64,
    /// Variance of the speed about this line, where the block was merged of shorter ones.
    pub(crate) variance_rev2_s2: f64,
    /// Standard uncertainty, from the curvature of the likelihood.
    pub(crate) std_uncertainty_rev_s: f64,
    /// Angle in turns from the end of this block's line of speed to the start of the next block's, where the phases determine it.
    pub(crate) step_to_next_turns: Option<f64>,
    /// Whether several rotors sound and the speed is their mean.
    pub(crate) is_several: bool,
    /// Level of the strongest line, dB re a sine of full scale.
    pub(crate) level_db: f64,
    /// Whether the block stands out of the noise.
    pub(crate) is_heard: bool,
    /// Whether several lines keep their phase over a second or more, with a likelihood that a search does not find in noise.
    pub(crate) is_steady: bool,
}

impl HarmonicBlock {
    /// The part of the block in a span of time, with the larger uncertainty of the shorter part. `None` outside the block.
    pub(crate) fn within(&self, part: Span) -> Option<Self> {
        let span = self.span.overlap(part);
        let longer = self.span.length_s() / span.length_s();
        (span.length_s() > 0.0).then(|| Self {
            span,
            speed_rev_s: self.speed_at(span.middle_s()),
            std_uncertainty_rev_s: self.std_uncertainty_rev_s * longer.powf(LENGTH_POWER),
            step_to_next_turns: self.step_to_next_turns.filter(|_| span.to_s == self.span.to_s),
            ..*self
        })
    }

    /// Speed at a time on the recording's clock.
    pub(crate) fn speed_at(&self, time_s: f64) -> f64 {
        self.speed_rev_s + self.slope_rev_s2 * (time_s - self.span.middle_s())
    }

    /// Whether the next block begins where this one ends, and shows as many rotors.
    fn meets(&self, next: &Self) -> bool {
        let is_alike = (self.is_heard, self.is_several) == (next.is_heard, next.is_several);
        is_alike && (next.span.from_s - self.span.to_s).abs() < SAME_TIME_S
    }

    /// This block and the next one as one block: the straight line closest to both. Their turns remain, and so does their variance, as that of
    /// blocks that are not joined by phase. `None` where they do not meet.
    fn merged(&self, next: &Self) -> Option<Self> {
        let span = Span { from_s: self.span.from_s, to_s: next.span.to_s };
        let length_s = span.length_s();
        let both = [self, next];
        let turns_of = |block: &Self| block.speed_rev_s * block.span.length_s();
        // ∫ n τ dτ, where τ is the time from the middle of both
        let moment = |block: &Self| {
            let away_s = block.span.middle_s() - span.middle_s();
            away_s * turns_of(block) + block.slope_rev_s2 * block.span.length_s().powi(3) / 12.0
        };
        let std_turns = both.map(|block| block.std_uncertainty_rev_s * block.span.length_s());
        let line = Self {
            span,
            speed_rev_s: both.map(turns_of).iter().sum::<f64>() / length_s,
            slope_rev_s2: 12.0 * both.map(moment).iter().sum::<f64>() / length_s.powi(3),
            variance_rev2_s2: 0.0,
            ..*next
        };
        let mean_square = both.map(|block| block.mean_square_in(block.span) * block.span.length_s() / length_s);
        self.meets(next).then(|| Self {
            speed_rev_s: line.speed_rev_s + self.step_to_next_turns.unwrap_or(0.0) / length_s,
            variance_rev2_s2: (mean_square[0] + mean_square[1] - line.mean_square_in(span)).max(0.0),
            std_uncertainty_rev_s: std_turns[0].hypot(std_turns[1]) / length_s,
            level_db: self.level_db.max(next.level_db),
            is_steady: self.is_steady && next.is_steady,
            ..line
        })
    }

    /// A block from the middle of this one to the middle of the next, along the line through the speeds there. `None` where they do not meet.
    fn between(&self, next: &Self) -> Option<Self> {
        let span = Span { from_s: self.span.middle_s(), to_s: next.span.middle_s() };
        self.meets(next).then(|| Self {
            span,
            speed_rev_s: (self.speed_rev_s + next.speed_rev_s) / 2.0,
            slope_rev_s2: (next.speed_rev_s - self.speed_rev_s) / span.length_s(),
            std_uncertainty_rev_s: (self.std_uncertainty_rev_s + next.std_uncertainty_rev_s) / 2.0,
            step_to_next_turns: None,
            ..*next
        })
    }

    /// Mean square of the speed in a part of the block, (rev/s)². Over a time T with a straight line of speed, it is `n² + γ² T² / 12`.
    pub(crate) fn mean_square_in(&self, part: Span) -> f64 {
        let of_line = self.speed_at(part.middle_s()).powi(2) + (self.slope_rev_s2 * part.length_s()).powi(2) / 12.0;
        of_line + self.variance_rev2_s2
    }

    /// The same block with an earlier end.
    pub(crate) fn until(&self, to_s: f64) -> Self {
        let span = Span { to_s, ..self.span };
        Self { span, speed_rev_s: self.speed_at(span.middle_s()), ..*self }
    }
}

/// The contribution of a line over all chunks.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LineRecord {
    pub(crate) order: f64,
    /// Sum over the chunks of the mean power on the path, over the power of noise.
    pub(crate) on_path: f64,
    /// Number of chunks.
    pub(crate) chunks: u32,
    /// Chunks in which the line was not used, because of a foreign sound in its band.
    pub(crate) chunks_left_out: u32,
}

impl LineRecord {
    /// Weight of the line in the speed: order squared times power over noise.
    pub(crate) fn weight(&self) -> f64 {
        let heard = 1.0 - f64::from(self.chunks_left_out) / f64::from(self.chunks.max(1));
        heard * self.order.powi(2) * (self.on_path - f64::from(self.chunks)).max(0.0)
    }
}

/// The speed along a hover by harmonic likelihood.
#[derive(Clone, Debug, Default)]
pub(crate) struct HarmonicTrack {
    /// Time between points of the track.
    pub(crate) step_s: f64,
    /// Blocks in order of time.
    pub(crate) blocks: Vec<HarmonicBlock>,
    /// Blocks from the middle of each block to the middle of the next: they support the track where two blocks meet.
    pub(crate) between: Vec<HarmonicBlock>,
    /// The contribution of each line.
    pub(crate) lines: Vec<LineRecord>,
    /// Whether blocks were merged.
    pub(crate) is_limited: bool,
}

impl HarmonicTrack {
    /// The blocks that overlap a span of time, or all blocks without one.
    pub(crate) fn blocks_in(&self, span: Option<&Span>) -> &[HarmonicBlock] {
        let Some(span) = span else { return &self.blocks };
        let from = self.blocks.partition_point(|block| block.span.to_s <= span.from_s);
        let to = self.blocks.partition_point(|block| block.span.from_s < span.to_s);
        self.blocks.get(from..to).unwrap_or_default()
    }

    /// Merges neighbours where there are more blocks than a track may have, so that memory does not grow with the length of the recording.
    pub(crate) fn limit_blocks(&mut self) {
        if self.blocks.len() <= BLOCKS_MAX {
            return;
        }
        self.is_limited = true;
        self.merge_up_to(self.step_s);
        let ends_s =
            self.blocks.first().zip(self.blocks.last()).map(|(first, last)| last.span.to_s - first.span.from_s);
        while self.blocks.len() > BLOCKS_MAX / 2 && ends_s.is_some_and(|ends_s| self.step_s < ends_s) {
            self.step_s *= 2.0;
            self.merge_up_to(self.step_s);
        }
    }

    /// The track at the end of the recording: where blocks were merged, the last ones as well, so that all parts count alike.
    pub(crate) fn finished(mut self) -> Self {
        if self.is_limited {
            self.merge_up_to(self.step_s);
        }
        self
    }

    /// Merges neighbours to blocks of up to this length.
    fn merge_up_to(&mut self, length_s_max: f64) {
        let mut merged: Vec<HarmonicBlock> = Vec::with_capacity(self.blocks.len());
        for block in &self.blocks {
            let longer = merged.last().and_then(|last| last.merged(block));
            let longer = longer.filter(|longer| longer.span.length_s() <= length_s_max + SAME_TIME_S);
            match merged.last_mut().zip(longer) {
                Some((last, longer)) => *last = longer,
                None => merged.push(*block),
            }
        }
        merged.shrink_to_fit();
        let pairs = merged.windows(2).filter_map(|pair| pair[0].between(&pair[1]));
        self.between = pairs.filter(|block| block.is_heard).collect();
        self.blocks = merged;
    }

    /// The speed at each of these times; between the blocks that of the nearest one. `None` where no block is heard.
    pub(crate) fn speeds_at(&self, times_s: &[f64]) -> Option<Vec<f64>> {
        let heard: Vec<&HarmonicBlock> = self.blocks.iter().filter(|block| block.is_heard).collect();
        let distance_s =
            |block: &HarmonicBlock, time_s: f64| (time_s - time_s.clamp(block.span.from_s, block.span.to_s)).abs();
        let speed_at = |&time_s: &f64| {
            let after = heard.partition_point(|block| block.span.to_s < time_s);
            let near = heard[after.saturating_sub(1)..].iter().take(2);
            let nearest = near.min_by(|a, b| distance_s(a, time_s).total_cmp(&distance_s(b, time_s)))?;
            Some(nearest.speed_at(time_s.clamp(nearest.span.from_s, nearest.span.to_s)))
        };
        times_s.iter().map(speed_at).collect()
    }

    /// Share of a hover of length `hover_s` in which lines keep their phase.
    pub(crate) fn steady_share(&self, hover_s: f64) -> f64 {
        let steady_s: f64 = self.blocks.iter().filter(|block| block.is_steady).map(|block| block.span.length_s()).sum();
        steady_s / hover_s.max(f64::MIN_POSITIVE)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone_vehicle::Order;

    /// Blocks of half a hop along a speed that swings by 2 % once in 7 s.
    fn track(blocks: usize) -> HarmonicTrack {
        let (step_s, rate) = (0.04, std::f64::consts::TAU / 7.0);
        let block = |index: usize| {
            let span = Span { from_s: step_s * index as f64, to_s: step_s * (index + 1) as f64 };
            HarmonicBlock {
                span,
                speed_rev_s: 60.0 + 1.2 * (rate * span.middle_s()).sin(),
                slope_rev_s2: 1.2 * rate * (rate * span.middle_s()).cos(),
                variance_rev2_s2: 0.0,
                std_uncertainty_rev_s: 0.1 + 0.05 * (index % 3) as f64,
                step_to_next_turns: None,
                level_db: -20.0,
                is_several: false,
                is_heard: true,
                is_steady: false,
            }
        };
        HarmonicTrack { step_s, blocks: (0..blocks).map(block).collect(), ..HarmonicTrack::default() }
    }

    #[test]
    fn a_long_recording_has_longer_blocks_and_the_same_speed() {
        // an hour and a half, less than what is a whole number of blocks
        let whole = track(7 * BLOCKS_MAX + 5);
        let mut limited = HarmonicTrack { blocks: Vec::new(), ..whole.clone() };
        for chunk in whole.blocks.chunks(250) {
            limited.blocks.extend_from_slice(chunk);
            limited.limit_blocks();
            assert!(limited.blocks.len() <= BLOCKS_MAX && limited.between.len() <= BLOCKS_MAX);
        }
        let limited = limited.finished();
        assert!(limited.blocks.len() > BLOCKS_MAX / 4 && limited.step_s == 16.0 * whole.step_s, "{}", limited.step_s);
        assert!(limited.blocks.iter().all(|block| block.span.length_s() < 0.65));
        let order = Order::new(2.0).unwrap();
        let minute = Span { from_s: 600.0, to_s: 660.0 };
        for span in [None, Some(&minute)] {
            let (want, got) = (whole.speed_in(span, order).unwrap(), limited.speed_in(span, order).unwrap());
            assert!((got.speed.rev_s() - want.speed.rev_s()).abs() < 1e-3, "{:?} {:?}", got.speed, want.speed);
            let ratio = got.std_uncertainty_rev_s.unwrap() / want.std_uncertainty_rev_s.unwrap();
            // a part of a block is less certain than its share of the block: one at each end of the minute
            assert!((ratio - 1.0).abs() < if span.is_some() { 0.05 } else { 0.01 }, "{ratio}");
            // the mean over 0.64 s of a swing of 7 s is (π 0.64 / 7)² / 6 smaller than its middle: 1.4 %
            let ratio = got.spread_rev_s.unwrap() / want.spread_rev_s.unwrap();
            assert!((ratio - 1.0).abs() < 0.02, "{ratio}");
            let squares = [&whole, &limited].map(|track| track.mean_square_rad2_s2(span).unwrap());
            assert!((squares[1] / squares[0] - 1.0).abs() < 2e-6, "{squares:?}");
        }
        // the track follows the speed, also where blocks meet
        for point in limited.points_in(None, order) {
            let want = 60.0 + 1.2 * (std::f64::consts::TAU / 7.0 * point.time_s).sin();
            assert!((point.speed_rev_s - want).abs() < 0.03, "{point:?}");
        }
    }

    #[test]
    fn steps_between_merged_blocks_count_as_turns_and_not_as_speed() {
        let mut whole = track(3 * BLOCKS_MAX);
        for (block, step) in whole.blocks.iter_mut().zip([1e-3, 1e-3, -2e-3].into_iter().cycle()) {
            block.step_to_next_turns = Some(step);
        }
        let mut limited = whole.clone();
        limited.limit_blocks();
        let order = Order::new(2.0).unwrap();
        let speeds = [&whole, &limited].map(|track| track.speed_in(None, order).unwrap().speed.rev_s());
        assert!((speeds[0] - speeds[1]).abs() < 1e-6, "{speeds:?}");
        // steps that count as positive alone would change it by 1e-4
        let squares = [&whole, &limited].map(|track| track.mean_square_rad2_s2(None).unwrap());
        assert!((squares[1] / squares[0] - 1.0).abs() < 1e-5, "{squares:?}");
    }

    #[test]
    fn blocks_with_a_gap_between_them_stay_apart() {
        let mut gaps = track(2 * BLOCKS_MAX);
        gaps.blocks.retain(|block| (block.span.from_s / 0.04).round() as usize % 4 != 3);
        let spans_s: f64 = gaps.blocks.iter().map(|block| block.span.length_s()).sum();
        let times_s = [0.02, 0.13, 0.15, 600.0];
        let before = gaps.speeds_at(&times_s).unwrap();
        gaps.limit_blocks();
        assert!((gaps.blocks.iter().map(|block| block.span.length_s()).sum::<f64>() - spans_s).abs() < 1e-6);
        for (before, after) in before.iter().zip(gaps.speeds_at(&times_s).unwrap()) {
            assert!((before - after).abs() < 0.02, "{before} {after}");
        }
        let turns = |blocks: &[HarmonicBlock]| blocks.iter().map(|b| b.speed_rev_s * b.span.length_s()).sum::<f64>();
        assert!((turns(&gaps.blocks) / turns(&track(2 * BLOCKS_MAX).blocks) - 0.75).abs() < 1e-3);
        assert!(gaps.blocks_in(Some(&Span { from_s: 0.125, to_s: 0.155 })).is_empty());
    }
}
