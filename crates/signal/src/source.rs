//! The input of every analysis: one channel of samples at the rate of the recording.

use std::error::Error;
use std::fmt;

/// Highest frequency that a recording holds without loss, as a share of its sample rate: the filters of recorders end below one half. *Physics.*
pub const RECORDED_RATE_SHARE: f64 = 0.45;

/// Mono sound that delivers its samples in blocks and can start again from the first sample.
///
/// An analysis reads a source several times and holds one block at a time, so that memory does not grow with the length of
/// the recording.
pub trait SignalSource {
    /// Sample rate of the recording, Hz. The analysis never resamples.
    fn sample_rate_hz(&self) -> f64;

    /// Time of the first sample on the recording's own clock, s. It is not zero where the audio of a video starts late.
    fn start_s(&self) -> f64;

    /// The next samples: full scale ±1, finite, at least one. `None` after the last sample.
    ///
    /// # Errors
    /// The source cannot deliver its next samples.
    fn next_block(&mut self) -> Result<Option<&[f32]>, SourceError>;

    /// Goes back to the first sample.
    ///
    /// # Errors
    /// The source cannot start again.
    fn rewind(&mut self) -> Result<(), SourceError>;
}

/// A source could not deliver its next samples or start again. Holds the cause.
#[derive(Debug)]
pub struct SourceError(Box<dyn Error + Send + Sync>);

impl SourceError {
    /// Wraps the cause of the failure.
    pub fn new(cause: impl Into<Box<dyn Error + Send + Sync>>) -> Self {
        Self(cause.into())
    }
}

impl fmt::Display for SourceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}

impl Error for SourceError {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        self.0.source()
    }
}

/// Sound held in memory: for tests, simulation and short pieces.
#[derive(Clone, Debug)]
pub struct Signal {
    samples: Vec<f32>,
    sample_rate_hz: f64,
    start_s: f64,
    position: usize,
}

/// Length of the blocks that [`Signal`] delivers, in samples. *Numeric.*
const BLOCK_SAMPLES: usize = 1 << 16;

impl Signal {
    /// Samples of full scale ±1 at a rate in Hz. The first sample is at time 0.
    pub fn new(samples: Vec<f32>, sample_rate_hz: f64) -> Self {
        Self { samples, sample_rate_hz, start_s: 0.0, position: 0 }
    }

    /// The same sound with its first sample at `start_s` on the recording's clock.
    #[must_use]
    pub fn with_start_s(self, start_s: f64) -> Self {
        Self { start_s, ..self }
    }

    /// All samples.
    pub fn samples(&self) -> &[f32] {
        &self.samples
    }
}

impl SignalSource for Signal {
    fn sample_rate_hz(&self) -> f64 {
        self.sample_rate_hz
    }

    fn start_s(&self) -> f64 {
        self.start_s
    }

    fn next_block(&mut self) -> Result<Option<&[f32]>, SourceError> {
        let from = self.position;
        self.position = (from + BLOCK_SAMPLES).min(self.samples.len());
        Ok(Some(&self.samples[from..self.position]).filter(|block| !block.is_empty()))
    }

    fn rewind(&mut self) -> Result<(), SourceError> {
        self.position = 0;
        Ok(())
    }
}
