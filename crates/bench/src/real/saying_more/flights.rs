//! Random hovers, simulated by the program.

use super::super::program::Program;
use super::super::truth_track::TruthTrack;
use super::subject::Subject;
use crate::workspace::output_of;
use hovertone_sim::scenario::ScenarioFile;
use hovertone_vehicle::find_preset;
use std::fs;
use std::path::Path;
use std::process::Command;

/// The name of the set.
pub(super) const NAME: &str = "simulated";
const DURATION_S: f64 = 6.0;
/// Rotors' constants within ±1 %, so speeds up to 1 % apart.
const SPREAD_SHARE: f64 = 0.01;
/// Blades of a vehicle whose preset does not have them.
const BLADES_OF_MOST: u32 = 2;

/// Flies one hover in a folder.
pub(super) fn flown(program: &Program, folder: &Path, seed: u64) -> Result<Subject, String> {
    let failed = |error: std::io::Error| format!("{}: {error}", folder.display());
    fs::create_dir_all(folder).map_err(failed)?;
    let file = ScenarioFile::random_hover(seed, DURATION_S, SPREAD_SHARE);
    let (scenario, flown) = (folder.join("scenario.toml"), folder.join("flown"));
    fs::write(&scenario, toml::to_string(&file).map_err(|error| error.to_string())?).map_err(failed)?;
    let mut command = Command::new(program.path());
    output_of(command.arg("simulate").arg(&scenario).arg("-o").arg(&flown).args(["--no-progress", "--force"]))?;
    let preset = &file.vehicle.preset;
    let vehicle = find_preset(preset).ok_or_else(|| format!("there is no vehicle {preset}"))?;
    let track = TruthTrack::read_flight(&flown.join("truth.csv"))?;
    Ok(Subject {
        set: NAME,
        name: format!("{seed} ({preset})"),
        sound: flown.join("sound.wav"),
        blades: vehicle.blade_count.map_or(BLADES_OF_MOST, |blades| blades.value),
        rotors: track.rotor_count(),
        track,
        diameter_m: vehicle.propeller_diameter_m.map(|diameter| diameter.value),
        preset: Some(vehicle.id),
    })
}
