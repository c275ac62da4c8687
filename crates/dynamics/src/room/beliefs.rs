//! What is believed of a step and of its place before it is heard.

use super::fit::RoomStep;
use super::parameters::{CURVE, GAINS, Layout, NOISE_KNOTS, PLACE, RoomCurve, SHARES};
use super::spectra::StepSpectra;
use hovertone_signal::statistics::median;
use nalgebra::DVector;

/// Standard deviations: start, s; ln τ; ln(to/from); power of the speed with which the sound gets louder; logarithms of powers; gains, from the
/// fading of a room. *Decision*: all wide.
const CURVE_STD: [f64; CURVE] = [0.05, 1.0, 0.1, 1.0];
const POWER_STD: f64 = 3.0;
const GAIN_STD: f64 = 1.0;
/// Power of the speed with which the sound of a rotor gets louder: 5 to 6 by the size of the forces on its blades. *Physics.*
const LOUDER: f64 = 5.0;
/// Logarithms of the echoes' power over that of the direct sound, of the time constant of their tail and of the time of the first one, s:
/// means and standard deviations. *Physics*: rooms whose sound falls by 60 dB in 0.15 to 1 s, and walls within some metres.
const PLACE_MEAN: [f64; PLACE] = [-1.0, -3.5, -4.5];
const PLACE_STD: [f64; PLACE] = [2.0, 0.5, 0.5];
/// Bins on either side of a line in which its power is first sought. *Numeric.*
const NEAR_BINS: usize = 2;
/// First powers over the median of the spectrum: least of a line, and noise. *Numeric.*
const LINE_SHARE_MIN: f64 = 0.3;
const NOISE_SHARE: f64 = 0.5;

/// Means and inverse variances of all unknowns.
pub(super) struct Beliefs {
    pub(super) mean: DVector<f64>,
    pub(super) precision: DVector<f64>,
}

/// A logarithm that is believed of a place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PlaceValue {
    /// The logarithm.
    pub value: f64,
    /// Its variance.
    pub variance: f64,
}

/// Logarithms of the echoes' power over that of the direct sound, of the time constant of their tail in s, and of the delay of the first one in s.
pub type PlaceBelief = [PlaceValue; PLACE];

/// What is believed of a place before anything is heard.
pub fn any_place() -> PlaceBelief {
    std::array::from_fn(|at| PlaceValue { value: PLACE_MEAN[at], variance: PLACE_STD[at].powi(2) })
}

/// What the steps of a recording tell of their place, each heard with the belief `before`: what each adds to it is added to the belief in any
/// place.
pub fn place_of(steps: &[RoomStep], before: &PlaceBelief) -> PlaceBelief {
    let any = any_place();
    std::array::from_fn(|at| {
        let (mut weights, mut products) = (any[at].variance.recip(), any[at].value / any[at].variance);
        for step in steps {
            let with = step.place[at].variance.recip();
            let added = (with - before[at].variance.recip()).max(0.0);
            weights += added;
            products += with * step.place[at].value - (with - added) * before[at].value;
        }
        PlaceValue { value: products / weights, variance: weights.recip() }
    })
}

/// Beliefs about a step near a curve.
pub(super) fn beliefs_of(spectra: &StepSpectra, first: &RoomCurve, place: &PlaceBelief) -> Beliefs {
    let layout = Layout::of(spectra);
    let mut mean = DVector::zeros(layout.count());
    let mut std = DVector::from_element(layout.count(), POWER_STD);
    let curve = [first.start_s, first.time_constant_s.ln(), (first.to_rev_s / first.from_rev_s).ln(), LOUDER];
    for at in 0..CURVE {
        (mean[at], std[at]) = (curve[at], CURVE_STD[at]);
    }
    for (at, belief) in place.iter().enumerate() {
        (mean[CURVE + at], std[CURVE + at]) = (belief.value, belief.variance.sqrt());
    }
    let frames = spectra.frames.len() as f64;
    let mean_power = |bin: usize| spectra.frames.iter().map(|frame| frame.power[bin]).sum::<f64>() / frames;
    let powers: Vec<f64> = (0..spectra.bin_count()).map(mean_power).collect();
    let floor = median(&powers).unwrap_or(1.0).max(f64::MIN_POSITIVE);
    for (line, order) in spectra.orders.iter().enumerate() {
        let bin = ((order * spectra.turns).round() as usize).saturating_sub(spectra.first_bin);
        let near = &powers[bin.saturating_sub(NEAR_BINS).min(powers.len())..(bin + NEAR_BINS + 1).min(powers.len())];
        let highest = near.iter().copied().fold(LINE_SHARE_MIN * floor, f64::max);
        for share in 0..SHARES.len() {
            mean[layout.power(line, share)] = (highest / SHARES.len() as f64).ln();
        }
        for knot in 0..GAINS {
            std[layout.gain(line, knot)] = GAIN_STD;
        }
    }
    for knot in 0..NOISE_KNOTS {
        for side in 0..2 {
            mean[layout.noise(knot, side)] = (NOISE_SHARE * floor).ln();
        }
    }
    Beliefs { mean, precision: std.map(|std: f64| std.powi(-2)) }
}
