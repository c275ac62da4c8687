//! Several rotors told apart from one microphone.
//!
//! In each chunk of up to ten seconds: what they share, where the vehicle bobs (`motion`); spectra of all lines in short frames along
//! it (`spectra`); a path for each rotor with the others taken away (`search`, `scores`), once in a wide band of speeds, which misses
//! none, and again in what is then known to hold them all; the amplitudes of all lines solved for together, so that each rotor is heard
//! alone (`separation`) and its path is known more finely (`retrace`), and then all of them as one pattern, where they bob (`together`); and
//! then the same likelihood as for a single rotor (`partition`, `join`). Which rotor is which, where they cross, their loudness tells
//! (`identity`).

mod atoms;
mod chunk;
mod grid;
mod hearing;
mod histories;
mod identity;
mod labellings;
mod line_weights;
mod loudness;
mod mixture;
mod motion;
mod pace;
mod paths;
mod phase_kept;
mod retrace;
mod scores;
mod search;
mod separation;
mod settings;
mod spectra;
mod together;

pub use settings::RotorsConfig;

use crate::harmonic::{
    Chunk, ChunkCutter, ChunkListener, ChunkPlace, HarmonicBlock, HarmonicTrack, InChunks, NoiseDensity, block_at,
    limits_rev_s,
};
use crate::thresholds::FEW;
use atoms::{ChannelAtoms, atoms_of};
use chunk::{HeardRotor, band_of_tracks, resolution_rev_s, rotors_of_chunk, rough_tracks};
use histories::Histories;
use hovertone_analysis::Span;
use hovertone_signal::channels::ChannelBand;
use hovertone_signal::fft::ComplexPlanner;
use hovertone_signal::statistics::median;
use identity::{Identity, Labelling, Steps, TrackFrame};
use pace::Pace;
use spectra::FRAME_TICKS;
use std::ops::RangeInclusive;

/// Lines that keep less of their phase than this are wider than frames resolve. *Decision.*
const PHASE_KEPT_MIN: f64 = 0.6;
/// Factor by which two rotors must then be further apart than else: any path through a wide line is a resolution or two from any other. *Decision.*
const WIDE_LINE_FACTOR: f64 = 4.0;
/// Largest share of the time in which they may be closer.
const WIDE_LINE_SHARE_MAX: f64 = FEW;

/// Looks where the rotors are, in a wide band of speeds.
pub(crate) struct RotorScout {
    atoms: Vec<ChannelAtoms>,
    limits_rev_s: (f64, f64),
    count: usize,
    planner: ComplexPlanner,
    rough: RoughRotors,
}

/// Where rotors are, roughly.
#[derive(Clone, Debug, Default)]
pub(crate) struct RoughRotors {
    count: usize,
    limits_rev_s: (f64, f64),
    chunks: Vec<RoughChunk>,
}

/// What a scout knows of a chunk.
#[derive(Clone, Debug, Default)]
struct RoughChunk {
    /// The speed of each rotor in each frame.
    tracks: Vec<Vec<f64>>,
    pace: Pace,
    /// Noise of each line: in a wide band the lines themselves take up less.
    noise: Vec<NoiseDensity>,
}

/// Follows the speeds of several rotors through the stretches of sound in which a scout has been before.
pub(crate) struct RotorTracer {
    atoms: Vec<ChannelAtoms>,
    limits_rev_s: (f64, f64),
    /// How far two rotors must be apart to be told so, if they do not bob.
    steady_resolution_rev_s: f64,
    planner: ComplexPlanner,
    identity: Identity,
    /// End of the sound that was listened to so far.
    heard_to_s: f64,
    histories: Histories,
    rough: std::vec::IntoIter<RoughChunk>,
    tracks: RotorTracks,
}

/// The tracks of several rotors.
#[derive(Clone, Debug, Default)]
pub(crate) struct RotorTracks {
    pub(crate) rotors: Vec<RotorTrack>,
    /// How far two rotors must be apart to be told so.
    pub(crate) resolution_rev_s: f64,
    /// How long was listened to.
    pub(crate) length_s: f64,
    /// For how long of that a rotor of a quarter of the loudest one's power would have been heard.
    pub(crate) faint_s: f64,
    /// For how long rotors were close to each other, where they often were: then some of them may be the beats of others.
    pub(crate) close_s: f64,
    /// For how long one more rotor was heard in what all of them leave. 0 where their number is known.
    pub(crate) another_s: f64,
    /// For how long they all sped up and slowed down together, by some percent in some tenths of a second.
    pub(crate) bobbing_s: f64,
    /// Whether too few of them are told apart to say of any what it does by itself: then they have a mean.
    pub(crate) are_one_group: bool,
}

