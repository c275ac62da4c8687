//! Attitudes as unit quaternions, scalar first, body to world.

use nalgebra::{Matrix3, Vector3};

/// Roll, pitch and yaw: the rotation is R_z(yaw) R_y(pitch) R_x(roll), as in the authors' code. With z up and y to
/// the left, positive roll leans right, positive pitch puts the nose down, positive yaw turns left.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Euler {
    /// φ, rad.
    pub roll_rad: f64,
    /// θ, rad.
    pub pitch_rad: f64,
    /// ψ, rad.
    pub yaw_rad: f64,
}

impl Euler {
    /// From a quaternion, scalar first.
    pub fn from_attitude(attitude: &[f64; 4]) -> Self {
        let [w, x, y, z] = *attitude;
        Self {
            roll_rad: (2.0 * (w * x + y * z)).atan2(1.0 - 2.0 * (x * x + y * y)),
            pitch_rad: (2.0 * (w * y - z * x)).clamp(-1.0, 1.0).asin(),
            yaw_rad: (2.0 * (w * z + x * y)).atan2(1.0 - 2.0 * (y * y + z * z)),
        }
    }

    /// As a unit quaternion, scalar first.
    pub fn attitude(&self) -> [f64; 4] {
        let (sr, cr) = (0.5 * self.roll_rad).sin_cos();
        let (sp, cp) = (0.5 * self.pitch_rad).sin_cos();
        let (sy, cy) = (0.5 * self.yaw_rad).sin_cos();
        [
            cr * cp * cy + sr * sp * sy,
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
        ]
    }

    /// φ', θ', ψ' for body rates p, q, r; not defined with the nose straight up or down.
    pub fn rates(&self, body_rad_s: &Vector3<f64>) -> [f64; 3] {
        let (sin, cos) = self.roll_rad.sin_cos();
        let across = body_rad_s.y * sin + body_rad_s.z * cos;
        let yaw = across / self.pitch_rad.cos();
        [body_rad_s.x + yaw * self.pitch_rad.sin(), body_rad_s.y * cos - body_rad_s.z * sin, yaw]
    }
}

/// Rotation matrix, body to world. The quaternion may have any length except zero.
pub(crate) fn rotation(attitude: &[f64; 4]) -> Matrix3<f64> {
    let [w, x, y, z] = *attitude;
    let twice = 2.0 / (w * w + x * x + y * y + z * z);
    let (xx, yy, zz) = (twice * x * x, twice * y * y, twice * z * z);
    let (xy, xz, yz) = (twice * x * y, twice * x * z, twice * y * z);
    let (wx, wy, wz) = (twice * w * x, twice * w * y, twice * w * z);
    Matrix3::new(1.0 - yy - zz, xy - wz, xz + wy, xy + wz, 1.0 - xx - zz, yz - wx, xz - wy, yz + wx, 1.0 - xx - yy)
}

/// q' = q ⊗ (0, Ω)/2 for body rates Ω.
pub(crate) fn attitude_rate(attitude: &[f64; 4], rates_rad_s: &Vector3<f64>) -> [f64; 4] {
    let [w, x, y, z] = *attitude;
    let (p, q, r) = (0.5 * rates_rad_s.x, 0.5 * rates_rad_s.y, 0.5 * rates_rad_s.z);
    [-x * p - y * q - z * r, w * p + y * r - z * q, w * q + z * p - x * r, w * r + x * q - y * p]
}

/// The same attitude with length 1.
pub(crate) fn normalised(attitude: [f64; 4]) -> [f64; 4] {
    let length = attitude.iter().map(|part| part * part).sum::<f64>().sqrt();
    attitude.map(|part| part / length)
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Quaternion, UnitQuaternion};

    #[test]
    fn rotation_and_angles_agree_with_nalgebra() {
        for (roll_rad, pitch_rad, yaw_rad) in [(0.3, -0.2, 1.5), (-2.0, 1.2, -3.0), (0.0, 0.0, 0.0), (1.0, 0.5, 2.9)] {
            let euler = Euler { roll_rad, pitch_rad, yaw_rad };
            let attitude = euler.attitude();
            let reference = UnitQuaternion::from_euler_angles(roll_rad, pitch_rad, yaw_rad);
            assert!((rotation(&attitude) - reference.to_rotation_matrix().into_inner()).norm() < 1e-14);
            assert!((rotation(&attitude.map(|part| 1.7 * part)) - rotation(&attitude)).norm() < 1e-14);
            let back = Euler::from_attitude(&attitude);
            assert!((back.roll_rad - roll_rad).abs() < 1e-12 && (back.pitch_rad - pitch_rad).abs() < 1e-12);
            assert!((back.yaw_rad - yaw_rad).abs() < 1e-12);
        }
    }

    #[test]
    fn rates_of_quaternion_and_angles_are_derivatives() {
        let (euler, rates) = (Euler { roll_rad: 0.4, pitch_rad: -0.5, yaw_rad: 1.0 }, Vector3::new(0.7, -1.1, 0.4));
        let [w, x, y, z] = euler.attitude();
        let turned = |by_s: f64| -> [f64; 4] {
            let q = UnitQuaternion::from_quaternion(Quaternion::new(w, x, y, z)) * UnitQuaternion::new(rates * by_s);
            [q.w, q.i, q.j, q.k]
        };
        let (before, after) = (turned(-1e-5), turned(1e-5));
        let rate = attitude_rate(&[w, x, y, z], &rates);
        for k in 0..4 {
            assert!(((after[k] - before[k]) / 2e-5 - rate[k]).abs() < 1e-9);
        }
        let (before, after) = (Euler::from_attitude(&before), Euler::from_attitude(&after));
        let [roll, pitch, yaw] = euler.rates(&rates);
        assert!(((after.roll_rad - before.roll_rad) / 2e-5 - roll).abs() < 1e-8);
        assert!(((after.pitch_rad - before.pitch_rad) / 2e-5 - pitch).abs() < 1e-8);
        assert!(((after.yaw_rad - before.yaw_rad) / 2e-5 - yaw).abs() < 1e-8);
    }

    /// Positive roll leans to the right (-y), positive pitch forward (+x), positive yaw turns the nose left (+y).
    #[test]
    fn the_signs_of_the_angles() {
        let up = Vector3::z();
        let of = |roll_rad, pitch_rad, yaw_rad| rotation(&Euler { roll_rad, pitch_rad, yaw_rad }.attitude());
        assert!((of(0.1, 0.0, 0.0) * up).y < -0.09);
        assert!((of(0.0, 0.1, 0.0) * up).x > 0.09);
        assert!((of(0.0, 0.0, 0.1) * Vector3::x()).y > 0.09);
    }
}
