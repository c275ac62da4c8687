//! Sound → power over the local floor, in short and long frames, in bounded memory and time.

use super::floor::{Floor, FloorShape, FloorSums};
use super::level_table::{Level, LevelTable, UNKNOWN};
use super::near_floor::{NearFloor, levels_over};
use super::pauses::{drop_rests, quiet_frames};
use super::rounding::Rounding;
use crate::thresholds::STEADY_FRAME_S;
use hovertone_signal::spectrogram::{Stft, Window};
use hovertone_signal::{RECORDED_RATE_SHARE, SteadyLines};
use std::f64::consts::{LN_2, PI};
use std::ops::Range;
use std::sync::Arc;

/// Length of a short frame, s. Most rotors in flight are clearest in 0.1 s: their speeds wander by 1 to 3 %. *Decision.*
const SHORT_S: f64 = 0.1;
/// Length of a long frame, s. Steady rotors, and several at once, are clearest in 0.4 s.
pub(super) const LONG_S: f64 = STEADY_FRAME_S;
/// Step between short frames, s. *Numeric.*
pub(super) const HOP_S: f64 = 0.05;
/// Steps between short frames to a step between long ones. *Numeric.*
const LONG_HOPS: u32 = 2;
/// Bins to the resolution of a frame. *Numeric.*
const ZERO_PAD_FACTOR: u32 = 4;
/// Noise that is added to power and floor, as a share of the mean power of the frame: codecs leave holes in the spectrum. *Numeric.*
const ADDED_NOISE_SHARE: f64 = 1e-7;
/// Bins to either side whose highest decides whether a bin is a skirt: half a resolution, well within the main lobe of a line. *Numeric.*
const SKIRT_BINS: usize = 2;
/// Share of the highest of these below which a bin is a skirt of it, and counts as noise at most. *Numeric.*
const SKIRT_SHARE: f64 = 0.5;
/// Distances at which the side lobes of a line are looked for, in bins: from the end of its main lobe. *Numeric.*
const SIDE_LOBES: Range<usize> = 8..40;
/// A side lobe may be higher than that of a steady line by this factor, because the line moves. *Decision.*
const SIDE_LOBE_MARGIN: f64 = 2.0;
/// Length of a section, s: long recordings are heard in sections with gaps between. *Numeric.*
const SECTION_S: f64 = 1.0;
/// Largest number of sections. *Numeric.*
const SECTIONS_MAX: usize = 32;

/// Two looks at the same sound.
#[derive(Clone, Debug, Default)]
pub(crate) struct Looks {
    /// In short frames.
    pub(crate) short: Excess,
    /// In long frames.
    pub(crate) long: Excess,
}

/// Power over the local floor.
#[derive(Clone, Debug, Default)]
pub(crate) struct Excess {
    /// Distance between bins, Hz.
    pub(crate) bin_hz: f64,
    /// The frames in order of time; quiet ones are left out.
    pub(crate) frames: Vec<ExcessFrame>,
    /// The floor of the whole recording.
    pub(super) floor: Arc<FloorShape>,
    /// The same of the near floor.
    near_floor: Arc<FloorShape>,
}

/// One frame.
#[derive(Clone, Debug)]
pub(crate) struct ExcessFrame {
    /// Middle of the frame on the recording's clock, s.
    pub(crate) centre_s: f64,
    /// Power over the floor of each bin, as a [`Level`]. Shared, because part of the frames are looked at again.
    pub(super) levels: Arc<[Level]>,
    /// The near floor over the floor, in steps of a level, see [`NearFloor`].
    near_floor: Arc<[i8]>,
    pub(super) mean_power: f64,
}

#[cfg(test)]
impl Excess {
    /// Frames that all have these levels over a flat floor.
    pub(super) fn of_levels(bin_hz: f64, hop_s: f64, frames: u32, levels: &[Level]) -> Self {
        let levels: Arc<[Level]> = levels.into();
        let frame = |index: u32| ExcessFrame {
            centre_s: hop_s * f64::from(index),
            levels: Arc::clone(&levels),
            near_floor: Arc::default(),
            mean_power: 1.0,
        };
        Self { bin_hz, frames: (0..frames).map(frame).collect(), ..Self::default() }
    }
}

