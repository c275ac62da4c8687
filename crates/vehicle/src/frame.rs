//! Names and positions of the rotors of a frame.

use crate::Layout;
use serde::Serialize;

/// Position of one rotor in body axes: x forward, y left, seen from above.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct RotorPlace {
    /// Name of the place: "front left".
    pub name: &'static str,
    /// Distance forward of the centre of mass.
    pub x_m: f64,
    /// Distance left of the centre of mass.
    pub y_m: f64,
    /// Direction of rotation seen from above: +1 counter-clockwise, -1 clockwise.
    pub spin: f64,
}

impl Layout {
    /// Names of the places, in the order of the numbers of the rotors.
    pub fn place_names(self) -> [&'static str; 4] {
        match self {
            Self::X => ["front left", "rear left", "rear right", "front right"],
            Self::Plus => ["front", "left", "rear", "right"],
        }
    }

    /// The positions of the rotors of this layout for a given length of the arms.
    pub fn places(self, arm_length_m: f64) -> [RotorPlace; 4] {
        let (directions, spins, names) = (self.hub_directions(), self.spins(), self.place_names());
        std::array::from_fn(|k| RotorPlace {
            name: names[k],
            x_m: arm_length_m * directions[k][0],
            y_m: arm_length_m * directions[k][1],
            spin: spins[k],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_say_where_the_rotors_stand() {
        for layout in [Layout::X, Layout::Plus] {
            for place in layout.places(0.2) {
                let says = |word: &str| place.name.contains(word);
                assert!((place.x_m.hypot(place.y_m) - 0.2).abs() < 1e-12);
                assert_eq!((says("front"), says("rear")), (place.x_m > 1e-9, place.x_m < -1e-9), "{place:?}");
                assert_eq!((says("left"), says("right")), (place.y_m > 1e-9, place.y_m < -1e-9), "{place:?}");
            }
        }
    }
}
