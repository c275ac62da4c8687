//! Where the rotors are, roughly: a path for each through a map of all lines from which the others have been taken away, each in
//! turn (RELAX), with the best path by Viterbi's algorithm.

use super::atoms::ChannelAtoms;
use super::grid::OffsetGrid;
use super::scores::{GridScores, Trust};
use super::spectra::Spectra;
use crate::harmonic::best_path::best_path;
use crate::thresholds::SEARCHED_NOISE_STDS_MAX;
use hovertone_signal::statistics::median;

/// How much a rotor's speed changes from one frame to the next, as a share. *Decision.*
const STEP_STD_SHARE: f64 = 0.001;
/// A rotor's own track covers so many points of the grid to either side. *Numeric.*
const OWN_POINTS: usize = 1;
/// What a rotor claims of what was left over is taken from so many points to either side. *Numeric.*
const CLAIMED_POINTS: usize = 5;
/// The best of some hundred points of noise lies so many median deviations over their median: 3.4 standard deviations.
const NOTHING_DEVIATIONS: f64 = SEARCHED_NOISE_STDS_MAX;

/// The tracks of `count` rotors as offsets from the common speed in each frame: those that are not known from `start`, one after the
/// other, and then `sweeps` times each again beside all others.
pub(super) fn found_tracks(
    spectra: &Spectra,
    atoms: &[ChannelAtoms],
    grid: &OffsetGrid,
    start: &[Vec<f64>],
    count: usize,
    sweeps: usize,
    trust: Trust<'_>,
) -> Vec<Vec<f64>> {
    let middle = spectra.common_rev_s.iter().sum::<f64>() / spectra.frames().max(1) as f64;
    let step_std = step_std(grid, middle) * (spectra.frames_apart() as f64).sqrt();
    let mut searches: Vec<SearchBeside> = (0..count).map(|_| SearchBeside::new(spectra.frames())).collect();
    let mut tracks: Vec<Vec<f64>> = start.to_vec();
    let mut grid_scores = GridScores::new(spectra, atoms, grid, trust);
    let mut find = |rotor: usize, tracks: &[Vec<f64>]| -> Vec<f64> {
        let others: Vec<&Vec<f64>> =
            tracks.iter().enumerate().filter(|(other, _)| *other != rotor).map(|(_, track)| track).collect();
        let scores = searches[rotor].scores(&others, |frame, others| grid_scores.of_frame(frame, others));
        best_path(scores, step_std).into_iter().map(|place| grid.offset_rev_s(place)).collect()
    };
    while tracks.len() < count {
        let track = find(tracks.len(), &tracks);
        tracks.push(track);
    }
    if count > 1 {
        for rotor in (0..sweeps).flat_map(|_| 0..count) {
            tracks[rotor] = find(rotor, &tracks);
        }
    }
    tracks
}

/// What speaks for one rotor, frame by frame. Where the others stay where they were, it stays what it was.
struct SearchBeside {
    scores: Vec<Vec<f64>>,
    /// Where the others were; `None` before the first search.
    others_rev_s: Vec<Option<Vec<f64>>>,
}

impl SearchBeside {
    fn new(frames: usize) -> Self {
        Self { scores: vec![Vec::new(); frames], others_rev_s: vec![None; frames] }
    }

    fn scores(&mut self, others: &[&Vec<f64>], mut score: impl FnMut(usize, &[f64]) -> Vec<f64>) -> &[Vec<f64>] {
        for (frame, (scores, before)) in self.scores.iter_mut().zip(&mut self.others_rev_s).enumerate() {
            let now: Vec<f64> = others.iter().map(|track| track[frame]).collect();
            if before.as_ref() != Some(&now) {
                *scores = score(frame, &now);
                *before = Some(now);
            }
        }
        &self.scores
    }
}

/// The tracks of rotors whose lines have all been taken away, leaving `rest_scores`: each stays at its own offset, which is worth so
/// much in each frame, or goes where something is left over that is worth more, or where another rotor hides it. What one claims
/// is no longer there for the next; those that share another's rotor, and so are worth least, come first.
pub(super) fn reclaimed_tracks(
    rest_scores: &[Vec<f64>],
    offsets_rev_s: &[Vec<f64>],
    worths: &[&[f64]],
    grid: &OffsetGrid,
    middle_rev_s: f64,
) -> Vec<Vec<f64>> {
    let nothing: Vec<f64> = rest_scores.iter().map(|scores| worth_of_nothing(scores)).collect();
    let mut left = rest_scores.to_vec();
    let mut tracks = offsets_rev_s.to_vec();
    let total = |rotor: usize| worths[rotor].iter().sum::<f64>();
    let mut order: Vec<usize> = (0..tracks.len()).collect();
    order.sort_by(|&a, &b| total(a).total_cmp(&total(b)));
    for rotor in order {
        let scores: Vec<Vec<f64>> = left
            .iter()
            .enumerate()
            .map(|(frame, left)| {
                let mut scores = left.clone();
                for (other, track) in tracks.iter().enumerate() {
                    let worth = if other == rotor { worths[rotor][frame] } else { nothing[frame] };
                    for score in &mut scores[grid.points_around(track[frame], OWN_POINTS)] {
                        *score = worth.max(*score);
                    }
                }
                scores
            })
            .collect();
        for (frame, place) in best_path(&scores, step_std(grid, middle_rev_s)).into_iter().enumerate() {
            if !grid.points_around(tracks[rotor][frame], OWN_POINTS + 1).contains(&place) {
                let offset = grid.offset_rev_s(place);
                tracks[rotor][frame] = offset;
                for score in &mut left[frame][grid.points_around(offset, CLAIMED_POINTS)] {
                    *score = score.min(nothing[frame]);
                }
            }
        }
    }
    tracks
}

/// In each frame, what speaks for one more rotor on the best path through `rest_scores`, which all rotors together leave, beyond what noise has
/// there and beyond `ghosts`, what may be left of one of them.
pub(super) fn worths_of_another(
    rest_scores: &[Vec<f64>],
    ghosts: &[f64],
    grid: &OffsetGrid,
    middle_rev_s: f64,
) -> Vec<f64> {
    let path = best_path(rest_scores, step_std(grid, middle_rev_s));
    let worth =
        |((place, scores), ghost): ((usize, &Vec<f64>), &f64)| scores[place] - worth_of_nothing(scores).max(*ghost);
    path.into_iter().zip(rest_scores).zip(ghosts).map(worth).collect()
}

/// What the best point of a frame is worth where there is nothing but noise, as its other points tell.
fn worth_of_nothing(scores: &[f64]) -> f64 {
    let middle = median(scores).unwrap_or_default();
    let deviations: Vec<f64> = scores.iter().map(|score| (score - middle).abs()).collect();
    middle + NOTHING_DEVIATIONS * median(&deviations).unwrap_or_default()
}

/// Standard deviation of the step from frame to frame, in points.
fn step_std(grid: &OffsetGrid, middle_rev_s: f64) -> f64 {
    STEP_STD_SHARE * middle_rev_s / grid.step_rev_s
}
