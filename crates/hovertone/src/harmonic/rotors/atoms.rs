//! What one rotor puts into a channel: its own line there, and those of its other lines and sidebands that fall into the band.

use crate::channel::Channel;
use std::f64::consts::PI;

/// Sidebands of a gear mesh that are taken away with it: one and two turns of the shaft to either side.
const SIDEBANDS: [f64; 4] = [-2.0, -1.0, 1.0, 2.0];
/// Beyond so many resolution cells one line does not disturb another: the lobes of a Hann frame are below -60 dB there.
pub(super) const REACH_CELLS: f64 = 6.0;
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
            orders.extend(SIDEBANDS.iter().map(|sideband| channel.order + sideband));
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
    }
}
