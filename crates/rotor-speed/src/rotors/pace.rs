//! How fast speeds change, which says how long a frame may be.

use crate::thresholds::STEADY_FRAME_S;

/// A frame is no longer than this: sound in a room loses its phase.
const FRAME_S_MAX: f64 = STEADY_FRAME_S;
/// Frames of rotors that bob are so much shorter than those of others: 1.4 to 2.5 do alike, within what chance makes of 19 flights. *Decision.*
const BOBBING_SHORTER: f64 = 1.75;
/// Frames to either side over which the common speed is averaged. *Decision.*
const COMMON_FRAMES: usize = 2;
/// The same for rotors that bob. *Decision.*
const COMMON_FRAMES_BOBBING: usize = 1;

/// How the speeds of a vehicle's rotors change.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Pace {
    /// By less than 1.5 % in a second (rms), or each independently.
    #[default]
    Steady,
    /// All together, by some percent in some tenths of a second.
    Bobbing,
}

impl Pace {
    /// Length of the frames of a line of some order, around some speed: `√(frame_hz_s2 / f)`, so that what a change of speed smears is as
    /// many resolution cells in any line, up to 0.4 s; and less where they bob.
    pub(super) fn frame_s_of_order(self, frame_hz_s2: f64, speed_rev_s: f64) -> impl Fn(f64) -> f64 {
        move |order| (frame_hz_s2 / (order * speed_rev_s)).sqrt().min(FRAME_S_MAX) / self.shorter()
    }

    /// By how much frames are shorter than those of steady rotors, and coarser.
    pub(super) fn shorter(self) -> f64 {
        match self {
            Self::Steady => 1.0,
            Self::Bobbing => BOBBING_SHORTER,
        }
    }

    pub(super) fn common_frames(self) -> usize {
        match self {
            Self::Steady => COMMON_FRAMES,
            Self::Bobbing => COMMON_FRAMES_BOBBING,
        }
    }
}
