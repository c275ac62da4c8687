//! `hovertone identify`: the thrust constant from an experiment file and its recordings.

mod check;
mod experiment_file;
mod logs;
mod recordings;
mod typed;

pub(crate) use experiment_file::{ExperimentSource, names_loads};
use logs::FlownLog;
use recordings::advice_on_copies;
pub(crate) use recordings::{LoadJob, jobs_of};
use typed::{EXPERIMENT, TypedExperiment};

use crate::args::{HearingArguments, IdentifyArguments};
use crate::copies::refuse_equal_speeds;
use crate::failure::{Ending, Failure};
use crate::files::sha256_of_bytes;
use crate::jobs::ending_of;
use crate::output_folder::{FolderContent, OutputFolder};
use crate::outputs::Outputs;
use crate::progress::Progress;
use crate::recording::{Hearing, Job, records_of};
use crate::report_folder::{PAGE, RESULTS, write_report};
use crate::terminal::Terminal;
use crate::today::today;
use crate::typed::typed_command;
use hovertone::experiment::Experiment;
use hovertone::speed::Method;
use hovertone::thrust::ThrustWarning;
use hovertone_report::{InputRecord, Notice, SpeedRecord, Wording, printable, results_json};
use hovertone_workflow::{ReportExtras, TipsTooFast, Titles};
use std::ops::Deref;
use std::path::{Path, PathBuf};

/// An experiment with the records of its recordings and the fits of its loads.
pub(crate) struct Identified {
    identified: hovertone_workflow::Identified,
    /// The recordings, which are read again for their pictures.
    jobs: Vec<Job>,
    hearing: Hearing,
    wording: Wording,
}

/// Identifies the experiment and prints warnings, the tables where they are wanted, and the lines to quote.
pub(crate) fn run(arguments: &IdentifyArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let source = source_of(arguments)?;
    source.replaced_correction.iter().for_each(|notice| terminal.tip(notice));
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
        None => "page: not written; add -o DIR to write the page, results.json, tables and figures\n".to_owned(),
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
    let clock_correction_ppm = arguments.hearing.clock_correction_ppm;
    match &arguments.experiment {
        Some(path) => Ok(ExperimentSource::read(path)?.with_correction(clock_correction_ppm)),
        None => TypedExperiment::from_arguments(&arguments.draft, clock_correction_ppm)?.source(),
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
        let extras = ReportExtras { command: &typed_command(), date: &today(), ..ReportExtras::default() };
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
    let folder = checked_folder(&source, &recordings, arguments)?;
    folder.as_ref().map_or(Ok(()), OutputFolder::begin)?;
    let text_of_typed = match &folder {
        Some(folder) => source.text_for(folder.path(), arguments.data_root.as_deref())?,
        None => None,
    };
    let identified = identify(source, recordings, hearing, method, !arguments.hearing.no_progress)?;
    Ok(Measured { identified, folder, text_of_typed })
}

/// The folder of results, where one is wanted, before anything is written. It may hold those of an earlier run for the same experiment.
fn checked_folder(
    source: &ExperimentSource,
    recordings: &[LoadJob],
    arguments: &IdentifyArguments,
) -> Result<Option<OutputFolder>, Failure> {
    let Some(folder) = &arguments.output else { return Ok(None) };
    let paths = |LoadJob { job, log, .. }: &LoadJob| {
        std::iter::once(job.path.clone()).chain(log.as_ref().map(|log| log.path.clone()))
    };
    let inputs = recordings.iter().flat_map(paths).chain(source.inputs());
    let outputs = Outputs::beside(inputs, arguments.replace.force);
    let root = |root: &PathBuf| format!(" {}", sha256_of_bytes(root.as_os_str().as_encoded_bytes()));
    let root = arguments.data_root.as_ref().map_or(String::new(), root);
    let run = format!("identify {}{root}", source.fingerprint());
    let of_typed = source.typed.as_ref().map(|_| EXPERIMENT);
    let files: Vec<&str> = RESULTS.into_iter().chain(of_typed).collect();
    OutputFolder::checked(
        folder,
        outputs,
        &FolderContent {
            name: "of this experiment (with another experiment file, or with other masses, recordings or facts of the vehicle, it is another experiment)",
            run: &run,
            files: &files,
        },
    )
    .map(Some)
}

/// The last line to quote: where the page is.
pub(crate) fn page_line(page: &Path) -> String {
    format!("page: {}\n", printable(&page.display().to_string()))
}

fn hearing_of(arguments: &HearingArguments, experiment: &Experiment, wants_hash: bool) -> Hearing {
    let clock_correction_ppm = experiment.clock_correction_ppm;
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
    let (hint, experiment_file) = advice_on_copies(&source);
    refuse_equal_speeds(&records, hint, experiment_file)?;
    let wording = source.wording;
    let input = |((OfLoad { load, log }, mut record), job): ((OfLoad, SpeedRecord), &Job)| {
        let log = log.map(|log| log.compared(&mut record, job));
        InputRecord { load, record: record.worded(wording), log }
    };
    let inputs: Vec<InputRecord> = of_loads.into_iter().zip(records).zip(&jobs).map(input).collect();
    let titles = Titles { file: source.name, sha256: source.sha256 };
    let path = source.path;
    let identified = hovertone_workflow::Identified::of_records(titles, source.experiment, inputs, method);
    let identified = identified.map_err(|TipsTooFast { file, contradiction }| Failure::Usage {
        what: format!("{file}: {contradiction}"),
        hint: contradiction.hint(),
        path: Some(path),
    })?;
    Ok(Identified { identified, jobs, hearing, wording })
}

/// What belongs to a recording beside its job.
struct OfLoad {
    load: String,
    log: Option<FlownLog>,
}

impl Deref for Identified {
    type Target = hovertone_workflow::Identified;

    fn deref(&self) -> &Self::Target {
        &self.identified
    }
}

impl Identified {
    pub(crate) fn ending(&self) -> Ending {
        let has_failed_check = !self.identification().logs_of_failed_checks().is_empty();
        let is_incomplete = self.warnings().iter().any(ThrustWarning::makes_incomplete);
        let of_checks = if has_failed_check || is_incomplete { Ending::Incomplete } else { Ending::Done };
        ending_of(self.records()).max(of_checks)
    }

    /// Prints warnings and cuts: first those of the constant, then those of the recordings.
    pub(crate) fn say_notes(&self, terminal: &mut Terminal) {
        terminal.warning_count(self.warning_count());
        for warning in self.warnings() {
            terminal.warning(&Notice::from(warning).worded(self.wording), "");
        }
        terminal.notes(&self.records());
    }

    /// Writes the report with all its files.
    pub(crate) fn write(&self, folder: &OutputFolder, extras: &ReportExtras<'_>) -> Result<(), Failure> {
        write_report(&self.identification(), &self.jobs, self.hearing, extras, folder)
    }
}