impl Excess {
    /// The frames whose middle is in one of these spans of time.
    pub(crate) fn within(&self, spans_s: &[Range<f64>]) -> Self {
        let is_within = |frame: &ExcessFrame| spans_s.iter().any(|span_s| span_s.contains(&frame.centre_s));
        self.with_levels(|frame| is_within(frame).then(|| Arc::clone(&frame.levels)))
    }

    /// The quieter frames, in which a voice pauses.
    pub(crate) fn quieter(&self) -> Self {
        let is_quiet = quiet_frames(&self.frames);
        let frames = self.frames.iter().zip(is_quiet).filter(|(_, is_quiet)| *is_quiet).map(|(frame, _)| frame.clone());
        self.with_frames(frames.collect())
    }

    /// Other frames of the same sound.
    fn with_frames(&self, frames: Vec<ExcessFrame>) -> Self {
        let [floor, near_floor] = [&self.floor, &self.near_floor].map(Arc::clone);
        Self { bin_hz: self.bin_hz, frames, floor, near_floor }
    }

    /// The frames for which there are levels, with these levels.
    pub(super) fn with_levels(&self, levels_of: impl Fn(&ExcessFrame) -> Option<Arc<[Level]>>) -> Self {
        let with = |frame: &ExcessFrame| Some(ExcessFrame { levels: levels_of(frame)?, ..frame.clone() });
        self.with_frames(self.frames.iter().filter_map(with).collect())
    }

    /// The same frames over the near floor. An echo makes waves in the spectrum of noise; the wide floor leaves their crests as lines.
    pub(super) fn over_near_floor(&self) -> Self {
        let over = |frame: &ExcessFrame| ExcessFrame {
            levels: levels_over(&frame.levels, &frame.near_floor, self.bin_hz),
            ..frame.clone()
        };
        let frames = self.frames.iter().map(over).collect();
        let [floor, near_floor] = [&self.near_floor; 2].map(Arc::clone);
        Self { bin_hz: self.bin_hz, frames, floor, near_floor }
    }

    /// Resolution of a frame, Hz.
    pub(super) fn resolution_hz(&self) -> f64 {
        f64::from(ZERO_PAD_FACTOR) * self.bin_hz
    }

    /// Time from the first frame to the end of the last one, where frames are long.
    pub(crate) fn length_s(&self) -> f64 {
        let ends = self.frames.first().zip(self.frames.last());
        ends.map_or(0.0, |(first, last)| last.centre_s - first.centre_s + LONG_S)
    }

    /// Number of short hops from each frame to the next. The first is 1.
    pub(crate) fn hops(&self) -> Vec<usize> {
        let hops = self.frames.windows(2).map(|pair| ((pair[1].centre_s - pair[0].centre_s) / HOP_S).round() as usize);
        std::iter::once(1).chain(hops.map(|hops| hops.max(1))).collect()
    }
}

impl ExcessFrame {
    /// Whether the band has a line at a frequency, where bins are `bin_hz` apart.
    pub(super) fn holds(&self, hz: f64, bin_hz: f64) -> bool {
        ((hz / bin_hz + 0.5) as usize) + 2 <= self.levels.len()
    }

    /// The highest level within a bin of a frequency, where bins are `bin_hz` apart. `None` outside the band, and where lines are left out of the
    /// sound.
    pub(super) fn level_near(&self, hz: f64, bin_hz: f64) -> Option<Level> {
        let bin = (hz / bin_hz + 0.5) as usize;
        self.levels.get(bin.saturating_sub(1)..bin + 2)?.iter().copied().max().filter(|level| *level != UNKNOWN)
    }
}

/// Keeps sections of a stream of samples. Where a recording is longer than the sections that are kept, every second section is dropped and
/// the gaps double.
pub(crate) struct ExcessBuilder {
    start_s: f64,
    sample_rate_hz: f64,
    hz_max: f64,
    /// Samples that were pushed.
    samples: usize,
    /// Sections from one that is kept to the next.
    stride: usize,
    sections: Vec<Section>,
    rounding: Rounding,
    /// Lines that are left out of the sound.
    left_out: Option<SteadyLines>,
}

struct Section {
    index: usize,
    samples: Vec<f32>,
}

impl ExcessBuilder {
    /// Sections of a recording that starts at `start_s`, up to a highest frequency, where these lines are left out of the sound.
    pub(crate) fn new(sample_rate_hz: f64, start_s: f64, hz_max: f64, left_out: Option<SteadyLines>) -> Self {
        let hz_max = hz_max.min(RECORDED_RATE_SHARE * sample_rate_hz);
        let rounding = Rounding::default();
        Self { start_s, sample_rate_hz, hz_max, samples: 0, stride: 1, sections: Vec::new(), rounding, left_out }
    }

