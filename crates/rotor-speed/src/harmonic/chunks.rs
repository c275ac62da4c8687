//! A stream of sound → chunks of up to 10 s of all channels, each analysed at once.
//!
//! A stretch of sound (a part of the recording without gaps) is cut into chunks of nearly equal length. The noise around each
//! line is measured in every chunk.

use super::noise_floor::NoiseMeter;
use super::speed_map::FRAME_HOPS;
use hovertone_signal::channels::{Channel, ChannelBand, ChannelBank, TICKS_PER_HOP};
use hovertone_signal::fft::ComplexPlanner;
use hovertone_signal::passes::StretchListener;
use realfft::num_complex::Complex;

/// Longest chunk, s. A rotor in flight keeps its phase for less. *Decision.*
const CHUNK_S_MAX: f64 = 10.0;
/// Smallest noise variance of one channel sample: it keeps the likelihood of digital silence finite. The last bit of 24 has 2e-15.
/// *Numeric.*
const NOISE_VARIANCE_MIN: f64 = 1e-16;
/// Smallest noise variance of one channel sample as a share of the power of the sound: rounding of the samples to 16 bits, and of the transforms,
/// makes noise below this, and that noise keeps its phase like a tone. *Numeric.*
const ROUNDING_SHARE: f64 = 1e-8;
/// Rounding error of the length of a stretch, ticks: a remainder below this is no tick. *Numeric.*
const TICK_TOLERANCE: f64 = 1e-6;

/// Lowest and highest shaft speed of the bands, rev/s: all bands cover the same speeds.
pub(crate) fn limits_rev_s(bands: &[ChannelBand]) -> (f64, f64) {
    bands.first().map_or((0.0, 1.0), |band| (band.band_hz_low / band.order, band.band_hz_high / band.order))
}

/// Noise power density around one line.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NoiseDensity {
    /// Order of the line.
    pub(crate) order: f64,
    /// Noise power per Hz.
    pub(crate) power_per_hz: f64,
}

/// An analysis that takes in sound chunk by chunk.
pub(crate) trait ChunkListener {
    /// The result of the analysis.
    type Output;

    /// Noise density of the lines for which it is known before the next chunk comes.
    fn known_noise(&self) -> &[NoiseDensity] {
        &[]
    }

    /// Analyses the next chunk.
    fn take_chunk(&mut self, chunk: &Chunk<'_>);

    /// The stretch of sound ends at a time within the last chunk.
    fn end_stretch(&mut self, _end_s: f64) {}

    /// Returns the result.
    fn finish(self) -> Self::Output;
}

/// Cuts stretches of sound into chunks and passes them on to a listener.
pub(crate) struct InChunks<L> {
    cutter: ChunkCutter,
    listener: L,
}

impl<L: ChunkListener> InChunks<L> {
    pub(crate) fn new(cutter: ChunkCutter, listener: L) -> Self {
        Self { cutter, listener }
    }

    /// Ends the last stretch and returns the result of the listener.
    pub(crate) fn finish(mut self) -> L::Output {
        self.end_stretch();
        self.listener.finish()
    }

    fn pass_on(&mut self, ticks: usize) {
        self.listener.take_chunk(&self.cutter.chunk(ticks, self.listener.known_noise()));
        self.cutter.drop_ticks(ticks);
    }

    fn end_stretch(&mut self) {
        if let Some(last) = self.cutter.last_chunk() {
            self.pass_on(last.ticks);
            self.listener.end_stretch(last.end_s);
        }
    }
}

impl<L: ChunkListener> StretchListener for InChunks<L> {
    fn restart(&mut self, start_s: f64, length_s: f64) {
        self.end_stretch();
        self.cutter.restart(start_s, length_s);
    }

    fn push(&mut self, samples: &[f32]) {
        self.cutter.push(samples);
        while let Some(ticks) = self.cutter.ready_ticks() {
            self.pass_on(ticks);
        }
    }
}

/// Collects the channels of a stretch of sound and cuts them into chunks of nearly equal length.
pub(crate) struct ChunkCutter {
    bank: ChannelBank,
    /// Samples of each channel that belong to no chunk yet.
    series: Vec<Vec<Complex<f32>>>,
    noise_meters: Vec<NoiseMeter>,
    /// Time of the first sample in `series`.
    start_s: f64,
    stretch_start_s: f64,
    /// Samples of the stretch so far.
    samples_in: u64,
    /// Sum of the squares of these samples.
    squares: f64,
    sample_rate_hz: f64,
    chunk_hops: usize,
}

/// All channels over up to 10 s of sound.
pub(crate) struct Chunk<'a> {
    pub(crate) channels: &'a [Channel],
    /// Samples of each channel.
    pub(crate) series: Vec<&'a [Complex<f32>]>,
    pub(crate) start_s: f64,
    /// Length of a tick.
    pub(crate) tick_s: f64,
    /// Length of the chunk in ticks.
    pub(crate) ticks: usize,
    /// Noise variance of one sample of each channel.
    pub(crate) noise_variances: Vec<f64>,
}

