//! The folder of a demo: its check, its experiment file, its truth.

use super::render::{TrialTruth, folder_of_load, recording_of, trials};
use crate::failure::Failure;
use crate::output_folder::{FolderContent, OutputFolder};
use crate::outputs::Outputs;
use crate::report_folder::RESULTS;
use hovertone_sim::paper::{GRAVITY_M_S2, LOADS, ROTOR_COUNT, TONE_ORDER};
use hovertone_vehicle::RotorSpeed;
use std::path::{Path, PathBuf};

const EXPERIMENT: &str = "experiment.toml";
const TRUTH: &str = "truth.csv";
const TRACKS: &str = "truth_tracks.csv";

/// Makes the folder. A folder with other files than those of an earlier demo is refused, and so is one in which a file of the demo was
/// changed, such as a recording that was replaced by the user's own.
pub(super) fn prepare(path: &Path, force: bool) -> Result<OutputFolder, Failure> {
    let nothing: [&Path; 0] = [];
    let recordings: Vec<String> = trials().iter().map(|trial| recording_of(&trial.load, trial.number)).collect();
    let own = [EXPERIMENT, TRUTH, TRACKS].into_iter().chain(recordings.iter().map(String::as_str));
    let files: Vec<&str> = own.chain(RESULTS).collect();
    let content = FolderContent { name: "of the same demo", run: "demo", files: &files };
    OutputFolder::prepare(path, Outputs::beside(nothing, force), &content)
}

/// Writes the experiment file and returns its path.
pub(super) fn write_experiment(folder: &OutputFolder, seed: u64) -> Result<PathBuf, Failure> {
    folder.write(EXPERIMENT, experiment_text(seed))?;
    Ok(folder.place(EXPERIMENT))
}

fn experiment_text(seed: u64) -> String {
    let vehicle_kg = LOADS[0].mass_kg;
    let mut text = format!(
        "# Written by `hovertone demo` (hovertone {version}, seed {seed}).
# The experiment of Pizetta, Brandao, Pizziolo and Sarcinelli-Filho in simulated flight. truth.csv has the truth.

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
    text
}

/// Writes `truth.csv` with a line for each trial, and `truth_tracks.csv` with the speed of every rotor at every row of the truth.
pub(super) fn write_truth(folder: &OutputFolder, trials: &[TrialTruth]) -> Result<(), Failure> {
    folder.write_csv(TRUTH, |writer| {
        let rotors = (1..=ROTOR_COUNT).map(|rotor| format!("rotor_{rotor}_mean_speed_rev_s"));
        let head = ["load", "trial", "recording", "seed", "mass_kg"].map(str::to_owned).into_iter().chain(rotors);
        writer.write_record(
            head.chain(
                ["mean_sum_of_squares_rad2_s2", "thrust_constant_total_n_s2", "thrust_constant_per_rotor_n_s2"]
                    .map(str::to_owned),
            ),
        )?;
        for trial in trials {
            let truth = &trial.truth;
            let mut line = vec![
                trial.load.name.to_owned(),
                trial.number.to_string(),
                recording_of(&trial.load, trial.number),
                trial.seed.to_string(),
                trial.load.mass_kg.to_string(),
            ];
            line.extend(truth.mean_speed_rad_s.map(|speed| RotorSpeed::from_rad_s(speed).rev_s().to_string()));
            line.push(truth.mean_sum_of_squares_rad2_s2.to_string());
            line.push(truth.thrust_constant_total_n_s2.to_string());
            line.push(truth.thrust_constant_per_rotor_n_s2.to_string());
            writer.write_record(line)?;
        }
        Ok(())
    })?;
    folder.write_csv(TRACKS, |writer| {
        let rotors = (1..=ROTOR_COUNT).map(|rotor| format!("rotor_{rotor}_speed_rev_s"));
        writer.write_record(["load", "trial", "time_s"].map(str::to_owned).into_iter().chain(rotors))?;
        for trial in trials {
            for (time_s, speeds) in &trial.track {
                let mut line = vec![trial.load.name.to_owned(), trial.number.to_string(), format!("{time_s:.4}")];
                line.extend(speeds.iter().map(|speed| format!("{:.5}", speed.rev_s())));
                writer.write_record(line)?;
            }
        }
        Ok(())
    })
}
