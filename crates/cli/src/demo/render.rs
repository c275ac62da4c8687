//! The sound of all trials, as 16-bit WAV files, and its truth.

use crate::failure::Failure;
use crate::progress::{Progress, Share};
use hound::{SampleFormat, WavSpec, WavWriter};
use hovertone_report::LoadTruth;
use hovertone_sim::paper::{GRAVITY_M_S2, LOADS, PaperLoad, PaperSimulation, ROTOR_COUNT, TRIAL_COUNT, TRIAL_S};
use hovertone_sim::{HoverSound, Truth};
use rayon::prelude::*;
use std::fs;
use std::path::Path;

/// Samples that are rendered at once.
const BLOCK: usize = 4800;

/// What one trial really was.
pub(super) struct TrialTruth {
    /// Its load.
    pub(super) load: PaperLoad,
    /// Its number, counted from 1.
    pub(super) number: u32,
    /// Seed of its sound.
    pub(super) seed: u64,
    /// Its speeds at every instant.
    pub(super) truth: Truth,
}

impl TrialTruth {
    /// Mean over the whole trial of the sum of the rotors' squared speeds.
    pub(super) fn mean_sum_of_squares_rad2_s2(&self) -> Option<f64> {
        self.truth.mean_sum_of_squares(0.0, TRIAL_S)
    }
}

/// Name of a load's folder.
pub(super) fn folder_of_load(load: &PaperLoad) -> String {
    load.name.replace(' ', "_")
}

/// Renders and writes all trials, in parallel; their truths are in the order of loads and trials.
pub(super) fn render_all(
    simulation: &PaperSimulation,
    folder: &Path,
    shows_progress: bool,
) -> Result<Vec<TrialTruth>, Failure> {
    for load in &LOADS {
        let folder = folder.join(folder_of_load(load));
        fs::create_dir_all(&folder).map_err(|error| Failure::cannot_write(&error, &folder))?;
    }
    let trials: Vec<(PaperLoad, u32)> =
        LOADS.iter().flat_map(|load| (0..TRIAL_COUNT).map(|trial| (*load, trial))).collect();
    let progress = Progress::new("simulating", trials.len(), shows_progress);
    let rendered = trials
        .par_iter()
        .map(|&(load, trial)| render(simulation, load, trial, folder, &mut progress.recording()))
        .collect();
    progress.finish();
    rendered
}

fn render(
    simulation: &PaperSimulation,
    load: PaperLoad,
    trial: u32,
    folder: &Path,
    share: &mut Share<'_>,
) -> Result<TrialTruth, Failure> {
    let number = trial + 1;
    let path = folder.join(folder_of_load(&load)).join(format!("trial_{number}.wav"));
    let settings = simulation.trial(&load, trial);
    let (seed, sample_rate) = (settings.seed, settings.sample_rate_hz);
    let mut sound = HoverSound::new(settings).map_err(Failure::internal)?;
    let spec = WavSpec { channels: 1, sample_rate, bits_per_sample: 16, sample_format: SampleFormat::Int };
    let cannot_write = |error: hound::Error| match error {
        hound::Error::IoError(error) => Failure::cannot_write(&error, &path),
        error => Failure::internal(error),
    };
    let mut writer = WavWriter::create(&path, spec).map_err(cannot_write)?;
    let (mut block, mut rows, mut written) = ([0.0; BLOCK], Vec::new(), 0);
    loop {
        let count = sound.render(&mut block, &mut rows);
        if count == 0 {
            break;
        }
        for sample in &block[..count] {
            let rounded = (sample * f32::from(i16::MAX)).round().clamp(f32::from(i16::MIN), f32::from(i16::MAX));
            writer.write_sample(rounded as i16).map_err(cannot_write)?;
        }
        written += count;
        share.set(written as f64 / sound.sample_count() as f64);
    }
    writer.finalize().map_err(cannot_write)?;
    Ok(TrialTruth { load, number, seed, truth: Truth::from_rows(rows) })
}

/// The truth of every load, in the paper's order.
pub(super) fn truth_of_loads(trials: &[TrialTruth]) -> Vec<LoadTruth> {
    let truth_of = |load: &PaperLoad| LoadTruth {
        name: load.name.to_owned(),
        force_n: load.mass_kg * GRAVITY_M_S2,
        rotor_count: ROTOR_COUNT as u32,
        mean_sum_of_squares_rad2_s2: trials
            .iter()
            .filter(|trial| trial.load.name == load.name)
            .filter_map(TrialTruth::mean_sum_of_squares_rad2_s2)
            .collect(),
    };
    LOADS.iter().map(truth_of).collect()
}
