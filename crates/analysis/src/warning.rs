//! Warnings about a speed, each with a hint. They are values; nothing here prints.

use crate::rotors_not_apart::{not_apart_hint, not_apart_text};
use crate::{OtherRotor, Span};
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
        /// Lower edge of the band.
        band_hz_low: f64,
        /// Upper edge of the band.
        band_hz_high: f64,
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
        /// The longest part with few gaps, where it is long enough for a speed.
        clear: Option<Span>,
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
        /// Number of rotors in the mean, with those that are heard but not separated; 0 where one tone is used for all.
        in_mean: usize,
        /// Whether their number was not given.
        is_assumed: bool,
        /// Standard deviation of the speeds of the rotors about their mean, as a share, that the ± contains where one tone is used for all.
        spread_share: f64,
    },
    /// The number of rotors is not known, so that the line of one may stand for several.
    RotorCountUnknown {
        /// Standard deviation of the speeds of the others about their mean, as a share, that the ± contains.
        spread_share: f64,
    },
    /// Another rotor of the vehicle is heard, at a speed of its own, beside as many as are said to turn.
    OtherRotorsHeard {
        /// The number of rotors that are said to turn.
        expected: u32,
    },
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
        matches!(self, Self::ManyGaps { gap_share, .. } if 1.0 - gap_share < HEARD_SHARE_MIN)
    }

    /// Whether another warning about the same recording makes it needless: one for each harmonic would say the same several times.
    pub fn is_told_by(&self, others: &[Self]) -> bool {
        others.iter().any(|other| match (self, other) {
            (Self::RidgeOnBandEdge { harmonic, .. }, Self::RidgeOnBandEdge { harmonic: lower, .. }) => lower < harmonic,
            (Self::FewHarmonicsAgree { used, of }, Self::HarmonicLeftOut { harmonic: 1, .. }) => 2 * used >= *of,
            // advice about a tone that is probably the wrong one does not help
            (_, Self::FitsElsewhere(_)) => self.is_about_followed_tone(),
            _ => false,
        })
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
            | Self::OtherRotorsHeard { .. }
            | Self::FitsElsewhere(_)
            | Self::ManyGaps { .. } => false,
        }
    }

    /// Advice to the user, where no band was given; for given facts see [`GivenFacts::hints`](crate::GivenFacts::hints).
    pub fn hint(&self) -> &'static str {
        match self {
            Self::RidgeOnBandEdge { .. } => "check the number of blades",
            Self::HarmonicLeftOut { harmonic: 1, .. } => "if the speed looks wrong, check the number of blades",
            Self::HarmonicLeftOut { .. } => "you need to do nothing: the speed comes from the other harmonics",
            Self::BandCutByCodec { .. } => {
                "to use the higher harmonics too, record without compression or at a higher bit rate"
            }
            Self::FewHarmonicsAgree { used, of } if 2 * used < *of => {
                "another sound may be mixed in: check the number of blades, or use the tone alone with --harmonics 1"
            }
            Self::FewHarmonicsAgree { .. } => "another sound may be mixed in: check the number of blades",
            Self::OtherSteadySpeed { .. } | Self::HoversDiffer { .. } => {
                "choose the part you mean with --from and --to"
            }
            Self::HoverShorterThanSample { .. } => {
                "record a longer hover, or write a smaller length_s under [samples] in the experiment file"
            }
            _ if self.is_hardly_heard() => {
                "do not use this speed yet; first check the vehicle and its blades; if they are right, move the microphone nearer, or choose \
                 the clear part with --from and --to"
            }
            Self::ManyGaps { .. } => "move the microphone nearer, or choose the clear part with --from and --to",
            Self::FewFrames { needed_s: Some(_), .. } => {
                "record a longer hover, or choose a longer part with --from and --to"
            }
            Self::FewFrames { .. } => "choose the clear part with --from and --to",
            Self::RotorsNotApart { resolved, of, in_mean, is_assumed, .. } => {
                not_apart_hint(*resolved, *of, *in_mean, *is_assumed)
            }
            Self::RotorCountUnknown { .. } => {
                "give the number of rotors, as in --rotors 4 or --rotors 1: the ± may become smaller; to separate several rotors, place the microphone nearer"
            }
            Self::OtherRotorsHeard { .. } => {
                "if more rotors turn, give their number with --rotors; if not, record away from other machines"
            }
            Self::FitsElsewhere(_) => "check the given facts",
            Self::SeveralLines { .. } => {
                "hovertone follows the rotor that is loudest at each moment; to follow one rotor, give --band LOW:HIGH around its tone"
            }
        }
    }
}

