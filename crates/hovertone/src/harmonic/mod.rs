//! Channels → shaft speed by harmonic likelihood: all lines of the rotor together, each weighed by the noise around it.
//!
//! The hover is heard in quanta of up to ten seconds. In each, a map of all lines finds the path of the speed (`map`); the
//! lines are turned back along it (`block`); and blocks as long as one straight line of speed explains them (`coherence`)
//! give speed, slope and the uncertainty that the noise leaves.

mod block;
mod coherence;
mod floor;
mod map;
mod path;

use crate::channel::{ChannelBand, ChannelBank, TICKS_PER_HOP};
use crate::span::Span;
use block::{BlockFit, Line, demodulated};
use coherence::{Level, best_level, first_level, likelihood_min, polished, straight_level};
use floor::FloorMeter;
use map::{FRAME_HOPS, LinePresence, MapPath, SpeedMap};
use path::SpeedPath;
use realfft::num_complex::Complex;
use rustfft::FftPlanner;

/// Longest stretch that is taken together. No rotor in flight keeps its phase for longer.
const QUANTUM_S_MAX: f64 = 10.0;
/// Ticks at either end of a stretch in which it fades in or out; their amplitude says nothing.
const FADE_TICKS: usize = 3;
/// A line whose band holds something this much stronger than what lies on the path is of another sound.
const STRANGER_RATIO: f64 = 6.0;
/// … if that stands this far over the noise: the highest of a band's own noise does not.
const STRANGER_POWER_MIN: f64 = 20.0;

/// The speed over one block of sound.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HarmonicBlock {
    pub(crate) span: Span,
    /// Speed in the middle.
    pub(crate) speed_rev_s: f64,
    pub(crate) slope_rev_s2: f64,
    /// From the curvature of the likelihood.
    pub(crate) std_uncertainty_rev_s: f64,
    pub(crate) likelihood: f64,
    /// Whether it stands out of the noise.
    pub(crate) is_heard: bool,
}

/// What a line contributed over all quanta.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct LineRecord {
    pub(crate) order: f64,
    on_path: f64,
    in_band: f64,
    pub(crate) quanta: u32,
    pub(crate) quanta_left_out: u32,
}

/// The harmonic likelihood over a hover.
#[derive(Clone, Debug, Default)]
pub(crate) struct HarmonicTrack {
    pub(crate) blocks: Vec<HarmonicBlock>,
    pub(crate) lines: Vec<LineRecord>,
}

/// Follows the speed through stretches of sound.
pub(crate) struct HarmonicTracer {
    bank: ChannelBank,
    series: Vec<Vec<Complex<f32>>>,
    floors: Vec<FloorMeter>,
    map: SpeedMap,
    /// Start of what lies in `series`.
    start_s: f64,
    stretch_start_s: f64,
    samples_in: u64,
    sample_rate_hz: f64,
    quantum_hops: usize,
    track: HarmonicTrack,
}

impl HarmonicTracer {
    pub(crate) fn new(sample_rate_hz: f64, bands: &[ChannelBand], speeds_rev_s: (f64, f64)) -> Self {
        let bank = ChannelBank::new(sample_rate_hz, bands);
        let mut planner = FftPlanner::new();
        let floors =
            bank.channels.iter().map(|channel| FloorMeter::new(channel.hop_samples, &mut planner)).collect();
        let map = SpeedMap::new(&bank.channels, speeds_rev_s, bank.hop_s(), &mut planner);
        Self {
            series: vec![Vec::new(); bank.channels.len()],
            floors,
            map,
            start_s: 0.0,
            stretch_start_s: 0.0,
            samples_in: 0,
            sample_rate_hz,
            quantum_hops: 1,
            track: HarmonicTrack {
                blocks: Vec::new(),
                lines: bands.iter().map(|band| LineRecord { order: band.order, ..LineRecord::default() }).collect(),
            },
            bank,
        }
    }

