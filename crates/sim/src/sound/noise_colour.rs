//! Normal noise of a set level, flat up to a corner and falling with a straight slope above, fast enough for many
//! sources.

use super::noise_slope::{PoleAndZero, SlopeFilterRoots};
use rand::RngExt;
use rand_distr::StandardNormal;
use rand_pcg::Pcg64;
use std::f64::consts::TAU;

/// Poles that share an instruction.
const LANES: usize = 8;
/// Groups of poles, at most: 32 poles are 15 octaves, 10 Hz at 192 kHz.
const GROUPS_MAX: usize = 4;

/// The filter of [`SlopeFilterRoots`] as a sum of its partial fractions, `Π (1 - z_k/z) / (1 - p_k/z) = c + Σ r_k /
/// (1 - p_k/z)`, which can be computed in parallel. Poles and zeros alternate, so all r have one sign and nothing cancels.
#[derive(Clone)]
pub(crate) struct ColouredNoise {
    direct: f32,
    poles: Vec<[f32; LANES]>,
    residues: Vec<[f32; LANES]>,
    states: Vec<[f32; LANES]>,
    /// The zero that straightens the slope towards half the sample rate, and its memory.
    top_zero: f32,
    before: f32,
    random: Pcg64,
}

impl ColouredNoise {
    /// Noise of this standard deviation. The first samples are already stationary.
    pub(crate) fn new(
        std: f64,
        slope_db_per_octave: f64,
        flat_below_hz: f64,
        sample_rate_hz: f64,
        random: Pcg64,
    ) -> Self {
        let roots = SlopeFilterRoots::new(slope_db_per_octave, flat_below_hz, sample_rate_hz);
        let gain = std / mean_power_gain(&roots, flat_below_hz, sample_rate_hz).sqrt();
        let ladder = &roots.ladder;
        let fraction = |index: usize, pole: f64| {
            let factor = |other: usize, root: &PoleAndZero| {
                let rest = if other == index { 1.0 } else { 1.0 - root.pole / pole };
                (1.0 - root.zero / pole) / rest
            };
            ladder.iter().enumerate().map(|(other, root)| factor(other, root)).product::<f64>()
        };
        let mut residues: Vec<f32> =
            ladder.iter().enumerate().map(|(index, root)| (gain * fraction(index, root.pole)) as f32).collect();
        let mut poles: Vec<f32> = ladder.iter().map(|root| root.pole as f32).collect();
        poles.truncate(GROUPS_MAX * LANES);
        poles.resize(poles.len().next_multiple_of(LANES), 0.0);
        residues.resize(poles.len(), 0.0);
        let lanes = |values: &[f32]| -> Vec<[f32; LANES]> { values.as_chunks().0.to_vec() };
        let direct: f64 = gain * ladder.iter().map(|root| root.zero / root.pole).product::<f64>();
        let mut noise = Self {
            direct: direct as f32,
            states: vec![[0.0; LANES]; poles.len() / LANES],
            poles: lanes(&poles),
            residues: lanes(&residues),
            top_zero: roots.top_zero as f32,
            before: 0.0,
            random,
        };
        // The slowest pole forgets by e^-10.
        let mut settling = [0.0; 64];
        for _ in 0..(10.0 * sample_rate_hz / (TAU * flat_below_hz) / 64.0) as usize {
            noise.fill(&mut settling);
        }
        noise
    }

    /// The next samples.
    pub(crate) fn fill(&mut self, samples: &mut [f32]) {
        for sample in samples.iter_mut() {
            let white: f64 = self.random.sample(StandardNormal);
            *sample = white as f32;
        }
        match self.states.len() {
            0 => self.filter::<0>(samples),
            1 => self.filter::<1>(samples),
            2 => self.filter::<2>(samples),
            3 => self.filter::<3>(samples),
            _ => self.filter::<GROUPS_MAX>(samples),
        }
    }

