//! Mean, spread, median, uncertainty of the mean of a correlated series, and sums of likelihoods.

/// Standard deviation of a normal distribution over its median absolute deviation (Rousseeuw and Croux 1993). *Physics.*
pub const STD_PER_MEDIAN_DEVIATION: f64 = 1.4826;

/// Arithmetic mean, in the unit of the values. `None` for an empty slice.
pub fn mean(values: &[f64]) -> Option<f64> {
    (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
}

/// Mean of values that each count as their square, `Σ x³ / Σ x²`, in the unit of the values: the typical one of the large values, even where
/// these are few. `None` where none differs from 0.
pub fn mean_by_square(values: impl IntoIterator<Item = f64>) -> Option<f64> {
    let (mut cubes, mut squares) = (0.0, 0.0);
    for value in values {
        cubes += value.powi(3);
        squares += value.powi(2);
    }
    (squares > 0.0).then(|| cubes / squares)
}

/// Sample standard deviation, in the unit of the values: s = √(Σ (x − x̄)² / (n − 1)). `None` for fewer than two values.
///
/// This is eq 8 of the paper with the square that the printed form lacks.
pub fn std(values: &[f64]) -> Option<f64> {
    let centre = mean(values).filter(|_| values.len() >= 2)?;
    let squares: f64 = values.iter().map(|value| (value - centre).powi(2)).sum();
    Some((squares / (values.len() - 1) as f64).sqrt())
}

/// Median, in the unit of the values. For an even count it is the upper of the two middle values. `None` for an empty slice.
pub fn median(values: &[f64]) -> Option<f64> {
    let mut values = values.to_vec();
    let middle = values.len() / 2;
    (!values.is_empty()).then(|| *values.select_nth_unstable_by(middle, f64::total_cmp).1)
}

/// Standard uncertainty of the mean of a correlated series, in the unit of the values.
///
/// Formula: u = s √(τ / n), where s is the standard deviation, n the count, and τ the integrated autocorrelation time
/// τ = −1 + 2 Σ (ρ_2m + ρ_2m+1), m = 0, 1, …; the sum ends at the first pair that is not positive.
///
/// - Source: Geyer, Statistical Science 7, 1992 (initial positive sequence estimator).
/// - The sum covers lags up to a third of the series. τ is at least 1.
/// - Values count as equally spaced: the function does not know of gaps.
/// - Limit: for a series shorter than about 10 τ the result is too small, because the series does not show its correlation.
/// - `None` for fewer than two values.
pub fn std_uncertainty_of_mean(values: &[f64]) -> Option<f64> {
    let (centre, spread) = (mean(values)?, std(values)?);
    let count = values.len();
    let variance: f64 = values.iter().map(|value| (value - centre).powi(2)).sum();
    if variance <= 0.0 {
        return Some(0.0);
    }
    let correlation = |lag: usize| {
        let products: f64 =
            values[lag..].iter().zip(values).map(|(late, early)| (late - centre) * (early - centre)).sum();
        products / variance
    };
    let mut correlation_time = -1.0;
    let mut lag = 0;
    while lag == 0 || lag < count / 3 {
        let pair = correlation(lag) + correlation((lag + 1).min(count - 1));
        if pair <= 0.0 {
            break;
        }
        correlation_time += 2.0 * pair;
        lag += 2;
    }
    Some(spread * (correlation_time.max(1.0) / count as f64).sqrt())
}

/// A term that is smaller than the largest by a factor of e to this power does not change a sum of `f64`: 3·10⁻²⁰. *Numeric.*
const NEGLIGIBLE_NATS: f64 = 45.0;

/// ln Σ exp(x) without overflow: the largest x is factored out. Each x is the logarithm of a likelihood or probability.
/// −∞ for no values. Terms that are too small to change the sum are left out.
pub fn log_sum_exp(logarithms: impl Iterator<Item = f64>) -> f64 {
    let (mut largest, mut sum) = (f64::NEG_INFINITY, 0.0);
    for value in logarithms {
        if value > largest {
            sum = if value - largest > NEGLIGIBLE_NATS { 1.0 } else { sum * (largest - value).exp() + 1.0 };
            largest = value;
        } else if largest - value <= NEGLIGIBLE_NATS {
            sum += (value - largest).exp();
        }
    }
    if sum > 0.0 { largest + sum.ln() } else { largest }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    #[test]
    fn small_series_can_be_done_by_hand() {
        assert_eq!((mean(&[]), std(&[1.0]), median(&[])), (None, None, None));
        assert_eq!(
            (mean(&[1.0, 2.0, 6.0]), std(&[1.0, 3.0]), median(&[9.0, 1.0, 5.0])),
            (Some(3.0), Some(2f64.sqrt()), Some(5.0))
        );
        assert_eq!(std_uncertainty_of_mean(&[2.0, 2.0, 2.0]), Some(0.0));
        assert_eq!((mean_by_square([1.0, 0.0, 3.0]), mean_by_square([0.0, 0.0])), (Some(2.8), None));
    }

    #[test]
    fn a_correlated_series_knows_that_it_is_worth_less() {
        // first-order autoregression, ρ_k = a^k: τ = (1 + a) / (1 − a)
        let mut rng = rand_pcg::Pcg64::seed_from_u64(1);
        let (a, count, runs) = (0.8_f64, 1000, 300);
        let (mut means, mut claimed) = (Vec::new(), Vec::new());
        for _ in 0..runs {
            let mut state = 0.0;
            let series: Vec<f64> = (0..count)
                .map(|_| {
                    let kick: f64 = StandardNormal.sample(&mut rng);
                    state = a * state + (1.0 - a * a).sqrt() * kick;
                    state
                })
                .collect();
            means.push(mean(&series).unwrap());
            claimed.push(std_uncertainty_of_mean(&series).unwrap());
        }
        let true_std = ((1.0 + a) / (1.0 - a) / count as f64).sqrt();
        let seen_std = std(&means).unwrap();
        // the spread of 300 means is known to 1/√600 = 4 %
        assert!((seen_std / true_std - 1.0).abs() < 0.15, "{seen_std} {true_std}");
        let typical = median(&claimed).unwrap();
        assert!((0.85..1.1).contains(&(typical / true_std)), "{typical} {true_std}");
    }
}
