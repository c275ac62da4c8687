//! Choice of the audio track: the first that is not silent.

use crate::error::MediaError;
use crate::file_access::FileAccess;
use crate::frames::Incidents;
use crate::plan::Plan;
use crate::tracks::Tracks;

/// One step of 16-bit sound. A track that never exceeds it is silent, whatever its codec.
const SILENCE_MAX: f32 = 1.0 / 32_768.0;

/// The chosen track.
pub(crate) struct Choice {
    /// Index of the track, counted from 0.
    pub(crate) index: usize,
    pub(crate) plan: Plan,
    /// Silent tracks before it, counted from 1.
    pub(crate) silent: Vec<usize>,
}

/// Decodes the tracks in order up to the first sound. If all are silent, the choice is the first that decodes.
pub(crate) fn first_audible_track(file: &dyn FileAccess, tracks: &Tracks<'_>) -> Result<Choice, MediaError> {
    let mut silent = Vec::new();
    let mut first_silent = None;
    let mut first_error = None;
    for index in 0..tracks.count() {
        let heard = tracks.plan(index).and_then(|plan| Ok((is_audible(file, &plan)?, plan)));
        match heard {
            Ok((true, plan)) => return Ok(Choice { index, plan, silent }),
            Ok((false, plan)) => {
                silent.push(index + 1);
                first_silent.get_or_insert((index, plan));
            }
            Err(error) => {
                first_error.get_or_insert(error);
            }
        }
    }
    match (first_silent, first_error) {
        (Some((index, plan)), _) => Ok(Choice { index, plan, silent: Vec::new() }),
        (None, Some(error)) => Err(error),
        (None, None) => Err(MediaError::NoSuchTrack { asked: 1, count: 0 }),
    }
}

fn is_audible(file: &dyn FileAccess, plan: &Plan) -> Result<bool, MediaError> {
    let mut frames = plan.open(file)?;
    let mut interleaved = Vec::new();
    let mut incidents = Incidents::default();
    loop {
        let has_more = frames.next_frames(&mut interleaved, &mut incidents).map_err(MediaError::Read)?;
        if interleaved.iter().any(|sample| sample.abs() > SILENCE_MAX) {
            return Ok(true);
        }
        if !has_more {
            return Ok(false);
        }
    }
}