    /// For a number of groups that the compiler knows, the states stay in registers.
    fn filter<const GROUPS: usize>(&mut self, samples: &mut [f32]) {
        let known = |values: &[[f32; LANES]]| -> [[f32; LANES]; GROUPS] { std::array::from_fn(|group| values[group]) };
        let (mut states, poles, residues) = (known(&self.states), known(&self.poles), known(&self.residues));
        for sample in samples {
            let white = *sample;
            let mut sums = [0.0_f32; LANES];
            for group in 0..GROUPS {
                for lane in 0..LANES {
                    let state = poles[group][lane] * states[group][lane] + residues[group][lane] * white;
                    states[group][lane] = state;
                    sums[lane] += state;
                }
            }
            let [a, b, c, d, e, f, g, h] = sums;
            let value = self.direct * white + (((a + e) + (c + g)) + ((b + f) + (d + h)));
            *sample = value - self.top_zero * self.before;
            self.before = value;
        }
        self.states.copy_from_slice(&states);
    }
}

/// Mean of |H|² over the band: variance out for variance 1 in.
fn mean_power_gain(roots: &SlopeFilterRoots, flat_below_hz: f64, sample_rate_hz: f64) -> f64 {
    // Steps of half the width of the flat part, so that no part of the slope falls between two steps.
    let count = (sample_rate_hz / flat_below_hz).max(500.0) as u32;
    let gain = |step: u32| {
        let cosine = (std::f64::consts::PI * (f64::from(step) + 0.5) / f64::from(count)).cos();
        let distance_square = |root: f64| 1.0 - 2.0 * root * cosine + root * root;
        let gain_of = |root: &PoleAndZero| distance_square(root.zero) / distance_square(root.pole);
        roots.ladder.iter().map(gain_of).product::<f64>() * distance_square(roots.top_zero)
    };
    (0..count).map(gain).sum::<f64>() / f64::from(count)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::{Part, stream};

    /// Relative standard error of a variance from N samples of noise with a band of B hertz is about 1/√(B T).
    #[test]
    fn the_level_is_the_set_one_for_all_colours() {
        for (slope, corner_hz, rate_hz) in
            [(0.0, 100.0, 44_100.0), (-3.0, 20.0, 48_000.0), (-5.0, 1000.0, 48_000.0), (-6.0, 60.0, 96_000.0)]
        {
            let mut noise = ColouredNoise::new(0.2, slope, corner_hz, rate_hz, stream(4, Part::RotorNoise, 0));
            let mut samples = vec![0.0; 2_000_000];
            noise.fill(&mut samples);
            let square = samples.iter().map(|value| f64::from(value * value)).sum::<f64>() / samples.len() as f64;
            let limit = 5.0 / (2.0 * corner_hz * samples.len() as f64 / rate_hz).sqrt();
            assert!((square / 0.04 - 1.0).abs() < limit, "{slope}: {} ± {limit}", square / 0.04);
        }
    }

    /// The sum of partial fractions has the impulse response of the product.
    #[test]
    fn partial_fractions_are_the_ladder() {
        let (slope, corner_hz, rate_hz) = (-4.0, 200.0, 48_000.0);
        let mut noise = ColouredNoise::new(1.0, slope, corner_hz, rate_hz, stream(4, Part::RotorNoise, 1));
        noise.states.iter_mut().for_each(|state| *state = [0.0; LANES]);
        noise.before = 0.0;
        let mut whites = noise.random.clone();
        let mut samples = vec![0.0; 2000];
        noise.fill(&mut samples);
        let roots = SlopeFilterRoots::new(slope, corner_hz, rate_hz);
        let gain = 1.0 / mean_power_gain(&roots, corner_hz, rate_hz).sqrt();
        let mut sections = vec![(0.0, 0.0); roots.ladder.len()];
        let mut before = 0.0;
        for sample in samples {
            let mut value: f64 = gain * whites.sample::<f64, _>(StandardNormal);
            for ((input, output), root) in sections.iter_mut().zip(&roots.ladder) {
                *output = value + root.pole * *output - root.zero * *input;
                *input = value;
                value = *output;
            }
            let expected = value - roots.top_zero * before;
            before = value;
            assert!((f64::from(sample) - expected).abs() < 1e-4, "{sample} {expected}");
        }
    }
}
