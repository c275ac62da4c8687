//! What one microphone hears of every rotor's lines: complex amplitudes in blocks, those of all rotors solved for together.

use crate::by_microphones::MicrophonesConfig;
use crate::speed_curve::SpeedCurve;
use hovertone_analysis::TrackPoint;
use hovertone_rotor_speed::{ToneConfig, lines_between_speeds};
use hovertone_signal::line_solver::{INFLATION_MAX, SolvedLines};
use hovertone_signal::passes::{Passes, Piece, Progress};
use hovertone_signal::spectrogram::hann_weights;
use hovertone_signal::{SignalError, SignalSource};
use hovertone_vehicle::{BLADES_MAX, MESH_SIDEBANDS};
use realfft::num_complex::Complex;
use std::f64::consts::TAU;

/// Samples over which a rotor's speed is taken for constant: at most 8 ms.
const CHUNK: usize = 64;
/// Beyond so many resolution cells one line does not disturb another: the lobes of a Hann block are below -60 dB there. A speed may
/// change by [`WANDER_SHARE`] within a block besides.
const REACH_CELLS: f64 = 6.0;
const WANDER_SHARE: f64 = 0.005;
/// Noise is that beside each line, half a turn of the shaft above it, where no rotor sounds.
const BESIDE: f64 = 0.5;

pub(super) type C = Complex<f64>;

/// What one microphone heard of the lines of several rotors. Amplitudes count from the angle of the rotor's shaft, which is the same
/// for all microphones.
#[derive(Clone, Debug)]
pub struct MicrophoneLines {
    /// Mean speed of each rotor.
    pub(super) speeds_rev_s: Vec<f64>,
    pub(super) lines: Vec<LineBlocks>,
}

/// One line of every rotor, block by block.
#[derive(Clone, Debug)]
pub(super) struct LineBlocks {
    /// Lines per turn.
    pub(super) order: f64,
    pub(super) blocks: Vec<LineBlock>,
}

/// A line in one block: of each rotor, nothing where it is not apart from others.
#[derive(Clone, Debug)]
pub(super) struct LineBlock {
    pub(super) start_s: f64,
    /// Amplitude, and by how much the others widen its variance.
    pub(super) amplitudes: Vec<Option<(C, f64)>>,
    /// Power of noise beside the line.
    pub(super) noise: Vec<Option<f64>>,
}

/// Hears the lines of rotors whose speeds are known, in one channel.
///
/// `tracks` are those of the rotors that were told apart, `tone` says which lines they have. Every line of every rotor, with the
/// sidebands of a gear mesh, is solved for together by least squares in blocks of up to [`MicrophonesConfig::block_s`] along the rotors'
/// turns, for [`MicrophonesConfig::listen_s_max`] at most. All channels of a recording have to be heard with the same tracks.
///
/// # Errors
/// A source that fails, an impossible sample rate.
pub fn microphone_lines_from_source(
    source: &mut dyn SignalSource,
    tracks: &[&[TrackPoint]],
    tone: &ToneConfig,
    config: &MicrophonesConfig,
    on_progress: &mut dyn FnMut(Progress),
) -> Result<MicrophoneLines, SignalError> {
    let mut passes = Passes::planned(source, 1, on_progress)?;
    let mut reader = LineReader::new(passes.sample_rate_hz(), tracks, tone, config);
    let times = || tracks.iter().copied().flatten().map(|point| point.time_s);
    let from_s = times().fold(f64::INFINITY, f64::min);
    let to_s = times().fold(f64::NEG_INFINITY, f64::max).min(from_s + config.listen_s_max);
    let span_s = from_s..to_s;
    if !span_s.is_empty() {
        passes.pieces(std::slice::from_ref(&span_s), |piece| match piece {
            Piece::Start(start_s) => reader.next_s = start_s,
            Piece::Samples(samples) => reader.push(samples),
            Piece::Heard(_) => {}
        })?;
    }
    let lines = reader.banks.into_iter().flat_map(|bank| bank.lines).collect();
    Ok(MicrophoneLines { speeds_rev_s: reader.speeds_rev_s, lines })
}

/// Follows the rotors' turns through the samples.
struct LineReader {
    sample_rate_hz: f64,
    speeds_rev_s: Vec<f64>,
    curves: Vec<SpeedCurve>,
    next_s: f64,
    pending: Vec<f32>,
    banks: Vec<LineBank>,
}

/// Lines that are heard in blocks of one length.
struct LineBank {
    block_s: f64,
    rotors: usize,
    /// Those of each rotor in a row: lines, what is beside them, and others that may disturb them.
    atoms: Vec<Atom>,
    /// Hann window of a block.
    window: Vec<f64>,
    block: Option<BlockSums>,
    lines: Vec<LineBlocks>,
}

/// One complex exponential along a rotor's turns.
#[derive(Clone, Copy, Debug)]
struct Atom {
    rotor: usize,
    order: f64,
}

