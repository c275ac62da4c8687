//! The report of an identified experiment: its figures, its page, and the lines for simulators.

use crate::drawing::{Drawing, trial_of};
use hovertone::speed::Method;
use hovertone_exchange::{SimulatorFormat, export_text, identified_from_results};
use hovertone_figures::{ExperimentFigures, Figure, FigureError, Trial, figures_of_experiment};
use hovertone_page::{PageError, Report, SimulatorLines, TrialReport, names_of, report_html};
use hovertone_report::{Identification, TextTable, TitledTable};

/// An identification with its recordings drawn.
#[derive(Debug)]
pub struct Drawn<'a> {
    identification: &'a Identification<'a>,
    names: Vec<String>,
    reasons: Vec<Option<String>>,
    drawings: Vec<Option<Drawing>>,
}

/// The figures of a report.
#[derive(Debug)]
pub struct ReportFigures {
    /// Those of the experiment.
    pub experiment: Vec<Figure>,
    /// One spectrogram for each recording, where there is one.
    pub recordings: Vec<Option<Figure>>,
}

/// Content of the report beside the identification.
#[derive(Clone, Copy, Debug, Default)]
pub struct ReportExtras<'a> {
    /// Tables that replace the table of a method.
    pub compared: &'a [(Method, TextTable)],
    /// Additional tables.
    pub more_tables: &'a [TitledTable],
    /// The command that repeats the run.
    pub command: &'a str,
    /// Day of the run, as 2026-11-26; empty where it is not known.
    pub date: &'a str,
}

impl<'a> Drawn<'a> {
    /// One drawing for each recording, in its order.
    pub fn new(identification: &'a Identification<'a>, drawings: Vec<Option<Drawing>>) -> Self {
        Self {
            names: names_of(identification.inputs),
            reasons: identification.inputs.iter().map(|input| input.record.reason()).collect(),
            identification,
            drawings,
        }
    }

    /// The recordings as input of the figures.
    pub fn trials(&self) -> Vec<Trial<'_>> {
        let inputs = self.identification.inputs.iter().zip(&self.names);
        inputs
            .zip(self.reasons.iter().zip(&self.drawings))
            .map(|((input, name), (reason, drawing))| Trial {
                recording: name,
                ..trial_of(&input.load, &input.record, reason.as_deref(), drawing.as_ref())
            })
            .collect()
    }

    /// The figures of the experiment.
    ///
    /// # Errors
    /// None is known.
    pub fn experiment_figures(&self, trials: &[Trial<'_>]) -> Result<Vec<Figure>, FigureError> {
        let Identification { tables, method, .. } = *self.identification;
        figures_of_experiment(&ExperimentFigures { trials, tables, method })
    }

    /// The page. `results` are the results as JSON, from which the lines for simulators come.
    ///
    /// # Errors
    /// None is known.
    pub fn page(&self, figures: &ReportFigures, results: &str, extras: &ReportExtras<'_>) -> Result<String, PageError> {
        let trials: Vec<TrialReport<'_>> = figures
            .recordings
            .iter()
            .zip(&self.drawings)
            .map(|(figure, drawing)| TrialReport {
                figure: figure.as_ref(),
                sound: drawing.as_ref().and_then(|drawing| drawing.sound.as_ref()),
            })
            .collect();
        report_html(&Report {
            identification: self.identification,
            figures: &figures.experiment,
            trials: &trials,
            compared: extras.compared,
            more_tables: extras.more_tables,
            simulators: &simulators_of(results),
            command: extras.command,
            date: extras.date,
        })
    }
}

/// The lines for every simulator that takes what the results have; none without a constant.
pub fn simulators_of(results: &str) -> Vec<SimulatorLines> {
    let Ok(rotor) = identified_from_results(results, None) else { return Vec::new() };
    let lines = |format: SimulatorFormat| {
        Some(SimulatorLines { name: format.name().to_owned(), text: export_text(&rotor, format).ok()? })
    };
    SimulatorFormat::ALL.into_iter().filter_map(lines).collect()
}
