//! Settings: the lines of a rotor.

use super::line_scatter::{LineClass, LineScatter};
use hovertone_vehicle::{QuantityError, Vehicle};

/// Lines of the gear between motor and rotor. Levels are amplitudes in the unit of all levels.
#[derive(Clone, Debug, PartialEq)]
pub struct GearMeshTones {
    /// Teeth of the wheel on the rotor's shaft: lines per turn.
    pub order: u32,
    /// Level of the mesh tone and of its harmonics.
    pub harmonic_levels: Vec<f64>,
    /// Levels of the sidebands at ±1, ±2, … shaft speeds, as shares of their harmonic.
    pub sideband_levels: Vec<f64>,
}

impl GearMeshTones {
    /// The mesh of a wheel with this number of teeth: harmonics at levels 1, 0.5, 0.25 with sidebands of 0.3 and 0.15. No published
    /// levels were found; these are assumed.
    pub fn with_order(order: u32) -> Self {
        Self { order, harmonic_levels: vec![1.0, 0.5, 0.25], sideband_levels: vec![0.3, 0.15] }
    }
}

/// Lines of the blades, `level · h^exponent` at `h` times the blade pass, h = 1…harmonic_count.
#[derive(Clone, Debug, PartialEq)]
pub struct BladePassTones {
    /// Blades of the propeller: lines per turn.
    pub blade_count: u32,
    /// Number of harmonics, including the blade pass.
    pub harmonic_count: u32,
    /// Level of the blade pass.
    pub level: f64,
    /// Exponent of the harmonic's number in its level.
    pub exponent: f64,
}

impl BladePassTones {
    /// Twenty harmonics at `2 h^-0.7` (assumed, as the levels of the mesh).
    pub fn with_blades(blade_count: u32) -> Self {
        Self { blade_count, harmonic_count: 20, level: 2.0, exponent: -0.7 }
    }

    /// The level at an order, which may be between two harmonics.
    pub(crate) fn level_of_order(&self, order: f64) -> f64 {
        self.level * (order / f64::from(self.blade_count)).powf(self.exponent)
    }
}

/// Level of the shaft lines of a propeller without a gear, as a share of the blade pass: −14 dB.
const UNLIKE_BLADES_LEVEL: f64 = 0.2;

/// The lines of a rotor. All rotors have the same set of lines; phases and levels are drawn for each rotor and line.
#[derive(Clone, Debug, PartialEq)]
pub struct ToneSettings {
    /// Lines of the gear; absent for direct drive.
    pub gear_mesh: Option<GearMeshTones>,
    /// Lines of the blades.
    pub blade_pass: Option<BladePassTones>,
    /// Level of the line at the shaft speed itself: imbalance. With a `scatter`, of all lines below the blade pass.
    pub shaft_level: f64,
    /// Level of the other lines of the shaft, as a share of the level that the blade pass has at their order: no two blades are quite alike.
    pub unlike_blades_level: f64,
    /// Standard deviation of every line's level about the set one, drawn once per rotor and line.
    pub level_spread_db: f64,
    /// Scatter of the lines of blades and shaft by class, in place of `level_spread_db`.
    pub scatter: Option<LineScatter>,
}

/// A line of the shaft that is no blade pass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ShaftLine {
    pub(crate) order: f64,
    pub(crate) level: f64,
    pub(crate) class: LineClass,
}

impl Default for ToneSettings {
    /// The AR.Drone: a 69-tooth wheel and two blades. The shaft line is small, 0.2. The spread of 3 dB makes one rotor the
    /// loudest; real rotors differ by more.
    fn default() -> Self {
        Self {
            gear_mesh: Some(GearMeshTones::with_order(69)),
            blade_pass: Some(BladePassTones::with_blades(2)),
            shaft_level: 0.2,
            unlike_blades_level: 0.0,
            level_spread_db: 3.0,
            scatter: None,
        }
    }
}

impl ToneSettings {
    /// The lines of a vehicle's gear and blades. Without a gear, the lines of unlike blades are 14 dB below the blade pass: real propellers have
    /// 7 dB where the blades are unlike, and 18 dB where they are alike (`docs/measurements.md`).
    pub fn for_vehicle(vehicle: &Vehicle) -> Self {
        Self {
            unlike_blades_level: if vehicle.gear.is_some() { 0.0 } else { UNLIKE_BLADES_LEVEL },
            gear_mesh: vehicle.gear.map(|gear| GearMeshTones::with_order(gear.value.wheel)),
            blade_pass: vehicle.blade_count.map(|blades| BladePassTones::with_blades(blades.value)),
            ..Self::default()
        }
    }

