//! The stretches of a recording that are used, and why the rest is not.

use crate::Span;
use serde::Serialize;
use std::fmt;
use std::ops::Range;

/// A stretch that was not used, and why.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Cut {
    /// When.
    #[serde(flatten)]
    pub span: Span,
    /// Why.
    #[serde(flatten)]
    pub reason: CutReason,
}

/// Why a stretch is not hover.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
#[serde(tag = "reason", rename_all = "snake_case")]
#[non_exhaustive]
pub enum CutReason {
    /// Much quieter than the hover.
    Silence,
    /// Much louder than the hover: handling, wind, speech at the microphone.
    HandlingNoise,
    /// The rotors run up.
    TakeOff,
    /// The rotors run down.
    Landing,
    /// The speed moves by clearly more than the hover's own wander: doublets, climbs, fast yaw.
    Manoeuvre,
    /// The rotors turn, but not at the hover's speed: idling, another load.
    OtherSpeed {
        /// Shaft speed that is heard there.
        speed_rev_s: f64,
    },
    /// No rotor is heard.
    NoTone,
    /// Between hover and not: the edge of a change.
    Edge,
    /// Steady, but too short to use.
    TooShort,
}

impl fmt::Display for CutReason {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Silence => f.write_str("silence"),
            Self::HandlingNoise => f.write_str("handling noise"),
            Self::OtherSpeed { speed_rev_s } => {
                write!(f, "another speed ({speed_rev_s:.1} rev/s)")
            }
            Self::TakeOff => f.write_str("take-off"),
            Self::Landing => f.write_str("landing"),
            Self::Manoeuvre => f.write_str("manoeuvre"),
            Self::NoTone => f.write_str("no rotor heard"),
            Self::Edge => f.write_str("edge of the hover"),
            Self::TooShort => f.write_str("too short to use"),
        }
    }
}

/// The steady stretches of a recording and what lies between them.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Hover {
    /// What is used.
    pub segments: Vec<Span>,
    /// What is not.
    pub cuts: Vec<Cut>,
}

impl Hover {
    /// All of a span, because the user says so.
    pub fn whole(span: Span) -> Self {
        Self { segments: vec![span], cuts: Vec::new() }
    }

    /// The later half of what is used, of its first so many seconds at most.
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

    /// What is used from a time on; before it the rotors run up.
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

    /// The stretches as ranges of seconds, as passes over the sound take them.
    pub fn spans_s(&self) -> Vec<Range<f64>> {
        self.segments.iter().map(|segment| segment.from_s..segment.to_s).collect()
    }

    /// How much is used.
    pub fn length_s(&self) -> f64 {
        self.segments.iter().map(Span::length_s).sum()
    }
}
