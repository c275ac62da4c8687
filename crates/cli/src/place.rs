//! Gravity and air from the arguments about the place.

use crate::args::{AirArguments, PlaceArguments};
use crate::failure::Failure;
use hovertone::thrust::{Air, Gravity};
use hovertone::vehicle::PROPELLER_DIAMETER_M;

const SEE_HELP: &str = "correct this flag; --help of the command has its unit";

/// Local gravity.
pub(crate) fn gravity_of(place: &PlaceArguments) -> Result<Gravity, Failure> {
    let height = Air { height_m: place.height_m, ..Air::default() };
    height.check().map_err(|error| Failure::usage(error.to_string(), SEE_HELP))?;
    match (place.gravity_m_s2, place.latitude_deg) {
        (Some(gravity_m_s2), _) if !(9.7..=9.9).contains(&gravity_m_s2) => {
            let what = format!("gravity_m_s2 = {gravity_m_s2} is found nowhere on Earth: 9.70 to 9.90");
            Err(Failure::usage(what, SEE_HELP))
        }
        (Some(gravity_m_s2), _) => Ok(Gravity::given(gravity_m_s2)),
        (None, Some(latitude_deg)) if latitude_deg.abs() <= 90.0 => {
            Ok(Gravity::at_place(latitude_deg, place.height_m.unwrap_or(0.0)))
        }
        (None, Some(latitude_deg)) => {
            Err(Failure::usage(format!("latitude_deg is {latitude_deg}, and it must lie between -90 and 90"), SEE_HELP))
        }
        (None, None) => Ok(Gravity::UNKNOWN),
    }
}

/// Density of the air, where an argument says anything about it.
pub(crate) fn air_density_kg_m3(air: &AirArguments, place: &PlaceArguments) -> Result<Option<f64>, Failure> {
    if let Some(diameter_m) = air.diameter_m.filter(|diameter_m| !PROPELLER_DIAMETER_M.contains(diameter_m)) {
        return Err(Failure::usage(format!("diameter_m is {diameter_m}, and it must be from 0.01 to 10"), SEE_HELP));
    }
    let said = Air {
        temperature_c: air.temperature_c,
        pressure_hpa: air.pressure_hpa,
        humidity_percent: air.humidity_percent.unwrap_or(0.0),
        height_m: place.height_m,
    };
    let is_said = said.temperature_c.or(said.pressure_hpa).or(said.height_m).is_some();
    said.check().map_err(|error| Failure::usage(error.to_string(), SEE_HELP))?;
    Ok(is_said.then(|| said.density_kg_m3()))
}
