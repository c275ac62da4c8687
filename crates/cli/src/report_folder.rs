//! The folder of results: the report, and its tables and figures as separate files.

use crate::drawing::{draw_all, trial_of};
use crate::failure::Failure;
use crate::recording::{Hearing, Job};
use hovertone::speed::Method;
use hovertone_figures::{
    DOTS_PER_INCH, ExperimentFigures, Figure, Trial, figure_png, figures_of_experiment, recording_figure,
};
use hovertone_page::{Report, SOUND_S_MAX, TrialReport, experiment_tables, report_html};
use hovertone_report::{
    Identification, RESULTS_SCHEMA, SpeedRecord, TextTable, TitledTable, loads_data, results_json, samples_data,
    tables_latex, tables_markdown,
};
use rayon::prelude::*;
use std::fs;
use std::path::Path;

const FIGURES: &str = "figures";

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

/// Reads the recordings again for their pictures and writes all files; returns the names of the most important ones.
pub(crate) fn write_report(
    identification: &Identification<'_>,
    jobs: &[Job],
    hearing: Hearing,
    extras: &Extras<'_>,
    folder: &Path,
) -> Result<Vec<String>, Failure> {
    let figures_folder = folder.join(FIGURES);
    fs::create_dir_all(&figures_folder).map_err(|error| Failure::cannot_write(&error, &figures_folder))?;
    // write the measured results before the drawing, which takes long
    write(&folder.join("results.json"), results_json(identification).map_err(Failure::internal)?)?;
    write(&folder.join("results.schema.json"), RESULTS_SCHEMA)?;
    for table in [samples_data(identification.tables), loads_data(identification.tables)] {
        write(&folder.join(format!("{}.csv", table.name)), table.csv().map_err(Failure::internal)?)?;
        #[cfg(feature = "parquet")]
        write(&folder.join(format!("{}.parquet", table.name)), table.parquet().map_err(Failure::internal)?)?;
    }
    let mut tables = experiment_tables(identification);
    tables.extend_from_slice(extras.more_tables);
    write(&folder.join("tables.md"), tables_markdown(&tables))?;
    write(&folder.join("tables.tex"), tables_latex(&tables))?;

    let records: Vec<&SpeedRecord> = identification.inputs.iter().map(|input| &input.record).collect();
    let drawings = draw_all(jobs, &records, hearing, SOUND_S_MAX);
    let reasons: Vec<Option<String>> = records.iter().map(|record| record.reason()).collect();
    let trials: Vec<Trial<'_>> = identification
        .inputs
        .iter()
        .zip(&reasons)
        .zip(&drawings)
        .map(|((input, reason), drawing)| trial_of(&input.load, &input.record, reason.as_deref(), drawing.as_ref()))
        .collect();
    let drawn = ExperimentFigures { trials: &trials, tables: identification.tables, method: identification.method };
    let figures = figures_of_experiment(&drawn).map_err(Failure::internal)?;
    figures.par_iter().try_for_each(|figure| write_figure(figure, &figures_folder))?;

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
        command: extras.command,
    };
    let page = report_html(&report).map_err(Failure::internal)?;
    write(&folder.join("report.html"), page)?;
    let named = |name: &str| folder.join(name).display().to_string();
    Ok(["report.html", "results.json", "samples.csv", "tables.md", "tables.tex", FIGURES].map(named).to_vec())
}

/// Writes a figure as SVG and as PNG.
fn write_figure(figure: &Figure, folder: &Path) -> Result<(), Failure> {
    write(&folder.join(format!("{}.svg", figure.name)), &figure.svg)?;
    let png = figure_png(figure, DOTS_PER_INCH).map_err(Failure::internal)?;
    write(&folder.join(format!("{}.png", figure.name)), png)
}

fn write(path: &Path, content: impl AsRef<[u8]>) -> Result<(), Failure> {
    fs::write(path, content).map_err(|error| Failure::cannot_write(&error, path))
}
