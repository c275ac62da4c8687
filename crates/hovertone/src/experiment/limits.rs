//! Limits of the numbers in an experiment file.

use super::{ExperimentError, ExperimentLoad};
use hovertone_thrust::VehicleModel;
use hovertone_vehicle::{KnownRotor, PROPELLER_DIAMETER_M};

/// Refuses propellers that cannot carry a load.
pub(super) fn check_hovers(loads: &[ExperimentLoad], known: &KnownRotor) -> Result<(), ExperimentError> {
    let mut masses_kg = loads.iter().filter_map(|load| load.force.mass_kg());
    Ok(masses_kg.try_for_each(|mass_kg| KnownRotor { mass_kg: Some(mass_kg), ..*known }.check_hover())?)
}

pub(super) fn missing(what: &str, hint: &'static str) -> ExperimentError {
    ExperimentError::Missing { what: what.to_owned(), hint }
}

pub(super) fn positive(name: &str, value: f64) -> Result<f64, ExperimentError> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(ExperimentError::OutOfRange { name: name.to_owned(), value, must_be: "must be a number above 0" })
    }
}

pub(super) fn not_negative(name: &str, value: f64) -> Result<f64, ExperimentError> {
    if value.is_finite() && value >= 0.0 {
        Ok(value)
    } else {
        Err(ExperimentError::OutOfRange { name: name.to_owned(), value, must_be: "must be 0 or more" })
    }
}

/// Refuses a model with numbers out of range.
pub(super) fn check_model(model: &VehicleModel) -> Result<(), ExperimentError> {
    let is_positive = |value: f64| value.is_finite() && value > 0.0;
    let refuse = |name: &str, value: f64, must_be| {
        Err(ExperimentError::OutOfRange { name: format!("{name} of the model {:?}", model.file), value, must_be })
    };
    match (model.mass_kg, model.propeller_diameter_m, model.rotor_count) {
        (Some(mass_kg), ..) if !is_positive(mass_kg) => refuse("mass_kg", mass_kg, "must be a number above 0"),
        (_, Some(diameter_m), _) if !PROPELLER_DIAMETER_M.contains(&diameter_m) => {
            refuse("propeller_diameter_m", diameter_m, "must be from 0.01 to 10")
        }
        (.., Some(0)) => refuse("rotors", 0.0, "must be from 1 to 12"),
        _ => Ok(()),
    }
}
