//! The folder of results: the report, and its tables and figures as separate files.

use crate::drawing::{draw_all, trial_of};
use crate::failure::Failure;
use crate::output_folder::OutputFolder;
use crate::recording::{Hearing, Job};
use hovertone::speed::Method;
use hovertone_exchange::{SimulatorFormat, export_text, identified_from_results};
use hovertone_figures::{
    DOTS_PER_INCH, ExperimentFigures, Figure, Trial, figure_png, figures_of_experiment, recording_figure,
};
use hovertone_page::{Report, SOUND_S_MAX, SimulatorLines, TrialReport, experiment_tables, names_of, report_html};
use hovertone_report::{
    Identification, RESULTS_SCHEMA, SpeedRecord, TextTable, TitledTable, loads_data, results_json, samples_data,
    tables_latex, tables_markdown,
};
use rayon::prelude::*;

const FIGURES: &str = "figures";
/// The page that a person opens.
pub(crate) const PAGE: &str = "report.html";
const SCHEMA: &str = "results.schema.json";

/// The files of results, without the figures, whose names depend on the experiment.
pub(crate) const RESULTS: [&str; 9] = [
    SCHEMA,
    "results.json",
    "samples.csv",
    "samples.parquet",
    "loads.csv",
    "loads.parquet",
    "tables.md",
    "tables.tex",
    PAGE,
];

/// Content of the report beside the identification.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Extras<'a> {
    /// Tables that replace the table of a method.
    pub(crate) compared: &'a [(Method, TextTable)],
    /// Additional tables.
    pub(crate) more_tables: &'a [TitledTable],
    /// The command that repeats the run.
    pub(crate) command: &'a str,
}

/// Reads the recordings again for their pictures and writes all files.
pub(crate) fn write_report(
    identification: &Identification<'_>,
    jobs: &[Job],
    hearing: Hearing,
    extras: &Extras<'_>,
    folder: &OutputFolder,
) -> Result<(), Failure> {
    // write the measured results before the drawing, which takes long
    folder.write(SCHEMA, RESULTS_SCHEMA)?;
    let results = results_json(identification).map_err(Failure::internal)?;
    folder.write("results.json", &results)?;
    for table in [samples_data(identification.tables), loads_data(identification.tables)] {
        folder.write(&format!("{}.csv", table.name), table.csv().map_err(Failure::internal)?)?;
        #[cfg(feature = "parquet")]
        folder.write(&format!("{}.parquet", table.name), table.parquet().map_err(Failure::internal)?)?;
    }
    let mut tables = experiment_tables(identification);
    tables.extend_from_slice(extras.more_tables);
    folder.write("tables.md", tables_markdown(&tables))?;
    folder.write("tables.tex", tables_latex(&tables))?;

    let records: Vec<&SpeedRecord> = identification.inputs.iter().map(|input| &input.record).collect();
    let drawings = draw_all(jobs, &records, hearing, SOUND_S_MAX);
    let reasons: Vec<Option<String>> = records.iter().map(|record| record.reason()).collect();
    let names = names_of(identification.inputs);
    let trials: Vec<Trial<'_>> = identification
        .inputs
        .iter()
        .zip(&names)
        .zip(reasons.iter().zip(&drawings))
        .map(|((input, name), (reason, drawing))| Trial {
            recording: name,
            ..trial_of(&input.load, &input.record, reason.as_deref(), drawing.as_ref())
        })
        .collect();
    let drawn = ExperimentFigures { trials: &trials, tables: identification.tables, method: identification.method };
    let figures = figures_of_experiment(&drawn).map_err(Failure::internal)?;
    figures.par_iter().try_for_each(|figure| write_figure(figure, folder))?;

    let trial_figures: Vec<Option<Figure>> = trials
        .par_iter()
        .enumerate()
        .map(|(index, trial)| recording_figure(trial, &format!("recording-{}", index + 1)))
        .collect::<Result<_, _>>()
        .map_err(Failure::internal)?;
    let of_page: Vec<TrialReport<'_>> = trial_figures
        .iter()
        .zip(&drawings)
        .map(|(figure, drawing)| TrialReport {
            figure: figure.as_ref(),
            sound: drawing.as_ref().and_then(|drawing| drawing.sound.as_ref()),
        })
        .collect();
    let report = Report {
        identification,
        figures: &figures,
        trials: &of_page,
        compared: extras.compared,
        more_tables: extras.more_tables,
        simulators: &simulators_of(&results),
        command: extras.command,
    };
    let page = report_html(&report).map_err(Failure::internal)?;
    folder.write(PAGE, page)
}

/// The lines for every simulator that takes what the results have; none without a constant.
fn simulators_of(results: &str) -> Vec<SimulatorLines> {
    let Ok(rotor) = identified_from_results(results, None) else { return Vec::new() };
    let lines = |format: SimulatorFormat| {
        Some(SimulatorLines { name: format.name().to_owned(), text: export_text(&rotor, format).ok()? })
    };
    SimulatorFormat::ALL.into_iter().filter_map(lines).collect()
}

/// Writes a figure as SVG and as PNG.
fn write_figure(figure: &Figure, folder: &OutputFolder) -> Result<(), Failure> {
    folder.write(&format!("{FIGURES}/{}.svg", figure.name), &figure.svg)?;
    let png = figure_png(figure, DOTS_PER_INCH).map_err(Failure::internal)?;
    folder.write(&format!("{FIGURES}/{}.png", figure.name), png)
}
