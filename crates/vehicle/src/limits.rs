//! Limits of settings and of what multirotors can be, where several stages share them.

use crate::{COVERAGE_FACTOR, QuantityError};
use std::ops::RangeInclusive;

/// Most blades of a propeller. *Physics.*
pub const BLADE_COUNT_MAX: u32 = 12;

/// Highest order of a blade pass, which is that of [`BLADE_COUNT_MAX`] blades. A tone of higher order is a gear mesh. *Physics.*
pub const BLADES_MAX: f64 = BLADE_COUNT_MAX as f64;

/// Orders beside a gear mesh and its multiples at which its sidebands lie: one and two shaft turns to either side. *Physics.*
pub const MESH_SIDEBANDS: [f64; 4] = [-2.0, -1.0, 1.0, 2.0];

/// Most rotors of a multirotor: as many are separated. *Decision.*
pub const ROTORS_MAX: u32 = 12;

/// Diameters of multirotor propellers, m, with a margin on both sides. C_T contains D⁴, so a wrong unit must be refused. *Physics.*
pub const PROPELLER_DIAMETER_M: RangeInclusive<f64> = 0.01..=10.0;

/// Speeds of a running rotor, rev/s, that are accepted from instruments, tables and files: the smallest racers' propellers make 670. Numbers
/// beyond are in another unit. *Physics.*
pub const SHAFT_REV_S: RangeInclusive<f64> = 1.0..=1500.0;

/// Largest speed in the log of a flight, rev/s. Where the pole pairs are not known, logs hold electrical speeds, and a geared motor is faster
/// than its rotor: the fastest stay below a million rpm. *Physics.*
pub const LOGGED_REV_S_MAX: f64 = 17_000.0;

/// Thrust coefficients F/(ρ n² D⁴) of hovering propellers. Measured ones lie between 0.06 and 0.15. *Physics.*
pub const THRUST_COEFFICIENT: RangeInclusive<f64> = 0.03..=0.25;

/// Largest ratio between two masses of one vehicle: its given and its known mass, or with and without load. Beyond it one of the two is in
/// grams, or of another vehicle. *Decision.*
pub const MASS_FACTOR_MAX: f64 = 10.0;

/// Whether two masses may be of one vehicle: neither is more than [`MASS_FACTOR_MAX`] times the other.
pub fn are_masses_of_one_vehicle(given_kg: f64, known_kg: f64) -> bool {
    (known_kg / MASS_FACTOR_MAX..=known_kg * MASS_FACTOR_MAX).contains(&given_kg)
}

/// Masses of loads, over the mass of their known vehicle, that raise no question: without battery or camera, up to a heavy payload. *Decision.*
pub const KNOWN_MASS_SHARES: RangeInclusive<f64> = 0.8..=3.0;

/// Ratios of a given to an expected mass at which the given one is in grams: a thousand, with a wide margin. *Decision.*
pub const GRAMS_FACTOR: RangeInclusive<f64> = 100.0..=10_000.0;

/// Largest mass that is accepted where neither a unit nor a diameter bears it out, kg: a larger number was read in grams. *Decision.*
pub const MASS_ALONE_KG_MAX: f64 = 50.0;

/// A shaft is searched for down to the known slowest speed divided by this factor, and up to the fastest times this factor. *Decision.*
pub const KNOWN_RANGE_MARGIN: f64 = 1.5;

/// Default standard deviation of the rotors' speeds about their mean, as a share: rotors spread evenly over ±1 % have 0.58 %. *Decision.*
pub const ROTOR_SPREAD_SHARE: f64 = 0.0058;

/// Standard deviation of the speed of one rotor from the mean of the others, as a share, where nothing is known of it: the rotors of real
/// quadrotors differ by 13 to 22 % from slowest to fastest (DREGON, Strauss et al. 2018; a flight of a DJI M100). *Physics.*
pub const ROTOR_STD_SHARE: f64 = 0.06;

/// Default change of the distance to the microphone during a hover, m. *Decision.*
pub const DRIFT_M_MAX: f64 = 0.5;

/// Default half width of the error of a recorder's clock, in millionths. Phones and cameras keep within 50. *Physics.*
pub const CLOCK_PPM: f64 = 50.0;

/// Largest correction of a recorder's clock, in millionths. Crystals keep within 100; a camera that counts 1000 pictures for 1001 is off by
/// 1000. A larger error is no error of a clock. *Physics.*
pub const CLOCK_CORRECTION_PPM_MAX: f64 = 2000.0;

/// Standard deviation of the difference between the speed of one rotor and the mean of all, as a share: σ √(1 − 1/N), for independent
/// rotors with the relative standard deviation σ.
pub fn loudest_rotor_share(rotor_spread_share: f64, rotor_count: u32) -> f64 {
    rotor_spread_share * (1.0 - 1.0 / f64::from(rotor_count.max(1))).sqrt()
}

/// Whether the expanded uncertainty (k = 2) of a positive quantity reaches zero: then nothing was measured, or the unit is wrong.
pub fn is_swamped(value: f64, std_uncertainty: f64) -> bool {
    COVERAGE_FACTOR * std_uncertainty > value
}

/// A setting out of range.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ConfigError {
    /// A number outside its limits.
    #[error("{name} = {value}, but it must be from {min} to {max}")]
    OutOfRange {
        /// Name of the setting, as in files and flags.
        name: &'static str,
        /// The given number.
        value: f64,
        /// Smallest allowed number.
        min: f64,
        /// Largest allowed number.
        max: f64,
    },
    /// A band whose upper edge is not above its lower edge.
    #[error("the band {low_hz}:{high_hz} Hz is empty: its upper edge must be above its lower edge")]
    EmptyBand {
        /// Lower edge.
        low_hz: f64,
        /// Upper edge.
        high_hz: f64,
    },
    /// A span whose end is not after its start.
    #[error("the end of the part, {to_s} s, is not after its start, {from_s} s")]
    EmptySpan {
        /// Start.
        from_s: f64,
        /// End.
        to_s: f64,
    },
}

/// Checks that a setting lies within its limits, both included. NaN is always refused.
///
/// # Errors
/// [`ConfigError::OutOfRange`] with the setting's name, its value and the limits.
pub fn check_range(name: &'static str, value: f64, min: f64, max: f64) -> Result<(), ConfigError> {
    if (min..=max).contains(&value) { Ok(()) } else { Err(ConfigError::OutOfRange { name, value, min, max }) }
}

/// Checks the tip-to-tip diameter of a propeller against [`PROPELLER_DIAMETER_M`].
///
/// # Errors
/// The diameter with its name.
pub fn check_diameter(name: &'static str, diameter_m: f64) -> Result<(), QuantityError> {
    let must_be = "from 0.01 to 10, in metres: 10 inches are 0.254";
    check_quantity(name, diameter_m, PROPELLER_DIAMETER_M.contains(&diameter_m), must_be)
}

/// Checks that a number is finite and above 0.
///
/// # Errors
/// The number with its name.
pub fn check_positive(name: &'static str, value: f64) -> Result<(), QuantityError> {
    check_quantity(name, value, value > 0.0, "a number above 0")
}

/// Checks that a number is finite and not negative.
///
/// # Errors
/// The number with its name.
pub fn check_not_negative(name: &'static str, value: f64) -> Result<(), QuantityError> {
    check_quantity(name, value, value >= 0.0, "0 or more")
}

fn check_quantity(name: &'static str, value: f64, is_kept: bool, must_be: &'static str) -> Result<(), QuantityError> {
    if value.is_finite() && is_kept { Ok(()) } else { Err(QuantityError { name, value, must_be }) }
}
