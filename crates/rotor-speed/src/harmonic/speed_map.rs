//! A rough path of the speed: the score of all lines together on a grid of speeds in each frame, and the best path through the scores.

use super::best_path::best_path;
use super::frame_transform::FrameTransform;
use super::speed_path::SpeedPoint;
use crate::thresholds::{MANY, MOST};
use hovertone_signal::channels::Channel;
use hovertone_signal::fft::ComplexPlanner;
use hovertone_signal::statistics::{mean, median};
use hovertone_vehicle::BLADES_MAX;
use realfft::num_complex::Complex;

/// Length of a frame of the map, in hops of the filter bank: 0.17 s. *Numeric.*
pub(crate) const FRAME_HOPS: usize = 2;
/// Grid points in a resolution cell of the highest line; the main lobe of a Hann frame is four cells wide. *Numeric.*
const GRID_PER_CELL: f64 = 1.5;
/// Smallest number of steps of the grid. *Numeric.*
const GRID_STEPS_MIN: f64 = 3.0;
/// Largest number of steps of the grid. *Numeric.*
const GRID_STEPS_MAX: f64 = 1200.0;
/// Length of the transform in frames. *Numeric.*
const ZERO_PAD_FACTOR: usize = 2;
/// Standard deviation of the change of speed of a hover from one frame to the next, as a share of the speed. *Decision.*
const STEP_STD_SHARE: f64 = 0.01;
/// Smallest power over noise in a frame of a line that stands out in each of the four half hops of the frame. *Decision.*
pub(crate) const STRONG_POWER_MIN: f64 = 30.0;
/// Highest power that noise alone reaches in a band, over the mean power of noise. *Decision.*
const NOISE_PEAK_POWER: f64 = 8.0;
/// Smallest power beside the path, as a share of the strongest power in the band, at which another sound is in the band. *Decision.*
const MOST_BANDS_SHARE: f64 = 0.03;
/// Power of the sidebands of a gear mesh (one and two turns of the shaft away), as a share of the power of the mesh.
const SIDEBAND_SHARE: f64 = MANY;
/// Half width of the lobe of a line around the path, in resolution cells: the half lobe of a Hann frame and half a cell. *Numeric.*
const LOBE_CELLS: f64 = 2.5;
/// Smallest power that counts for the centroid of a frame, as a share of the highest power in the frame.
const CENTROID_SHARE_MIN: f32 = MOST as f32;
/// Equivalent noise bandwidth of the Hann window, in resolution cells (Harris, Proc. IEEE 66, 1978): a sine of amplitude A in a frame
/// of N samples with the noise variance V has J = A² N / (1.5 V). *Physics.*
pub(crate) const HANN_NOISE_CELLS: f64 = 1.5;

/// The powers of one line in the frames of a chunk. Each is a mean over the frames of a power over the mean power of noise.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LinePowers {
    /// Power on the path.
    pub(crate) on_path: f64,
    /// Highest power in the band of the line.
    pub(crate) in_band: f64,
    /// Highest power in the band outside the lobe around the path.
    pub(crate) off_path: f64,
}

/// The spectra of one line, and its place in them at each speed of the grid.
struct MapLine {
    order: f64,
    /// Whether no other line of the rotor reaches into the band.
    is_alone: bool,
    frames: FrameTransform,
    /// Amplitude of each bin, lowest frequency first, and a zero.
    amplitudes: Vec<f32>,
    /// Place of the line at each speed: the bin below, and the fraction of a bin from there.
    places: Vec<(u32, f32)>,
}

/// Scores of the speeds between two limits.
pub(crate) struct SpeedMap {
    lines: Vec<MapLine>,
    speeds_rev_s: Vec<f64>,
    /// Amplitude of each line at each speed in the last chunk, frame by frame. Kept because fresh memory costs as much time as
    /// filling it.
    amplitudes: Vec<f32>,
    /// Score of each speed in the last chunk, frame by frame.
    scores: Vec<f64>,
}

/// The path through a chunk.
pub(crate) struct MapPath {
    /// Speed in the middle of each frame.
    pub(crate) points: Vec<SpeedPoint>,
    /// Powers of each line.
    pub(crate) powers: Vec<LinePowers>,
    /// The speed that explains most of all frames together.
    pub(crate) steady_rev_s: f64,
    /// Power of other sounds in the bands of the strong lines, as a share of the strongest power there: mean over these lines. 0 where
    /// other sounds are in few bands.
    pub(crate) off_path_share: f64,
}

