//! What the harmonic likelihood says of a hover: blocks of speed, and what each line contributed.

use crate::span::Span;

/// A line between the assumed ones is there above this likelihood; noise reaches it in one of ten thousand lines and blocks.
const BETWEEN_LIKELIHOOD_MIN: f64 = 16.0;
/// The speed over one block of sound.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HarmonicBlock {
    pub(crate) span: Span,
    /// Speed in the middle.
    pub(crate) speed_rev_s: f64,
    pub(crate) slope_rev_s2: f64,
    /// From the curvature of the likelihood.
    pub(crate) std_uncertainty_rev_s: f64,
    /// By how many turns the next block's line starts ahead of where this one ends, where phases say so.
    pub(crate) step_to_next_turns: Option<f64>,
    /// Whether several rotors sound, and the speed is their mean.
    pub(crate) is_several: bool,
    /// Level of the strongest line, dB re a full-scale sine.
    pub(crate) level_db: f64,
    /// Whether it stands out of the noise.
    pub(crate) is_heard: bool,
    /// Whether two lines keep their phase over a second or more, beyond what the search finds in noise.
    pub(crate) is_steady: bool,
}

impl HarmonicBlock {
    /// The part of it that lies in a stretch of time; less is known of it than of all of it.
    pub(super) fn within(&self, stretch: Span) -> Option<Self> {
        let span = self.span.overlap(stretch);
        let longer = self.span.length_s() / span.length_s();
        (span.length_s() > 0.0).then(|| Self {
            span,
            speed_rev_s: self.speed_at(span.middle_s()),
            std_uncertainty_rev_s: self.std_uncertainty_rev_s * longer.powf(1.5),
            ..*self
        })
    }

    /// Speed at a time.
    pub(crate) fn speed_at(&self, time_s: f64) -> f64 {
        self.speed_rev_s + self.slope_rev_s2 * (time_s - self.span.middle_s())
    }

    /// The same block, ending a little earlier.
    pub(super) fn until(&self, to_s: f64) -> Self {
        let span = Span { to_s, ..self.span };
        Self { span, speed_rev_s: self.speed_at(span.middle_s()), ..*self }
    }
}

/// What a line contributed over all quanta.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LineRecord {
    pub(crate) order: f64,
    pub(super) on_path: f64,
    /// Likelihood where lines keep their phase.
    pub(super) steady_likelihood: f64,
    pub(crate) quanta: u32,
    pub(crate) quanta_left_out: u32,
}

impl LineRecord {
    /// What the line counts for: order squared times power over noise.
    pub(crate) fn weight(&self) -> f64 {
        let heard = 1.0 - f64::from(self.quanta_left_out) / f64::from(self.quanta.max(1));
        heard * self.order.powi(2) * (self.on_path - f64::from(self.quanta)).max(0.0)
    }
}

/// The harmonic likelihood over a hover.
#[derive(Clone, Debug, Default)]
pub(crate) struct HarmonicTrack {
    /// Time between points of the track.
    pub(crate) step_s: f64,
    pub(crate) blocks: Vec<HarmonicBlock>,
    pub(crate) lines: Vec<LineRecord>,
}

impl HarmonicTrack {
    /// Share of a hover in which lines keep their phase.
    pub(crate) fn steady_share(&self, hover_s: f64) -> f64 {
        let steady_s: f64 = self.blocks.iter().filter(|block| block.is_steady).map(|block| block.span.length_s()).sum();
        steady_s / hover_s.max(f64::MIN_POSITIVE)
    }
}

impl HarmonicTrack {
    /// Lines that keep their phase at orders which are no multiple of `order`: those of a shaft that turns more slowly.
    pub(crate) fn lines_between(&self, order: f64) -> usize {
        let is_between = |line: &&LineRecord| (line.order / order).fract() != 0.0;
        self.lines
            .iter()
            .filter(is_between)
            .filter(|line| line.steady_likelihood > BETWEEN_LIKELIHOOD_MIN * f64::from(line.quanta.max(1)))
            .count()
    }
}
