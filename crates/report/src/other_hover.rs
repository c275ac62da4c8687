//! A flight whose rotors hover at another speed than the numbers of the vehicle tell.

use crate::notice::Notice;

/// The hover speed of a flight beside the one that the vehicle's numbers tell.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OtherHover {
    /// Mean speed of the rotors on this flight.
    pub flown_rev_s: f64,
    /// Speed at which the vehicle would hover with its mass and its thrust constant.
    pub expected_rev_s: f64,
}

impl From<OtherHover> for Notice {
    fn from(hover: OtherHover) -> Self {
        let text = format!(
            "the rotors turn at {:.1} rev/s on this flight, but with this mass the vehicle would hover at {:.1} rev/s",
            hover.flown_rev_s, hover.expected_rev_s
        );
        Self::new(text, "check --mass-kg and --vehicle: the scenario of --scenario has this mass")
    }
}
