//! What one rotor puts into a channel: its own line there, and those of its other lines and sidebands that fall into the band.

use crate::channel::Channel;
use crate::tone::MESH_SIDEBANDS;
use std::f64::consts::PI;

/// Beyond so many resolution cells one line does not disturb another: the lobes of a Hann frame are below -60 dB there.
pub(super) const REACH_CELLS: f64 = 6.0;
/// Below this the quotient of the lobe loses its digits.
const LOBE_DENOMINATOR_MIN: f32 = 0.02;
/// Lines closer than this share one lobe; their amplitudes cannot be told apart.
const SAME_CELLS: f64 = 1e-3;

/// The orders that fall into one channel, its own first.
#[derive(Clone, Debug)]
pub(super) struct ChannelAtoms {
    pub(super) orders: Vec<f64>,
}

/// The atoms of each channel. `mesh_order` is the order of the gear mesh, whose lines have sidebands.
pub(super) fn atoms_of(channels: &[Channel], mesh_order: Option<f64>) -> Vec<ChannelAtoms> {
    let mut orders: Vec<f64> = Vec::new();
    for channel in channels {
        orders.push(channel.order);
        if mesh_order.is_some_and(|mesh| (channel.order / mesh).fract() == 0.0) {
            orders.extend(MESH_SIDEBANDS.iter().map(|sideband| channel.order + sideband));
        }
    }
    channels
        .iter()
        .map(|channel| {
            // a rotor anywhere in the band of speeds, with any of its lines in the band of the channel
            let half_width = channel.rate_hz / 2.0 / channel.centre_hz.max(channel.rate_hz);
            let reach = 2.0 * half_width * channel.order;
            let others = orders
                .iter()
                .copied()
                .filter(|&order| order != channel.order && (order - channel.order).abs() <= reach);
            let mut orders: Vec<f64> = std::iter::once(channel.order).chain(others).collect();
            orders[1..].sort_by(f64::total_cmp);
            orders.dedup();
            ChannelAtoms { orders }
        })
        .collect()
}

/// Spectrum of a Hann window of length T at a frequency of `cells` / T, 1 at 0: `sinc(x) / (1 − x²)`.
pub(super) fn hann_lobe(cells: f64) -> f64 {
    let x = cells.abs();
    if x > REACH_CELLS {
        0.0
    } else if x < SAME_CELLS {
        1.0
    } else if (x - 1.0).abs() < SAME_CELLS {
        0.5
    } else {
        (PI * x).sin() / (PI * x * (1.0 - x * x))
    }
}

/// The lobe at equal steps: its sine by recurrence.
pub(super) struct HannLobes {
    cells: f32,
    step_cells: f32,
    sine: (f32, f32),
    turn: (f32, f32),
}

impl HannLobes {
    pub(super) fn from(cells: f64, step_cells: f64) -> Self {
        let ((sine, cosine), (turn_sine, turn_cosine)) = ((PI * cells).sin_cos(), (PI * step_cells).sin_cos());
        Self {
            cells: cells as f32,
            step_cells: step_cells as f32,
            sine: (cosine as f32, sine as f32),
            turn: (turn_cosine as f32, turn_sine as f32),
        }
    }
}

impl Iterator for HannLobes {
    type Item = f32;

    fn next(&mut self) -> Option<f32> {
        let ((re, im), (turn_re, turn_im)) = (self.sine, self.turn);
        let x = self.cells;
        // sin(π x) vanishes where the denominator does
        let below = PI as f32 * x * (1.0 - x * x);
        let lobe = if below.abs() > LOBE_DENOMINATOR_MIN { im / below } else { hann_lobe(f64::from(x)) as f32 };
        self.sine = (re * turn_re - im * turn_im, re * turn_im + im * turn_re);
        self.cells += self.step_cells;
        Some(lobe)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lobe_is_that_of_a_hann_window() {
        let length = 4096;
        for cells in [0.0, 0.3, 0.5, 0.9999, 1.0, 1.5, 2.0, 2.5, 4.2] {
            let (mut sum, mut weights) = (0.0, 0.0);
            for n in 0..length {
                let t = (f64::from(n) + 0.5) / f64::from(length) - 0.5;
                let weight = 0.5 + 0.5 * (2.0 * PI * t).cos();
                sum += weight * (2.0 * PI * cells * t).cos();
                weights += weight;
            }
            assert!((hann_lobe(cells) - sum / weights).abs() < 1e-3, "{cells}");
            assert_eq!(hann_lobe(cells), hann_lobe(-cells));
        }
        for (index, lobe) in HannLobes::from(-5.77, 0.25).take(46).enumerate() {
            assert!((f64::from(lobe) - hann_lobe(-5.77 + 0.25 * index as f64)).abs() < 1e-4, "{index}");
        }
    }
}
