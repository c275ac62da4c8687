//! What one rotor puts into a channel: its own line there, and those of its other lines and sidebands that fall into the band.

use hovertone_signal::channels::Channel;
use hovertone_vehicle::MESH_SIDEBANDS;
use std::array::from_fn;
use std::f64::consts::PI;

/// Beyond so many resolution cells one line does not disturb another: the lobes of a Hann frame are below -60 dB there. *Numeric.*
pub(super) const REACH_CELLS: f64 = 6.0;
/// Places half a cell apart within that reach to either side, rounded up to whole vectors. *Numeric.*
const LOBE_PLACES: usize = (4 * REACH_CELLS as usize + 1).next_multiple_of(4);
/// Below this the quotient of the lobe loses its digits. *Numeric.*
const LOBE_DENOMINATOR_MIN: f32 = 0.02;
/// Lines closer than this share one lobe; their amplitudes cannot be told apart. *Numeric.*
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

/// Lobes of Hann frames whose places are known by their sines as well: of one place, the sine of all others half cells away is one of
/// four values, and of two, the sine of their difference follows.
#[derive(Clone, Copy, Debug)]
pub(super) struct PlacedLobe {
    pub(super) cells: f64,
    sine: f64,
    cosine: f64,
}

impl PlacedLobe {
    pub(super) fn at(cells: f64) -> Self {
        let (sine, cosine) = (PI * cells).sin_cos();
        Self { cells, sine, cosine }
    }

    /// The lobe of one at the place of the other.
    pub(super) fn at_place_of(self, other: Self) -> f64 {
        let x = self.cells - other.cells;
        let below = PI * x * (1.0 - x * x);
        if x.abs() > REACH_CELLS || below.abs() < f64::from(LOBE_DENOMINATOR_MIN) {
            return hann_lobe(x);
        }
        (self.sine * other.cosine - self.cosine * other.sine) / below
    }

    /// The lobe at so many places from `half_cells` halves of a cell on, each half a cell after the one before.
    pub(super) fn lobes_from(self, half_cells: i32) -> [f32; LOBE_PLACES] {
        // sin(π (n / 2 - x)) for n = 0 … 3
        let (sine, cosine) = (self.sine as f32, self.cosine as f32);
        let mut sines = [-sine, cosine, sine, -cosine];
        sines.rotate_left(half_cells.rem_euclid(4) as usize);
        let first_cells = f64::from(half_cells) / 2.0 - self.cells;
        let denominators: [f32; LOBE_PLACES] = from_fn(|index| {
            let x = first_cells as f32 + 0.5 * index as f32;
            PI as f32 * x * (1.0 - x * x)
        });
        let mut lobes = [0.0f32; LOBE_PLACES];
        for (lobes, denominators) in lobes.as_chunks_mut::<4>().0.iter_mut().zip(denominators.as_chunks::<4>().0) {
            *lobes = from_fn(|index| sines[index] / denominators[index]);
        }
        // the sine vanishes where the denominator does
        if denominators.iter().any(|below| below.abs() <= LOBE_DENOMINATOR_MIN) {
            for (index, lobe) in lobes.iter_mut().enumerate() {
                let x = first_cells + 0.5 * index as f64;
                // the denominator vanishes at −1, 0 and 1
                if x.abs().round() <= 1.0 {
                    *lobe = hann_lobe(x) as f32;
                }
            }
        }
        lobes
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
        for cells in [-3.77, 0.0, 2.5, 7.001, -0.4997] {
            let placed = PlacedLobe::at(cells);
            for half_cells in [-20, -13, 3] {
                for (index, lobe) in placed.lobes_from(half_cells).into_iter().enumerate() {
                    let away = f64::from(half_cells) / 2.0 + 0.5 * index as f64 - cells;
                    let is_within = away.abs() <= REACH_CELLS;
                    assert!(!is_within || (f64::from(lobe) - hann_lobe(away)).abs() < 1e-5, "{cells} {away}");
                }
            }
            for other in [-3.77, -2.7701, 0.3, 1.49] {
                assert!((placed.at_place_of(PlacedLobe::at(other)) - hann_lobe(cells - other)).abs() < 1e-12);
            }
        }
    }
}
