//! Evidence for a law with one more parameter (MacKay 1992). Evidence charges a law for its freedom; the residuals alone always prefer
//! the law with more parameters.

use statrs::distribution::{Continuous, Normal, StudentsT};

/// Steps of the integral over the prior, which is needed where the noise comes from the residuals. *Numeric.*
const STEPS: usize = 4000;
/// Half width of that integral, in standard deviations of the prior. *Numeric.*
const HALF_WIDTH_STDS: f64 = 8.0;

/// Normal prior on a parameter that the smaller law has not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterPrior {
    /// Value that makes the larger law equal to the smaller one; the middle of the prior.
    pub null: f64,
    /// Standard deviation of the prior.
    pub std: f64,
}

/// Natural logarithm of the evidence of the law with the parameter over the evidence of the law without it, as the Savage–Dickey
/// density ratio at the null (Dickey 1971). It is positive where the points favour the parameter.
///
/// `noise_degrees_of_freedom` is given where the uncertainty u of the estimate comes from the residuals; its distribution is then
/// Student's t. With known noise and a linear parameter the ratio is exact:
/// −½ ln(1 + s²/u²) + ½ z² s²/(u² + s²), with z = (estimate − null)/u and the standard deviation s of the prior.
pub fn log_evidence_ratio(
    estimate: f64,
    estimate_std: f64,
    prior: ParameterPrior,
    noise_degrees_of_freedom: Option<usize>,
) -> f64 {
    let offset = estimate - prior.null;
    let ratio = prior.std / estimate_std;
    let student = noise_degrees_of_freedom
        .and_then(|freedom| StudentsT::new(0.0, 1.0, freedom as f64).ok())
        .zip(Normal::new(0.0, 1.0).ok());
    let Some((student, normal)) = student else {
        return -0.5 * (ratio * ratio).ln_1p()
            + 0.5 * (offset / estimate_std).powi(2) * ratio.powi(2) / (1.0 + ratio.powi(2));
    };
    let at_null = student.ln_pdf(offset / estimate_std);
    if ratio * HALF_WIDTH_STDS / STEPS as f64 > 0.5 {
        // one step is wider than half of u: the prior is flat over the width of the estimate
        return normal.ln_pdf(offset / prior.std) - ratio.ln() - at_null;
    }
    let step = 2.0 * HALF_WIDTH_STDS / STEPS as f64;
    // the density of Student's t from its value at 0, because each call of the library computes gamma functions
    let (peak, freedom) = (student.pdf(0.0), student.freedom());
    let density = |t: f64| peak * (1.0 + t * t / freedom).powf(-(freedom + 1.0) / 2.0);
    let under_prior: f64 = (0..STEPS)
        .map(|index| (index as f64 + 0.5) * step - HALF_WIDTH_STDS)
        .map(|stds| normal.pdf(stds) * density((offset - stds * prior.std) / estimate_std) * step)
        .sum();
    under_prior.ln() - at_null
}
