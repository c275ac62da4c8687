//! `hovertone identify`: the thrust constant from an experiment file and its recordings.

mod experiment_file;
mod recordings;

pub(crate) use experiment_file::ExperimentSource;
pub(crate) use recordings::{LoadJob, jobs_of};

use crate::args::HearingArguments;
use crate::args::IdentifyArguments;
use crate::failure::{Ending, Failure};
use crate::jobs::ending_of;
use crate::output_folder::OutputFolder;
use crate::outputs::Outputs;
use crate::progress::Progress;
use crate::recording::{Hearing, Job, records_of};
use crate::report_folder::{Extras, RESULTS, write_report};
use crate::terminal::Terminal;
use crate::typed::typed_command;
use hovertone::experiment::Experiment;
use hovertone::speed::{Method, SpeedEstimate};
use hovertone::thrust::{LoadSpeeds, ThrustSettings, ThrustTable, TrialSpeeds, thrust_from_loads};
use hovertone_report::{
    ExperimentFacts, Identification, InputRecord, Notice, adequacy_text, method_title, results_json, thrust_summary,
    thrust_table, vehicle_model_text,
};
use serde_json::Value;
use std::path::PathBuf;

/// An experiment with the records of its recordings and the fits of its loads.
pub(crate) struct Identified {
    source: ExperimentSource,
    method: Method,
    inputs: Vec<InputRecord>,
    tables: Vec<ThrustTable>,
    /// The resolved experiment, as written to the results.
    settings: Value,
    /// The recordings, which are read again for their pictures.
    jobs: Vec<Job>,
    hearing: Hearing,
}

/// Identifies the experiment and prints its tables.
pub(crate) fn run(arguments: &IdentifyArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let source = ExperimentSource::read(&arguments.experiment)?;
    let hearing = hearing_of(&arguments.hearing, arguments.json || arguments.output.is_some());
    let method = arguments.method.unwrap_or(source.experiment.config.method);
    let recordings = jobs_of(&source, arguments.data_root.as_deref())?;
    let inputs = recordings.iter().map(|LoadJob { job, .. }| job.path.clone()).chain(source.inputs());
    let outputs = Outputs::beside(inputs, arguments.replace.force);
    let prepare = |folder: &PathBuf| OutputFolder::prepare(folder, outputs, &RESULTS);
    let folder = arguments.output.as_ref().map(prepare).transpose()?;
    let identified = identify(source, recordings, hearing, method, !arguments.hearing.no_progress)?;
    if arguments.json {
        terminal.data(&results_json(&identified.identification()).map_err(Failure::internal)?)?;
    } else {
        terminal.data(&identified.in_words())?;
    }
    terminal.flush()?;
    identified.say_notes(terminal);
    match &folder {
        Some(folder) => {
            let extras = Extras { command: &typed_command(), ..Extras::default() };
            let written = identified.write(folder, &extras)?;
            terminal.say(&format!("written: {}", written.join(", ")));
        }
        None if !arguments.json => {
            terminal.say("nothing was written; -o DIR writes report.html, results.json, tables and figures there");
        }
        None => {}
    }
    Ok(identified.ending())
}

fn hearing_of(arguments: &HearingArguments, wants_hash: bool) -> Hearing {
    Hearing { audio_track: arguments.audio_track, channel: arguments.channel, wants_hash, wants_samples: true }
}

/// Analyses all recordings of an experiment and fits its loads by every method.
pub(crate) fn identify(
    source: ExperimentSource,
    recordings: Vec<LoadJob>,
    hearing: Hearing,
    method: Method,
    shows_progress: bool,
) -> Result<Identified, Failure> {
    let (jobs, loads): (Vec<Job>, Vec<String>) =
        recordings.into_iter().map(|LoadJob { job, load }| (job, load)).unzip();
    let progress = Progress::new("listening to", jobs.len(), shows_progress);
    let records = records_of(&jobs, hearing, &progress);
    progress.finish();
    let inputs: Vec<InputRecord> =
        loads.into_iter().zip(records).map(|(load, record)| InputRecord { load, record }).collect();
    let experiment = &source.experiment;
    let has_rotors = inputs.iter().filter_map(|input| input.record.tone()?.speed(Method::Separated)).any(is_separated);
    let method = if has_rotors || method != Method::Separated { method } else { Method::Harmonic };
    let unresolved_std_share = unresolved_std_share(experiment, &inputs);
    let tables = Method::ALL
        .into_iter()
        .filter(|&method| method != Method::Separated || has_rotors)
        .map(|method| {
            let settings = ThrustSettings {
                follows_loudest: method != Method::Separated,
                unresolved_std_share,
                ..experiment.thrust_settings()
            };
            thrust_from_loads(&loads_of(experiment, &inputs, method), method, &settings)
        })
        .collect();
    let settings = serde_json::to_value(experiment).map_err(Failure::internal)?;
    Ok(Identified { source, method, inputs, tables, settings, jobs, hearing })
}

