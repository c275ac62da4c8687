//! Directivity of a rotor's sound.

use super::settings::{Bound, checked};
use hovertone_vehicle::QuantityError;

/// Amplitude against the angle θ from the rotor's axis: `D(θ) = in_plane sin²θ + on_axis cos²θ`, the same above and below
/// and all around.
///
/// All kinds of sound have this one form, so that a rotor needs only two signals, one for each term:
/// - Blade pass: Gutin's steady loading noise goes with `J_mB(m B M sin θ)`, which at the low tip Mach numbers of a small
///   drone is `∝ (sin θ)^(mB)`: sin²θ for the first line of two blades, with a null on the axis. Higher harmonics and
///   more blades are narrower than that; real rotors fill the null by unsteady loading.
/// - Broadband: fluctuating lift is a dipole along the axis. Its |cos θ| beside a plane that is not silent is close to this
///   form: with -6 dB in the plane, 0.79 of the amplitude at 45° against 0.75 here.
///   TU Delft's 112-microphone measurement of a hovering quadcopter (Yupa Villanueva et al.) agrees: "dipole-like",
///   lowest near the rotor plane, higher away from it.
/// - Gear and motor: radiated by body and arms. No measurement was found; the same in all directions is assumed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Directivity {
    /// Amplitude towards the plane of the disc, as a share of the set level. 0 for a null.
    pub in_plane: f64,
    /// Amplitude along the axis, as a share of the set level. 0 for a null.
    pub on_axis: f64,
}

impl Directivity {
    /// The same in all directions.
    pub const OMNI: Self = Self { in_plane: 1.0, on_axis: 1.0 };
    /// Loading noise of turning blades: full in the plane; -20 dB on the axis (assumed, for the unsteady part).
    pub const BLADES: Self = Self { in_plane: 1.0, on_axis: 0.1 };
    /// Broadband noise: full on the axis; -6 dB in the plane (assumed; TU Delft's abstract gives no number).
    pub const BROADBAND: Self = Self { in_plane: 0.5, on_axis: 1.0 };

    /// Root of the mean of D² over the sphere, for the diffuse field. `∫sin⁴ = 8/15`, `∫cos⁴ = 3/15`,
    /// `∫sin²cos² = 2/15` of the sphere.
    pub(crate) fn diffuse(&self) -> f64 {
        let (plane, axis) = (self.in_plane, self.on_axis);
        ((8.0 * plane * plane + 4.0 * plane * axis + 3.0 * axis * axis) / 15.0).sqrt()
    }

    pub(crate) fn check(&self) -> Result<(), QuantityError> {
        checked("directivity in_plane", self.in_plane, Bound::ZeroOrMore)?;
        checked("directivity on_axis", self.on_axis, Bound::ZeroOrMore)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn the_diffuse_share_is_the_mean_over_the_sphere() {
        for pattern in [Directivity::OMNI, Directivity::BLADES, Directivity::BROADBAND] {
            let count = 100_000;
            let sum: f64 = (0..count)
                .map(|step| (f64::from(step) + 0.5) / f64::from(count) * PI)
                .map(|angle| {
                    let amplitude = pattern.in_plane * angle.sin().powi(2) + pattern.on_axis * angle.cos().powi(2);
                    amplitude.powi(2) * angle.sin() / 2.0
                })
                .sum();
            assert!((sum * PI / f64::from(count) - pattern.diffuse().powi(2)).abs() < 1e-9);
        }
    }
}
