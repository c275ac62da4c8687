//! Force balance: what a known force and a measured speed say of the thrust constant (paper, eq 3).

use hovertone_vehicle::{GRAVITY_STANDARD_M_S2, RotorSpeed};

/// Standard uncertainty of gravity by latitude and height, or as somebody wrote it: rock below, and heights as people know them.
const GRAVITY_STD_M_S2: f64 = 0.0005;
/// Where neither gravity nor place is given it may be anything from 9.780 at the equator to 9.832 at the poles: the standard
/// deviation of a rectangle of that width.
const GRAVITY_UNKNOWN_STD_M_S2: f64 = 0.015;

/// Local gravity, as well as it is known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gravity {
    /// The value.
    pub m_s2: f64,
    /// Its standard uncertainty.
    pub std_m_s2: f64,
}

impl Gravity {
    /// Somewhere on Earth.
    pub const UNKNOWN: Self = Self { m_s2: GRAVITY_STANDARD_M_S2, std_m_s2: GRAVITY_UNKNOWN_STD_M_S2 };

    /// As somebody wrote it.
    pub fn given(m_s2: f64) -> Self {
        Self { m_s2, std_m_s2: GRAVITY_STD_M_S2 }
    }

    /// At a latitude and a height above the sea.
    pub fn at_place(latitude_deg: f64, height_m: f64) -> Self {
        Self::given(gravity_m_s2(latitude_deg, height_m))
    }
}

/// C = f / ω² in N s² (N per (rad/s)²), eq 3 solved for the constant.
///
/// With `force_n` the whole weight, as in the paper's tables, it is the constant of the whole vehicle: the sum over its
/// rotors. With the force of one rotor it is that rotor's.
pub fn thrust_constant_n_s2(force_n: f64, speed: RotorSpeed) -> f64 {
    force_n / speed.rad_s().powi(2)
}

/// Normal gravity at a latitude and height: Somigliana's formula on the WGS84 ellipsoid with the free-air gradient, good
/// to about 0.0005 m/s² where the ground is not unusual.
pub fn gravity_m_s2(latitude_deg: f64, height_m: f64) -> f64 {
    let sine_squared = latitude_deg.to_radians().sin().powi(2);
    let on_ellipsoid =
        9.7803253359 * (1.0 + 0.00193185265241 * sine_squared) / (1.0 - 0.00669437999013 * sine_squared).sqrt();
    on_ellipsoid - 3.086e-6 * height_m
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
