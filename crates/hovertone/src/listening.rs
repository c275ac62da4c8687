//! Readings of a source after the first: the stretches of its hover.

use crate::error::Error;
use crate::hover::Hover;
use crate::signal::SignalSource;
use crate::span::Span;
use crate::stream::{Piece, Progress, for_each_piece};

/// The survey, and the reading of the hover; where more are needed, each shows as the second.
pub(crate) const PASS_COUNT: u32 = 2;

/// What hears the stretches of a hover.
pub(crate) trait HoverListener {
    /// A new stretch of sound begins at `start_s` and should last `length_s`.
    fn restart(&mut self, start_s: f64, length_s: f64);

    fn push(&mut self, samples: &[f32]);
}

/// Several at once.
impl<L: HoverListener> HoverListener for Vec<L> {
    fn restart(&mut self, start_s: f64, length_s: f64) {
        self.iter_mut().for_each(|listener| listener.restart(start_s, length_s));
    }

    fn push(&mut self, samples: &[f32]) {
        self.iter_mut().for_each(|listener| listener.push(samples));
    }
}

/// Two of different kinds.
impl<A: HoverListener, B: HoverListener> HoverListener for (A, B) {
    fn restart(&mut self, start_s: f64, length_s: f64) {
        self.0.restart(start_s, length_s);
        self.1.restart(start_s, length_s);
    }

    fn push(&mut self, samples: &[f32]) {
        self.0.push(samples);
        self.1.push(samples);
    }
}

/// Any reading after the first: the stretches of the hover, one after the other.
pub(crate) fn listen_again(
    source: &mut dyn SignalSource,
    hover: &Hover,
    listener: &mut impl HoverListener,
    on_progress: &mut dyn FnMut(Progress),
) -> Result<(), Error> {
    let mut segments = hover.segments.iter();
    for_each_piece(source, &hover.segments, |piece| match piece {
        Piece::Start(start_s) => listener.restart(start_s, segments.next().map_or(0.0, Span::length_s)),
        Piece::Samples(samples) => listener.push(samples),
        Piece::Heard(time_s) => on_progress(Progress { pass: PASS_COUNT, pass_count: PASS_COUNT, time_s }),
    })?;
    Ok(())
}
