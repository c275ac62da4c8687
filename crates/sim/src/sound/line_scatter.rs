//! How the lines of a rotor scatter about their mean levels.

use super::tone_settings::ToneSettings;
use rand::RngExt;
use rand_distr::StandardNormal;
use rand_pcg::Pcg64;
use std::f64::consts::TAU;

/// Scatter of the lines of one class. Drawn once per rotor and line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ClassScatter {
    /// Standard deviation of a line's level about the set one.
    pub spread_db: f64,
    /// Share of the lines that are missing.
    pub missing_share: f64,
}

/// Scatter of the lines by class.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineScatter {
    /// Lines of the blade pass.
    pub blade_pass: ClassScatter,
    /// Shaft lines above the blade pass.
    pub shaft: ClassScatter,
    /// Lines below the blade pass.
    pub below: ClassScatter,
}

/// Class of a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum LineClass {
    BladePass,
    Shaft,
    Below,
    /// Gear and motor.
    Machine,
}

/// What is drawn for one line of one rotor.
pub(crate) struct LineDraw {
    /// Its level over the set one; 0 where it is missing.
    pub(crate) factor: f64,
    pub(crate) phase_rad: f64,
}

impl ToneSettings {
    /// Draws level and phase of a line.
    pub(crate) fn draw_line(&self, class: LineClass, random: &mut Pcg64) -> LineDraw {
        let ClassScatter { spread_db, missing_share } = self.scatter_of(class);
        let spread: f64 = random.sample(StandardNormal);
        let phase_rad = TAU * random.random::<f64>();
        let is_missing = missing_share > 0.0 && random.random::<f64>() < missing_share;
        let factor = if is_missing { 0.0 } else { 10_f64.powf(spread_db * spread / 20.0) };
        LineDraw { factor, phase_rad }
    }

    fn scatter_of(&self, class: LineClass) -> ClassScatter {
        let of_class = self.scatter.and_then(|scatter| match class {
            LineClass::BladePass => Some(scatter.blade_pass),
            LineClass::Shaft => Some(scatter.shaft),
            LineClass::Below => Some(scatter.below),
            LineClass::Machine => None,
        });
        of_class.unwrap_or(ClassScatter { spread_db: self.level_spread_db, missing_share: 0.0 })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::{Part, stream};

    /// The share of `count` draws has the standard error √(p (1 − p)/count).
    #[test]
    fn the_set_share_of_a_class_is_missing_and_no_line_of_another_class() {
        let class = |missing_share| ClassScatter { spread_db: 3.0, missing_share };
        let scatter = LineScatter { blade_pass: class(0.0), shaft: class(0.15), below: class(1.0) };
        let tones = ToneSettings { scatter: Some(scatter), ..ToneSettings::default() };
        let mut random = stream(3, Part::Tones, 0);
        let count = 10_000;
        let mut missing =
            |class| (0..count).filter(|_| tones.draw_line(class, &mut random).factor == 0.0).count() as f64;
        assert_eq!([missing(LineClass::BladePass), missing(LineClass::Machine)], [0.0; 2]);
        assert_eq!(missing(LineClass::Below), f64::from(count));
        let std = (0.15 * 0.85 * f64::from(count)).sqrt();
        assert!((missing(LineClass::Shaft) - 0.15 * f64::from(count)).abs() < 4.0 * std);
    }
}
