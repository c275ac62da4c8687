//! Unit phasors exp(jφ) by multiplication instead of sine and cosine: the phases of the lines of one shaft are multiples of one
//! angle.

use realfft::num_complex::Complex;
use std::f64::consts::TAU;

/// Largest angle, rad, at which five terms of the Taylor series of sine and cosine are exact to rounding (0.1¹⁰ / 10! = 3e-17).
/// *Numeric.*
const SMALL_TURN: f64 = 0.1;

/// Factors from each term of the Taylor series of the cosine to the next; a division takes several times as long. *Numeric.*
const COSINE: [f64; 4] = [1.0 / 2.0, 1.0 / (3.0 * 4.0), 1.0 / (5.0 * 6.0), 1.0 / (7.0 * 8.0)];
/// The same of the sine. *Numeric.*
const SINE: [f64; 4] = [1.0 / 6.0, 1.0 / (4.0 * 5.0), 1.0 / (6.0 * 7.0), 1.0 / (8.0 * 9.0)];

/// Largest angle, rad, of which a phasor is made by squaring that of a small part of it: 5 squares, which are faster than the sine and
/// cosine of the system and lose 5 bits at most. *Numeric.*
const SQUARED_TURN: f64 = 32.0 * SMALL_TURN;

/// `exp(j angle)`, fast for an angle in rad of less than half a turn.
#[inline]
pub(crate) fn small_turn(angle: f64) -> Complex<f64> {
    if angle.abs() <= SMALL_TURN { by_series(angle) } else { wide_turn(angle) }
}

fn wide_turn(angle: f64) -> Complex<f64> {
    if angle.abs() > SQUARED_TURN {
        return Complex::from_polar(1.0, angle);
    }
    let (mut part, mut squares) = (0.5 * angle, 1);
    while part.abs() > SMALL_TURN {
        part *= 0.5;
        squares += 1;
    }
    let mut turn = by_series(part);
    for _ in 0..squares {
        turn = Complex::new(turn.re * turn.re - turn.im * turn.im, 2.0 * turn.re * turn.im);
    }
    turn
}

#[inline]
fn by_series(angle: f64) -> Complex<f64> {
    let x2 = angle * angle;
    // in Horner form
    let cosine = 1.0 - x2 * COSINE[0] * (1.0 - x2 * COSINE[1] * (1.0 - x2 * COSINE[2] * (1.0 - x2 * COSINE[3])));
    let sine = angle * (1.0 - x2 * SINE[0] * (1.0 - x2 * SINE[1] * (1.0 - x2 * SINE[2] * (1.0 - x2 * SINE[3]))));
    Complex::new(cosine, sine)
}

/// `exp(−j 2π o x_i)` for one order o after the other, with angles x_i of the shaft in turns that stay the same.
///
/// The phasors of the next order are those of the last one times `exp(−j 2π Δo x_i)`. This factor is computed again only where the
/// step Δo between orders changes: once for each family of lines.
pub(crate) struct OrderPhasors<'a> {
    turns: &'a [f64],
    order: f64,
    step: f64,
    /// Phasors of the step between orders.
    of_step: Vec<Complex<f64>>,
    /// Phasors of `order`.
    now: Vec<Complex<f64>>,
}

impl<'a> OrderPhasors<'a> {
    /// For angles of the shaft in turns.
    pub(crate) fn new(turns: &'a [f64]) -> Self {
        let one = vec![Complex::new(1.0, 0.0); turns.len()];
        Self { turns, order: 0.0, step: 0.0, of_step: one.clone(), now: one }
    }

    /// The phasors of an order. Fast where each order is one step above the last, as the lines of a family are.
    pub(crate) fn of(&mut self, order: f64) -> &[Complex<f64>] {
        let is_start = order <= self.order;
        let step = if is_start { order } else { order - self.order };
        if step != self.step {
            self.step = step;
            for (phasor, turns) in self.of_step.iter_mut().zip(self.turns) {
                *phasor = small_turn(-TAU * step * turns);
            }
        }
        self.order = order;
        if is_start {
            self.now.copy_from_slice(&self.of_step);
        } else {
            self.now.iter_mut().zip(&self.of_step).for_each(|(now, step)| *now *= step);
        }
        &self.now
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn phasors_by_multiplication_are_those_of_the_order() {
        let turns = [0.0, 1e-4, -0.3, 1.7];
        let mut phasors = OrderPhasors::new(&turns);
        let blades = (1..=20).map(|number| 2.0 * f64::from(number));
        for order in [69.0, 138.0, 207.0].into_iter().chain(blades).chain([5.0, 5.0, 7.5, 40.0, 3.0]) {
            for (phasor, turns) in phasors.of(order).iter().zip(turns) {
                let error = (phasor - Complex::from_polar(1.0, -TAU * order * turns)).norm();
                assert!(error < 1e-12, "order {order} at {turns}: {error}");
            }
        }
    }

    #[test]
    fn small_turns_are_turns() {
        for angle in [0.0, 1e-9, -0.02, 0.0999, 0.1001, 0.7, -2.0, 3.19, 3.21, -40.0] {
            let error = (small_turn(angle) - Complex::from_polar(1.0, angle)).norm();
            assert!(error < 1e-14, "{angle}: {error}");
        }
    }
}
