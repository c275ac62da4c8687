//! Channels → shaft speed by harmonic likelihood: all lines of the rotor together, each weighted by the noise around it.
//!
//! The units of time, from long to short:
//!
//! | unit | meaning |
//! |---|---|
//! | stretch | sound without gaps |
//! | chunk | up to 10 s of a stretch, analysed at once (`chunks`) |
//! | block | part of a chunk in which one straight line of speed explains the sound (`block`) |
//! | frame | 0.17 s: two hops (`speed_map`) |
//! | hop | half a frame of the filter bank (`hovertone_signal::channels`) |
//! | tick | an eighth of a hop |
//!
//! A *partition* is the division of a chunk into blocks (`partition`).
//!
//! In each chunk, a map of all lines gives a rough path of the speed (`speed_map`). The lines are demodulated along it
//! (`demodulation`). Blocks as long as straight lines of speed explain the sound give speed, slope and the uncertainty due to noise
//! (`block`, `partition`), and are joined by phase (`join`). Further blocks, from the middle of each block to the middle of the next,
//! support the track where two blocks meet.
//!
//! Sources: harmonic likelihood as in Christensen and Jakobsson, *Multi-Pitch Estimation*, 2009; Cramér-Rao bound as in Rife and
//! Boorstyn, IEEE Trans. Information Theory 20, 1974.

pub(crate) mod best_path;
pub(crate) mod block;
pub(crate) mod chunks;
pub(crate) mod demodulation;
pub(crate) mod frame_transform;
pub(crate) mod join;
mod noise_floor;
pub(crate) mod partition;
pub(crate) mod phasors;
pub(crate) mod speed_map;
pub(crate) mod speed_path;
mod track;

use crate::thresholds::{CLEAR_TIMES, HEARD_S_MIN, MANY, MESH_LINES, NEARLY_ALL, SERIES_LINES};
use block::BlockFit;
pub(crate) use chunks::{Chunk, ChunkCutter, ChunkListener, InChunks, NoiseDensity, limits_rev_s};
use demodulation::{Line, LinePlace, demodulated};
use hovertone_analysis::Span;
use hovertone_signal::channels::{ChannelBand, TICKS_PER_HOP};
use hovertone_signal::fft::ComplexPlanner;
use hovertone_signal::spectrogram::power_db;
use join::joined;
pub(crate) use join::{EndBlock, joined_variance_turns2};
use partition::{Partition, best_partition, blocks_between, first_partition, likelihood_min, straight_partition};
use speed_map::{Centroid, FRAME_HOPS, LinePowers, STRONG_POWER_MIN, SpeedMap};
use speed_path::{SpeedPath, SpeedPoint};
pub(crate) use track::{HarmonicBlock, HarmonicTrack, LineRecord, SAME_TIME_S};

/// Smallest ratio of the highest power in the band of a line to the power on the path at which the band holds a foreign sound.
/// *Decision.*
const FOREIGN_RATIO: f64 = 6.0;
/// Smallest power of a foreign sound over the mean power of noise: the highest value of noise in a band stays below. *Decision.*
const FOREIGN_POWER_MIN: f64 = 20.0;
/// Share of power beside the path, in the bands of the strong lines, above which several rotors sound. One rotor leaves up to 0.02 (by
/// its wander and by lines of other orders), several leave 0.11 to 0.6. *Decision.*
const SEVERAL_SHARE: f64 = 0.06;
/// Standard deviation of the mean speed of several rotors with unequal loudness (3 dB or so among four), as a share of their standard
/// deviation. *Decision.*
const UNKNOWN_LOUDNESS_SHARE: f64 = 0.2;
/// Smallest share of blocks of one hop that must be clear for the path to be right beyond doubt.
const CLEAR_SHARE: f64 = NEARLY_ALL;
/// Largest change of a path, in cycles of the highest line within a tick, for which its lines are not demodulated again. *Numeric.*
const NEAR_TURNS: f64 = 0.02;
/// Smallest information of a block that counts as heard, s²: a standard uncertainty of 10 rev/s. *Decision.*
const INFORMATION_MIN: f64 = 1e-2;
/// Smallest length of a steady block, s: a tone too weak to be a line in any frame is a tone if lines keep their phase for this long.
pub(crate) const STEADY_S_MIN: f64 = HEARD_S_MIN;
/// Likelihood of a steady block, in units of the likelihood that stands out of the noise.
const STEADY_TIMES: f64 = CLEAR_TIMES;
/// Likelihood that a search over 100 000 resolution cells finds in noise; a steady block must reach this in addition. *Decision.*
const SEARCH_LIKELIHOOD: f64 = 20.0;
/// Smallest likelihood of the blocks of a coherent chunk, as a share of the likelihood over noise of blocks of one hop. The hum of a
/// machine leaves a tenth.
const COHERENT_SHARE: f64 = MANY;