impl RotorTracks {
    /// How many have a track.
    pub(crate) fn heard_count(&self) -> usize {
        self.rotors.iter().filter(|rotor| rotor.is_heard()).count()
    }

    /// The same of so many rotors: those that have a track, and others without one.
    pub(crate) fn of_count(mut self, count: usize) -> Self {
        self.rotors.sort_by_key(|rotor| !rotor.is_heard());
        self.rotors.resize_with(count, RotorTrack::default);
        self
    }
}

/// One rotor.
#[derive(Clone, Debug, Default)]
pub(crate) struct RotorTrack {
    pub(crate) track: HarmonicTrack,
    /// When it is closer to another rotor than can be told apart, or not heard.
    pub(crate) merged: Vec<Span>,
    /// When it is not heard, and no other rotor hides it: then it may be anywhere.
    pub(crate) lost: Vec<Span>,
    /// Standard uncertainty of its mean speed, because it may have changed places with a rotor that it met.
    pub(crate) exchange_std_rev_s: f64,
}

impl RotorTrack {
    pub(crate) fn is_heard(&self) -> bool {
        self.track.blocks.iter().any(|block| block.is_heard)
    }
}

impl RotorScout {
    /// Looks for `count` rotors in the lines of `bands`, which all stand for the same limits of speed. `mesh_order` is the order of
    /// the gear mesh, if there is one.
    pub(crate) fn new(
        sample_rate_hz: f64,
        bands: &[ChannelBand],
        mesh_order: Option<f64>,
        count: usize,
    ) -> InChunks<Self> {
        let cutter = ChunkCutter::new(sample_rate_hz, bands);
        let limits_rev_s = limits_rev_s(bands);
        let scout = Self {
            atoms: atoms_of(cutter.channels(), mesh_order),
            limits_rev_s,
            count,
            planner: ComplexPlanner::new(),
            rough: RoughRotors { count, limits_rev_s, chunks: Vec::new() },
        };
        InChunks::new(cutter, scout)
    }
}

impl ChunkListener for RotorScout {
    type Output = RoughRotors;

    fn take_chunk(&mut self, chunk: &Chunk<'_>) {
        let (low_rev_s, high_rev_s) = self.limits_rev_s;
        let (tracks, pace) = rough_tracks(chunk, &self.atoms, &(low_rev_s..=high_rev_s), self.count, &mut self.planner);
        self.rough.chunks.push(RoughChunk { tracks, pace, noise: chunk.noise_densities() });
    }

    fn finish(self) -> RoughRotors {
        self.rough
    }
}

impl RoughRotors {
    /// The band of speeds in which they all are.
    pub(crate) fn band_rev_s(&self) -> RangeInclusive<f64> {
        let (low_rev_s, high_rev_s) = self.limits_rev_s;
        band_of_tracks(self.chunks.iter().flat_map(|chunk| &chunk.tracks), &(low_rev_s..=high_rev_s))
    }
}

impl RotorTracer {
    /// Hears rotors in the lines of `bands`, which all stand for the same limits of speed.
    pub(crate) fn new(
        sample_rate_hz: f64,
        bands: &[ChannelBand],
        mesh_order: Option<f64>,
        rough: RoughRotors,
    ) -> InChunks<Self> {
        let cutter = ChunkCutter::new(sample_rate_hz, bands);
        let step_s = cutter.tick_s() * FRAME_TICKS as f64;
        let rotor = RotorTrack { track: HarmonicTrack { step_s, ..HarmonicTrack::default() }, ..RotorTrack::default() };
        let steady_resolution_rev_s = resolution_rev_s(bands);
        let tracer = Self {
            atoms: atoms_of(cutter.channels(), mesh_order),
            limits_rev_s: limits_rev_s(bands),
            steady_resolution_rev_s,
            planner: ComplexPlanner::new(),
            identity: Identity::default(),
            heard_to_s: 0.0,
            histories: Histories::of(rough.count),
            tracks: RotorTracks {
                rotors: vec![rotor; rough.count],
                resolution_rev_s: steady_resolution_rev_s,
                ..RotorTracks::default()
            },
            rough: rough.chunks.into_iter(),
        };
        InChunks::new(cutter, tracer)
    }

