//! A stream of sound → quanta of all channels, each short enough to be analysed at once.

use super::floor::FloorMeter;
use super::map::FRAME_HOPS;
use crate::channel::{Channel, ChannelBand, ChannelBank, TICKS_PER_HOP};
use realfft::num_complex::Complex;
use rustfft::FftPlanner;

/// Longest stretch that is taken together. No rotor in flight keeps its phase for longer.
const QUANTUM_S_MAX: f64 = 10.0;
/// Digital silence has no noise; this keeps the likelihood finite. The last bit of 24 has 2e-15.
const NOISE_VARIANCE_MIN: f64 = 1e-16;
/// Noise below this share of the sound's power is the rounding of the transforms, and keeps its phase like a tone.
const ROUNDING_SHARE: f64 = 1e-12;

/// The speeds between which all bands stand.
pub(super) fn limits_rev_s(bands: &[ChannelBand]) -> (f64, f64) {
    bands.first().map_or((0.0, 1.0), |band| (band.band_hz_low / band.order, band.band_hz_high / band.order))
}

/// Gathers the channels of stretches of sound and cuts them into quanta of nearly equal length.
pub(super) struct QuantumCutter {
    bank: ChannelBank,
    series: Vec<Vec<Complex<f32>>>,
    floors: Vec<FloorMeter>,
    /// Start of what lies in `series`.
    start_s: f64,
    stretch_start_s: f64,
    samples_in: u64,
    /// Sum of their squares.
    squares: f64,
    sample_rate_hz: f64,
    quantum_hops: usize,
}

/// All channels over a stretch of time.
pub(super) struct Quantum<'a> {
    pub(super) channels: &'a [Channel],
    /// Samples of each channel.
    pub(super) series: Vec<&'a [Complex<f32>]>,
    pub(super) start_s: f64,
    pub(super) tick_s: f64,
    pub(super) ticks: usize,
    /// The noise in one sample of each channel.
    pub(super) noise_variances: Vec<f64>,
}

impl Quantum<'_> {
    /// Order and noise power per Hz of each channel.
    pub(super) fn floors(&self) -> Vec<(f64, f64)> {
        let channels = self.channels.iter().zip(&self.noise_variances);
        channels.map(|(channel, variance)| (channel.order, variance / channel.rate_hz)).collect()
    }
}

impl QuantumCutter {
    pub(super) fn new(sample_rate_hz: f64, bands: &[ChannelBand]) -> Self {
        let bank = ChannelBank::new(sample_rate_hz, bands);
        let mut planner = FftPlanner::new();
        let channels = bank.channels.iter();
        Self {
            floors: channels.map(|channel| FloorMeter::new(channel.hop_samples, &mut planner)).collect(),
            series: vec![Vec::new(); bank.channels.len()],
            bank,
            start_s: 0.0,
            stretch_start_s: 0.0,
            samples_in: 0,
            squares: 0.0,
            sample_rate_hz,
            quantum_hops: 1,
        }
    }

    pub(super) fn channels(&self) -> &[Channel] {
        &self.bank.channels
    }

    pub(super) fn hop_s(&self) -> f64 {
        self.bank.hop_s()
    }

    pub(super) fn tick_s(&self) -> f64 {
        self.bank.hop_s() / TICKS_PER_HOP as f64
    }

    /// A new stretch begins at `start_s` and should last `length_s`; the one before has been taken to its end.
    pub(super) fn restart(&mut self, start_s: f64, length_s: f64) {
        self.series.iter_mut().for_each(Vec::clear);
        self.bank.restart();
        (self.start_s, self.stretch_start_s, self.samples_in, self.squares) = (start_s, start_s, 0, 0.0);
        let quanta = (length_s / QUANTUM_S_MAX).ceil().max(1.0);
        self.quantum_hops = (length_s / quanta / self.bank.hop_s()).ceil().max(1.0) as usize;
    }

    pub(super) fn push(&mut self, samples: &[f32]) {
        self.samples_in += samples.len() as u64;
        self.squares += sum_of_squares(samples);
        self.bank.push(samples, &mut self.series);
    }

    /// Ticks of the next quantum, if it has come in whole. A stretch that ends a little later than it should must not leave a crumb.
    pub(super) fn ready_ticks(&self) -> Option<usize> {
        (self.hops() >= self.quantum_hops + self.quantum_hops / 2).then_some(self.quantum_hops * TICKS_PER_HOP)
    }

    /// The stretch ends here: ticks of what is left, if it is worth anything, and the time of the last sample. The last tick is
    /// heard even if the stretch ends within it: it has faded out by then.
    pub(super) fn last_ticks(&mut self) -> Option<(usize, f64)> {
        self.bank.finish(&mut self.series);
        let end_s = self.stretch_start_s + self.samples_in as f64 / self.sample_rate_hz;
        let ticks = ((end_s - self.start_s) / self.tick_s() - 1e-6).ceil() as usize;
        let ticks = ticks.min(self.hops() * TICKS_PER_HOP);
        self.samples_in = 0;
        (ticks >= FRAME_HOPS * TICKS_PER_HOP).then_some((ticks, end_s))
    }

    /// The first ticks of what has come in, with a floor that is known: noise power per Hz at each order.
    pub(super) fn quantum_over(&mut self, ticks: usize, floors: &[(f64, f64)]) -> Quantum<'_> {
        let mut quantum = self.quantum(ticks);
        for (channel, variance) in quantum.channels.iter().zip(&mut quantum.noise_variances) {
            if let Some((_, density)) = floors.iter().find(|(order, _)| *order == channel.order) {
                *variance = density * channel.rate_hz;
            }
        }
        quantum
    }

    /// The first ticks of what has come in.
    pub(super) fn quantum(&mut self, ticks: usize) -> Quantum<'_> {
        let channels = &self.bank.channels;
        let series: Vec<&[Complex<f32>]> = channels
            .iter()
            .zip(&self.series)
            .map(|(channel, series)| &series[..ticks * channel.hop_samples / TICKS_PER_HOP])
            .collect();
        let mean_square = self.squares / self.samples_in.max(1) as f64;
        let noise_variance_min = NOISE_VARIANCE_MIN.max(ROUNDING_SHARE * mean_square);
        let floors = self.floors.iter_mut().zip(&series);
        let noise_variances =
            floors.map(|(floor, series)| floor.noise_variance(series).unwrap_or(0.0).max(noise_variance_min)).collect();
        let tick_s = self.bank.hop_s() / TICKS_PER_HOP as f64;
        Quantum { channels, series, start_s: self.start_s, tick_s, ticks, noise_variances }
    }

    /// Forgets the first ticks.
    pub(super) fn drop_ticks(&mut self, ticks: usize) {
        for (channel, series) in self.bank.channels.iter().zip(&mut self.series) {
            let samples = (ticks * channel.hop_samples / TICKS_PER_HOP).min(series.len());
            series.drain(..samples);
        }
        self.start_s += ticks as f64 * self.tick_s();
    }

    fn hops(&self) -> usize {
        self.bank
            .channels
            .iter()
            .zip(&self.series)
            .map(|(channel, series)| series.len() / channel.hop_samples)
            .min()
            .unwrap_or(0)
    }
}

/// Written so that it runs in vectors.
fn sum_of_squares(samples: &[f32]) -> f64 {
    let (eights, rest) = samples.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for eight in eights {
        sums.iter_mut().zip(eight).for_each(|(sum, sample)| *sum += f64::from(sample * sample));
    }
    sums.iter().sum::<f64>() + rest.iter().map(|sample| f64::from(sample * sample)).sum::<f64>()
}
