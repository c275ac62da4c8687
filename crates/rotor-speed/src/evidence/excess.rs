//! Sound → power over the local floor, in short frames, in bounded memory.

use hovertone_signal::spectrogram::{Stft, Window};
use hovertone_signal::statistics::median;
use std::collections::VecDeque;
use std::f64::consts::LN_2;

/// Length of a frame, s. Most rotors are clearest in 0.1 s: their speeds wander by 1 to 3 % in flight. *Decision.*
const FRAME_S: f64 = 0.1;
/// Step between frames, s. *Numeric.*
const HOP_S: f64 = 0.05;
/// Bins to the resolution of a frame. *Numeric.*
const ZERO_PAD_FACTOR: u32 = 4;
/// Highest frequency, Hz: lines of small rotors are audible to their twelfth blade pass. *Decision.*
const HZ_MAX: f64 = 9000.0;
/// Highest frequency as a share of the sample rate: filters of recorders end below one half. *Decision.*
const RATE_SHARE_MAX: f64 = 0.45;
/// Width of the running median of the floor, Hz: wider than several lines of a small rotor's comb, narrower than the slope of noise.
/// *Decision.*
const FLOOR_HZ: f64 = 120.0;
/// Lowest floor as a share of the mean power of the frame: codecs leave holes in the spectrum. *Numeric.*
const FLOOR_SHARE_MIN: f64 = 1e-7;
/// Bins to either side among which a line is the highest: the main lobe of the window. *Numeric.*
const LOBE_BINS: usize = 2;
/// Share of the highest neighbour below which a bin is a skirt of it, and counts as noise at most. *Numeric.*
const SKIRT_SHARE: f32 = 0.5;
/// Share of the median power of the frames below which a frame is silent. *Decision.*
const SILENT_SHARE: f64 = 1e-4;
/// Length of a section, s: long recordings are heard in sections with gaps between. *Numeric.*
const SECTION_S: f64 = 1.0;
/// Largest number of sections. *Numeric.*
const SECTIONS_MAX: usize = 32;

/// Power over the local floor.
#[derive(Clone, Debug, Default)]
pub(crate) struct Excess {
    /// Distance between bins, Hz.
    pub(crate) bin_hz: f64,
    /// The frames in order of time; silent ones are left out.
    pub(crate) frames: Vec<ExcessFrame>,
}

/// One frame.
#[derive(Clone, Debug)]
pub(crate) struct ExcessFrame {
    /// Middle of the frame on the recording's clock, s.
    pub(crate) centre_s: f64,
    /// Power over the floor of each bin.
    pub(crate) power: Vec<f32>,
    mean_power: f64,
    section: usize,
}

impl Excess {
    /// Number of hops from each frame to the next: 1 without a gap. The first is 1.
    pub(crate) fn hops(&self) -> Vec<usize> {
        let hops = self.frames.windows(2).map(|pair| ((pair[1].centre_s - pair[0].centre_s) / HOP_S).round() as usize);
        std::iter::once(1).chain(hops.map(|hops| hops.max(1))).collect()
    }
}

/// Builds the frames from a stream of samples. Where a recording is longer than the sections that are kept, every second section is dropped
/// and the gaps double.
pub(crate) struct ExcessBuilder {
    stft: Stft<f32>,
    start_s: f64,
    sample_rate_hz: f64,
    samples: usize,
    stride: usize,
    is_listening: bool,
    floor: RunningMedian,
    bins: usize,
    frames: Vec<ExcessFrame>,
}

impl ExcessBuilder {
    /// Frames of a recording that starts at `start_s`.
    pub(crate) fn new(sample_rate_hz: f64, start_s: f64) -> Self {
        let mut stft = Stft::new(sample_rate_hz, Window::Hann, FRAME_S, HOP_S, ZERO_PAD_FACTOR);
        stft.restart(start_s);
        let bins = (HZ_MAX.min(RATE_SHARE_MAX * sample_rate_hz) / stft.bin_hz()) as usize;
        let floor = RunningMedian::of_width((FLOOR_HZ / stft.bin_hz()) as usize | 1);
        Self {
            stft,
            start_s,
            sample_rate_hz,
            samples: 0,
            stride: 1,
            is_listening: true,
            floor,
            bins,
            frames: Vec::new(),
        }
    }

    pub(crate) fn push(&mut self, mut samples: &[f32]) {
        let section_samples = (SECTION_S * self.sample_rate_hz) as usize;
        while !samples.is_empty() {
            let section = self.samples / section_samples;
            let (now, later) = samples.split_at(samples.len().min((section + 1) * section_samples - self.samples));
            let is_wanted = section.is_multiple_of(self.stride);
            if is_wanted && !self.is_listening {
                self.stft.restart(self.start_s + self.samples as f64 / self.sample_rate_hz);
            }
            if is_wanted {
                self.hear(now, section);
            }
            self.is_listening = is_wanted;
            self.samples += now.len();
            samples = later;
        }
    }

