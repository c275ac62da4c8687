//! The folder of results: the report, and its tables and figures as separate files.

use crate::drawing::draw_all;
use crate::failure::Failure;
use crate::output_folder::OutputFolder;
use crate::recording::{Hearing, Job};
use hovertone_figures::{DOTS_PER_INCH, Figure, figure_png, recording_figure};
use hovertone_page::{SOUND_S_MAX, experiment_tables};
use hovertone_report::{
    Identification, RESULTS_SCHEMA, SpeedRecord, loads_data, results_json, samples_data, tables_latex, tables_markdown,
};
use hovertone_workflow::{Drawn, ReportExtras, ReportFigures};
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

/// Reads the recordings again for their pictures and writes all files.
pub(crate) fn write_report(
    identification: &Identification<'_>,
    jobs: &[Job],
    hearing: Hearing,
    extras: &ReportExtras<'_>,
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
    let drawn = Drawn::new(identification, drawings);
    let trials = drawn.trials();
    let experiment = drawn.experiment_figures(&trials).map_err(Failure::internal)?;
    experiment.par_iter().try_for_each(|figure| write_figure(figure, folder))?;
    let recordings: Vec<Option<Figure>> = trials
        .par_iter()
        .enumerate()
        .map(|(index, trial)| recording_figure(trial, &format!("recording-{}", index + 1)))
        .collect::<Result<_, _>>()
        .map_err(Failure::internal)?;
    let page = drawn.page(&ReportFigures { experiment, recordings }, &results, extras).map_err(Failure::internal)?;
    folder.write(PAGE, page)
}

/// Writes a figure as SVG and as PNG.
fn write_figure(figure: &Figure, folder: &OutputFolder) -> Result<(), Failure> {
    folder.write(&format!("{FIGURES}/{}.svg", figure.name), &figure.svg)?;
    let png = figure_png(figure, DOTS_PER_INCH).map_err(Failure::internal)?;
    folder.write(&format!("{FIGURES}/{}.png", figure.name), png)
}
