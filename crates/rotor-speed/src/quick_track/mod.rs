//! The speed over time in frames as short as the lines allow, through steps and other fast changes: for the constants of motors.
//!
//! ```text
//! sound ─ coarse ▶ path of a comb over short frames
//! sound ─ aligned ▶ lines along a path, one frame at a time ─ offsets ▶ distance of each frame from the path ─ piece ▶ track
//! ```
//!
//! Along a path that is right, a line stands still, so that a frame may be longer than the speed takes to change. What a frame sees of a path
//! that is not quite right is known ([`hovertone_signal::spectrogram::hann_frequency_weight`]): each speed of the track is the mean of the true
//! speed with this weight. The response of the frame belongs to the model that is fitted to the track.

mod aligned;
mod coarse;
mod held;
mod lines;
mod offsets;
mod path;
mod piece;
mod turn_frames;

use crate::error::Error;
use crate::tone::ToneConfig;
use coarse::CoarseListener;
use hovertone_signal::passes::Passes;
use lines::TrackedLines;
pub use path::SpeedPath;
use piece::{Approach, PieceListener};
use std::ops::Range;
pub use turn_frames::{PathWindow, TurnFrame, TurnFrames, turn_frames_from_passes};

/// Passes of [`quick_track_from_passes`]. *Numeric.*
pub const PASSES_OF_QUICK_TRACK: u32 = 2;

/// Speed of the rotors in short frames. Of several rotors it is the speed of their lines together.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct QuickTrack {
    /// Length of the Hann frames: each speed is the mean of the true one with the weight of such a frame.
    pub frame_s: f64,
    /// Stretches in which the rotors are heard, in the sequence of time.
    pub stretches: Vec<QuickStretch>,
}

/// A stretch of a [`QuickTrack`] without gaps.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct QuickStretch {
    /// Middle of each frame, in equal steps.
    pub time_s: Vec<f64>,
    /// Speed of each frame.
    pub speed_rev_s: Vec<f64>,
}

/// The speed in short frames of rotors that were heard at a speed; two passes. Speeds from `heard_rev_s` / 1.9 to 1.9 `heard_rev_s` are followed.
///
/// # Errors
/// A source that fails.
pub fn quick_track_from_passes(
    passes: &mut Passes<'_>,
    tone: &ToneConfig,
    heard_rev_s: f64,
    span_s: Range<f64>,
) -> Result<QuickTrack, Error> {
    let lines = TrackedLines::of_heard(tone, heard_rev_s, passes.sample_rate_hz());
    let spans = std::slice::from_ref(&span_s);
    let mut coarse = CoarseListener::new(&lines, passes.sample_rate_hz());
    passes.listen(spans, &mut coarse)?;
    let path = coarse.finish();
    let mut pieces = PieceListener::new(&lines, &path, Approach::FromAfar, passes.sample_rate_hz());
    passes.listen(spans, &mut pieces)?;
    Ok(pieces.finish())
}

/// Spans in which a tone of the order is held, longest first, whoever makes it: a bench whose speed steps has no hover, but its levels are as
/// steady as one. One pass.
///
/// # Errors
/// A source that fails.
pub fn held_spans_from_passes(
    passes: &mut Passes<'_>,
    tone: &ToneConfig,
    span_s: Range<f64>,
) -> Result<Vec<Range<f64>>, Error> {
    let lines = TrackedLines::of_any(tone, passes.sample_rate_hz());
    let mut coarse = CoarseListener::new(&lines, passes.sample_rate_hz());
    passes.listen(std::slice::from_ref(&span_s), &mut coarse)?;
    Ok(held::held_spans(&coarse.finish()))
}

/// The track along a path that is near the true speed, such as fitted curves; one pass. A speed is the path as the frame sees it, and the slope of
/// the frame's likelihood over the mean curvature: where least squares leave nothing of these distances, the likelihood of all sound is highest.
///
/// # Errors
/// A source that fails.
pub fn quick_track_along(
    passes: &mut Passes<'_>,
    tone: &ToneConfig,
    heard_rev_s: f64,
    span_s: Range<f64>,
    path: &SpeedPath,
) -> Result<QuickTrack, Error> {
    let lines = TrackedLines::of_heard(tone, heard_rev_s, passes.sample_rate_hz());
    let mut pieces = PieceListener::new(&lines, path, Approach::Near, passes.sample_rate_hz());
    passes.listen(std::slice::from_ref(&span_s), &mut pieces)?;
    Ok(pieces.finish())
}