    fn section_samples(&self) -> usize {
        (SECTION_S * self.sample_rate_hz) as usize
    }

    pub(crate) fn push(&mut self, mut samples: &[f32]) {
        let section_samples = self.section_samples();
        while !samples.is_empty() {
            let index = self.samples / section_samples;
            let (now, later) = samples.split_at(samples.len().min((index + 1) * section_samples - self.samples));
            if index.is_multiple_of(self.stride) {
                self.keep(index, now);
            }
            self.samples += now.len();
            samples = later;
        }
    }

    fn keep(&mut self, index: usize, samples: &[f32]) {
        self.rounding.take(samples);
        match self.sections.last_mut().filter(|section| section.index == index) {
            Some(section) => section.samples.extend_from_slice(samples),
            None => self.sections.push(Section { index, samples: samples.to_vec() }),
        }
        if index / self.stride >= SECTIONS_MAX {
            self.stride *= 2;
            let stride = self.stride;
            self.sections.retain(|section| section.index.is_multiple_of(stride));
        }
    }

    /// The sections in frames of both lengths. Each section is freed once it is in frames.
    pub(crate) fn finish(self) -> Looks {
        let section_samples = self.section_samples();
        let mut short = Frames::new(&self, SHORT_S, HOP_S, false);
        let mut long = Frames::new(&self, LONG_S, f64::from(LONG_HOPS) * HOP_S, true);
        let mut next = None;
        for Section { index, samples } in self.sections {
            let start_s = self.start_s + (index * section_samples) as f64 / self.sample_rate_hz;
            let start_s = (next != Some(index)).then_some(start_s);
            short.push(&samples, start_s);
            long.push(&samples, start_s);
            next = Some(index + 1);
        }
        Looks { short: short.finish(), long: long.finish() }
    }
}

/// Sections of sound → frames of one length.
struct Frames {
    stft: Stft<f32>,
    /// Number of bins in the band.
    bins: usize,
    /// Bins in which lines are left out of the sound.
    left_out: Vec<usize>,
    floor: Floor,
    /// Power of a line that rounding makes.
    rounding_power: f64,
    floors: FloorSums,
    /// Of long frames only.
    near_floor: Option<NearFloor>,
    near_floors: FloorSums,
    levels: LevelTable,
    frames: Vec<ExcessFrame>,
}

impl Frames {
    fn new(sound: &ExcessBuilder, frame_s: f64, hop_s: f64, has_near_floor: bool) -> Self {
        let stft = Stft::<f32>::new(sound.sample_rate_hz, Window::Hann, frame_s, hop_s, ZERO_PAD_FACTOR);
        let (bin_hz, bins) = (stft.bin_hz(), (sound.hz_max / stft.bin_hz()) as usize);
        let is_left_out = |bin: &usize| sound.left_out.as_ref().is_some_and(|lines| lines.hold(*bin as f64 * bin_hz));
        Self {
            bins,
            left_out: (0..bins).filter(is_left_out).collect(),
            floor: Floor::of_bins(stft.bin_hz()),
            rounding_power: sound.rounding.line_power(),
            floors: FloorSums::default(),
            near_floor: has_near_floor.then(|| NearFloor::of_bins(stft.bin_hz())),
            near_floors: FloorSums::default(),
            levels: LevelTable::new(),
            frames: Vec::new(),
            stft,
        }
    }

    /// Takes in a section. Where it does not follow the last one, its start is given.
    fn push(&mut self, samples: &[f32], start_s: Option<f64>) {
        let Self { stft, bins, left_out, floor, rounding_power, floors, near_floor, near_floors, levels, frames } =
            self;
        if let Some(start_s) = start_s {
            stft.restart(start_s);
        }
        let bin_hz = stft.bin_hz();
        stft.push(samples, |frame| {
            let mean_power = frame.power.iter().sum::<f64>() / frame.power.len() as f64;
            let added = (ADDED_NOISE_SHARE * mean_power).max(*rounding_power).max(f64::MIN_POSITIVE);
            let power = &frame.power[..frame.power.len().min(*bins)];
            let under = floor.of(power);
            floors.add(&under, added, bin_hz);
            let near_floor = near_floor.as_mut().map_or_else(Arc::default, |near_floor| {
                let near = near_floor.of(power);
                near_floors.add_points(&near, added);
                near_floor.over(&near, &under, added)
            });
            let excess = over_floor(power, &under, added);
            let mut levels: Vec<Level> = excess.into_iter().map(|excess| levels.of(excess)).collect();
            for &bin in &*left_out {
                if let Some(level) = levels.get_mut(bin) {
                    *level = UNKNOWN;
                }
            }
            frames.push(ExcessFrame { centre_s: frame.centre_s, levels: levels.into(), near_floor, mean_power });
        });
    }

