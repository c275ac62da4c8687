//! A stream of sound → quanta of all channels, each short enough to be analysed at once.

use super::floor::FloorMeter;
use super::map::FRAME_HOPS;
use hovertone_signal::channels::{Channel, ChannelBand, ChannelBank, TICKS_PER_HOP};
use hovertone_signal::passes::StretchListener;
use realfft::num_complex::Complex;
use rustfft::FftPlanner;

/// Longest stretch that is taken together. No rotor in flight keeps its phase for longer.
const QUANTUM_S_MAX: f64 = 10.0;
/// Digital silence has no noise; this keeps the likelihood finite. The last bit of 24 has 2e-15.
const NOISE_VARIANCE_MIN: f64 = 1e-16;
/// Noise below this share of the sound's power is the rounding of the transforms, and keeps its phase like a tone.
const ROUNDING_SHARE: f64 = 1e-12;

/// The speeds between which all bands stand.
pub(crate) fn limits_rev_s(bands: &[ChannelBand]) -> (f64, f64) {
    bands.first().map_or((0.0, 1.0), |band| (band.band_hz_low / band.order, band.band_hz_high / band.order))
}

/// What hears sound quantum by quantum.
pub(crate) trait QuantumListener {
    /// What it has heard in the end.
    type Heard;

    /// Noise power per Hz at each order, where it is known before the next quantum comes.
    fn known_floors(&self) -> &[(f64, f64)] {
        &[]
    }

    /// The next quantum.
    fn hear(&mut self, quantum: &Quantum<'_>);

    /// A stretch of sound ends, at a time within the last quantum.
    fn end_stretch(&mut self, _end_s: f64) {}

    fn finish(self) -> Self::Heard;
}

/// Lets something hear stretches of sound in quanta.
pub(crate) struct InQuanta<L> {
    cutter: QuantumCutter,
    listener: L,
}

impl<L: QuantumListener> InQuanta<L> {
    pub(crate) fn new(cutter: QuantumCutter, listener: L) -> Self {
        Self { cutter, listener }
    }

    pub(crate) fn finish(mut self) -> L::Heard {
        self.end_stretch();
        self.listener.finish()
    }

    fn take_quantum(&mut self, ticks: usize) {
        self.listener.hear(&self.cutter.quantum(ticks, self.listener.known_floors()));
        self.cutter.drop_ticks(ticks);
    }

    fn end_stretch(&mut self) {
        if let Some((ticks, end_s)) = self.cutter.last_ticks() {
            self.take_quantum(ticks);
            self.listener.end_stretch(end_s);
        }
    }
}

impl<L: QuantumListener> StretchListener for InQuanta<L> {
    fn restart(&mut self, start_s: f64, length_s: f64) {
        self.end_stretch();
        self.cutter.restart(start_s, length_s);
    }

    fn push(&mut self, samples: &[f32]) {
        self.cutter.push(samples);
        while let Some(ticks) = self.cutter.ready_ticks() {
            self.take_quantum(ticks);
        }
    }
}

/// Gathers the channels of stretches of sound and cuts them into quanta of nearly equal length.
pub(crate) struct QuantumCutter {
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
pub(crate) struct Quantum<'a> {
    pub(crate) channels: &'a [Channel],
    /// Samples of each channel.
    pub(crate) series: Vec<&'a [Complex<f32>]>,
    pub(crate) start_s: f64,
    pub(crate) tick_s: f64,
    pub(crate) ticks: usize,
    /// The noise in one sample of each channel.
    pub(crate) noise_variances: Vec<f64>,
}

impl Quantum<'_> {
    /// Order and noise power per Hz of each channel.
    pub(crate) fn floors(&self) -> Vec<(f64, f64)> {
        let channels = self.channels.iter().zip(&self.noise_variances);
        channels.map(|(channel, variance)| (channel.order, variance / channel.rate_hz)).collect()
    }
}

impl QuantumCutter {
    pub(crate) fn new(sample_rate_hz: f64, bands: &[ChannelBand]) -> Self {
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

    pub(crate) fn channels(&self) -> &[Channel] {
        &self.bank.channels
    }

    pub(crate) fn hop_s(&self) -> f64 {
        self.bank.hop_s()
    }

    pub(crate) fn tick_s(&self) -> f64 {
        self.bank.hop_s() / TICKS_PER_HOP as f64
    }

    /// A new stretch begins at `start_s` and should last `length_s`; the one before has been taken to its end.
    fn restart(&mut self, start_s: f64, length_s: f64) {
        self.series.iter_mut().for_each(Vec::clear);
        self.bank.restart();
        (self.start_s, self.stretch_start_s, self.samples_in, self.squares) = (start_s, start_s, 0, 0.0);
        let quanta = (length_s / QUANTUM_S_MAX).ceil().max(1.0);
        self.quantum_hops = (length_s / quanta / self.bank.hop_s()).ceil().max(1.0) as usize;
    }

    fn push(&mut self, samples: &[f32]) {
        self.samples_in += samples.len() as u64;
        self.squares += sum_of_squares(samples);
        self.bank.push(samples, &mut self.series);
    }

    /// Ticks of the next quantum, if it has come in whole. A stretch that ends a little later than it should must not leave a crumb.
    fn ready_ticks(&self) -> Option<usize> {
        (self.hops() >= self.quantum_hops + self.quantum_hops / 2).then_some(self.quantum_hops * TICKS_PER_HOP)
    }

    /// The stretch ends here: ticks of what is left, if it is worth anything, and the time of the last sample. The last tick is
    /// heard even if the stretch ends within it: it has faded out by then.
    fn last_ticks(&mut self) -> Option<(usize, f64)> {
        self.bank.finish(&mut self.series);
        let end_s = self.stretch_start_s + self.samples_in as f64 / self.sample_rate_hz;
        let ticks = ((end_s - self.start_s) / self.tick_s() - 1e-6).ceil() as usize;
        let ticks = ticks.min(self.hops() * TICKS_PER_HOP);
        self.samples_in = 0;
        (ticks >= FRAME_HOPS * TICKS_PER_HOP).then_some((ticks, end_s))
    }

    /// The first ticks of what has come in. The floor is measured where `floors`, noise power per Hz at each order, does not know it.
    fn quantum(&mut self, ticks: usize, floors: &[(f64, f64)]) -> Quantum<'_> {
        let channels = &self.bank.channels;
        let series: Vec<&[Complex<f32>]> = channels
            .iter()
            .zip(&self.series)
            .map(|(channel, series)| &series[..ticks * channel.hop_samples / TICKS_PER_HOP])
            .collect();
        let mean_square = self.squares / self.samples_in.max(1) as f64;
        let noise_variance_min = NOISE_VARIANCE_MIN.max(ROUNDING_SHARE * mean_square);
        let noise_variances = channels
            .iter()
            .zip(&mut self.floors)
            .zip(&series)
            .map(|((channel, meter), series)| {
                let known = floors.iter().find(|(order, _)| *order == channel.order);
                let measured = || meter.noise_variance(series).unwrap_or(0.0).max(noise_variance_min);
                known.map_or_else(measured, |(_, density)| density * channel.rate_hz)
            })
            .collect();
        let tick_s = self.bank.hop_s() / TICKS_PER_HOP as f64;
        Quantum { channels, series, start_s: self.start_s, tick_s, ticks, noise_variances }
    }

    /// Forgets the first ticks.
    fn drop_ticks(&mut self, ticks: usize) {
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
