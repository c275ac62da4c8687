//! y = b x with uncertainty in both coordinates.

use super::{Agreement, FitError, FitPoint, check, settled};

/// A line through the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProportionalFit {
    /// Slope.
    pub slope: f64,
    /// Standard uncertainty of the slope, from the uncertainties of the points without their scatter.
    pub slope_std: f64,
    /// How well the points agree with the line.
    pub agreement: Agreement,
}

/// The slope that minimises Σ (y − b x)² / (u_y² + b² u_x²).
///
/// With w = 1/(u_y² + b² u_x²) and the adjusted abscissa x' = x + b u_x² w (y − b x), the minimum satisfies
/// b = Σ w x' y / Σ w x' x, and the standard uncertainty is 1/√(Σ w x'²) (York et al. 2004). With exact abscissas the slope is the
/// weighted mean of y/x, with exact ordinates the inverse of the weighted mean of x/y.
///
/// # Errors
/// No point, a coordinate that is not a number, all points at x = 0, an iteration that does not converge.
pub fn proportional_fit(points: &[FitPoint]) -> Result<ProportionalFit, FitError> {
    check(points, 1)?;
    if points.iter().all(|point| point.x == 0.0) {
        return Err(FitError::NoSpread);
    }
    let products = |slope: f64, of: &dyn Fn(&FitPoint, f64) -> f64| -> f64 {
        points.iter().map(|point| point.weight(slope) * adjusted_x(point, slope) * of(point, slope)).sum()
    };
    // start with plain least squares, which exists for any uncertainties
    let squares: f64 = points.iter().map(|point| point.x * point.x).sum();
    let start = points.iter().map(|point| point.x * point.y).sum::<f64>() / squares;
    let slope = settled(start, |slope| products(slope, &|point, _| point.y) / products(slope, &|point, _| point.x))?;
    let chi_square = points.iter().map(|point| point.weight(slope) * (point.y - slope * point.x).powi(2)).sum();
    Ok(ProportionalFit {
        slope,
        slope_std: products(slope, &adjusted_x).sqrt().recip(),
        agreement: Agreement { chi_square, degrees_of_freedom: points.len() - 1 },
    })
}

/// Abscissa of the most probable true position of a point on the line.
fn adjusted_x(point: &FitPoint, slope: f64) -> f64 {
    point.x + slope * point.x_std.powi(2) * point.weight(slope) * (point.y - slope * point.x)
}
