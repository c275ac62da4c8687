//! Spectra of all lines in short frames, turned back by a speed that all rotors share, so that what is left of each rotor is how
//! far it is from that.

use crate::harmonic::chunks::Chunk;
use crate::harmonic::demodulation::{LinePhasors, LinePlace};
use crate::harmonic::frame_transform::FrameTransform;
use crate::harmonic::speed_path::{SpeedPath, SpeedPoint};
use hovertone_signal::channels::TICKS_PER_HOP;
use hovertone_signal::fft::ComplexPlanner;
use realfft::num_complex::Complex;
use std::f64::consts::TAU;

/// Ticks from one frame to the next: 0.04 s. *Numeric.*
pub(super) const FRAME_TICKS: usize = TICKS_PER_HOP / 2;
/// Denominators of Lagrange's weights of six places. *Numeric.*
const LAGRANGE_DENOMINATORS: [f64; 6] = [-120.0, 24.0, -12.0, 12.0, -24.0, 120.0];
/// Bins are half a resolution cell apart. *Numeric.*
const ZERO_PAD_FACTOR: usize = 2;

/// The frames of one line.
pub(super) struct LineSpectra {
    pub(super) order: f64,
    /// Length of a frame.
    pub(super) frame_s: f64,
    /// Bins to either side of the shared speed.
    half_bins: usize,
    /// Frame by frame, from the lowest frequency to the highest; squares are likelihoods. Phases are those in the middle of the
    /// frame.
    bins: Vec<Complex<f32>>,
}

/// All lines over a chunk.
pub(super) struct Spectra {
    pub(super) lines: Vec<LineSpectra>,
    /// Speed that all rotors share, in the middle of each frame.
    pub(super) common_rev_s: Vec<f64>,
    frames_apart: usize,
    length_s: f64,
}

/// Middle of a frame, in ticks.
pub(super) fn frame_middle_ticks(frame: usize) -> usize {
    frame * FRAME_TICKS + FRAME_TICKS / 2
}

/// Half the length of a frame in whole ticks.
pub(super) fn half_frame_ticks(frame_s: f64, tick_s: f64) -> usize {
    (frame_s / tick_s / 2.0).round().max(1.0) as usize
}

impl Spectra {
    /// Frames along a common path, of a length for each order; every so many'th only.
    pub(super) fn along(
        chunk: &Chunk<'_>,
        series: &[&[Complex<f32>]],
        common: &SpeedPath,
        frame_s_of_order: impl Fn(f64) -> f64,
        frames_apart: usize,
        planner: &mut ComplexPlanner,
    ) -> Self {
        let frames = (chunk.ticks / FRAME_TICKS).div_ceil(frames_apart);
        let lines = chunk
            .channels
            .iter()
            .zip(series)
            .zip(&chunk.noise_variances)
            .map(|((channel, series), noise_variance)| {
                let samples_per_tick = channel.hop_samples / TICKS_PER_HOP;
                let ticks = 2 * half_frame_ticks(frame_s_of_order(channel.order), chunk.tick_s);
                let length = ticks * samples_per_tick;
                // nothing before the first frame and after the last
                let mut turned = vec![Complex::default(); length];
                turned.extend(turned_back(series, LinePlace::of_channel(channel), common, samples_per_tick));
                turned.resize(turned.len() + length, Complex::default());
                let mut transform = FrameTransform::new(length, ZERO_PAD_FACTOR, planner);
                let scale = 1.0 / (transform.energy * noise_variance).sqrt();
                let count = ZERO_PAD_FACTOR * length;
                let to_middle: Vec<Complex<f32>> = (0..count)
                    .map(|index| {
                        let bin = index as f64 - (count / 2) as f64;
                        let phase = TAU * bin / count as f64 * (length as f64 - 1.0) / 2.0;
                        Complex::new((scale * phase.cos()) as f32, (scale * phase.sin()) as f32)
                    })
                    .collect();
                let mut bins = Vec::with_capacity(frames * count);
                for frame in 0..frames {
                    let start = length + frame_middle_ticks(frame * frames_apart) * samples_per_tick - length / 2;
                    let (rising, negative) = transform.spectrum(&turned[start..]).split_at(count / 2);
                    let (lower, upper) = to_middle.split_at(count / 2);
                    bins.extend(negative.iter().zip(lower).map(|(bin, turn)| bin * turn));
                    bins.extend(rising.iter().zip(upper).map(|(bin, turn)| bin * turn));
                }
                LineSpectra { order: channel.order, frame_s: ticks as f64 * chunk.tick_s, half_bins: count / 2, bins }
            })
            .collect();
        let middles = (0..frames).map(|frame| frame_middle_ticks(frame * frames_apart));
        let common_rev_s = middles.map(|tick| common.speed_rev_s(tick)).collect();
        Self { lines, common_rev_s, frames_apart, length_s: chunk.ticks as f64 * chunk.tick_s }
    }

