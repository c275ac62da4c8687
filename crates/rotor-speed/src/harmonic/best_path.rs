//! The best path through points that are scored frame by frame.

/// The path of grid points with the highest sum of scores less (step / σ)² / 2 for each step (Viterbi). The best predecessor
/// of every point is found in one sweep, by the lower envelope of parabolas (Felzenszwalb and Huttenlocher, Theory of
/// Computing 8, 2012).
pub(crate) fn best_path(scores: &[impl AsRef<[f64]>], step_std: f64) -> Vec<usize> {
    let Some((first, rest)) = scores.split_first() else { return Vec::new() };
    let mut total = first.as_ref().to_vec();
    let points = total.len();
    let mut next = vec![0.0; points];
    let curvature = 1.0 / (2.0 * step_std * step_std);
    let mut from = vec![0u32; points * rest.len()];
    let (mut places, mut borders) = (vec![0usize; points], vec![0.0f64; points + 1]);
    for (score, origin) in rest.iter().zip(from.chunks_exact_mut(points.max(1))) {
        let mut last = 0;
        places[0] = 0;
        (borders[0], borders[1]) = (f64::NEG_INFINITY, f64::INFINITY);
        for q in 1..points {
            let crossing = |p: usize| {
                let (qf, pf) = (q as f64, p as f64);
                ((curvature * qf * qf - total[q]) - (curvature * pf * pf - total[p])) / (2.0 * curvature * (qf - pf))
            };
            let mut s = crossing(places[last]);
            while s <= borders[last] && last > 0 {
                last -= 1;
                s = crossing(places[last]);
            }
            last += 1;
            places[last] = q;
            (borders[last], borders[last + 1]) = (s, f64::INFINITY);
        }
        let mut envelope = 0;
        for (q, ((origin, into), score)) in origin.iter_mut().zip(&mut next).zip(score.as_ref()).enumerate() {
            while borders[envelope + 1] < q as f64 {
                envelope += 1;
            }
            let p = places[envelope];
            *origin = p as u32;
            *into = total[p] - curvature * (q as f64 - p as f64).powi(2) + score;
        }
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
                let levels: f64 = path.iter().zip(&scores).map(|(&place, score)| score[place]).sum();
                let steps: f64 = path.windows(2).map(|pair| (pair[0] as f64 - pair[1] as f64).powi(2)).sum();
                levels - steps / (2.0 * 1.3 * 1.3)
            };
            let best = (0..7usize.pow(4))
                .map(|code| value(&[code % 7, code / 7 % 7, code / 49 % 7, code / 343]))
                .fold(f64::MIN, f64::max);
            assert!((value(&best_path(&scores, 1.3)) - best).abs() < 1e-9);
        }
        assert!(best_path(&[] as &[Vec<f64>], 1.0).is_empty());
    }
}
