//! The folder of a demo: that it may be written to, its experiment file, its truth.

use super::render::{TrialTruth, folder_of_load};
use crate::failure::Failure;
use hovertone_sim::paper::{GRAVITY_M_S2, LOADS, ROTOR_COUNT, TONE_ORDER, TRIAL_S};
use std::fs;
use std::path::{Path, PathBuf};

/// First words of every experiment file that a demo writes: what may be overwritten.
const MARK: &str = "# Written by `hovertone demo`";
const EXPERIMENT: &str = "experiment.toml";

/// Makes the folder, and refuses one that holds anything but an earlier demo.
pub(super) fn prepare(folder: &Path) -> Result<(), Failure> {
    let is_empty = match fs::read_dir(folder) {
        Ok(mut entries) => entries.next().is_none(),
        Err(_) if folder.exists() => {
            return Err(Failure::failed("this is no folder that can be read", "choose another with -o DIR", folder));
        }
        Err(_) => true,
    };
    let is_demo = || fs::read_to_string(folder.join(EXPERIMENT)).is_ok_and(|text| text.starts_with(MARK));
    if !is_empty && !is_demo() {
        let what = "this folder is not empty, and what is in it is not an earlier demo: nothing was written";
        return Err(Failure::failed(what, "choose a new folder with -o DIR", folder));
    }
    fs::create_dir_all(folder).map_err(|error| Failure::cannot_write(&error, folder))
}

/// Writes the experiment file; gives back where it is.
pub(super) fn write_experiment(folder: &Path, seed: u64) -> Result<PathBuf, Failure> {
    let vehicle_kg = LOADS[0].mass_kg;
    let mut text = format!(
        "{MARK} (hovertone {version}, seed {seed}).
# The experiment of Pizetta, Brandao, Pizziolo and Sarcinelli-Filho with simulated sound. truth.csv has the truth.

[vehicle]
preset = \"ardrone\"
mass_kg = {vehicle_kg}           # ready to fly, without hull
gravity_m_s2 = {GRAVITY_M_S2:.2}       # behind the paper's numbers

[tone]
order = {TONE_ORDER}                # teeth of the rotor's gear wheel: the paper's n r
harmonics = 3

[samples]
length_s = 2.94           # five samples of a trial, 25 of a load, as in the paper; its 5 s would give two
overlap = 0.4
",
        version = env!("CARGO_PKG_VERSION"),
    );
    for load in &LOADS {
        text += &format!(
            "\n[[load]]\nname = \"{}\"\nadded_mass_kg = {:.3}\nrecordings = [\"{}/*.wav\"]\n",
            load.name,
            load.mass_kg - vehicle_kg,
            folder_of_load(load)
        );
    }
    let path = folder.join(EXPERIMENT);
    fs::write(&path, text).map_err(|error| Failure::cannot_write(&error, &path))?;
    Ok(path)
}

/// Writes `truth.csv`, a line for each trial, and `truth_tracks.csv`, the speed of every rotor at every row of the
/// truth.
pub(super) fn write_truth(folder: &Path, trials: &[TrialTruth]) -> Result<(), Failure> {
    write_csv(&folder.join("truth.csv"), |writer| {
        let rotors = (1..=ROTOR_COUNT).map(|rotor| format!("rotor_{rotor}_mean_speed_rev_s"));
        let head = ["load", "trial", "recording", "seed", "mass_kg"].map(str::to_owned).into_iter().chain(rotors);
        writer.write_record(
            head.chain(
                ["mean_sum_of_squares_rad2_s2", "thrust_constant_total_n_s2", "thrust_constant_per_rotor_n_s2"]
                    .map(str::to_owned),
            ),
        )?;
        for trial in trials {
            let (truth, mass_kg) = (&trial.truth, trial.load.mass_kg);
            let mut line = vec![
                trial.load.name.to_owned(),
                trial.number.to_string(),
                format!("{}/trial_{}.wav", folder_of_load(&trial.load), trial.number),
                trial.seed.to_string(),
                mass_kg.to_string(),
            ];
            let mean_rev_s = |rotor| truth.mean_speed(rotor, 0.0, TRIAL_S).map(|speed| speed.rev_s());
            line.extend((0..ROTOR_COUNT).map(|rotor| cell(mean_rev_s(rotor))));
            line.push(cell(trial.mean_sum_of_squares_rad2_s2()));
            line.push(cell(truth.thrust_constant_total_n_s2(mass_kg, GRAVITY_M_S2, 0.0, TRIAL_S)));
            line.push(cell(truth.thrust_constant_per_rotor_n_s2(mass_kg, GRAVITY_M_S2, 0.0, TRIAL_S)));
            writer.write_record(line)?;
        }
        Ok(())
    })?;
    write_csv(&folder.join("truth_tracks.csv"), |writer| {
        let rotors = (1..=ROTOR_COUNT).map(|rotor| format!("rotor_{rotor}_speed_rev_s"));
        writer.write_record(["load", "trial", "time_s"].map(str::to_owned).into_iter().chain(rotors))?;
        for trial in trials {
            for row in trial.truth.rows() {
                let mut line = vec![trial.load.name.to_owned(), trial.number.to_string(), format!("{:.4}", row.time_s)];
                line.extend(row.rotors.iter().map(|rotor| format!("{:.5}", rotor.speed_rev_s)));
                writer.write_record(line)?;
            }
        }
        Ok(())
    })
}

fn cell(number: Option<f64>) -> String {
    number.map_or(String::new(), |number| number.to_string())
}

fn write_csv(
    path: &Path,
    write: impl FnOnce(&mut csv::Writer<fs::File>) -> Result<(), csv::Error>,
) -> Result<(), Failure> {
    let cannot_write = |error: csv::Error| {
        Failure::failed(
            format!("cannot write: {error}"),
            "choose another place, or check your rights and the disk",
            path,
        )
    };
    let mut writer = csv::Writer::from_path(path).map_err(cannot_write)?;
    write(&mut writer).map_err(cannot_write)?;
    writer.flush().map_err(|error| Failure::cannot_write(&error, path))
}
