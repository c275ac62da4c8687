//! Local gravity, and the force balance of eq 3 of the paper.

use hovertone_vehicle::{ConfigError, GRAVITY_STANDARD_M_S2, QuantityError, RotorSpeed, check_range};
use std::ops::RangeInclusive;

/// Normal gravity at the equator, m/s² (WGS 84, NIMA TR8350.2, 2000). *Physics.*
const GRAVITY_EQUATOR_M_S2: f64 = 9.7803253359;
/// k of Somigliana's formula (WGS 84). *Physics.*
const SOMIGLIANA_K: f64 = 0.00193185265241;
/// Squared first eccentricity of the ellipsoid (WGS 84). *Physics.*
const ECCENTRICITY_SQUARED: f64 = 0.00669437999013;
/// Decrease of gravity with the height in free air, 1/s². *Physics.*
const FREE_AIR_GRADIENT_1_S2: f64 = 3.086e-6;

/// Gravity on Earth, m/s², with a margin: 9.764 on the highest equatorial mountain, 9.832 at the poles. *Physics.*
const GRAVITY_M_S2: RangeInclusive<f64> = 9.70..=9.90;
/// Latitude of a pole, degrees. *Physics.*
const LATITUDE_DEG_MAX: f64 = 90.0;

/// Standard uncertainty of gravity from latitude and height, or as stated, m/s²: a typical gravity anomaly of 50 mGal
/// by local rock, and heights that are known to some 100 m. *Physics.*
const GRAVITY_STD_M_S2: f64 = 0.0005;
/// Standard uncertainty of gravity at an unknown place, m/s². It lies between 9.780 at the equator and 9.832 at the poles; a
/// rectangular distribution of that width has this standard deviation. *Physics.*
const GRAVITY_UNKNOWN_STD_M_S2: f64 = 0.015;

/// Local gravity with its uncertainty.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gravity {
    /// The value.
    pub m_s2: f64,
    /// Its standard uncertainty.
    pub std_m_s2: f64,
}

impl Gravity {
    /// Standard gravity, for an unknown place on Earth. *Physics.*
    pub const UNKNOWN: Self = Self { m_s2: GRAVITY_STANDARD_M_S2, std_m_s2: GRAVITY_UNKNOWN_STD_M_S2 };

    /// A stated value.
    pub fn given(m_s2: f64) -> Self {
        Self { m_s2, std_m_s2: GRAVITY_STD_M_S2 }
    }

    /// Gravity at a latitude and a height above the sea.
    pub fn at_place(latitude_deg: f64, height_m: f64) -> Self {
        Self::given(gravity_m_s2(latitude_deg, height_m))
    }
}

/// Checks that a gravity is found on Earth.
///
/// # Errors
/// The number with its name.
pub fn check_gravity(name: &'static str, m_s2: f64) -> Result<(), QuantityError> {
    let must_be = "from 9.7 to 9.9, because no place on Earth has another gravity";
    if GRAVITY_M_S2.contains(&m_s2) { Ok(()) } else { Err(QuantityError { name, value: m_s2, must_be }) }
}

/// Checks that a latitude is one.
///
/// # Errors
/// The number with its name.
pub fn check_latitude(name: &'static str, latitude_deg: f64) -> Result<(), ConfigError> {
    check_range(name, latitude_deg, -LATITUDE_DEG_MAX, LATITUDE_DEG_MAX)
}

/// C = f / ω² in N s² (N per (rad/s)²): eq 3 of the paper, solved for the constant.
///
/// With the whole weight as `force_n`, as in the tables of the paper, C is the constant of the whole vehicle, the sum over its
/// rotors. With the force of one rotor, C is the constant of that rotor.
pub fn thrust_constant_n_s2(force_n: f64, speed: RotorSpeed) -> f64 {
    force_n / speed.rad_s().powi(2)
}

/// Normal gravity at a latitude φ and a height h: γ = γ_e (1 + k sin²φ) / √(1 − e² sin²φ) − 3.086e-6 h (Somigliana 1929, on the
/// WGS 84 ellipsoid, with the free-air gradient). It is correct to about 0.0005 m/s² where no large gravity anomaly lies.
pub fn gravity_m_s2(latitude_deg: f64, height_m: f64) -> f64 {
    let sine_squared = latitude_deg.to_radians().sin().powi(2);
    let on_ellipsoid =
        GRAVITY_EQUATOR_M_S2 * (1.0 + SOMIGLIANA_K * sine_squared) / (1.0 - ECCENTRICITY_SQUARED * sine_squared).sqrt();
    on_ellipsoid - FREE_AIR_GRADIENT_1_S2 * height_m
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn gravity_at_known_places() {
        for (latitude_deg, height_m, expected) in [(-20.32, 5.0, 9.7865), (-20.76, 650.0, 9.7848), (52.0, 0.0, 9.8125)]
        {
            assert!((gravity_m_s2(latitude_deg, height_m) - expected).abs() < 1e-4);
        }
    }
}
