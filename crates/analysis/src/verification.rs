//! Heard speeds against the speeds in a log of the same flight.

/// Largest relative difference of heard and logged speeds at which order and clock are right: clocks of recorders are right to 0.01 %, telemetry to
/// its rounding. *Decision.*
const RIGHT_SHARE: f64 = 0.005;

/// A heard and a logged speed at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComparedPoint {
    /// Time on the clock of the recording.
    pub time_s: f64,
    /// Heard speed.
    pub heard_rev_s: f64,
    /// Its standard uncertainty.
    pub std_uncertainty_rev_s: f64,
    /// Logged speed.
    pub logged_rev_s: f64,
}

/// One track against its motor.
#[derive(Clone, Debug, PartialEq)]
pub struct VerifiedRotor {
    /// Index of the track among all tracks.
    pub track: usize,
    /// Index of the motor in the log; the number of motors for their mean, which the one tone of all rotors may follow.
    pub motor: usize,
    /// Its name.
    pub name: String,
    /// Mean heard speed.
    pub speed_rev_s: f64,
    /// Mean of heard less logged speed.
    pub bias_rev_s: f64,
    /// Standard deviation of heard less logged speed.
    pub scatter_rev_s: f64,
    /// Share of the points within ± of the logged speed, whose rounding counts.
    pub coverage: f64,
    /// Compared points.
    pub point_count: usize,
    /// The points.
    pub points: Vec<ComparedPoint>,
}

/// Sound against telemetry.
#[derive(Clone, Debug, PartialEq)]
pub struct Verification {
    /// Time to be added to the log's clock to get the recording's.
    pub offset_s: f64,
    /// Whether another offset would be clearly worse; else the speeds are too steady to tell it.
    pub is_offset_told: bool,
    /// Rate of the log's clock over the recording's, less 1; absent in short comparisons.
    pub clock_rate_share: Option<f64>,
    /// The rotors, in the sequence of the tracks.
    pub rotors: Vec<VerifiedRotor>,
    /// Mean of heard over logged speeds.
    pub speed_ratio: f64,
    /// The simple ratio that it is near to.
    pub near_ratio: Option<f64>,
}

impl Verification {
    /// Whether the recording's order and clock are right: heard and logged speeds are equal.
    pub fn is_right(&self) -> bool {
        (self.speed_ratio - 1.0).abs() <= RIGHT_SHARE
    }
}
