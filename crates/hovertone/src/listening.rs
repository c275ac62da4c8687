//! Readings of a source after the first: the stretches of its hover.

use crate::error::Error;
use crate::hover::Hover;
use crate::signal::SignalSource;
use crate::span::Span;
use crate::stream::{Piece, Progress, for_each_piece};

/// The survey, and the reading of the hover; where more are needed, each shows as the second.
pub(crate) const PASS_COUNT: u32 = 2;

/// A piece of the hover.
pub(crate) enum HoverSound<'a> {
    /// A stretch begins, and should last so long.
    Start {
        start_s: f64,
        length_s: f64,
    },
    Samples(&'a [f32]),
}

/// Any reading after the first: the stretches of the hover, one after the other.
pub(crate) fn listen_again(
    source: &mut dyn SignalSource,
    hover: &Hover,
    on_progress: &mut dyn FnMut(Progress),
    mut take: impl FnMut(HoverSound<'_>),
) -> Result<(), Error> {
    let mut segments = hover.segments.iter();
    for_each_piece(source, &hover.segments, |piece| match piece {
        Piece::Start(start_s) => {
            take(HoverSound::Start { start_s, length_s: segments.next().map_or(0.0, Span::length_s) });
        }
        Piece::Samples(samples) => take(HoverSound::Samples(samples)),
        Piece::Heard(time_s) => on_progress(Progress { pass: PASS_COUNT, pass_count: PASS_COUNT, time_s }),
    })?;
    Ok(())
}
