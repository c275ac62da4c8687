//! Where the speed is, roughly: all lines scored together on a grid of speeds in each frame, and the best path through them.

use super::best_path::best_path;
use super::frame::FrameTransform;
use hovertone_signal::channels::Channel;
use hovertone_signal::statistics::{mean, median};
use hovertone_vehicle::BLADES_MAX;
use realfft::num_complex::Complex;
use rustfft::FftPlanner;

/// Frames of the map, in hops of the bank: 0.17 s.
pub(crate) const FRAME_HOPS: usize = 2;
/// Grid points in a resolution cell of the highest line; the lobe of a Hann frame is four cells wide.
const GRID_PER_CELL: f64 = 1.5;
/// Points of the grid at most.
const GRID_POINTS_MAX: f64 = 1200.0;
/// How much the speed of a hover changes from one frame of the map to the next, as a share.
const STEP_STD_SHARE: f64 = 0.01;
/// A line of this power over the noise in a frame stands out in each of its four half hops.
pub(crate) const STRONG_POWER_MIN: f64 = 30.0;
/// The highest power of noise alone in a band.
const NOISE_PEAK_POWER: f64 = 8.0;
/// Something else is in a band where it has this share of the strongest power.
const MOST_BANDS_SHARE: f64 = 0.03;
/// Power of the lines beside a gear mesh, as a share of its own.
const SIDEBAND_SHARE: f64 = 0.35;
/// Half width of the lobe of a Hann frame, and half a cell more, in resolution cells.
const LOBE_CELLS: f64 = 2.5;
/// What is weaker than this share of a frame's highest power does not count for where its energy lies.
const CENTROID_SHARE_MIN: f32 = 0.4;

/// What one line shows in the frames of a quantum.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LinePresence {
    /// Mean power on the path, over that of noise.
    pub(crate) on_path: f64,
    /// Mean of each frame's highest power in the line's band, over that of noise.
    pub(crate) in_band: f64,
    /// Mean of each frame's highest power in the band but for the lobe around the path, over that of noise.
    pub(crate) beside: f64,
}

struct Line {
    order: f64,
    /// Whether no other line of the rotor reaches into its band.
    is_alone: bool,
    frames: FrameTransform,
    /// Amplitude of each bin of the spectrum, lowest frequency first, and how far it is to that of the next.
    amplitudes: Vec<[f32; 2]>,
    /// Where the line lies in the spectrum at each speed: the bin below, and how far on it is to the next.
    places: Vec<(u32, f32)>,
}

/// Scores speeds between two limits.
pub(crate) struct SpeedMap {
    lines: Vec<Line>,
    speeds_rev_s: Vec<f64>,
    /// Amplitude of every line at every speed, frame by frame; of the quantum last heard, as are the scores. They are kept, since
    /// asking for fresh memory costs as much as filling it.
    amplitudes: Vec<f32>,
    /// What all lines say together of every speed, frame by frame.
    scores: Vec<f64>,
}

impl SpeedMap {
    pub(crate) fn new(
        channels: &[Channel],
        (low, high): (f64, f64),
        hop_s: f64,
        planner: &mut FftPlanner<f32>,
    ) -> Self {
        let order_max = channels.iter().map(|channel| channel.order).fold(1.0, f64::max);
        let frame_s = FRAME_HOPS as f64 * hop_s;
        let points = ((high - low) * GRID_PER_CELL * order_max * frame_s).ceil().clamp(3.0, GRID_POINTS_MAX);
        let step = (high - low) / points;
        let speeds_rev_s: Vec<f64> = (0..=points as usize).map(|index| low + step * index as f64).collect();
        let lines = channels
            .iter()
            .map(|channel| {
                let length = FRAME_HOPS * channel.hop_samples;
                let apart = channels
                    .iter()
                    .map(|other| (other.order - channel.order).abs())
                    .filter(|&apart| apart > 0.0)
                    .fold(channel.order, f64::min);
                Line {
                    order: channel.order,
                    is_alone: channel.order * (high - low) / 2.0 <= apart * low / 2.0,
                    amplitudes: vec![[0.0; 2]; 2 * length],
                    places: places_of(channel, length, &speeds_rev_s),
                    frames: FrameTransform::new(length, 2, planner),
                }
            })
            .collect();
        Self { lines, speeds_rev_s, amplitudes: Vec::new(), scores: Vec::new() }
    }

    /// The slowest and fastest speed that is looked for.
    pub(crate) fn limits_rev_s(&self) -> (f64, f64) {
        let last = self.speeds_rev_s.len() - 1;
        (self.speeds_rev_s[0], self.speeds_rev_s[last])
    }