/// The sums of scores over the frames of a chunk.
struct Scored {
    /// Mean power of the loudest place of each line.
    in_band: Vec<f64>,
    /// Index of the speed with the greatest power in all frames together.
    steady: usize,
}

impl SpeedMap {
    /// A map of the speeds between two limits, for the lines of channels with hops of `hop_s`.
    pub(crate) fn new(
        channels: &[Channel],
        low_rev_s: f64,
        high_rev_s: f64,
        hop_s: f64,
        planner: &mut ComplexPlanner,
    ) -> Self {
        let (low, high) = (low_rev_s, high_rev_s);
        let order_max = channels.iter().map(|channel| channel.order).fold(1.0, f64::max);
        let frame_s = FRAME_HOPS as f64 * hop_s;
        let steps = ((high - low) * GRID_PER_CELL * order_max * frame_s).ceil().clamp(GRID_STEPS_MIN, GRID_STEPS_MAX);
        let step = (high - low) / steps;
        let speeds_rev_s: Vec<f64> = (0..=steps as usize).map(|index| low + step * index as f64).collect();
        let lines = channels
            .iter()
            .map(|channel| {
                let length = FRAME_HOPS * channel.hop_samples;
                let apart = channels
                    .iter()
                    .map(|other| (other.order - channel.order).abs())
                    .filter(|&apart| apart > 0.0)
                    .fold(channel.order, f64::min);
                MapLine {
                    order: channel.order,
                    is_alone: channel.order * (high - low) / 2.0 <= apart * low / 2.0,
                    amplitudes: vec![0.0; ZERO_PAD_FACTOR * length + 1],
                    places: places_of(channel, length, &speeds_rev_s),
                    frames: FrameTransform::new(length, ZERO_PAD_FACTOR, planner),
                }
            })
            .collect();
        Self { lines, speeds_rev_s, amplitudes: Vec::new(), scores: Vec::new() }
    }

    /// The lowest and the highest speed of the grid.
    pub(crate) fn limits_rev_s(&self) -> (f64, f64) {
        let last = self.speeds_rev_s.len() - 1;
        (self.speeds_rev_s[0], self.speeds_rev_s[last])
    }

    /// Number of amplitudes of one frame.
    fn frame_len(&self) -> usize {
        (self.speeds_rev_s.len() * self.lines.len()).max(1)
    }

    /// The best path through a chunk of channel samples, and the powers of each line along it.
    pub(crate) fn path_through(&mut self, series: &[&[Complex<f32>]], noise_variances: &[f64], hop_s: f64) -> MapPath {
        let points = self.speeds_rev_s.len();
        let Scored { in_band, steady } = self.score_frames(series, noise_variances);
        let step = self.speeds_rev_s[1] - self.speeds_rev_s[0];
        let middle = (self.speeds_rev_s[0] + self.speeds_rev_s[points - 1]) / 2.0;
        let scores: Vec<&[f64]> = self.scores.chunks_exact(points).collect();
        let path = best_path(&scores, STEP_STD_SHARE * middle / step);
        let powers = self.powers_along(&path, in_band, hop_s);
        let frame_s = FRAME_HOPS as f64 * hop_s;
        let points = path
            .iter()
            .enumerate()
            .map(|(frame, &place)| SpeedPoint {
                time_s: (frame as f64 + 0.5) * frame_s,
                speed_rev_s: self.speeds_rev_s[place],
            })
            .collect();
        let off_path_share = self.off_path_share(&powers);
        MapPath { points, powers, steady_rev_s: self.speeds_rev_s[steady], off_path_share }
    }

