//! Logged speeds and commands of a motor → its constants in eq 2 of the paper, in the form that a log can tell:
//! dω/dt = (ω_target − ω)/τ, with τ for rising and for falling speeds, the dead time and the static map ω_target(command); and the square
//! term of the load where the speeds have a wide enough range.
//!
//! ```text
//! series ─ transitions ▶ windows with one step ─ first_order ▶ curves ─ step ▶ steps with a verdict ─ combined ▶ time constants, dead time
//!    └──── plateaus ────▶ levels held ─ static_map ▶ speed at each command, gain, saturation ──┘
//!                              └─────── bench_torque ▶ C_τ, where a bench logs the torque
//! ```
//!
//! `motor.rs` is the whole chain, `config.rs` has all settings.

mod alignment;
mod bench_torque;
mod combined;
mod config;
mod first_order;
mod frame_response;
mod grey_box;
mod listening;
mod load;
mod motor;
mod plateaus;
mod room;
mod search;
mod series;
mod static_map;
mod step;
mod transitions;
mod weighted_line;

pub use alignment::{offset_of_commands, other_offset_of_commands};
pub use bench_torque::{BenchTorque, TorqueSeries};
pub use combined::CombinedEstimate;
pub use config::MotorConfig;
pub use grey_box::*;
pub use listening::{
    Echoes, HeardLines, LineOrders, SoundConfig, SoundFit, grey_box_from_sound, lines_from_passes, log_offset_s,
    speeds_along,
};
pub use load::{LOAD_STEPS_MIN, LoadTerm};
pub use motor::{MotorConstants, MotorModel, constants_of, motor_from_series, torque_of_motor};
pub use room::*;
pub use series::{CommandSeries, MotorSeries, command_of_speed};
pub use static_map::{MapOrigin, MapPoint, StaticMap};
pub use step::{MotorStep, StepVerdict};
