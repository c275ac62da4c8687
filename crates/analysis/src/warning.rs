//! What weakens a speed, with what to do about it. Values, not print-outs.

use serde::Serialize;
use std::fmt;

/// Something in the sound that weakens a speed.
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
        /// Why.
        reason: String,
    },
    /// A codec or the recorder left nothing of the high frequencies.
    BandCutByCodec {
        /// Where the recording ends.
        above_hz: f64,
    },
    /// Most harmonics were left out, or the tone itself was: what remains may not be the rotor's.
    FewHarmonicsAgree {
        /// Harmonics that are used.
        used: usize,
        /// Harmonics that were followed.
        of: usize,
    },
    /// Another steady speed was heard for at least half as long as the one that is reported.
    OtherSteadySpeed {
        /// The other shaft speed.
        speed_rev_s: f64,
        /// When it is heard.
        from_s: f64,
        /// Until when.
        to_s: f64,
    },
    /// The hover is shorter than one sample.
    HoverShorterThanSample {
        /// Length of the hover.
        hover_s: f64,
        /// Length of a sample as set.
        length_s: f64,
    },
    /// Many frames have no point.
    ManyGaps {
        /// Share of the frames without a point on the ridge.
        gap_share: f64,
    },
    /// Some samples rest on few frames.
    FewFrames {
        /// Fewest frames of a sample.
        frame_count: usize,
    },
    /// Some rotors could not be told apart.
    RotorsNotApart {
        /// Rotors that are, each by itself; 0 where no more than half are.
        resolved: usize,
        /// Rotors that there are.
        of: u32,
        /// Whether the mean of all of them is known all the same.
        has_mean: bool,
    },
    /// The ridge jumps between lines.
    SeveralLines {
        /// Spread of the ridge as a share of its mean.
        spread_share: f64,
    },
}

impl Warning {
    /// What to do about it.
    pub fn hint(&self) -> &'static str {
        match self {
            Self::RidgeOnBandEdge { .. } => "widen --band, or check the blades or the gear",
            Self::HarmonicLeftOut { .. } => "nothing to do when the others agree; --harmonics 1 follows the tone alone",
            Self::BandCutByCodec { .. } => {
                "record without compression, or at a higher bit rate, to use the harmonics above"
            }
            Self::FewHarmonicsAgree { .. } => {
                "another sound may lie in these bands: check the blades or the gear, narrow --band, or compare --harmonics 1"
            }
            Self::OtherSteadySpeed { .. } => "choose the part you mean with --from and --to",
            Self::HoverShorterThanSample { .. } => "record a longer hover, or shorten the samples (length_s)",
            Self::ManyGaps { .. } => "move the microphone nearer, or choose the clear part with --from and --to",
            Self::FewFrames { .. } => "use shorter frames, longer samples, or a larger frames_max",
            Self::RotorsNotApart { has_mean: false, .. } => {
                "one speed stands for all of them, and the budget counts that; rotors that turn alike cannot be told apart, \
                 others by a nearer microphone and higher harmonics"
            }
            Self::RotorsNotApart { .. } => {
                "their mean and mean square stand all the same, with a wider uncertainty; a nearer microphone and higher \
                 harmonics tell more apart"
            }
            Self::SeveralLines { .. } => {
                "the rotors turn at different speeds and the loudest wins; a narrower --band follows one line"
            }
        }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::RidgeOnBandEdge { harmonic, frames_share } => {
                write!(
                    f,
                    "harmonic {harmonic} sits on the edge of its band in {:.0} % of the frames",
                    100.0 * frames_share
                )
            }
            Self::HarmonicLeftOut { harmonic, reason } => write!(f, "harmonic {harmonic} is left out: {reason}"),
            Self::BandCutByCodec { above_hz } => {
                write!(f, "the recording holds nothing above {:.1} kHz: a codec or the recorder cut it", above_hz / 1e3)
            }
            Self::FewHarmonicsAgree { used, of } => {
                write!(f, "only {used} of {of} harmonics agree, or the first is not among them")
            }
            Self::OtherSteadySpeed { speed_rev_s, from_s, to_s } => {
                write!(f, "another steady speed, {speed_rev_s:.1} rev/s, is heard from {from_s:.1} s to {to_s:.1} s")
            }
            Self::HoverShorterThanSample { hover_s, length_s } => {
                write!(
                    f,
                    "the hover lasts {hover_s:.1} s, less than one sample of {length_s:.1} s: it is used as one sample"
                )
            }
            Self::ManyGaps { gap_share } => write!(f, "{:.0} % of the frames hold no tone", 100.0 * gap_share),
            Self::FewFrames { frame_count } => write!(f, "a sample rests on {frame_count} frames only"),
            Self::RotorsNotApart { resolved, of, .. } => write!(f, "{resolved} of {of} rotors are told apart"),
            Self::SeveralLines { spread_share } => {
                write!(f, "the ridge spreads over {:.1} % of the speed", 100.0 * spread_share)
            }
        }
    }
}
