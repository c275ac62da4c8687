//! Which track of a recording belongs to which rotor, and the condition of each rotor.
//!
//! A separation of rotors (`hovertone-rotor-speed`) gives tracks without names. Each room of this crate compares the tracks with a
//! second source:
//!
//! ```text
//! tracks ─┬─ log of the flight ────────▶ by_log ─────────┐
//!         │                                              ├─▶ likelihood ratio of every    ─▶ posterior over  ─▶ labels, or the
//!         ├─ several microphones ──────▶ by_microphones ─┘   assignment, tracks to rotors    assignments        reason why not
//!         │
//!         ├─ sound of the spin-up ─────▶ by_spin_up ─────▶ start of every rotor ─▶ sequence of the starts ────▶ labels, or the
//!         │                                                                                                     reason why not
//!         └─ sound of the hover ───────▶ condition ──────▶ level of every shaft line, relative to the blade pass
//! ```
//!
//! All rooms read the tracks through `speed_curve`: the speed and the shaft angle of a rotor at any time.
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
