//! Amplitudes of the lines of all rotors in blocks of one length, solved together by least squares.

use hovertone_signal::line_solver::{INFLATION_MAX, SolvedLines};
use hovertone_signal::spectrogram::hann_weights;
use realfft::num_complex::Complex;
use std::f64::consts::TAU;

/// Audio samples over which a rotor's speed is taken as constant: 8 ms at the lowest usual rate, 8 kHz. *Numeric.*
pub(super) const CHUNK: usize = 64;
/// Distance in resolution cells beyond which two lines do not overlap: the side lobes of a Hann block are below −58 dB there. *Numeric.*
const OVERLAP_CELLS: f64 = 6.0;
/// Change of a speed within a block, as a share: lines may come this much closer. *Decision.*
pub(super) const WANDER_SHARE: f64 = 0.005;
/// Distance from a line at which the noise is measured, in orders: half a shaft turn above it no rotor sounds. *Decision.*
const NOISE_ORDER: f64 = 0.5;

pub(super) type C = Complex<f64>;

/// One line of every rotor, block by block.
#[derive(Clone, Debug)]
pub(super) struct LineBlocks {
    /// Lines per turn.
    pub(super) order: f64,
    pub(super) blocks: Vec<LineBlock>,
}

/// One line of every rotor in one block.
#[derive(Clone, Debug)]
pub(super) struct LineBlock {
    pub(super) start_s: f64,
    /// For each rotor; none where the line cannot be separated from others.
    pub(super) amplitudes: Vec<Option<LineAmplitude>>,
    /// Power of the noise beside the line, for each rotor.
    pub(super) noise: Vec<Option<f64>>,
}

/// Amplitude of a line, relative to the angle of the rotor's shaft.
#[derive(Clone, Copy, Debug)]
pub(super) struct LineAmplitude {
    pub(super) amplitude: C,
    /// Variance inflation factor: by how much overlapping lines increase the variance.
    pub(super) inflation: f64,
}

/// A short piece of sound, and the rotors' turns at its start and within it.
pub(super) struct Chunk<'a> {
    pub(super) start_s: f64,
    pub(super) length_s: f64,
    pub(super) samples: &'a [f32; CHUNK],
    pub(super) from_turns: Vec<f64>,
    pub(super) made_turns: Vec<f64>,
}

/// Lines that are solved in blocks of one length.
pub(super) struct LineBank {
    block_s: f64,
    rotors: usize,
    /// Rotor by rotor: its lines, the places of noise beside them, and other lines that may overlap them.
    components: Vec<Component>,
    /// Hann window of a block.
    window: Vec<f64>,
    block: Option<BlockSums>,
    lines: Vec<LineBlocks>,
}

/// A complex exponential along a rotor's turns.
#[derive(Clone, Copy, Debug)]
struct Component {
    rotor: usize,
    order: f64,
}

/// Sums over a block, as chunks come in, weighted by the window.
struct BlockSums {
    start_s: f64,
    samples: usize,
    weights: f64,
    /// Product of the sound with each component.
    sound: Vec<C>,
    overlaps: Vec<Overlap>,
}

/// Product of two components that overlap, `a < b`.
struct Overlap {
    a: usize,
    b: usize,
    product: C,
}

impl LineBank {
    /// A bank for the lines of orders `own`; lines of orders `others` may overlap them.
    pub(super) fn new(sample_rate_hz: f64, block_s: f64, rotors: usize, own: Vec<f64>, others: Vec<f64>) -> Self {
        let noise = own.iter().map(|order| order + NOISE_ORDER);
        let of_rotor: Vec<f64> = own.iter().copied().chain(noise).chain(others).collect();
        let components = (0..rotors).flat_map(|rotor| of_rotor.iter().map(move |&order| Component { rotor, order }));
        let length = (block_s * sample_rate_hz / CHUNK as f64).round().max(1.0) as usize * CHUNK;
        Self {
            block_s,
            rotors,
            components: components.collect(),
            window: hann_weights(length).collect(),
            block: None,
            lines: own.into_iter().map(|order| LineBlocks { order, blocks: Vec::new() }).collect(),
        }
    }

    /// The lines of all complete blocks.
    pub(super) fn into_lines(self) -> Vec<LineBlocks> {
        self.lines
    }

    /// Drops the block that is not complete.
    pub(super) fn drop_block(&mut self) {
        self.block = None;
    }

    pub(super) fn add(&mut self, chunk: &Chunk<'_>) {
        let components = &self.components;
        let block = self.block.get_or_insert_with(|| BlockSums::new(chunk, self.block_s, components));
        block.add(chunk, components, &self.window[block.samples..block.samples + CHUNK]);
        if block.samples >= self.window.len()
            && let Some(block) = self.block.take()
        {
            self.add_lines(&block);
        }
    }

