//! Whether points speak for one parameter more: evidence, not fit, so that a law is not preferred for bending further.

use statrs::distribution::{Continuous, Normal, StudentsT};

/// Steps of the integral over the prior where the noise has to be taken from the residuals.
const STEPS: usize = 4000;
/// Half width of that integral in standard deviations of the prior.
const HALF_WIDTH_STDS: f64 = 8.0;

/// A parameter that a smaller law does without: how large it may be before anybody has measured.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ParameterPrior {
    /// Its value in the smaller law, and the middle of the prior.
    pub null: f64,
    /// Standard deviation of the prior, a normal one.
    pub std: f64,
}

/// Logarithm of the evidence of the law with the parameter over that of the law without (Savage and Dickey's ratio of the
/// densities at the null): positive where the points ask for the parameter.
///
/// `noise_degrees_of_freedom` is given where the uncertainty of the estimate was taken from the residuals: then one of few
/// points counts for less. Exact for a linear parameter and known noise:
/// −½ ln(1 + s²/u²) + ½ z² s²/(u² + s²), z = (estimate − null)/u.
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
        // the prior is flat over the width of the estimate
        return normal.ln_pdf(offset / prior.std) - ratio.ln() - at_null;
    }
    let step = 2.0 * HALF_WIDTH_STDS / STEPS as f64;
    let under_prior: f64 = (0..STEPS)
        .map(|index| (index as f64 + 0.5) * step - HALF_WIDTH_STDS)
        .map(|stds| normal.pdf(stds) * student.pdf((offset - stds * prior.std) / estimate_std) * step)
        .sum();
    under_prior.ln() - at_null
}
