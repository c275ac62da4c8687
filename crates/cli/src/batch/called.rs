//! The recordings of an archive and their rows for a program that calls, such as an engine that has a cluster of its own.

use super::hearing::heard_always;
use super::inputs::{Names, recordings_of};
use super::{hearing_of, requests_of};
use crate::args::BatchArguments;
use crate::failure::Failure;
use crate::progress::Progress;
use crate::recording::Job;
use crate::settings::config_of;
use hovertone_archive::{ArchiveRow, Part};

/// The names of the recordings, in the order of the tables. Flags without a meaning are refused here, before a cluster works.
pub(crate) fn names(arguments: &BatchArguments) -> Result<Vec<String>, Failure> {
    config_of(&arguments.tone, &arguments.known, &arguments.analysis)?;
    let plan = Names::of(&recordings_of(&arguments.inputs)?.found)?.plan();
    Ok(plan.recordings().iter().map(|recording| recording.name.clone()).collect())
}

/// The row of the first input, which is one recording, as a stream of Arrow IPC. One that cannot be heard is a row with its error.
pub(crate) fn row(arguments: &BatchArguments) -> Result<Vec<u8>, Failure> {
    let (config, discovery) = config_of(&arguments.tone, &arguments.known, &arguments.analysis)?;
    let Some(path) = arguments.inputs.first() else { return Err(Failure::internal("there is no recording")) };
    let job = Job {
        path: path.clone(),
        name: path.to_string_lossy().into_owned(),
        config,
        discovery,
        requests: requests_of(arguments),
        sha256: None,
        samples: None,
    };
    let progress = Progress::new("hearing", 1, false);
    let heard = heard_always(&job, hearing_of(arguments), &progress);
    let row = ArchiveRow { record: heard.record, error_class: heard.error_class };
    Part::new(&row, None).and_then(|part| part.row_stream()).map_err(Failure::internal)
}
