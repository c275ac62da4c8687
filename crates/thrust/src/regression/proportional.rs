//! y = b x with uncertainty in both coordinates.

use super::{Agreement, FitError, FitPoint, check, settled};

/// A line through the origin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ProportionalFit {
    /// Slope.
    pub slope: f64,
    /// Its standard uncertainty, from those of the points alone.
    pub slope_std: f64,
    /// How well the points agree with it.
    pub agreement: Agreement,
}

/// The slope that minimises Σ (y − b x)² / (u_y² + b² u_x²), at its exact minimum.
///
/// With w = 1/(u_y² + b² u_x²) and the adjusted abscissa x' = x + b u_x² w (y − b x), the minimum is where
/// b = Σ w x' y / Σ w x' x, and the standard uncertainty is 1/√(Σ w x'²). For exact abscissas this is the weighted mean of
/// the ratios, for exact ordinates the inverse of that of the inverse ratios.
///
/// # Errors
/// No point, coordinates that are no numbers, all of them at x = 0, points that fit no line.
pub fn proportional_fit(points: &[FitPoint]) -> Result<ProportionalFit, FitError> {
    check(points, 1)?;
    if points.iter().all(|point| point.x == 0.0) {
        return Err(FitError::NoSpread);
    }
    let products = |slope: f64, of: &dyn Fn(&FitPoint, f64) -> f64| -> f64 {
        points.iter().map(|point| point.weight(slope) * adjusted_x(point, slope) * of(point, slope)).sum()
    };
    // a start that no uncertainty can spoil: the plain least squares
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

/// The point of the line that a point most probably comes from: its abscissa.
fn adjusted_x(point: &FitPoint, slope: f64) -> f64 {
    point.x + slope * point.x_std.powi(2) * point.weight(slope) * (point.y - slope * point.x)
}
