//! The unknowns of a step in a room, as one vector.

use super::spectra::StepSpectra;
use crate::first_order::response;
use nalgebra::DVector;

/// Start, ln τ, ln(to/from), and the power of the speed with which the sound gets louder.
pub(super) const CURVE: usize = 4;
/// Behind them: ln of the power of the echoes over that of the direct sound, of the time constant of their tail, and of the time of the first one.
pub(super) const PLACE: usize = 3;
/// Shares of the mean speed at which rotors are sought: the dictionary of the shape of a line. *Decision*: rotors of a bench are alike.
pub(super) const SHARES: [f64; 5] = [-0.016, -0.008, 0.0, 0.008, 0.016];
/// Steps between delays of the tail, and how many time constants of it are heard. *Numeric.*
const TAIL_STEPS: usize = 16;
const TAIL_TIME_CONSTANTS: f64 = 4.0;
/// Knots of the gain of a line over time: from before the step to behind it. *Decision.*
pub(super) const GAINS: usize = 4;
/// Knots of the noise over the orders. *Decision.*
pub(super) const NOISE_KNOTS: usize = 8;

/// A curve of first order from a given speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RoomCurve {
    /// When the speed begins to change.
    pub start_s: f64,
    /// τ.
    pub time_constant_s: f64,
    /// Speed before.
    pub from_rev_s: f64,
    /// Speed that the curve approaches.
    pub to_rev_s: f64,
}

impl RoomCurve {
    /// The speed at a time.
    #[inline]
    pub fn at(&self, time_s: f64) -> f64 {
        self.from_rev_s + (self.to_rev_s - self.from_rev_s) * response(time_s, self.start_s, self.time_constant_s)
    }
}

/// Where each kind of unknown begins in the vector.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    pub(super) lines: usize,
}

impl Layout {
    pub(super) fn of(spectra: &StepSpectra) -> Self {
        Self { lines: spectra.orders.len() }
    }

    /// ln of the power of a line at a share.
    pub(super) fn power(self, line: usize, share: usize) -> usize {
        CURVE + PLACE + line * SHARES.len() + share
    }

    /// ln of a line's gain at a knot of time.
    pub(super) fn gain(self, line: usize, knot: usize) -> usize {
        CURVE + PLACE + self.lines * SHARES.len() + GAINS * line + knot
    }

    /// ln of the noise at a knot, before and behind.
    pub(super) fn noise(self, knot: usize, side: usize) -> usize {
        self.gain(self.lines, 0) + 2 * knot + side
    }

    pub(super) fn count(self) -> usize {
        self.noise(NOISE_KNOTS, 0)
    }
}

/// What a microphone hears of a sound, by its delay.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arrival {
    pub(super) delay_s: f64,
    pub(super) power: f64,
}

/// The echogram: the direct sound with a power of 1, and a tail that falls exponentially.
pub(super) fn arrivals(unknowns: &DVector<f64>) -> Vec<Arrival> {
    let [echoes, time_constant_s, first_s]: [f64; PLACE] = std::array::from_fn(|at| unknowns[CURVE + at].exp());
    let mut arrivals = vec![Arrival { delay_s: 0.0, power: 1.0 }];
    let step = TAIL_TIME_CONSTANTS / TAIL_STEPS as f64;
    arrivals.extend((0..TAIL_STEPS).map(|at| {
        let delay = (at as f64 + 0.5) * step;
        Arrival { delay_s: first_s + delay * time_constant_s, power: echoes * step * (-delay).exp() }
    }));
    arrivals
}
