//! Warnings about a speed, each with a hint. They are values; nothing here prints.

use crate::OtherRotor;
use serde::Serialize;
use std::fmt;

/// A reason to doubt a speed.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
#[non_exhaustive]
pub enum Warning {
    /// The ridge leaves its band.
    RidgeOnBandEdge {
        /// Number of the harmonic, 1 for the tone itself.
        harmonic: u32,
        /// Share of the frames whose peak is at an edge of the band.
        frames_share: f64,
    },
    /// A harmonic was not used.
    HarmonicLeftOut {
        /// Number of the harmonic.
        harmonic: u32,
        /// Reason.
        reason: String,
    },
    /// A codec or the recorder removed the high frequencies.
    BandCutByCodec {
        /// Upper end of the bandwidth.
        above_hz: f64,
    },
    /// Most harmonics were left out, or the tone itself was. The remaining ones may not belong to the rotor.
    FewHarmonicsAgree {
        /// Number of used harmonics.
        used: usize,
        /// Number of followed harmonics.
        of: usize,
    },
    /// Parts of the hover, between manoeuvres, turn at different speeds.
    HoversDiffer {
        /// Mean shaft speed of the slowest part.
        slowest_rev_s: f64,
        /// Mean shaft speed of the fastest part.
        fastest_rev_s: f64,
    },
    /// Another steady speed was heard for at least half as long as the reported one.
    OtherSteadySpeed {
        /// The other shaft speed.
        speed_rev_s: f64,
        /// Its start.
        from_s: f64,
        /// Its end.
        to_s: f64,
    },
    /// The hover is shorter than one sample.
    HoverShorterThanSample {
        /// Length of the hover.
        hover_s: f64,
        /// Configured length of a sample.
        length_s: f64,
    },
    /// Many frames have no point on the ridge.
    ManyGaps {
        /// Share of the frames without a point.
        gap_share: f64,
    },
    /// Some samples have few frames.
    FewFrames {
        /// Smallest number of frames in a sample.
        frame_count: usize,
        /// Length of that sample.
        sample_s: f64,
        /// Length that has enough frames, where the sample is too short for them; absent where the tone has gaps.
        needed_s: Option<f64>,
    },
    /// Some rotors could not be separated.
    RotorsNotApart {
        /// Number of separated rotors; 0 where at most half of them are.
        resolved: usize,
        /// Number of rotors.
        of: u32,
        /// Whether the mean of all rotors is still known.
        has_mean: bool,
        /// Whether their number was not given.
        is_assumed: bool,
    },
    /// The number of rotors is not known, so that the line of one may stand for several.
    RotorCountUnknown {
        /// Standard deviation of the speeds of the others about their mean, as a share, that the ± contains.
        spread_share: f64,
    },
    /// Another rotor of the vehicle is heard, at a speed of its own, where one alone is said to turn.
    OtherRotorsHeard,
    /// The lines are far more probable for a rotor that something known leaves out.
    FitsElsewhere(OtherRotor),
    /// The ridge jumps between lines.
    SeveralLines {
        /// Relative standard deviation of the ridge.
        spread_share: f64,
    },
}

/// Smallest share of the time in which a line is heard whose frequency is used. *Decision.*
pub const HEARD_SHARE_MIN: f64 = 0.3;

impl Warning {
    /// Whether the tone is heard for so small a share of the time that it proves no order: other lines of another rotor may have told the speed.
    pub fn is_hardly_heard(&self) -> bool {
        matches!(self, Self::ManyGaps { gap_share } if 1.0 - gap_share < HEARD_SHARE_MIN)
    }

    /// Whether it concerns the way in which one tone is followed, and nothing that the recording holds.
    pub fn is_about_followed_tone(&self) -> bool {
        match self {
            Self::RidgeOnBandEdge { .. }
            | Self::HarmonicLeftOut { .. }
            | Self::FewHarmonicsAgree { .. }
            | Self::FewFrames { .. }
            | Self::RotorsNotApart { .. }
            | Self::RotorCountUnknown { .. }
            | Self::SeveralLines { .. } => true,
            Self::BandCutByCodec { .. }
            | Self::OtherSteadySpeed { .. }
            | Self::HoversDiffer { .. }
            | Self::HoverShorterThanSample { .. }
            | Self::OtherRotorsHeard
            | Self::FitsElsewhere(_)
            | Self::ManyGaps { .. } => false,
        }
    }