    /// A new stretch of sound begins at `start_s` and should last `length_s`.
    pub(crate) fn restart(&mut self, start_s: f64, length_s: f64) {
        self.end_stretch();
        self.bank.restart();
        (self.start_s, self.stretch_start_s, self.samples_in) = (start_s, start_s, 0);
        let quanta = (length_s / QUANTUM_S_MAX).ceil().max(1.0);
        self.quantum_hops = (length_s / quanta / self.bank.hop_s()).ceil().max(1.0) as usize;
    }

    pub(crate) fn push(&mut self, samples: &[f32]) {
        self.samples_in += samples.len() as u64;
        self.bank.push(samples, &mut self.series);
        // a stretch that ends a little later than it should must not leave a crumb
        while self.hops() >= self.quantum_hops + self.quantum_hops / 2 {
            self.take_quantum(self.quantum_hops * TICKS_PER_HOP);
        }
    }

    pub(crate) fn finish(mut self) -> HarmonicTrack {
        self.end_stretch();
        self.track
    }

    fn end_stretch(&mut self) {
        self.bank.finish(&mut self.series);
        let tick_s = self.bank.hop_s() / TICKS_PER_HOP as f64;
        let left_s = self.stretch_start_s + self.samples_in as f64 / self.sample_rate_hz - self.start_s;
        let ticks = ((left_s / tick_s + 1e-6) as usize).min(self.hops() * TICKS_PER_HOP);
        let ticks = ticks.saturating_sub(FADE_TICKS);
        if ticks >= FRAME_HOPS * TICKS_PER_HOP {
            self.take_quantum(ticks);
        }
        self.series.iter_mut().for_each(Vec::clear);
        self.samples_in = 0;
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

    /// Analyses the first ticks of what has come in, and drops them.
    fn take_quantum(&mut self, mut ticks: usize) {
        let hop_s = self.bank.hop_s();
        let tick_s = hop_s / TICKS_PER_HOP as f64;
        if self.start_s == self.stretch_start_s && ticks > FADE_TICKS {
            self.drop_ticks(FADE_TICKS);
            ticks -= FADE_TICKS;
        }
        if let Some(level) = self.level_of_quantum(ticks) {
            let threshold = likelihood_min(self.bank.channels.len());
            let start_s = self.start_s;
            self.track.blocks.extend(level.blocks.iter().map(|fit| block_at(fit, start_s, tick_s, threshold)));
        }
        self.drop_ticks(ticks);
    }

    fn drop_ticks(&mut self, ticks: usize) {
        for (channel, series) in self.bank.channels.iter().zip(&mut self.series) {
            let samples = (ticks * channel.hop_samples / TICKS_PER_HOP).min(series.len());
            series.drain(..samples);
        }
        self.start_s += ticks as f64 * self.bank.hop_s() / TICKS_PER_HOP as f64;
    }

    fn level_of_quantum(&mut self, ticks: usize) -> Option<Level> {
        let channels = &self.bank.channels;
        let hop_s = self.bank.hop_s();
        let tick_s = hop_s / TICKS_PER_HOP as f64;
        let series: Vec<&[Complex<f32>]> = channels
            .iter()
            .zip(&self.series)
            .map(|(channel, series)| &series[..ticks * channel.hop_samples / TICKS_PER_HOP])
            .collect();
        let noise_variances: Vec<f64> = self
            .floors
            .iter_mut()
            .zip(&series)
            .map(|(floor, series)| floor.noise_variance(series).unwrap_or(0.0).max(NOISE_VARIANCE_MIN))
            .collect();
        let MapPath { points, presences, steady_rev_s } = self.map.path_through(&series, &noise_variances, hop_s);
        let path = SpeedPath::through(&points, tick_s, ticks)?;
        let used: Vec<usize> = (0..channels.len()).filter(|&index| !is_stranger(&presences[index])).collect();
        for (index, (record, presence)) in self.track.lines.iter_mut().zip(&presences).enumerate() {
            record.on_path += presence.on_path;
            record.in_band += presence.in_band;
            record.quanta += 1;
            record.quanta_left_out += u32::from(!used.contains(&index));
        }
        let lines_along = |path: &SpeedPath| -> Vec<Line> {
            used.iter()
                .map(|&index| {
                    let channel = &channels[index];
                    let samples_per_tick = channel.hop_samples / TICKS_PER_HOP;
                    let place = (channel.order, channel.centre_hz, channel.rate_hz);
                    Line {
                        order: channel.order,
                        is_strong: presences[index].on_path > STRONG_POWER_MIN,
                        noise_variance: noise_variances[index],
                        samples_per_tick: samples_per_tick as f64,
                        ticks: demodulated(series[index], place, samples_per_tick, path),
                    }
                })
                .collect()
        };
        let threshold = likelihood_min(used.len());
        let coarse = first_level(&lines_along(&path), &path);
        let better: Vec<(f64, f64)> = coarse
            .blocks
            .iter()
            .filter(|block| block.likelihood >= threshold)
            .map(|block| (block.middle_s(tick_s), block.speed_rev_s))
            .collect();
        let path = SpeedPath::through(&better, tick_s, ticks).filter(|_| coarse.heard_share(used.len(), 1.0) > 0.5);
        let following = path.map(|path| best_level(&lines_along(&path), &path));
        let best = match following {
            Some(level) if coarse.heard_share(used.len(), CLEAR_TIMES) > CLEAR_SHARE => level,
            following => {
                // single blocks are weak: perhaps all of them together are a rotor that holds its speed
                let steady = SpeedPath::through(&[(0.0, steady_rev_s)], tick_s, ticks)?;
                let straight = straight_level(&lines_along(&steady), &steady);
                following.map_or(straight.clone(), |level| straight.or_better(level))
            }
        };
        let points: Vec<(f64, f64)> = best
            .blocks
            .iter()
            .filter(|block| block.likelihood >= threshold)
            .flat_map(|block| {
                let reach_s = 0.49 * (block.tick_to - block.tick_from) as f64 * tick_s;
                let middle_s = block.middle_s(tick_s);
                [middle_s - reach_s, middle_s + reach_s].map(|t| (t, block.speed_at(t, tick_s)))
            })
            .collect();
        Some(match SpeedPath::through(&points, tick_s, ticks) {
            Some(path) => polished(&lines_along(&path), &path, &best),
            None => best,
        })
    }
}

/// A line of this power over the noise in a frame of the map stands out in each of its four half hops.
const STRONG_POWER_MIN: f64 = 30.0;
/// Where this share of the shortest blocks stands out by so many times what they must, the path cannot be wrong.
const CLEAR_SHARE: f64 = 0.9;
const CLEAR_TIMES: f64 = 2.0;
/// Digital silence has no noise; this keeps the likelihood finite. The last bit of 24 has 2e-15.
const NOISE_VARIANCE_MIN: f64 = 1e-16;

fn is_stranger(presence: &LinePresence) -> bool {
    presence.in_band > STRANGER_POWER_MIN && presence.in_band > STRANGER_RATIO * presence.on_path
}

fn block_at(fit: &BlockFit, start_s: f64, tick_s: f64, threshold: f64) -> HarmonicBlock {
    let at = |tick: usize| start_s + tick as f64 * tick_s;
    HarmonicBlock {
        span: Span { from_s: at(fit.tick_from), to_s: at(fit.tick_to) },
        speed_rev_s: fit.speed_rev_s,
        slope_rev_s2: fit.slope_rev_s2,
        std_uncertainty_rev_s: (fit.scatter / fit.information).sqrt(),
        likelihood: fit.likelihood,
        is_heard: fit.likelihood >= threshold,
    }
}

#[cfg(test)]
mod tests;
