//! The path of shaft speeds with the most votes.

use std::ops::Range;

/// Largest change of the logarithm of the speed from frame to frame: 13 % in a second, as fast as a motor answers. *Physics.*
const STEP_MAX: f64 = 0.0067;
/// Cost of the largest change, in nats; a smaller one costs its square. *Decision.*
const STEP_NATS: f32 = 2.0;
/// Largest number of hops between frames over which the allowed change grows. *Numeric.*
const GAP_HOPS_MAX: usize = 8;

/// The indices into a grid with a constant step of the logarithm along the best path: one for each frame.
///
/// - `votes[frame][speed]`: votes in nats.
/// - `range`: the part of the grid where the path may run.
/// - `hops[frame]`: hops since the frame before.
/// - `grid_step`: step of the logarithm of the speed.
///
/// Dynamic programming (Viterbi 1967).
pub(super) fn best_path(votes: &[Vec<f32>], range: Range<usize>, hops: &[usize], grid_step: f64) -> Vec<usize> {
    let Some(first) = votes.first() else { return Vec::new() };
    let points = range.len();
    // for each frame, the votes of the best path to each point
    let mut sums: Vec<Vec<f32>> = vec![first[range.clone()].to_vec()];
    for (frame, (votes, &hops)) in votes.iter().zip(hops).enumerate().skip(1) {
        let reach = reach_points(hops, grid_step);
        let mut next = vec![f32::MIN; points];
        for step in 0..=reach.min(points - 1) {
            reach_by_step(&mut next, &sums[frame - 1], step, step_nats(step, reach));
        }
        next.iter_mut().zip(&votes[range.clone()]).for_each(|(sum, vote)| *sum += vote);
        sums.push(next);
    }
    let mut path = Vec::with_capacity(sums.len());
    let mut to: Option<usize> = None;
    for (frame, sums) in sums.iter().enumerate().rev() {
        let reach = hops.get(frame + 1).map_or(points, |&hops| reach_points(hops, grid_step));
        let value = |from: usize| to.map_or(sums[from], |to| sums[from] - step_nats(from.abs_diff(to), reach));
        let near = to.map_or(0..points, |to| to.saturating_sub(reach)..(to + reach + 1).min(points));
        let from = near.max_by(|&a, &b| value(a).total_cmp(&value(b)));
        path.extend(from);
        to = from;
    }
    path.reverse();
    path.into_iter().map(|point| range.start + point).collect()
}

/// Raises the sums to those that are reached by a step of so many points, up or down, at a cost.
pub(super) fn reach_by_step(next: &mut [f32], sums: &[f32], step: usize, cost: f32) {
    next[step..].iter_mut().zip(sums).for_each(|(to, from)| *to = larger(*to, from - cost));
    next.iter_mut().zip(&sums[step..]).for_each(|(to, from)| *to = larger(*to, from - cost));
}

/// The larger of two numbers, in one instruction of a processor: [`f32::max`] also asks whether one is none.
fn larger(a: f32, b: f32) -> f32 {
    if b > a { b } else { a }
}

/// Largest step of a path over so many hops, in points of the grid.
pub(super) fn reach_points(hops: usize, grid_step: f64) -> usize {
    (STEP_MAX * hops.min(GAP_HOPS_MAX) as f64 / grid_step).round().max(1.0) as usize
}

/// Cost of a step of a path that reaches so many points.
pub(super) fn step_nats(step: usize, reach: usize) -> f32 {
    STEP_NATS * (step as f32 / reach as f32).powi(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_best_path_is_that_of_all_paths() {
        // three frames, five speeds, steps of one point: all 5 · 3 · 3 paths by hand
        let votes: Vec<Vec<f32>> =
            vec![vec![0.0, 1.0, 0.0, 0.0, 2.0], vec![0.0, 0.0, 3.0, 0.0, 0.0], vec![2.9, 3.0, 0.0, 4.0, 0.0]];
        let step = STEP_MAX;
        let mut all = Vec::new();
        for a in 0..5usize {
            for b in a.saturating_sub(1)..(a + 2).min(5) {
                for c in b.saturating_sub(1)..(b + 2).min(5) {
                    let moves = STEP_NATS * (f32::from(u8::from(a != b)) + f32::from(u8::from(b != c)));
                    all.push((votes[0][a] + votes[1][b] + votes[2][c] - moves, vec![a, b, c]));
                }
            }
        }
        let best = all.iter().max_by(|a, b| a.0.total_cmp(&b.0)).unwrap();
        assert_eq!(best_path(&votes, 0..5, &[1, 1, 1], step), best.1);
    }
}
