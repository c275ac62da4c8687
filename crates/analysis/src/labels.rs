//! What is known of which rotor is which, and why not more.

use serde::Serialize;
use std::fmt;

/// Most rotors that can be labelled: the number of assignments grows with the factorial. *Decision.*
pub const LABELLED_ROTORS_MAX: usize = 6;

/// Where labels come from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum LabelSource {
    /// Speeds of the motors in a log.
    MotorSpeeds,
    /// Commands or PWM of the motors in a log.
    MotorCommands,
    /// Rates at which the body turns, in a log.
    BodyRates,
    /// Levels and delays at several microphones whose places are known.
    Microphones,
    /// The order in which the motors were started.
    SpinUp,
}

impl LabelSource {
    /// For people.
    pub fn words(self) -> &'static str {
        match self {
            Self::MotorSpeeds => "the speeds of the motors",
            Self::MotorCommands => "the commands of the motors",
            Self::BodyRates => "the body's rates",
            Self::Microphones => "levels and delays at the microphones",
            Self::SpinUp => "the order in which the motors were started",
        }
    }
}

/// Which rotor a track is.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RotorLabel {
    /// Number of the motor or place, counted from 1, in the order of the log's motors or of the frame's places.
    pub number: usize,
    /// Its name: "motor 3", "front left".
    pub name: String,
    /// How probable it is that the track is this rotor's.
    pub probability: f64,
}

/// Which rotors the tracks are.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RotorLabels {
    /// What tells it.
    pub source: LabelSource,
    /// What is to be added to the log's times to have the recording's; absent where nothing is told.
    pub offset_s: Option<f64>,
    /// Its standard uncertainty.
    pub offset_std_s: Option<f64>,
    /// Probability of the most probable assignment of all tracks; the rest is for the others, and for the log, or the positions,
    /// having nothing to do with the tracks.
    pub probability: Option<f64>,
    /// For each track, in their order; absent where it is not told.
    pub rotors: Vec<Option<RotorLabel>>,
    /// Why some are not told.
    pub not_told: Option<NotTold>,
}

/// Why labels are not told.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
#[non_exhaustive]
pub enum NotTold {
    /// The log knows another number of rotors.
    OtherCount {
        /// Rotors that turn.
        rotors: usize,
        /// Rotors of the log.
        of_log: usize,
    },
    /// Too many to weigh every assignment.
    TooManyRotors {
        /// Rotors that turn.
        rotors: usize,
    },
    /// Not enough rotors are told apart.
    TooFewTracks {
        /// Those that are.
        tracks: usize,
        /// Those that are needed.
        needed: usize,
    },
    /// More offsets than can be tried.
    TooManyOffsets {
        /// The smallest.
        low_s: f64,
        /// The largest.
        high_s: f64,
    },
    /// Log and hover share too little time.
    NoOverlap,
    /// Nothing in the log moves with the tracks.
    NothingInCommon {
        /// Probability that it has to do with them at all.
        probability: f64,
    },
    /// The best offset is the smallest or largest that was tried.
    OffsetAtLimit {
        /// Where.
        offset_s: f64,
    },
    /// Rotors begin at one time, or nearly.
    StartedTogether {
        /// The shortest time between two.
        apart_s: f64,
    },
    /// From the hover back to where they begin some rotors are not heard all the time, or at speeds that jump.
    NotFollowed {
        /// How many.
        tracks: usize,
    },
    /// Before it turns as in the hover, a rotor turns at another speed.
    OtherSpeedBefore {
        /// Which.
        speed_rev_s: f64,
    },
    /// Rotors whose speeds are too close to each other for short frames.
    RotorsTooClose {
        /// How close.
        apart_rev_s: f64,
    },
    /// The hover begins too late.
    SpinUpTooLong {
        /// How long after the recording.
        before_hover_s: f64,
    },
    /// Several assignments fit.
    SeveralFit {
        /// Tracks that have no label.
        tracks: usize,
    },
    /// The recording has another number of channels than there are microphones.
    OtherChannels {
        /// Channels.
        channels: usize,
        /// Microphones.
        microphones: usize,
    },
    /// No rotors, or more than there are places for.
    OtherPlaces {
        /// Rotors that are told apart.
        tracks: usize,
        /// Places of rotors.
        places: usize,
    },
    /// A microphone hears no line of any rotor for long enough.
    NothingHeard {
        /// Which, counted from 1.
        microphone: usize,
    },
    /// Levels and delays are not those of rotors and microphones at these places.
    OtherArray {
        /// Probability that they are.
        probability: f64,
    },
    /// Several assignments fit levels and delays.
    SeveralPlacesFit {
        /// Tracks that have no label.
        tracks: usize,
    },
}