impl Chunk<'_> {
    /// Noise density of each line.
    pub(crate) fn noise_densities(&self) -> Vec<NoiseDensity> {
        let channels = self.channels.iter().zip(&self.noise_variances);
        channels
            .map(|(channel, variance)| NoiseDensity { order: channel.order, power_per_hz: variance / channel.rate_hz })
            .collect()
    }
}

/// The rest of a stretch of sound.
struct LastChunk {
    ticks: usize,
    /// Time of the end of the sound, within the last tick.
    end_s: f64,
}

impl ChunkCutter {
    pub(crate) fn new(sample_rate_hz: f64, bands: &[ChannelBand]) -> Self {
        let bank = ChannelBank::new(sample_rate_hz, bands);
        let mut planner = ComplexPlanner::new();
        let channels = bank.channels.iter();
        Self {
            noise_meters: channels.map(|channel| NoiseMeter::new(channel.hop_samples, &mut planner)).collect(),
            series: vec![Vec::new(); bank.channels.len()],
            bank,
            start_s: 0.0,
            stretch_start_s: 0.0,
            samples_in: 0,
            squares: 0.0,
            sample_rate_hz,
            chunk_hops: 1,
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

    /// Begins a stretch at `start_s` with the expected length `length_s`. The stretch before has ended.
    fn restart(&mut self, start_s: f64, length_s: f64) {
        self.series.iter_mut().for_each(Vec::clear);
        self.bank.restart();
        (self.start_s, self.stretch_start_s, self.samples_in, self.squares) = (start_s, start_s, 0, 0.0);
        let chunks = (length_s / CHUNK_S_MAX).ceil().max(1.0);
        self.chunk_hops = (length_s / chunks / self.bank.hop_s()).ceil().max(1.0) as usize;
    }

    fn push(&mut self, samples: &[f32]) {
        self.samples_in += samples.len() as u64;
        self.squares += sum_of_squares(samples);
        self.bank.push(samples, &mut self.series);
    }

    /// Ticks of the next chunk, once one and a half chunks are there: where a stretch is a little longer than expected, its rest
    /// joins the last chunk instead of forming a short one.
    fn ready_ticks(&self) -> Option<usize> {
        (self.hops() >= self.chunk_hops + self.chunk_hops / 2).then_some(self.chunk_hops * TICKS_PER_HOP)
    }

    /// Ends the stretch: the chunk that is left, unless it is shorter than a frame of the speed map. The last tick counts even where
    /// the sound ends within it, because the sound has faded out by then.
    fn last_chunk(&mut self) -> Option<LastChunk> {
        self.bank.finish(&mut self.series);
        let end_s = self.stretch_start_s + self.samples_in as f64 / self.sample_rate_hz;
        let ticks = ((end_s - self.start_s) / self.tick_s() - TICK_TOLERANCE).ceil() as usize;
        let ticks = ticks.min(self.hops() * TICKS_PER_HOP);
        (ticks >= FRAME_HOPS * TICKS_PER_HOP).then_some(LastChunk { ticks, end_s })
    }

    /// A chunk of the first ticks in `series`. The noise of a line is measured where `known_noise` does not hold it.
    fn chunk(&mut self, ticks: usize, known_noise: &[NoiseDensity]) -> Chunk<'_> {
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
            .zip(&mut self.noise_meters)
            .zip(&series)
            .map(|((channel, meter), series)| {
                let known = known_noise.iter().find(|known| known.order == channel.order);
                let measured = || meter.noise_variance(series).unwrap_or(0.0).max(noise_variance_min);
                known.map_or_else(measured, |known| known.power_per_hz * channel.rate_hz)
            })
            .collect();
        let tick_s = self.bank.hop_s() / TICKS_PER_HOP as f64;
        Chunk { channels, series, start_s: self.start_s, tick_s, ticks, noise_variances }
    }

    /// Drops the first ticks in `series`.
    fn drop_ticks(&mut self, ticks: usize) {
        for (channel, series) in self.bank.channels.iter().zip(&mut self.series) {
            let samples = (ticks * channel.hop_samples / TICKS_PER_HOP).min(series.len());
            series.drain(..samples);
        }
        self.start_s += ticks as f64 * self.tick_s();
    }

    /// Whole hops in `series`.
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

/// Sum of squares in eight sums, which the compiler turns into vector instructions.
fn sum_of_squares(samples: &[f32]) -> f64 {
    let (eights, rest) = samples.as_chunks::<8>();
    let mut sums = [0.0; 8];
    for eight in eights {
        sums.iter_mut().zip(eight).for_each(|(sum, sample)| *sum += f64::from(sample * sample));
    }
    sums.iter().sum::<f64>() + rest.iter().map(|sample| f64::from(sample * sample)).sum::<f64>()
}
