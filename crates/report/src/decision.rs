//! The decision for a shaft speed in words: how sure it is, and which speed was second.

use crate::number::significant;
use crate::recording::SpeedRecord;
use hovertone_analysis::{Outcome, RotorTone, RotorsHeard, WeighedSpeed};

/// Digits of a speed whose uncertainty stands elsewhere.
const DIGITS: usize = 4;
/// Odds above this are printed as "more than".
const ODDS_MAX: f64 = 1000.0;
/// Speeds of rotors of one vehicle differ by less.
const SAME_VEHICLE_SHARE: f64 = 0.25;

/// The decision for a shaft speed.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct DecisionWords {
    /// Why this speed: "odds 49 : 1".
    pub odds: String,
    /// The second speed: "120.3 rev/s (2 %)".
    pub runner_up: String,
    /// What is heard of the rotors: "4 rotors separated".
    pub rotors: String,
}

/// A weighed speed, from the evidence or from the readings of a search.
struct Weighed {
    speed_rev_s: f64,
    plausibility: Option<f64>,
    lines_db: Option<f64>,
}

impl From<&WeighedSpeed> for Weighed {
    fn from(weighed: &WeighedSpeed) -> Self {
        let &WeighedSpeed { speed, plausibility, lines_db } = weighed;
        Self { speed_rev_s: speed.rev_s(), plausibility, lines_db }
    }
}

/// The decision for the shaft speed of a recording; `None` without a rotor tone.
pub fn decision_in_words(record: &SpeedRecord) -> Option<DecisionWords> {
    let Outcome::Ok(tone) = &record.analysis()?.outcome else { return None };
    let chosen_rev_s = tone.speed(record.method)?.speed.rev_s();
    let all = all_weighed(record, tone);
    let is_chosen = |weighed: &&Weighed| (weighed.speed_rev_s / chosen_rev_s).ln().abs() < SAME_VEHICLE_SHARE;
    let chosen = all.iter().find(is_chosen);
    let second = all.iter().find(|weighed| !is_chosen(weighed));
    Some(DecisionWords {
        odds: odds_in_words(chosen, record.is_ambiguous()),
        runner_up: runner_up_in_words(second, chosen),
        rotors: rotors_in_words(record, tone),
    })
}

fn all_weighed(record: &SpeedRecord, tone: &RotorTone) -> Vec<Weighed> {
    let family = record.found.as_ref().and_then(|found| found.families.get(found.rotor?));
    let mut all: Vec<Weighed> = match family {
        Some(family) => family
            .readings
            .iter()
            .filter(|reading| reading.plausibility > 0.0)
            .map(|reading| Weighed {
                speed_rev_s: reading.speed.rev_s(),
                plausibility: Some(reading.plausibility),
                lines_db: None,
            })
            .collect(),
        None => tone.weighed.iter().map(Weighed::from).collect(),
    };
    let rank = |weighed: &Weighed| weighed.plausibility.or(weighed.lines_db).unwrap_or(0.0);
    all.sort_by(|a, b| rank(b).total_cmp(&rank(a)));
    all
}

fn odds_in_words(chosen: Option<&Weighed>, is_ambiguous: bool) -> String {
    match chosen {
        Some(Weighed { plausibility: Some(share), .. }) if is_ambiguous => {
            format!("not decided: {:.0} % plausible", 100.0 * share)
        }
        Some(Weighed { plausibility: Some(share), .. }) => odds(*share),
        Some(Weighed { lines_db: Some(db), .. }) => format!("by its lines: {db:.1} dB over their surroundings"),
        _ => "no other speed was weighed".to_owned(),
    }
}

/// "odds 49 : 1".
fn odds(share: f64) -> String {
    let odds = share / (1.0 - share);
    match odds {
        odds if odds > ODDS_MAX => format!("odds above {ODDS_MAX:.0} : 1"),
        odds if odds >= 10.0 => format!("odds {odds:.0} : 1"),
        odds if odds >= 1.0 => format!("odds {odds:.1} : 1"),
        odds => format!("odds 1 : {:.1}", 1.0 / odds),
    }
}

fn runner_up_in_words(second: Option<&Weighed>, chosen: Option<&Weighed>) -> String {
    let Some(second) = second else { return "none: no other speed explains the lines".to_owned() };
    let speed = format!("{} rev/s", significant(second.speed_rev_s, DIGITS));
    match (second.plausibility, second.lines_db, chosen.and_then(|chosen| chosen.lines_db)) {
        (Some(share), ..) if share < 0.001 => format!("{speed} (below 0.1 %)"),
        (Some(share), ..) => format!("{speed} ({:.1} %)", 100.0 * share),
        (None, Some(db), Some(_)) => format!("{speed}, whose lines have {db:.1} dB"),
        _ => speed,
    }
}

fn rotors_in_words(record: &SpeedRecord, tone: &RotorTone) -> String {
    match (tone.rotors_heard(record.method), tone.rotors.len()) {
        (Some(RotorsHeard::Separated), count) => format!("{count} rotors separated"),
        (Some(RotorsHeard::Group), _) => "rotors heard as a group".to_owned(),
        (Some(RotorsHeard::OneTone), _) => "one tone for all rotors".to_owned(),
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn weighed(speed_rev_s: f64, plausibility: Option<f64>, lines_db: Option<f64>) -> Weighed {
        Weighed { speed_rev_s, plausibility, lines_db }
    }

    #[test]
    fn odds_and_runner_up_are_words() {
        for (share, words) in
            [(0.98, "odds 49 : 1"), (0.75, "odds 3.0 : 1"), (0.25, "odds 1 : 3.0"), (1.0, "odds above 1000 : 1")]
        {
            assert_eq!(odds(share), words);
        }
        let (first, second) = (weighed(60.2, Some(0.98), None), weighed(120.4, Some(0.02), None));
        assert_eq!(odds_in_words(Some(&first), true), "not decided: 98 % plausible");
        assert_eq!(runner_up_in_words(Some(&second), Some(&first)), "120.4 rev/s (2.0 %)");
        assert_eq!(runner_up_in_words(None, Some(&first)), "none: no other speed explains the lines");
    }

    #[test]
    fn a_gear_mesh_is_decided_by_its_lines() {
        let (first, second) = (weighed(60.2, None, Some(18.24)), weighed(31.0, None, Some(3.1)));
        assert_eq!(odds_in_words(Some(&first), false), "by its lines: 18.2 dB over their surroundings");
        assert_eq!(runner_up_in_words(Some(&second), Some(&first)), "31.00 rev/s, whose lines have 3.1 dB");
    }
}
