//! `cargo run --release -p hovertone-bench -- labels`: which rotor is which, from logs and several microphones of simulated flights, and
//! from the start of the motors. Writes a section of `docs/rotors.md`. Run by people; its tests fly fewer.

mod flight;
mod microphones;
mod spin_up;

use crate::accuracy::drawn;
use crate::rotors_report::{LABELS_TITLE, REPORT, labels_section};
use flight::{Flown, Logged};
use hovertone::rotors::{LabelsConfig, RotorLabels, labels_from_log};
use hovertone::sound::Signal;
use hovertone::speed::{Config, Method, Outcome, RotorEstimate, ToneConfig, TrackPoint, speed_from_source};
use hovertone_sim::scenario::{MicrophoneSection, MotorWanderSection, ScenarioFile, SoundSection, SpreadSection};
use hovertone_vehicle::Order;
use spin_up::{Start, by_spin_up};
use std::fs;
use std::path::Path;

/// Flights of each kind, and those that are heard, unless the options say otherwise.
const FLIGHTS: usize = 200;
const HEARD: usize = 20;
/// Recordings of each kind that begin with the motors' start.
const STARTED: usize = 20;
/// Rotors' constants within ±1 %, so speeds up to 1 % apart.
const SPREAD_SHARE: f64 = 0.01;
const DURATION_S: f64 = 5.0;
/// Of the rotors' constants of those that are heard, as standard deviations: real rotors lie 13 to 22 % apart from slowest to fastest, and
/// rotors that cross all the time are confused.
const FAR_APART_SHARE: f64 = 0.06;
const NEAR_SHARE: f64 = 0.015;
const TITLE_OF_STARTS: &str = "\n### By the motors' start\n";

/// What is flown and logged.
#[derive(Clone, Copy)]
struct Kind {
    logged: Logged,
    duration_s: f64,
    /// Of each motor's gain; speeds wander by two thirds of it.
    wander_share: f64,
    /// Of each point of a track.
    error_share: f64,
}

/// The flights of the claim.
const CLAIMED: Kind =
    Kind { logged: Logged::BodyRates, duration_s: DURATION_S, wander_share: 0.003, error_share: 0.0003 };

fn kinds() -> Vec<Kind> {
    let rates = |duration_s, wander_share, error_share| Kind { duration_s, wander_share, error_share, ..CLAIMED };
    let motors = |logged, wander_share| Kind { logged, wander_share, ..CLAIMED };
    let longer = |kind: Kind| Kind { duration_s: 10.0, ..kind };
    vec![
        CLAIMED,
        rates(5.0, 0.003, 0.001),
        rates(2.0, 0.003, 0.0003),
        rates(10.0, 0.003, 0.001),
        rates(5.0, 0.001, 0.0003),
        rates(5.0, 0.0, 0.0003),
        motors(Logged::Speeds, 0.003),
        motors(Logged::Speeds, 0.0),
        motors(Logged::Commands, 0.003),
        longer(motors(Logged::Commands, 0.003)),
    ]
}

/// How flights were labelled.
#[derive(Clone, Copy, Debug, Default)]
struct Count {
    flights: usize,
    /// All rotors labelled, and rightly.
    right: usize,
    /// Some rotors labelled wrongly.
    wrong: usize,
    /// Flights whose offset is told, and those in which it is off by more than three of its standard uncertainties.
    offsets: usize,
    offsets_off: usize,
}

impl Count {
    fn add(&mut self, labels: &RotorLabels, rotors: &[usize], offset_s: f64) {
        let judged: Vec<Option<bool>> = labels
            .rotors
            .iter()
            .zip(rotors)
            .map(|(label, rotor)| label.as_ref().map(|label| label.number == rotor + 1))
            .collect();
        self.flights += 1;
        self.right += usize::from(judged.iter().all(|label| *label == Some(true)));
        self.wrong += usize::from(judged.contains(&Some(false)));
        if let (Some(found_s), Some(std_s)) = (labels.offset_s, labels.offset_std_s) {
            self.offsets += 1;
            self.offsets_off += usize::from((found_s - offset_s).abs() > 3.0 * std_s);
        }
    }
}

/// A random hover whose motors wander independently.
fn hover(seed: u64, kind: &Kind) -> ScenarioFile {
    let motor_wander = MotorWanderSection { gain_std_share: kind.wander_share, ..MotorWanderSection::default() };
    let motor_wander = (kind.wander_share > 0.0).then_some(motor_wander);
    ScenarioFile { motor_wander, ..ScenarioFile::random_hover(seed, kind.duration_s, SPREAD_SHARE) }
}

