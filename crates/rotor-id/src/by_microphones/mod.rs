//! Which rotor is which, from several microphones whose places are known: levels and delays.
//!
//! ```text
//! each channel, along the rotors' turns ─▶ amplitude of every line in blocks (lines) ─▶ side by side (heard)
//!                                                                                              │
//!         posterior over all assignments ◀── levels ◀── 1/r, patterns, gains ◀─────────────────┤
//!                                        ◀── delays ◀── r/c, as far as positions allow ◀───────┘
//! ```

mod delays;
mod heard;
mod levels;
mod lines;
mod settings;

pub use settings::MicrophonesConfig;

pub use lines::{MicrophoneLines, microphone_lines_from_source};

use crate::posterior::{Posterior, assignments};
use crate::settings::LabelsConfig;
use delays::Delays;
use heard::heard_lines;
use hovertone_analysis::{LABELLED_ROTORS_MAX, LabelSource, NotTold, RotorLabels};
use levels::Levels;

/// Nothing on or about a vehicle is further away.
const POSITION_M_MAX: f64 = 1000.0;

/// One rotor alone compares with nothing.
const TRACKS_MIN: usize = 2;

/// Where a rotor stands on the vehicle.
#[derive(Clone, Debug, PartialEq)]
pub struct PlacedRotor {
    /// Its name: "front left".
    pub name: String,
    /// Its hub in the vehicle's frame.
    pub position_m: [f64; 3],
}

/// Microphones and rotors in the vehicle's frame: x forward, y left, z up, origin at the centre of the rotors.
#[derive(Clone, Debug, PartialEq)]
pub struct MicrophoneArray {
    microphones_m: Vec<[f64; 3]>,
    rotors: Vec<PlacedRotor>,
}

/// An array that means nothing.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ArrayError {
    /// One microphone compares with nothing.
    #[error("{count} microphone(s), and at least 2 are needed")]
    TooFewMicrophones {
        /// How many there are.
        count: usize,
    },
    /// One rotor is told apart from nothing.
    #[error("{count} rotor(s), and 2 to {LABELLED_ROTORS_MAX} can be told")]
    WrongRotorCount {
        /// How many there are.
        count: usize,
    },
    /// A position that is no place.
    #[error("{what} {number} is at a place that is not within 1000 m")]
    BadPosition {
        /// "microphone" or "rotor".
        what: &'static str,
        /// Which, counted from 1.
        number: usize,
    },
}

impl MicrophoneArray {
    /// Microphones in the order of the recording's channels, and rotors in the order of their numbers.
    ///
    /// # Errors
    /// Fewer than two of either, more rotors than can be told, positions that are no places.
    pub fn new(microphones_m: Vec<[f64; 3]>, rotors: Vec<PlacedRotor>) -> Result<Self, ArrayError> {
        if microphones_m.len() < 2 {
            return Err(ArrayError::TooFewMicrophones { count: microphones_m.len() });
        }
        if !(2..=LABELLED_ROTORS_MAX).contains(&rotors.len()) {
            return Err(ArrayError::WrongRotorCount { count: rotors.len() });
        }
        let is_bad = |at_m: &[f64; 3]| at_m.iter().any(|metres| metres.is_nan() || metres.abs() > POSITION_M_MAX);
        if let Some(bad) = microphones_m.iter().position(is_bad) {
            return Err(ArrayError::BadPosition { what: "microphone", number: bad + 1 });
        }
        if let Some(bad) = rotors.iter().position(|rotor| is_bad(&rotor.position_m)) {
            return Err(ArrayError::BadPosition { what: "rotor", number: bad + 1 });
        }
        Ok(Self { microphones_m, rotors })
    }

    /// How many microphones there are, and so channels.
    pub fn microphone_count(&self) -> usize {
        self.microphones_m.len()
    }

    /// How many rotors there are.
    pub fn rotor_count(&self) -> usize {
        self.rotors.len()
    }
}

