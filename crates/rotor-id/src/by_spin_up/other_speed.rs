//! Lines of a rotor at another speed, before the rotors reach the speeds of the hover: motors that idle first do not start in the sequence
//! in which they come up to the hover.

use super::frames::{FRAME_S, Frame};
use super::joint_lines::JointLines;

/// Slowest speed that is searched, as a share of the slowest rotor's. *Decision.*
const SLOWEST_SHARE: f64 = 0.3;
/// Fastest speed that is searched, as a share of the fastest rotor's. *Decision.*
const FASTEST_SHARE: f64 = 1.2;
/// Step of the speed, in resolution cells of the highest line. *Numeric.*
const STEP_CELLS: f64 = 0.5;
/// Distance in resolution cells from the line of a known rotor, up to which a line belongs to that rotor: the main lobe of a Hann window
/// has two cells on either side. *Numeric.*
const GUARD_CELLS: f64 = 2.5;
/// Power over that of the noise above which a line is audible. *Decision.*
const AUDIBLE_OVER_NOISE: f64 = 10.0;
/// Fewest lines of a speed that lie apart from the known rotors. *Decision.*
const APART_LINES_MIN: usize = 4;
/// Smallest share of these lines that are audible. *Decision.*
const AUDIBLE_SHARE_MIN: f64 = 0.75;
/// Smallest power of a series, as a share of the faintest rotor's power in the hover. *Decision.*
const POWER_SHARE_MIN: f64 = 0.03;
/// Fewest consecutive frames of a series. *Decision.*
const FRAMES_MIN: usize = 6;
/// Share of the frames of the hover above which a series belongs to the room: mains hum, fans. *Decision.*
const ROOM_SHARE: f64 = 0.3;

/// A frame and the rotors that are known to sound in it.
pub(super) struct KnownFrame<'a> {
    pub(super) frame: &'a Frame,
    pub(super) speeds_rev_s: Vec<f64>,
    /// Does a rotor run up in this frame?
    pub(super) is_run_up: bool,
}

/// The search for a series of lines that no known rotor makes.
pub(super) struct OtherSpeedSearch<'a> {
    pub(super) lines: &'a JointLines,
    /// All lines of the rotors lie at multiples of this order.
    pub(super) base_order: f64,
    pub(super) slowest_rev_s: f64,
    pub(super) fastest_rev_s: f64,
    /// Power of the faintest rotor in the hover.
    pub(super) faintest_power: f64,
}

impl OtherSpeedSearch<'_> {
    /// The speed of a series that is present in consecutive frames of `before`, and in few frames of `hover`.
    pub(super) fn speed_rev_s(&self, before: &[KnownFrame<'_>], hover: &[KnownFrame<'_>]) -> Option<f64> {
        let speeds = self.speeds_rev_s();
        let mut hover_frames = vec![0_usize; speeds.len()];
        for known in hover {
            let present = speeds.iter().map(|&speed| usize::from(self.is_present(known, speed)));
            hover_frames.iter_mut().zip(present).for_each(|(count, present)| *count += present);
        }
        let is_room = |at: usize| hover_frames[at] as f64 > ROOM_SHARE * hover.len() as f64;
        let mut consecutive = vec![0; speeds.len()];
        for known in before {
            if known.is_run_up {
                consecutive.fill(0);
                continue;
            }
            let present: Vec<bool> =
                speeds.iter().enumerate().map(|(at, &speed)| self.is_present(known, speed) && !is_room(at)).collect();
            for (at, count) in consecutive.iter_mut().enumerate() {
                // a speed may change by one step from frame to frame
                let is_near = present[at.saturating_sub(1)..(at + 2).min(present.len())].contains(&true);
                *count = if is_near { *count + 1 } else { 0 };
                if *count >= FRAMES_MIN {
                    return Some(speeds[at]);
                }
            }
        }
        None
    }

    /// The speeds that are searched.
    fn speeds_rev_s(&self) -> Vec<f64> {
        let highest = self.lines.orders.iter().copied().fold(self.base_order, f64::max);
        let (low, high) = (SLOWEST_SHARE * self.slowest_rev_s, FASTEST_SHARE * self.fastest_rev_s);
        let step = STEP_CELLS / FRAME_S / highest;
        (0..((high - low) / step) as usize).map(|at| low + step * at as f64).collect()
    }

    /// Does a frame hold a series of lines of this speed, apart from the lines of the known rotors?
    fn is_present(&self, known: &KnownFrame<'_>, speed_rev_s: f64) -> bool {
        let is_apart = |hz: f64| {
            known.speeds_rev_s.iter().all(|rotor| {
                let spacing_hz = self.base_order * rotor;
                (hz - spacing_hz * (hz / spacing_hz).round()).abs() * FRAME_S > GUARD_CELLS
            })
        };
        let (mut apart, mut audible, mut power) = (0, 0, 0.0);
        for (order, noise) in self.lines.orders.iter().zip(&self.lines.noise) {
            let hz = order * speed_rev_s;
            if is_apart(hz) {
                let line = known.frame.at(hz).norm_sqr();
                apart += 1;
                audible += usize::from(line > AUDIBLE_OVER_NOISE * known.frame.noise(hz));
                power += line / noise;
            }
        }
        let of_all = power * self.lines.orders.len() as f64 / f64::from(apart.max(1) as u32);
        apart >= APART_LINES_MIN
            && audible as f64 >= AUDIBLE_SHARE_MIN * apart as f64
            && of_all >= POWER_SHARE_MIN * self.faintest_power
    }
}
