//! Sound as samples, and the arithmetic on it that needs no rotor: sources, passes, spectra, narrow channels, peaks, statistics, and the
//! least-squares solver of lines that overlap.
//!
//! Pure: no files, clock, threads or printing.

pub mod channels;
mod error;
pub mod line_solver;
pub mod passes;
pub mod peak;
mod source;
pub mod spectrogram;
pub mod statistics;

pub use error::SignalError;
pub use source::{Signal, SignalSource, SourceError};
