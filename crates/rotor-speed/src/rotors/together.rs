//! The rotors as one pattern. A vehicle that bobs moves them all at once, while what sets them apart changes slowly: so at each
//! moment all of them tell together how fast it moves, and over some tenths of a second each tells how far it is from the others.

use super::grid::OffsetGrid;
use super::paths::{offsets_from, smoothed_mean};
use crate::harmonic::best_path::best_path;
use hovertone_signal::statistics::{mean, median};
use std::ops::RangeInclusive;

/// At first, how far a rotor is from the mean of all is the median over so many frames to either side (0.3 s). *Decision.*
const SLOW_FRAMES: usize = 8;
/// Standard deviation of the step of the shared speed from one frame to the next beside what is known of it, as a share of the speed. *Decision.*
const SHARED_STEP_STD_SHARE: f64 = 0.004;
/// The same for the distance of a rotor from the shared speed. *Decision.*
const OWN_STEP_STD_SHARE: f64 = 0.0003;
/// Tracks closer than so many points of the grid, two resolution cells, are in one place. *Numeric.*
const ONE_PLACE_POINTS: f64 = 4.0;
/// By this factor more speaks for the pattern of rotors that turn alike, or in pairs, than for tracks that scatter around them: 1.28 to 1.40 in
/// simulated flights; 1.03 and 1.06 in two recordings of real ones in which a rotor was lost to its neighbour. *Decision.*
const ALIKE_GAIN: f64 = 1.25;
/// The score of where a rotor cannot be. *Numeric.*
const BARRED: f64 = -1e6;

/// What speaks for one rotor at each offset from a common speed, frame by frame.
#[derive(Default)]
pub(super) struct FrameScores {
    pub(super) scores: Vec<Vec<f64>>,
    pub(super) grid: OffsetGrid,
    pub(super) common_rev_s: Vec<f64>,
}

impl FrameScores {
    /// What speaks for a rotor of some speed in one frame.
    fn at(&self, frame: usize, speed_rev_s: f64) -> f64 {
        self.grid.score_at(&self.scores[frame], speed_rev_s - self.common_rev_s[frame])
    }

    fn frames(&self) -> usize {
        self.scores.len()
    }

    /// A step from frame to frame in points of the grid.
    fn points_of(&self, share: f64) -> f64 {
        share * mean(&self.common_rev_s).unwrap_or_default() / self.grid.step_rev_s
    }

    /// What speaks for tracks in all frames; for those closer than so many points of the grid only once.
    fn total(&self, tracks: &[Vec<f64>], one_place_points: f64) -> f64 {
        let of_frame = |frame: usize| -> f64 {
            let mut speeds: Vec<f64> = tracks.iter().map(|track| track[frame]).collect();
            speeds.sort_by(f64::total_cmp);
            speeds.dedup_by(|faster, slower| *faster - *slower < one_place_points * self.grid.step_rev_s);
            speeds.into_iter().map(|speed| self.at(frame, speed)).sum()
        };
        (0..self.frames()).map(of_frame).sum()
    }

    /// Whether more speaks for these tracks than for others.
    ///
    /// A rotor that is drawn to its louder neighbour's line must not count for that, so tracks in one place count once: then tracks
    /// that scatter around one line count for more than those of rotors that turn alike, in one place. These show by how much
    /// more speaks for all of them.
    pub(super) fn speak_more_for(&self, tracks: &[Vec<f64>], others: &[Vec<f64>]) -> bool {
        self.total(tracks, ONE_PLACE_POINTS) > self.total(others, ONE_PLACE_POINTS)
            || self.total(tracks, 0.0) > ALIKE_GAIN * self.total(others, 0.0)
    }

    /// The tracks as a pattern: it moves as a whole to where most speaks for it, by up to `reach_rev_s` from where it is known to be;
    /// and along that each rotor goes slowly to where most speaks for it alone.
    pub(super) fn moved_as_one(&self, tracks: &[Vec<f64>], reach_rev_s: f64) -> Vec<Vec<f64>> {
        if self.frames() == 0 {
            return tracks.to_vec();
        }
        let offsets = slow_offsets(tracks);
        let shared_rev_s = self.shared_motion(&offsets, reach_rev_s);
        let along =
            |offsets: Vec<f64>| offsets.iter().zip(&shared_rev_s).map(|(offset, shared)| shared + offset).collect();
        let own = |rotor: usize| self.own_offsets(rotor, &offsets, &shared_rev_s, reach_rev_s);
        (0..offsets.len()).map(|rotor| along(own(rotor))).collect()
    }

