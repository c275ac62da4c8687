//! Heard speeds against the speeds in a log of the same flight.

/// Largest relative difference of heard and logged speeds at which order and clock are right: clocks of recorders are right to 0.01 %, telemetry to
/// its rounding. *Decision.*
pub const RIGHT_SHARE: f64 = 0.005;

/// Share of the points within their ± (k = 2) where the true ± is twice the stated: P(|z| < 1). Below it, sound and log are not of the same
/// speeds. Of rotors that are separated, the measured coverage is 0.85 to 0.9 (`docs/verify.md`). *Decision.*
pub const COVERAGE_OF_HALF: f64 = 0.6827;

/// A heard and a logged speed at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ComparedPoint {
    /// Time on the clock of the recording.
    pub time_s: f64,
    /// Heard speed.
    pub heard_rev_s: f64,
    /// Standard uncertainty of the heard speed.
    pub std_uncertainty_rev_s: f64,
    /// Logged speed.
    pub logged_rev_s: f64,
}

/// Name of the mean of the motors of a log, with which rotors that are not separated are compared.
pub const MEAN_OF_MOTORS: &str = "mean of all motors";

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

/// How well the points lie within their ±, as a share of the points against 95 %.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Agreement {
    /// The share may be 95 %.
    AsStated,
    /// The share is below 95 %, but the ± is no less than half as large as it should be.
    PlusMinusTooSmall,
    /// The scatter is more than twice the stated: sound and log do not follow the same speeds.
    Scattered,
}

/// Sound against telemetry.
#[derive(Clone, Debug, PartialEq)]
pub struct Verification {
    /// Time to be added to the log's clock to get the recording's.
    pub offset_s: f64,
    /// Whether another offset would be clearly worse; else the speeds are too steady to tell it.
    pub is_offset_told: bool,
    /// Whether limits of the offset were given.
    pub is_offset_given: bool,
    /// Whether the offset lies at a given limit, and the speeds do not tell it: then it may be any.
    pub is_offset_at_limit: bool,
    /// An offset outside of the given limits at which the log fits clearly better.
    pub better_offset_s: Option<f64>,
    /// How well the points lie within their ±.
    pub agreement: Agreement,
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

    /// Whether recording and log agree: the means are equal, the offset is within its limits, the points agree, and the log is of this flight.
    pub fn passes(&self) -> bool {
        self.is_right()
            && self.better_offset_s.is_none()
            && self.agreement != Agreement::Scattered
            && self.is_of_this_flight()
    }

    /// Whether something shows that the log is of this flight: speeds that change together tell the offset of the clocks, or it was given and
    /// most points agree. Equal means of steady speeds show nothing, since another flight of the vehicle has them too; nor does an offset at its
    /// limit, where the next one fits better.
    fn is_of_this_flight(&self) -> bool {
        let is_given = self.is_offset_given && !self.is_offset_at_limit;
        self.is_offset_told || is_given && self.coverage() >= COVERAGE_OF_HALF
    }

    /// Share of the points of all rotors within their ±.
    pub fn coverage(&self) -> f64 {
        let count: usize = self.rotors.iter().map(|rotor| rotor.point_count).sum();
        let within: f64 = self.rotors.iter().map(|rotor| rotor.coverage * rotor.point_count as f64).sum();
        within / count.max(1) as f64
    }
}