    /// The frames without quiet ones.
    fn finish(self) -> Excess {
        let bin_hz = self.stft.bin_hz();
        let mut frames = self.frames;
        drop_rests(&mut frames);
        let [floor, near_floor] = [self.floors, self.near_floors].map(|floors| Arc::new(floors.shape()));
        Excess { bin_hz, frames, floor, near_floor }
    }
}

/// Power over the floor, with noise added to both. A skirt or a side lobe of a line counts as noise at most.
fn over_floor(power: &[f64], floors: &[f64], added: f64) -> Vec<f64> {
    // the median of noise is ln 2 of its mean
    let over = |(power, floor): (&f64, &f64)| (power + added) / (floor / LN_2 + added);
    let excess: Vec<f64> = power.iter().zip(floors).map(over).collect();
    let limits = skirt_limits(&excess);
    let without_skirts = |(&excess, limit): (&f64, f64)| if excess < limit { excess.min(1.0) } else { excess };
    excess.iter().zip(limits).map(without_skirts).collect()
}

/// For each bin, the power over the floor below which it is a skirt or a side lobe of a line nearby.
fn skirt_limits(excess: &[f64]) -> Vec<f64> {
    let highest_near = |bin: usize| {
        let near = bin.saturating_sub(SKIRT_BINS)..(bin + SKIRT_BINS + 1).min(excess.len());
        excess[near].iter().copied().fold(0.0, f64::max)
    };
    let mut limits: Vec<f64> = (0..excess.len()).map(|bin| SKIRT_SHARE * highest_near(bin)).collect();
    let side_lobes: Vec<(usize, f64)> =
        SIDE_LOBES.map(|bins| (bins, side_lobe_share(bins as f64 / f64::from(ZERO_PAD_FACTOR)))).collect();
    let Some(&(_, most)) = side_lobes.first() else { return limits };
    for (peak, &power) in excess.iter().enumerate().filter(|(_, power)| **power * most > 1.0) {
        // a limit below the noise changes nothing
        let limited = side_lobes.iter().map(|(bins, share)| (bins, SIDE_LOBE_MARGIN * share * power));
        for (bins, own_limit) in limited.take_while(|(_, limit)| *limit > 1.0) {
            for bin in [peak.checked_sub(*bins), Some(peak + bins)].into_iter().flatten() {
                if let Some(limit) = limits.get_mut(bin) {
                    *limit = limit.max(own_limit);
                }
            }
        }
    }
    limits
}

/// Largest share of the power of a line that a Hann window leaves so many resolutions beside it.
fn side_lobe_share(resolutions: f64) -> f64 {
    (PI * resolutions * (resolutions * resolutions - 1.0)).powi(-2)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::evidence::level_table::level_db;

    #[test]
    fn a_long_recording_keeps_a_bounded_number_of_sections() {
        let mut builder = ExcessBuilder::new(2000.0, 3.0, 1e4, None);
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
        let excess = builder.finish().short;
        assert!((300..=640).contains(&excess.frames.len()), "{}", excess.frames.len());
        assert!(excess.frames.first().is_some_and(|frame| frame.centre_s < 3.2));
        assert!(excess.frames.last().is_some_and(|frame| frame.centre_s > 180.0));
        assert!(excess.hops().iter().any(|&hops| hops > 20));
        // noise has the mean 1, less what skirts lose
        let levels: Vec<Level> = excess.frames.iter().flat_map(|frame| frame.levels.iter().copied()).collect();
        let power = |level: Level| 10f64.powf(level_db(f64::from(level)) / 10.0);
        let mean = levels.iter().map(|&level| power(level)).sum::<f64>() / levels.len() as f64;
        assert!((0.7..1.2).contains(&mean), "{mean}");
    }
}
