//! Dynamic programming: the best path through grid points that are scored in each frame.

/// The path of grid points with the highest Σ score − Σ (step / σ)² / 2, where a step is the distance in grid points between
/// neighbouring frames and σ is `step_std` (Viterbi, IEEE Trans. Information Theory 13, 1967).
///
/// The best predecessors of all points of a frame are found in one sweep, as the lower envelope of parabolas (Felzenszwalb and
/// Huttenlocher, Theory of Computing 8, 2012): O(frames × points) operations.
///
/// - `scores`: one row of equal length for each frame. Output: one grid point for each frame; empty without frames.
pub(crate) fn best_path(scores: &[impl AsRef<[f64]>], step_std: f64) -> Vec<usize> {
    let Some((first, rest)) = scores.split_first() else { return Vec::new() };
    let mut total = first.as_ref().to_vec();
    let points = total.len();
    let mut next = vec![0.0; points];
    let mut envelope = Envelope::new(points, 1.0 / (2.0 * step_std * step_std));
    let mut from = vec![0u32; points * rest.len()];
    for (score, origin) in rest.iter().zip(from.chunks_exact_mut(points.max(1))) {
        envelope.build(&total);
        envelope.advance(&total, score.as_ref(), &mut next, origin);
        std::mem::swap(&mut total, &mut next);
    }
    let mut place = (0..points).max_by(|&a, &b| total[a].total_cmp(&total[b])).unwrap_or(0);
    let mut path = vec![place];
    for origin in from.chunks_exact(points.max(1)).rev() {
        place = origin[place] as usize;
        path.push(place);
    }
    path.reverse();
    path
}

/// Upper envelope of the parabolas `total[p] − curvature (q − p)²` over the grid points q.
struct Envelope {
    curvature: f64,
    /// `1 / (2 curvature d)` for each distance d of two vertices.
    per_distance: Vec<f64>,
    /// `curvature q² − total[q]` of each grid point q.
    raised: Vec<f64>,
    /// Vertices of the parabolas on the envelope, from left to right.
    places: Vec<usize>,
    /// Parabola i is highest between the borders i and i + 1.
    borders: Vec<f64>,
}

impl Envelope {
    fn new(points: usize, curvature: f64) -> Self {
        let per_distance = (0..points).map(|distance| 1.0 / (2.0 * curvature * distance as f64)).collect();
        Self { curvature, per_distance, raised: Vec::new(), places: vec![0; points], borders: vec![0.0; points + 1] }
    }

    /// Finds the envelope for the totals of one frame.
    fn build(&mut self, total: &[f64]) {
        let Self { curvature, per_distance, raised, places, borders } = self;
        raised.clear();
        raised.extend(total.iter().enumerate().map(|(q, total)| *curvature * q as f64 * q as f64 - total));
        let mut last = 0;
        places[0] = 0;
        (borders[0], borders[1]) = (f64::NEG_INFINITY, f64::INFINITY);
        for q in 1..total.len() {
            let crossing = |p: usize| (raised[q] - raised[p]) * per_distance[q - p];
            let mut s = crossing(places[last]);
            while s <= borders[last] && last > 0 {
                last -= 1;
                s = crossing(places[last]);
            }
            last += 1;
            places[last] = q;
            (borders[last], borders[last + 1]) = (s, f64::INFINITY);
        }
    }

    /// Writes the totals of the next frame with its `score`, and the best predecessor of each point.
    fn advance(&self, total: &[f64], score: &[f64], next: &mut [f64], origin: &mut [u32]) {
        let mut envelope = 0;
        for (q, ((origin, into), score)) in origin.iter_mut().zip(next).zip(score).enumerate() {
            while self.borders[envelope + 1] < q as f64 {
                envelope += 1;
            }
            let p = self.places[envelope];
            *origin = p as u32;
            *into = total[p] - self.curvature * (q as f64 - p as f64).powi(2) + score;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::{RngExt, SeedableRng};

    #[test]
    fn the_path_is_the_best_of_all_paths() {
        let mut rng = rand_pcg::Pcg64::seed_from_u64(5);
        for _ in 0..50 {
            let scores: Vec<Vec<f64>> = (0..4).map(|_| (0..7).map(|_| rng.random_range(0.0..3.0)).collect()).collect();
            let value = |path: &[usize]| -> f64 {
                let scored: f64 = path.iter().zip(&scores).map(|(&place, score)| score[place]).sum();
                let steps: f64 = path.windows(2).map(|pair| (pair[0] as f64 - pair[1] as f64).powi(2)).sum();
                scored - steps / (2.0 * 1.3 * 1.3)
            };
            let best = (0..7usize.pow(4))
                .map(|code| value(&[code % 7, code / 7 % 7, code / 49 % 7, code / 343]))
                .fold(f64::MIN, f64::max);
            assert!((value(&best_path(&scores, 1.3)) - best).abs() < 1e-9);
        }
        assert!(best_path(&[] as &[Vec<f64>], 1.0).is_empty());
    }
}
