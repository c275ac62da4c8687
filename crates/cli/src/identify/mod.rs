//! `hovertone identify`: the thrust constant from an experiment file and its recordings.

mod check;
mod experiment_file;
mod logs;
mod recordings;
mod typed;

pub(crate) use experiment_file::ExperimentSource;
use logs::FlownLog;
pub(crate) use recordings::{LoadJob, jobs_of};
use typed::{EXPERIMENT, TypedExperiment};

use crate::args::{HearingArguments, IdentifyArguments};
use crate::failure::{Ending, Failure};
use crate::files::sha256_of_bytes;
use crate::jobs::ending_of;
use crate::output_folder::{FolderContent, OutputFolder};
use crate::outputs::Outputs;
use crate::progress::Progress;
use crate::recording::{Hearing, Job, records_of};
use crate::report_folder::{Extras, PAGE, RESULTS, write_report};
use crate::terminal::Terminal;
use crate::typed::typed_command;
use hovertone::experiment::Experiment;
use hovertone::speed::{Method, SpeedEstimate};
use hovertone::thrust::{LoadSpeeds, ThrustSettings, ThrustTable, ThrustWarning, TrialSpeeds, thrust_from_loads};
use hovertone_page::names_of;
use hovertone_report::{
    ExperimentFacts, Identification, InputRecord, LOADS_FOOTNOTE, Notice, SpeedRecord, Verdict, adequacy_text, counted,
    flight_log_tables, printable, quoted_constants, results_json, rotors_heard_text, table_text, thrust_summary,
    thrust_table, vehicle_model_text, warning_count,
};
use hovertone_vehicle::check_tips;
use serde_json::Value;
use std::path::{Path, PathBuf};

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

/// Identifies the experiment and prints warnings, the tables where they are wanted, and the lines to quote.
pub(crate) fn run(arguments: &IdentifyArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let source = source_of(arguments)?;
    if arguments.check {
        return check::run(&source, arguments, terminal);
    }
    let measured = measured(source, arguments)?;
    let identified = &measured.identified;
    identified.say_notes(terminal);
    if arguments.json {
        terminal.data(&results_json(&identified.identification()).map_err(Failure::internal)?)?;
    } else {
        terminal.text(&identified.headline())?;
        if arguments.verbose {
            terminal.text(&identified.tables_in_words(terminal.fold_width()))?;
        }
        terminal.text(&identified.model_in_words())?;
        terminal.text(&identified.quote())?;
    }
    terminal.flush()?;
    let page = match measured.write()? {
        Some(page) => page_line(&page),
        None => "page: none; -o DIR writes it, with results.json, tables and figures\n".to_owned(),
    };
    if !arguments.json {
        terminal.text(&page)?;
    }
    Ok(identified.ending())
}

/// An identified experiment, and the page of its report where one was written.
pub(crate) struct Reported {
    pub(crate) identified: Identified,
    pub(crate) page: Option<PathBuf>,
}

/// The identified experiment, for a program that calls, and the page of its report, which is written where the arguments name a folder.
pub(crate) fn called(arguments: &IdentifyArguments) -> Result<Reported, Failure> {
    let measured = measured(source_of(arguments)?, arguments)?;
    let page = measured.write()?;
    Ok(Reported { identified: measured.identified, page })
}

fn source_of(arguments: &IdentifyArguments) -> Result<ExperimentSource, Failure> {
    match &arguments.experiment {
        Some(path) => ExperimentSource::read(path),
        None => TypedExperiment::from_arguments(&arguments.draft)?.source(),
    }
}

/// An identified experiment, and the folder that its report goes into.
struct Measured {
    identified: Identified,
    folder: Option<OutputFolder>,
    /// The text of the experiment file, where the flags stand in place of one.
    text_of_typed: Option<String>,
}

impl Measured {
    /// Writes the report, where it is wanted. Returns the place of its page.
    fn write(&self) -> Result<Option<PathBuf>, Failure> {
        let Some(folder) = &self.folder else { return Ok(None) };
        let extras = Extras { command: &typed_command(), ..Extras::default() };
        self.identified.write(folder, &extras)?;
        if let Some(text) = &self.text_of_typed {
            folder.write(EXPERIMENT, text)?;
        }
        Ok(Some(folder.place(PAGE)))
    }
}

