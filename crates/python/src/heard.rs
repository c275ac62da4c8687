//! A recording with its answer.

use crate::failure::raised;
use hovertone_analysis::TrackPoint;
use hovertone_cli::Failure;
use hovertone_cli::calls::HeardRecording;
use hovertone_report::{SpeedRecord, numbered_tracks, speed_json, tones_json};
use numpy::{IntoPyArray, PyArray1};
use pyo3::prelude::*;

/// A recording with its answer.
#[pyclass(frozen, module = "hovertone._native")]
pub(crate) struct Heard {
    recording: HeardRecording,
}

impl From<HeardRecording> for Heard {
    fn from(recording: HeardRecording) -> Self {
        Self { recording }
    }
}

/// Times, frequencies of the tone, speeds, their standard uncertainties, levels; numbers of the rotors, fastest first, 0 for all together.
type Track<'py> = (Column<'py>, Column<'py>, Column<'py>, Column<'py>, Column<'py>, Bound<'py, PyArray1<i64>>);
type Column<'py> = Bound<'py, PyArray1<f64>>;

#[pymethods]
impl Heard {
    /// The line of `hovertone speed --json`.
    fn speed_json(&self, py: Python<'_>) -> PyResult<String> {
        speed_json(self.recording.record()).map_err(|error| raised(py, &Failure::internal(error)))
    }

    /// The line of `hovertone tones --json`.
    fn tones_json(&self, py: Python<'_>) -> PyResult<String> {
        tones_json(self.recording.record()).map_err(|error| raised(py, &Failure::internal(error)))
    }

    /// The speed in every frame: one track after the other for the separated rotors, or one for all together.
    fn track<'py>(&self, py: Python<'py>) -> Track<'py> {
        let points = points_of(self.recording.record());
        let column = |value: fn(&TrackPoint) -> f64| {
            points.iter().map(|(_, point)| value(point)).collect::<Vec<f64>>().into_pyarray(py)
        };
        (
            column(|point| point.time_s),
            column(|point| point.tone_hz),
            column(|point| point.speed_rev_s),
            column(|point| point.std_uncertainty_rev_s),
            column(|point| point.level_db),
            points.iter().map(|(rotor, _)| *rotor).collect::<Vec<i64>>().into_pyarray(py),
        )
    }

    /// The spectrogram with the tracks of the rotors as SVG, by another pass over the sound; none of a sound that is too short.
    fn figure(&self, py: Python<'_>) -> PyResult<Option<String>> {
        let figure = py.detach(|| self.recording.figure()).map_err(|failure| raised(py, &failure))?;
        Ok(figure.map(|figure| figure.svg))
    }
}

/// The points of all tracks, each with the number of its rotor: those of `--track`.
fn points_of(record: &SpeedRecord) -> Vec<(i64, TrackPoint)> {
    let mut points = Vec::new();
    for (rotor, track) in numbered_tracks(record) {
        points.extend(track.iter().map(|point| (rotor as i64, *point)));
    }
    points
}