/// Estimates the speed along stretches of sound.
pub(crate) struct HarmonicTracer {
    map: SpeedMap,
    track: HarmonicTrack,
}

impl HarmonicTracer {
    /// A tracer of the lines of `bands`, which all cover the same speeds.
    pub(crate) fn new(sample_rate_hz: f64, bands: &[ChannelBand]) -> InChunks<Self> {
        let cutter = ChunkCutter::new(sample_rate_hz, bands);
        let (low_rev_s, high_rev_s) = limits_rev_s(bands);
        let map = SpeedMap::new(cutter.channels(), low_rev_s, high_rev_s, cutter.hop_s(), &mut ComplexPlanner::new());
        let track = HarmonicTrack {
            step_s: cutter.hop_s(),
            lines: bands.iter().map(|band| LineRecord { order: band.order, ..LineRecord::default() }).collect(),
            ..HarmonicTrack::default()
        };
        InChunks::new(cutter, Self { map, track })
    }
}

impl ChunkListener for HarmonicTracer {
    type Output = HarmonicTrack;

    fn take_chunk(&mut self, chunk: &Chunk<'_>) {
        let Self { map, track } = self;
        match content_of_chunk(chunk, map, &mut track.lines) {
            Some(ChunkContent::One { partition, between, is_coherent }) => {
                let place = ChunkPlace {
                    start_s: chunk.start_s,
                    tick_s: chunk.tick_s,
                    line_count: chunk.channels.len(),
                    limits_rev_s: map.limits_rev_s(),
                };
                let at = |fit: &BlockFit| block_at(fit, is_coherent, &place);
                track.blocks.extend(partition.blocks.iter().map(at));
                track.between.extend(between.iter().map(at).filter(|block| block.is_heard));
            }
            Some(ChunkContent::Several(centroids)) => {
                let frame_s = (FRAME_HOPS * TICKS_PER_HOP) as f64 * chunk.tick_s;
                track.blocks.extend(blocks_of_several(&centroids, chunk.start_s, frame_s));
            }
            None => {}
        }
        track.limit_blocks();
    }

    fn end_stretch(&mut self, end_s: f64) {
        if let Some(last) = self.track.blocks.last_mut().filter(|last| last.span.to_s > end_s) {
            *last = last.until(end_s);
        }
    }

    fn finish(self) -> HarmonicTrack {
        self.track.finished()
    }
}

/// The content of a chunk.
enum ChunkContent {
    /// One rotor, or several at one speed.
    One {
        partition: Partition,
        /// Blocks from the middle of each block to the middle of the next.
        between: Vec<BlockFit>,
        /// Whether the blocks keep most of the likelihood of short blocks, so that the lines keep their phase.
        is_coherent: bool,
    },
    /// Several rotors: the distribution of power over speed in each frame.
    Several(Vec<Centroid>),
}