/// Labels tracks that are the truth with an error of their own.
fn by_tracks(kind: &Kind, flights: usize) -> Result<Count, String> {
    let outcomes = drawn(flights, |seed| {
        let mut flown = Flown::of(hover(seed as u64, kind), false)?;
        let (tracks, rotors) = flown.tracks(kind.error_share);
        let (log, offset_s) = flown.log(kind.logged)?;
        let tracks: Vec<&[TrackPoint]> = tracks.iter().map(Vec::as_slice).collect();
        Ok((labels_from_log(&tracks, 4, &log, &LabelsConfig::default()), rotors, offset_s))
    })?;
    let mut count = Count::default();
    outcomes.iter().for_each(|(labels, rotors, offset_s)| count.add(labels, rotors, *offset_s));
    Ok(count)
}

/// An AR.Drone over open ground and a microphone on a stand.
fn heard_hover(seed: u64, thrust_std_share: f64) -> ScenarioFile {
    let microphone = MicrophoneSection::at([-1.2, 0.5, 1.3]);
    ScenarioFile {
        seed,
        duration_s: Some(DURATION_S),
        spread: Some(SpreadSection { thrust_std_share, ..SpreadSection::default() }),
        motor_wander: Some(MotorWanderSection::default()),
        sound: SoundSection { tone_level_db_spl: 65.0, ..SoundSection::default() },
        microphones: vec![microphone],
        ..ScenarioFile::default()
    }
}

/// The rotors of an AR.Drone that the separation tells apart; nothing where there is no tone.
fn separated(samples: Vec<f32>, sample_rate_hz: f64) -> Result<Option<Vec<RotorEstimate>>, String> {
    let mut tone = ToneConfig::of_order(Order::new(69.0).map_err(|error| error.to_string())?);
    tone.blades = Some(2);
    let mut config = Config::for_tone(tone);
    (config.rotors.count, config.method) = (4, Method::Separated);
    let mut signal = Signal::new(samples, sample_rate_hz);
    let analysis = speed_from_source(&mut signal, &config, &mut |_| {}).map_err(|error| error.to_string())?;
    match analysis.outcome {
        Outcome::Ok(tone) => Ok(Some(tone.rotors)),
        Outcome::NoRotorTone { .. } => Ok(None),
    }
}

/// Labels what the separation makes of the sound; with how many flights had four rotors told apart.
fn by_sound(flights: usize, thrust_std_share: f64) -> Result<(Count, usize), String> {
    let outcomes = drawn(flights, |seed| {
        let mut flown = Flown::of(heard_hover(seed as u64 + 1, thrust_std_share), true)?;
        let (samples, sample_rate_hz) = flown.sound().ok_or("nobody heard it".to_owned())?;
        let (log, offset_s) = flown.log(Logged::BodyRates)?;
        let Some(rotors) = separated(samples, sample_rate_hz)? else { return Ok(None) };
        let tracks: Vec<&[TrackPoint]> = rotors.iter().map(|rotor| rotor.track.as_slice()).collect();
        let rotors: Vec<usize> = tracks.iter().map(|track| flown.rotor_of(track)).collect();
        Ok(Some((labels_from_log(&tracks, 4, &log, &LabelsConfig::default()), rotors, offset_s)))
    })?;
    let (mut count, mut apart) = (Count { flights: 0, ..Count::default() }, 0);
    for outcome in &outcomes {
        match outcome {
            Some((labels, rotors, offset_s)) if rotors.len() == 4 => {
                apart += 1;
                count.add(labels, rotors, *offset_s);
            }
            _ => count.flights += 1,
        }
    }
    Ok((count, apart))
}

pub(crate) fn run(root: &Path, options: &[&str]) -> Result<(), String> {
    let given = |name: &str| options.iter().position(|option| *option == name).and_then(|at| options.get(at + 1));
    let option = |name: &str, otherwise: usize| {
        given(name).map_or(Ok(otherwise), |text| text.parse::<usize>().map_err(|error| format!("{name}: {error}")))
    };
    let report = root.join(REPORT);
    let before = fs::read_to_string(&report).map_err(|error| format!("{REPORT}: {error}"))?;
    let section = labels_section(&before);
    let only = given("--only").copied();
    if let Some(other) = only.filter(|only| !PARTS.iter().any(|(name, ..)| name == only)) {
        return Err(format!("--only {other}: there are {}", PARTS.map(|(name, ..)| name).join(", ")));
    }
    let mut text = before.strip_suffix(section).unwrap_or(&before).to_owned();
    for (name, title, written) in PARTS {
        let is_wanted = only.is_none_or(|only| only == name);
        text += &if is_wanted { written(&option)? } else { part_of(section, title).to_owned() };
    }
    fs::write(&report, text).map_err(|error| format!("{REPORT}: {error}"))?;
    println!("written: {REPORT}");
    Ok(())
}