    /// The blocks from the middle of one to the middle of the next.
    fn blocks_between(&self, rotor: &HeardRotor, place: &ChunkPlace) -> Vec<HarmonicBlock> {
        let between = rotor.between.iter().map(|fit| block_at(fit, true, place));
        between.filter(|block| block.is_heard).collect()
    }

    /// The blocks of a rotor. Where its lines do not keep their phase, or are too weak for that, it goes along the line that the
    /// search followed, known as well as the search resolves.
    fn blocks_of(&self, rotor: &HeardRotor, place: &ChunkPlace, resolution_rev_s: f64) -> Vec<HarmonicBlock> {
        let mut blocks = Vec::new();
        for fit in &rotor.level.blocks {
            let block = block_at(fit, true, place);
            if block.is_heard {
                blocks.push(block);
                continue;
            }
            for tick_from in (fit.tick_from..fit.tick_to).step_by(FRAME_TICKS) {
                let tick_to = (tick_from + FRAME_TICKS).min(fit.tick_to);
                let (from, to) = (rotor.traced.speed_rev_s(tick_from), rotor.traced.speed_rev_s(tick_to));
                let at = |tick: usize| place.start_s + tick as f64 * place.tick_s;
                let span = Span { from_s: at(tick_from), to_s: at(tick_to) };
                blocks.push(HarmonicBlock {
                    span,
                    speed_rev_s: (from + to) / 2.0,
                    slope_rev_s2: (to - from) / span.length_s(),
                    std_uncertainty_rev_s: resolution_rev_s,
                    step_to_next_turns: None,
                    is_heard: true,
                    is_steady: false,
                    ..block
                });
            }
        }
        blocks
    }
}

impl ChunkListener for RotorTracer {
    type Output = RotorTracks;

    fn known_noise(&self) -> &[NoiseDensity] {
        self.rough.as_slice().first().map_or(&[], |rough| &rough.noise)
    }

