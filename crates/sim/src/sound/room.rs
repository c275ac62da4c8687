//! The surroundings: free field, a ground, or a room.

use super::settings::{Bound, checked};
use hovertone_vehicle::QuantityError;

/// Absorption coefficient α of each surface: the absorbed share of the sound energy. The reflected pressure is `√(1 - α)`
/// of the incoming pressure.
///
/// One number for all frequencies. Values from tables at 1 kHz (from 125 Hz to 4 kHz they vary by a factor of 2 and
/// more): concrete or tile 0.02, linoleum on concrete 0.03, painted block 0.07, window glass 0.12, wood 0.07
/// (sengpielaudio.com/calculator-RT60Coeff.htm; Barron, Industrial Noise Control and Acoustics, appendix D).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct WallAbsorption {
    /// The wall with the smallest x.
    pub x_low: f64,
    /// The wall with the largest x.
    pub x_high: f64,
    /// The wall with the smallest y.
    pub y_low: f64,
    /// The wall with the largest y.
    pub y_high: f64,
    /// The floor.
    pub floor: f64,
    /// The ceiling.
    pub ceiling: f64,
}

/// A box, its edges along the axes of the world.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Room {
    /// The corner with the smallest coordinates; its z is the floor.
    pub corner_m: [f64; 3],
    /// Length along x, along y, and height.
    pub size_m: [f64; 3],
    /// Absorption of the six surfaces.
    pub absorption: WallAbsorption,
    /// Reverberation time: the exponential tail falls by 60 dB in it; `None` for first reflections only.
    /// [`sabine_reverberation_s`](Self::sabine_reverberation_s) gives the time for the surfaces alone.
    pub reverberation_s: Option<f64>,
}

/// The place of the flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Surroundings {
    /// No reflections at all.
    FreeField,
    /// A level ground at z = 0 and nothing else.
    Ground {
        /// Absorption coefficient of the ground.
        absorption: f64,
    },
    /// Within a box.
    Room(Room),
}

/// A reflecting surface: the plane where coordinate `axis` is `at_m`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Mirror {
    pub(crate) axis: usize,
    pub(crate) at_m: f64,
    /// Reflected pressure over incoming pressure.
    pub(crate) reflection: f64,
}

impl Mirror {
    pub(crate) fn image(&self, mut point: [f64; 3]) -> [f64; 3] {
        point[self.axis] = 2.0 * self.at_m - point[self.axis];
        point
    }

    pub(crate) fn image_of_direction(&self, mut direction: [f64; 3]) -> [f64; 3] {
        direction[self.axis] = -direction[self.axis];
        direction
    }
}

impl Default for Room {
    /// A laboratory of ordinary size about the origin of the flight, for the paper's figure 1, which has no scale: 8 x 6 x 3
    /// m, walls of plaster with windows and shelves (0.1), linoleum on concrete (0.03), a plain ceiling (0.05). The
    /// tail is Sabine's for these surfaces, 1.9 s, shortened to 0.6 s by furniture and people (assumed).
    fn default() -> Self {
        Self {
            corner_m: [-4.0, -3.0, 0.0],
            size_m: [8.0, 6.0, 3.0],
            absorption: WallAbsorption { x_low: 0.1, x_high: 0.1, y_low: 0.1, y_high: 0.1, floor: 0.03, ceiling: 0.05 },
            reverberation_s: Some(0.6),
        }
    }
}

impl Room {
    fn surfaces(&self) -> [(usize, f64, f64); 6] {
        let high = |axis: usize| self.corner_m[axis] + self.size_m[axis];
        let low = self.corner_m;
        let walls = self.absorption;
        [
            (0, low[0], walls.x_low),
            (0, high(0), walls.x_high),
            (1, low[1], walls.y_low),
            (1, high(1), walls.y_high),
            (2, low[2], walls.floor),
            (2, high(2), walls.ceiling),
        ]
    }

