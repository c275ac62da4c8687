//! Sound as it arrives → the speed of the rotors now.
//!
//! ```text
//! samples ─ recent ─▶ the last seconds ─ review (as a recording) ─▶ rotors, octave, mean speed
//!         └ comb ─▶ scores ─ follower ─▶ speed of each frame ─ steady_mean ─▶ live speed      ▲ pattern and start
//! ```
//!
//! A review has the numbers of the analysis of a recording, because it is one. Between reviews, a [`Listener`] follows the pattern of the lines
//! from frame to frame in memory of a fixed size: a step is seen after a frame of 0.1 s, and a steady speed is a mean over up to 0.9 s.
//!
//! Pure: no files, clock, threads or printing.

mod comb;
mod follower;
mod listener;
mod live_speed;
mod meter;
mod octave;
mod recent;
mod review;
mod settings;
mod steady_mean;

pub use listener::Listener;
pub use live_speed::{LiveSpeed, LiveStatus};
pub use octave::PossibleSpeed;
pub use settings::LiveConfig;
