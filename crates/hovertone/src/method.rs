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
    /// The loudest frequency of each frame (paper, section 4.1).
    MaximumTrace,
    /// The centre of the Gaussian through all that reaches a share of the loudest (paper, section 4.2).
    Gaussian,
}

impl Method {
    /// All methods: ours, then the paper's in its order.
    pub const ALL: [Self; 3] = [Self::Harmonic, Self::MaximumTrace, Self::Gaussian];

    /// Name in files and flags.
    pub fn name(self) -> &'static str {
        match self {
            Self::Harmonic => "harmonic",
            Self::MaximumTrace => "maximum_trace",
            Self::Gaussian => "gaussian",
        }
    }
}
