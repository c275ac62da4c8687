//! Reasons why no rotor tone was found.

use crate::{GivenFacts, OtherRotor};
use serde::Serialize;
use std::fmt;

/// Reason why no rotor tone was found.
#[derive(Clone, Debug, PartialEq, Serialize)]
#[serde(tag = "kind", rename_all = "snake_case")]
#[non_exhaustive]
pub enum NoTone {
    /// The requested span begins where the recording has ended.
    OutsideRecording {
        /// End of the recording.
        end_s: f64,
    },
    /// The recording is too short for an analysis.
    TooShort {
        /// Length of the recording.
        heard_s: f64,
    },
    /// The recording is silent.
    Silence,
    /// No series of lines resembles a rotor.
    NoSeries {
        /// The shaft speeds that were compared, where something that is known of the rotor leaves others out.
        only_rev_s: Option<(f64, f64)>,
        /// What is heard where nothing is known.
        instead: Option<OtherRotor>,
    },
    /// No stretch is steady for long enough.
    NoHover,
    /// The hover has no frame of the requested length with a tone.
    NoFrame {
        /// Length of a frame.
        window_s: f64,
        /// Length of the hover.
        hover_s: f64,
    },
    /// The only candidate is mains hum.
    MainsHum {
        /// Measured mains frequency.
        mains_hz: f64,
    },
    /// No tone lasts for long, while others sound for longer.
    NotHeld {
        /// The tone with the longest total time.
        tone_hz: f64,
        /// Longest continuous time of that tone.
        held_s: f64,
    },
    /// The tone lies above the bandwidth of the recording.
    BandCutByCodec {
        /// Expected frequency of the tone.
        tone_hz: f64,
        /// Upper end of the bandwidth.
        above_hz: f64,
    },
}

impl NoTone {
    /// The reason with its advice, which names the given facts and no others.
    pub fn in_words(&self, given: GivenFacts) -> String {
        match self {
            Self::NoSeries { only_rev_s, instead: Some(OtherRotor { blades, speed_rev_s }) } => {
                let in_place = blades_in_place(*blades, given);
                let may_turn = format!("with {blades} blades may turn at {speed_rev_s:.1} rev/s");
                let not_heard = match only_rev_s {
                    Some((low, high)) if (*low..=*high).contains(speed_rev_s) => {
                        return format!(
                            "the tone that the given facts describe is not heard, but a rotor {may_turn}; {in_place}"
                        );
                    }
                    Some((low, high)) => {
                        format!("no rotor that fits the given facts is heard at {low:.0} to {high:.0} rev/s")
                    }
                    None => "no rotor that fits the given facts is heard".to_owned(),
                };
                format!(
                    "{not_heard}. But a rotor {may_turn}: if your rotor has {blades} blades, {in_place}; if not, \
                    check {}",
                    given.in_words("and")
                )
            }
            Self::NoSeries { only_rev_s: Some((low, high)), instead: None } => format!(
                "no rotor is heard at {low:.0} to {high:.0} rev/s, where the given facts expect it; check {}, or move the microphone nearer",
                given.in_words("and")
            ),
            Self::NoFrame { window_s, hover_s } if given.window => format!(
                "in {hover_s:.1} s of hover, no piece of {window_s} s (--window-s) has a clear tone; leave --window-s out: hovertone then chooses a \
                 length that fits the tone"
            ),
            other => other.to_string(),
        }
    }
}

/// To give the blades that are heard: alone, where other facts than the blades are in their way.
fn blades_in_place(blades: u32, given: GivenFacts) -> String {
    let others = GivenFacts { blades: false, window: false, ..given };
    match given.blades && others == GivenFacts::default() {
        true => format!("give --blades {blades}"),
        false => format!("give --blades {blades} alone, in place of {}", given.replaced_by_blades()),
    }
}

