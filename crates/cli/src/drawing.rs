//! Another pass over the recordings, for their pictures and for the sound of the page.

use crate::failure::Failure;
use crate::recording::{Hearing, Job};
use hovertone_report::SpeedRecord;
use hovertone_workflow::Drawing;
use rayon::prelude::*;

/// Draws all recordings in parallel, in the order of the jobs. A recording that cannot be read again has no drawing; its record has the
/// reason.
pub(crate) fn draw_all(
    jobs: &[Job],
    records: &[&SpeedRecord],
    hearing: Hearing,
    sound_s_max: f64,
) -> Vec<Option<Drawing>> {
    let draw = |(job, record): (&Job, &&SpeedRecord)| drawing_of(job, record, hearing, Some(sound_s_max)).ok();
    jobs.par_iter().zip(records).map(draw).collect()
}

/// Reads a recording again for its pictures and for the wanted part of its sound.
pub(crate) fn drawing_of(
    job: &Job,
    record: &SpeedRecord,
    hearing: Hearing,
    sound_s_max: Option<f64>,
) -> Result<Drawing, Failure> {
    let unreadable = |error: &dyn std::fmt::Display| {
        Failure::failed(format!("the recording could not be read again: {error}"), "check the disk", &job.path)
    };
    let mut recording = job.open(hearing).map_err(|error| unreadable(&error))?;
    let drawing = hovertone_workflow::drawing_of(&mut recording, record, sound_s_max);
    drawing.map_err(|error| unreadable(&error))?.ok_or_else(|| unreadable(&"it could not be heard"))
}