fn measured(mut source: ExperimentSource, arguments: &IdentifyArguments) -> Result<Measured, Failure> {
    let hearing = hearing_of(&arguments.hearing, &source.experiment, arguments.json || arguments.output.is_some());
    let method = arguments.method.unwrap_or(source.experiment.config.method);
    let recordings = jobs_of(&source, arguments.data_root.as_deref())?;
    let paths = |LoadJob { job, log, .. }: &LoadJob| {
        std::iter::once(job.path.clone()).chain(log.as_ref().map(|log| log.path.clone()))
    };
    let inputs = recordings.iter().flat_map(paths).chain(source.inputs());
    let outputs = Outputs::beside(inputs, arguments.replace.force);
    let prepare = |folder: &PathBuf| prepare_folder(folder, &source, outputs, arguments.data_root.as_deref());
    let folder = arguments.output.as_ref().map(prepare).transpose()?;
    let text_of_typed = match &folder {
        Some(folder) => source.text_for(folder.path(), arguments.data_root.as_deref())?,
        None => None,
    };
    let identified = identify(source, recordings, hearing, method, !arguments.hearing.no_progress)?;
    Ok(Measured { identified, folder, text_of_typed })
}

/// Makes the folder of results. It may hold those of an earlier run for the same experiment.
fn prepare_folder(
    folder: &Path,
    source: &ExperimentSource,
    outputs: Outputs,
    data_root: Option<&Path>,
) -> Result<OutputFolder, Failure> {
    let root =
        data_root.map_or(String::new(), |root| format!(" {}", sha256_of_bytes(root.as_os_str().as_encoded_bytes())));
    let run = format!("identify {}{root}", source.fingerprint());
    let of_typed = source.typed.as_ref().map(|_| EXPERIMENT);
    let files: Vec<&str> = RESULTS.into_iter().chain(of_typed).collect();
    OutputFolder::prepare(folder, outputs, &FolderContent { name: "experiment", run: &run, files: &files })
}

/// The last line to quote: where the page is.
pub(crate) fn page_line(page: &Path) -> String {
    format!("page: {}\n", printable(&page.display().to_string()))
}

fn hearing_of(arguments: &HearingArguments, experiment: &Experiment, wants_hash: bool) -> Hearing {
    let clock_correction_ppm = arguments.clock_correction_ppm.unwrap_or(experiment.clock_correction_ppm);
    Hearing { clock_correction_ppm, wants_hash, wants_samples: true, ..Hearing::of(arguments) }
}

