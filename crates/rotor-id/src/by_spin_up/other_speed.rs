//! Whether something turns, before a rotor is heard at its speed, at a speed of its own: motors that idle first are not started in
//! the order in which they come up to the hover.

use super::frames::{FRAME_S, Frame};
use super::lines::Lines;

/// Speeds that are looked at, as shares of the slowest and fastest rotor's.
const SPEEDS_SHARE: (f64, f64) = (0.3, 1.2);
/// Of the resolution of the highest line, the step between them.
const STEP_CELLS: f64 = 0.5;
/// Lines nearer than this to one of a rotor that is followed belong to that.
const GUARD_CELLS: f64 = 2.5;
/// Power over that of noise at which a line is there.
const HIT_OVER_NOISE: f64 = 10.0;
/// So many lines must be free to look at, and this share of them there.
const FREE_MIN: usize = 4;
const HIT_SHARE_MIN: f64 = 0.75;
/// It must have this share of the faintest rotor's power, for so many frames in a row.
const POWER_SHARE_MIN: f64 = 0.03;
const FRAMES_IN_A_ROW: usize = 6;
/// What sounds in so many of the hover's frames too is the room's: mains, fans.
const ALWAYS_SHARE: f64 = 0.3;

/// Rotors of which a frame may hold lines, as far as they are followed.
pub(super) struct Followed<'a> {
    pub(super) frame: &'a Frame,
    pub(super) speeds_rev_s: Vec<f64>,
    /// Whether a rotor runs up in it.
    pub(super) is_changing: bool,
}

/// The speed of a series of lines that no rotor accounts for, in frames before the hover and not in those of it.
pub(super) fn other_speed_rev_s(
    before: &[Followed],
    hover: &[Followed],
    lines: &Lines,
    base_order: f64,
    (slowest_rev_s, fastest_rev_s): (f64, f64),
    faintest: f64,
) -> Option<f64> {
    let highest = lines.orders.iter().copied().fold(base_order, f64::max);
    let (low, high) = (SPEEDS_SHARE.0 * slowest_rev_s, SPEEDS_SHARE.1 * fastest_rev_s);
    let step = STEP_CELLS / FRAME_S / highest;
    let speeds: Vec<f64> = (0..((high - low) / step) as usize).map(|at| low + step * at as f64).collect();
    let is_there = |followed: &Followed, speed: f64| {
        let is_free = |hz: f64| {
            followed.speeds_rev_s.iter().all(|rotor| {
                let spacing_hz = base_order * rotor;
                (hz - spacing_hz * (hz / spacing_hz).round()).abs() * FRAME_S > GUARD_CELLS
            })
        };
        let (mut free, mut hits, mut power) = (0, 0, 0.0);
        for (order, noise) in lines.orders.iter().zip(&lines.noise) {
            let hz = order * speed;
            if is_free(hz) {
                let line = followed.frame.at(hz).norm_sqr();
                free += 1;
                hits += usize::from(line > HIT_OVER_NOISE * followed.frame.noise(hz));
                power += line / noise;
            }
        }
        let of_all = power * lines.orders.len() as f64 / f64::from(free.max(1) as u32);
        free >= FREE_MIN && hits as f64 >= HIT_SHARE_MIN * free as f64 && of_all >= POWER_SHARE_MIN * faintest
    };
    let mut always = vec![0_usize; speeds.len()];
    for followed in hover {
        always.iter_mut().zip(&speeds).for_each(|(count, &speed)| *count += usize::from(is_there(followed, speed)));
    }
    let is_always = |at: usize| always[at] as f64 > ALWAYS_SHARE * hover.len() as f64;
    let mut in_a_row = vec![0; speeds.len()];
    for followed in before {
        if followed.is_changing {
            in_a_row.fill(0);
            continue;
        }
        let there: Vec<bool> =
            speeds.iter().enumerate().map(|(at, &speed)| is_there(followed, speed) && !is_always(at)).collect();
        for (at, count) in in_a_row.iter_mut().enumerate() {
            let is_near = there[at.saturating_sub(1)..(at + 2).min(there.len())].contains(&true);
            *count = if is_near { *count + 1 } else { 0 };
            if *count >= FRAMES_IN_A_ROW {
                return Some(speeds[at]);
            }
        }
    }
    None
}
