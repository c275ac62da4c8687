//! What is heard now, in words and as JSON: the same for lines, screens and the page.

use hovertone::live::{Listener, LiveSpeed, LiveStatus, PossibleSpeed};
use hovertone_report::{LiveWords, Wording, counted, live_speed_in_words};
use hovertone_vehicle::RotorSpeed;
use serde::Serialize;

/// Sound that arrives has no parts to choose.
const LIVE: Wording = Wording::of_phrases(&[
    (", or choose a steady part with --from and --to", ""),
    ("; choose a longer or steadier part with --from and --to", ""),
    ("; if one of these tones is from a rotor, choose the part with this tone: --from and --to", ""),
]);

/// What the last review says, with advice that holds for sound as it arrives.
pub fn live_remark(listener: &Listener) -> String {
    LIVE.of(&listener.remark())
}

/// A live speed in words; `None` where no rotor is heard.
pub fn live_words(speed: &LiveSpeed) -> Option<LiveWords> {
    let (speed_rev_s, std_rev_s) = (speed.speed_rev_s?, speed.std_uncertainty_rev_s?);
    Some(live_speed_in_words(RotorSpeed::from_rev_s(speed_rev_s), std_rev_s))
}

/// The status of a live speed in words, empty where all is well; `remark` is that of the listener.
pub fn live_status_in_words(status: LiveStatus, remark: &str) -> String {
    match status {
        LiveStatus::Ok => remark.to_owned(),
        LiveStatus::Ambiguous if remark.is_empty() => "several speeds are possible".to_owned(),
        LiveStatus::Ambiguous => format!("several speeds are possible; {remark}"),
        LiveStatus::Listening => "listening".to_owned(),
        LiveStatus::NoRotorTone if remark.is_empty() => "no rotor tone".to_owned(),
        LiveStatus::NoRotorTone => format!("no rotor tone: {remark}"),
    }
}

/// One of several possible speeds in words.
pub fn possible_in_words(possible: &PossibleSpeed) -> String {
    let &PossibleSpeed { order, blades, speed_rev_s, belief } = possible;
    let tone = match blades {
        Some(blades) if order.lines_per_turn() == f64::from(blades) => counted(blades as usize, "blade"),
        _ => format!("order {order}"),
    };
    format!("{speed_rev_s:.1} rev/s, {tone}, probability {:.0} %", 100.0 * belief)
}

/// One line of `hovertone listen --json`.
#[derive(Serialize)]
pub struct LiveLine<'a> {
    #[serde(flatten)]
    speed: &'a LiveSpeed,
    rotors_rev_s: &'a [f64],
    possible_rev_s: Vec<f64>,
    remark: String,
}

impl<'a> LiveLine<'a> {
    /// A live speed, with what the last review says.
    pub fn new(speed: &'a LiveSpeed, listener: &'a Listener) -> Self {
        let possible_rev_s = listener.possible().iter().map(|possible| possible.speed_rev_s).collect();
        Self { speed, rotors_rev_s: listener.rotors_rev_s(), possible_rev_s, remark: live_remark(listener) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone::speed::NoTone;

    #[test]
    fn advice_about_live_sound_chooses_no_part() {
        for reason in [
            NoTone::NoSeries { only_rev_s: None, instead: None },
            NoTone::NoFrame { window_s: 0.1, hover_s: 3.0 },
            NoTone::NotHeld { tone_hz: 160.0, held_s: 1.0 },
        ] {
            let said = reason.to_string();
            assert!(said.contains("--from") && !LIVE.of(&said).contains("--"), "{said}");
        }
    }

    fn speed(speed_rev_s: Option<f64>, std_rev_s: f64) -> LiveSpeed {
        let status = if speed_rev_s.is_some() { LiveStatus::Ok } else { LiveStatus::NoRotorTone };
        let std_uncertainty_rev_s = speed_rev_s.map(|_| std_rev_s);
        LiveSpeed { time_s: 1.0, status, speed_rev_s, std_uncertainty_rev_s, level_db: -18.0, clipped_share: 0.0 }
    }

    #[test]
    fn a_speed_has_two_figures_of_its_uncertainty() {
        let words = live_words(&speed(Some(318.7213), 0.07)).unwrap();
        assert_eq!([words.speed_rev_s, words.plus_minus_rev_s], ["318.72", "0.14"]);
        assert_eq!([words.plus_minus_percent, words.speed_rpm], ["0.044", "19123.3"]);
        assert_eq!(live_words(&speed(Some(318.7213), 11.5)).unwrap().speed_rev_s, "319");
        assert_eq!(live_words(&speed(None, 0.0)), None);
    }
}