    /// The speed from which all rotors keep their offsets.
    fn shared_motion(&self, offsets_rev_s: &[Vec<f64>], reach_rev_s: f64) -> Vec<f64> {
        let side = (reach_rev_s / self.grid.step_rev_s).round();
        let shift_rev_s = |place: f64| (place - side) * self.grid.step_rev_s;
        let scores: Vec<Vec<f64>> = (0..self.frames())
            .map(|frame| {
                let speed = |place: usize| self.common_rev_s[frame] + shift_rev_s(place as f64);
                let of_all =
                    |speed: f64| offsets_rev_s.iter().map(|own| self.at(frame, speed + own[frame])).sum::<f64>();
                (0..=2 * side as usize).map(|place| of_all(speed(place))).collect()
            })
            .collect();
        best_path(&scores, self.points_of(SHARED_STEP_STD_SHARE))
            .into_iter()
            .zip(&scores)
            .zip(&self.common_rev_s)
            .map(|((place, scores), common)| common + shift_rev_s(place as f64 + to_the_top(scores, place)))
            .collect()
    }

    /// How far a rotor is from the shared speed. It stays on its side of the middle between it and others.
    fn own_offsets(
        &self,
        rotor: usize,
        offsets_rev_s: &[Vec<f64>],
        shared_rev_s: &[f64],
        reach_rev_s: f64,
    ) -> Vec<f64> {
        let own = &offsets_rev_s[rotor];
        let (low, high) =
            own.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &o| (low.min(o), high.max(o)));
        let (low, high) = (low - reach_rev_s, high + reach_rev_s);
        let points = ((high - low) / self.grid.step_rev_s).max(0.0) as usize + 1;
        let offset_rev_s = |place: usize| low + place as f64 * self.grid.step_rev_s;
        let scores: Vec<Vec<f64>> = (0..self.frames())
            .map(|frame| {
                let side = own_side(rotor, offsets_rev_s, frame);
                // of alike rotors one has no side but where it is
                let known = ((own[frame] - low) / self.grid.step_rev_s).round() as usize;
                let at = |place: usize| {
                    let is_barred = place != known && !side.contains(&offset_rev_s(place));
                    if is_barred { BARRED } else { self.at(frame, shared_rev_s[frame] + offset_rev_s(place)) }
                };
                (0..points).map(at).collect()
            })
            .collect();
        best_path(&scores, self.points_of(OWN_STEP_STD_SHARE)).into_iter().map(offset_rev_s).collect()
    }
}

/// From the middle between a rotor and the next slower one to the middle between it and the next faster one.
fn own_side(rotor: usize, offsets_rev_s: &[Vec<f64>], frame: usize) -> RangeInclusive<f64> {
    let own = offsets_rev_s[rotor][frame];
    let (mut from, mut to) = (f64::NEG_INFINITY, f64::INFINITY);
    for (index, other) in
        offsets_rev_s.iter().map(|offsets| offsets[frame]).enumerate().filter(|(index, _)| *index != rotor)
    {
        let middle = (own + other) / 2.0;
        if (other, index) < (own, rotor) {
            from = from.max(middle);
        } else {
            to = to.min(middle);
        }
    }
    from..=to
}

/// How far each track is from the mean of all, over some tenths of a second.
fn slow_offsets(tracks: &[Vec<f64>]) -> Vec<Vec<f64>> {
    let slow = |offsets: Vec<f64>| {
        let near = |frame: usize| frame.saturating_sub(SLOW_FRAMES)..(frame + SLOW_FRAMES + 1).min(offsets.len());
        (0..offsets.len()).map(|frame| median(&offsets[near(frame)]).unwrap_or_default()).collect()
    };
    offsets_from(tracks, &smoothed_mean(tracks, 0)).into_iter().map(slow).collect()
}

