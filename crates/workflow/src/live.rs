//! What is heard now, in words and as JSON: the same for lines, screens and the page.

use hovertone::live::{Listener, LiveSpeed, LiveStatus, PossibleSpeed};
use hovertone_report::{LiveWords, Wording, counted, live_speed_in_words, significant};
use hovertone_vehicle::RotorSpeed;
use serde::Serialize;

/// Digits of a speed without a ±.
const DIGITS: usize = 3;

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
    format!("{speed_rev_s:.1} rev/s, {tone}, plausibility {:.0} %", 100.0 * belief)
}

/// "42.4 or 84.7 rev/s", the most probable first; `None` where there are not two different speeds.
///
/// The possible speeds are those of the last review. They have changed since then as the speed that is followed.
pub fn possible_speeds_in_words(possible: &[PossibleSpeed], followed_rev_s: Option<f64>) -> Option<String> {
    let change = followed_rev_s.and_then(|followed_rev_s| {
        let at_review = possible.iter().find(|one| one.is_same(followed_rev_s))?;
        Some(followed_rev_s / at_review.speed_rev_s)
    });
    let mut speeds_rev_s: Vec<f64> = Vec::new();
    for one in possible {
        if !speeds_rev_s.iter().any(|&speed_rev_s| one.is_same(speed_rev_s)) {
            speeds_rev_s.push(one.speed_rev_s);
        }
    }
    let [first, second, others @ ..] = speeds_rev_s.as_slice() else { return None };
    let in_words = |speed_rev_s: &f64| significant(change.unwrap_or(1.0) * speed_rev_s, DIGITS);
    let others: Vec<String> = others.iter().map(in_words).collect();
    let less_probable =
        if others.is_empty() { String::new() } else { format!(" (less probable: {})", others.join(", ")) };
    Some(format!("{} or {} rev/s{less_probable}", in_words(first), in_words(second)))
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
        let mut possible_rev_s: Vec<f64> = listener.possible().iter().map(|possible| possible.speed_rev_s).collect();
        // the rotors may be lost since
        if speed.status == LiveStatus::Ambiguous && possible_rev_s.is_empty() {
            possible_rev_s.extend(speed.speed_rev_s);
        }
        Self { speed, rotors_rev_s: listener.rotors_rev_s(), possible_rev_s, remark: live_remark(listener) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone::speed::NoTone;
    use hovertone_vehicle::Order;

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

    #[test]
    fn each_possible_speed_is_named_once_and_the_most_probable_first() {
        let possible = |speeds_rev_s: &[f64], followed_rev_s: Option<f64>| {
            let order = Order::from_blades(2).unwrap();
            let one = |&speed_rev_s: &f64| PossibleSpeed { order, blades: Some(2), speed_rev_s, belief: 0.3 };
            possible_speeds_in_words(&speeds_rev_s.iter().map(one).collect::<Vec<_>>(), followed_rev_s)
        };
        assert_eq!(possible(&[42.37, 84.73, 42.36], None).unwrap(), "42.4 or 84.7 rev/s");
        assert_eq!(possible(&[42.0, 84.0], Some(86.0)).unwrap(), "43.0 or 86.0 rev/s");
        let more = possible(&[310.1, 155.0, 103.4, 77.5], None).unwrap();
        assert_eq!(more, "310 or 155 rev/s (less probable: 103, 77.5)");
        assert_eq!(possible(&[42.37, 42.36], None), None);
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
