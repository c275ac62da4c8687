//! Sound as samples, and the arithmetic on it that knows nothing of rotors.
//!
//! | module | content |
//! |---|---|
//! | crate root | [`SignalSource`]: mono samples in blocks; [`Signal`]: samples in memory; [`SteadyLines`]: lines that passes leave out |
//! | [`passes`] | runs over a source: the wanted stretches of time, block by block |
//! | [`spectrogram`] | power spectra of frames, window shapes, decimation, the noise floor, the cutoff of a codec |
//! | [`channels`] | a bank of band-pass filters: one complex signal at a low rate for each spectral line |
//! | [`fft`] | plans of fast Fourier transforms |
//! | [`peak`] | the frequency of a spectral peak, finer than a bin |
//! | [`statistics`] | mean, spread, median, uncertainty of the mean of a correlated series |
//! | [`line_frequency`] | the frequency of one line in a band, with its uncertainty |
//! | [`line_solver`] | least squares of spectral lines that overlap |
//!
//! Units are SI: times in s, frequencies in Hz. Samples have full scale ±1; a power of 1 (0 dB) is a sine of full scale.
//!
//! Pure: no files, clock, threads or printing.

pub mod channels;
mod error;
pub mod line_frequency;
pub mod line_solver;
pub mod passes;
pub mod peak;
mod source;
pub mod spectrogram;
pub mod statistics;
mod without_lines;

pub use error::SignalError;
pub use hovertone_fft as fft;
pub use source::{RECORDED_RATE_SHARE, Signal, SignalSource, SourceError};
pub use without_lines::SteadyLines;
