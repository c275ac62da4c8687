//! Sums of lines, as phasors of a block of samples.

use std::f64::consts::TAU;

/// Samples that are made at once: 1 ms at 48 kHz. The wander of a [`HoverSound`](crate::HoverSound), and the level and
/// phase of a [`Line`](super::Line) that change, go along one straight line in it. Part of what a seed means.
pub(super) const BLOCK: usize = 48;

/// A line's amplitude `A` and phase `φ` as `A cos φ` and `A sin φ`: the line is `A cos(θ + φ) = cosine · cos θ - sine ·
/// sin θ`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Amplitude {
    pub(super) cosine: f64,
    pub(super) sine: f64,
}

impl Amplitude {
    /// From amplitude and phase.
    pub(super) fn polar(amplitude: f64, phase_rad: f64) -> Self {
        let (sine, cosine) = phase_rad.sin_cos();
        Self { cosine: amplitude * cosine, sine: amplitude * sine }
    }
}

/// `e^(i·order·θ)` for each sample of a block, by components, so that the compiler can use vector instructions.
#[derive(Clone)]
pub(super) struct Phasors {
    re: [f64; BLOCK],
    im: [f64; BLOCK],
}

impl Phasors {
    /// Order 1, from shares of a turn.
    pub(super) fn from_turns(turns: &[f64; BLOCK]) -> Self {
        let mut phasors = Self { re: [0.0; BLOCK], im: [0.0; BLOCK] };
        for ((re, im), turn) in phasors.re.iter_mut().zip(&mut phasors.im).zip(turns) {
            (*im, *re) = (TAU * turn).sin_cos();
        }
        phasors
    }

    /// Any order, whole or not, from turns counted since the start.
    pub(super) fn of_order(order: f64, turns: &[f64; BLOCK]) -> Self {
        // only the part of a turn counts, and a sine is most exact for small arguments
        Self::from_turns(&turns.map(|turns| {
            let turned = order * turns;
            turned - turned.round()
        }))
    }

    /// Order 0.
    pub(super) fn one() -> Self {
        Self { re: [1.0; BLOCK], im: [0.0; BLOCK] }
    }

    /// Multiplies by `other`: the orders add up. With `sign` -1 by its conjugate: the orders subtract.
    pub(super) fn turn_on(&mut self, other: &Self, sign: f64) {
        for sample in 0..BLOCK {
            let (re, im) = (self.re[sample], self.im[sample]);
            let (other_re, other_im) = (other.re[sample], sign * other.im[sample]);
            self.re[sample] = re * other_re - im * other_im;
            self.im[sample] = re * other_im + im * other_re;
        }
    }

    /// To a whole power, by squaring: the rounding is that of `log2(order)` products, some 1e-14 at order 69.
    pub(super) fn power(&self, order: u32) -> Self {
        let (mut result, mut square, mut left) = (Self::one(), self.clone(), order);
        while left > 0 {
            if left & 1 == 1 {
                result.turn_on(&square, 1.0);
            }
            let same = square.clone();
            square.turn_on(&same, 1.0);
            left >>= 1;
        }
        result
    }

    /// Adds a line of constant amplitude and phase.
    pub(super) fn add_line(&self, line: Amplitude, sum: &mut [f64; BLOCK]) {
        for ((sum, re), im) in sum.iter_mut().zip(&self.re).zip(&self.im) {
            *sum += line.cosine * re - line.sine * im;
        }
    }

    /// Adds a line whose amplitude goes straight from one value, at the first sample of the block, to another, at the
    /// first sample of the next block.
    pub(super) fn add_changing_line(&self, from: Amplitude, to: Amplitude, sum: &mut [f64; BLOCK]) {
        let (cosine_change, sine_change) = (to.cosine - from.cosine, to.sine - from.sine);
        for (sample, ((sum, re), im)) in sum.iter_mut().zip(&self.re).zip(&self.im).enumerate() {
            let share = sample as f64 / BLOCK as f64;
            *sum += (from.cosine + share * cosine_change) * re - (from.sine + share * sine_change) * im;
        }
    }
}
