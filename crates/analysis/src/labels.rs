//! Labels: which track belongs to which rotor, and the reasons for missing labels.

use serde::Serialize;
use std::fmt;

/// Largest number of rotors with labels. The number of assignments is its factorial. *Decision.*
pub const LABELLED_ROTORS_MAX: usize = 6;

/// Source of the labels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum LabelSource {
    /// Speeds of the motors in a log.
    MotorSpeeds,
    /// Commands or PWM of the motors in a log.
    MotorCommands,
    /// Body rates in a log.
    BodyRates,
    /// Levels and delays at several microphones at known positions.
    Microphones,
    /// The order in which the motors were started.
    SpinUp,
}

impl LabelSource {
    /// Description for people.
    pub fn words(self) -> &'static str {
        match self {
            Self::MotorSpeeds => "the speeds of the motors",
            Self::MotorCommands => "the commands of the motors",
            Self::BodyRates => "the body's rates",
            Self::Microphones => "loudness and delay of the sound at the microphones",
            Self::SpinUp => "the sequence in which the motors were started",
        }
    }
}

/// The rotor of a track.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RotorLabel {
    /// Number of the motor or place, counted from 1, in the order of the motors of the log or of the places of the frame.
    pub number: usize,
    /// Name: "motor 3", "front left".
    pub name: String,
    /// Probability that the track belongs to this rotor.
    pub probability: f64,
}

/// The rotors of all tracks.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct RotorLabels {
    /// Source of the labels.
    pub source: LabelSource,
    /// Time of the recording minus time of the log; absent where no label is known.
    pub offset_s: Option<f64>,
    /// Standard uncertainty of the offset.
    pub offset_std_s: Option<f64>,
    /// Probability of the most probable assignment of all tracks. The remainder is for other assignments, and for a log or positions that
    /// do not belong to the tracks.
    pub probability: Option<f64>,
    /// The label of each track, in the order of the tracks; absent where it is unknown.
    pub rotors: Vec<Option<RotorLabel>>,
    /// Reason for missing labels.
    pub not_told: Option<NotTold>,
}

/// Reason for missing labels.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
#[non_exhaustive]
pub enum NotTold {
    /// The log has another number of rotors.
    OtherCount {
        /// Number of running rotors.
        rotors: usize,
        /// Number of rotors in the log.
        of_log: usize,
    },
    /// Too many rotors to compare all assignments.
    TooManyRotors {
        /// Number of running rotors.
        rotors: usize,
    },
    /// Too few rotors are separated.
    TooFewTracks {
        /// Number of separated rotors.
        tracks: usize,
        /// Needed number.
        needed: usize,
    },
    /// The range of offsets is too wide.
    TooManyOffsets {
        /// Smallest offset.
        low_s: f64,
        /// Largest offset.
        high_s: f64,
    },
    /// Log and hover overlap too little.
    NoOverlap,
    /// The signals of the log do not follow the tracks.
    NothingInCommon {
        /// Probability that log and tracks belong together.
        probability: f64,
    },
    /// The best offset lies at a limit of the search.
    OffsetAtLimit {
        /// The offset.
        offset_s: f64,
    },
    /// The hover begins with the recording, and no start is found in it.
    NoStart,
    /// Rotors start at nearly the same time.
    StartedTogether {
        /// Shortest time between two starts.
        apart_s: f64,
    },
    /// Some rotors cannot be followed from the hover back to their start: they are inaudible in between, or their speed jumps.
    NotFollowed {
        /// Number of these rotors.
        tracks: usize,
    },
    /// A rotor turns at another speed before it reaches the speed of the hover.
    OtherSpeedBefore {
        /// That speed.
        speed_rev_s: f64,
    },
    /// The speeds of two rotors are too close for short frames.
    RotorsTooClose {
        /// Difference of the speeds.
        apart_rev_s: f64,
    },
    /// The hover begins too long after the start of the recording.
    SpinUpTooLong {
        /// Time between start of the recording and hover.
        before_hover_s: f64,
    },
    /// Several assignments fit the motors of the log.
    SeveralFit {
        /// Number of tracks without a label.
        tracks: usize,
    },
    /// Several assignments fit the body rates of the log, which has no motors.
    SeveralFitRates {
        /// Number of tracks without a label.
        tracks: usize,
    },
    /// The numbers of channels and microphones differ.
    OtherChannels {
        /// Number of channels.
        channels: usize,
        /// Number of microphones.
        microphones: usize,
    },
    /// No separated rotors, or more than places.
    OtherPlaces {
        /// Number of separated rotors.
        tracks: usize,
        /// Number of places.
        places: usize,
    },
    /// A microphone hears no line of any rotor for long enough.
    NothingHeard {
        /// Number of the microphone, counted from 1.
        microphone: usize,
    },
    /// Levels and delays do not fit these positions of rotors and microphones.
    OtherArray {
        /// Probability that they fit.
        probability: f64,
    },
    /// Several assignments fit levels and delays.
    SeveralPlacesFit {
        /// Number of tracks without a label.
        tracks: usize,
    },
}

