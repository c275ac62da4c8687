//! Another pass over the recordings, for their pictures and for the sound of the page.

use crate::failure::Failure;
use crate::recording::{Hearing, Job};
use hovertone::speed::Span;
use hovertone_figures::Trial;
use hovertone_figures::{PictureConfig, Pictures, pictures_from_source, views_of_recording};
use hovertone_page::{SoundClip, clip_from_source};
use hovertone_report::SpeedRecord;
use rayon::prelude::*;

/// Pictures and sound of a recording.
pub(crate) struct Drawing {
    pub(crate) pictures: Pictures,
    pub(crate) sound: Option<SoundClip>,
}

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
    let Some(analysis) = record.analysis() else { return Err(unreadable(&"it could not be heard")) };
    let mut recording = job.open(hearing).map_err(|error| unreadable(&error))?;
    let config = PictureConfig::default();
    let rate_hz = recording.info().sample_rate_hz;
    let views = views_of_recording(record.tone(), rate_hz, &config);
    let segments = &analysis.hover.segments;
    let pictures = pictures_from_source(&mut recording, analysis.heard, &views, segments, &config)
        .map_err(|error| unreadable(&error))?;
    let sound = sound_s_max.map(|sound_s_max| {
        let Span { from_s, to_s } = analysis.heard;
        // the sound of a long recording starts with the hover, not with the walk to the drone
        let begins_late = to_s - from_s > sound_s_max;
        let from_s = segments.first().filter(|_| begins_late).map_or(from_s, |segment| segment.from_s);
        clip_from_source(&mut recording, Span { from_s, to_s: to_s.min(from_s + sound_s_max) })
    });
    let sound = sound.transpose().map_err(|error| unreadable(&error))?;
    Ok(Drawing { pictures, sound })
}

/// A record with its drawing, as input of the figures.
pub(crate) fn trial_of<'a>(
    load: &'a str,
    record: &'a SpeedRecord,
    reason: Option<&'a str>,
    drawing: Option<&'a Drawing>,
) -> Trial<'a> {
    Trial {
        load,
        recording: &record.file,
        analysis: record.analysis(),
        reason,
        method: record.method,
        pictures: drawing.map(|drawing| &drawing.pictures),
    }
}
