//! One step as a curve of first order.

use crate::frame_response::FrameResponse;
use crate::search::{Interval, minimum};
use crate::series::{MotorSeries, std_uncertainty_of_long_mean};
use hovertone_signal::statistics::{mean, std};
use nalgebra::{Matrix4, RowVector4};

/// Parameters of the curve.
const PARAMETERS: usize = 4;
/// Places of the coarse search for the start and for the time constant. *Numeric.*
const START_COUNT: usize = 48;
const TIME_CONSTANT_COUNT: usize = 24;
/// Most rows of the coarse search: of more, each second, third, … is taken. *Numeric.*
const COARSE_ROWS_MAX: usize = 400;
/// The fine search ends at this share of a coarse step. *Numeric.*
const FINE_SHARE: f64 = 1e-4;
/// The scatter of the rise counts where its variance is larger by this factor: the 95 % point of χ² with 3 degrees of freedom, over 3. *Numeric.*
const RISE_VARIANCE_RATIO: f64 = 2.6;
/// Variance of an even distribution over its squared width. *Physics.*
pub(crate) const EVEN_VARIANCE: f64 = 1.0 / 12.0;

/// Where the start and the time constant are sought.
#[derive(Clone, Copy, Debug)]
pub(crate) struct FitRange {
    pub(crate) start_s: Interval,
    pub(crate) time_constant_s: Interval,
}

/// ω(t) = from before the start, and from + (to − from)(1 − exp(−(t − start)/τ)) behind it, with standard uncertainties.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct FirstOrderFit {
    pub(crate) from_rev_s: f64,
    pub(crate) to_rev_s: f64,
    pub(crate) start_s: f64,
    pub(crate) time_constant_s: f64,
    pub(crate) to_std_rev_s: f64,
    pub(crate) start_std_s: f64,
    pub(crate) time_constant_std_s: f64,
    pub(crate) residual_rms_rev_s: f64,
}

/// The least-squares curve. Its two speeds are linear, so that they are eliminated (variable projection, Golub and Pereyra 1973), and start and
/// time constant are found by a coarse search and golden sections.
///
/// `None` for fewer rows than the curve has parameters and one, or where the speed does not change.
///
/// `frame`: how a row sees the speed around its time.
pub(crate) fn first_order_from_rows(
    rows: &MotorSeries,
    frame: &FrameResponse,
    range: FitRange,
) -> Option<FirstOrderFit> {
    if rows.time_s.len() <= PARAMETERS || std(rows.speed_rev_s)? == 0.0 {
        return None;
    }
    let logarithm = Interval { low: range.time_constant_s.low.ln(), high: range.time_constant_s.high.ln() };
    let stride = rows.time_s.len().div_ceil(COARSE_ROWS_MAX);
    let each = |values: &[f64]| values.iter().copied().step_by(stride).collect::<Vec<f64>>();
    let (time_s, speed_rev_s) = (each(rows.time_s), each(rows.speed_rev_s));
    let coarse = MotorSeries { time_s: &time_s, speed_rev_s: &speed_rev_s };
    let (mut best, mut lowest) = ((range.start_s.low, logarithm.low), f64::INFINITY);
    for start_s in range.start_s.points(START_COUNT) {
        for logarithm in logarithm.points(TIME_CONSTANT_COUNT) {
            let squares = residual_squares(&coarse, &Curve { frame, start_s, time_constant_s: logarithm.exp() });
            if squares < lowest {
                (best, lowest) = ((start_s, logarithm), squares);
            }
        }
    }
    let curve = |start_s: f64, logarithm: f64| Curve { frame, start_s, time_constant_s: logarithm.exp() };
    let cost = |start_s: f64, logarithm: f64| residual_squares(rows, &curve(start_s, logarithm));
    // the valley of start and time constant is oblique: the fine search covers two coarse steps on both sides
    let near_start = range.start_s.around(best.0, 2.0 * range.start_s.step(START_COUNT));
    let near_logarithm = logarithm.around(best.1, 2.0 * logarithm.step(TIME_CONSTANT_COUNT));
    let best_start = |logarithm: f64| minimum(near_start, FINE_SHARE, |start_s| cost(start_s, logarithm));
    let fine = minimum(near_logarithm, FINE_SHARE, |logarithm| cost(best_start(logarithm), logarithm));
    fitted(rows, &curve(best_start(fine), fine))
}

/// Share of the step that is done.
pub(crate) fn response(time_s: f64, start_s: f64, time_constant_s: f64) -> f64 {
    if time_s > start_s { 1.0 - (-(time_s - start_s) / time_constant_s).exp() } else { 0.0 }
}

/// A step as the rows see it.
struct Curve<'a> {
    frame: &'a FrameResponse,
    start_s: f64,
    time_constant_s: f64,
}

/// The curve at the time of a row.
struct CurvePoint {
    /// Share of the step that is done.
    done: f64,
    /// The rest, where the step has begun.
    left: f64,
    /// The rest times the time since the start, in time constants.
    left_moment: f64,
}

impl Curve<'_> {
    fn done(&self, time_s: f64) -> f64 {
        self.frame.mean(|offset_s| response(time_s + offset_s, self.start_s, self.time_constant_s))
    }

    fn at(&self, time_s: f64) -> CurvePoint {
        let since = |offset_s: f64| (time_s + offset_s - self.start_s) / self.time_constant_s;
        let left = |offset_s: f64| if since(offset_s) > 0.0 { (-since(offset_s)).exp() } else { 0.0 };
        CurvePoint {
            done: self.done(time_s),
            left: self.frame.mean(left),
            left_moment: self.frame.mean(|offset_s| left(offset_s) * since(offset_s)),
        }
    }
}

