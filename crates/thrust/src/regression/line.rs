//! y = a + b x with uncertainty in both coordinates.

use super::{Agreement, FitError, FitPoint, check, settled};

/// A straight line.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LineFit {
    /// Intercept.
    pub intercept: f64,
    /// Its standard uncertainty, from those of the points alone.
    pub intercept_std: f64,
    /// Slope.
    pub slope: f64,
    /// Its standard uncertainty, from those of the points alone.
    pub slope_std: f64,
    /// Where along x slope and intercept do not trade: the weighted mean of the adjusted abscissas.
    pub x_centre: f64,
    /// How well the points agree with it.
    pub agreement: Agreement,
}

/// York's line (2004, eqs 13): the minimum of Σ (y − a − b x)² / (u_y² + b² u_x²).
///
/// # Errors
/// Fewer than two points, coordinates that are no numbers, all of them at the same x, points that fit no line.
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

/// Weighted means, about which everything is computed: what is far from the origin keeps its digits.
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

    /// York's β: how far along x from the mean the point of the line is that a point most probably comes from.
    fn beta(&self, point: &FitPoint) -> f64 {
        point.weight(self.slope)
            * ((point.x - self.x) * point.y_std.powi(2) + self.slope * (point.y - self.y) * point.x_std.powi(2))
    }
}