    /// The middle of each frame.
    pub(super) fn middle_ticks(&self) -> impl Iterator<Item = usize> {
        (0..self.frames()).map(|frame| frame_middle_ticks(frame * self.frames_apart))
    }

    /// The path of what is so far from the shared speed in each frame.
    pub(super) fn path_at(&self, offsets_rev_s: &[f64], chunk: &Chunk<'_>) -> Option<SpeedPath> {
        let times_s = self.middle_ticks().map(|tick| tick as f64 * chunk.tick_s);
        let speeds = self.common_rev_s.iter().zip(offsets_rev_s).map(|(common, offset)| common + offset);
        let points: Vec<SpeedPoint> =
            times_s.zip(speeds).map(|(time_s, speed_rev_s)| SpeedPoint { time_s, speed_rev_s }).collect();
        SpeedPath::through(&points, chunk.tick_s, chunk.ticks)
    }

    /// Frames from one to the next.
    pub(super) fn frames_apart(&self) -> usize {
        self.frames_apart
    }

    pub(super) fn frames(&self) -> usize {
        self.common_rev_s.len()
    }

    /// How long all frames last together.
    pub(super) fn length_s(&self) -> f64 {
        self.length_s
    }
}

#[cfg(test)]
impl Spectra {
    /// One line of order 1 along a speed of 0, in frames of 0.2 s that do not overlap.
    pub(super) fn of_line(frames: &[Vec<Complex<f32>>]) -> Self {
        let half_bins = frames.first().map_or(0, |frame| frame.len() / 2);
        let frame_s = 0.2;
        let length_s = frame_s * frames.len() as f64;
        let line = LineSpectra { order: 1.0, frame_s, half_bins, bins: frames.concat() };
        Self { lines: vec![line], common_rev_s: vec![0.0; frames.len()], frames_apart: 1, length_s }
    }
}

impl LineSpectra {
    /// Bins of a frame.
    pub(super) fn frame_bins(&self) -> usize {
        2 * self.half_bins
    }

    pub(super) fn frame(&self, frame: usize) -> &[Complex<f32>] {
        &self.bins[2 * frame * self.half_bins..2 * (frame + 1) * self.half_bins]
    }

    /// Where in a frame's bins lies what is so many resolution cells from the shared speed.
    pub(super) fn bin_of(&self, cells: f64) -> f64 {
        ZERO_PAD_FACTOR as f64 * cells + self.half_bins as f64
    }

    /// Resolution cells of a bin from the shared speed.
    pub(super) fn cells_of(&self, bin: usize) -> f64 {
        (bin as f64 - self.half_bins as f64) / ZERO_PAD_FACTOR as f64
    }

    /// The same in halves of a cell.
    pub(super) fn half_cells_of(&self, bin: usize) -> i32 {
        bin as i32 - self.half_bins as i32
    }

    /// The spectrum between its bins, by the polynomial through the six around; `None` beyond the edge.
    pub(super) fn at(&self, frame: usize, cells: f64) -> Option<Complex<f64>> {
        let place = self.bin_of(cells);
        let bin = place.floor();
        let t = place - bin;
        let bins = self.frame(frame);
        let first = (bin as usize).checked_sub(2).filter(|first| place >= 2.0 && first + 6 <= bins.len())?;
        // Lagrange's weights of the places -2 … 3 at t
        let (a, b, c, d, e, f) = (t + 2.0, t + 1.0, t, t - 1.0, t - 2.0, t - 3.0);
        let products = [
            b * c * d * e * f,
            a * c * d * e * f,
            a * b * d * e * f,
            a * b * c * e * f,
            a * b * c * d * f,
            a * b * c * d * e,
        ];
        let weights = products.into_iter().zip(LAGRANGE_DENOMINATORS).map(|(product, below)| product / below);
        let near = bins[first..first + 6].iter().zip(weights);
        Some(near.map(|(z, weight)| Complex::new(f64::from(z.re), f64::from(z.im)) * weight).sum())
    }
}

/// A channel, turned back by its order times the angle of a path.
fn turned_back(
    series: &[Complex<f32>],
    place: LinePlace,
    path: &SpeedPath,
    samples_per_tick: usize,
) -> Vec<Complex<f32>> {
    let mut turned = phasors(place, path, samples_per_tick, series.len());
    turned.iter_mut().zip(series).for_each(|(phasor, z)| *phasor = z * phasor.conj());
    turned
}

/// The phasors of a line at every sample of a channel.
pub(super) fn phasors(
    place: LinePlace,
    path: &SpeedPath,
    samples_per_tick: usize,
    samples: usize,
) -> Vec<Complex<f32>> {
    let mut phasors = LinePhasors::new(place, path, samples_per_tick);
    let mut all = vec![Complex::default(); samples];
    for of_tick in all.chunks_exact_mut(samples_per_tick) {
        phasors.take_tick(|sample, phasor| of_tick[sample] = Complex::new(phasor.re as f32, phasor.im as f32));
    }
    all
}
