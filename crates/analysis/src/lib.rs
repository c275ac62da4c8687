//! The result of an analysis as plain data: speeds, tracks and rotors, the hover and its cuts, tone families, labels, warnings; or the
//! reason for "no rotor tone".
//!
//! There is no signal processing in this crate. `hovertone-rotor-speed` and `hovertone-rotor-id` produce these types; all later crates
//! read them.

mod condition;
mod given;
mod hover;
mod labels;
mod method;
mod no_tone;
mod other_rotor;
mod percent;
mod ridge;
mod rotors_heard;
mod rotors_not_apart;
mod span;
mod speed;
mod speed_analysis;
mod tone_family;
mod uncertainty;
mod verification;
mod warning;
mod weighed_speed;

pub use condition::{RotorCondition, ShaftLine};
pub use given::{FEWER_ROTORS, GivenFacts};
pub use hover::{Cut, CutReason, Hover};
pub use labels::{LABELLED_ROTORS_MAX, LabelSource, NotTold, RotorLabel, RotorLabels};
pub use method::Method;
pub use no_tone::NoTone;
pub use other_rotor::OtherRotor;
pub use percent::percent_in_words;
pub use ridge::{Band, Peak, Ridge, RidgeFrame};
pub use rotors_heard::{RotorsHeard, RotorsHeardCounts};
pub use span::Span;
pub use speed::{HarmonicSpeed, RotorEstimate, SpeedEstimate, TrackPoint};
pub use speed_analysis::{Outcome, RotorTone, SampleSpeeds, SpeedAnalysis};
pub use tone_family::{Meaning, Reading, Remark, SeenHarmonic, ToneFamily};
pub use uncertainty::{UncertaintySource, UncertaintyTerm};
pub use verification::{
    Agreement, COVERAGE_OF_HALF, ComparedPoint, MEAN_OF_MOTORS, RIGHT_SHARE, Verification, VerifiedRotor,
};
pub use warning::{HEARD_SHARE_MIN, Warning};
pub use weighed_speed::WeighedSpeed;