impl NotTold {
    /// What to do about it.
    pub fn hint(&self) -> &'static str {
        match self {
            Self::OtherCount { .. } => "say how many rotors turn with --rotors, and give the log of the same flight",
            Self::TooManyRotors { .. } => "they keep their numbers by speed",
            Self::TooFewTracks { .. } => "a nearer microphone and higher harmonics tell more rotors apart",
            Self::TooManyOffsets { .. } => "narrow them with --log-offset-s LOW:HIGH",
            Self::NoOverlap => {
                "give the log of the same flight, and limits with --log-offset-s LOW:HIGH that hold its offset"
            }
            Self::NothingInCommon { .. } => {
                "check that the log is of the same flight, that --log-offset-s holds its offset, and how its axes point"
            }
            Self::OffsetAtLimit { .. } => "widen --log-offset-s LOW:HIGH",
            Self::StartedTogether { .. } => "start one motor after the other, a second or more apart",
            Self::NotFollowed { .. } => {
                "bring each motor straight to the speed of the hover, wait a second before the next, and record from before the first"
            }
            Self::OtherSpeedBefore { .. } => {
                "bring each motor straight to the speed of the hover: idling is not followed"
            }
            Self::RotorsTooClose { .. } => "give a log of the flight with --log",
            Self::SpinUpTooLong { .. } => "cut the recording to the start of the motors and the hover, with --from",
            Self::SeveralFit { .. } => {
                "a longer hover, or one with small rolls and pitches in it, tells rotors apart that move alike"
            }
            Self::OtherChannels { .. } => {
                "give the position of each channel's microphone, in the order of the channels"
            }
            Self::OtherPlaces { .. } => "say where every rotor stands",
            Self::NothingHeard { .. } => "check that the channel is not silent; a longer hover shows fainter lines",
            Self::OtherArray { .. } => {
                "check positions, their order and their axes (x forward, y left, z up), and how well they are known (position_std_m)"
            }
            Self::SeveralPlacesFit { .. } => {
                "microphones nearer to the rotors and off the vehicle's planes of symmetry, more of them, or positions that are better \
                 known (position_std_m) tell more"
            }
        }
    }
}

impl fmt::Display for NotTold {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OtherCount { rotors, of_log } => write!(f, "{rotors} rotors turn, and the log is of {of_log}"),
            Self::TooManyRotors { rotors } => {
                write!(f, "{rotors} rotors have too many assignments; up to {} can be told", LABELLED_ROTORS_MAX)
            }
            Self::TooFewTracks { tracks, needed } => {
                write!(f, "{tracks} rotors are told apart by their sound, and {needed} are needed")
            }
            Self::TooManyOffsets { low_s, high_s } => {
                write!(f, "the log could be anywhere from {low_s:.0} to {high_s:.0} s off the recording")
            }
            Self::NoOverlap => f.write_str("the log and the hover share too little time"),
            Self::NothingInCommon { probability } => {
                write!(f, "nothing in the log moves with the rotors' speeds (probability {probability:.2})")
            }
            Self::OffsetAtLimit { offset_s } => {
                write!(f, "the log fits best at an offset of {offset_s:.2} s, the limit of what was tried")
            }
            Self::StartedTogether { apart_s } => {
                write!(f, "two rotors begin within {:.1} s of each other", apart_s.max(0.1))
            }
            Self::NotFollowed { tracks } => {
                write!(f, "{tracks} of the rotors cannot be followed from the hover back to where they begin")
            }
            Self::OtherSpeedBefore { speed_rev_s } => {
                write!(f, "before a rotor is heard as in the hover something turns at {speed_rev_s:.1} rev/s")
            }
            Self::RotorsTooClose { apart_rev_s } => {
                write!(f, "two rotors turn within {apart_rev_s:.2} rev/s of each other, too close to hear each begin")
            }
            Self::SpinUpTooLong { before_hover_s } => {
                write!(f, "the hover begins {before_hover_s:.0} s after the recording, too long to be followed")
            }
            Self::SeveralFit { tracks } => write!(f, "for {tracks} of the rotors several labels fit the log"),
            Self::OtherChannels { channels, microphones } => {
                write!(f, "the recording has {channels} channels, and {microphones} microphones have a position")
            }
            Self::OtherPlaces { tracks, places } => {
                write!(f, "{tracks} rotors are told apart by their sound, and {places} have a place")
            }
            Self::NothingHeard { microphone } => {
                write!(f, "microphone {microphone} hears no line of the rotors for long enough")
            }
            Self::OtherArray { probability } => {
                write!(f, "levels and delays do not fit these positions (probability {probability:.2})")
            }
            Self::SeveralPlacesFit { tracks } => {
                write!(f, "for {tracks} of the rotors levels and delays fit several places")
            }
        }
    }
}

impl RotorLabels {
    /// No label at all.
    pub fn not_told(source: LabelSource, tracks: usize, reason: NotTold) -> Self {
        Self {
            source,
            offset_s: None,
            offset_std_s: None,
            probability: None,
            rotors: vec![None; tracks],
            not_told: Some(reason),
        }
    }
}