    /// One line of level 1 at that order and nothing else, for checks against a closed form.
    pub fn single(order: u32) -> Self {
        let mesh = GearMeshTones { order, harmonic_levels: vec![1.0], sideband_levels: Vec::new() };
        Self {
            gear_mesh: Some(mesh),
            blade_pass: None,
            shaft_level: 0.0,
            unlike_blades_level: 0.0,
            level_spread_db: 0.0,
            scatter: None,
        }
    }

    /// The class of the line at the shaft speed itself.
    pub(crate) fn class_of_shaft(&self) -> LineClass {
        match &self.blade_pass {
            Some(blades) if blades.blade_count > 1 => LineClass::Below,
            _ => LineClass::Shaft,
        }
    }

    /// The lines of unlike blades: orders 2, 3, …, silent at those of the blade pass. None where their level is 0.
    pub(crate) fn lines_of_unlike_blades(&self) -> impl Iterator<Item = ShaftLine> {
        let blades = self.blade_pass.as_ref().filter(|_| self.unlike_blades_level > 0.0);
        blades.into_iter().flat_map(move |blades| {
            (2..blades.blade_count * blades.harmonic_count).map(move |order| {
                let is_below = order < blades.blade_count;
                let level = match self.scatter {
                    _ if order.is_multiple_of(blades.blade_count) => 0.0,
                    Some(_) if is_below => self.shaft_level,
                    _ => self.unlike_blades_level * blades.level_of_order(f64::from(order)),
                };
                let class = if is_below { LineClass::Below } else { LineClass::Shaft };
                ShaftLine { order: f64::from(order), level, class }
            })
        })
    }

    pub(crate) fn check(&self) -> Result<(), QuantityError> {
        let mut levels = vec![
            ("shaft_level", self.shaft_level),
            ("unlike_blades_level", self.unlike_blades_level),
            ("level_spread_db", self.level_spread_db),
        ];
        for class in self.scatter.iter().flat_map(|scatter| [scatter.blade_pass, scatter.shaft, scatter.below]) {
            levels.push(("scatter spread_db", class.spread_db));
            if !(0.0..=1.0).contains(&class.missing_share) {
                let must_be = "between 0 and 1";
                return Err(QuantityError { name: "scatter missing_share", value: class.missing_share, must_be });
            }
        }
        let mut counts = Vec::new();
        if let Some(mesh) = &self.gear_mesh {
            counts.push(("gear mesh order", mesh.order));
            levels.extend(mesh.harmonic_levels.iter().map(|&level| ("gear mesh harmonic_levels", level)));
            levels.extend(mesh.sideband_levels.iter().map(|&level| ("gear mesh sideband_levels", level)));
        }
        if let Some(blades) = &self.blade_pass {
            counts.push(("blade_count", blades.blade_count));
            levels.push(("blade pass level", blades.level));
            if !blades.exponent.is_finite() {
                return Err(QuantityError { name: "blade pass exponent", value: blades.exponent, must_be: "a number" });
            }
        }
        for (name, value) in levels {
            if !(value.is_finite() && value >= 0.0) {
                return Err(QuantityError { name, value, must_be: "0 or more" });
            }
        }
        for (name, count) in counts {
            if count == 0 {
                return Err(QuantityError { name, value: 0.0, must_be: "at least 1" });
            }
        }
        Ok(())
    }

    /// Order and level of the reference line of the noise: the gear mesh, else the blade pass, else the shaft.
    pub(crate) fn reference(&self) -> Option<(f64, f64)> {
        let mesh = self.gear_mesh.as_ref().and_then(|mesh| Some((mesh.order, *mesh.harmonic_levels.first()?)));
        let blades = self.blade_pass.as_ref().map(|blades| (blades.blade_count, blades.level));
        [mesh, blades, Some((1, self.shaft_level))]
            .into_iter()
            .flatten()
            .find(|(_, level)| *level > 0.0)
            .map(|(order, level)| (f64::from(order), level))
    }
}