    fn area_m2(&self, axis: usize) -> f64 {
        self.size_m[(axis + 1) % 3] * self.size_m[(axis + 2) % 3]
    }

    fn total_area_m2(&self) -> f64 {
        2.0 * (0..3).map(|axis| self.area_m2(axis)).sum::<f64>()
    }

    fn volume_m3(&self) -> f64 {
        self.size_m.iter().product()
    }

    /// Reverberation time of the bare surfaces, `T60 = 0.161 V / Σ S α` (Sabine); infinite if nothing absorbs.
    pub fn sabine_reverberation_s(&self) -> f64 {
        let absorbing: f64 = self.surfaces().iter().map(|&(axis, _, absorption)| self.area_m2(axis) * absorption).sum();
        0.161 * self.volume_m3() / absorbing
    }

    /// Mean square of the tail over the mean square at 1 m in the free field: `16 π (1 - ᾱ)² / A`, with Sabine's
    /// `A = 0.161 V / T60` and `ᾱ = A / S`. It is the diffuse field `4 W (1 - ᾱ) / A` (Beranek) without the first
    /// reflection, which comes from the mirror images.
    pub(crate) fn tail_power(&self, reverberation_s: f64) -> f64 {
        let absorbing_m2 = 0.161 * self.volume_m3() / reverberation_s;
        let mean_absorption = (absorbing_m2 / self.total_area_m2()).min(1.0);
        16.0 * std::f64::consts::PI * (1.0 - mean_absorption).powi(2) / absorbing_m2
    }

    fn check(&self) -> Result<(), QuantityError> {
        for (corner, size) in self.corner_m.into_iter().zip(self.size_m) {
            checked("room corner_m", corner, Bound::Finite)?;
            checked("room size_m", size, Bound::Within(0.5, 200.0, "between 0.5 and 200"))?;
        }
        for (_, _, absorption) in self.surfaces() {
            checked("absorption", absorption, Bound::Within(0.0, 1.0, "between 0 and 1"))?;
        }
        let tail_s = self.reverberation_s.unwrap_or(1.0);
        checked("reverberation_s", tail_s, Bound::Within(0.05, 20.0, "between 0.05 and 20"))
    }
}

impl Surroundings {
    pub(crate) fn check(&self) -> Result<(), QuantityError> {
        match self {
            Self::FreeField => Ok(()),
            Self::Ground { absorption } => {
                checked("absorption", *absorption, Bound::Within(0.0, 1.0, "between 0 and 1"))
            }
            Self::Room(room) => room.check(),
        }
    }

    /// Every path from a rotor to a microphone: direct, and by each reflecting surface.
    pub(crate) fn ways(&self) -> Vec<Option<Mirror>> {
        let surfaces = match self {
            Self::FreeField => Vec::new(),
            Self::Ground { absorption } => vec![(2, 0.0, *absorption)],
            Self::Room(room) => room.surfaces().to_vec(),
        };
        let mirrors = surfaces
            .into_iter()
            .filter(|(_, _, absorption)| *absorption < 1.0)
            .map(|(axis, at_m, absorption)| Some(Mirror { axis, at_m, reflection: (1.0 - absorption).sqrt() }));
        [None].into_iter().chain(mirrors).collect()
    }

    /// Refuses a place behind a surface.
    pub(crate) fn check_place(&self, name: &'static str, place: [f64; 3]) -> Result<(), QuantityError> {
        let outside = |value: f64, must_be| Err(QuantityError { name, value, must_be });
        match self {
            Self::FreeField => Ok(()),
            Self::Ground { .. } if place[2] < 0.0 => outside(place[2], "above the ground"),
            Self::Ground { .. } => Ok(()),
            Self::Room(room) => {
                for (axis, &value) in place.iter().enumerate() {
                    let beyond = value - room.corner_m[axis];
                    if !(0.0..=room.size_m[axis]).contains(&beyond) {
                        return outside(value, "within the room");
                    }
                }
                Ok(())
            }
        }
    }
}