/// Which rotor each track is, from what several microphones heard of its lines: `heard` has one entry for each microphone of `array`,
/// in its order, all made with the same tracks.
///
/// Every assignment of tracks to rotors is weighed by its likelihood ratio to "rotors and microphones stand elsewhere, as far apart as
/// these, in no order":
///
/// - *Levels*: the mean level of a rotor's lines at a microphone is its loudness (not known) `− 20 log₁₀ d` + half of what the pattern
///   of turning blades would make of it, ± the other half; ± what bodies and arms do
///   ([`level_std_db`](MicrophonesConfig::level_std_db)), ± the microphones' gains, which are the same for all rotors, ± the scatter of
///   its lines, which is measured.
/// - *Delays*: the phase of a line between two microphones is `−2π f (d_a − d_b) / c`. Of each two rotors the difference of these
///   phases is compared, in which a vehicle that drifts is the same and cancels. What else is not known of the positions adds to the path
///   of all lines of a rotor alike, and is integrated over; single lines scatter by von Mises, in a width that is integrated over, and
///   some say nothing. Lines of which the positions make more than half a wave are left out.
///
/// The answer is "not told" where nothing stands out, per rotor and altogether: microphones in a plane of symmetry of the vehicle do not
/// tell its two sides. Measured limits: docs/rotors.md.
pub fn labels_from_microphones(
    heard: &[MicrophoneLines],
    array: &MicrophoneArray,
    config: &MicrophonesConfig,
) -> RotorLabels {
    let tracks = heard.first().map_or(0, |lines| lines.speeds_rev_s.len());
    let not_told = |reason| RotorLabels::not_told(LabelSource::Microphones, tracks, reason);
    if heard.len() != array.microphones_m.len() {
        return not_told(NotTold::OtherChannels { channels: heard.len(), microphones: array.microphones_m.len() });
    }
    if tracks < TRACKS_MIN {
        return not_told(NotTold::TooFewTracks { tracks, needed: TRACKS_MIN });
    }
    if tracks > array.rotors.len() {
        return not_told(NotTold::OtherPlaces { tracks, places: array.rotors.len() });
    }
    let lines = heard_lines(heard, config);
    let hears = |microphone: &usize| lines.levels.iter().any(|line| line.powers[*microphone].is_some());
    if let Some(deaf) = (0..heard.len()).find(|microphone| !hears(microphone)) {
        return not_told(NotTold::NothingHeard { microphone: deaf + 1 });
    }
    let assignments = assignments(tracks, array.rotors.len());
    let (levels, delays) =
        (Levels::new(&lines.levels, tracks, array, config), Delays::new(&lines.phases, tracks, array, config));
    let believed = assignments
        .iter()
        .map(|assignment| levels.log_ratio(assignment) + delays.log_ratio(assignment))
        // numbers that overflow say nothing
        .map(|ratio| if ratio.is_finite() { config.evidence_share * ratio } else { 0.0 })
        .map(|believed| believed + (config.array_prior / (1.0 - config.array_prior)).ln());
    // there is one clock
    let mut posterior = Posterior::new(&assignments, 1);
    posterior.add(0.0, Some(believed.collect()));
    let names: Vec<String> = array.rotors.iter().map(|rotor| rotor.name.clone()).collect();
    let settings = LabelsConfig { probability_min: config.probability_min, ..LabelsConfig::default() };
    let labels = posterior.labels(LabelSource::Microphones, &names, &settings);
    let not_told = labels.not_told.map(|reason| match reason {
        NotTold::NothingInCommon { probability } => NotTold::OtherArray { probability },
        NotTold::SeveralFit { tracks } => NotTold::SeveralPlacesFit { tracks },
        other => other,
    });
    RotorLabels { offset_s: None, offset_std_s: None, not_told, ..labels }
}

/// The unit vector from one place to another; none where they are the same.
fn direction(from_m: [f64; 3], to_m: [f64; 3]) -> [f64; 3] {
    let far_m = distance_m(from_m, to_m).max(f64::MIN_POSITIVE);
    std::array::from_fn(|axis| (to_m[axis] - from_m[axis]) / far_m)
}

fn distance_m(a_m: [f64; 3], b_m: [f64; 3]) -> f64 {
    a_m.iter().zip(b_m).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}
