//! What a multirotor is, and the quantities of its rotors.
//!
//! The estimator (`hovertone`) and the simulator (`hovertone-sim`) share this crate and nothing else, so that recovering a simulated flight
//! proves something. Of sound, it has only the levels that were measured on real rotors.

mod constants;
mod contradiction;
mod estimate;
mod flight;
mod frame;
mod known_rotor;
mod limits;
mod line_levels;
mod list;
mod number;
mod own_vehicle;
mod presets;
mod said;
mod speed;
mod vehicle;

pub use constants::{AIR_KG_M3, GRAVITY_STANDARD_M_S2, SOUND_M_S};
pub use contradiction::{Contradiction, TIP_MACH_MAX, check_tips};
pub use estimate::{COVERAGE_FACTOR, Ending, Estimate};
pub use flight::{
    Axis, BatteryParameters, ControllerParameters, FlightParameters, Layout, LoopGains, MotorParameters,
    RotorParameters, find_flight_parameters, flight_preset_names, flight_presets,
};
pub use frame::RotorPlace;
pub use known_rotor::KnownRotor;
pub use limits::{
    BLADE_COUNT_MAX, BLADES_MAX, CLOCK_CORRECTION_PPM_MAX, CLOCK_PPM, ConfigError, DRIFT_M_MAX, GRAMS_FACTOR,
    KNOWN_MASS_SHARES, KNOWN_RANGE_MARGIN, LOGGED_REV_S_MAX, MASS_ALONE_KG_MAX, MASS_FACTOR_MAX, MESH_SIDEBANDS,
    PROPELLER_DIAMETER_M, ROTOR_SPREAD_SHARE, ROTOR_STD_SHARE, ROTORS_MAX, SHAFT_REV_S, THRUST_COEFFICIENT,
    are_masses_of_one_vehicle, check_diameter, check_not_negative, check_positive, check_range, is_swamped,
    loudest_rotor_share,
};
pub use line_levels::LineLevels;
pub use list::in_list;
pub use number::number_in_words;
pub use own_vehicle::{OwnVehicle, OwnVehicleError};
pub use presets::{find_preset, presets};
pub use said::{SaidOfVehicle, SearchedTone};
pub use speed::{Gear, Order, QuantityError, RotorSpeed};
pub use vehicle::{ShaftSpeedRange, Sourced, Vehicle};
