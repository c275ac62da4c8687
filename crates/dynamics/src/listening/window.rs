//! One window of sound: its likelihood, and how it changes with the speeds of the rotors.

use super::heard_lines::{HeardLine, HeardLines};
use super::turns::Turns;
use crate::grey_box::LoopInputs;
use nalgebra::{Cholesky, Complex, Matrix4, U4, Vector4};
use std::f64::consts::{PI, TAU};
use std::ops::Range;

pub(super) type C = Complex<f64>;

/// Place of a window.
#[derive(Clone, Copy, Debug)]
pub(super) struct Window {
    /// Its middle.
    pub(super) time_s: f64,
    /// Its length. Windows overlap by half, so that their weights add up to one.
    pub(super) length_s: f64,
}

impl Window {
    /// From its first to its last moment.
    pub(super) fn span_s(self) -> Range<f64> {
        let half_s = self.length_s / 2.0;
        self.time_s - half_s..self.time_s + half_s
    }

    /// Whether the log knows all that the loops see in it.
    pub(super) fn is_known(self, inputs: &LoopInputs) -> bool {
        let span_s = self.span_s();
        inputs.knows(span_s.start, span_s.end)
    }

    /// Its weight (Hann) at a time from its middle.
    pub(super) fn weight(self, place_s: f64) -> f64 {
        0.5 + 0.5 * (PI * place_s / (self.length_s / 2.0)).cos()
    }
}

/// The logarithm of the likelihood of a window about the predicted speeds, to the second order.
#[derive(Clone, Copy, Debug)]
pub(super) struct Likelihood {
    /// Logarithm of the likelihood ratio to "noise alone".
    pub(super) value: f64,
    /// Gradient by the speeds, s/rad, without that of the determinant.
    pub(super) gradient: Vector4<f64>,
    /// Fisher information about the speeds, s²/rad².
    pub(super) information: Matrix4<f64>,
    /// Gradient of the determinant, `ln det(1 + G/λ)`, by the speeds, s/rad: 0 where no lines overlap.
    pub(super) overlap: Vector4<f64>,
}

impl Default for Likelihood {
    fn default() -> Self {
        Self { value: 0.0, gradient: Vector4::zeros(), information: Matrix4::zeros(), overlap: Vector4::zeros() }
    }
}

/// Sums of the four lines `eᵢ` of one order under the window w, with time s from its middle.
struct Sums {
    /// Σ w eᵢ* eₖ, and times s and s².
    gram: Matrix4<C>,
    gram_s: Matrix4<C>,
    gram_ss: Matrix4<C>,
    /// Σ w eᵢ* z, and times s.
    products: Vector4<C>,
    products_s: Vector4<C>,
}

/// The likelihood of a window with the speeds off the prediction by `offset_rad_s`, from the lines up to an order.
pub(super) fn likelihood(
    heard: &HeardLines,
    order_max: f64,
    turns: &Turns,
    window: Window,
    offset_rad_s: &Vector4<f64>,
) -> Likelihood {
    let mut all = Likelihood::default();
    for line in heard.lines.iter().filter(|line| line.order <= order_max) {
        let of_line = line_likelihood(line, &sums_of::<true>(line, heard.start_s, turns, window, offset_rad_s));
        all.value += of_line.value;
        all.gradient += of_line.gradient;
        all.information += of_line.information;
        all.overlap += of_line.overlap;
    }
    all
}

/// The value of the likelihood alone, in half of the time, with `offset_rad_s` as above.
pub(super) fn likelihood_value(
    heard: &HeardLines,
    order_max: f64,
    turns: &Turns,
    window: Window,
    offset_rad_s: &Vector4<f64>,
) -> f64 {
    let lines = heard.lines.iter().filter(|line| line.order <= order_max);
    let value = |line: &HeardLine| {
        let sums = sums_of::<false>(line, heard.start_s, turns, window, offset_rad_s);
        solved(line, &sums).map_or(0.0, |solved| solved.value)
    };
    lines.map(value).sum()
}