/// How far the top of a parabola through a point and its neighbours is from it.
fn to_the_top(scores: &[f64], place: usize) -> f64 {
    let neighbours = place.checked_sub(1).and_then(|before| Some((scores.get(before)?, scores.get(place + 1)?)));
    neighbours.map_or(0.0, |(before, after)| {
        let bend = 2.0 * scores[place] - before - after;
        if bend > 0.0 { ((after - before) / 2.0 / bend).clamp(-0.5, 0.5) } else { 0.0 }
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    const REAL: [f64; 4] = [0.9, 0.3, 0.3, -0.9];
    const FRAMES: usize = 120;

    fn motion(frame: usize) -> f64 {
        0.5 * (frame as f64 / 4.0).sin()
    }

    /// Peaks of rotors, two of them alike, that move together around a common speed of 60; in noise.
    fn scores(rng: &mut impl rand::Rng) -> FrameScores {
        let grid = OffsetGrid::of_points(-3.0, 0.05, 121);
        let of_frame = |frame: usize| {
            let heights = REAL.map(|_| rng.random_range(2.0..20.0));
            let at = |offset: f64, noise: f64| {
                let peak =
                    |(place, height): (f64, f64)| height * (-((offset - place - motion(frame)) / 0.12).powi(2)).exp();
                REAL.into_iter().zip(heights).map(peak).sum::<f64>() + noise
            };
            (0..121).map(|point| at(-3.0 + 0.05 * f64::from(point), rng.random_range(0.0..2.0))).collect()
        };
        FrameScores { scores: (0..FRAMES).map(of_frame).collect(), grid, common_rev_s: vec![60.0; FRAMES] }
    }

    #[test]
    fn a_pattern_moves_as_one_and_alike_rotors_are_not_set_apart() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(8);
        let scores = scores(&mut rng);
        // tracks that lag behind and scatter; of the two alike each has its own place
        let known = [0.9, 0.4, 0.2, -0.9];
        let tracks: Vec<Vec<f64>> = known
            .iter()
            .map(|own| {
                (0..FRAMES).map(|frame| 60.0 + own + 0.6 * motion(frame) + rng.random_range(-0.2..0.2)).collect()
            })
            .collect();
        let found = scores.moved_as_one(&tracks, 1.8);
        for (track, real) in found.iter().zip(REAL) {
            let errors: Vec<f64> = (0..FRAMES).map(|frame| track[frame] - 60.0 - real - motion(frame)).collect();
            // a point of the grid, and three
            assert!(mean(&errors).unwrap().abs() <= 0.05, "{real}: {:?}", mean(&errors));
            assert!(errors.iter().filter(|error| error.abs() < 0.15).count() > 110, "{real}: {errors:?}");
        }
        assert!(scores.speak_more_for(&found, &tracks) && !scores.speak_more_for(&tracks, &found));
        // a rotor in another one's place is none
        let lost = [found[0].clone(), found[1].clone(), found[2].clone(), found[0].clone()];
        assert!(!scores.speak_more_for(&lost, &found) && scores.speak_more_for(&found, &lost));
        assert_eq!(FrameScores::default().moved_as_one(&tracks, 1.8), tracks);
    }

    #[test]
    fn each_rotor_has_a_side_of_its_own() {
        let offsets = [vec![0.4], vec![0.4], vec![-0.2]];
        assert_eq!(own_side(0, &offsets, 0), 0.1..=0.4);
        assert_eq!(own_side(1, &offsets, 0), 0.4..=f64::INFINITY);
        assert_eq!(own_side(2, &offsets, 0), f64::NEG_INFINITY..=0.1);
    }

    #[test]
    fn the_top_is_that_of_a_parabola() {
        let parabola: Vec<f64> = (0..5).map(|n| 7.0 - (f64::from(n) - 2.3).powi(2)).collect();
        assert!((to_the_top(&parabola, 2) - 0.3).abs() < 1e-12);
        assert_eq!((to_the_top(&parabola, 0), to_the_top(&parabola, 4)), (0.0, 0.0));
    }
}
