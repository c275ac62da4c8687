//! Another pass over a recording, for its pictures and for the sound of the report.

use hovertone::speed::Span;
use hovertone_figures::{PictureConfig, PictureError, Pictures, Trial, pictures_from_source, views_of_recording};
use hovertone_media::Recording;
use hovertone_page::{SoundClip, clip_from_source};
use hovertone_report::SpeedRecord;

/// Pictures and sound of a recording.
#[derive(Debug)]
pub struct Drawing {
    /// Its pictures.
    pub pictures: Pictures,
    /// The wanted part of its sound.
    pub sound: Option<SoundClip>,
}

/// Reads a recording again for its pictures and for at most `sound_s_max` seconds of its sound; `None` for a recording that was not heard.
///
/// # Errors
/// The sound cannot be read again.
pub fn drawing_of(
    recording: &mut Recording,
    record: &SpeedRecord,
    sound_s_max: Option<f64>,
) -> Result<Option<Drawing>, PictureError> {
    let Some(analysis) = record.analysis() else { return Ok(None) };
    let config = PictureConfig::default();
    let views = views_of_recording(record.tone(), recording.info().sample_rate_hz, &config);
    let segments = &analysis.hover.segments;
    let pictures = pictures_from_source(recording, analysis.heard, &views, segments, &config)?;
    let sound = sound_s_max.map(|sound_s_max| {
        let Span { from_s, to_s } = analysis.heard;
        // the sound of a long recording starts with the hover, not with the walk to the drone
        let begins_late = to_s - from_s > sound_s_max;
        let from_s = segments.first().filter(|_| begins_late).map_or(from_s, |segment| segment.from_s);
        clip_from_source(recording, Span { from_s, to_s: to_s.min(from_s + sound_s_max) })
    });
    let sound = sound.transpose().map_err(hovertone::sound::SignalError::from)?;
    Ok(Some(Drawing { pictures, sound }))
}

/// A record with its drawing, as input of the figures.
pub fn trial_of<'a>(
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
        readings: record.alternatives(),
        method: record.method,
        pictures: drawing.map(|drawing| &drawing.pictures),
    }
}
