//! Sound as the core takes it in: one channel of samples at the rate it was recorded at.

use std::error::Error;
use std::fmt;

/// Mono sound that can be heard from its first sample as often as needed, in blocks, so that memory does not grow with
/// its length.
pub trait SignalSource {
    /// Samples per second, as recorded: analysis never resamples.
    fn sample_rate_hz(&self) -> f64;

    /// Time of the first sample on the recording's own clock: not zero where the audio of a video starts late.
    fn start_s(&self) -> f64;

    /// The next samples, full scale ±1, always finite; never empty; `None` after the last.
    fn next_block(&mut self) -> Result<Option<&[f32]>, SourceError>;

    /// Back to the first sample.
    fn rewind(&mut self) -> Result<(), SourceError>;
}

/// A source could not deliver its next samples.
#[derive(Debug)]
pub struct SourceError(Box<dyn Error + Send + Sync>);

impl SourceError {
    /// Wraps what the source has to say.
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

/// Samples that are handed out at a time.
const BLOCK_SAMPLES: usize = 1 << 16;

impl Signal {
    /// Samples, full scale ±1, and their rate. Their first is at time 0.
    pub fn new(samples: Vec<f32>, sample_rate_hz: f64) -> Self {
        Self { samples, sample_rate_hz, start_s: 0.0, position: 0 }
    }

    /// The same sound, starting at `start_s` on the recording's clock.
    #[must_use]
    pub fn with_start_s(self, start_s: f64) -> Self {
        Self { start_s, ..self }
    }

    /// The samples.
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
