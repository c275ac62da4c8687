//! The used stretches of a recording, and the reasons for the cuts between them.

use crate::Span;
use serde::Serialize;
use std::fmt;
use std::ops::Range;

/// A stretch that is not used.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Cut {
    /// Stretch of time.
    #[serde(flatten)]
    pub span: Span,
    /// Reason for the cut.
    #[serde(flatten)]
    pub reason: CutReason,
}

/// Reason why a stretch is not hover.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "reason", rename_all = "snake_case")]
#[non_exhaustive]
pub enum CutReason {
    /// Much quieter than the hover.
    Silence,
    /// Much louder than the hover: handling, wind, speech at the microphone.
    HandlingNoise,
    /// The rotors speed up.
    TakeOff,
    /// The rotors slow down.
    Landing,
    /// The speed changes by much more than its usual wander in this hover: doublets, climbs, fast yaw.
    Manoeuvre,
    /// The rotors turn at another speed than in the hover: idling, another load.
    OtherSpeed {
        /// Shaft speed in this stretch.
        speed_rev_s: f64,
    },
    /// No rotor is heard.
    NoTone,
    /// The transition between hover and another stretch.
    Edge,
    /// Steady, but too short to use.
    TooShort,
}

impl CutReason {
    /// The reason in words, without its numbers.
    pub fn words(self) -> &'static str {
        match self {
            Self::Silence => "silence",
            Self::HandlingNoise => "handling noise",
            Self::OtherSpeed { .. } => "another speed",
            Self::TakeOff => "take-off",
            Self::Landing => "landing",
            Self::Manoeuvre => "manoeuvre",
            Self::NoTone => "no steady rotor",
            Self::Edge => "transition to or from the hover",
            Self::TooShort => "steady, but too short for a hover",
        }
    }
}

impl fmt::Display for CutReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.words())?;
        match self {
            Self::OtherSpeed { speed_rev_s } => write!(f, " ({speed_rev_s:.1} rev/s)"),
            _ => Ok(()),
        }
    }
}

/// The steady stretches of a recording and the cuts between them.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Hover {
    /// Used stretches.
    pub segments: Vec<Span>,
    /// Stretches that are not used.
    pub cuts: Vec<Cut>,
}

impl Hover {
    /// A hover over a whole span, chosen by the user.
    pub fn whole(span: Span) -> Self {
        Self { segments: vec![span], cuts: Vec::new() }
    }

    /// Time from the start of the first stretch to the end of the last, used or not. `None` without stretches.
    pub fn span_s(&self) -> Option<f64> {
        let spans = || self.segments.iter().chain(self.cuts.iter().map(|cut| &cut.span));
        let from_s = spans().map(|span| span.from_s).fold(f64::INFINITY, f64::min);
        let to_s = spans().map(|span| span.to_s).fold(f64::NEG_INFINITY, f64::max);
        (to_s > from_s).then_some(to_s - from_s)
    }

    /// The later half of the used time; of more than `length_s_max` only that much from the start counts.
    pub fn later_half(&self, length_s_max: f64) -> Self {
        let length_s = self.length_s().min(length_s_max);
        let (mut segments, mut passed_s) = (Vec::new(), 0.0);
        for segment in &self.segments {
            let at_s = |share: f64| segment.from_s + (share * length_s - passed_s).clamp(0.0, segment.length_s());
            let later = Span { from_s: at_s(0.5), to_s: at_s(1.0) };
            passed_s += segment.length_s();
            if later.length_s() > 0.0 {
                segments.push(later);
            }
        }
        Self { segments, cuts: Vec::new() }
    }

    /// The hover without the time before `time_s`, which becomes a cut for the take-off.
    pub fn after_take_off(self, time_s: f64) -> Self {
        let Self { segments, mut cuts } = self;
        let mut kept = Vec::new();
        for segment in segments {
            let before = Span { to_s: segment.to_s.min(time_s), ..segment };
            if before.length_s() > 0.0 {
                cuts.push(Cut { span: before, reason: CutReason::TakeOff });
            }
            let after = Span { from_s: segment.from_s.max(time_s), ..segment };
            if after.length_s() > 0.0 {
                kept.push(after);
            }
        }
        cuts.sort_by(|a, b| a.span.from_s.total_cmp(&b.span.from_s));
        Self { segments: kept, cuts }
    }

    /// The stretches as ranges of seconds, the input of passes over the sound.
    pub fn spans_s(&self) -> Vec<Range<f64>> {
        self.segments.iter().map(|segment| segment.from_s..segment.to_s).collect()
    }

    /// Total used time.
    pub fn length_s(&self) -> f64 {
        self.segments.iter().map(Span::length_s).sum()
    }
}
