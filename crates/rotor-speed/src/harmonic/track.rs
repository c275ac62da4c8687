//! What the harmonic likelihood says of a hover: blocks of speed, and what each line contributed.

use hovertone_analysis::Span;
use hovertone_signal::statistics::mean;

/// A line between the assumed ones is there above this likelihood; noise reaches it in one of ten thousand lines and blocks.
const BETWEEN_LIKELIHOOD_MIN: f64 = 16.0;
/// Lines between that have this share of the others' power belong to one series with them.
const SERIES_POWER_SHARE: f64 = 0.5;

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
    pub(crate) fn within(&self, stretch: Span) -> Option<Self> {
        let span = self.span.overlap(stretch);
        let longer = self.span.length_s() / span.length_s();
        (span.length_s() > 0.0).then(|| Self {
            span,
            speed_rev_s: self.speed_at(span.middle_s()),
            std_uncertainty_rev_s: self.std_uncertainty_rev_s * longer.powf(1.5),
            step_to_next_turns: self.step_to_next_turns.filter(|_| span.to_s == self.span.to_s),
            ..*self
        })
    }

    /// Speed at a time.
    pub(crate) fn speed_at(&self, time_s: f64) -> f64 {
        self.speed_rev_s + self.slope_rev_s2 * (time_s - self.span.middle_s())
    }

    /// The same block, ending a little earlier.
    pub(crate) fn until(&self, to_s: f64) -> Self {
        let span = Span { to_s, ..self.span };
        Self { span, speed_rev_s: self.speed_at(span.middle_s()), ..*self }
    }
}

/// What a line contributed over all quanta.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LineRecord {
    pub(crate) order: f64,
    pub(crate) on_path: f64,
    /// Likelihood where lines keep their phase.
    pub(crate) steady_likelihood: f64,
    pub(crate) quanta: u32,
    pub(crate) quanta_left_out: u32,
}

impl LineRecord {
    fn is_heard(&self) -> bool {
        self.steady_likelihood > BETWEEN_LIKELIHOOD_MIN * f64::from(self.quanta.max(1))
    }

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
    /// Blocks from the middle of one to the middle of the next, where the track leans on them.
    pub(crate) between: Vec<HarmonicBlock>,
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
    /// Lines that keep their phase at orders which are no multiple of `order`, where there is more than one: those of a shaft that
    /// turns more slowly.
    pub(crate) fn lines_between(&self, order: f64) -> Option<LinesBetween> {
        let is_between = |line: &&LineRecord| (line.order / order).fract() != 0.0;
        let reach = self.lines.iter().filter(is_between).map(|line| line.order).fold(0.0, f64::max);
        let heard: Vec<f64> =
            self.lines.iter().filter(is_between).filter(|line| line.is_heard()).map(|line| line.order).collect();
        let times_slower = (2..=5u32).find(|&times| {
            let parts = |line_order: f64| f64::from(times) * line_order / order;
            let is_part = |line_order: f64| (parts(line_order) - parts(line_order).round()).abs() < 1e-6;
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

/// Lines between those that a rotor can make.
pub(crate) struct LinesBetween {
    pub(crate) count: usize,
    /// How many times more slowly a shaft turns that makes all of them, if they are as strong as the others: the shaft lines of a
    /// rotor, which lie there too, are much weaker.
    pub(crate) times_slower: Option<u32>,
}
