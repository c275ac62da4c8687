//! Sound → one complex signal for each order.

use super::turns::Turns;
use super::window::Window;
use crate::grey_box::SpeedPrediction;
use hovertone_signal::channels::{ChannelBand, ChannelBank};
use hovertone_signal::passes::{Passes, StretchListener};
use hovertone_signal::{SignalError, statistics::median};
use hovertone_vehicle::Vehicle;
use nalgebra::Complex;
use std::f64::consts::{LN_2, PI, TAU};
use std::ops::Range;

/// Blade passes that are heard. *Physics*: real rotors show about twelve.
const BLADE_PASSES: u32 = 12;
/// Harmonics of the gear mesh that are heard. *Physics*: three, as in the paper.
const MESHES: u32 = 3;
/// Highest frequency over the sample rate. *Numeric*: the filters of recorders begin there.
const RATE_SHARE_MAX: f64 = 0.44;
/// Orders above this are of a mesh: twelve passes of five blades are below. *Physics.*
const MESH_ORDER_MIN: f64 = 60.5;
/// Lowest rate of a line that follows its rotors, Hz: twenty samples in a window. *Numeric.*
const RATE_HZ_MIN: f64 = 100.0;
/// Samples of the transform that finds the noise between the lines. *Numeric.*
const NOISE_BINS: usize = 24;

/// The orders of a vehicle's lines.
#[derive(Clone, Debug, PartialEq)]
pub struct LineOrders(pub Vec<f64>);

impl LineOrders {
    /// Blade passes and, of a geared vehicle, meshes; `None` where the number of blades is not known.
    pub fn of(vehicle: &Vehicle) -> Option<Self> {
        let blades = vehicle.blade_count?.value;
        let passes = (1..=BLADE_PASSES).map(|k| f64::from(k * blades));
        let wheel = vehicle.gear.map(|gear| f64::from(gear.value.wheel));
        let meshes = wheel.into_iter().flat_map(|wheel| (1..=MESHES).map(move |k| f64::from(k) * wheel));
        Some(Self(passes.chain(meshes).collect()))
    }
}

/// One line of all rotors.
pub(super) struct HeardLine {
    pub(super) order: f64,
    pub(super) rate_hz: f64,
    pub(super) samples: Vec<Complex<f32>>,
    /// Turns by which each sample was turned back: the line itself is the sample times `exp(2πj carrier)`.
    pub(super) carrier: Vec<f64>,
    /// Power of the noise in one sample.
    pub(super) noise: f64,
    /// Power of one rotor's line above the noise; the variance of its amplitude.
    pub(super) amplitude_variance: f64,
}

impl HeardLine {
    /// The first sample of a window, and the first behind it.
    pub(super) fn samples_of(&self, start_s: f64, window: Window) -> (usize, usize) {
        let at = |time_s: f64| ((time_s - start_s) * self.rate_hz).max(0.0);
        let span_s = window.span_s();
        (at(span_s.start).ceil() as usize, (at(span_s.end).floor() as usize).min(self.samples.len()))
    }

    pub(super) fn sample(&self, index: usize) -> Complex<f64> {
        let sample = self.samples[index];
        Complex::new(f64::from(sample.re), f64::from(sample.im))
    }
}

/// All lines of a recording.
pub struct HeardLines {
    pub(super) start_s: f64,
    pub(super) end_s: f64,
    pub(super) lines: Vec<HeardLine>,
}

impl HeardLines {
    /// The same lines turned back along the mean angle of a prediction, and decimated to a band of `band_share` of the speed on both
    /// sides of it. Less is left to compute: the band of a line that follows its rotors is narrow.
    pub(super) fn followed(&self, prediction: &SpeedPrediction, band_share: f64) -> Self {
        let turns = Turns::of(prediction);
        let mean_rev_s =
            prediction.speed_rad_s.iter().flatten().sum::<f64>() / (4.0 * prediction.speed_rad_s.len() as f64 * TAU);
        let lines = self.lines.iter().map(|line| {
            let wanted_hz = (2.0 * band_share * line.order * mean_rev_s).max(RATE_HZ_MIN);
            followed(line, self.start_s, &turns, ((line.rate_hz / wanted_hz) as usize).max(1))
        });
        Self { start_s: self.start_s, end_s: self.end_s, lines: lines.collect() }
    }

    /// The order of the gear mesh, where it was heard.
    pub(super) fn mesh_order(&self) -> Option<f64> {
        self.lines.iter().map(|line| line.order).find(|order| *order > MESH_ORDER_MIN)
    }

    /// The highest order that was heard.
    pub(super) fn order_max(&self) -> f64 {
        self.lines.iter().map(|line| line.order).fold(1.0, f64::max)
    }
}

