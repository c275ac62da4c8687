//! Which lines are followed, and in which frames.

use crate::thresholds::BELOW_OCTAVE;
use crate::tone::{ToneConfig, blades_known};
use hovertone_signal::RECORDED_RATE_SHARE;
use std::ops::Range;

/// Fastest and slowest speed that is followed, over the speed that was heard: a bench steps by less.
const RANGE_FACTOR: f64 = BELOW_OCTAVE;
/// Turns of the shaft in a frame, at the slowest speed that is usual on a bench: the lines of all orders, half orders as the floor between
/// them, are resolved. *Numeric.*
const FRAME_TURNS: f64 = 4.0;
/// The slowest usual speed, over the speed that was heard. *Decision.*
const SLOW_SHARE: f64 = 0.6;
/// Shortest and longest frame: noise; and the time constants of motors. *Decision.*
const FRAME_S_MIN: f64 = 0.03;
const FRAME_S_MAX: f64 = 0.1;
/// Highest frequency of a line of a blade pass: above, noise of air covers the lines. *Decision.*
const BLADE_PASS_HZ_MAX: f64 = 4000.0;
/// Lines of a gear mesh. *Decision.*
const MESH_LINES: f64 = 3.3;
/// Lines at most. *Numeric.*
const LINES_MAX: u32 = 20;
/// Frames per length of a frame. *Numeric.*
const HOPS_PER_FRAME: f64 = 10.0;

/// The lines of a tone, and the frames in which they are followed.
#[derive(Clone, Copy, Debug)]
pub(super) struct TrackedLines {
    /// Order of the first line.
    pub(super) order: f64,
    /// Highest frequency of a line.
    pub(super) hz_max: f64,
    pub(super) slowest_rev_s: f64,
    pub(super) fastest_rev_s: f64,
    pub(super) frame_s: f64,
    pub(super) hop_s: f64,
}

impl TrackedLines {
    /// The lines of rotors that were heard at a speed.
    pub(super) fn of_heard(tone: &ToneConfig, heard_rev_s: f64, sample_rate_hz: f64) -> Self {
        let range_rev_s = heard_rev_s / RANGE_FACTOR..heard_rev_s * RANGE_FACTOR;
        let frame_s = (FRAME_TURNS / (SLOW_SHARE * heard_rev_s)).clamp(FRAME_S_MIN, FRAME_S_MAX);
        Self::new(tone, range_rev_s, frame_s, sample_rate_hz)
    }

    /// The lines of rotors at any speed.
    pub(super) fn of_any(tone: &ToneConfig, sample_rate_hz: f64) -> Self {
        Self::new(tone, tone.speed_min.rev_s()..tone.speed_max.rev_s(), FRAME_S_MAX, sample_rate_hz)
    }

    fn new(tone: &ToneConfig, range_rev_s: Range<f64>, frame_s: f64, sample_rate_hz: f64) -> Self {
        // a line of low order crosses few cells of a spectrum in a step
        let order = blades_known(tone).map_or(tone.order.lines_per_turn(), f64::from);
        let of_mesh_hz = MESH_LINES * order * (range_rev_s.start * range_rev_s.end).sqrt();
        Self {
            order,
            hz_max: BLADE_PASS_HZ_MAX.max(of_mesh_hz).min(RECORDED_RATE_SHARE * sample_rate_hz),
            slowest_rev_s: range_rev_s.start,
            fastest_rev_s: range_rev_s.end,
            frame_s,
            hop_s: frame_s / HOPS_PER_FRAME,
        }
    }

    /// Lines of a shaft at this speed.
    pub(super) fn count_at(&self, speed_rev_s: f64) -> u32 {
        ((self.hz_max / (self.order * speed_rev_s)) as u32).min(LINES_MAX)
    }
}
