//! Wind: a steady part and Dryden gusts.

use crate::seed::{Part, stream};
use hovertone_vehicle::QuantityError;
use nalgebra::Vector3;
use rand::RngExt;
use rand_distr::StandardNormal;
use rand_pcg::Pcg64;

const FEET_PER_M: f64 = 1.0 / 0.3048;

/// Dryden gusts, MIL-F-8785C: u along the mean wind, v across it, w up.
///
/// ```text
/// u: σ √(2 T) / (1 + T s)      v, w: σ √T (1 + √3 T s) / (1 + T s)²      T = L/V, white noise of unit density in
/// ```
///
/// The model is a frozen field of turbulence through which the vehicle flies. In hover the wind carries the field past the
/// vehicle, so V is the speed of the wind, or an assumed speed in still air.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gusts {
    /// σ of u, v, w, m/s.
    pub std_m_s: [f64; 3],
    /// L of u, v, w, m.
    pub length_m: [f64; 3],
    /// V, m/s.
    pub airspeed_m_s: f64,
}

impl Gusts {
    /// Below 300 m, by height in metres and the wind at 6 m: L_w = h, L_u = L_v = h/(0.177 + 0.000823 h)^1.2 with h in
    /// feet, σ_w = 0.1 W, σ_u = σ_v = σ_w/(0.177 + 0.000823 h)^0.4.
    pub fn low_altitude(height_m: f64, wind_at_6_m_m_s: f64) -> Self {
        let height_ft = height_m.max(1.0) * FEET_PER_M;
        let shape = 0.177 + 0.000_823 * height_ft;
        let (across_m, up_m_s) = (height_ft / shape.powf(1.2) / FEET_PER_M, 0.1 * wind_at_6_m_m_s);
        let across_m_s = up_m_s / shape.powf(0.4);
        Self {
            std_m_s: [across_m_s, across_m_s, up_m_s],
            length_m: [across_m, across_m, height_m.max(1.0)],
            airspeed_m_s: wind_at_6_m_m_s.max(1.0),
        }
    }

    pub(crate) fn check(&self) -> Result<(), QuantityError> {
        let refused = |name, value, must_be| Err(QuantityError { name, value, must_be });
        for axis in 0..3 {
            if !(0.0..=20.0).contains(&self.std_m_s[axis]) {
                return refused("gust_std_m_s", self.std_m_s[axis], "between 0 and 20");
            }
            if !(self.length_m[axis] > 0.0 && self.length_m[axis].is_finite()) {
                return refused("gust_length_m", self.length_m[axis], "above 0");
            }
        }
        if !(self.airspeed_m_s > 0.0 && self.airspeed_m_s.is_finite()) {
            return refused("gust_airspeed_m_s", self.airspeed_m_s, "above 0");
        }
        Ok(())
    }
}

/// The wind at each step: steady part plus gusts, world axes.
#[derive(Clone, Debug)]
pub struct Wind {
    steady_m_s: Vector3<f64>,
    gusts: Option<(Vector3<f64>, [GustFilter; 3])>,
}

impl Wind {
    /// A steady wind (the velocity of the air), with gusts or without, stepped by `step_s`. The gusts start in their
    /// stationary state; the same seed gives the same gusts.
    pub fn new(steady_m_s: [f64; 3], gusts: Option<&Gusts>, step_s: f64, seed: u64) -> Self {
        let steady_m_s = Vector3::from(steady_m_s);
        let level = Vector3::new(steady_m_s.x, steady_m_s.y, 0.0);
        let along = level.try_normalize(1e-9).unwrap_or_else(Vector3::x);
        let filter = |gusts: &Gusts, axis: usize| {
            let time_s = gusts.length_m[axis] / gusts.airspeed_m_s;
            let random = stream(seed, Part::Gust, axis as u64);
            GustFilter::new(gusts.std_m_s[axis], time_s, step_s, axis > 0, random)
        };
        Self { steady_m_s, gusts: gusts.map(|gusts| (along, std::array::from_fn(|axis| filter(gusts, axis)))) }
    }

    /// The velocity of the air now, m/s.
    pub fn velocity_m_s(&self) -> Vector3<f64> {
        let Some((along, [u, v, w])) = &self.gusts else { return self.steady_m_s };
        let across = Vector3::new(-along.y, along.x, 0.0);
        self.steady_m_s + along * u.value() + across * v.value() + Vector3::z() * w.value()
    }

    /// Goes on by one step.
    pub fn step(&mut self) {
        if let Some((_, filters)) = &mut self.gusts {
            filters.iter_mut().for_each(GustFilter::step);
        }
    }
}

/// One component of the gusts: two lags in a row, x₁' = (n - x₁)/T, x₂' = (x₁ - x₂)/T, stepped exactly.
///
/// u is x₁; v and w are √3 x₁ + (1 - √3) x₂. With P = σ_x² [[1, ½], [½, ½]] the stationary covariance of the two and Φ
/// = e^(-h/T) [[1, 0], [h/T, 1]] their step, the kick has covariance P - Φ P Φᵀ, drawn through its Cholesky factor; and
/// σ_x² is σ² for u, σ²/2 for the others.
#[derive(Clone, Debug)]
struct GustFilter {
    lags: [f64; 2],
    out: [f64; 2],
    keep: f64,
    ratio: f64,
    kick: [f64; 3],
    random: Pcg64,
}

impl GustFilter {
    fn new(std: f64, time_s: f64, step_s: f64, second_order: bool, mut random: Pcg64) -> Self {
        let root3 = 3.0_f64.sqrt();
        let (lag_std, out) =
            if second_order { (std * 0.5_f64.sqrt(), [root3, 1.0 - root3]) } else { (std, [1.0, 0.0]) };
        let (ratio, keep) = (step_s / time_s, (-step_s / time_s).exp());
        // 1 - keep² without the loss of digits of a short step; the others are small differences of it. Terms of P - Φ
        // P Φᵀ:
        let lost = -(-2.0 * ratio).exp_m1();
        let keep2 = keep * keep;
        let q11 = lost;
        let q12 = 0.5 * lost - keep2 * ratio;
        let q22 = 0.5 * lost - keep2 * ratio * (1.0 + ratio);
        let l11 = q11.sqrt();
        let l21 = if l11 > 0.0 { q12 / l11 } else { 0.0 };
        let l22 = (q22 - l21 * l21).max(0.0).sqrt();
        let (first, second): (f64, f64) = (random.sample(StandardNormal), random.sample(StandardNormal));
        let lags = [lag_std * first, lag_std * 0.5 * (first + second)];
        Self { lags, out, keep, ratio, kick: [l11, l21, l22].map(|part| lag_std * part), random }
    }

    fn value(&self) -> f64 {
        self.out[0] * self.lags[0] + self.out[1] * self.lags[1]
    }

    fn step(&mut self) {
        let (first, second): (f64, f64) = (self.random.sample(StandardNormal), self.random.sample(StandardNormal));
        let [x1, x2] = self.lags;
        let [l11, l21, l22] = self.kick;
        self.lags = [self.keep * x1 + l11 * first, self.keep * (x2 + self.ratio * x1) + l21 * first + l22 * second];
    }
}

#[cfg(test)]
mod tests;
