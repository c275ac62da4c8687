//! Sound → speeds of the four rotors, heard along the speeds that a model predicts.
//!
//! ```text
//! sound ─ heard_lines ▶ one complex signal for each line ─┐
//!                                                          ├─ window ▶ likelihood, gradient, information of one window ─ along ▶ observations
//! model ─ prediction ▶ angles of the four rotors ──────────┘                     └─ search ▶ hover speeds, gains and names to start from
//! ```
//!
//! In the end, `place` compares the sound with and without echoes (`echoed`), which the model does not contain.
//!
//! A flight through doublets has no steady lines, and rotors that are alike cannot be separated in hover. Along the prediction they can: each rotor
//! has an angle of its own, and a window of sound is a sum of lines `Σ a exp(j o θᵢ(t))` with known angles and unknown amplitudes. The likelihood of
//! a window, with amplitudes that are Gaussian, is that of a linear model; how it changes with the speeds tells how far the model is off.

mod along;
mod clock;
mod echoed;
mod heard_lines;
mod mirror;
mod place;
mod search;
mod turns;
mod window;

pub use along::{SoundConfig, SoundFit, grey_box_from_sound, speeds_along};
pub use clock::log_offset_s;
pub use heard_lines::{HeardLines, LineOrders, lines_from_passes};
pub use place::Echoes;
