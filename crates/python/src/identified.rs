//! An experiment with its constant.

use crate::failure::raised;
use hovertone_cli::Failure;
use hovertone_cli::calls::IdentifiedExperiment;
use hovertone_report::{loads_data, samples_data};
use pyo3::prelude::*;
use std::path::PathBuf;

/// An experiment with its constant.
#[pyclass(frozen, module = "hovertone._native")]
pub(crate) struct Identified {
    experiment: IdentifiedExperiment,
}

impl From<IdentifiedExperiment> for Identified {
    fn from(experiment: IdentifiedExperiment) -> Self {
        Self { experiment }
    }
}

#[pymethods]
impl Identified {
    /// The content of results.json.
    fn json(&self, py: Python<'_>) -> PyResult<String> {
        self.experiment.json().map_err(|failure| raised(py, &failure))
    }

    /// The content of samples.csv and of loads.csv.
    fn tables(&self, py: Python<'_>) -> PyResult<(String, String)> {
        let tables = self.experiment.identification().tables;
        let csv =
            |table: hovertone_report::DataTable| table.csv().map_err(|error| raised(py, &Failure::internal(error)));
        Ok((csv(samples_data(tables))?, csv(loads_data(tables))?))
    }

    /// The lines to quote: the constants with their ±, and the verdict.
    fn quote(&self) -> String {
        self.experiment.quote()
    }

    /// The page of the report, where one was written.
    fn page(&self) -> Option<PathBuf> {
        self.experiment.page().map(PathBuf::from)
    }

    /// Name, title and SVG of each figure that needs no sound.
    fn figures(&self, py: Python<'_>) -> PyResult<Vec<(String, String, String)>> {
        let figures = py.detach(|| self.experiment.figures()).map_err(|failure| raised(py, &failure))?;
        Ok(figures.into_iter().map(|figure| (figure.name, figure.title, figure.svg)).collect())
    }
}