    /// Computes the amplitudes and scores of all frames of a chunk. The score of a speed is the sum of the amplitudes of all lines there.
    fn score_frames(&mut self, series: &[&[Complex<f32>]], noise_variances: &[f64]) -> Scored {
        let frames =
            self.lines.iter().zip(series).map(|(line, series)| series.len() / line.frames.length()).min().unwrap_or(0);
        let points = self.speeds_rev_s.len();
        let mut in_band = vec![0.0; self.lines.len()];
        let frame_len = self.frame_len();
        self.amplitudes.resize(frames * frame_len, 0.0);
        for (frame, on_grid) in self.amplitudes.chunks_exact_mut(frame_len).enumerate() {
            let rows = on_grid.chunks_exact_mut(points).zip(&mut in_band);
            for (((line, series), &noise), (row, in_band)) in
                self.lines.iter_mut().zip(series).zip(noise_variances).zip(rows)
            {
                line.transform(&series[frame * line.frames.length()..], noise);
                line.interpolate(row);
                *in_band += f64::from(highest(row).powi(2)) / frames as f64;
            }
        }
        // noise does not agree: one line beside it is all that is heard
        let is_one_line = in_band.iter().filter(|power| **power > NOISE_PEAK_POWER).count() == 1;
        let mut power = vec![0.0f32; points];
        let mut score = vec![0.0f32; points];
        self.scores.clear();
        for on_grid in self.amplitudes.chunks_exact(frame_len) {
            let peaks: Vec<f32> = on_grid.chunks_exact(points).map(highest).collect();
            let cap = if is_one_line { f32::INFINITY } else { second_largest(&peaks) };
            score.fill(0.0);
            for (row, &peak) in on_grid.chunks_exact(points).zip(&peaks) {
                // one loud tone in one band must not outvote several lines that agree
                let scale = if peak > cap { cap / peak } else { 1.0 };
                for ((sum, power), amplitude) in score.iter_mut().zip(&mut power).zip(row) {
                    let scaled = amplitude * scale;
                    *sum += scaled;
                    *power += scaled * scaled;
                }
            }
            self.scores.extend(score.iter().copied().map(f64::from));
        }
        let steady = (0..points).max_by(|&a, &b| power[a].total_cmp(&power[b])).unwrap_or(0);
        Scored { in_band, steady }
    }

    /// The powers of each line on and beside a path, which has one grid point for each frame.
    fn powers_along(&self, path: &[usize], in_band: Vec<f64>, hop_s: f64) -> Vec<LinePowers> {
        let points = self.speeds_rev_s.len();
        let step = self.speeds_rev_s[1] - self.speeds_rev_s[0];
        let frame_len = self.frame_len();
        let frames = self.amplitudes.len() / frame_len;
        let mut powers: Vec<LinePowers> =
            in_band.into_iter().map(|in_band| LinePowers { in_band, ..LinePowers::default() }).collect();
        for (&place, on_grid) in path.iter().zip(self.amplitudes.chunks_exact(frame_len)) {
            for ((powers, row), line) in powers.iter_mut().zip(on_grid.chunks_exact(points)).zip(&self.lines) {
                let lobe_points = LOBE_CELLS / (line.order * FRAME_HOPS as f64 * hop_s) / step;
                powers.on_path += f64::from(row[place].powi(2)) / frames as f64;
                if line.is_alone {
                    powers.off_path += power_off_path(row, place, lobe_points) / frames as f64;
                }
            }
        }
        powers
    }

    /// Power of other sounds in the bands of the strong lines, as [`MapPath::off_path_share`].
    fn off_path_share(&self, powers: &[LinePowers]) -> f64 {
        let strong: Vec<f64> = powers
            .iter()
            .zip(&self.lines)
            .filter(|(powers, line)| line.is_alone && powers.on_path > STRONG_POWER_MIN)
            .map(|(powers, line)| {
                let sidebands = if line.order > BLADES_MAX { SIDEBAND_SHARE * powers.in_band } else { 0.0 };
                (powers.off_path - NOISE_PEAK_POWER - sidebands).max(0.0) / powers.in_band
            })
            .collect();
        // a foreign sound falls into some bands, another rotor into most of the bands that resolve it
        let is_in_most = median(&strong).is_some_and(|share| share > MOST_BANDS_SHARE);
        mean(&strong).filter(|_| is_in_most).unwrap_or(0.0)
    }

    /// The centroid of each frame of the last chunk.
    pub(crate) fn centroids(&self, powers: &[LinePowers], noise_variances: &[f64]) -> Vec<Centroid> {
        self.amplitudes
            .chunks_exact(self.frame_len())
            .map(|on_grid| self.centroid(on_grid, powers, noise_variances))
            .collect()
    }