    /// Amplitudes of one frame.
    fn frame_len(&self) -> usize {
        (self.speeds_rev_s.len() * self.lines.len()).max(1)
    }

    /// The path of a quantum as speeds in the middle of each frame, and how present each line is on it.
    pub(crate) fn path_through(&mut self, series: &[&[Complex<f32>]], noise_variances: &[f64], hop_s: f64) -> MapPath {
        let frames =
            self.lines.iter().zip(series).map(|(line, series)| series.len() / line.frames.length()).min().unwrap_or(0);
        let points = self.speeds_rev_s.len();
        let mut presences = vec![LinePresence::default(); self.lines.len()];
        let mut power = vec![0.0f32; points];
        let mut score = vec![0.0f32; points];
        let frame_len = self.frame_len();
        self.amplitudes.resize(frames * frame_len, 0.0);
        self.scores.clear();
        for (frame, on_grid) in self.amplitudes.chunks_exact_mut(frame_len).enumerate() {
            for (((line, series), &noise), row) in
                self.lines.iter_mut().zip(series).zip(noise_variances).zip(on_grid.chunks_exact_mut(points))
            {
                line.transform(&series[frame * line.frames.length()..], noise);
                line.interpolate(row);
            }
            let peaks: Vec<f32> = on_grid.chunks_exact(points).map(highest).collect();
            let cap = second_largest(&peaks);
            score.fill(0.0);
            for ((row, &peak), presence) in on_grid.chunks_exact(points).zip(&peaks).zip(&mut presences) {
                // a whistle in one band must not outvote lines that agree
                let scale = if peak > cap { cap / peak } else { 1.0 };
                for ((sum, power), amplitude) in score.iter_mut().zip(&mut power).zip(row) {
                    let scaled = amplitude * scale;
                    *sum += scaled;
                    *power += scaled * scaled;
                }
                presence.in_band += f64::from(peak * peak) / frames as f64;
            }
            self.scores.extend(score.iter().copied().map(f64::from));
        }
        let steady = (0..points).max_by(|&a, &b| power[a].total_cmp(&power[b])).unwrap_or(0);
        let step = self.speeds_rev_s[1] - self.speeds_rev_s[0];
        let middle = (self.speeds_rev_s[0] + self.speeds_rev_s[points - 1]) / 2.0;
        let scores: Vec<&[f64]> = self.scores.chunks_exact(points).collect();
        let path = best_path(&scores, STEP_STD_SHARE * middle / step);
        for (&place, on_grid) in path.iter().zip(self.amplitudes.chunks_exact(frame_len)) {
            for ((presence, row), line) in presences.iter_mut().zip(on_grid.chunks_exact(points)).zip(&self.lines) {
                let lobe_points = LOBE_CELLS / (line.order * FRAME_HOPS as f64 * hop_s) / step;
                presence.on_path += f64::from(row[place].powi(2)) / frames as f64;
                if line.is_alone {
                    presence.beside += power_beside(row, place, lobe_points) / frames as f64;
                }
            }
        }
        let strong: Vec<f64> = presences
            .iter()
            .zip(&self.lines)
            .filter(|(presence, line)| line.is_alone && presence.on_path > STRONG_POWER_MIN)
            .map(|(presence, line)| {
                // a gear mesh has lines beside it, one and two turns of the shaft away, up to a third as strong
                let sidebands = if line.order > BLADES_MAX { SIDEBAND_SHARE * presence.in_band } else { 0.0 };
                (presence.beside - NOISE_PEAK_POWER - sidebands).max(0.0) / presence.in_band
            })
            .collect();
        // another sound falls into some bands, another rotor into most of those that resolve it
        let is_in_most = median(&strong).is_some_and(|share| share > MOST_BANDS_SHARE);
        let beside_share = mean(&strong).filter(|_| is_in_most).unwrap_or(0.0);
        let frame_s = FRAME_HOPS as f64 * hop_s;
        let points = path
            .iter()
            .enumerate()
            .map(|(frame, &place)| ((frame as f64 + 0.5) * frame_s, self.speeds_rev_s[place]))
            .collect();
        let steady_rev_s = self.speeds_rev_s[steady];
        MapPath { points, presences, steady_rev_s, beside_share }
    }

    /// Where the energy of each frame of the quantum last heard lies.
    pub(crate) fn centroids(&self, presences: &[LinePresence], noise_variances: &[f64]) -> Vec<Centroid> {
        self.amplitudes
            .chunks_exact(self.frame_len())
            .map(|on_grid| self.centroid(on_grid, presences, noise_variances))
            .collect()
    }