/// Sums for the straight line of speed over response.
struct LineSums {
    response_mean: f64,
    speed_mean: f64,
    response_squares: f64,
    products: f64,
    speed_squares: f64,
}

fn line_sums(rows: &MotorSeries, curve: &Curve<'_>) -> LineSums {
    let count = rows.time_s.len() as f64;
    let speed_mean = rows.speed_rev_s.iter().sum::<f64>() / count;
    let (mut sum, mut squares, mut products, mut speed_squares) = (0.0, 0.0, 0.0, 0.0);
    for (&time_s, &speed_rev_s) in rows.time_s.iter().zip(rows.speed_rev_s) {
        let (response, speed) = (curve.done(time_s), speed_rev_s - speed_mean);
        sum += response;
        squares += response * response;
        products += response * speed;
        speed_squares += speed * speed;
    }
    let response_mean = sum / count;
    LineSums { response_mean, speed_mean, response_squares: squares - sum * response_mean, products, speed_squares }
}

/// Sum of the squared residuals at the best two speeds.
fn residual_squares(rows: &MotorSeries, curve: &Curve<'_>) -> f64 {
    let sums = line_sums(rows, curve);
    let explained = if sums.response_squares > 0.0 { sums.products.powi(2) / sums.response_squares } else { 0.0 };
    sums.speed_squares - explained
}

fn fitted(rows: &MotorSeries, curve: &Curve<'_>) -> Option<FirstOrderFit> {
    let &Curve { start_s, time_constant_s, .. } = curve;
    let sums = line_sums(rows, curve);
    let size = sums.products / sums.response_squares;
    let from_rev_s = sums.speed_mean - size * sums.response_mean;
    let gradient = |&time_s: &f64| {
        let CurvePoint { done, left, left_moment } = curve.at(time_s);
        let slope = -size / time_constant_s;
        RowVector4::new(1.0 - done, done, slope * left, slope * left_moment)
    };
    let gradients: Vec<RowVector4<f64>> = rows.time_s.iter().map(gradient).collect();
    let information: Matrix4<f64> = gradients.iter().map(|gradient| gradient.transpose() * gradient).sum();
    let inverse = information.try_inverse()?;
    let speeds = rows.time_s.iter().zip(rows.speed_rev_s);
    let residuals: Vec<f64> = speeds.map(|(&time_s, &speed)| speed - from_rev_s - size * curve.done(time_s)).collect();
    let variance = residual_variance(&residuals, &gradients, &inverse).max(rounding_variance(rows.speed_rev_s));
    let deviation = |at: usize| (variance * inverse[(at, at)]).sqrt();
    let squares: f64 = residuals.iter().map(|residual| residual * residual).sum();
    let fit = FirstOrderFit {
        from_rev_s,
        to_rev_s: from_rev_s + size,
        start_s,
        time_constant_s,
        to_std_rev_s: deviation(1),
        start_std_s: deviation(2),
        time_constant_std_s: deviation(3),
        residual_rms_rev_s: (squares / residuals.len() as f64).sqrt(),
    };
    let numbers = [fit.from_rev_s, fit.to_rev_s, fit.time_constant_std_s, fit.start_std_s];
    numbers.iter().all(|number| number.is_finite()).then_some(fit)
}

/// Variance of a row about the curve, times the factor by which correlated rows are worth less. It is that of all rows, or of the rows that tell
/// the time constant where it is clearly larger: there a motor that is not of first order differs from the curve.
fn residual_variance(residuals: &[f64], gradients: &[RowVector4<f64>], inverse: &Matrix4<f64>) -> f64 {
    let count = residuals.len() as f64;
    let of_all = residuals.iter().map(|residual| residual * residual).sum::<f64>() / (count - PARAMETERS as f64);
    let (mut weighted, mut weights) = (0.0, 0.0);
    for (residual, gradient) in residuals.iter().zip(gradients) {
        let weight = gradient[3].powi(2);
        let free_share = 1.0 - (gradient * inverse * gradient.transpose())[(0, 0)];
        weighted += weight * residual * residual;
        weights += weight * free_share.max(0.0);
    }
    let of_rise = if weights > 0.0 { weighted / weights } else { 0.0 };
    let variance = if of_rise > RISE_VARIANCE_RATIO * of_all { of_rise } else { of_all };
    variance * correlation_factor(residuals)
}

/// Factor of the variance of a mean over that of independent rows.
fn correlation_factor(residuals: &[f64]) -> f64 {
    let (Some(spread), Some(of_mean)) = (std(residuals), std_uncertainty_of_long_mean(residuals)) else { return 1.0 };
    if spread > 0.0 { (of_mean / spread).powi(2) * residuals.len() as f64 } else { 1.0 }
}

/// Variance of rounding, from the smallest difference of successive speeds.
fn rounding_variance(speeds_rev_s: &[f64]) -> f64 {
    let differences = speeds_rev_s.windows(2).map(|pair| (pair[1] - pair[0]).abs());
    let scale = mean(speeds_rev_s).unwrap_or(0.0).abs() * f64::EPSILON * 16.0;
    let smallest = differences.filter(|difference| *difference > scale).fold(f64::INFINITY, f64::min);
    if smallest.is_finite() { EVEN_VARIANCE * smallest * smallest } else { 0.0 }
}
