//! Gravity and air from the arguments about the place.

use crate::args::{AirArguments, PlaceArguments};
use crate::failure::Failure;
use hovertone::thrust::{Air, Gravity, check_gravity, check_latitude};
use hovertone_vehicle::check_diameter;

/// Local gravity.
pub(crate) fn gravity_of(place: &PlaceArguments) -> Result<Gravity, Failure> {
    let height = Air { height_m: place.height_m, ..Air::default() };
    height.check()?;
    match (place.gravity_m_s2, place.latitude_deg) {
        (Some(gravity_m_s2), _) => {
            check_gravity("gravity_m_s2", gravity_m_s2)?;
            Ok(Gravity::given(gravity_m_s2))
        }
        (None, Some(latitude_deg)) => {
            check_latitude("latitude_deg", latitude_deg)?;
            Ok(Gravity::at_place(latitude_deg, place.height_m.unwrap_or(0.0)))
        }
        (None, None) => Ok(Gravity::UNKNOWN),
    }
}

/// Refuses a height without a latitude, where nothing but gravity is asked of the place.
pub(crate) fn refuse_height_alone(place: &PlaceArguments) -> Result<(), Failure> {
    match (place.height_m, place.latitude_deg) {
        (Some(height_m), None) => {
            let what = format!("--height-m {height_m} alone does not give the gravity");
            Err(Failure::usage(what, "also give --latitude-deg, or leave --height-m out"))
        }
        _ => Ok(()),
    }
}

/// Density of the air, where an argument says anything about it.
pub(crate) fn air_density_kg_m3(air: &AirArguments, place: &PlaceArguments) -> Result<Option<f64>, Failure> {
    air.diameter_m.map_or(Ok(()), |diameter_m| check_diameter("diameter_m", diameter_m))?;
    let said = Air {
        temperature_c: air.temperature_c,
        pressure_hpa: air.pressure_hpa,
        humidity_percent: air.humidity_percent.unwrap_or(0.0),
        height_m: place.height_m,
    };
    let is_said = said.temperature_c.or(said.pressure_hpa).or(said.height_m).is_some();
    said.check()?;
    Ok(is_said.then(|| said.density_kg_m3()))
}
