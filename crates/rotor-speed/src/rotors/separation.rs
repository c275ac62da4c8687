//! Channels → lines of one rotor each: the amplitudes of all rotors' lines in a channel are solved for together, frame by frame,
//! and what belongs to the others is taken away.

use super::atoms::ChannelAtoms;
use super::mixture::Mixture;
use super::scores::worth;
use super::spectra::{FRAME_TICKS, frame_middle_ticks, half_frame_ticks, phasors};
use crate::harmonic::chunks::Chunk;
use crate::harmonic::demodulation::{Line, LinePlace};
use crate::harmonic::speed_map::{HANN_NOISE_CELLS, STRONG_POWER_MIN};
use crate::harmonic::speed_path::SpeedPath;
use crate::thresholds::{FEW, MOST};
use hovertone_signal::channels::TICKS_PER_HOP;
use hovertone_signal::spectrogram::hann_weights;
use realfft::num_complex::Complex;

/// Two lines closer than this in a frame cannot be told apart: order · Δf · T ≥ 1.25, measured with frames under a Hann window. *Numeric.*
pub(super) const RESOLVED_CELLS: f64 = 1.25;
/// A rotor of a fifth of another one's power is a faint one.
const FAINT_SHARE: f64 = FEW;
/// Lines are taken away but for the ridge's 2 % of their amplitude, and a part of what AM and bends put beside them. *Numeric.*
const GHOST_SHARE: f64 = 1.0 / 100.0;
/// A line that is apart from all others in less than this share of a chunk is not heard for its speed.
const APART_SHARE_MIN: f64 = MOST;

/// What belongs to one rotor.
pub(super) struct SeparatedRotor {
    pub(super) lines: Vec<Line>,
    /// Amplitude of each channel's own line in each frame, relative to noise; 0 where it is not apart from the others.
    pub(super) levels: Vec<Vec<f64>>,
    /// What the rotor's lines are worth in each frame beside those of the others.
    pub(super) worths: Vec<f64>,
    /// The same for a rotor of a quarter of its power.
    pub(super) faint_worths: Vec<f64>,
    /// What is left of its lines where they are not quite taken away may be worth this.
    pub(super) ghost_worths: Vec<f64>,
}

/// One line of one rotor in a channel.
struct Atom {
    rotor: usize,
    order: f64,
    phasors: Vec<Complex<f32>>,
    /// Amplitude in each frame.
    amplitudes: Vec<Complex<f64>>,
    /// For the channel's own line: share of its energy in each frame that nothing else explains.
    shares: Vec<f64>,
}

/// Takes the rotors apart whose speeds are `paths`, each line being worth its weight; and what is left of each channel.
pub(super) fn separated(
    chunk: &Chunk<'_>,
    atoms: &[ChannelAtoms],
    paths: &[SpeedPath],
    frame_s_of_order: impl Fn(f64) -> f64,
    line_weights: &[f64],
) -> (Vec<SeparatedRotor>, Vec<Vec<Complex<f32>>>) {
    let frames = chunk.ticks / FRAME_TICKS;
    let nothing = || SeparatedRotor {
        lines: Vec::new(),
        levels: Vec::new(),
        worths: vec![0.0; frames],
        faint_worths: vec![0.0; frames],
        ghost_worths: vec![0.0; frames],
    };
    let mut rotors: Vec<SeparatedRotor> = paths.iter().map(|_| nothing()).collect();
    let mut rests = Vec::with_capacity(atoms.len());
    for (index, atoms) in atoms.iter().enumerate() {
        let channel = &chunk.channels[index];
        let frame_ticks = 2 * half_frame_ticks(frame_s_of_order(channel.order), chunk.tick_s);
        let mut mixed = MixedChannel::new(chunk, index, atoms, paths);
        let apart = mixed.solve(chunk, index, paths, frame_ticks);
        mixed.take_away(chunk.ticks);
        let samples_per_tick = mixed.samples_per_tick;
        for (rotor, separated) in rotors.iter_mut().enumerate() {
            let own = mixed.atoms.iter().find(|atom| atom.rotor == rotor && atom.order == channel.order);
            let apart = &apart[rotor];
            let power = |amplitude: &Complex<f64>| {
                amplitude.norm_sqr() * (frame_ticks * samples_per_tick) as f64
                    / (HANN_NOISE_CELLS * chunk.noise_variances[index])
            };
            let levels: Vec<f64> = match own {
                Some(own) => own
                    .amplitudes
                    .iter()
                    .zip(apart)
                    .map(|(amplitude, &is_apart)| if is_apart { power(amplitude).sqrt() } else { 0.0 })
                    .collect(),
                None => vec![0.0; apart.len()],
            };
            let frames_apart = apart.iter().filter(|&&is_apart| is_apart).count();
            if let Some(own) = own.filter(|_| frames_apart as f64 >= APART_SHARE_MIN * apart.len() as f64) {
                let mean_power = levels.iter().map(|level| level * level).sum::<f64>() / frames_apart.max(1) as f64;
                separated.lines.push(Line {
                    order: channel.order,
                    is_first: channel.is_first,
                    is_strong: mean_power > STRONG_POWER_MIN,
                    noise_variance: chunk.noise_variances[index],
                    leakage_band_hz: 0.0..0.0,
                    samples_per_tick: samples_per_tick as f64,
                    ticks: mixed.ticks_of(own, chunk.ticks),
                });
            }
            separated.levels.push(levels);
            if let Some(own) = own {
                let of_line = own.amplitudes.iter().zip(&own.shares).map(|(amplitude, share)| power(amplitude) * share);
                let likelihoods = of_line.map(|likelihood| line_weights[index] * likelihood);
                for (frame, likelihood) in likelihoods.enumerate() {
                    separated.worths[frame] += worth(likelihood);
                    separated.faint_worths[frame] += worth(FAINT_SHARE * likelihood);
                    separated.ghost_worths[frame] += worth(GHOST_SHARE * likelihood);
                }
            }
        }
        rests.push(mixed.rest);
    }
    (rotors, rests)
}

