//! The estimators: a closed list.

use serde::{Deserialize, Serialize};

/// How the speed is read from the sound.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Method {
    /// The maximum of the likelihood of all lines together, each weighed by the noise around it.
    #[default]
    Harmonic,
    /// The same for each of several rotors, told apart; their mean is the speed, and their mean square what carries the weight.
    Separated,
    /// The loudest frequency of each frame (paper, section 4.1).
    MaximumTrace,
    /// The centre of the Gaussian through all that reaches a share of the loudest (paper, section 4.2).
    Gaussian,
}

impl Method {
    /// All methods: ours, then the paper's in its order.
    pub const ALL: [Self; 4] = [Self::Separated, Self::Harmonic, Self::MaximumTrace, Self::Gaussian];

    /// What is recommended for so many rotors at once: they are told apart.
    pub fn for_rotors(count: u32) -> Self {
        if count > 1 { Self::Separated } else { Self::default() }
    }

    /// Name in files and flags.
    pub fn name(self) -> &'static str {
        match self {
            Self::Harmonic => "harmonic",
            Self::Separated => "separated",
            Self::MaximumTrace => "maximum_trace",
            Self::Gaussian => "gaussian",
        }
    }

    /// Whether it reads ridges.
    pub fn reads_ridges(self) -> bool {
        matches!(self, Self::MaximumTrace | Self::Gaussian)
    }
}