    fn take_chunk(&mut self, chunk: &Chunk<'_>) {
        let rough = self.rough.next().unwrap_or_default();
        let (start_s, tick_s, length_s) = (chunk.start_s, chunk.tick_s, chunk.ticks as f64 * chunk.tick_s);
        let heard = rotors_of_chunk(chunk, &self.atoms, &rough, &mut self.planner);
        let frame_s = FRAME_TICKS as f64 * tick_s;
        let frames: Vec<Vec<TrackFrame>> = heard.iter().map(|rotor| rotor.frames(tick_s)).collect();
        let resolution_rev_s = self.steady_resolution_rev_s * rough.pace.shorter();
        let Labelling { tracks: labelling, meetings } = self.identity.labelled(
            &frames,
            &Steps { frame_s, pace: rough.pace, resolution_rev_s, gap_s: start_s - self.heard_to_s },
        );
        self.heard_to_s = start_s + length_s;
        let of = |rotor: usize, frame: usize| &frames[labelling[frame][rotor]][frame];
        let speeds: Vec<Vec<f64>> = (0..heard.len())
            .map(|rotor| (0..labelling.len()).map(|frame| of(rotor, frame).speed_rev_s).collect())
            .collect();
        self.histories.take(&speeds, &meetings);
        let limits_rev_s = self.limits_rev_s;
        let place = |rotor: &HeardRotor| ChunkPlace { start_s, tick_s, line_count: rotor.line_count, limits_rev_s };
        self.tracks.resolution_rev_s = self.tracks.resolution_rev_s.max(resolution_rev_s);
        let blocks: Vec<Vec<HarmonicBlock>> =
            heard.iter().map(|rotor| self.blocks_of(rotor, &place(rotor), resolution_rev_s)).collect();
        let between: Vec<Vec<HarmonicBlock>> =
            heard.iter().map(|rotor| self.blocks_between(rotor, &place(rotor))).collect();
        self.tracks.length_s += length_s;
        self.tracks.bobbing_s += if rough.pace == Pace::Bobbing { length_s } else { 0.0 };
        self.tracks.faint_s += heard.iter().map(|rotor| rotor.faint_share).fold(0.0, f64::max) * length_s;
        self.tracks.close_s += heard.first().map_or(0.0, |rotor| rotor.close_share) * length_s;
        self.tracks.another_s += heard.first().map_or(0.0, |rotor| rotor.another_share) * length_s;
        let phases_kept: Vec<f64> = heard.iter().filter_map(|rotor| rotor.phase_kept).collect();
        // frames as short as rotors that bob ask for make all lines wide
        let are_wide = rough.pace == Pace::Bobbing || median(&phases_kept).is_some_and(|kept| kept < PHASE_KEPT_MIN);
        let apart_rev_s = if are_wide { WIDE_LINE_FACTOR * resolution_rev_s } else { resolution_rev_s };
        let is_close = |rotor: usize, other: usize, frame: usize| {
            (of(other, frame).speed_rev_s - of(rotor, frame).speed_rev_s).abs() < apart_rev_s
        };
        for (rotor, RotorTrack { track, merged, lost, .. }) in self.tracks.rotors.iter_mut().enumerate() {
            // of two in one place the first stands for both
            let hidden: Vec<bool> =
                (0..labelling.len()).map(|frame| (0..rotor).any(|other| is_close(rotor, other, frame))).collect();
            let hidden_frames = hidden.iter().filter(|&&is_hidden| is_hidden).count();
            let is_part_of_another = are_wide && hidden_frames as f64 > WIDE_LINE_SHARE_MAX * hidden.len() as f64;
            for (frame, labels) in labelling.iter().enumerate() {
                let span =
                    Span { from_s: start_s + frame as f64 * frame_s, to_s: start_s + (frame + 1) as f64 * frame_s };
                let is_hidden = is_part_of_another || hidden[frame];
                let hides = (rotor + 1..labels.len()).any(|other| is_close(rotor, other, frame));
                let is_lost = !is_hidden && !hides && !of(rotor, frame).is_heard;
                if is_hidden || is_lost {
                    extend(merged, span);
                }
                if is_lost {
                    extend(lost, span);
                }
            }
            // stretches in which the rotor keeps one track
            let mut from = 0;
            while let Some(first) = labelling.get(from) {
                let kept = labelling[from..].iter().take_while(|labels| labels[rotor] == first[rotor]).count();
                let to = from + kept;
                let end_s = if to == labelling.len() { f64::INFINITY } else { start_s + to as f64 * frame_s };
                let stretch = Span { from_s: start_s + from as f64 * frame_s, to_s: end_s };
                // the search knows even the shortest part to within its resolution
                let part_of = |block: &HarmonicBlock| {
                    let part = block.within(stretch)?;
                    let std_uncertainty_rev_s = part.std_uncertainty_rev_s.min(resolution_rev_s);
                    Some(HarmonicBlock { std_uncertainty_rev_s, ..part })
                };
                track.blocks.extend(blocks[first[rotor]].iter().filter_map(part_of));
                track.between.extend(between[first[rotor]].iter().filter_map(part_of));
                from = to;
            }
            track.limit_blocks();
        }
    }

    fn end_stretch(&mut self, end_s: f64) {
        for last in self.tracks.rotors.iter_mut().filter_map(|rotor| rotor.track.blocks.last_mut()) {
            *last = last.until(end_s.min(last.span.to_s));
        }
    }

    /// The rotors, in no order.
    fn finish(mut self) -> RotorTracks {
        for (rotor, exchange_std_rev_s) in self.tracks.rotors.iter_mut().zip(self.histories.stds_rev_s()) {
            rotor.track = std::mem::take(&mut rotor.track).finished();
            rotor.exchange_std_rev_s = exchange_std_rev_s;
        }
        self.tracks
    }
}

/// Adds a span to those before it, of which it may continue the last.
fn extend(spans: &mut Vec<Span>, span: Span) {
    match spans.last_mut().filter(|last| span.from_s - last.to_s < span.length_s() / 2.0) {
        Some(last) => last.to_s = span.to_s,
        None => spans.push(span),
    }
}