impl fmt::Display for Warning {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::RidgeOnBandEdge { harmonic, frames_share, band_hz_low, band_hz_high } => {
                f.write_str(&on_edge_text(*harmonic, *frames_share, [*band_hz_low, *band_hz_high]))
            }
            Self::HarmonicLeftOut { harmonic, reason } => f.write_str(&left_out_text(*harmonic, reason)),
            Self::BandCutByCodec { above_hz } => {
                write!(
                    f,
                    "the recording has no sound above {:.1} kHz: the recorder or its compression removed it",
                    above_hz / 1e3
                )
            }
            Self::FewHarmonicsAgree { used, of } => {
                if 2 * used < *of {
                    let show = if *used == 1 { "shows" } else { "show" };
                    write!(f, "only {used} of {of} harmonics (multiples of the tone) {show} the same speed")
                } else {
                    f.write_str("the tone itself shows another speed than its multiples (its harmonics)")
                }
            }
            Self::OtherSteadySpeed { speed_rev_s, from_s, to_s } => {
                write!(f, "another steady speed, {speed_rev_s:.1} rev/s, is heard from {from_s:.1} s to {to_s:.1} s")
            }
            Self::HoversDiffer { slowest_rev_s, fastest_rev_s } => {
                write!(
                    f,
                    "the rotor speed differs between parts of the hover, from {slowest_rev_s:.1} to {fastest_rev_s:.1} rev/s: the result is the \
                    mean of these parts"
                )
            }
            Self::HoverShorterThanSample { hover_s, length_s } => {
                write!(
                    f,
                    "the hover ({hover_s:.1} s) is shorter than one sample (a part of {length_s:.1} s), so the whole \
                    hover is used as one sample"
                )
            }
            Self::ManyGaps { gap_share, clear } => {
                write!(f, "the tone is not clear for {:.0} % of the time", 100.0 * gap_share)?;
                match clear {
                    _ if self.is_hardly_heard() => f.write_str(": the speed may come from another sound"),
                    Some(Span { from_s, to_s }) => write!(f, "; it is clearest from {from_s:.1} to {to_s:.1} s"),
                    None => Ok(()),
                }
            }
            Self::FewFrames { sample_s, needed_s: Some(needed_s), .. } => {
                write!(f, "only {sample_s:.1} s of the sound are used, and a reliable ± needs {needed_s:.1} s or more")
            }
            Self::FewFrames { frame_count, sample_s, .. } => {
                write!(
                    f,
                    "in a part of {sample_s:.1} s, the tone is heard in only {frame_count} {} (short pieces of sound)",
                    if *frame_count == 1 { "frame" } else { "frames" }
                )
            }
            Self::RotorsNotApart { resolved, of, in_mean, is_assumed, spread_share } => {
                f.write_str(&not_apart_text(*resolved, *of, *is_assumed, *in_mean > 0, *spread_share))
            }
            Self::RotorCountUnknown { spread_share } => write!(
                f,
                "the number of rotors is not given; if there are several, the tone may come from one of them alone. So the ± is larger: \
                hovertone assumes that the speeds of the rotors differ by {:.1} % (standard deviation)",
                100.0 * spread_share
            ),
            Self::OtherRotorsHeard { expected } => f.write_str(&others_heard_text(*expected)),
            Self::FitsElsewhere(OtherRotor { blades, speed_rev_s }) => write!(
                f,
                "the sound contradicts the given facts: by the sound alone, a rotor with {blades} blades at {speed_rev_s:.1} rev/s is \
                more than 99 times as probable as any rotor that fits these facts"
            ),
            Self::SeveralLines { spread_share } => {
                write!(
                    f,
                    "the heard speed varies by {:.1} % (standard deviation): hovertone may hear different rotors at different times",
                    100.0 * spread_share
                )
            }
        }
    }
}

