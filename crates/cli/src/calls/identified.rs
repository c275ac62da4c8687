//! An identified experiment, for a program that calls.

use crate::failure::Failure;
use crate::identify::{Identified, Reported};
use hovertone_figures::{ExperimentFigures, Figure, figures_of_experiment};
use hovertone_report::{Identification, results_json};
use std::path::{Path, PathBuf};

/// An experiment with its constant.
pub struct IdentifiedExperiment {
    identified: Identified,
    page: Option<PathBuf>,
}

impl IdentifiedExperiment {
    pub(crate) fn new(Reported { identified, page }: Reported) -> Self {
        Self { identified, page }
    }

    /// The content of results.json.
    ///
    /// # Errors
    /// None is known.
    pub fn json(&self) -> Result<String, Failure> {
        results_json(&self.identified.identification()).map_err(Failure::internal)
    }

    /// The results as the report takes them.
    pub fn identification(&self) -> Identification<'_> {
        self.identified.identification()
    }

    /// The lines to quote: the constants with their ±, and the verdict.
    pub fn quote(&self) -> String {
        self.identified.quote()
    }

    /// The page of the report, where one was written.
    pub fn page(&self) -> Option<&Path> {
        self.page.as_deref()
    }

    /// The figures that need no sound: the fit and the budget.
    ///
    /// # Errors
    /// Errors of the plotting library.
    pub fn figures(&self) -> Result<Vec<Figure>, Failure> {
        let Identification { tables, method, .. } = self.identified.identification();
        figures_of_experiment(&ExperimentFigures { trials: &[], tables, method }).map_err(Failure::internal)
    }
}