/// Some samples, weighted by nothing yet, and the turns of all rotors at their start and over them.
struct Chunk<'a> {
    start_s: f64,
    length_s: f64,
    samples: &'a [f32; CHUNK],
    from_turns: Vec<f64>,
    made_turns: Vec<f64>,
}

/// Sums over a block, as chunks come in.
struct BlockSums {
    start_s: f64,
    samples: usize,
    weights: f64,
    /// Product of the sound with each atom.
    sound: Vec<C>,
    /// Atoms that are near each other, and their products.
    pairs: Vec<(usize, usize, C)>,
}

impl LineReader {
    fn new(sample_rate_hz: f64, tracks: &[&[TrackPoint]], tone: &ToneConfig, config: &MicrophonesConfig) -> Self {
        let mean_rev_s = |track: &&[TrackPoint]| {
            track.iter().map(|point| point.speed_rev_s).sum::<f64>() / (track.len() as f64).max(1.0)
        };
        let speeds_rev_s: Vec<f64> = tracks.iter().map(mean_rev_s).collect();
        let fastest_rev_s = speeds_rev_s.iter().copied().fold(0.0, f64::max);
        let slowest_rev_s = speeds_rev_s.iter().copied().fold(fastest_rev_s, f64::min);
        let bands = lines_between_speeds((slowest_rev_s, fastest_rev_s), tone, sample_rate_hz);
        let orders: Vec<f64> = bands.iter().map(|band| band.order).collect();
        let mesh_order = Some(tone.order.lines_per_turn()).filter(|order| *order > BLADES_MAX);
        let is_mesh = |order: f64| mesh_order.is_some_and(|mesh| (order / mesh).fract() == 0.0);
        let sidebands =
            orders.iter().filter(|order| is_mesh(**order)).flat_map(|order| MESH_SIDEBANDS.map(|away| order + away));
        let sounding: Vec<f64> = orders.iter().copied().chain(sidebands).collect();
        // the length of a block in halvings of the longest
        let halvings = |order: f64| (config.block_s * order / config.block_order_s).log2().ceil().max(0.0) as u32;
        let mut lengths: Vec<u32> = orders.iter().map(|order| halvings(*order)).collect();
        lengths.dedup();
        // how far the lines of two rotors may be apart in order and still fall on each other
        let reach = fastest_rev_s / slowest_rev_s.max(f64::MIN_POSITIVE) * (1.0 + 2.0 * WANDER_SHARE);
        let banks = lengths.into_iter().map(|length| {
            let own: Vec<f64> = orders.iter().copied().filter(|order| halvings(*order) == length).collect();
            let is_other = |order: &f64| own.iter().all(|line| (line - order).abs() > 0.1);
            let disturbs =
                |order: &f64| own.iter().any(|line| *order < line * reach + 1.0 && *order > line / reach - 1.0);
            let others = sounding.iter().copied().filter(|order| is_other(order) && disturbs(order));
            let block_s = config.block_s / f64::from(2u32.saturating_pow(length));
            LineBank::new(sample_rate_hz, block_s, tracks.len(), own.clone(), others.collect())
        });
        Self {
            sample_rate_hz,
            curves: tracks.iter().map(|track| SpeedCurve::through(track)).collect(),
            next_s: 0.0,
            pending: Vec::new(),
            banks: banks.collect(),
            speeds_rev_s,
        }
    }

    fn push(&mut self, samples: &[f32]) {
        let mut pending = std::mem::take(&mut self.pending);
        pending.extend_from_slice(samples);
        let (chunks, rest) = pending.as_chunks::<CHUNK>();
        chunks.iter().for_each(|chunk| self.take(chunk));
        self.pending = rest.to_vec();
    }

    fn take(&mut self, samples: &[f32; CHUNK]) {
        let (start_s, length_s) = (self.next_s, CHUNK as f64 / self.sample_rate_hz);
        self.next_s += length_s;
        let from: Option<Vec<f64>> = self.curves.iter_mut().map(|curve| curve.turns_at(start_s)).collect();
        let to: Option<Vec<f64>> = self.curves.iter_mut().map(|curve| curve.turns_at(start_s + length_s)).collect();
        let (Some(from_turns), Some(to)) = (from, to) else {
            // where a rotor is not followed nothing is known of its phase: the blocks are lost
            self.banks.iter_mut().for_each(|bank| bank.block = None);
            return;
        };
        let made_turns = from_turns.iter().zip(&to).map(|(from, to)| to - from).collect();
        let chunk = Chunk { start_s, length_s, samples, from_turns, made_turns };
        self.banks.iter_mut().for_each(|bank| bank.take(&chunk));
    }
}

impl LineBank {
    fn new(sample_rate_hz: f64, block_s: f64, rotors: usize, own: Vec<f64>, others: Vec<f64>) -> Self {
        let beside = own.iter().map(|order| order + BESIDE);
        let of_rotor: Vec<f64> = own.iter().copied().chain(beside).chain(others).collect();
        let atoms = (0..rotors).flat_map(|rotor| of_rotor.iter().map(move |&order| Atom { rotor, order }));
        let length = (block_s * sample_rate_hz / CHUNK as f64).round().max(1.0) as usize * CHUNK;
        Self {
            block_s,
            rotors,
            atoms: atoms.collect(),
            window: hann_weights(length).collect(),
            block: None,
            lines: own.into_iter().map(|order| LineBlocks { order, blocks: Vec::new() }).collect(),
        }
    }