/// The sums; those with time only where `MOMENTS`.
fn sums_of<const MOMENTS: bool>(
    line: &HeardLine,
    start_s: f64,
    turns: &Turns,
    window: Window,
    offset_rad_s: &Vector4<f64>,
) -> Sums {
    let mut sums = Sums {
        gram: Matrix4::zeros(),
        gram_s: Matrix4::zeros(),
        gram_ss: Matrix4::zeros(),
        products: Vector4::zeros(),
        products_s: Vector4::zeros(),
    };
    let (first, last) = line.samples_of(start_s, window);
    for index in first..last {
        let time_s = start_s + index as f64 / line.rate_hz;
        let s = time_s - window.time_s;
        let weight = window.weight(s);
        let own = turns.at(time_s);
        let carrier = line.carrier[index];
        let lines: [C; 4] = std::array::from_fn(|rotor| {
            if !turns.sounding[rotor] {
                return C::new(0.0, 0.0);
            }
            phasor(line.order * (own[rotor] + offset_rad_s[rotor] * s / TAU) - carrier)
        });
        let sample = line.sample(index);
        for i in 0..4 {
            let weighed = lines[i].conj() * weight;
            sums.products[i] += weighed * sample;
            if MOMENTS {
                sums.products_s[i] += weighed * sample * s;
            }
            for (k, other) in lines.iter().enumerate().skip(i) {
                let product = weighed * other;
                sums.gram[(i, k)] += product;
                if MOMENTS {
                    sums.gram_s[(i, k)] += product * s;
                    sums.gram_ss[(i, k)] += product * (s * s);
                }
            }
        }
    }
    for matrix in [&mut sums.gram, &mut sums.gram_s, &mut sums.gram_ss] {
        for i in 1..4 {
            for k in 0..i {
                matrix[(i, k)] = matrix[(k, i)].conj();
            }
        }
    }
    sums
}

/// `exp(2πj turn)`, right to 1e-7: half the angle by its series, and the double angle of it. Four times as fast as the standard library, in which the
/// search would spend most of its time.
pub(super) fn phasor(turn: f64) -> C {
    let half = PI * (turn - turn.round());
    let square = half * half;
    let sin = half
        * (1.0
            - square / 6.0
                * (1.0 - square / 20.0 * (1.0 - square / 42.0 * (1.0 - square / 72.0 * (1.0 - square / 110.0)))));
    let cos = 1.0
        - square / 2.0
            * (1.0
                - square / 12.0
                    * (1.0 - square / 30.0 * (1.0 - square / 56.0 * (1.0 - square / 90.0 * (1.0 - square / 132.0)))));
    C::new(cos * cos - sin * sin, 2.0 * sin * cos)
}

/// The amplitudes of the four lines.
struct Solved {
    cholesky: Cholesky<C, U4>,
    amplitudes: Vector4<C>,
    value: f64,
}

/// With amplitudes of variance v and noise of power n, λ = n/v: `ln L = bᴴ (G + λ)⁻¹ b / n − ln det(1 + G/λ)`.
fn solved(line: &HeardLine, sums: &Sums) -> Option<Solved> {
    let ratio = line.noise / line.amplitude_variance;
    let cholesky = (sums.gram + Matrix4::from_diagonal_element(C::new(ratio, 0.0))).cholesky()?;
    let amplitudes = cholesky.solve(&sums.products);
    let explained: f64 = (0..4).map(|i| (sums.products[i].conj() * amplitudes[i]).re).sum();
    let determinant: f64 = (0..4).map(|i| 2.0 * cholesky.l_dirty()[(i, i)].re.ln() - ratio.ln()).sum();
    Some(Solved { value: explained / line.noise - determinant, cholesky, amplitudes })
}

