//! The result of the harmonic likelihood for a hover: blocks of speed, and the contribution of each line.

use hovertone_analysis::Span;
use hovertone_signal::statistics::mean;

/// Smallest likelihood of a line between the assumed ones, for each chunk; noise reaches it in one of ten thousand lines and blocks.
/// *Decision.*
const BETWEEN_LIKELIHOOD_MIN: f64 = 16.0;
/// Smallest power of the lines between, as a share of the power of the others, at which all form one series. *Decision.*
const SERIES_POWER_SHARE: f64 = 0.5;

/// Rounding error of the ratio of two orders: a ratio this close to a whole number is one. *Numeric.*
const ORDER_TOLERANCE: f64 = 1e-6;

/// The uncertainty of a mean speed falls with the length of a block to this power (Rife and Boorstyn 1974). *Physics.*
pub(crate) const LENGTH_POWER: f64 = 1.5;

/// The speed in one block of sound.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HarmonicBlock {
    pub(crate) span: Span,
    /// Speed in the middle of the block.
    pub(crate) speed_rev_s: f64,
    /// Rate of change of the speed.
    pub(crate) slope_rev_s2: f64,
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

    /// The same block with an earlier end.
    pub(crate) fn until(&self, to_s: f64) -> Self {
        let span = Span { to_s, ..self.span };
        Self { span, speed_rev_s: self.speed_at(span.middle_s()), ..*self }
    }
}

/// Smallest mean power of a line on the path, over the power of noise, at which it is heard. *Decision.*
const HEARD_POWER_MIN: f64 = 3.0;

/// The contribution of a line over all chunks.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LineRecord {
    pub(crate) order: f64,
    /// Sum over the chunks of the mean power on the path, over the power of noise.
    pub(crate) on_path: f64,
    /// Likelihood in the chunks whose speed is steady.
    pub(crate) steady_likelihood: f64,
    /// Number of chunks.
    pub(crate) chunks: u32,
    /// Chunks in which the line was not used, because of a foreign sound in its band.
    pub(crate) chunks_left_out: u32,
}

impl LineRecord {
    /// Whether the line keeps its phase.
    fn is_heard(&self) -> bool {
        self.steady_likelihood > BETWEEN_LIKELIHOOD_MIN * f64::from(self.chunks.max(1))
    }

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
}

impl HarmonicTrack {
    /// The blocks that overlap a span of time, or all blocks without one.
    pub(crate) fn blocks_in(&self, span: Option<&Span>) -> &[HarmonicBlock] {
        let Some(span) = span else { return &self.blocks };
        let from = self.blocks.partition_point(|block| block.span.to_s <= span.from_s);
        let to = self.blocks.partition_point(|block| block.span.from_s < span.to_s);
        self.blocks.get(from..to).unwrap_or_default()
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

    /// Whether the line of this order, or one of its harmonics, stands out of the noise along the path.
    pub(crate) fn hears_line(&self, order: f64) -> bool {
        let is_harmonic = |line: &&LineRecord| (line.order / order).fract() < ORDER_TOLERANCE;
        let mut harmonics = self.lines.iter().filter(is_harmonic);
        harmonics.any(|line| line.on_path >= HEARD_POWER_MIN * f64::from(line.chunks.max(1)))
    }

    /// Share of a hover of length `hover_s` in which lines keep their phase.
    pub(crate) fn steady_share(&self, hover_s: f64) -> f64 {
        let steady_s: f64 = self.blocks.iter().filter(|block| block.is_steady).map(|block| block.span.length_s()).sum();
        steady_s / hover_s.max(f64::MIN_POSITIVE)
    }

    /// Lines that keep their phase at orders that are no multiples of `order`: they belong to a slower shaft. `None` for fewer than two
    /// lines.
    pub(crate) fn lines_between(&self, order: f64) -> Option<LinesBetween> {
        let is_between = |line: &&LineRecord| (line.order / order).fract() != 0.0;
        let reach = self.lines.iter().filter(is_between).map(|line| line.order).fold(0.0, f64::max);
        let heard: Vec<f64> =
            self.lines.iter().filter(is_between).filter(|line| line.is_heard()).map(|line| line.order).collect();
        let times_slower = (2..=5u32).find(|&times| {
            let parts = |line_order: f64| f64::from(times) * line_order / order;
            let is_part = |line_order: f64| (parts(line_order) - parts(line_order).round()).abs() < ORDER_TOLERANCE;
            let mean_of = |is_own: bool| {
                let of_kind =
                    |line: &&LineRecord| is_between(line) != is_own && line.order <= reach && is_part(line.order);
                mean(&self.lines.iter().filter(of_kind).map(|line| line.steady_likelihood).collect::<Vec<f64>>())
            };
            let is_one_series =
                || mean_of(false).zip(mean_of(true)).is_some_and(|(b, own)| b > SERIES_POWER_SHARE * own);
            heard.iter().all(|&line_order| is_part(line_order)) && is_one_series()
        });
        (heard.len() > 1).then_some(LinesBetween { count: heard.len(), times_slower })
    }
}

/// Lines between the lines that the assumed rotor makes.
pub(crate) struct LinesBetween {
    /// Number of lines.
    pub(crate) count: usize,
    /// Ratio of the assumed speed to the speed of a shaft that makes all lines, where the lines between are as strong as the others. The
    /// shaft lines of the assumed rotor have these orders too, but are much weaker.
    pub(crate) times_slower: Option<u32>,
}