/// Analyses all recordings of an experiment and fits its loads by every method.
pub(crate) fn identify(
    source: ExperimentSource,
    recordings: Vec<LoadJob>,
    hearing: Hearing,
    method: Method,
    shows_progress: bool,
) -> Result<Identified, Failure> {
    let mut jobs: Vec<Job> = Vec::new();
    let mut of_loads: Vec<OfLoad> = Vec::new();
    for LoadJob { job, load, log } in recordings {
        let log = log.map(|file| FlownLog::read(file, hearing.wants_hash)).transpose()?;
        jobs.push(job);
        of_loads.push(OfLoad { load, log });
    }
    let progress = Progress::new("listening to", jobs.len(), shows_progress);
    let records = records_of(&jobs, hearing, &progress);
    progress.finish();
    let input = |((OfLoad { load, log }, mut record), job): ((OfLoad, SpeedRecord), &Job)| {
        let log = log.map(|log| log.compared(&mut record, job));
        InputRecord { load, record, log }
    };
    let inputs: Vec<InputRecord> = of_loads.into_iter().zip(records).zip(&jobs).map(input).collect();
    let experiment = &source.experiment;
    check_tips_of(&source, &inputs)?;
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

/// What belongs to a recording beside its job.
struct OfLoad {
    load: String,
    log: Option<FlownLog>,
}

/// Refuses the diameter of the experiment where the blade tips of a heard rotor would be faster than any multirotor's.
fn check_tips_of(source: &ExperimentSource, inputs: &[InputRecord]) -> Result<(), Failure> {
    let Some(diameter_m) = source.experiment.propeller_diameter_m else { return Ok(()) };
    for record in inputs.iter().map(|input| &input.record) {
        let tips = record.speed().map(|estimate| check_tips(diameter_m, estimate.speed));
        tips.transpose().map_err(|tips| Failure::Usage {
            what: format!("{}: {tips}", record.file),
            hint: tips.hint(),
            path: Some(source.path.clone()),
        })?;
    }
    Ok(())
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
        let has_failed_check = self.identification().failed_check_count() > 0;
        let of_checks = if has_failed_check { Ending::Incomplete } else { Ending::Done };
        ending_of(self.inputs.iter().map(|input| &input.record)).max(of_checks)
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
    pub(crate) fn summary(&self, width: Option<usize>) -> String {
        let identification = self.identification();
        let reported = identification.reported();
        thrust_summary(&self.tables, self.method, width)
            + &reported.map_or(String::new(), |table| adequacy_text(table, width))
    }

    /// The simulator's model that the experiment names, beside the result; empty without one.
    fn model_in_words(&self) -> String {
        let identification = self.identification();
        let model = identification.reported().zip(self.source.experiment.model.as_ref());
        model.map_or(String::new(), |(table, model)| vehicle_model_text(model, table))
    }

    /// What was heard, and the number of warnings.
    fn headline(&self) -> String {
        let experiment = &self.source.experiment;
        let heard = self.inputs.iter().filter(|input| input.record.speed().is_some()).count();
        format!(
            "{}: {}, tone of order {}; {}, {}, {heard} of them with a rotor tone; {}\n",
            printable(&experiment.vehicle_name),
            counted(experiment.rotor_count as usize, "rotor"),
            experiment.config.tone.order,
            counted(experiment.loads.len(), "load"),
            counted(self.inputs.len(), "recording"),
            self.warnings_counted(),
        )
    }

    /// "2 warnings".
    pub(crate) fn warnings_counted(&self) -> String {
        counted(self.warnings().len() + warning_count(&self.records()), "warning")
    }

    /// The tables of all methods, the laws and the budget.
    fn tables_in_words(&self, width: Option<usize>) -> String {
        let mut text = String::new();
        for table in &self.tables {
            text += &format!("\n{}\n{}", table.title(), table_text(&thrust_table(table), width));
        }
        text += &format!("{LOADS_FOOTNOTE}\n\n{}\n", self.summary(width));
        for titled in flight_log_tables(&self.inputs, &names_of(&self.inputs)) {
            text += &format!("{}\n{}\n", titled.title, table_text(&titled.table, width));
        }
        text
    }

    /// The lines to quote: the constants with their ±, and the verdict.
    pub(crate) fn quote(&self) -> String {
        let reported = self.tables.iter().find(|table| table.method == self.method);
        let constants = reported.and_then(quoted_constants);
        match reported.zip(constants) {
            Some((table, constants)) => {
                let heard = rotors_heard_text(table.rotors_heard).map_or(String::new(), |heard| format!("; {heard}"));
                let failed = match self.identification().failed_check_count() {
                    0 => String::new(),
                    count => format!("; the order check failed against {}", counted(count, "log")),
                };
                format!("{constants}\nverdict: {}{heard}{failed}\n", printable(Verdict::of(table).words()))
            }
            None => "C_f: none, since no recording has a rotor tone\nverdict: nothing is identified\n".to_owned(),
        }
    }

    fn records(&self) -> Vec<&SpeedRecord> {
        self.inputs.iter().map(|input| &input.record).collect()
    }

    /// The warnings about the constant.
    fn warnings(&self) -> &[ThrustWarning] {
        let table = self.tables.iter().find(|table| table.method == self.method);
        table.map_or(&[], |table| &table.warnings)
    }

    /// Prints warnings and cuts: first those of the constant, then those of the recordings.
    pub(crate) fn say_notes(&self, terminal: &mut Terminal) {
        terminal.heading(&self.warnings_counted());
        for warning in self.warnings() {
            terminal.warning(&Notice::from(warning), "");
        }
        terminal.notes(&self.records());
    }

    /// Writes the report with all its files.
    pub(crate) fn write(&self, folder: &OutputFolder, extras: &Extras<'_>) -> Result<(), Failure> {
        write_report(&self.identification(), &self.jobs, self.hearing, extras, folder)
    }
}
