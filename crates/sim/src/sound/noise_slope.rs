//! Poles and zeros of a filter whose power gain falls with a straight slope.

use std::f64::consts::{LN_2, TAU};

/// Poles per octave. With two, the slope is straight to 0.12 dB from 120 Hz to 16 kHz.
const POLES_PER_OCTAVE: f64 = 2.0;
/// A digital filter goes flat towards half the sample rate, where the slope does not: the share of
/// `20 log (x / sin x)`, `x = π f / sample rate`. One more zero, at minus this number times the slope's share of a pole,
/// corrects that to 0.1 dB up to 16 kHz at 44.1 kHz.
const TOP_ZERO: f64 = 0.14;
/// Fall of one pole per octave.
const POLE_DB_PER_OCTAVE: f64 = 6.020_599_913_279_624;

/// A pole and the zero that follows it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PoleAndZero {
    pub(crate) pole: f64,
    pub(crate) zero: f64,
}

/// A filter `Π (1 - z_k/z) / (1 - p_k/z) · (1 - z_top/z)` that is flat up to a frequency and falls with a straight slope
/// above it.
///
/// Poles stand at even steps of log frequency, each followed by a zero. The way from a pole to its zero, as a share of
/// the way to the next pole, is the wanted slope over that of a pole.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct SlopeFilterRoots {
    /// Lowest pole first; none without a slope.
    pub(crate) ladder: Vec<PoleAndZero>,
    /// The zero that keeps the slope straight towards half the sample rate; 0 without a slope.
    pub(crate) top_zero: f64,
}

impl SlopeFilterRoots {
    /// Roots for a slope between -6 and 0 dB per octave above `flat_below_hz`.
    pub(crate) fn new(slope_db_per_octave: f64, flat_below_hz: f64, sample_rate_hz: f64) -> Self {
        let share = -slope_db_per_octave / POLE_DB_PER_OCTAVE;
        if share == 0.0 {
            return Self { ladder: Vec::new(), top_zero: 0.0 };
        }
        let corner = |octaves: f64| (-TAU * flat_below_hz * (octaves * LN_2).exp() / sample_rate_hz).exp();
        // Poles above half the sample rate still bend the response below it.
        let count = (POLES_PER_OCTAVE * (sample_rate_hz / flat_below_hz).log2()) as u32;
        let ladder = (0..count)
            .map(f64::from)
            .map(|number| PoleAndZero {
                pole: corner(number / POLES_PER_OCTAVE),
                zero: corner((number + share) / POLES_PER_OCTAVE),
            })
            .collect();
        Self { ladder, top_zero: -TOP_ZERO * share }
    }
}