    /// Advice to the user.
    pub fn hint(&self) -> &'static str {
        match self {
            Self::RidgeOnBandEdge { .. } => "widen --band, or check the blades or the gear",
            Self::HarmonicLeftOut { harmonic: 1, .. } => {
                "the speed comes from the other harmonics; --band narrows the search"
            }
            Self::HarmonicLeftOut { .. } => "the speed comes from the other harmonics",
            Self::BandCutByCodec { .. } => {
                "record without compression, or at a higher bit rate, to use the harmonics above"
            }
            Self::FewHarmonicsAgree { .. } => {
                "another sound may lie in these bands: check the blades or the gear, narrow --band, or compare --harmonics 1"
            }
            Self::OtherSteadySpeed { .. } | Self::HoversDiffer { .. } => {
                "choose the part you mean with --from and --to"
            }
            Self::HoverShorterThanSample { .. } => "record a longer hover, or lower length_s in [samples]",
            _ if self.is_hardly_heard() => {
                "do not use this speed before you have checked the vehicle, the blades and the gear; if they are right, move the microphone nearer, \
                 or choose the clear part with --from and --to; if you gave --band, leave it out"
            }
            Self::ManyGaps { .. } => {
                "move the microphone nearer, or choose the clear part with --from and --to; if you gave --band, leave it out"
            }
            Self::FewFrames { needed_s: Some(_), .. } => {
                "choose a longer part with --from and --to, or record a longer hover"
            }
            Self::FewFrames { .. } => "choose the clear part with --from and --to",
            Self::RotorsNotApart { has_mean: false, .. } => {
                "if their speeds are equal, nothing can separate them; if not, place the microphone nearer and record without compression"
            }
            Self::RotorsNotApart { .. } => {
                "the speed is the mean of all, and its ± allows for this; if fewer rotors turn, give their number with --rotors; to separate more, place the microphone nearer"
            }
            Self::RotorCountUnknown { .. } => "give the number of rotors with --rotors",
            Self::OtherRotorsHeard => {
                "if several rotors turn, leave --rotors 1 out; if not, record away from other machines"
            }
            Self::FitsElsewhere(_) => {
                "check the given facts: the vehicle, the blades, the diameter, the mass or the band"
            }
            Self::SeveralLines { .. } => "the result follows the loudest rotor; a narrower --band follows one rotor",
        }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::RidgeOnBandEdge { harmonic, frames_share } => {
                write!(
                    f,
                    "harmonic {harmonic} is at the edge of its band in {:.0} % of the frames",
                    100.0 * frames_share
                )
            }
            Self::HarmonicLeftOut { harmonic, reason } => write!(f, "harmonic {harmonic} is not used: {reason}"),
            Self::BandCutByCodec { above_hz } => {
                write!(f, "the recording holds nothing above {:.1} kHz: a codec or the recorder cut it", above_hz / 1e3)
            }
            Self::FewHarmonicsAgree { used, of } => {
                if 2 * used < *of {
                    write!(f, "only {used} of {of} harmonics show the same speed")
                } else {
                    f.write_str("the first harmonic shows another speed than the others")
                }
            }
            Self::OtherSteadySpeed { speed_rev_s, from_s, to_s } => {
                write!(f, "another steady speed, {speed_rev_s:.1} rev/s, is heard from {from_s:.1} s to {to_s:.1} s")
            }
            Self::HoversDiffer { slowest_rev_s, fastest_rev_s } => {
                write!(
                    f,
                    "parts of the hover turn at different speeds, {slowest_rev_s:.1} to {fastest_rev_s:.1} rev/s: the result is their mean"
                )
            }
            Self::HoverShorterThanSample { hover_s, length_s } => {
                write!(
                    f,
                    "the hover of {hover_s:.1} s is shorter than a sample ({length_s:.1} s) and is used as one sample"
                )
            }
            Self::ManyGaps { gap_share } => {
                write!(f, "the tone is not heard for {:.0} % of the time", 100.0 * gap_share)?;
                if self.is_hardly_heard() { f.write_str(": another rotor may have told this speed") } else { Ok(()) }
            }
            Self::FewFrames { sample_s, needed_s: Some(needed_s), .. } => {
                write!(f, "only {sample_s:.1} s are used, and hovertone needs {needed_s:.1} s or more")
            }
            Self::FewFrames { frame_count, sample_s, .. } => {
                write!(f, "in a part of {sample_s:.1} s, only {frame_count} frames have a tone")
            }
            Self::RotorsNotApart { resolved, of, has_mean, is_assumed } => {
                match (resolved, has_mean) {
                    (0, true) => write!(
                        f,
                        "the speeds of the {of} rotors are too close to separate them: they are heard as a group"
                    ),
                    (0, false) => write!(f, "the {of} rotors could not be separated: one tone is used for all of them"),
                    _ => write!(f, "only {resolved} of the {of} rotors could be separated"),
                }?;
                if *is_assumed { write!(f, " (no number of rotors was given: {of} are assumed)") } else { Ok(()) }
            }
            Self::RotorCountUnknown { spread_share } => write!(
                f,
                "the number of rotors is not known; for the ±, hovertone assumes that their speeds differ by {:.1} % (standard deviation)",
                100.0 * spread_share
            ),
            Self::OtherRotorsHeard => f.write_str("other rotors are heard beside the one that is said to turn alone"),
            Self::FitsElsewhere(OtherRotor { blades, speed_rev_s }) => write!(
                f,
                "by its lines alone, the rotor more probably has {blades} blades and turns at {speed_rev_s:.1} rev/s (odds of more than 99 to 1)"
            ),
            Self::SeveralLines { spread_share } => {
                write!(
                    f,
                    "the speed that is followed varies by {:.1} % (standard deviation): it may jump from rotor to rotor",
                    100.0 * spread_share
                )
            }
        }
    }
}