/// Analyses a chunk, and adds the contribution of each line to its record. `None` where the chunk is shorter than a frame.
fn content_of_chunk(chunk: &Chunk<'_>, map: &mut SpeedMap, records: &mut [LineRecord]) -> Option<ChunkContent> {
    let (tick_s, ticks) = (chunk.tick_s, chunk.ticks);
    let map_path = map.path_through(&chunk.series, &chunk.noise_variances, TICKS_PER_HOP as f64 * tick_s);
    let path = SpeedPath::through(&map_path.points, tick_s, ticks)?;
    let used: Vec<usize> = (0..chunk.channels.len()).filter(|&index| !is_foreign(&map_path.powers[index])).collect();
    for (index, (record, powers)) in records.iter_mut().zip(&map_path.powers).enumerate() {
        record.on_path += powers.on_path;
        record.chunks += 1;
        record.chunks_left_out += u32::from(!used.contains(&index));
    }
    if map_path.off_path_share > SEVERAL_SHARE {
        return Some(ChunkContent::Several(map.centroids(&map_path.powers, &chunk.noise_variances)));
    }
    let lines = ChunkLines { chunk, used: &used, powers: &map_path.powers };
    let Found { partition, along, is_coherent } = lines.found(path, map_path.steady_rev_s)?;
    let points = partition.points(likelihood_min(used.len()), tick_s);
    let Some(path) = SpeedPath::through(&points, tick_s, ticks) else {
        return Some(ChunkContent::One { partition, between: Vec::new(), is_coherent });
    };
    let order_max = used.iter().map(|&index| chunk.channels[index].order).fold(1.0, f64::max);
    let near_rev_s = NEAR_TURNS / (order_max * tick_s);
    let AlongPath { lines, path } =
        along.filter(|along| along.path.is_within(near_rev_s, &path)).unwrap_or_else(|| lines.along(path));
    let partition = joined(&lines, &path, &partition);
    Some(ChunkContent::One { between: blocks_between(&lines, &path, &partition), partition, is_coherent })
}

/// The lines of a chunk without foreign sounds in their bands.
struct ChunkLines<'a> {
    chunk: &'a Chunk<'a>,
    /// Indices of the channels.
    used: &'a [usize],
    powers: &'a [LinePowers],
}

/// Lines demodulated along a path.
struct AlongPath {
    lines: Vec<Line>,
    path: SpeedPath,
}

/// The best partition of a chunk.
struct Found {
    partition: Partition,
    /// The lines along the path from which the partition was made, where this path is right beyond doubt.
    along: Option<AlongPath>,
    /// As in [`ChunkContent::One`].
    is_coherent: bool,
}

impl ChunkLines<'_> {
    /// Demodulates the lines along a path.
    fn along(&self, path: SpeedPath) -> AlongPath {
        let line = |&index: &usize| {
            let channel = &self.chunk.channels[index];
            let samples_per_tick = channel.hop_samples / TICKS_PER_HOP;
            Line {
                order: channel.order,
                is_first: channel.is_first,
                is_strong: self.powers[index].on_path > STRONG_POWER_MIN,
                noise_variance: self.chunk.noise_variances[index],
                leakage_band_hz: channel.centre_hz - channel.rate_hz / 2.0..channel.centre_hz + channel.rate_hz / 2.0,
                samples_per_tick: samples_per_tick as f64,
                ticks: demodulated(self.chunk.series[index], LinePlace::of_channel(channel), samples_per_tick, &path),
            }
        };
        AlongPath { lines: self.used.iter().map(line).collect(), path }
    }

    /// The best partition, from the path of the map. Where single blocks are weak, a rotor with one line of speed through the whole
    /// chunk, near `steady_rev_s`, is tried as well.
    fn found(&self, path: SpeedPath, steady_rev_s: f64) -> Option<Found> {
        let (tick_s, ticks, line_count) = (self.chunk.tick_s, self.chunk.ticks, self.used.len());
        let threshold = likelihood_min(line_count);
        let rough = self.along(path);
        let coarse = first_partition(&rough.lines, &rough.path);
        drop(rough);
        let heard: Vec<SpeedPoint> = coarse
            .blocks
            .iter()
            .filter(|block| block.likelihood >= threshold)
            .map(|block| SpeedPoint { time_s: block.middle_s(tick_s), speed_rev_s: block.speed_rev_s })
            .collect();
        let better_path =
            SpeedPath::through(&heard, tick_s, ticks).filter(|_| coarse.heard_share(line_count, 1.0) > 0.5);
        let following = better_path.map(|path| {
            let along = self.along(path);
            (best_partition(&along.lines, &along.path, &coarse), along)
        });
        let (partition, along) = match following {
            Some((partition, along)) if coarse.heard_share(line_count, CLEAR_TIMES) > CLEAR_SHARE => {
                (partition, Some(along))
            }
            following => {
                let steady = [SpeedPoint { time_s: 0.0, speed_rev_s: steady_rev_s }];
                let steady = self.along(SpeedPath::through(&steady, tick_s, ticks)?);
                let straight = straight_partition(&steady.lines, &steady.path);
                let is_explained = straight.likelihood() > COHERENT_SHARE * coarse.likelihood_of_heard(line_count);
                let best = match following {
                    Some((partition, _)) if is_explained => straight.or_better(partition),
                    Some((partition, _)) => partition,
                    None if is_explained => straight,
                    None => coarse.clone(),
                };
                (best, None)
            }
        };
        let is_coherent = partition.likelihood() > COHERENT_SHARE * coarse.likelihood_over_noise(line_count);
        Some(Found { partition, along, is_coherent })
    }
}