impl NotTold {
    /// Advice to the user.
    pub fn hint(&self) -> &'static str {
        match self {
            Self::OtherCount { .. } => {
                "give the log of the same flight; if it is the right log, correct the number of rotors with --vehicle or --rotors"
            }
            Self::TooManyRotors { .. } => "the rotors get numbers in place of names; rotor 1 is the fastest",
            Self::TooFewTracks { .. } => {
                "place the microphone nearer; this does not help with rotors at nearly equal speeds"
            }
            Self::TooManyOffsets { .. } => "give narrower limits for the offset, in seconds: --log-offset-s LOW:HIGH",
            Self::NoOverlap => {
                "give the log of the same flight; if it is the right log, give other limits for the offset of the log, in seconds: \
                --log-offset-s LOW:HIGH"
            }
            Self::NothingInCommon { .. } => {
                "check that the log is of the same flight; if it is, give limits that contain the offset of the log (--log-offset-s LOW:HIGH), and check the direction of the axes (--log-axes)"
            }
            Self::OffsetAtLimit { .. } => "give wider limits for the offset, in seconds: --log-offset-s LOW:HIGH",
            Self::NoStart => {
                "leave --spin-up out, or give a log of the flight with --log in its place; next time, start the \
                recording first, then one motor after the other, a second or more apart"
            }
            Self::StartedTogether { .. } => "record again, and start one motor after the other, a second or more apart",
            Self::NotFollowed { .. } => {
                "record again: start the recording first; then bring one motor after the other straight to the speed \
                of the hover, a second apart"
            }
            Self::OtherSpeedBefore { .. } => {
                "record again, and bring each motor straight to the speed of the hover, without idling"
            }
            Self::RotorsTooClose { .. } => "give a log of the flight with --log",
            Self::SpinUpTooLong { .. } => "choose a part that begins shortly before the motors start: --from SECONDS",
            Self::SeveralFit { .. } => {
                "record a longer hover, and rock the vehicle gently left-right and forward-back: this makes the \
                speeds of the rotors differ"
            }
            Self::SeveralFitRates { .. } => {
                "record longer, and rock the vehicle gently left-right and forward-back: the movements show where \
                each rotor is"
            }
            Self::OtherChannels { .. } => {
                "in the file of --microphones, write one [[microphone]] for each channel, in the sequence of the \
                channels"
            }
            Self::OtherPlaces { .. } => {
                "in the file of --microphones, write one [[rotor]] for each rotor, with its name and position_m"
            }
            Self::NothingHeard { .. } => {
                "check that the channel of this microphone is not silent, or record a longer hover"
            }
            Self::OtherArray { .. } => {
                "check the positions of the microphones, their sequence, and the axes (x forward, y left, z up); if all are right, give a \
                larger position_std_m, which is the uncertainty of the positions"
            }
            Self::SeveralPlacesFit { .. } => {
                "place the microphones nearer, and not symmetrically to the vehicle; or add microphones; or measure their positions better, and \
                give a smaller position_std_m"
            }
        }
    }
}