    /// Adds the lines of a complete block.
    fn add_lines(&mut self, block: &BlockSums) {
        let solved = block.solve();
        let of_rotor = self.components.len() / self.rotors;
        let count = self.lines.len();
        for (index, line) in self.lines.iter_mut().enumerate() {
            let at = |place: usize| (0..self.rotors).map(|rotor| solved[rotor * of_rotor + place]).collect::<Vec<_>>();
            let power = |noise: Option<LineAmplitude>| noise.map(|noise| noise.amplitude.norm_sqr() / noise.inflation);
            line.blocks.push(LineBlock {
                start_s: block.start_s,
                amplitudes: at(index),
                noise: at(count + index).into_iter().map(power).collect(),
            });
        }
    }
}

impl BlockSums {
    /// Empty sums. Which components overlap follows from the speeds in the first chunk of the block.
    fn new(chunk: &Chunk<'_>, block_s: f64, components: &[Component]) -> Self {
        let hz: Vec<f64> = components
            .iter()
            .map(|component| component.order * chunk.made_turns[component.rotor] / chunk.length_s)
            .collect();
        let is_overlap =
            |a: usize, b: usize| (hz[a] - hz[b]).abs() < OVERLAP_CELLS / block_s + WANDER_SHARE * hz[a].max(hz[b]);
        let overlaps = (0..hz.len())
            .flat_map(|a| (a + 1..hz.len()).map(move |b| (a, b)))
            .filter(|&(a, b)| is_overlap(a, b))
            .map(|(a, b)| Overlap { a, b, product: C::default() })
            .collect();
        Self { start_s: chunk.start_s, samples: 0, weights: 0.0, sound: vec![C::default(); components.len()], overlaps }
    }

    /// Adds a chunk with its part of the window.
    fn add(&mut self, chunk: &Chunk<'_>, components: &[Component], window: &[f64]) {
        let weighted: Vec<f64> =
            window.iter().zip(chunk.samples).map(|(weight, sample)| weight * f64::from(*sample)).collect();
        for (component, sum) in components.iter().zip(&mut self.sound) {
            let step = phasor(-component.order * chunk.made_turns[component.rotor] / CHUNK as f64);
            let mut turning = phasor(-component.order * chunk.from_turns[component.rotor]);
            for sample in &weighted {
                *sum += turning * *sample;
                turning *= step;
            }
        }
        let weight: f64 = window.iter().sum();
        let at_middle = |component: &Component| {
            let Component { rotor, order } = *component;
            phasor(order * (chunk.from_turns[rotor] + chunk.made_turns[rotor] / 2.0))
        };
        for Overlap { a, b, product } in &mut self.overlaps {
            *product += at_middle(&components[*a]).conj() * at_middle(&components[*b]) * weight;
        }
        self.weights += weight;
        self.samples += CHUNK;
    }

    /// Amplitude of each component; none where the variance inflation factor is too large.
    fn solve(&self) -> Vec<Option<LineAmplitude>> {
        let mut solved = vec![None; self.sound.len()];
        for group in self.groups() {
            let entry = |a: usize, b: usize| {
                if a == b {
                    return C::new(self.weights, 0.0);
                }
                let overlap = self.overlaps.iter().find(|overlap| (overlap.a, overlap.b) == (a.min(b), a.max(b)));
                let product = overlap.map_or(C::default(), |overlap| overlap.product);
                if a < b { product } else { product.conj() }
            };
            let products: Vec<C> = group.iter().map(|&component| self.sound[component]).collect();
            let gram = |row: usize, column: usize| entry(group[row], group[column]);
            let Some(lines) = SolvedLines::from_normal_equations(gram, &products) else { continue };
            for (row, &component) in group.iter().enumerate() {
                let inflation = lines.variance(row) * self.weights;
                let amplitude = lines.amplitudes()[row];
                solved[component] = (inflation <= INFLATION_MAX).then_some(LineAmplitude { amplitude, inflation });
            }
        }
        solved
    }

    /// Connected groups of components: each overlaps another one of its group, and none of the other groups.
    fn groups(&self) -> Vec<Vec<usize>> {
        let mut group_of: Vec<usize> = (0..self.sound.len()).collect();
        for &Overlap { a, b, .. } in &self.overlaps {
            let (kept, joined) = (group_of[a], group_of[b]);
            group_of.iter_mut().filter(|group| **group == joined).for_each(|group| *group = kept);
        }
        let members = |group: usize| (0..group_of.len()).filter(|&index| group_of[index] == group).collect::<Vec<_>>();
        (0..group_of.len()).map(members).filter(|members| !members.is_empty()).collect()
    }
}

/// `exp(2π i turns)`.
fn phasor(turns: f64) -> C {
    let (im, re) = (TAU * turns.fract()).sin_cos();
    C::new(re, im)
}
