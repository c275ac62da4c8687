//! Whether a constant and a mass are known well enough to weigh with.

use crate::failure::Failure;
use hovertone::thrust::AcousticScale;
use hovertone_vehicle::{Estimate, is_swamped, number_in_words};
use std::path::Path;

/// Refuses standard uncertainties that say that nothing was measured: those of the flags, and those of the results in a file.
pub(crate) fn check_stds(scale: &AcousticScale, results: Option<&Path>) -> Result<(), Failure> {
    let is_swamped = |estimate: &Estimate| is_swamped(estimate.value, estimate.std_uncertainty.unwrap_or(0.0));
    let refuse = |name: &str, quantity: &str, unit: &str, estimate: Estimate, hint: &str| {
        let std = estimate.std_uncertainty.unwrap_or(0.0);
        let what = format!(
            "{name} = {}: this standard uncertainty is too large: twice its value, the ±, must be less than the {quantity}, {} {unit}",
            number_in_words(std),
            number_in_words(estimate.value)
        );
        Err(Failure::usage(what, hint))
    };
    match (scale.thrust_constant_total_n_s2, scale.vehicle_mass_kg) {
        (constant, _) if let Some(path) = results.filter(|_| is_swamped(&constant)) => {
            let percent = 200.0 * constant.std_uncertainty.unwrap_or(0.0) / constant.value;
            let what =
                format!("this constant is too uncertain to weigh with: its ± (k = 2) is {percent:.0} % of its value");
            let hint = "measure the constant again: the warnings of `hovertone identify` or `hovertone fit` say what to improve";
            Err(Failure::Usage { what, hint: hint.to_owned(), path: Some(path.to_owned()) })
        }
        (constant, _) if is_swamped(&constant) => refuse(
            "constant_std_n_s2",
            "constant",
            "N s²",
            constant,
            "give half the ± of the constant, in N s²: for a constant of (2.83 ± 0.02) 1e-5, give 0.01e-5",
        ),
        (_, Some(mass)) if is_swamped(&mass) => refuse(
            "mass_std_kg",
            "mass",
            "kg",
            mass,
            "give half the ± of the mass, in kilograms: for ± 1 g write 0.0005",
        ),
        _ => Ok(()),
    }
}
