//! A voice or an instrument: a comb of lines that moves as a motor does for some time, and then jumps.
//!
//! It sounds like a rotor while it holds a note. Where it explains the frames far better than the best rotor, it sounds beside a rotor or instead
//! of one. The frames in which it is elsewhere tell: without its lines, they hold a rotor, or none.

use super::excess::{Excess, LONG_S, Looks};
use super::level_table::{Level, UNKNOWN};
use super::path::{reach_by_step, reach_points, step_nats};
use std::sync::Arc;

/// Cost of a jump to a speed that a motor cannot reach, in nats. *Decision.*
const JUMP_NATS: f32 = 8.0;

/// A path that jumps, beside the path of a rotor.
pub(super) struct Voice {
    /// Votes that it has more than the rotor, in nats, as a mean over the frames.
    pub(super) gain_nats: f64,
    /// Point of the grid at which it is in each frame; `None` where it is silent, or near the rotor.
    pub(super) points: Vec<Option<usize>>,
}

/// Votes of all paths that end in one frame, over those of the rotor's path.
struct Sums {
    /// On the rotor's path.
    on_path: f32,
    /// At each point elsewhere.
    elsewhere: Vec<f32>,
}

impl Sums {
    /// The most votes.
    fn most_nats(&self) -> f32 {
        self.elsewhere.iter().copied().fold(self.on_path, f32::max)
    }

    /// Where the most votes are: `None` on the path.
    fn best(&self) -> Option<usize> {
        let elsewhere = self.elsewhere.iter().copied().enumerate().max_by(|(_, a), (_, b)| a.total_cmp(b));
        elsewhere.filter(|(_, nats)| *nats > self.on_path).map(|(point, _)| point)
    }
}

impl Voice {
    /// The path with the most votes of all that may jump between the rotor's path and other speeds, where it has at least `gain_nats_min` more than
    /// the rotor. A speed near that of the rotor, where `is_near(shift)` of the shift in points of the grid holds, is that of another rotor or of an
    /// octave, and no jump.
    ///
    /// - `votes[frame][speed]`: votes in nats.
    /// - `path`: the rotor's, an index in each frame.
    /// - `grid_step`: step of the logarithm of the speed.
    pub(super) fn beside(
        votes: &[Vec<f32>],
        path: &[usize],
        grid_step: f64,
        gain_nats_min: f64,
        is_near: impl Fn(isize) -> bool,
    ) -> Option<Self> {
        // the sums of all frames are large, and few recordings have a voice: only then are they kept
        let most_nats = sums_along(votes, path, grid_step, &is_near, |_| {}).most_nats();
        let gain_nats = f64::from(most_nats) / path.len().max(1) as f64;
        if gain_nats < gain_nats_min {
            return None;
        }
        let mut all: Vec<Sums> = Vec::with_capacity(votes.len());
        let end = sums_along(votes, path, grid_step, &is_near, |sums| all.push(sums));
        Some(Self { gain_nats, points: traced(&all, end.best(), reach_points(1, grid_step)) })
    }

    /// The frames in which it sounds elsewhere, without its lines: nothing is known there.
    ///
    /// - `speed_rev_s(point)`: the speed at a point of the grid.
    pub(super) fn left_out_of(&self, looks: &Looks, speed_rev_s: impl Fn(usize) -> f64) -> Looks {
        let times_s = looks.short.frames.iter().map(|frame| frame.centre_s);
        let notes: Vec<(f64, Option<f64>)> =
            times_s.zip(self.points.iter().map(|point| point.map(&speed_rev_s))).collect();
        Looks {
            short: without_notes(&looks.short, &notes, 0.0),
            long: without_notes(&looks.long, &notes, 0.5 * LONG_S),
        }
    }
}

/// The sums behind the last frame. Those before each frame are handed over.
fn sums_along(
    votes: &[Vec<f32>],
    path: &[usize],
    grid_step: f64,
    is_near: impl Fn(isize) -> bool,
    mut on_sums: impl FnMut(Sums),
) -> Sums {
    let points = votes.first().map_or(0, Vec::len);
    let reach = reach_points(1, grid_step);
    let mut sums = Sums { on_path: 0.0, elsewhere: vec![f32::MIN; points] };
    for (votes, &at) in votes.iter().zip(path) {
        let jumped = sums.most_nats() - JUMP_NATS;
        let mut elsewhere = vec![jumped; points];
        for step in 0..=reach.min(points - 1) {
            reach_by_step(&mut elsewhere, &sums.elsewhere, step, step_nats(step, reach));
        }
        for (to, (sum, vote)) in elsewhere.iter_mut().zip(votes).enumerate() {
            *sum = if is_near(to as isize - at as isize) { f32::MIN } else { *sum + vote - votes[at] };
        }
        let on_path = sums.on_path.max(jumped);
        on_sums(std::mem::replace(&mut sums, Sums { on_path, elsewhere }));
    }
    sums
}

