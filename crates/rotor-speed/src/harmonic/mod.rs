//! Channels → shaft speed by harmonic likelihood: all lines of the rotor together, each weighed by the noise around it.
//!
//! The hover is heard in quanta of up to ten seconds. In each, a map of all lines finds the path of the speed (`map`); the
//! lines are turned back along it (`block`); and blocks as long as one straight line of speed explains them (`coherence`)
//! give speed, slope and the uncertainty that the noise leaves. Where one block ends and the next begins the track leans on a
//! third one, from middle to middle.

pub(crate) mod best_path;
pub(crate) mod block;
pub(crate) mod coherence;
mod floor;
pub(crate) mod frame;
pub(crate) mod join;
pub(crate) mod line;
pub(crate) mod map;
pub(crate) mod path;
pub(crate) mod phasors;
pub(crate) mod quanta;
mod track;

use block::BlockFit;
use coherence::{Level, best_level, blocks_between, first_level, likelihood_min, line_likelihoods, straight_level};
use hovertone_analysis::Span;
use hovertone_signal::channels::{ChannelBand, TICKS_PER_HOP};
use hovertone_signal::spectrogram::power_db;
use join::joined;
pub(crate) use join::{EndBlock, joined_variance_turns2};
use line::{Line, demodulated};
use map::{Centroid, FRAME_HOPS, LinePresence, MapPath, STRONG_POWER_MIN, SpeedMap};
use path::SpeedPath;
pub(crate) use quanta::{InQuanta, Quantum, QuantumCutter, QuantumListener, limits_rev_s};
pub(crate) use track::{HarmonicBlock, HarmonicTrack, LineRecord};

use rustfft::FftPlanner;

/// A line whose band holds something this much stronger than what lies on the path is of another sound.
const STRANGER_RATIO: f64 = 6.0;
/// … if that stands this far over the noise: the highest of a band's own noise does not.
const STRANGER_POWER_MIN: f64 = 20.0;

/// Where something else in the bands of the strong lines has this share of their power, several rotors sound at once. One rotor
/// leaves up to 0.02 there (its own wander, and lines at other orders), several leave 0.11 to 0.6.
const SEVERAL_SHARE: f64 = 0.06;
/// The rotors' loudness is not known to be equal: with levels that differ by 3 dB or so, the mean of four is uncertain by this
/// share of how far they lie apart.
const UNKNOWN_LOUDNESS_SHARE: f64 = 0.2;
/// Where this share of the shortest blocks stands out by so many times what they must, the path cannot be wrong.
const CLEAR_SHARE: f64 = 0.9;
const CLEAR_TIMES: f64 = 2.0;
/// Lines need not be turned back again along a path that turns the highest of them by less than this within a tick.
const NEAR_TURNS: f64 = 0.02;
/// A quantum in more blocks than this is not steady.
const STEADY_BLOCKS_MAX: usize = 8;
/// A block that knows the speed no better than to 10 rev/s knows nothing.
const INFORMATION_MIN: f64 = 1e-2;
/// A tone too weak to be a line in any frame is one if two of its lines keep their phase for this long …
const STEADY_S_MIN: f64 = 1.0;
/// … and reach so many times what a block must, and what the search over a hundred thousand cells finds in noise.
const STEADY_TIMES: f64 = 2.0;
const SEARCH_LIKELIHOOD: f64 = 20.0;
/// … and hold this share of the likelihood that blocks of one hop find, each by itself. A machine's hum leaves a tenth.
const COHERENT_SHARE: f64 = 0.4;

/// Follows the speed through stretches of sound.
pub(crate) struct HarmonicTracer {
    map: SpeedMap,
    track: HarmonicTrack,
}

impl HarmonicTracer {
    /// Hears the lines of `bands`, which all stand for the same limits of speed.
    pub(crate) fn new(sample_rate_hz: f64, bands: &[ChannelBand]) -> InQuanta<Self> {
        let cutter = QuantumCutter::new(sample_rate_hz, bands);
        let map = SpeedMap::new(cutter.channels(), limits_rev_s(bands), cutter.hop_s(), &mut FftPlanner::new());
        let track = HarmonicTrack {
            step_s: cutter.hop_s(),
            lines: bands.iter().map(|band| LineRecord { order: band.order, ..LineRecord::default() }).collect(),
            ..HarmonicTrack::default()
        };
        InQuanta::new(cutter, Self { map, track })
    }
}

