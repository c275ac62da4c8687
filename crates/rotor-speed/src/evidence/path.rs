//! The path of shaft speeds with the most votes.

/// Largest change of the logarithm of the speed from frame to frame: 13 % in a second, as fast as a motor answers. *Physics.*
const STEP_MAX: f64 = 0.0067;
/// Cost of the largest change, in nats; a smaller one costs its square. *Decision.*
const STEP_NATS: f32 = 2.0;
/// Largest number of hops between frames over which the allowed change grows. *Numeric.*
const GAP_HOPS_MAX: usize = 8;

/// The indices into a grid with a constant step of the logarithm along the best path: one for each frame.
///
/// - `votes[frame][speed]`: votes in nats.
/// - `hops[frame]`: hops since the frame before.
/// - `grid_step`: step of the logarithm of the speed.
///
/// Dynamic programming (Viterbi 1967).
pub(super) fn best_path(votes: &[Vec<f32>], hops: &[usize], grid_step: f64) -> Vec<usize> {
    let Some(first) = votes.first() else { return Vec::new() };
    let points = first.len();
    let mut best = first.clone();
    let mut from: Vec<Vec<u16>> = Vec::with_capacity(votes.len());
    for (votes, &hops) in votes.iter().zip(hops).skip(1) {
        let reach = (STEP_MAX * hops.min(GAP_HOPS_MAX) as f64 / grid_step).round().max(1.0) as usize;
        let mut next = vec![f32::MIN; points];
        let mut arrived = vec![0u16; points];
        for shift in 0..=2 * reach {
            let cost = STEP_NATS * ((shift as f32 - reach as f32) / reach as f32).powi(2);
            // from the point `to + shift − reach`
            let low = reach.saturating_sub(shift);
            let high = points.min((points + reach).saturating_sub(shift));
            for to in low..high {
                let value = best[to + shift - reach] - cost;
                if value > next[to] {
                    next[to] = value;
                    arrived[to] = (to + shift - reach) as u16;
                }
            }
        }
        next.iter_mut().zip(votes).for_each(|(sum, vote)| *sum += vote);
        best = next;
        from.push(arrived);
    }
    let last = (0..points).max_by(|&a, &b| best[a].total_cmp(&best[b])).unwrap_or(0);
    let mut path = vec![last];
    for arrived in from.iter().rev() {
        path.push(usize::from(arrived[path[path.len() - 1]]));
    }
    path.reverse();
    path
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
        assert_eq!(best_path(&votes, &[1, 1, 1], step), best.1);
    }
}