    fn take(&mut self, chunk: &Chunk<'_>) {
        let (atoms, window) = (&self.atoms, &self.window);
        let block = self.block.get_or_insert_with(|| BlockSums::new(chunk, self.block_s, atoms));
        let window = &window[block.samples..block.samples + CHUNK];
        let weighted: Vec<f64> =
            window.iter().zip(chunk.samples).map(|(weight, sample)| weight * f64::from(*sample)).collect();
        for (atom, sum) in atoms.iter().zip(&mut block.sound) {
            let step = turned(-atom.order * chunk.made_turns[atom.rotor] / CHUNK as f64);
            let mut phasor = turned(-atom.order * chunk.from_turns[atom.rotor]);
            for sample in &weighted {
                *sum += phasor * *sample;
                phasor *= step;
            }
        }
        let weight: f64 = window.iter().sum();
        let middle =
            |atom: &Atom| turned(atom.order * (chunk.from_turns[atom.rotor] + chunk.made_turns[atom.rotor] / 2.0));
        for (a, b, sum) in &mut block.pairs {
            *sum += middle(&atoms[*a]).conj() * middle(&atoms[*b]) * weight;
        }
        block.weights += weight;
        block.samples += CHUNK;
        if block.samples >= self.window.len()
            && let Some(block) = self.block.take()
        {
            let solved = block.solved();
            let of_rotor = self.atoms.len() / self.rotors;
            let count = self.lines.len();
            for (index, line) in self.lines.iter_mut().enumerate() {
                let of =
                    |place: usize| (0..self.rotors).map(|rotor| solved[rotor * of_rotor + place]).collect::<Vec<_>>();
                let power = |beside: Option<(C, f64)>| beside.map(|(noise, inflation)| noise.norm_sqr() / inflation);
                line.blocks.push(LineBlock {
                    start_s: block.start_s,
                    amplitudes: of(index),
                    noise: of(count + index).into_iter().map(power).collect(),
                });
            }
        }
    }
}

/// exp(2π i turns).
fn turned(turns: f64) -> C {
    let (im, re) = (TAU * turns.fract()).sin_cos();
    C::new(re, im)
}

impl BlockSums {
    fn new(chunk: &Chunk<'_>, block_s: f64, atoms: &[Atom]) -> Self {
        let hz: Vec<f64> =
            atoms.iter().map(|atom| atom.order * chunk.made_turns[atom.rotor] / chunk.length_s).collect();
        let is_near =
            |a: usize, b: usize| (hz[a] - hz[b]).abs() < REACH_CELLS / block_s + WANDER_SHARE * hz[a].max(hz[b]);
        let pairs = (0..hz.len())
            .flat_map(|a| (a + 1..hz.len()).map(move |b| (a, b)))
            .filter(|&(a, b)| is_near(a, b))
            .map(|(a, b)| (a, b, C::default()))
            .collect();
        Self { start_s: chunk.start_s, samples: 0, weights: 0.0, sound: vec![C::default(); atoms.len()], pairs }
    }

    /// The amplitude of each atom, and by how much the others widen its variance; nothing where they widen it too much.
    fn solved(&self) -> Vec<Option<(C, f64)>> {
        let mut solved = vec![None; self.sound.len()];
        for group in self.groups() {
            let entry = |a: usize, b: usize| {
                if a == b {
                    return C::new(self.weights, 0.0);
                }
                let pair = self.pairs.iter().find(|pair| (pair.0, pair.1) == (a.min(b), a.max(b)));
                let product = pair.map_or(C::default(), |pair| pair.2);
                if a < b { product } else { product.conj() }
            };
            let products: Vec<C> = group.iter().map(|&atom| self.sound[atom]).collect();
            let gram = |row: usize, column: usize| entry(group[row], group[column]);
            let Some(lines) = SolvedLines::from_normal_equations(gram, &products) else { continue };
            for (row, &atom) in group.iter().enumerate() {
                let inflation = lines.variance(row) * self.weights;
                solved[atom] = (inflation <= INFLATION_MAX).then_some((lines.amplitudes()[row], inflation));
            }
        }
        solved
    }

    /// Atoms that are near each other, or near one that is.
    fn groups(&self) -> Vec<Vec<usize>> {
        let mut group_of: Vec<usize> = (0..self.sound.len()).collect();
        for &(a, b, _) in &self.pairs {
            let (kept, joined) = (group_of[a], group_of[b]);
            group_of.iter_mut().filter(|group| **group == joined).for_each(|group| *group = kept);
        }
        let members = |group: usize| (0..group_of.len()).filter(|&atom| group_of[atom] == group).collect::<Vec<_>>();
        (0..group_of.len()).map(members).filter(|members| !members.is_empty()).collect()
    }
}
