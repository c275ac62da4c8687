//! Whether heard and logged speeds agree as well as the stated ± promises.

use hovertone_analysis::{Agreement, COVERAGE_OF_HALF, VerifiedRotor};
use hovertone_signal::statistics::{std, std_uncertainty_of_mean};
use statrs::function::beta::beta_reg;

/// Share of points within ± (k = 2) where the ± is right and errors are normal: P(|z| < 2). *Physics.*
const COVERAGE: f64 = 0.9545;
/// Chance that a coverage is called too small by chance. *Decision.*
const CHANCE: f64 = 0.01;

/// How well the points of all rotors lie within their ±.
///
/// Neighbouring points are not independent: their effective number is n / τ, with the correlation time τ of the differences (Geyer 1992, see
/// [`std_uncertainty_of_mean`]). A coverage is too small if so few of that number, or fewer, have a probability below 1 % (binomial).
pub(super) fn agreement_of(rotors: &[VerifiedRotor]) -> Agreement {
    let counts: Vec<f64> = rotors.iter().map(independent_count).collect();
    let count: f64 = counts.iter().sum();
    let within: f64 = rotors.iter().zip(&counts).map(|(rotor, count)| rotor.coverage * count).sum();
    let is_below = |coverage: f64| probability_of_at_most(within, count, coverage) < CHANCE;
    match () {
        () if is_below(COVERAGE_OF_HALF) => Agreement::Scattered,
        () if is_below(COVERAGE) => Agreement::PlusMinusTooSmall,
        () => Agreement::AsStated,
    }
}

/// Number of independent points with as much information as the points of a rotor.
fn independent_count(rotor: &VerifiedRotor) -> f64 {
    let differences: Vec<f64> = rotor.points.iter().map(|point| point.heard_rev_s - point.logged_rev_s).collect();
    let count = differences.len() as f64;
    let known = std(&differences).zip(std_uncertainty_of_mean(&differences));
    known.filter(|(_, mean_std)| *mean_std > 0.0).map_or(count, |(std, mean_std)| (std / mean_std).powi(2).min(count))
}

/// P(X ≤ successes) of a binomial distribution, continued to numbers that are not whole: I_{1−p}(n − k, k + 1).
fn probability_of_at_most(successes: f64, count: f64, probability: f64) -> f64 {
    if count - successes <= 0.0 { 1.0 } else { beta_reg(count - successes, successes + 1.0, 1.0 - probability) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone_analysis::ComparedPoint;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};

    /// A rotor whose differences have this standard deviation over the stated one, and this correlation of neighbours.
    fn rotor(std_over_stated: f64, correlation: f64, count: usize, seed: u64) -> VerifiedRotor {
        let mut random = rand_pcg::Pcg64::seed_from_u64(seed);
        let mut state: f64 = StandardNormal.sample(&mut random);
        let points: Vec<ComparedPoint> = (0..count)
            .map(|at| {
                let kick: f64 = StandardNormal.sample(&mut random);
                state = correlation * state + (1.0 - correlation * correlation).sqrt() * kick;
                ComparedPoint {
                    time_s: 0.1 * at as f64,
                    heard_rev_s: 80.0 + 0.1 * std_over_stated * state,
                    std_uncertainty_rev_s: 0.1,
                    logged_rev_s: 80.0,
                }
            })
            .collect();
        let is_within = |point: &&ComparedPoint| (point.heard_rev_s - point.logged_rev_s).abs() <= 0.2;
        VerifiedRotor {
            track: 0,
            motor: 0,
            name: "motor 1".to_owned(),
            speed_rev_s: 80.0,
            bias_rev_s: 0.0,
            scatter_rev_s: 0.1 * std_over_stated,
            coverage: points.iter().filter(is_within).count() as f64 / count as f64,
            point_count: count,
            points,
        }
    }

    #[test]
    fn a_binomial_probability_can_be_done_by_hand() {
        // of two points: none, P = 0.25; at most one, P = 0.75
        assert!((probability_of_at_most(0.0, 2.0, 0.5) - 0.25).abs() < 1e-12);
        assert!((probability_of_at_most(1.0, 2.0, 0.5) - 0.75).abs() < 1e-12);
        assert_eq!(probability_of_at_most(2.0, 2.0, 0.5), 1.0);
    }

    /// A right ± is doubted in 1 of 100 cases, however much neighbours depend on each other.
    #[test]
    fn correlated_points_raise_no_false_alarm() {
        for correlation in [0.0, 0.5, 0.9] {
            let doubted =
                (0..300).filter(|&seed| agreement_of(&[rotor(1.0, correlation, 150, seed)]) != Agreement::AsStated);
            // of 300, 3 are expected; 12 and more have a probability of 1e-4
            assert!(doubted.count() < 12, "{correlation}");
        }
    }

    #[test]
    fn a_scatter_far_above_the_stated_is_found_and_twice_of_it_is_a_small_plus_minus() {
        for seed in 0..50 {
            assert_eq!(agreement_of(&[rotor(6.0, 0.5, 300, seed)]), Agreement::Scattered);
            assert_ne!(agreement_of(&[rotor(1.6, 0.5, 300, seed)]), Agreement::Scattered);
        }
        // 20 points that follow each other slowly are hardly more than one or two
        assert_eq!(agreement_of(&[rotor(1.6, 0.99, 20, 1)]), Agreement::AsStated);
        assert_eq!(agreement_of(&[]), Agreement::AsStated);
    }
}