/// The states along the best path that ends in one: a point elsewhere, or `None` on the rotor's path.
///
/// - `sums[frame]`: the votes before each frame.
fn traced(sums: &[Sums], end: Option<usize>, reach: usize) -> Vec<Option<usize>> {
    let mut state = end;
    let mut states: Vec<Option<usize>> = Vec::with_capacity(sums.len());
    for before in sums.iter().rev() {
        states.push(state);
        let (best_state, jumped) = (before.best(), before.most_nats() - JUMP_NATS);
        state = match state {
            None => {
                if before.on_path >= jumped {
                    None
                } else {
                    best_state
                }
            }
            Some(point) => {
                let near = point.saturating_sub(reach)..(point + reach + 1).min(before.elsewhere.len());
                let sum = |from: usize| before.elsewhere[from] - step_nats(from.abs_diff(point), reach);
                let moved = near.map(|from| (from, sum(from))).max_by(|(_, a), (_, b)| a.total_cmp(b));
                moved.filter(|(_, sum)| *sum >= jumped).map_or(best_state, |(from, _)| Some(from))
            }
        };
    }
    states.reverse();
    states
}

/// The frames in whose middle a note sounds, where the lines of all notes within `reach_s` are unknown.
///
/// - `notes`: the middle of each short frame, s, with the speed of the note that sounds in it.
fn without_notes(look: &Excess, notes: &[(f64, Option<f64>)], reach_s: f64) -> Excess {
    let half_bins = (look.resolution_hz() / look.bin_hz).round() as usize;
    look.with_levels(|frame| {
        let from = notes.partition_point(|(time_s, _)| *time_s < frame.centre_s - reach_s);
        let to = notes.partition_point(|(time_s, _)| *time_s <= frame.centre_s + reach_s);
        let around = notes.get(from..to)?;
        around.get(around.len() / 2)?.1?;
        let mut levels: Vec<Level> = frame.levels.to_vec();
        let bins = levels.len();
        for note_rev_s in around.iter().filter_map(|(_, note_rev_s)| *note_rev_s) {
            let lines = (1..).map(|order| (f64::from(order) * note_rev_s / look.bin_hz).round() as usize);
            for bin in lines.take_while(|bin| *bin < bins + half_bins) {
                let end = (bin + half_bins + 1).min(bins);
                levels[bin.saturating_sub(half_bins).min(end)..end].fill(UNKNOWN);
            }
        }
        Some(Arc::from(levels))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tune_gains_by_its_jumps_and_a_rotor_does_not() {
        let (frames, points, step) = (200, 100, 0.0067);
        let votes = |at: fn(usize) -> usize| -> Vec<Vec<f32>> {
            (0..frames).map(|n| (0..points).map(|point| if point == at(n) { 20.0 } else { -5.0 }).collect()).collect()
        };
        let path = vec![20; frames];
        let is_near = |shift: isize| shift.abs() < 10;
        let beside =
            |votes: &[Vec<f32>]| Voice::beside(votes, &path, step, 0.0, is_near).expect("no less than the rotor");
        let rotor = beside(&votes(|_| 20));
        assert_eq!(rotor.gain_nats, 0.0);
        assert!(rotor.points.iter().all(Option::is_none));
        // away for half of the time, in ten stays of ten frames: 25 nats in each of these frames, less twenty jumps
        let tune = beside(&votes(|n| if n / 10 % 2 == 0 { 20 } else { 60 }));
        let expected = 0.5 * 25.0 - 8.0 * 19.0 / 200.0;
        assert!((tune.gain_nats - expected).abs() < 1e-3, "{} {expected}", tune.gain_nats);
        for (n, point) in tune.points.iter().enumerate() {
            assert_eq!(*point, (n / 10 % 2 == 1).then_some(60), "{n}");
        }
    }

    #[test]
    fn the_frames_in_which_a_note_sounds_stay_without_its_lines() {
        let looks = Looks {
            short: Excess::of_levels(2.5, 0.05, 40, &[100; 400]),
            long: Excess::of_levels(0.625, 0.1, 20, &[100; 1600]),
        };
        let points = (0..40).map(|n| (10..30).contains(&n).then_some(n)).collect();
        let voice = Voice { gain_nats: 9.0, points };
        let without = voice.left_out_of(&looks, |_| 100.0);
        let times =
            |look: &Excess| look.frames.iter().map(|frame| (frame.centre_s * 100.0).round()).collect::<Vec<_>>();
        assert_eq!(times(&without.short), (10..30).map(|n| f64::from(5 * n)).collect::<Vec<_>>());
        assert_eq!(times(&without.long), (5..15).map(|n| f64::from(10 * n)).collect::<Vec<_>>());
        for (look, bin_hz) in [(&without.short, 2.5), (&without.long, 0.625)] {
            let unknown = |hz: f64| look.frames[3].levels[(hz / bin_hz) as usize] == UNKNOWN;
            assert!([100.0, 200.0, 900.0].into_iter().all(unknown));
            assert!(![50.0, 150.0, 875.0].into_iter().any(unknown));
        }
    }
}
