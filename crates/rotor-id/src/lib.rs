//! Which track of a recording is which rotor, and the condition of each rotor.
//!
//! Each analysis takes a finished [`SpeedAnalysis`](hovertone_analysis::SpeedAnalysis), or its tracks, and what else tells rotors apart: a
//! log of the flight ([`by_log`]), several microphones ([`by_microphones`]), or the order in which the motors start ([`by_spin_up`]).
//! [`condition`] compares the lines of each rotor's shaft with its blade pass.
//!
//! Pure: no files, clock, threads or printing.

pub mod by_log;
pub mod by_microphones;
pub mod by_spin_up;
pub mod condition;
mod posterior;
mod settings;
mod speed_curve;

pub use settings::LabelsConfig;
