//! All figures of an experiment, in the order of the paper.

use crate::figure::{Figure, FigureError};
use crate::trial::Trial;
use crate::{budget, database, fit, gaussian, load_spectrograms, maximum_trace, rotors, spectrum};
use hovertone_analysis::Method;
use hovertone_thrust::ThrustTable;

/// Input of the figures of an experiment.
#[derive(Clone, Copy, Debug)]
pub struct ExperimentFigures<'a> {
    /// All recordings, load by load.
    pub trials: &'a [Trial<'a>],
    /// One table for each method.
    pub tables: &'a [ThrustTable],
    /// The method whose constant is reported.
    pub method: Method,
}

/// Figures 5 to 9 of the paper, then the fit, the budget, and the first trial with separated rotors. A figure without data is left out.
///
/// # Errors
/// Errors of the plotting library.
pub fn figures_of_experiment(experiment: &ExperimentFigures<'_>) -> Result<Vec<Figure>, FigureError> {
    let ExperimentFigures { trials, tables, method } = *experiment;
    let mut figures = vec![
        database::figure(trials)?,
        load_spectrograms::figure(trials)?,
        spectrum::figure(trials)?,
        maximum_trace::figure(trials)?,
        gaussian::figure(trials)?,
        fit::figure(tables, method)?,
    ];
    if let Some(table) = tables.iter().find(|table| table.method == method) {
        figures.push(budget::figure(table)?);
    }
    let separated = trials.iter().find(|trial| trial.tone().is_some_and(|tone| !tone.rotors.is_empty()));
    figures.push(match separated {
        Some(trial) => rotors::rotors_figure(trial, "rotors")?,
        None => None,
    });
    Ok(figures.into_iter().flatten().collect())
}
