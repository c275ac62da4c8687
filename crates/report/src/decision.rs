//! The decision for a shaft speed in words: how sure it is, and which speed was second.

use crate::number::significant;
use crate::recording::SpeedRecord;
use hovertone_analysis::{Outcome, Reading, RotorTone, RotorsHeard, WeighedSpeed};
use hovertone_vehicle::LineLevels;
use statrs::distribution::{ContinuousCDF, Normal};

/// Digits of a speed whose uncertainty stands elsewhere.
const DIGITS: usize = 4;
/// Odds above this are printed as "more than".
const ODDS_MAX: f64 = 1000.0;
/// Speeds of rotors of one vehicle differ by less.
const SAME_VEHICLE_SHARE: f64 = 0.25;

/// Weights of the lines in the level of a gear mesh, h^−½ for harmonic h: the fewest lines by which a speed without plausibility is weighed.
const MESH_WEIGHTS: [f64; 3] = [1.0, std::f64::consts::FRAC_1_SQRT_2, 0.577_350_269_189_625_8];

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
    plausibility: Option<f64>,
    lines_db: Option<f64>,
}

impl From<&WeighedSpeed> for Weighed {
    fn from(weighed: &WeighedSpeed) -> Self {
        let &WeighedSpeed { speed, plausibility, lines_db } = weighed;
        Self { speed_rev_s: speed.rev_s(), plausibility, lines_db }
    }
}

impl From<&Reading> for Weighed {
    fn from(reading: &Reading) -> Self {
        Self { speed_rev_s: reading.speed.rev_s(), plausibility: Some(reading.plausibility), lines_db: None }
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
        odds: odds_in_words(chosen, second, record.is_ambiguous()),
        runner_up: runner_up_in_words(second, chosen),
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
    let rank = |weighed: &Weighed| weighed.plausibility.or(weighed.lines_db).unwrap_or(0.0);
    all.sort_by(|a, b| rank(b).total_cmp(&rank(a)));
    all
}

fn odds_in_words(chosen: Option<&Weighed>, second: Option<&Weighed>, is_ambiguous: bool) -> String {
    match chosen {
        Some(Weighed { plausibility: Some(share), speed_rev_s, .. }) if is_ambiguous => {
            format!("not decided: {} rev/s, {}", significant(*speed_rev_s, DIGITS), odds(*share))
        }
        Some(Weighed { plausibility: Some(share), .. }) => odds(*share),
        Some(Weighed { lines_db: Some(db), .. }) => match second.and_then(|second| second.lines_db) {
            Some(second_db) => format!("{} (lines of {db:.1} dB)", odds(share_by_lines(db - second_db))),
            None => format!("by its lines: {db:.1} dB over their surroundings"),
        },
        _ => "no other speed was weighed".to_owned(),
    }
}

/// Probability that the lines of one speed are the louder ones by their mean level, where they are louder by this: the levels of lines
/// scatter with σ = [`line_std_db`](LineLevels::line_std_db), or more in some recordings ([`SCATTERS`](LineLevels::SCATTERS)). The difference
/// of two mean levels with the weights w scatters with σ √(2 Σw²) / Σw. More lines than those of a gear mesh scatter less: with a blade pass
/// as well the probability is too small.
fn share_by_lines(louder_db: f64) -> f64 {
    let sum = |power: i32| MESH_WEIGHTS.iter().map(|weight| weight.powi(power)).sum::<f64>();
    let std_db = LineLevels::default().line_std_db * (2.0 * sum(2)).sqrt() / sum(1);
    let normal = Normal::standard();
    LineLevels::SCATTERS.iter().map(|(times, share)| share * normal.cdf(louder_db / (times * std_db))).sum()
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

fn runner_up_in_words(second: Option<&Weighed>, chosen: Option<&Weighed>) -> String {
    let Some(second) = second else { return "none: no other speed explains the lines".to_owned() };
    let speed = format!("{} rev/s", significant(second.speed_rev_s, DIGITS));
    match (second.plausibility, second.lines_db, chosen.and_then(|chosen| chosen.lines_db)) {
        (Some(share), ..) if share < 0.001 => format!("{speed} (below 0.1 %)"),
        (Some(share), ..) => format!("{speed} ({:.1} %)", 100.0 * share),
        (None, Some(db), Some(_)) => format!("{speed} (lines of {db:.1} dB)"),
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
        assert_eq!(odds_in_words(Some(&first), Some(&second), false), "odds 49 : 1");
        assert_eq!(odds_in_words(Some(&first), Some(&second), true), "not decided: 60.20 rev/s, odds 49 : 1");
        assert_eq!(runner_up_in_words(Some(&second), Some(&first)), "120.4 rev/s (2.0 %)");
        assert_eq!(runner_up_in_words(None, Some(&first)), "none: no other speed explains the lines");
    }

    #[test]
    fn a_gear_mesh_is_decided_by_its_lines_with_odds() {
        let (first, second) = (weighed(60.2, None, Some(14.84)), weighed(31.0, None, Some(8.6)));
        let words = odds_in_words(Some(&first), Some(&second), false);
        assert_eq!(words, "odds 28 : 1 (lines of 14.8 dB)");
        assert_eq!(odds_in_words(Some(&first), None, false), "by its lines: 14.8 dB over their surroundings");
        assert_eq!(runner_up_in_words(Some(&second), Some(&first)), "31.00 rev/s (lines of 8.6 dB)");
        assert!((share_by_lines(0.0) - 0.5).abs() < 1e-12);
        assert!(share_by_lines(3.0) < share_by_lines(6.0) && share_by_lines(40.0) > 0.9999);
    }
}
