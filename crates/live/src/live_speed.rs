//! What is heard now.

use serde::Serialize;

/// The answer at one moment.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LiveSpeed {
    /// Length of the sound so far.
    pub time_s: f64,
    /// Whether a rotor is heard, and its octave decided.
    pub status: LiveStatus,
    /// Shaft speed; of several rotors their mean. Where the octave is not decided, the speed that is followed, which is one of
    /// [`crate::Listener::possible`]. `None` where no rotor is heard.
    pub speed_rev_s: Option<f64>,
    /// Its combined standard uncertainty: of the noise of the frames, and of the last review.
    pub std_uncertainty_rev_s: Option<f64>,
    /// Level of the sound since the last live speed, against a sine of full scale.
    pub level_db: f64,
    /// Share of its audio samples at full scale.
    pub clipped_share: f64,
}

/// Whether a rotor is heard.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum LiveStatus {
    /// One speed.
    Ok,
    /// A rotor, whose speed may be another one: see [`crate::Listener::possible`].
    Ambiguous,
    /// No rotor tone.
    NoRotorTone,
    /// Too little sound yet for the first review.
    Listening,
}
