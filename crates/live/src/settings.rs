//! Settings of live listening.

use hovertone_rotor_speed::{Config, Discovery};
use hovertone_vehicle::{ConfigError, check_range};

/// What is listened for, and how often it is told.
#[derive(Clone, Debug)]
pub struct LiveConfig {
    /// Settings of the analysis of the last seconds.
    pub analysis: Config,
    /// The search for the tone, where nobody has named it; the order in `analysis` is then a placeholder.
    pub discovery: Option<Discovery>,
    /// Length of the sound that a review analyses: the last seconds.
    pub window_s: f64,
    /// Time from one review to the next while rotors are followed.
    pub review_s: f64,
    /// The same once the last three reviews heard the same rotors: nothing new is expected, and a review costs most of the processor time.
    pub settled_review_s: f64,
    /// The same while none are, and the length of the sound before the first review.
    pub search_s: f64,
    /// Time from one live speed to the next.
    pub every_s: f64,
}

impl LiveConfig {
    /// The recommended settings around those of the analysis.
    pub fn of_analysis(analysis: Config, discovery: Option<Discovery>) -> Self {
        Self { analysis, discovery, window_s: 4.0, review_s: 4.0, settled_review_s: 8.0, search_s: 2.0, every_s: 0.1 }
    }

    pub(crate) fn check(&self) -> Result<(), ConfigError> {
        self.analysis.check()?;
        check_range("window_s", self.window_s, 2.0, 60.0)?;
        check_range("review_s", self.review_s, 0.5, 60.0)?;
        check_range("settled_review_s", self.settled_review_s, self.review_s, 600.0)?;
        check_range("search_s", self.search_s, 0.5, 60.0)?;
        check_range("every_s", self.every_s, 0.025, 10.0)
    }
}
