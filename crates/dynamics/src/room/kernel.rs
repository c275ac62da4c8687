//! Power of a steady line in the bins around it, in a Hann frame.

use std::f64::consts::PI;

/// Bins on either side: beyond, the side lobes of Hann frames are below −41 dB. *Numeric.*
const HALF: isize = 3;
/// Bins of a line.
pub(super) const WIDTH: usize = 2 * HALF as usize + 1;
/// Places of a line between two bins. *Numeric.*
const PLACES: usize = 32;

/// The table.
pub(super) struct Kernel {
    rows: Vec<[f64; WIDTH]>,
}

impl Kernel {
    pub(super) fn new() -> Self {
        let row = |place: usize| {
            let offset = place as f64 / PLACES as f64 - 0.5;
            std::array::from_fn(|at| hann_power(at as f64 - HALF as f64 - offset))
        };
        Self { rows: (0..=PLACES).map(row).collect() }
    }

    /// First bin of a line at a place in bins, and its power in the bins from there.
    #[inline]
    pub(super) fn at(&self, place: f64) -> (isize, &[f64; WIDTH]) {
        let nearest = place.round();
        let row = ((place - nearest + 0.5) * PLACES as f64).round() as usize;
        (nearest as isize - HALF, &self.rows[row.min(PLACES)])
    }
}

/// Power of a Hann frame at a distance in bins, 1 in the middle.
fn hann_power(bins: f64) -> f64 {
    let sinc = |x: f64| if x.abs() < 1e-9 { 1.0 } else { (PI * x).sin() / (PI * x) };
    (sinc(bins) + 0.5 * (sinc(bins - 1.0) + sinc(bins + 1.0))).powi(2)
}