/// What the numbers of options are, or else.
type Counts<'a> = &'a dyn Fn(&str, usize) -> Result<usize, String>;

/// A part of the section: by what `--only` calls it, its title, and what writes it.
type Part = (&'static str, &'static str, fn(Counts<'_>) -> Result<String, String>);

const PARTS: [Part; 3] = [
    ("logs", LABELS_TITLE, by_logs),
    ("microphones", microphones::TITLE, microphones::section),
    ("starts", TITLE_OF_STARTS, by_starts),
];

/// A part as it stands in the section, to the title of another.
fn part_of<'a>(section: &'a str, title: &str) -> &'a str {
    let Some(from) = section.find(title) else { return "" };
    let ends = PARTS.iter().filter_map(|(_, other, _)| section.find(other)).filter(|&end| end > from);
    &section[from..ends.min().unwrap_or(section.len())]
}

/// By logs: tracks that are the truth with an error, and those of the sound.
fn by_logs(option: Counts<'_>) -> Result<String, String> {
    let (flights, heard) = (option("--count", FLIGHTS)?, option("--heard", HEARD)?);
    let mut text = LABELS_TITLE.to_owned() + &HEAD.replace("{flights}", &flights.to_string());
    for kind in kinds() {
        let count = by_tracks(&kind, flights)?;
        let row = row_of(&kind, &count);
        print!("{row}");
        text += &row;
    }
    text +=
        "\nThe whole way from the sound, an AR.Drone and a microphone 1.3 m away, body rates as in the first row:\n\n";
    for thrust_std_share in [FAR_APART_SHARE, NEAR_SHARE] {
        let (count, apart) = by_sound(heard, thrust_std_share)?;
        let words = format!(
            "- rotors whose speeds scatter by {:.1} %: of {} flights of {DURATION_S} s {apart} have four separated rotors; all rotors \
             are labelled rightly in {}, some wrongly in {}.\n",
            50.0 * thrust_std_share,
            count.flights,
            count.right,
            count.wrong
        );
        print!("{words}");
        text += &words;
    }
    Ok(text)
}

/// By the order in which motors were started.
fn by_starts(option: Counts<'_>) -> Result<String, String> {
    let started = option("--started", STARTED)?;
    let mut text = TITLE_OF_STARTS.to_owned() + &HEAD_OF_STARTS.replace("{started}", &started.to_string());
    for (start, words) in Start::ALL {
        let count = by_spin_up(start, started)?;
        let not_told = count.flights - count.right - count.wrong;
        let row = format!("| {words} | {} | {} | {not_told} |\n", count.right, count.wrong);
        print!("{row}");
        text += &row;
    }
    Ok(text)
}

const HEAD: &str = "
Made by `cargo run --release -p hovertone-bench -- labels`. Each row: {flights} simulated hovers of four kinds of drone (`ScenarioFile::random_hover`), in
which each motor's gain wanders independently (0.4 s), so that speeds wander by two thirds of that; rotors up to 1 % apart. Tracks are
the true speeds every 0.04 s with a white error, in the order of speed; the log's clock is off by up to 100 s, which is found by
itself. Body rates at 20 Hz with 0.02 rad/s of noise; speeds at 3 Hz in steps of 0.5 rad/s; commands at 10 Hz in steps of a
thousandth of the battery's voltage, which know nothing of the motors' wander.

- right: all four rotors labelled, and rightly (in brackets: the aim). wrong: a label that is not so. The rest is \"not told\",
  in part or in all.
- offset: flights in which it is within three of its standard uncertainties, of those in which it is told.

| log | length, s | wander of the gains, % | error of the tracks, % | right | wrong | offset |
|---|---|---|---|---|---|---|
";