/// Standard deviation of the difference between the mean of all rotors and the mean of the separated rotors, as a share. It is the mean
/// over all recordings, since the rotors are the same in each of them.
fn unresolved_std_share(experiment: &Experiment, inputs: &[InputRecord]) -> f64 {
    let running = |input: &InputRecord| {
        let load = experiment.loads.iter().find(|load| load.name == input.load);
        load.map_or(1, |load| load.rotors_running)
    };
    let speeds = inputs
        .iter()
        .filter(|input| running(input) > 1)
        .filter_map(|input| input.record.tone()?.speed(Method::Separated));
    let shares: Vec<f64> = speeds.map(SpeedEstimate::rotors_std_share).collect();
    shares.iter().sum::<f64>() / shares.len().max(1) as f64
}

fn is_separated(speed: &SpeedEstimate) -> bool {
    speed.method == Method::Separated
}

/// The speeds of all loads by one method. A recording without a rotor tone is no trial.
fn loads_of(experiment: &Experiment, inputs: &[InputRecord], method: Method) -> Vec<LoadSpeeds> {
    experiment
        .loads
        .iter()
        .map(|load| LoadSpeeds {
            name: load.name.clone(),
            force: load.force,
            rotors_running: load.rotors_running,
            power_w: load.power_w,
            trials: inputs
                .iter()
                .filter(|input| input.load == load.name)
                .filter_map(|input| TrialSpeeds::from_analysis(&input.record.file, input.record.analysis()?, method))
                .collect(),
        })
        .collect()
}

impl Identified {
    /// One table for each method.
    pub(crate) fn tables(&self) -> &[ThrustTable] {
        &self.tables
    }

    pub(crate) fn ending(&self) -> Ending {
        ending_of(self.inputs.iter().map(|input| &input.record))
    }

    /// The results as the report takes them.
    pub(crate) fn identification(&self) -> Identification<'_> {
        let experiment = &self.source.experiment;
        Identification {
            file: &self.source.name,
            sha256: &self.source.sha256,
            experiment: ExperimentFacts {
                vehicle_name: &experiment.vehicle_name,
                rotor_count: experiment.rotor_count,
                order: experiment.config.tone.order,
                load_count: experiment.loads.len(),
                model: experiment.model.as_ref(),
                settings: &self.settings,
            },
            method: self.method,
            tables: &self.tables,
            inputs: &self.inputs,
        }
    }

    /// The result below the tables.
    pub(crate) fn summary(&self) -> String {
        let identification = self.identification();
        let reported = identification.reported();
        let model = reported.zip(self.source.experiment.model.as_ref());
        thrust_summary(&self.tables, self.method)
            + &reported.map_or(String::new(), adequacy_text)
            + &model.map_or(String::new(), |(table, model)| vehicle_model_text(model, table))
    }

    fn in_words(&self) -> String {
        let experiment = &self.source.experiment;
        let heard = self.inputs.iter().filter(|input| input.record.speed().is_some()).count();
        let mut text = format!(
            "{}: {} rotors, tone of order {}\n{} loads, {} recordings, {heard} of them with a rotor tone\n",
            experiment.vehicle_name,
            experiment.rotor_count,
            experiment.config.tone.order,
            experiment.loads.len(),
            self.inputs.len(),
        );
        for table in &self.tables {
            text += &format!("\n{}\n{}", method_title(table.method), thrust_table(table));
        }
        text + "\n" + &self.summary()
    }

    /// Prints cuts and warnings.
    pub(crate) fn say_notes(&self, terminal: &mut Terminal) {
        terminal.notes(&self.inputs.iter().map(|input| &input.record).collect::<Vec<_>>());
        for warning in self.identification().reported().map_or(&[][..], |table| &table.warnings) {
            terminal.warning(&Notice::from(warning), "");
        }
    }

    /// Writes the report with all its files; returns their names.
    pub(crate) fn write(&self, folder: &OutputFolder, extras: &Extras<'_>) -> Result<Vec<String>, Failure> {
        write_report(&self.identification(), &self.jobs, self.hearing, extras, folder)
    }
}