/// Gradients and Fisher information: a change of the speed of rotor i by x turns its line by order · x · s. The gradient is that of
/// `bᴴ (G + λ)⁻¹ b / n` alone; that of the determinant stands apart, as `overlap`.
fn line_likelihood(line: &HeardLine, sums: &Sums) -> Likelihood {
    let Some(Solved { cholesky, amplitudes, value }) = solved(line, sums) else { return Likelihood::default() };
    let slope = amplitudes.map(|amplitude| C::new(0.0, line.order) * amplitude);
    let left = sums.products_s - sums.gram_s * amplitudes;
    let gradient = Vector4::from_fn(|i, _| 2.0 / line.noise * (slope[i].conj() * left[i]).re);
    let turned = cholesky.solve(&sums.gram_s);
    let shared = sums.gram_ss - sums.gram_s.adjoint() * turned;
    let information = Matrix4::from_fn(|i, k| 2.0 / line.noise * (slope[i].conj() * shared[(i, k)] * slope[k]).re);
    let overlap = Vector4::from_fn(|i, _| -2.0 * line.order * turned[(i, i)].im);
    Likelihood { value, gradient, information: (information + information.transpose()) / 2.0, overlap }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grey_box::SpeedPrediction;

    #[test]
    fn phasors_are_those_of_the_standard_library() {
        let worst = (-1000..1000).map(|n| 0.0137 * f64::from(n)).map(|turn| {
            let (sin, cos) = (TAU * turn).sin_cos();
            (phasor(turn) - C::new(cos, sin)).norm()
        });
        assert!(worst.fold(0.0, f64::max) < 2e-7);
    }

    /// A line of four rotors, two of which turn nearly alike, heard for a second.
    fn line_of_four() -> (HeardLines, SpeedPrediction) {
        let speeds_rad_s = [500.0, 500.4, 503.0, 520.0];
        let (rate_hz, order) = (200.0, 4.0);
        let amplitudes = [1.0, 0.7, 1.3, 0.9].map(|size| C::from_polar(size, 2.0 * size));
        let prediction = SpeedPrediction { start_s: 0.0, step_s: 0.01, speed_rad_s: vec![speeds_rad_s; 101] };
        let carrier: Vec<f64> = (0..200).map(|n| order * 505.0 / TAU * f64::from(n) / rate_hz).collect();
        let sample = |(n, carrier): (usize, &f64)| {
            let time_s = n as f64 / rate_hz;
            let line = |rotor: usize| amplitudes[rotor] * phasor(order * speeds_rad_s[rotor] * time_s / TAU - carrier);
            let noise = 0.2 * phasor(0.37 * (n * n) as f64);
            let sum = (0..4).map(line).sum::<C>() + noise;
            Complex::new(sum.re as f32, sum.im as f32)
        };
        let samples = carrier.iter().enumerate().map(sample).collect();
        let line = HeardLine { order, rate_hz, samples, carrier, noise: 0.04, amplitude_variance: 1.0 };
        (HeardLines { start_s: 0.0, end_s: 1.0, lines: vec![line] }, prediction)
    }

    #[test]
    fn gradient_and_overlap_together_are_the_gradient_of_the_value() {
        let (heard, prediction) = line_of_four();
        let turns = Turns::of(&prediction);
        let window = Window { time_s: 0.5, length_s: 0.4 };
        let offset = Vector4::new(0.5, -0.8, 0.3, 1.0);
        let at = likelihood(&heard, 10.0, &turns, window, &offset);
        for rotor in 0..4 {
            let value = |by: f64| {
                let mut moved = offset;
                moved[rotor] += by;
                likelihood_value(&heard, 10.0, &turns, window, &moved)
            };
            let expected = (value(1e-3) - value(-1e-3)) / 2e-3;
            let found = at.gradient[rotor] - at.overlap[rotor];
            assert!((found - expected).abs() < 1e-3 * (1.0 + expected.abs()), "{rotor}: {found} {expected}");
        }
        // the first two push each other apart without it, and the last one stands alone
        assert!(
            at.overlap[0] * at.overlap[1] < 0.0 && at.overlap[3].abs() < 0.2 * at.overlap[0].abs(),
            "{}",
            at.overlap
        );
    }
}