const HEAD_OF_STARTS: &str = "
Made by `cargo run --release -p hovertone-bench -- labels --only starts`. By the order in which the motors were started (`--spin-up`), {started}
recordings of 16 s each: four rotors of two blades, 1.5 to 4 % apart, that wander by 0.1 % (0.6 s), levels that differ by 3 dB, in
white noise. Unless the table says otherwise motors start 0.9 to 2 s apart, straight to within 1.3 % of the hover's speed, to which
all go together (within about half a second) 1.4 to 2.5 s after the last start. right: all four rotors labelled, and rightly.

| start | right | wrong | not told |
|---|---|---|---|
";

fn row_of(kind: &Kind, count: &Count) -> String {
    let is_claimed = kind.logged == CLAIMED.logged && kind.wander_share == CLAIMED.wander_share;
    format!(
        "| {} | {} | {:.1} | {:.2} | {:.3}{} | {:.3} | {} of {} |\n",
        match kind.logged {
            Logged::BodyRates => "body rates",
            Logged::Speeds => "speeds",
            Logged::Commands => "commands",
        },
        kind.duration_s,
        100.0 * kind.wander_share,
        100.0 * kind.error_share,
        count.right as f64 / count.flights as f64,
        if is_claimed && kind.duration_s == DURATION_S { " (≥ 0.95)" } else { "" },
        count.wrong as f64 / count.flights as f64,
        count.offsets - count.offsets_off,
        count.offsets,
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What is claimed: 95 % of flights of 5 s rightly labelled from a gyro of 0.02 rad/s at 20 Hz, by tracks as good as the
    /// separation's and three times worse. Of 60 flights at a true 97 %, 95 % or more are right with a probability of 0.89.
    #[test]
    fn body_rates_label_the_rotors_of_short_flights() {
        for error_share in [0.0003, 0.001] {
            let count = by_tracks(&Kind { error_share, ..CLAIMED }, 60).unwrap();
            assert!(count.flights == 60 && 100 * count.right >= 95 * count.flights, "{count:?}");
            assert_eq!(count.wrong, 0, "{count:?}");
            assert!(count.offsets >= count.right && count.offsets_off <= 3, "{count:?}");
        }
    }

    /// Where next to nothing moves, nothing is known, and nothing is to be said.
    #[test]
    fn a_flight_in_which_nothing_moves_is_not_labelled_wrongly() {
        for logged in [Logged::BodyRates, Logged::Commands, Logged::Speeds] {
            let count = by_tracks(&Kind { logged, wander_share: 0.0, ..CLAIMED }, 40).unwrap();
            assert_eq!((count.flights, count.wrong), (40, 0), "{count:?}");
            assert!(count.right < 40, "{count:?}");
        }
    }

    /// The log of another flight says nothing, however lively both are.
    #[test]
    fn the_log_of_another_flight_is_refused() {
        for logged in [Logged::BodyRates, Logged::Commands] {
            let outcomes = drawn(30, |seed| {
                let mut flown = Flown::of(hover(seed as u64, &CLAIMED), false)?;
                let mut other = Flown::of(hover(seed as u64 + 1000, &CLAIMED), false)?;
                let (tracks, _) = flown.tracks(0.0003);
                let (log, _) = other.log(logged)?;
                let tracks: Vec<&[TrackPoint]> = tracks.iter().map(Vec::as_slice).collect();
                Ok(labels_from_log(&tracks, 4, &log, &LabelsConfig::default()))
            });
            for labels in outcomes.unwrap() {
                assert!(labels.rotors.iter().all(Option::is_none) && labels.not_told.is_some(), "{labels:?}");
            }
        }
    }

    /// From the sound to the names.
    #[test]
    fn heard_flights_are_labelled() {
        let (count, apart) = by_sound(3, FAR_APART_SHARE).unwrap();
        assert!(apart >= 2 && count.right >= 2 && count.wrong == 0, "{apart} {count:?}");
    }

    #[test]
    fn a_section_is_found_and_kept() {
        let report = format!("# a\n\n| b |\n{LABELS_TITLE}\nc\n");
        assert_eq!(labels_section(&report), format!("{LABELS_TITLE}\nc\n"));
        assert_eq!(labels_section("# a\n"), "");
        let both = format!("{report}{TITLE_OF_STARTS}\nd\n");
        assert_eq!(part_of(&both, LABELS_TITLE), format!("{LABELS_TITLE}\nc\n"));
        assert_eq!(part_of(&both, TITLE_OF_STARTS), format!("{TITLE_OF_STARTS}\nd\n"));
        assert_eq!(part_of("# a\n", LABELS_TITLE), "");
    }
}
