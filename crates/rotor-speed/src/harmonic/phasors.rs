//! Unit phasors without a sine for each: lines of one shaft turn by multiples of the same angle.

use realfft::num_complex::Complex;
use std::f64::consts::TAU;

/// Below this angle the first terms of sine and cosine are all of their digits.
const SMALL_TURN: f64 = 0.1;

/// `exp(j angle)`, where the angle is mostly small.
pub(crate) fn small_turn(angle: f64) -> Complex<f64> {
    if angle.abs() > SMALL_TURN {
        return Complex::from_polar(1.0, angle);
    }
    let x2 = angle * angle;
    let cosine = 1.0 - x2 / 2.0 * (1.0 - x2 / 12.0 * (1.0 - x2 / 30.0 * (1.0 - x2 / 56.0)));
    let sine = angle * (1.0 - x2 / 6.0 * (1.0 - x2 / 20.0 * (1.0 - x2 / 42.0 * (1.0 - x2 / 72.0))));
    Complex::new(cosine, sine)
}

/// `exp(−j 2π o x)` at the same places x for one order o after the other.
///
/// From one order to the next it is a multiplication; sines are taken anew only where orders go up by another step than before, once
/// for each family of lines.
pub(crate) struct OrderPhasors<'a> {
    turns: &'a [f64],
    order: f64,
    step: f64,
    of_step: Vec<Complex<f64>>,
    now: Vec<Complex<f64>>,
}

impl<'a> OrderPhasors<'a> {
    /// At places given in turns of the shaft.
    pub(crate) fn new(turns: &'a [f64]) -> Self {
        let one = vec![Complex::new(1.0, 0.0); turns.len()];
        Self { turns, order: 0.0, step: 0.0, of_step: one.clone(), now: one }
    }

    /// Those of an order: cheap where orders come as lines of one family do, each a step above the one before.
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
        for angle in [0.0, 1e-9, -0.02, 0.0999, 0.1001, -2.0] {
            let error = (small_turn(angle) - Complex::from_polar(1.0, angle)).norm();
            assert!(error < 1e-14, "{angle}: {error}");
        }
    }
}