/// Takes the lines out of the sound in one pass. `speed_rev_s` is the range of the shaft speeds.
///
/// # Errors
/// A source that fails.
pub fn lines_from_passes(
    passes: &mut Passes<'_>,
    span_s: Range<f64>,
    orders: &LineOrders,
    speed_rev_s: Range<f64>,
) -> Result<HeardLines, SignalError> {
    let rate_hz = passes.sample_rate_hz();
    let is_heard = |order: &&f64| **order * speed_rev_s.end < RATE_SHARE_MAX * rate_hz;
    let band = |order: &f64| ChannelBand {
        order: *order,
        is_first: false,
        band_hz_low: order * speed_rev_s.start,
        band_hz_high: order * speed_rev_s.end,
        noise_fall_db: 0.0,
    };
    let bands: Vec<ChannelBand> = orders.0.iter().filter(is_heard).map(band).collect();
    let mut listener = Listener {
        bank: ChannelBank::new(rate_hz, &bands),
        series: vec![Vec::new(); bands.len()],
        start_s: span_s.start,
    };
    passes.listen(&[span_s], &mut listener)?;
    let Listener { mut bank, mut series, start_s } = listener;
    bank.finish(&mut series);
    let mut end_s = start_s;
    let lines = bank.channels.iter().zip(series).map(|(channel, samples)| {
        end_s = start_s + samples.len() as f64 / channel.rate_hz;
        let noise = noise_of(&samples).max(f64::MIN_POSITIVE);
        let power = samples.iter().map(|z| f64::from(z.norm_sqr())).sum::<f64>() / samples.len().max(1) as f64;
        HeardLine {
            order: channel.order,
            rate_hz: channel.rate_hz,
            carrier: (0..samples.len()).map(|n| channel.centre_hz * n as f64 / channel.rate_hz).collect(),
            noise,
            amplitude_variance: ((power - noise) / 4.0).max(1e-3 * noise),
            samples,
        }
    });
    let lines = lines.collect();
    Ok(HeardLines { start_s, end_s, lines })
}

/// One line turned back and decimated by a Hann window of two steps.
fn followed(line: &HeardLine, start_s: f64, turns: &Turns, step: usize) -> HeardLine {
    let carrier_at = |n: usize| line.order * turns.at(start_s + n as f64 / line.rate_hz).iter().sum::<f64>() / 4.0;
    let turned: Vec<Complex<f32>> = line
        .samples
        .iter()
        .enumerate()
        .map(|(n, z)| {
            let turn = line.carrier[n] - carrier_at(n);
            let (sin, cos) = (TAU * (turn - turn.round())).sin_cos();
            z * Complex::new(cos as f32, sin as f32)
        })
        .collect();
    let reach = step as i64 - 1;
    let weights: Vec<f32> =
        (-reach..=reach).map(|k| (0.5 + 0.5 * (PI * k as f64 / step as f64).cos()) as f32 / step as f32).collect();
    let mean_at = |centre: usize| {
        let near = (-reach..=reach).zip(&weights);
        let value = |(k, weight): (i64, &f32)| {
            let at = usize::try_from(centre as i64 + k).ok()?;
            Some(turned.get(at)? * *weight)
        };
        near.filter_map(value).sum::<Complex<f32>>()
    };
    let kept: Vec<usize> = (0..line.samples.len()).step_by(step).collect();
    HeardLine {
        order: line.order,
        rate_hz: line.rate_hz / step as f64,
        samples: kept.iter().map(|&at| mean_at(at)).collect(),
        carrier: kept.iter().map(|&at| carrier_at(at)).collect(),
        noise: line.noise * weights.iter().map(|weight| f64::from(*weight).powi(2)).sum::<f64>(),
        amplitude_variance: line.amplitude_variance,
    }
}

struct Listener {
    bank: ChannelBank,
    series: Vec<Vec<Complex<f32>>>,
    start_s: f64,
}

impl StretchListener for Listener {
    fn restart(&mut self, start_s: f64, _length_s: f64) {
        self.start_s = start_s;
        self.bank.restart();
    }

    fn push(&mut self, samples: &[f32]) {
        self.bank.push(samples, &mut self.series);
    }
}

/// Power of the noise between lines: median power of the bins of short transforms over ln 2, the median of an exponential law.
fn noise_of(samples: &[Complex<f32>]) -> f64 {
    let mut powers = Vec::new();
    for block in samples.chunks_exact(NOISE_BINS) {
        for bin in 0..NOISE_BINS {
            let turn = |n: usize| Complex::from_polar(1.0, -TAU * (bin * n % NOISE_BINS) as f64 / NOISE_BINS as f64);
            let sum: Complex<f64> =
                block.iter().enumerate().map(|(n, z)| Complex::new(f64::from(z.re), f64::from(z.im)) * turn(n)).sum();
            powers.push(sum.norm_sqr() / NOISE_BINS as f64);
        }
    }
    median(&powers).unwrap_or(0.0) / LN_2
}