    fn hear(&mut self, samples: &[f32], section: usize) {
        let Self { stft, floor, bins, frames, .. } = self;
        let bins = *bins;
        stft.push(samples, |frame| {
            let mean_power = frame.power.iter().sum::<f64>() / frame.power.len() as f64;
            let power = over_floor(&frame.power[..bins.min(frame.power.len())], floor, mean_power);
            frames.push(ExcessFrame { centre_s: frame.centre_s, power, mean_power, section });
        });
        let kept = section / self.stride + 1;
        if kept > SECTIONS_MAX {
            self.stride *= 2;
            let stride = self.stride;
            self.frames.retain(|frame| frame.section.is_multiple_of(stride));
        }
    }

    pub(crate) fn finish(self) -> Excess {
        let mut frames = self.frames;
        let powers: Vec<f64> = frames.iter().map(|frame| frame.mean_power).collect();
        let power_min = SILENT_SHARE * median(&powers).unwrap_or(0.0);
        frames.retain(|frame| frame.mean_power > power_min);
        Excess { bin_hz: self.stft.bin_hz(), frames }
    }
}

/// Power over the floor. A skirt of a line counts as noise at most.
fn over_floor(power: &[f64], floor: &mut RunningMedian, mean_power: f64) -> Vec<f32> {
    let lowest = (FLOOR_SHARE_MIN * mean_power).max(f64::MIN_POSITIVE);
    // the median of noise is ln 2 of its mean
    let floors = floor.of(power);
    let excess: Vec<f32> =
        power.iter().zip(floors).map(|(power, floor)| (power / (floor / LN_2).max(lowest)) as f32).collect();
    let highest_near = |bin: usize| {
        let near = bin.saturating_sub(LOBE_BINS)..(bin + LOBE_BINS + 1).min(excess.len());
        excess[near].iter().copied().fold(0.0, f32::max)
    };
    (0..excess.len())
        .map(|bin| if excess[bin] >= SKIRT_SHARE * highest_near(bin) { excess[bin] } else { excess[bin].min(1.0) })
        .collect()
}

/// Median of a window that runs over a series; at the ends the window holds the values that there are.
struct RunningMedian {
    width: usize,
    window: VecDeque<f64>,
    sorted: Vec<f64>,
}

impl RunningMedian {
    fn of_width(width: usize) -> Self {
        Self { width, window: VecDeque::new(), sorted: Vec::new() }
    }

    fn of(&mut self, values: &[f64]) -> Vec<f64> {
        self.window.clear();
        self.sorted.clear();
        let half = self.width / 2;
        values.iter().take(half).for_each(|&value| self.add(value));
        (0..values.len())
            .map(|middle| {
                if let Some(&value) = values.get(middle + half) {
                    self.add(value);
                }
                if middle > half {
                    self.drop_first();
                }
                self.sorted[self.sorted.len() / 2]
            })
            .collect()
    }

    fn add(&mut self, value: f64) {
        self.window.push_back(value);
        self.sorted.insert(self.sorted.partition_point(|&other| other < value), value);
    }

    fn drop_first(&mut self) {
        if let Some(value) = self.window.pop_front() {
            self.sorted.remove(self.sorted.partition_point(|&other| other < value));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_running_median_is_that_of_the_values_around() {
        let values: Vec<f64> = (0..40).map(|n| f64::from((n * 7919) % 101)).collect();
        let found = RunningMedian::of_width(7).of(&values);
        for (middle, found) in found.iter().enumerate() {
            let mut near = values[middle.saturating_sub(3)..(middle + 4).min(values.len())].to_vec();
            near.sort_by(f64::total_cmp);
            assert_eq!(*found, near[near.len() / 2], "at {middle}");
        }
    }

    #[test]
    fn a_long_recording_keeps_a_bounded_number_of_sections() {
        let mut builder = ExcessBuilder::new(2000.0, 3.0);
        let mut noise = 1u64;
        for _ in 0..200 {
            let second: Vec<f32> = (0..2000)
                .map(|_| {
                    noise = noise.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
                    (noise >> 40) as f32 / (1 << 23) as f32 - 1.0
                })
                .collect();
            builder.push(&second);
        }
        let excess = builder.finish();
        assert!((300..=640).contains(&excess.frames.len()), "{}", excess.frames.len());
        assert!(excess.frames.first().is_some_and(|frame| frame.centre_s < 3.2));
        assert!(excess.frames.last().is_some_and(|frame| frame.centre_s > 180.0));
        assert!(excess.hops().iter().any(|&hops| hops > 20));
        // noise has the mean 1, less what skirts lose
        let mean = excess.frames.iter().flat_map(|frame| &frame.power).sum::<f32>()
            / excess.frames.iter().map(|frame| frame.power.len()).sum::<usize>() as f32;
        assert!((0.7..1.2).contains(&mean), "{mean}");
    }
}