/// A harmonic that is not used, with the reason.
fn left_out_text(harmonic: u32, reason: &str) -> String {
    match harmonic {
        1 => format!("only the multiples of the tone (its harmonics) are used, and not the tone itself: {reason}"),
        _ => format!("harmonic {harmonic} of the tone (its frequency times {harmonic}) is not used: {reason}"),
    }
}

/// A harmonic that lies at an edge of its band for a share of the time.
fn on_edge_text(harmonic: u32, frames_share: f64, [low_hz, high_hz]: [f64; 2]) -> String {
    let tone = if harmonic == 1 { "the tone".to_owned() } else { format!("harmonic {harmonic} of the tone") };
    format!(
        "for {:.0} % of the time, {tone} lies at the edge of the band that is searched ({low_hz:.0} to {high_hz:.0} Hz), so the true tone may \
        lie outside",
        100.0 * frames_share
    )
}

fn others_heard_text(expected: u32) -> String {
    match expected {
        1 => "one rotor alone is expected, but other rotors are heard too".to_owned(),
        several => format!("{several} rotors are expected, but another rotor is heard beside them"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn said(resolved: usize, has_mean: bool, is_assumed: bool) -> String {
        let warning = Warning::RotorsNotApart {
            resolved,
            of: 4,
            in_mean: if has_mean { 4 } else { 0 },
            is_assumed,
            spread_share: 0.0058,
        };
        warning.to_string()
    }

    /// One sentence about a tone at the edge of its band, and one about a lowest line that is not used.
    #[test]
    fn what_one_warning_says_no_other_says_again() {
        let edge = |harmonic: u32| {
            let times = f64::from(harmonic);
            let (band_hz_low, band_hz_high) = (140.4 * times, 165.0 * times);
            Warning::RidgeOnBandEdge { harmonic, frames_share: 0.67, band_hz_low, band_hz_high }
        };
        let reason = "it is 2.0 % higher than its multiples show, so it may be another sound".to_owned();
        let all = [
            Warning::HarmonicLeftOut { harmonic: 1, reason },
            edge(1),
            edge(2),
            Warning::FewHarmonicsAgree { used: 2, of: 3 },
            Warning::FewHarmonicsAgree { used: 1, of: 3 },
        ];
        let told: Vec<bool> = all.iter().map(|warning| warning.is_told_by(&all)).collect();
        assert_eq!(told, [false, false, true, true, false]);
        assert!(!all[3].is_told_by(&all[1..]));
        let expected = "for 67 % of the time, the tone lies at the edge of the band that is searched (140 to 165 Hz), so the true tone may lie \
                        outside";
        assert_eq!(edge(1).to_string(), expected);
        assert_eq!(
            all[0].to_string(),
            "only the multiples of the tone (its harmonics) are used, and not the tone itself: it is 2.0 % higher than its multiples show, so it may be \
            another sound"
        );
    }

    /// Four rotors are assumed where no number is given: two of them may be far apart, so the warning does not call their speeds close.
    #[test]
    fn rotors_that_are_not_separated_are_not_called_close() {
        let all = [true, false]
            .map(|is_assumed| [said(0, true, is_assumed), said(0, false, is_assumed), said(3, true, is_assumed)]);
        assert!(all.iter().flatten().all(|said| said.contains("be separated") && !said.contains("close")), "{all:?}");
        assert!(
            all[0].iter().all(|said| said.contains("(hovertone assumes 4, because no number was given)")),
            "{all:?}"
        );
        assert!(all[1].iter().all(|said| !said.contains("assumes (no number")), "{all:?}");
    }

    /// The ± of one tone for several rotors assumes how much their speeds differ: the warning says how much, why, and what to do.
    #[test]
    fn an_assumed_spread_is_explained() {
        let one_tone =
            Warning::RotorsNotApart { resolved: 0, of: 4, in_mean: 0, is_assumed: false, spread_share: 0.0058 };
        let unknown = Warning::RotorCountUnknown { spread_share: 0.0058 };
        for (warning, why, what_to_do) in [
            (&one_tone, "may come from one rotor alone", "get a smaller ±"),
            (&unknown, "may come from one of them alone", "--rotors"),
        ] {
            let text = warning.to_string();
            assert!(text.contains("speeds of the rotors differ by 0.6 %") && text.contains(why), "{text}");
            assert!(warning.hint().contains(what_to_do), "{}", warning.hint());
        }
    }
}
