//! The points of a fit: a known force against the squared shaft speed that balances it.

use crate::regression::{FitError, FitPoint, ProportionalFit, proportional_fit};
use hovertone_vehicle::RotorSpeed;
use serde::Serialize;

/// A known force, and the squared speed at which the rotors balance it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ForcePoint {
    /// Name of the load, or of the row of a table.
    pub name: String,
    /// Mean squared speed of a rotor.
    pub speed_square_rad2_s2: f64,
    /// Standard uncertainty of the squared speed.
    pub speed_square_std_rad2_s2: f64,
    /// Force.
    pub force_n: f64,
    /// Standard uncertainty of the force.
    pub force_std_n: f64,
}

impl ForcePoint {
    /// A shaft speed ω and a force, each with its standard uncertainty, or 0 where none is stated. u(ω²) = 2 ω u(ω).
    pub fn from_speed(name: String, speed: RotorSpeed, speed_std_rad_s: f64, force_n: f64, force_std_n: f64) -> Self {
        let rad_s = speed.rad_s();
        Self {
            name,
            speed_square_rad2_s2: rad_s.powi(2),
            speed_square_std_rad2_s2: 2.0 * rad_s * speed_std_rad_s,
            force_n,
            force_std_n,
        }
    }

    /// A shaft speed and a mass that hovers at it: the force is the weight m g.
    pub fn from_mass(
        name: String,
        speed: RotorSpeed,
        speed_std_rad_s: f64,
        mass_kg: f64,
        mass_std_kg: f64,
        gravity_m_s2: f64,
    ) -> Self {
        Self::from_speed(name, speed, speed_std_rad_s, mass_kg * gravity_m_s2, mass_std_kg * gravity_m_s2)
    }

    /// The constant of this point alone: C = F / ω².
    pub fn thrust_constant_n_s2(&self) -> f64 {
        self.force_n / self.speed_square_rad2_s2
    }

    /// Whether force and squared speed are positive numbers and no uncertainty is negative.
    pub(super) fn is_usable(&self) -> bool {
        let positive =
            [self.force_n, self.speed_square_rad2_s2].iter().all(|number| number.is_finite() && *number > 0.0);
        positive && self.force_std_n >= 0.0 && self.speed_square_std_rad2_s2 >= 0.0
    }

    pub(super) fn has_std(&self) -> bool {
        self.force_std_n > 0.0 || self.speed_square_std_rad2_s2 > 0.0
    }

    fn fit_point(&self) -> FitPoint {
        FitPoint {
            x: self.speed_square_rad2_s2,
            x_std: self.speed_square_std_rad2_s2,
            y: self.force_n,
            y_std: self.force_std_n,
        }
    }

    /// The point in natural logarithms, in which a power law is a straight line. Uncertainties become relative ones.
    pub(super) fn logarithms(&self) -> FitPoint {
        FitPoint {
            x: self.speed_square_rad2_s2.ln(),
            x_std: self.speed_square_std_rad2_s2 / self.speed_square_rad2_s2,
            y: self.force_n.ln(),
            y_std: self.force_std_n / self.force_n,
        }
    }
}

/// Where the uncertainties of the points come from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum PointNoise {
    /// They are stated, and taken as exactly known.
    Stated,
    /// They were estimated from scatter.
    Measured {
        /// Effective degrees of freedom of that estimate.
        degrees_of_freedom: f64,
    },
    /// Every point was observed once. Their uncertainties come from their own scatter about the law, or are larger, so that nothing is
    /// left to test the law.
    Unrepeated {
        /// Degrees of freedom of that estimate.
        degrees_of_freedom: f64,
    },
    /// No uncertainty is stated: all forces have the same one, and the residuals give its size.
    FromResiduals,
    /// No uncertainty is stated: that of each force is the same share of it, and the residuals give its size. A fit finds which of the two is more
    /// probable.
    FromShares,
}

impl PointNoise {
    /// Whether the residuals of a law are all that shows how uncertain the points are.
    pub(super) fn is_by_residuals(self) -> bool {
        matches!(self, Self::FromResiduals | Self::FromShares | Self::Unrepeated { .. })
    }
}

/// The points as the regression takes them. Without stated uncertainties every force has a standard uncertainty of 1 N, or of itself.
pub(super) fn fit_points(points: &[&ForcePoint], noise: PointNoise) -> Vec<FitPoint> {
    let of = |point: &&ForcePoint| match noise {
        PointNoise::FromResiduals => FitPoint::with_y_std(point.speed_square_rad2_s2, point.force_n, 1.0),
        PointNoise::FromShares => FitPoint::with_y_std(point.speed_square_rad2_s2, point.force_n, point.force_n),
        PointNoise::Stated | PointNoise::Measured { .. } | PointNoise::Unrepeated { .. } => point.fit_point(),
    };
    points.iter().map(of).collect()
}

/// The square law F = C ω² through the points.
pub(super) fn law_through_origin(points: &[&ForcePoint], noise: PointNoise) -> Result<ProportionalFit, FitError> {
    proportional_fit(&fit_points(points, noise))
}

/// How points without uncertainties scatter: forces by the same amount, or by the same share. The more probable of the two, where the residuals about
/// the square law are normal: −n/2 ln χ² − Σ ln u.
pub(super) fn scatter_of(points: &[&ForcePoint]) -> PointNoise {
    let nats = |noise: PointNoise| {
        let chi_square = law_through_origin(points, noise).ok()?.agreement.chi_square;
        let widths: f64 = fit_points(points, noise).iter().map(|point| point.y_std.ln()).sum();
        (chi_square > 0.0).then(|| -0.5 * points.len() as f64 * chi_square.ln() - widths)
    };
    match (nats(PointNoise::FromResiduals), nats(PointNoise::FromShares)) {
        (Some(equal), Some(shares)) if shares > equal => PointNoise::FromShares,
        _ => PointNoise::FromResiduals,
    }
}
