//! Take-off and landing: the speed of a rotor at each instant, as a share of its speed in hover.

use crate::prescribed::truth::Span;
use hovertone_vehicle::QuantityError;
use std::f64::consts::PI;

/// Rotors at rest, spun up, in hover, spun down, at rest again. The hover takes the rest of the sound's length.
/// The default is hover alone.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SpeedProfile {
    /// Rotors at rest before.
    pub silence_before_s: f64,
    /// From rest to hover speed, along half a period of a cosine.
    pub spin_up_s: f64,
    /// From hover speed to rest, along half a period of a cosine.
    pub spin_down_s: f64,
    /// Rotors at rest after.
    pub silence_after_s: f64,
}

/// When the parts of a profile are.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProfileParts {
    /// Rotors at rest before.
    pub silence_before: Span,
    /// From rest to hover speed.
    pub spin_up: Span,
    /// Hover: wander about the mean speed, nothing else.
    pub hover: Span,
    /// From hover speed to rest.
    pub spin_down: Span,
    /// Rotors at rest after.
    pub silence_after: Span,
}

impl SpeedProfile {
    /// The parts in a sound of that length. Fails on a negative part, and when no time is left for hover.
    pub fn parts(&self, duration_s: f64) -> Result<ProfileParts, QuantityError> {
        for (name, value) in [
            ("silence_before_s", self.silence_before_s),
            ("spin_up_s", self.spin_up_s),
            ("spin_down_s", self.spin_down_s),
            ("silence_after_s", self.silence_after_s),
        ] {
            if !(value.is_finite() && value >= 0.0) {
                return Err(QuantityError { name, value, must_be: "0 or more" });
            }
        }
        let up_s = self.silence_before_s;
        let hover_s = up_s + self.spin_up_s;
        let rest_s = duration_s - self.silence_after_s;
        let down_s = rest_s - self.spin_down_s;
        if down_s <= hover_s {
            let must_be = "longer than its take-off and landing together";
            return Err(QuantityError { name: "duration_s", value: duration_s, must_be });
        }
        Ok(ProfileParts {
            silence_before: Span { from_s: 0.0, to_s: up_s },
            spin_up: Span { from_s: up_s, to_s: hover_s },
            hover: Span { from_s: hover_s, to_s: down_s },
            spin_down: Span { from_s: down_s, to_s: rest_s },
            silence_after: Span { from_s: rest_s, to_s: duration_s },
        })
    }
}

impl ProfileParts {
    /// Share of the hover speed at an instant: 0 at rest, 1 in hover.
    pub fn speed_share(&self, time_s: f64) -> f64 {
        if time_s < self.hover.from_s {
            rising_cosine((time_s - self.spin_up.from_s) / (self.spin_up.to_s - self.spin_up.from_s))
        } else if time_s <= self.hover.to_s {
            1.0
        } else {
            rising_cosine((self.spin_down.to_s - time_s) / (self.spin_down.to_s - self.spin_down.from_s))
        }
    }
}

/// From 0 to 1 along half a period of a cosine. `share` outside 0..1 is clamped; the 0/0 of a ramp of no length gives 0.
fn rising_cosine(share: f64) -> f64 {
    if share > 0.0 { 0.5 - 0.5 * (PI * share.min(1.0)).cos() } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const PROFILE: SpeedProfile =
        SpeedProfile { silence_before_s: 1.0, spin_up_s: 2.0, spin_down_s: 1.5, silence_after_s: 0.5 };

    #[test]
    fn the_parts_follow_one_another_and_fill_the_sound() {
        let parts = PROFILE.parts(12.0).unwrap();
        assert_eq!(parts.hover, Span { from_s: 3.0, to_s: 10.0 });
        assert_eq!(parts.silence_after, Span { from_s: 11.5, to_s: 12.0 });
        assert_eq!([0.0, 0.99, 1.0].map(|time_s| parts.speed_share(time_s)), [0.0; 3]);
        assert_eq!([3.0, 7.0, 10.0].map(|time_s| parts.speed_share(time_s)), [1.0; 3]);
        assert_eq!([11.5, 12.0].map(|time_s| parts.speed_share(time_s)), [0.0; 2]);
        assert!((parts.speed_share(2.0) - 0.5).abs() < 1e-12);
        let rising: Vec<_> = (0..=20).map(|step| parts.speed_share(1.0 + 0.1 * f64::from(step))).collect();
        assert!(rising.windows(2).all(|pair| pair[0] < pair[1]), "{rising:?}");
    }

    #[test]
    fn a_default_profile_is_hover_from_first_to_last_sample() {
        let parts = SpeedProfile::default().parts(10.0).unwrap();
        assert_eq!(parts.hover, Span { from_s: 0.0, to_s: 10.0 });
        assert_eq!([0.0, 5.0, 10.0].map(|time_s| parts.speed_share(time_s)), [1.0; 3]);
    }

    #[test]
    fn a_sound_without_time_for_hover_is_refused() {
        assert_eq!(PROFILE.parts(5.0).unwrap_err().name, "duration_s");
        let negative = SpeedProfile { spin_up_s: -1.0, ..PROFILE };
        assert_eq!(negative.parts(12.0).unwrap_err().name, "spin_up_s");
    }
}
