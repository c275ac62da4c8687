//! The flights of all trials, their sound as 16-bit WAV files, and their truth.

use crate::failure::Failure;
use crate::output_folder::OutputFolder;
use crate::progress::{Progress, Share};
use crate::wav::WavFile;
use hovertone_report::LoadTruth;
use hovertone_sim::paper::{GRAVITY_M_S2, LOADS, PaperLoad, ROTOR_COUNT, TRIAL_COUNT};
use hovertone_sim::scenario::{ScenarioFile, ScenarioRun, SpanTruth};
use hovertone_vehicle::RotorSpeed;
use rayon::prelude::*;
use std::collections::BTreeMap;

/// Steps of the flight between two writes to the file.
const STEPS_AT_ONCE: usize = 100;

/// The truth of one trial.
pub(super) struct TrialTruth {
    /// Name of its load.
    pub(super) load: PaperLoad,
    /// Its number, counted from 1.
    pub(super) number: u32,
    /// Seed of its flight and sound.
    pub(super) seed: u64,
    /// Its means over the hover.
    pub(super) truth: SpanTruth,
    /// The speeds of its rotors over time.
    pub(super) track: Vec<(f64, [RotorSpeed; ROTOR_COUNT])>,
}

/// Name of the folder of a load.
pub(super) fn folder_of_load(load: &PaperLoad) -> String {
    load.name.replace(' ', "_")
}

/// Name of a recording in the folder of the demo.
pub(super) fn recording_of(load: &PaperLoad, number: u32) -> String {
    format!("{}/trial_{number}.wav", folder_of_load(load))
}

/// A trial that is to be flown.
pub(super) struct Trial {
    pub(super) load: PaperLoad,
    /// Its number, counted from 1.
    pub(super) number: u32,
}

/// All trials, in the order of loads.
pub(super) fn trials() -> Vec<Trial> {
    LOADS.iter().flat_map(|load| (1..=TRIAL_COUNT).map(|number| Trial { load: *load, number })).collect()
}

/// Simulates and writes all trials in parallel; the truths are in the order of loads and trials.
pub(super) fn render_all(seed: u64, folder: &OutputFolder, shows_progress: bool) -> Result<Vec<TrialTruth>, Failure> {
    let trials = trials();
    let progress = Progress::new("flying", trials.len(), shows_progress);
    let rendered = trials.par_iter().map(|trial| render(seed, trial, folder, &mut progress.recording())).collect();
    progress.finish();
    rendered
}

fn render(seed: u64, trial: &Trial, folder: &OutputFolder, share: &mut Share<'_>) -> Result<TrialTruth, Failure> {
    let &Trial { load, number } = trial;
    let name = recording_of(&load, number);
    let file = ScenarioFile::paper_trial(&load, number - 1, seed);
    let scenario = file.resolve(&BTreeMap::new()).map_err(Failure::internal)?;
    let mut wav = WavFile::create(
        folder.create(&name)?,
        scenario.sound.microphones.len(),
        scenario.sound.sample_rate_hz,
        scenario.sample_format,
    )?;
    let mut flown = ScenarioRun::new(scenario).map_err(Failure::internal)?;
    let (mut channels, mut rows, mut track, mut goes_on) = (Vec::new(), Vec::new(), Vec::new(), true);
    while goes_on {
        for _ in 0..STEPS_AT_ONCE {
            goes_on = goes_on && flown.advance(&mut channels, &mut rows).map_err(Failure::internal)?;
        }
        wav.drain(&mut channels)?;
        track.extend(rows.drain(..).map(|state| (state.time_s, state.speed_rad_s.map(RotorSpeed::from_rad_s))));
        share.set(flown.share_done());
    }
    let truth = flown.finish(&mut channels);
    wav.drain(&mut channels)?;
    wav.finish()?;
    Ok(TrialTruth { load, number, seed: file.seed, truth: truth.flight, track })
}

/// The truth of every load, in the order of the paper.
pub(super) fn truth_of_loads(trials: &[TrialTruth]) -> Vec<LoadTruth> {
    let truth_of = |load: &PaperLoad| LoadTruth {
        name: load.name.to_owned(),
        force_n: load.mass_kg * GRAVITY_M_S2,
        rotor_count: ROTOR_COUNT as u32,
        mean_sum_of_squares_rad2_s2: trials
            .iter()
            .filter(|trial| trial.load.name == load.name)
            .map(|trial| trial.truth.mean_sum_of_squares_rad2_s2)
            .collect(),
    };
    LOADS.iter().map(truth_of).collect()
}