    /// Where the energy of a frame lies, each line weighed by A² / (Φ o): of all strong lines whose band holds no other line of the
    /// rotor.
    fn centroid(&self, on_grid: &[f32], presences: &[LinePresence], noise_variances: &[f64]) -> Centroid {
        let points = self.speeds_rev_s.len();
        let mut centroid = Centroid::default();
        let rows = on_grid.chunks_exact(points).zip(presences).zip(noise_variances);
        for (((row, presence), noise), line) in rows.zip(&self.lines) {
            if !line.is_alone || presence.on_path < STRONG_POWER_MIN {
                continue;
            }
            let peak = highest(row).powi(2);
            // J of a sine of amplitude A in a Hann frame of N samples is A² N / 1.5 V
            let amplitude_square = 1.5 * f64::from(peak) * noise / line.frames.length() as f64;
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

/// Energy of a frame, and its moments over speed.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Centroid {
    pub(crate) energy: f64,
    pub(crate) first: f64,
    pub(crate) second: f64,
    /// Power of the strongest line, 1 for a sine of full scale.
    pub(crate) strongest_power: f64,
}

/// The highest power of a row outside the lobe of what is nearest to the path.
fn power_beside(row: &[f32], place: usize, lobe_points: f64) -> f64 {
    let near = (lobe_points / 2.0).ceil() as usize;
    let peak = (place.saturating_sub(near)..(place + near + 1).min(row.len()))
        .max_by(|&a, &b| row[a].total_cmp(&row[b]))
        .unwrap_or(place);
    let reach = lobe_points as usize;
    let below = highest(&row[..peak.saturating_sub(reach)]);
    let above = highest(row.get(peak + reach + 1..).unwrap_or_default());
    f64::from(below.max(above).powi(2))
}

/// The largest of values that are not negative; written so that it runs in vectors.
fn highest(values: &[f32]) -> f32 {
    let larger = |a: f32, b: f32| if b > a { b } else { a };
    let (eights, rest) = values.as_chunks::<8>();
    let mut lanes = [0.0; 8];
    for eight in eights {
        lanes.iter_mut().zip(eight).for_each(|(lane, &value)| *lane = larger(*lane, value));
    }
    lanes.iter().chain(rest).fold(0.0, |highest, &value| larger(highest, value))
}

/// What the map shows of a quantum.
pub(crate) struct MapPath {
    /// Time from the start and speed.
    pub(crate) points: Vec<(f64, f64)>,
    /// How present each line is.
    pub(crate) presences: Vec<LinePresence>,
    /// The one speed that explains most of all frames.
    pub(crate) steady_rev_s: f64,
    /// How strong something else in the bands of the strong lines is, as a share of the strongest; mean of these lines, 0 where
    /// it is in few of them.
    pub(crate) beside_share: f64,
}

impl Line {
    /// Amplitude spectrum of a frame in units of the noise: the root of what J would be.
    fn transform(&mut self, series: &[Complex<f32>], noise_variance: f64) {
        let length = self.frames.length();
        let scale = 1.0 / (self.frames.energy * noise_variance).sqrt() as f32;
        let spectrum = self.frames.spectrum(series);
        // from the lowest frequency to the highest
        let (rising, negative) = spectrum.split_at(length);
        for (into, bin) in self.amplitudes.iter_mut().zip(negative.iter().chain(rising)) {
            into[0] = bin.norm_sqr().sqrt() * scale;
        }
        let mut above = 0.0;
        for [amplitude, step] in self.amplitudes.iter_mut().rev() {
            *step = above - *amplitude;
            above = *amplitude;
        }
    }

    /// The spectrum at the line's place for each speed.
    fn interpolate(&self, row: &mut [f32]) {
        for (into, &(bin, share)) in row.iter_mut().zip(&self.places) {
            let [amplitude, step] = self.amplitudes[bin as usize];
            *into = amplitude + share * step;
        }
    }
}

/// Where the line of a channel lies in frames of `length` samples that are transformed at twice their length, lowest frequency first.
fn places_of(channel: &Channel, length: usize, speeds_rev_s: &[f64]) -> Vec<(u32, f32)> {
    let bin_hz = channel.rate_hz / (2 * length) as f64;
    let last = (2 * length - 1) as f64;
    speeds_rev_s
        .iter()
        .map(|speed_rev_s| {
            let place = ((channel.order * speed_rev_s - channel.centre_hz) / bin_hz + length as f64).max(0.0);
            let bin = place.floor().min(last);
            (bin as u32, (place - bin).min(1.0) as f32)
        })
        .collect()
}

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
