//! Why no rotor tone was found.

use serde::Serialize;
use std::fmt;

/// Why no rotor tone was found.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
#[non_exhaustive]
pub enum NoTone {
    /// The span that was asked for lies outside the recording.
    OutsideRecording,
    /// The recording is too short to look for anything.
    TooShort {
        /// How long it is.
        heard_s: f64,
    },
    /// Nothing sounds.
    Silence,
    /// Nothing resembles a rotor's series of lines.
    NoSeries,
    /// No stretch is steady for long enough.
    NoHover,
    /// The hover holds no frame of the length that was asked for with a tone in it.
    NoFrame {
        /// Length of a frame.
        window_s: f64,
        /// Length of the hover.
        hover_s: f64,
    },
    /// What looks like a rotor series is not made of lines.
    NotALine {
        /// Where the strongest candidate is.
        tone_hz: f64,
        /// Share of its frames that show a line.
        line_share: f64,
        /// Share that is asked for.
        line_share_min: f64,
    },
    /// Mains hum, and nothing else that resembles a rotor.
    MainsHum {
        /// Frequency of the mains as heard.
        mains_hz: f64,
    },
    /// Tones come and go, and none is held for long while others sound for longer.
    NotHeld {
        /// The tone that is heard most.
        tone_hz: f64,
        /// How long it is held at most.
        held_s: f64,
    },
    /// The lines belong to something that turns more slowly, or to an instrument.
    ForeignSeries {
        /// Distance of its lines.
        fundamental_hz: f64,
        /// Where the strongest candidate is.
        tone_hz: f64,
    },
    /// The tone lies where the recording holds nothing.
    BandCutByCodec {
        /// Where the tone would be.
        tone_hz: f64,
        /// Where the recording ends.
        above_hz: f64,
    },
    /// A weak steady tone, with lines between those that the rotor can make.
    SlowerShaft {
        /// How many of them.
        line_count: usize,
        /// How fast a shaft would turn that makes them all, if they are of one strength.
        speed_rev_s: Option<f64>,
    },
    /// A line that comes and goes, without any of its harmonics.
    LonelyLine {
        /// Where it is.
        tone_hz: f64,
        /// Share of its frames that show a line.
        line_share: f64,
    },
}

impl fmt::Display for NoTone {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutsideRecording => f.write_str("the recording has nothing between the times asked for"),
            Self::TooShort { heard_s } => write!(f, "{heard_s:.2} s are too short to hear a rotor in"),
            Self::Silence => f.write_str("nothing sounds"),
            Self::NoSeries => f.write_str("nothing resembles the lines of a rotor"),
            Self::NoHover => f.write_str("no stretch holds a steady tone for long enough"),
            Self::NoFrame { window_s, hover_s } => {
                write!(f, "no frame of {window_s} s in {hover_s:.1} s of hover holds the tone; ask for shorter frames")
            }
            Self::NotALine { tone_hz, line_share, line_share_min } if line_share > line_share_min => write!(
                f,
                "the best candidate, near {tone_hz:.0} Hz, is a line in {:.0} % of its frames, but these are too few to prove that a \
                 rotor's would be one in more than {:.0} %; let it hear a longer hover",
                100.0 * line_share,
                100.0 * line_share_min
            ),
            Self::NotALine { tone_hz, line_share, line_share_min } => write!(
                f,
                "the best candidate, near {tone_hz:.0} Hz, is a line in {:.0} % of its frames; a rotor is one in clearly \
                 more than {:.0} %",
                100.0 * line_share,
                100.0 * line_share_min
            ),
            Self::MainsHum { mains_hz } => write!(
                f,
                "what sounds is mains hum, lines at multiples of {mains_hz:.2} Hz that do not move, and no rotor is heard beside it"
            ),
            Self::NotHeld { tone_hz, held_s } => write!(
                f,
                "tones come and go: the one near {tone_hz:.0} Hz is held for {held_s:.1} s at most, and others sound for longer; \
                 if a rotor is among them, choose its part with --from and --to"
            ),
            Self::ForeignSeries { fundamental_hz, tone_hz } => write!(
                f,
                "lines {fundamental_hz:.1} Hz apart are heard that a rotor with its tone near {tone_hz:.0} Hz cannot make: a slower \
                 rotor, an engine or an instrument; check the blades or the gear"
            ),
            Self::BandCutByCodec { tone_hz, above_hz } => write!(
                f,
                "the tone would be near {tone_hz:.0} Hz, and a codec or the recorder left nothing above {above_hz:.0} Hz; \
                 record without compression, or follow a tone of lower order"
            ),
            Self::SlowerShaft { line_count, .. } => write!(
                f,
                "a weak steady tone, but {line_count} lines sound between those that the rotor can make: the shaft turns more \
                 slowly than they say"
            ),
            Self::LonelyLine { tone_hz, line_share } => write!(
                f,
                "the best candidate, near {tone_hz:.0} Hz, is a line in only {:.0} % of its frames and none of its \
                 harmonics is heard",
                100.0 * line_share
            ),
        }
    }
}
