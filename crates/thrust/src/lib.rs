//! From rotor speeds and known forces to the thrust constant C_f in F = C_f ω²: the square law through all loads with its uncertainty
//! budget, and the averages of the paper over samples, trials and loads.
//!
//! ```text
//! speeds, force       input: loads, trials, samples           fit            loads → table, the entry point
//! campaign            loads → points with uncertainties       square_law     points → constant, laws, verdicts
//! regression          lines with errors in x and y            budget         uncertainty budget (GUM)
//! drift               significant drifts of the constant      air            density, gravity, thrust coefficients
//! plan                flights for a wanted uncertainty        weighing       mass from a constant and a speed
//! outline             warnings before anything is heard
//! vehicle_model       a simulator's model beside the result   table          output, with warnings
//! ```

mod air;
mod budget;
mod campaign;
mod drift;
mod fit;
mod force;
mod misfiled;
mod outline;
mod plan;
pub mod regression;
mod settings;
mod speeds;
mod square_law;
mod statistics;
mod table;
mod vehicle_model;
mod warning;
mod warning_words;
mod weighing;

pub use air::{
    Air, Gravity, ThrustCoefficients, TorqueReading, check_gravity, check_latitude, figure_of_merit, gravity_m_s2,
    is_plausible_merit, least_diameter_m, least_tip_mach, thrust_constant_n_s2, torque_constant_n_m_s2,
};
pub use budget::{BudgetInput, BudgetLine, UncertaintyBudget};
pub use campaign::TrialBootstrap;
pub use drift::{Drift, DriftKind, row_drifts};
pub use fit::{preferred_law, thrust_from_loads, warnings_of_points};
pub use force::Force;
pub use outline::{LoadOutline, warnings_of_outline};
pub use plan::{FlightPlan, PLAN_SHARE_MAX, PlanError, PlanWish, flight_plan};
pub use settings::{ThrustSettings, UncertaintyInputs};
pub use speeds::{LoadSpeeds, SampleSpeed, TrialSpeeds};
pub use square_law::{
    ForceLaw, ForcePoint, InterceptLaw, LawAgreement, LawProbability, LoadRange, NoScatter, PointNoise, PointVerdict,
    PowerLaw, SquareLawFit, square_law_fit,
};
pub use statistics::p_value_text;
pub use table::{LoadThrust, SampleThrust, ThrustTable, TrialThrust};
pub use vehicle_model::{ModelAgainstHeard, VehicleModel};
pub use warning::ThrustWarning;
pub use warning_words::{RangeDoubt, compared, range_text};
pub use weighing::{AcousticScale, DifferentLoads, HeardHover, WeighError, WeighedHover};
