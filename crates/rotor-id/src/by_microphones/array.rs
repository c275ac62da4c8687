//! Places of microphones and rotors.

use hovertone_analysis::LABELLED_ROTORS_MAX;

/// Largest coordinate of a microphone or rotor, in m: a larger one is a wrong unit. *Decision.*
const POSITION_M_MAX: f64 = 1000.0;
/// Fewest microphones and fewest rotors: both are compared with each other. *Numeric.*
const COUNT_MIN: usize = 2;

/// Place of a rotor on the vehicle.
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
    pub(super) microphones_m: Vec<[f64; 3]>,
    pub(super) rotors: Vec<PlacedRotor>,
}

/// Why an array is refused.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ArrayError {
    /// Fewer than two microphones: nothing can be compared.
    #[error("the number of microphones is {count}, but at least 2 are needed")]
    TooFewMicrophones {
        /// Number of microphones.
        count: usize,
    },
    /// Fewer than two rotors, or more than can be labelled.
    #[error("the number of rotors is {count}, but only 2 to {LABELLED_ROTORS_MAX} rotors can be named")]
    WrongRotorCount {
        /// Number of rotors.
        count: usize,
    },
    /// A coordinate that is not finite or larger than 1000 m.
    #[error("the position of {what} {number} is more than 1000 m from the origin, or is no number")]
    BadPosition {
        /// "microphone" or "rotor".
        what: &'static str,
        /// Its number, from 1.
        number: usize,
    },
}

impl MicrophoneArray {
    /// Microphones in the sequence of the recording's audio channels, and rotors in the sequence of their numbers.
    ///
    /// # Errors
    /// Fewer than two microphones or rotors, more rotors than can be labelled, a coordinate beyond 1000 m or not finite.
    pub fn new(microphones_m: Vec<[f64; 3]>, rotors: Vec<PlacedRotor>) -> Result<Self, ArrayError> {
        if microphones_m.len() < COUNT_MIN {
            return Err(ArrayError::TooFewMicrophones { count: microphones_m.len() });
        }
        if !(COUNT_MIN..=LABELLED_ROTORS_MAX).contains(&rotors.len()) {
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

    /// Number of microphones, and so of audio channels.
    pub fn microphone_count(&self) -> usize {
        self.microphones_m.len()
    }

    /// Number of rotors.
    pub fn rotor_count(&self) -> usize {
        self.rotors.len()
    }
}

/// The unit vector from one place to another; zero if they are the same.
pub(super) fn direction(from_m: [f64; 3], to_m: [f64; 3]) -> [f64; 3] {
    let far_m = distance_m(from_m, to_m).max(f64::MIN_POSITIVE);
    std::array::from_fn(|axis| (to_m[axis] - from_m[axis]) / far_m)
}

pub(super) fn distance_m(a_m: [f64; 3], b_m: [f64; 3]) -> f64 {
    a_m.iter().zip(b_m).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
}
