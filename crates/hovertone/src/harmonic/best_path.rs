//! The best path through points that are scored frame by frame.

/// What steps from frame to frame cost: (step / σ)² / 2, and beyond `linear_from_stds` σ only that much more for each further σ (Huber).
#[derive(Clone, Copy)]
pub(super) struct StepCost {
    /// σ, in points.
    pub(super) std: f64,
    pub(super) linear_from_stds: f64,
}

impl StepCost {
    /// Steps that are normally distributed.
    pub(super) fn normal(std: f64) -> Self {
        Self { std, linear_from_stds: f64::INFINITY }
    }
}

/// The path of grid points with the highest sum of scores less the cost of each step (Viterbi). The best predecessor
/// of every point is found in one sweep, by the lower envelope of parabolas (Felzenszwalb and Huttenlocher, Theory of
/// Computing 8, 2012); and in one more up and one down, since a long step is a short one followed by single points of constant cost.
pub(super) fn best_path(scores: &[impl AsRef<[f64]>], step: StepCost) -> Vec<usize> {
    let Some((first, rest)) = scores.split_first() else { return Vec::new() };
    let mut total = first.as_ref().to_vec();
    let points = total.len();
    let mut next = vec![0.0; points];
    let curvature = 1.0 / (2.0 * step.std * step.std);
    let point_cost = step.linear_from_stds / step.std;
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
        for (q, (origin, into)) in origin.iter_mut().zip(&mut next).enumerate() {
            while borders[envelope + 1] < q as f64 {
                envelope += 1;
            }
            let p = places[envelope];
            *origin = p as u32;
            *into = total[p] - curvature * (q as f64 - p as f64).powi(2);
        }
        if point_cost.is_finite() {
            for q in 1..points {
                come_from(q - 1, q, point_cost, &mut next, origin);
            }
            for q in (1..points).rev() {
                come_from(q, q - 1, point_cost, &mut next, origin);
            }
        }
        next.iter_mut().zip(score.as_ref()).for_each(|(total, score)| *total += score);
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

/// Lets a point be reached over its neighbour where that costs less.
fn come_from(neighbour: usize, point: usize, cost: f64, totals: &mut [f64], origin: &mut [u32]) {
    if totals[neighbour] - cost > totals[point] {
        totals[point] = totals[neighbour] - cost;
        origin[point] = origin[neighbour];
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
            for (std, linear_from_stds) in [(1.3, f64::INFINITY), (1.3, 1.5), (2.0, 9.0), (0.7, 1.0)] {
                // points are a whole number of steps: the parabola is left where one more costs less than along it
                let cost = |points: f64| {
                    (0..=points as usize)
                        .map(|short| {
                            let far = points - short as f64;
                            let linear = if far > 0.0 { far * linear_from_stds / std } else { 0.0 };
                            (short as f64 / std).powi(2) / 2.0 + linear
                        })
                        .fold(f64::INFINITY, f64::min)
                };
                let value = |path: &[usize]| -> f64 {
                    let levels: f64 = path.iter().zip(&scores).map(|(&place, score)| score[place]).sum();
                    levels - path.windows(2).map(|pair| cost(pair[0].abs_diff(pair[1]) as f64)).sum::<f64>()
                };
                let best = (0..7usize.pow(4))
                    .map(|code| value(&[code % 7, code / 7 % 7, code / 49 % 7, code / 343]))
                    .fold(f64::MIN, f64::max);
                let found = best_path(&scores, StepCost { std, linear_from_stds });
                assert!((value(&found) - best).abs() < 1e-9, "{std} {linear_from_stds}");
            }
        }
        assert!(best_path(&[] as &[Vec<f64>], StepCost::normal(1.0)).is_empty());
    }
}