impl fmt::Display for NoTone {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::OutsideRecording { end_s } => write!(
                f,
                "the recording ends at {end_s:.1} s, before the chosen part begins; choose another part with --from and --to"
            ),
            Self::TooShort { heard_s } => {
                write!(f, "{heard_s:.2} s of sound are too short to hear a rotor: 1 s or more is needed; choose a longer part, or record a longer hover")
            }
            Self::Silence => f.write_str(
                "the recording is silent; check the microphone. If the file has several audio tracks or channels, choose one with \
                --audio-track or --channel: two channels of opposite sign cancel each other",
            ),
            Self::NoSeries { only_rev_s: None, instead: None } => {
                f.write_str("nothing sounds like a rotor; move the microphone nearer, or choose a steady part with --from and --to")
            }
            Self::NoSeries { .. } => f.write_str(&self.in_words(GivenFacts::default())),
            Self::NoHover => {
                f.write_str("no tone is steady for long enough; hover for ten seconds or longer without moving the sticks, or on a bench hold the throttle")
            }
            Self::NoFrame { window_s, hover_s } => {
                write!(
                    f,
                    "in {hover_s:.1} s of hover, the tone is never clear for {window_s} s at a time; choose a longer or steadier part with --from and --to"
                )
            }
            Self::MainsHum { mains_hz } => write!(
                f,
                "only tones at multiples of {mains_hz:.2} Hz are heard, and they never change: this is mains hum (from the power supply), \
                or a rotor at a constant speed; record the rotor at another throttle, or place the microphone nearer to the rotors"
            ),
            Self::NotHeld { tone_hz, held_s } => write!(
                f,
                "tones come and go: the tone near {tone_hz:.0} Hz is held for {held_s:.1} s at most; if one of these \
                tones is from a rotor, choose the part with this tone: --from and --to"
            ),
            Self::BandCutByCodec { tone_hz, above_hz } => write!(
                f,
                "the tone should be near {tone_hz:.0} Hz, but the recording has no sound above {above_hz:.0} Hz: the \
                recorder or its compression removed it; record without compression, or follow the lower tone of the \
                blades: give --blades N alone"
            ),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_steady_rotor_at_the_frequency_of_the_mains_is_not_said_to_be_hum_alone() {
        let said = NoTone::MainsHum { mains_hz: 60.0 }.to_string();
        assert!(
            said.contains("60.00 Hz")
                && said.contains("mains hum (from the power supply), or a rotor at a constant speed"),
            "{said}"
        );
        assert!(said.contains("record the rotor at another throttle"), "{said}");
    }

    #[test]
    fn what_is_heard_instead_is_named_with_what_to_do() {
        let said = |only_rev_s| {
            let instead = Some(OtherRotor { blades: 2, speed_rev_s: 60.2 });
            let given = GivenFacts { vehicle: true, band: true, ..GivenFacts::default() };
            NoTone::NoSeries { only_rev_s, instead }.in_words(given)
        };
        assert!(said(Some((13.0, 120.0))).contains("give --blades 2 alone, in place of the vehicle and the band"));
        // the number of blades that is given may be right
        let instead = Some(OtherRotor { blades: 2, speed_rev_s: 60.2 });
        let geared = GivenFacts { blades: true, gear: true, ..GivenFacts::default() };
        let told = NoTone::NoSeries { only_rev_s: None, instead }.in_words(geared);
        assert!(told.contains("give --blades 2 alone, in place of the gear (--gear or --order); if not"), "{told}");
        let by_blades = NoTone::NoSeries { only_rev_s: None, instead }.in_words(GivenFacts { gear: false, ..geared });
        assert!(
            by_blades.contains("if your rotor has 2 blades, give --blades 2; if not, check the number of blades"),
            "{by_blades}"
        );
        let other = said(Some((200.0, 400.0)));
        assert!(
            other.starts_with(
                "no rotor that fits the given facts is heard at 200 to 400 rev/s. But a rotor with 2 blades"
            ),
            "{other}"
        );
        assert!(said(None).starts_with(
            "no rotor that fits the given facts is heard. But a rotor with 2 blades may turn at 60.2 rev/s"
        ));
        assert!(
            other.contains("give --blades 2 alone, in place of the vehicle and the band; if not, check the"),
            "{other}"
        );
        let in_place = |given| blades_in_place(2, given);
        let bladed = GivenFacts { blades: true, ..GivenFacts::default() };
        assert_eq!(in_place(bladed), "give --blades 2");
        let geared = GivenFacts { gear: true, ..bladed };
        assert_eq!(in_place(geared), "give --blades 2 alone, in place of the gear (--gear or --order)");
        let nothing = NoTone::NoSeries { only_rev_s: Some((13.0, 120.0)), instead: None }.to_string();
        assert!(nothing.contains("check the given facts, or move the microphone nearer"), "{nothing}");
    }
}
