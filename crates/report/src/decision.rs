//! The decision for a shaft speed in words: how sure it is, and which speed was second.

use crate::number::significant;
use crate::recording::SpeedRecord;
use hovertone_analysis::{Outcome, Reading, RotorTone, RotorsHeard, WeighedSpeed};

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
    /// The second speed: "120.3 rev/s (2.0 %)".
    pub runner_up: String,
    /// All speeds that remain possible, most plausible first: "60.2 rev/s (62 %)"; empty where one is decided.
    pub possible: Vec<String>,
    /// What is heard of the rotors: "4 rotors separated".
    pub rotors: String,
}

/// A weighed speed, from the evidence or from the readings of a search.
struct Weighed {
    speed_rev_s: f64,
    plausibility: f64,
}

impl From<&WeighedSpeed> for Weighed {
    fn from(weighed: &WeighedSpeed) -> Self {
        let &WeighedSpeed { speed, plausibility } = weighed;
        Self { speed_rev_s: speed.rev_s(), plausibility }
    }
}

impl From<&Reading> for Weighed {
    fn from(reading: &Reading) -> Self {
        Self { speed_rev_s: reading.speed.rev_s(), plausibility: reading.plausibility }
    }
}

/// The decision for the shaft speed of a recording, or the most plausible speed where several remain possible; `None` without a rotor tone.
pub fn decision_in_words(record: &SpeedRecord) -> Option<DecisionWords> {
    let Outcome::Ok(tone) = &record.analysis()?.outcome else { return None };
    let chosen_rev_s = tone.speed(record.method)?.speed.rev_s();
    let all = all_weighed(record, tone);
    let is_chosen = |weighed: &&Weighed| (weighed.speed_rev_s / chosen_rev_s).ln().abs() < SAME_VEHICLE_SHARE;
    let chosen = all.iter().find(is_chosen);
    let second = all.iter().find(|weighed| !is_chosen(weighed));
    Some(DecisionWords {
        odds: odds_in_words(chosen, record.is_ambiguous()),
        runner_up: runner_up_in_words(second),
        possible: record
            .alternatives()
            .iter()
            .map(|reading| possible_in_words(reading, record.alternatives()))
            .collect(),
        rotors: rotors_in_words(record, tone),
    })
}

fn all_weighed(record: &SpeedRecord, tone: &RotorTone) -> Vec<Weighed> {
    let family = record.found.as_ref().and_then(|found| found.families.get(found.rotor?));
    let readings = family.map_or(&tone.alternatives, |family| &family.readings);
    let mut all: Vec<Weighed> = if readings.is_empty() {
        tone.weighed.iter().map(Weighed::from).collect()
    } else {
        readings.iter().filter(|reading| reading.plausibility > 0.0).map(Weighed::from).collect()
    };
    all.sort_by(|a, b| b.plausibility.total_cmp(&a.plausibility));
    all
}

fn odds_in_words(chosen: Option<&Weighed>, is_ambiguous: bool) -> String {
    match chosen {
        Some(Weighed { plausibility, speed_rev_s }) if is_ambiguous => {
            format!("not decided: {} rev/s, {}", significant(*speed_rev_s, DIGITS), odds(*plausibility))
        }
        Some(Weighed { plausibility, .. }) => odds(*plausibility),
        None => "no other speed was compared".to_owned(),
    }
}

/// "60.2 rev/s (62 %)", with the source of the tone where the readings differ in it.
fn possible_in_words(reading: &Reading, all: &[Reading]) -> String {
    let speed = significant(reading.speed.rev_s(), DIGITS);
    let meaning = if all.iter().any(|other| other.meaning.to_string() != reading.meaning.to_string()) {
        format!(", {}", reading.meaning)
    } else {
        String::new()
    };
    format!("{speed} rev/s ({:.1} %{meaning})", 100.0 * reading.plausibility)
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

fn runner_up_in_words(second: Option<&Weighed>) -> String {
    let Some(&Weighed { speed_rev_s, plausibility }) = second else {
        return "none: no other speed explains the sound".to_owned();
    };
    let speed = format!("{} rev/s", significant(speed_rev_s, DIGITS));
    if plausibility < 0.001 {
        format!("{speed} (below 0.1 %)")
    } else {
        format!("{speed} ({:.1} %)", 100.0 * plausibility)
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

    #[test]
    fn odds_and_runner_up_are_words() {
        for (share, words) in
            [(0.98, "odds 49 : 1"), (0.75, "odds 3.0 : 1"), (0.25, "odds 1 : 3.0"), (1.0, "odds above 1000 : 1")]
        {
            assert_eq!(odds(share), words);
        }
        let first = Weighed { speed_rev_s: 60.2, plausibility: 0.98 };
        let second = Weighed { speed_rev_s: 120.4, plausibility: 0.02 };
        assert_eq!(odds_in_words(Some(&first), false), "odds 49 : 1");
        assert_eq!(odds_in_words(Some(&first), true), "not decided: 60.20 rev/s, odds 49 : 1");
        assert_eq!(runner_up_in_words(Some(&second)), "120.4 rev/s (2.0 %)");
        assert_eq!(runner_up_in_words(None), "none: no other speed explains the sound");
    }
}
