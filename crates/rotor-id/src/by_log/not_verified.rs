//! Why a heard flight and a log cannot be compared, and what to do.

/// Why nothing can be compared.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NotVerified {
    /// No speed was heard.
    #[error("no rotor was heard for long enough")]
    NoTrack,
    /// The log has fewer motors than rotors were heard.
    #[error("{tracks} rotors were heard, but in the log only {motors} motors turn")]
    TooFewMotors {
        /// Heard rotors.
        tracks: usize,
        /// Motors of the log.
        motors: usize,
    },
    /// Both never overlap for long enough.
    #[error("the log is too short, or not of this recording: they share too little time")]
    NoOverlap,
    /// Both do not overlap for long enough at the given offsets.
    #[error("at the offsets that --log-offset-s allows, the log and the recording share too little time")]
    NoOverlapAtOffset,
    /// The range of offsets is too wide.
    #[error("the log or the recording is too long to try all offsets between their clocks")]
    TooLong,
}

impl NotVerified {
    /// What to do.
    pub fn hint(self) -> &'static str {
        match self {
            Self::NoTrack => {
                "record for longer, or choose a longer part with --from and --to: a rotor must be heard for some seconds without a gap"
            }
            Self::TooFewMotors { .. } => "give the log of the same vehicle, or the number of rotors with --rotors",
            Self::NoOverlap => "give the log of the same flight, at least half as long as the hover",
            Self::NoOverlapAtOffset => {
                "leave --log-offset-s out, or give limits that contain the right offset; the offset is added to the clock of the log"
            }
            Self::TooLong => "give limits of the offset in seconds: --log-offset-s LOW:HIGH",
        }
    }
}
