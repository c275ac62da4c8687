//! `cargo xtask bench labels`: which rotor is which, from logs of simulated flights. Writes a section of `docs/rotors.md`. Run by
//! people; its tests fly fewer.

mod flight;

use crate::accuracy::drawn;
use flight::{Flown, Logged};
use hovertone::{LabelsConfig, RotorLabels, TrackPoint, labels_from_log};
use hovertone_sim::scenario::{MotorWanderSection, ScenarioFile};

/// Rotors' constants within ±1 %, so speeds up to 1 % apart.
const SPREAD_SHARE: f64 = 0.01;

/// A random hover whose motors wander by that share, each for itself.
fn hover(seed: u64, duration_s: f64, wander_share: f64) -> ScenarioFile {
    let motor_wander = MotorWanderSection { gain_std_share: wander_share, ..MotorWanderSection::default() };
    let motor_wander = (wander_share > 0.0).then_some(motor_wander);
    ScenarioFile { motor_wander, ..ScenarioFile::random_hover(seed, duration_s, SPREAD_SHARE) }
}

/// How flights were labelled.
#[derive(Clone, Copy, Debug, Default)]
struct Count {
    flights: usize,
    /// All rotors labelled, and rightly.
    right: usize,
    /// Some rotors labelled wrongly.
    wrong: usize,
    /// Offsets further off than three of their standard uncertainties, of those that are told.
    offsets_off: usize,
}

impl Count {
    fn add(&mut self, labels: &RotorLabels, rotors: &[usize], offset_s: f64) {
        let is_right = |(label, rotor): (&Option<hovertone::RotorLabel>, &usize)| {
            label.as_ref().map(|label| label.number == rotor + 1)
        };
        let judged: Vec<Option<bool>> = labels.rotors.iter().zip(rotors).map(is_right).collect();
        self.flights += 1;
        self.right += usize::from(judged.iter().all(|label| *label == Some(true)));
        self.wrong += usize::from(judged.contains(&Some(false)));
        if let (Some(found_s), Some(std_s)) = (labels.offset_s, labels.offset_std_s) {
            self.offsets_off += usize::from((found_s - offset_s).abs() > 3.0 * std_s);
        }
    }
}

fn by_tracks(wander: f64, duration_s: f64, error_share: f64, logged: Logged, flights: usize) -> Result<Count, String> {
    let outcomes = drawn(flights, |seed| {
        let mut flown = Flown::of(hover(seed as u64, duration_s, wander), false)?;
        let (tracks, rotors) = flown.tracks(error_share);
        let (log, offset_s) = flown.log(logged)?;
        let tracks: Vec<&[TrackPoint]> = tracks.iter().map(Vec::as_slice).collect();
        let labels = labels_from_log(&tracks, 4, &log, &LabelsConfig::default());
        if std::env::var("SHOW").is_ok() {
            println!("wander {seed} {:.3?}", flown.wander());
        }
        Ok((labels, rotors, offset_s))
    })?;
    let mut count = Count::default();
    for (seed, (labels, rotors, offset_s)) in outcomes.iter().enumerate() {
        count.add(labels, rotors, *offset_s);
        if std::env::var("SHOW").is_ok() {
            let numbers: Vec<Option<usize>> =
                labels.rotors.iter().map(|label| label.as_ref().map(|label| label.number - 1)).collect();
            println!(
                "{seed} {rotors:?} {numbers:?} {:?} {:?} {:?} {:?} {:?}",
                labels.probability,
                labels.offset_s.map(|o| o - offset_s),
                labels.offset_std_s,
                labels.not_told,
                ScenarioFile::random_hover(seed as u64, duration_s, SPREAD_SHARE).vehicle.preset
            );
        }
    }
    Ok(count)
}

pub(crate) fn run(_root: &std::path::Path, options: &[&str]) -> Result<(), String> {
    let option = |name: &str| options.iter().position(|option| *option == name).and_then(|at| options.get(at + 1));
    let flights = option("--count").map_or(Ok(200), |text| text.parse::<usize>()).map_err(|error| error.to_string())?;
    for wander in [0.003, 0.001, 0.0] {
        for (logged, duration_s, error) in [
            (Logged::BodyRates, 5.0, 0.0003),
            (Logged::BodyRates, 5.0, 0.001),
            (Logged::BodyRates, 2.0, 0.0003),
            (Logged::BodyRates, 10.0, 0.001),
            (Logged::Commands, 5.0, 0.0003),
            (Logged::Speeds, 8.0, 0.0003),
        ] {
            println!(
                "{logged:?} {wander} {duration_s} {error} {:?}",
                by_tracks(wander, duration_s, error, logged, flights)?
            );
        }
    }
    Ok(())
}
