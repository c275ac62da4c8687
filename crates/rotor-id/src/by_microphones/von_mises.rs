//! The von Mises distribution of a phase: density `exp(κ cos x) / (2π I₀(κ))` (Mardia and Jupp, Directional Statistics, 2000). For large κ
//! it is normal with the variance 1/κ.

/// Argument at which the two polynomials of Abramowitz and Stegun meet. *Numeric.*
const BESSEL_SPLIT: f64 = 3.75;
/// Abramowitz and Stegun, Handbook of Mathematical Functions, 9.8.1: I₀(κ) as a polynomial of (κ / 3.75)². *Numeric.*
const BESSEL_SMALL: [f64; 7] = [1.0, 3.515_622_9, 3.089_942_4, 1.206_749_2, 0.265_973_2, 0.036_076_8, 0.004_581_3];
/// The same, 9.8.2: √κ exp(−κ) I₀(κ) as a polynomial of 3.75 / κ. *Numeric.*
const BESSEL_LARGE: [f64; 9] = [
    0.398_942_28,
    0.013_285_92,
    0.002_253_19,
    -0.001_575_65,
    0.009_162_81,
    -0.020_577_06,
    0.026_355_37,
    -0.016_476_33,
    0.003_923_77,
];

/// Logarithm of the density at the peak over the uniform density: `κ − ln I₀(κ)`.
pub(super) fn ln_peak_over_uniform(kappa: f64) -> f64 {
    kappa - ln_bessel_i0(kappa)
}

/// `ln I₀(κ)`, with an error below 2e-7.
fn ln_bessel_i0(kappa: f64) -> f64 {
    let polynomial = |x: f64, terms: &[f64]| terms.iter().rev().fold(0.0, |sum, term| sum * x + term);
    if kappa < BESSEL_SPLIT {
        polynomial((kappa / BESSEL_SPLIT).powi(2), &BESSEL_SMALL).ln()
    } else {
        polynomial(BESSEL_SPLIT / kappa, &BESSEL_LARGE).ln() + kappa - kappa.ln() / 2.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn the_bessel_function_is_its_integral() {
        for kappa in [0.01, 0.7, 3.7, 3.8, 11.0, 400.0] {
            let count = 20_000;
            let sum: f64 =
                (0..count).map(|n| (kappa * ((PI * (f64::from(n) + 0.5) / f64::from(count)).cos() - 1.0)).exp()).sum();
            let integral = (sum / f64::from(count)).ln() + kappa;
            assert!((ln_bessel_i0(kappa) - integral).abs() < 1e-6, "{kappa}");
        }
    }
}