impl QuantumListener for HarmonicTracer {
    type Heard = HarmonicTrack;

    fn hear(&mut self, quantum: &Quantum<'_>) {
        let Self { map, track } = self;
        let (start_s, tick_s) = (quantum.start_s, quantum.tick_s);
        let (lines, limits) = (quantum.channels.len(), map.limits_rev_s());
        match level_of_quantum(quantum, map, &mut track.lines) {
            Some(Heard::One { level, between, coheres }) => {
                let at = |fit: &BlockFit| block_at(fit, coheres, (start_s, tick_s), (lines, limits));
                track.blocks.extend(level.blocks.iter().map(at));
                track.between.extend(between.iter().map(at).filter(|block| block.is_heard));
            }
            Some(Heard::Several(centroids)) => {
                let frame_s = (FRAME_HOPS * TICKS_PER_HOP) as f64 * tick_s;
                track.blocks.extend(blocks_of_several(&centroids, start_s, frame_s));
            }
            None => {}
        }
    }

    fn end_stretch(&mut self, end_s: f64) {
        if let Some(last) = self.track.blocks.last_mut().filter(|last| last.span.to_s > end_s) {
            *last = last.until(end_s);
        }
    }

    fn finish(self) -> HarmonicTrack {
        self.track
    }
}

/// What is heard in a quantum; what each line contributed is added to its record.
fn level_of_quantum(quantum: &Quantum<'_>, map: &mut SpeedMap, records: &mut [LineRecord]) -> Option<Heard> {
    let Quantum { channels, series, noise_variances, tick_s, ticks, .. } = quantum;
    let (tick_s, ticks) = (*tick_s, *ticks);
    let seen = map.path_through(series, noise_variances, TICKS_PER_HOP as f64 * tick_s);
    let MapPath { points, presences, steady_rev_s, .. } = &seen;
    let path = SpeedPath::through(points, tick_s, ticks)?;
    let used: Vec<usize> = (0..channels.len()).filter(|&index| !is_stranger(&presences[index])).collect();
    for (index, (record, presence)) in records.iter_mut().zip(presences).enumerate() {
        record.on_path += presence.on_path;
        record.quanta += 1;
        record.quanta_left_out += u32::from(!used.contains(&index));
    }
    if seen.beside_share > SEVERAL_SHARE {
        return Some(Heard::Several(map.centroids(presences, noise_variances)));
    }
    let lines_along = |path: &SpeedPath| -> Vec<Line> {
        used.iter()
            .map(|&index| {
                let channel = &channels[index];
                let samples_per_tick = channel.hop_samples / TICKS_PER_HOP;
                let place = (channel.order, channel.centre_hz, channel.rate_hz);
                Line {
                    order: channel.order,
                    is_first: channel.is_first,
                    is_strong: presences[index].on_path > STRONG_POWER_MIN,
                    noise_variance: noise_variances[index],
                    company_hz: channel.centre_hz - channel.rate_hz / 2.0..channel.centre_hz + channel.rate_hz / 2.0,
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
    let following = path.map(|path| {
        let lines = lines_along(&path);
        (best_level(&lines, &path, &coarse), (lines, path))
    });
    let (best, along) = match following {
        Some((level, along)) if coarse.heard_share(used.len(), CLEAR_TIMES) > CLEAR_SHARE => (level, Some(along)),
        following => {
            // single blocks are weak: perhaps all of them together are a rotor that holds its speed
            let steady = SpeedPath::through(&[(0.0, *steady_rev_s)], tick_s, ticks)?;
            let straight = straight_level(&lines_along(&steady), &steady);
            (following.map_or(straight.clone(), |(level, _)| straight.or_better(level)), None)
        }
    };
    let coheres = best.likelihood() > COHERENT_SHARE * coarse.likelihood_over_noise(used.len());
    let points = best.points(threshold, tick_s);
    let Some(path) = SpeedPath::through(&points, tick_s, ticks) else {
        return Some(Heard::One { level: best, between: Vec::new(), coheres });
    };
    let order_max = used.iter().map(|&index| channels[index].order).fold(1.0, f64::max);
    let near_rev_s = NEAR_TURNS / (order_max * tick_s);
    let (lines, path) =
        along.filter(|(_, along)| along.is_within(near_rev_s, &path)).unwrap_or_else(|| (lines_along(&path), path));
    let best = joined(&lines, &path, &best);
    if best.blocks.len() <= STEADY_BLOCKS_MAX {
        let likelihoods = line_likelihoods(&lines, &path, &best);
        for (&index, likelihood) in used.iter().zip(likelihoods) {
            records[index].steady_likelihood += likelihood;
        }
    }
    Some(Heard::One { between: blocks_between(&lines, &path, &best), level: best, coheres })
}

/// What a quantum holds.
enum Heard {
    /// One rotor, or several that turn as one: its blocks, those from the middle of one to the middle of the next, and whether blocks
    /// hold most of what short ones find, so that the lines really keep their phase.
    One { level: Level, between: Vec<BlockFit>, coheres: bool },
    /// Several, and where their energy lies in each frame.
    Several(Vec<Centroid>),
}

/// Blocks of several rotors: the mean of their speeds, each counting for its loudness.
fn blocks_of_several(centroids: &[Centroid], start_s: f64, frame_s: f64) -> Vec<HarmonicBlock> {
    centroids
        .iter()
        .enumerate()
        .filter(|(_, centroid)| centroid.energy > 0.0)
        .map(|(frame, centroid)| {
            let speed_rev_s = centroid.first / centroid.energy;
            let apart_rev_s = (centroid.second / centroid.energy - speed_rev_s * speed_rev_s).max(0.0).sqrt();
            let from_s = start_s + frame as f64 * frame_s;
            HarmonicBlock {
                span: Span { from_s, to_s: from_s + frame_s },
                speed_rev_s,
                slope_rev_s2: 0.0,
                std_uncertainty_rev_s: UNKNOWN_LOUDNESS_SHARE * apart_rev_s,
                level_db: power_db(centroid.strongest_power),
                step_to_next_turns: None,
                is_several: true,
                is_heard: true,
                is_steady: false,
            }
        })
        .collect()
}

/// So many lines must keep their phase: two of a gear mesh, four of a blade pass, which has many.
fn steady_lines_min(lines: usize) -> u32 {
    if lines >= 8 { 4 } else { 2 }
}

fn is_stranger(presence: &LinePresence) -> bool {
    presence.in_band > STRANGER_POWER_MIN && presence.in_band > STRANGER_RATIO * presence.on_path
}

pub(crate) fn block_at(
    fit: &BlockFit,
    coheres: bool,
    (start_s, tick_s): (f64, f64),
    (lines, limits): (usize, (f64, f64)),
) -> HarmonicBlock {
    let threshold = likelihood_min(lines);
    let at = |tick: usize| start_s + tick as f64 * tick_s;
    HarmonicBlock {
        span: Span { from_s: at(fit.tick_from), to_s: at(fit.tick_to) },
        speed_rev_s: fit.speed_rev_s,
        slope_rev_s2: fit.slope_rev_s2,
        std_uncertainty_rev_s: (fit.scatter / fit.information).sqrt(),
        step_to_next_turns: fit.step_to_next_turns,
        is_several: false,
        level_db: power_db(fit.strongest_power),
        is_heard: fit.likelihood >= threshold
            && fit.information > INFORMATION_MIN
            && (limits.0..=limits.1).contains(&fit.speed_rev_s),
        is_steady: (fit.tick_to - fit.tick_from) as f64 * tick_s >= STEADY_S_MIN
            && fit.lines_heard >= steady_lines_min(lines)
            && fit.is_first_heard
            && coheres
            && fit.likelihood >= STEADY_TIMES * threshold + SEARCH_LIKELIHOOD,
    }
}

#[cfg(test)]
mod tests;