/// Blocks of several rotors, one for each frame: the mean of their speeds, weighted by their power.
fn blocks_of_several(centroids: &[Centroid], start_s: f64, frame_s: f64) -> Vec<HarmonicBlock> {
    centroids
        .iter()
        .enumerate()
        .filter(|(_, centroid)| centroid.energy > 0.0)
        .map(|(frame, centroid)| {
            let speed_rev_s = centroid.first / centroid.energy;
            let spread_rev_s = (centroid.second / centroid.energy - speed_rev_s * speed_rev_s).max(0.0).sqrt();
            let from_s = start_s + frame as f64 * frame_s;
            HarmonicBlock {
                span: Span { from_s, to_s: from_s + frame_s },
                speed_rev_s,
                slope_rev_s2: 0.0,
                variance_rev2_s2: 0.0,
                std_uncertainty_rev_s: UNKNOWN_LOUDNESS_SHARE * spread_rev_s,
                level_db: power_db(centroid.strongest_power),
                step_to_next_turns: None,
                is_several: true,
                is_heard: true,
                is_steady: false,
            }
        })
        .collect()
}

/// Smallest number of lines of a family that must keep their phase in a steady block: half of those by which a blade pass, or a gear mesh, is
/// recognised.
fn steady_lines_min(lines: usize) -> u32 {
    let recognised_by = if lines >= SERIES_LINES as usize { SERIES_LINES } else { MESH_LINES };
    recognised_by.div_ceil(2)
}

/// Whether the band of a line holds a sound much stronger than the line.
fn is_foreign(powers: &LinePowers) -> bool {
    powers.in_band > FOREIGN_POWER_MIN && powers.in_band > FOREIGN_RATIO * powers.on_path
}

/// A chunk on the clock of the recording, the number of its lines, and the lowest and highest speed that is searched.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ChunkPlace {
    pub(crate) start_s: f64,
    pub(crate) tick_s: f64,
    pub(crate) line_count: usize,
    pub(crate) limits_rev_s: (f64, f64),
}

/// A block on the clock of the recording, with the decisions whether it is heard and whether it is steady. `is_coherent`: whether the
/// lines of the chunk keep their phase.
pub(crate) fn block_at(fit: &BlockFit, is_coherent: bool, chunk: &ChunkPlace) -> HarmonicBlock {
    let ChunkPlace { start_s, tick_s, line_count, limits_rev_s: (low_rev_s, high_rev_s) } = *chunk;
    let threshold = likelihood_min(line_count);
    let at = |tick: usize| start_s + tick as f64 * tick_s;
    HarmonicBlock {
        span: Span { from_s: at(fit.tick_from), to_s: at(fit.tick_to) },
        speed_rev_s: fit.speed_rev_s,
        slope_rev_s2: fit.slope_rev_s2,
        variance_rev2_s2: 0.0,
        std_uncertainty_rev_s: (fit.phase_scatter / fit.information + fit.bend_variance).sqrt(),
        step_to_next_turns: fit.step_to_next_turns,
        is_several: false,
        level_db: power_db(fit.strongest_power),
        is_heard: fit.likelihood >= threshold
            && fit.information > INFORMATION_MIN
            && (low_rev_s..=high_rev_s).contains(&fit.speed_rev_s),
        is_steady: (fit.tick_to - fit.tick_from) as f64 * tick_s >= STEADY_S_MIN
            && fit.lines_heard >= steady_lines_min(line_count)
            && fit.is_first_heard
            && is_coherent
            && fit.likelihood >= STEADY_TIMES * threshold + SEARCH_LIKELIHOOD,
    }
}

#[cfg(test)]
mod tests;
