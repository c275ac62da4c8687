//! A straight line through weighted points.

/// A point of a line, with the inverse variance of its y.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WeightedPoint {
    pub(crate) x: f64,
    pub(crate) y: f64,
    pub(crate) weight: f64,
}

/// The line y = y_mean + slope (x − x_mean) by weighted least squares. Its variances are those of the weights, which a larger scatter about the line
/// increases.
#[derive(Clone, Copy, Debug)]
pub(crate) struct WeightedLine {
    pub(crate) x_mean: f64,
    pub(crate) y_mean: f64,
    pub(crate) y_mean_variance: f64,
    pub(crate) slope: f64,
    pub(crate) slope_variance: f64,
}

impl WeightedLine {
    /// The line through points. Three or more show a scatter.
    pub(crate) fn through(points: &[WeightedPoint]) -> Self {
        let sum = |value: &dyn Fn(&WeightedPoint) -> f64| points.iter().map(|it| it.weight * value(it)).sum::<f64>();
        let weight = sum(&|_| 1.0);
        let (x_mean, y_mean) = (sum(&|it| it.x) / weight, sum(&|it| it.y) / weight);
        let squares = sum(&|it| (it.x - x_mean).powi(2));
        let slope = sum(&|it| (it.x - x_mean) * (it.y - y_mean)) / squares;
        let chi_square = sum(&|it| (it.y - y_mean - slope * (it.x - x_mean)).powi(2));
        let excess = (chi_square / points.len().saturating_sub(2) as f64).max(1.0);
        Self { x_mean, y_mean, y_mean_variance: excess / weight, slope, slope_variance: excess / squares }
    }

    /// Its height at x = 0.
    pub(crate) fn at_zero(&self) -> f64 {
        self.y_mean - self.slope * self.x_mean
    }
}