    /// Distribution of the power of a frame over speed: the sum over the strong lines whose band holds no other line of the rotor. Line o
    /// with the amplitude A in noise of density Φ has a lobe of width ~ 1/o, and so the weight A² / (Φ o).
    fn centroid(&self, on_grid: &[f32], powers: &[LinePowers], noise_variances: &[f64]) -> Centroid {
        let points = self.speeds_rev_s.len();
        let mut centroid = Centroid::default();
        let rows = on_grid.chunks_exact(points).zip(powers).zip(noise_variances);
        for (((row, powers), noise), line) in rows.zip(&self.lines) {
            if !line.is_alone || powers.on_path < STRONG_POWER_MIN {
                continue;
            }
            let peak = highest(row).powi(2);
            let amplitude_square = HANN_NOISE_CELLS * f64::from(peak) * noise / line.frames.length() as f64;
            centroid.strongest_power = centroid.strongest_power.max(amplitude_square);
            let floor = (CENTROID_SHARE_MIN * peak).max(NOISE_PEAK_POWER as f32);
            for (amplitude, speed) in row.iter().zip(&self.speeds_rev_s) {
                let power = amplitude * amplitude;
                if power > floor {
                    let energy = f64::from(power);
                    centroid.energy += energy;
                    centroid.first += energy * speed;
                    centroid.second += energy * speed * speed;
                }
            }
        }
        centroid
    }
}

/// Energy E of a frame over speed n, and its first and second moments Σ E n and Σ E n².
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Centroid {
    pub(crate) energy: f64,
    pub(crate) first: f64,
    pub(crate) second: f64,
    /// Power of the strongest line, 1 for a sine of full scale.
    pub(crate) strongest_power: f64,
}

/// The highest power of a row outside the lobe around the peak nearest to the path.
fn power_off_path(row: &[f32], place: usize, lobe_points: f64) -> f64 {
    let near = (lobe_points / 2.0).ceil() as usize;
    let peak = (place.saturating_sub(near)..(place + near + 1).min(row.len()))
        .max_by(|&a, &b| row[a].total_cmp(&row[b]))
        .unwrap_or(place);
    let reach = lobe_points as usize;
    let below = highest(&row[..peak.saturating_sub(reach)]);
    let above = highest(row.get(peak + reach + 1..).unwrap_or_default());
    f64::from(below.max(above).powi(2))
}

/// The largest of values that are not negative, in eight lanes that the compiler turns into vector instructions.
fn highest(values: &[f32]) -> f32 {
    let larger = |a: f32, b: f32| if b > a { b } else { a };
    let (eights, rest) = values.as_chunks::<8>();
    let mut lanes = [0.0; 8];
    for eight in eights {
        lanes.iter_mut().zip(eight).for_each(|(lane, &value)| *lane = larger(*lane, value));
    }
    lanes.iter().chain(rest).fold(0.0, |highest, &value| larger(highest, value))
}

impl MapLine {
    /// Amplitude spectrum of a frame, in units of the noise: the square is J.
    fn transform(&mut self, series: &[Complex<f32>], noise_variance: f64) {
        let length = self.frames.length();
        let scale = 1.0 / (self.frames.energy * noise_variance).sqrt() as f32;
        let (rising, negative) = self.frames.spectrum(series).split_at(length);
        // from the lowest frequency to the highest; two loops, because the compiler turns each into vector instructions
        let (lower, upper) = self.amplitudes.split_at_mut(negative.len());
        for (into, bins) in [(lower, negative), (upper, rising)] {
            into.iter_mut().zip(bins).for_each(|(into, bin)| *into = bin.norm_sqr().sqrt() * scale);
        }
    }

    /// Writes the amplitude at the line's place for each speed, interpolated between bins.
    fn interpolate(&self, row: &mut [f32]) {
        for (into, &(bin, share)) in row.iter_mut().zip(&self.places) {
            let bin = bin as usize;
            let (below, above) = (self.amplitudes[bin], self.amplitudes[bin + 1]);
            *into = below + share * (above - below);
        }
    }
}

/// Place of the line of a channel at each speed, in frames of `length` samples: the bin below, lowest frequency first, and the fraction
/// of a bin from there.
fn places_of(channel: &Channel, length: usize, speeds_rev_s: &[f64]) -> Vec<(u32, f32)> {
    let bin_hz = channel.rate_hz / (ZERO_PAD_FACTOR * length) as f64;
    let last = (ZERO_PAD_FACTOR * length - 1) as f64;
    speeds_rev_s
        .iter()
        .map(|speed_rev_s| {
            let place = ((channel.order * speed_rev_s - channel.centre_hz) / bin_hz + length as f64).max(0.0);
            let bin = place.floor().min(last);
            (bin as u32, (place - bin).min(1.0) as f32)
        })
        .collect()
}

/// The second largest of values that are not negative; of one value, this value.
fn second_largest(values: &[f32]) -> f32 {
    let (mut first, mut second) = (0.0f32, 0.0f32);
    for &value in values {
        if value > first {
            (first, second) = (value, first);
        } else if value > second {
            second = value;
        }
    }
    if values.len() > 1 { second } else { first }
}