impl fmt::Display for NotTold {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OtherCount { rotors, of_log } => {
                write!(
                    f,
                    "the vehicle has {rotors} rotors, but the log has {of_log} motors (or motor outputs that change)"
                )
            }
            Self::TooManyRotors { rotors } => {
                write!(f, "{rotors} rotors are too many to name: the limit is {}", LABELLED_ROTORS_MAX)
            }
            Self::TooFewTracks { tracks, needed } => {
                write!(
                    f,
                    "to name rotors, {needed} separated rotors are needed, but {} separated in the sound",
                    rotors_are(*tracks)
                )
            }
            Self::TooManyOffsets { low_s, high_s } => {
                write!(
                    f,
                    "the offset of the log may be anything from {low_s:.0} to {high_s:.0} s: this range is too wide to search"
                )
            }
            Self::NoOverlap => f.write_str("the log covers too little time of the hover"),
            Self::NothingInCommon { probability } => {
                write!(
                    f,
                    "the log does not fit the speeds of the rotors (probability that it is of this flight: \
                    {probability:.2})"
                )
            }
            Self::OffsetAtLimit { offset_s } => {
                write!(f, "the log fits best at a clock offset of {offset_s:.2} s, at the edge of the searched range")
            }
            Self::NoStart => f.write_str(
                "the recording begins in the hover, so no motor is heard to start, and --spin-up changes nothing",
            ),
            Self::StartedTogether { apart_s } => {
                write!(f, "two rotors start within {:.1} s of each other", apart_s.max(0.1))
            }
            Self::NotFollowed { tracks } => {
                write!(f, "{tracks} of the rotors cannot be followed from their start to the hover")
            }
            Self::OtherSpeedBefore { speed_rev_s } => {
                write!(f, "before the hover, a rotor is heard at another speed, {speed_rev_s:.1} rev/s")
            }
            Self::RotorsTooClose { apart_rev_s } => {
                write!(
                    f,
                    "the speeds of two rotors differ by only {apart_rev_s:.2} rev/s, too little to hear which one starts"
                )
            }
            Self::SpinUpTooLong { before_hover_s } => {
                write!(
                    f,
                    "the hover begins {before_hover_s:.0} s after the start of the recording: this is too long to follow the rotors from \
                    their starts"
                )
            }
            Self::SeveralFit { tracks } => write!(f, "for {tracks} of the rotors, several motors of the log fit"),
            Self::SeveralFitRates { tracks } => f.write_str(&several_places_text(*tracks)),
            Self::OtherChannels { channels, microphones } => f.write_str(&other_channels_text(*channels, *microphones)),
            Self::OtherPlaces { tracks, places } => {
                write!(f, "{tracks} rotors were separated in the sound, but only {places} of them have a place")
            }
            Self::NothingHeard { microphone } => {
                write!(f, "microphone {microphone} does not hear the rotors for long enough")
            }
            Self::OtherArray { probability } => {
                write!(
                    f,
                    "the sound does not fit the given microphone positions (probability that it fits: {probability:.2})"
                )
            }
            Self::SeveralPlacesFit { tracks } => {
                write!(f, "for {tracks} of the rotors, the sound at the microphones fits several places")
            }
        }
    }
}

fn other_channels_text(channels: usize, microphones: usize) -> String {
    let plural = if channels == 1 { "" } else { "s" };
    format!(
        "the recording has {channels} channel{plural}, but the number of microphones with a position is {microphones}: \
         the two numbers must be equal"
    )
}

fn several_places_text(tracks: usize) -> String {
    format!("for {tracks} of the rotors, the movements in the log fit more than one place on the vehicle")
}

fn rotors_are(count: usize) -> String {
    match count {
        0 => "no rotor is".to_owned(),
        1 => "one rotor is".to_owned(),
        count => format!("{count} rotors are"),
    }
}

impl RotorLabels {
    /// That rotors could not be named, and why; `None` where all have a label.
    pub fn why_not_all(&self) -> Option<String> {
        let reason = self.not_told.as_ref()?;
        let who = if self.rotors.iter().any(Option::is_some) { "not all rotors" } else { "no rotor" };
        Some(format!("{who} could be named: {reason}"))
    }

    /// Labels that are all missing.
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sentence_tells_whether_any_rotor_has_a_name() {
        let reason = NotTold::SeveralFitRates { tracks: 4 };
        let none = RotorLabels::not_told(LabelSource::BodyRates, 4, reason);
        let said = none.why_not_all().unwrap_or_default();
        assert!(said.starts_with("no rotor could be named: for 4 of the rotors, the movements in the log"), "{said}");
        let first = RotorLabel { number: 1, name: "motor 1".to_owned(), probability: 0.99 };
        let some = RotorLabels { rotors: vec![Some(first), None], ..none.clone() };
        let said = some.why_not_all().unwrap_or_default();
        assert!(said.starts_with("not all rotors could be named: "), "{said}");
        assert_eq!(RotorLabels { not_told: None, ..some }.why_not_all(), None);
    }
}
