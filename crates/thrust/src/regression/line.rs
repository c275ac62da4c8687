//! y = a + b x with uncertainty in both coordinates.

use super::{Agreement, FitError, FitPoint, check, settled};

/// A straight line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineFit {
    /// Intercept.
    pub intercept: f64,
    /// Standard uncertainty of the intercept, from the uncertainties of the points without their scatter.
    pub intercept_std: f64,
    /// Slope.
    pub slope: f64,
    /// Standard uncertainty of the slope, from the uncertainties of the points without their scatter.
    pub slope_std: f64,
    /// Weighted mean of the adjusted abscissas. The slope and the value of the line at this x are uncorrelated.
    pub x_centre: f64,
    /// How well the points agree with the line.
    pub agreement: Agreement,
}

/// The line that minimises Σ (y − a − b x)² / (u_y² + b² u_x²) (York et al. 2004, eqs 13).
///
/// # Errors
/// Fewer than two points, a coordinate that is not a number, all points at the same x, an iteration that does not converge.
pub fn line_fit(points: &[FitPoint]) -> Result<LineFit, FitError> {
    check(points, 2)?;
    if points.iter().all(|point| point.x == points[0].x) {
        return Err(FitError::NoSpread);
    }
    let count = points.len() as f64;
    let (x_mean, y_mean) = (sum(points, |point| point.x) / count, sum(points, |point| point.y) / count);
    let start =
        sum(points, |point| (point.x - x_mean) * (point.y - y_mean)) / sum(points, |point| (point.x - x_mean).powi(2));
    let slope = settled(start, |slope| {
        let centred = Centred::of(points, slope);
        sum(points, |point| point.weight(slope) * centred.beta(point) * (point.y - centred.y))
            / sum(points, |point| point.weight(slope) * centred.beta(point) * (point.x - centred.x))
    })?;
    let centred = Centred::of(points, slope);
    let weights = sum(points, |point| point.weight(slope));
    let x_centre = sum(points, |point| point.weight(slope) * (centred.x + centred.beta(point))) / weights;
    let slope_variance =
        1.0 / sum(points, |point| point.weight(slope) * (centred.x + centred.beta(point) - x_centre).powi(2));
    let intercept = centred.y - slope * centred.x;
    let residual = |point: &FitPoint| (point.y - centred.y) - slope * (point.x - centred.x);
    Ok(LineFit {
        intercept,
        intercept_std: (1.0 / weights + x_centre.powi(2) * slope_variance).sqrt(),
        slope,
        slope_std: slope_variance.sqrt(),
        x_centre,
        agreement: Agreement {
            chi_square: sum(points, |point| point.weight(slope) * residual(point).powi(2)),
            degrees_of_freedom: points.len() - 2,
        },
    })
}

fn sum(points: &[FitPoint], of: impl Fn(&FitPoint) -> f64) -> f64 {
    points.iter().map(of).sum()
}

/// Weighted means of the coordinates. Sums about them lose no digits where the points are far from the origin.
struct Centred {
    slope: f64,
    x: f64,
    y: f64,
}

impl Centred {
    fn of(points: &[FitPoint], slope: f64) -> Self {
        let weights = sum(points, |point| point.weight(slope));
        Self {
            slope,
            x: sum(points, |point| point.weight(slope) * point.x) / weights,
            y: sum(points, |point| point.weight(slope) * point.y) / weights,
        }
    }

    /// β of York et al. (2004): distance along x from the mean to the most probable true position of a point on the line.
    fn beta(&self, point: &FitPoint) -> f64 {
        point.weight(self.slope)
            * ((point.x - self.x) * point.y_std.powi(2) + self.slope * (point.y - self.y) * point.x_std.powi(2))
    }
}
