//! Tracks of four rotors against the truth.

use super::sound::{MEAN_REV_S, Rendered};
use hovertone::speed::TrackPoint;

/// Frames at which tracks are compared with the truth, and what is left out at either end.
const FRAME_S: f64 = 0.05;
const EDGE_S: f64 = 0.3;
/// Steps of the mean square.
const STEP_S: f64 = 0.01;
/// A track says nothing this far from its nearest point.
const GAP_S: f64 = 0.08;

/// How one clip was heard.
pub(super) struct Score {
    /// Share of the frames in which all four are right.
    pub(super) set: f64,
    /// Share of rotors and frames that are right under one labelling.
    pub(super) identity: f64,
    /// Of each rotor in each frame, as a share of the speed.
    pub(super) errors: Vec<f64>,
    /// Of the mean square over the clip, as a share.
    pub(super) mean_square_error: f64,
    /// Share of rotors and frames within twice their uncertainty.
    pub(super) covered: f64,
}

pub(super) fn against_truth(
    tracks: &[&[TrackPoint]],
    rendered: &Rendered,
    duration_s: f64,
    spacing_share: f64,
) -> Score {
    let tolerance_rev_s = (0.4 * spacing_share * MEAN_REV_S).max(0.05);
    let times = |step_s: f64| {
        (0..).map(move |step| EDGE_S + step_s * f64::from(step)).take_while(move |time_s| *time_s < duration_s - EDGE_S)
    };
    let count = tracks.len();
    let labellings = permutations(count);
    let (mut right, mut frames, mut covered, mut errors) = (0usize, 0usize, 0usize, Vec::new());
    let mut right_as = vec![0usize; labellings.len()];
    for time_s in times(FRAME_S) {
        let truth = rendered.speeds_at(time_s);
        let said: Vec<Option<(f64, f64)>> = tracks.iter().map(|track| at(track, time_s)).collect();
        let off =
            |rotor: usize, real: usize| said[rotor].map_or(f64::INFINITY, |(speed, _)| (speed - truth[real]).abs());
        let is_right = |rotor: usize, real: usize| off(rotor, real) < tolerance_rev_s;
        let cost = |labelling: &[usize]| (0..count).map(|rotor| off(rotor, labelling[rotor]).min(1.0)).sum::<f64>();
        frames += 1;
        if let Some(best) = labellings.iter().min_by(|a, b| cost(a).total_cmp(&cost(b))) {
            right += usize::from((0..count).all(|rotor| is_right(rotor, best[rotor])));
            for (rotor, &real) in best.iter().enumerate() {
                if let Some((_, std)) = said[rotor] {
                    errors.push(off(rotor, real) / MEAN_REV_S);
                    covered += usize::from(off(rotor, real) <= 2.0 * std);
                }
            }
        }
        for (labelling, right_as) in labellings.iter().zip(&mut right_as) {
            *right_as += (0..count).filter(|&rotor| is_right(rotor, labelling[rotor])).count();
        }
    }
    let squares: Vec<f64> = times(STEP_S)
        .flat_map(|time_s| tracks.iter().filter_map(move |track| Some(at(track, time_s)?.0.powi(2))))
        .collect();
    let mean_square = squares.iter().sum::<f64>() / squares.len().max(1) as f64;
    Score {
        set: right as f64 / frames.max(1) as f64,
        identity: right_as.iter().copied().max().unwrap_or(0) as f64 / (count * frames).max(1) as f64,
        covered: covered as f64 / errors.len().max(1) as f64,
        errors,
        mean_square_error: mean_square / rendered.mean_square(EDGE_S, duration_s - EDGE_S) - 1.0,
    }
}

/// Speed and its uncertainty between the two nearest points of a track.
fn at(track: &[TrackPoint], time_s: f64) -> Option<(f64, f64)> {
    let next = track.partition_point(|point| point.time_s < time_s);
    match (track.get(next.wrapping_sub(1)), track.get(next)) {
        (Some(a), Some(b)) if b.time_s - a.time_s < 2.0 * GAP_S => {
            let share = (time_s - a.time_s) / (b.time_s - a.time_s);
            let std = a.std_uncertainty_rev_s.max(b.std_uncertainty_rev_s);
            Some((a.speed_rev_s + share * (b.speed_rev_s - a.speed_rev_s), std))
        }
        (Some(a), _) if time_s - a.time_s < GAP_S => Some((a.speed_rev_s, a.std_uncertainty_rev_s)),
        (_, Some(b)) if b.time_s - time_s < GAP_S => Some((b.speed_rev_s, b.std_uncertainty_rev_s)),
        _ => None,
    }
}

fn permutations(count: usize) -> Vec<Vec<usize>> {
    if count == 0 {
        return vec![Vec::new()];
    }
    let longer = |shorter: Vec<usize>| {
        (0..count).map(move |place| {
            let mut longer = shorter.clone();
            longer.insert(place, count - 1);
            longer
        })
    };
    permutations(count - 1).into_iter().flat_map(longer).collect()
}