/// A channel as a sum of atoms.
struct MixedChannel {
    samples_per_tick: usize,
    atoms: Vec<Atom>,
    /// What no atom explains.
    rest: Vec<Complex<f32>>,
}

impl MixedChannel {
    fn new(chunk: &Chunk<'_>, index: usize, channel_atoms: &ChannelAtoms, paths: &[SpeedPath]) -> Self {
        let channel = &chunk.channels[index];
        let samples_per_tick = channel.hop_samples / TICKS_PER_HOP;
        let samples = chunk.ticks * samples_per_tick;
        let place = |order: f64| LinePlace { order, ..LinePlace::of_channel(channel) };
        let atoms = paths
            .iter()
            .enumerate()
            .flat_map(|(rotor, path)| channel_atoms.orders.iter().map(move |&order| (rotor, path, order)))
            .filter(|(_, path, order)| (order * path.mean_rev_s() - channel.centre_hz).abs() < channel.rate_hz / 2.0)
            .map(|(rotor, path, order)| Atom {
                rotor,
                order,
                phasors: phasors(place(order), path, samples_per_tick, samples),
                amplitudes: Vec::new(),
                shares: Vec::new(),
            })
            .collect();
        Self { samples_per_tick, atoms, rest: chunk.series[index].to_vec() }
    }

    /// Amplitudes of all atoms in all frames; and for each rotor and frame, whether its own line is apart from those of others.
    fn solve(&mut self, chunk: &Chunk<'_>, index: usize, paths: &[SpeedPath], frame_ticks: usize) -> Vec<Vec<bool>> {
        let length = frame_ticks * self.samples_per_tick;
        let frame_s = frame_ticks as f64 * chunk.tick_s;
        let window: Vec<f32> = hann_weights(length).map(|weight| weight as f32).collect();
        let sum_of = |weights: &[f32]| weights.iter().map(|&weight| f64::from(weight)).sum::<f64>();
        let whole_weight = sum_of(&window);
        let mut mixture = Mixture::default();
        let series = chunk.series[index];
        let own_order = chunk.channels[index].order;
        let frames = chunk.ticks / FRAME_TICKS;
        let mut apart = vec![Vec::with_capacity(frames); paths.len()];
        let mut places = vec![0.0; self.atoms.len()];
        let mut seen = vec![Complex::<f64>::default(); self.atoms.len()];
        for frame in 0..frames {
            let middle = frame_middle_ticks(frame) * self.samples_per_tick;
            let from = middle.saturating_sub(length / 2);
            let to = (middle + length / 2).min(series.len());
            let window = &window[from + length / 2 - middle..to + length / 2 - middle];
            let weight = if window.len() == length { whole_weight } else { sum_of(window) };
            let speed_of = |rotor: usize| paths[rotor].speed_rev_s(frame_middle_ticks(frame));
            for ((atom, place), seen) in self.atoms.iter().zip(&mut places).zip(&mut seen) {
                *seen = weighted_product(&series[from..to], &atom.phasors[from..to], window) / weight;
                *place = atom.order * speed_of(atom.rotor) * frame_s;
            }
            let mut is_apart = vec![true; paths.len()];
            for (index, atom) in self.atoms.iter().enumerate().filter(|(_, atom)| atom.order == own_order) {
                let nearest = self.atoms.iter().zip(&places).filter(|(other, _)| other.rotor != atom.rotor);
                let nearest = nearest.map(|(_, place)| (place - places[index]).abs()).fold(f64::INFINITY, f64::min);
                is_apart[atom.rotor] = nearest >= RESOLVED_CELLS;
            }
            apart.iter_mut().zip(is_apart).for_each(|(apart, is_apart)| apart.push(is_apart));
            // what one line sees of another: exactly, because each leaves its frequency along its own path
            let gram = |a: usize, b: usize| {
                let (a, b) = (&self.atoms[a].phasors[from..to], &self.atoms[b].phasors[from..to]);
                weighted_product(b, a, window) / weight
            };
            mixture.mix(places.len(), |atom| places[atom], gram);
            for (atom, amplitude) in self.atoms.iter_mut().zip(mixture.amplitudes(&seen)) {
                atom.amplitudes.push(*amplitude);
            }
            for (index, atom) in self.atoms.iter_mut().enumerate() {
                if atom.order == own_order {
                    atom.shares.push(mixture.share_of_its_own(index));
                }
            }
        }
        apart
    }

