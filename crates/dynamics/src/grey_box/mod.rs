//! Commands, attitude and speeds of a flight → the gains of eq 1 and the lumped constants of eq 2.
//!
//! ```text
//! control log ─ inputs ▶ errors of the four loops ─ prediction ▶ speeds of the model ─┐
//!                                                                                      ├─ fit ▶ parameters ─ information ▶ ±, rank, correlations
//! rotor speeds, of a log or heard along the prediction (`listening`) ─ observation ───┘                    └ advice ▶ which manoeuvre is missing
//! ```
//!
//! The model, about the hover of each rotor, with δ = ω − ω_hover and the mixer M of eq 1:
//!
//! ```text
//! τ δ' = M u(t − delay) − δ − β δ²,    u = l tanh((P e + D e')/l) for each loop
//! ```
//!
//! It is eq 2 divided by its slope at hover, s = a + 2 b ω: τ = c/s, β = b/s, and each gain of eq 1 times 1/s, so that gains are in
//! rad/s of the rotor. No voltage is needed. Where the motor is known, [`MotorVolts`] gives the gains in volts.

mod advice;
mod check;
mod fit;
mod information;
mod inputs;
mod observation;
mod overlap;
mod parameters;
mod prediction;
mod problem;
mod residuals;
mod scenario;
mod yaw_torque;

pub use advice::{Advice, advice_of};
pub use check::{Checked, checked};
pub(crate) use fit::grey_box_near;
pub use fit::{GreyBoxConfig, GreyBoxFit, GreyBoxStop, grey_box_from_speeds};
pub use information::{Correlation, Information};
pub use inputs::{ControlKnowns, ControlLog, LoopInputs};
pub use observation::{SpeedObservation, observations_of_rows};
pub use parameters::{GreyBoxModel, LoopModel, PARAMETER_COUNT, Parameter};
pub use prediction::SpeedPrediction;
pub use scenario::{IdentifiedVehicle, MotorVolts};
pub use yaw_torque::{TorqueConstant, YawInertia, torque_constant};
