//! The methods of estimating the speed.

use serde::{Deserialize, Serialize};

/// Method of estimating the shaft speed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
#[non_exhaustive]
pub enum Method {
    /// Maximum of the likelihood of all lines together, each with the noise around it.
    #[default]
    Harmonic,
    /// The same for several rotors, which are separated. The speed is their mean; the thrust follows from their mean square.
    Separated,
    /// Maximum Trace: the loudest frequency of each frame (paper, section 4.1).
    MaximumTrace,
    /// Gaussian approximation: the centre of a Gaussian through all bins above a share of the loudest one (paper, section 4.2).
    Gaussian,
}

impl Method {
    /// All methods: the two of this project, then the two of the paper in its order.
    pub const ALL: [Self; 4] = [Self::Separated, Self::Harmonic, Self::MaximumTrace, Self::Gaussian];

    /// The recommended method for a number of rotors: several are separated.
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

    /// Whether the method uses ridges.
    pub fn reads_ridges(self) -> bool {
        matches!(self, Self::MaximumTrace | Self::Gaussian)
    }
}