    /// Subtracts all atoms.
    fn take_away(&mut self, ticks: usize) {
        for atom in &self.atoms {
            let rests = self.rest.chunks_exact_mut(self.samples_per_tick);
            let phasors = atom.phasors.chunks_exact(self.samples_per_tick);
            for ((rest, phasors), tick) in rests.zip(phasors).zip(0..ticks) {
                let amplitude = atom.amplitude_at(tick);
                let amplitude = Complex::new(amplitude.re as f32, amplitude.im as f32);
                rest.iter_mut().zip(phasors).for_each(|(rest, phasor)| *rest -= amplitude * phasor);
            }
        }
    }

    /// One atom and what is left beside all of them, turned back and summed in each tick.
    fn ticks_of(&self, atom: &Atom, ticks: usize) -> Vec<Complex<f64>> {
        let rests = self.rest.chunks_exact(self.samples_per_tick);
        let phasors = atom.phasors.chunks_exact(self.samples_per_tick);
        (0..ticks)
            .zip(rests.zip(phasors))
            .map(|(tick, (rest, phasors))| {
                let rest: Complex<f32> = rest.iter().zip(phasors).map(|(z, phasor)| z * phasor.conj()).sum();
                to_f64(rest) + atom.amplitude_at(tick) * self.samples_per_tick as f64
            })
            .collect()
    }
}

impl Atom {
    /// Amplitude in the middle of a tick, between those of the frames.
    fn amplitude_at(&self, tick: usize) -> Complex<f64> {
        let place = (tick as f64 + 0.5 - frame_middle_ticks(0) as f64) / FRAME_TICKS as f64;
        let last = self.amplitudes.len().saturating_sub(1);
        let before = (place.max(0.0) as usize).min(last);
        let share = (place - before as f64).clamp(0.0, 1.0);
        match (self.amplitudes.get(before), self.amplitudes.get((before + 1).min(last))) {
            (Some(a), Some(b)) => a + (b - a) * share,
            _ => Complex::default(),
        }
    }
}

/// Σ a b* w; written so that it runs in vectors.
fn weighted_product(a: &[Complex<f32>], b: &[Complex<f32>], weights: &[f32]) -> Complex<f64> {
    /// Sums that are kept apart, which the compiler turns into vector instructions. *Numeric.*
    const LANES: usize = 8;
    let lanes = |from: usize, re: &mut [f32], im: &mut [f32]| {
        let products = a[from..].iter().zip(&b[from..]).zip(&weights[from..]);
        for ((re, im), ((a, b), weight)) in re.iter_mut().zip(im).zip(products) {
            *re += weight * (a.re * b.re + a.im * b.im);
            *im += weight * (a.im * b.re - a.re * b.im);
        }
    };
    let (mut re, mut im) = ([0.0f32; LANES], [0.0f32; LANES]);
    let whole = weights.len() / LANES * LANES;
    for from in (0..whole).step_by(LANES) {
        lanes(from, &mut re, &mut im);
    }
    let rest = weights.len() - whole;
    lanes(whole, &mut re[..rest], &mut im[..rest]);
    to_f64(Complex::new(re.iter().sum(), im.iter().sum()))
}

fn to_f64(z: Complex<f32>) -> Complex<f64> {
    Complex::new(f64::from(z.re), f64::from(z.im))
}
