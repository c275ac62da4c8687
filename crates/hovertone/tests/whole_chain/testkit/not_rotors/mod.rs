//! The adversary: sounds that are no rotor and may be taken for one. Each is drawn from a seed, at an rms of 0.1.

mod electric;
mod machines;
mod music;
mod voice;
mod weather;

use super::SAMPLE_RATE_HZ;
use hovertone_sim::prescribed::{Line, Noise, Recording, Rotor, Sampling};
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use std::f64::consts::TAU;

/// A kind of sound that is no rotor.
#[derive(Clone, Copy)]
pub(crate) struct Kind {
    pub(crate) name: &'static str,
    make: fn(&mut Dice, f64) -> Vec<f64>,
}

/// Rms of every sound before it is mixed.
pub(crate) const RMS: f64 = 0.1;

pub(crate) const KINDS: [Kind; 15] = [
    Kind { name: "mains hum", make: electric::mains_hum },
    Kind { name: "mains hum in noise", make: electric::mains_hum_in_noise },
    Kind { name: "transformer", make: electric::transformer },
    Kind { name: "ESC beeps", make: electric::beeps },
    Kind { name: "PWM whine", make: electric::pwm_whine },
    Kind { name: "speech", make: voice::speech },
    Kind { name: "melody", make: music::melody },
    Kind { name: "chords", make: music::chords },
    Kind { name: "percussion", make: music::percussion },
    Kind { name: "singing", make: music::singing },
    Kind { name: "helicopter", make: machines::helicopter },
    Kind { name: "engine", make: machines::engine },
    Kind { name: "wind", make: weather::wind },
    Kind { name: "noise with an echo", make: weather::echo },
    Kind { name: "impulses", make: weather::impulses },
];

impl Kind {
    /// Its sound from a seed, at an rms of [`RMS`].
    pub(crate) fn sound(&self, seed: u64, length_s: f64) -> Vec<f32> {
        let mut samples = (self.make)(&mut Dice::new(seed), length_s);
        let rms = (samples.iter().map(|x| x * x).sum::<f64>() / samples.len() as f64).sqrt();
        samples.iter_mut().for_each(|x| *x *= RMS / rms);
        samples.into_iter().map(|x| x as f32).collect()
    }
}

/// Random numbers of a sound.
pub(crate) struct Dice(rand_pcg::Pcg64);

impl Dice {
    pub(crate) fn new(seed: u64) -> Self {
        Self(rand_pcg::Pcg64::seed_from_u64(seed))
    }

    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.0.random::<f64>()
    }

    pub(crate) fn pick<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.0.random_range(0..of.len())]
    }

    pub(crate) fn normal(&mut self) -> f64 {
        StandardNormal.sample(&mut self.0)
    }

    /// White noise of a standard deviation.
    pub(crate) fn noise(&mut self, std: f64, count: usize) -> Vec<f64> {
        self.coloured(&Noise::white(std), count)
    }

    fn coloured(&mut self, noise: &Noise, count: usize) -> Vec<f64> {
        let mut recording = Recording::of_rotors(&[], Sampling::of_count(SAMPLE_RATE_HZ, count));
        recording.add_noise(noise, &mut self.0);
        recording.samples().to_vec()
    }
}

pub(crate) fn sample_count(length_s: f64) -> usize {
    (length_s * SAMPLE_RATE_HZ) as usize
}

/// Partials of a fundamental that may change, each sample times a level.
pub(crate) fn series(
    length_s: f64,
    partials: &[Line],
    fundamental_hz: impl Fn(f64) -> f64,
    level: impl Fn(f64) -> f64,
) -> Vec<f64> {
    let source = Rotor::new(fundamental_hz, partials.to_vec()).with_level(level);
    let sampling = Sampling::of_count(SAMPLE_RATE_HZ, sample_count(length_s));
    Recording::of_rotors(&[source], sampling).samples().to_vec()
}

/// A sine at a multiple of the fundamental; its phase grows with the square of the multiple, so that partials do not peak
/// together.
pub(crate) fn partial(multiple: f64, level: f64) -> Line {
    Line::new(multiple, level).with_phase_rad(TAU * (0.37 * multiple * multiple - 0.25))
}

/// Partials whose levels fall by this many dB per octave.
pub(crate) fn falling(count: u32, db_per_octave: f64) -> Vec<Line> {
    (1..=count).map(f64::from).map(|k| partial(k, k.powf(-db_per_octave / 6.02))).collect()
}

pub(crate) fn add(into: &mut [f64], what: &[f64], times: f64) {
    into.iter_mut().zip(what).for_each(|(into, x)| *into += times * x);
}

/// Adds a sound from a time on, as far as there is room.
pub(crate) fn add_at(into: &mut [f64], from_s: f64, what: &[f64]) {
    let first = sample_count(from_s).min(into.len());
    add(&mut into[first..], what, 1.0);
}

/// A resonance: two poles at `hz`, `width_hz` wide, gain 1 at its peak.
pub(crate) fn resonated(samples: &[f64], hz: f64, width_hz: f64) -> Vec<f64> {
    let radius = (-std::f64::consts::PI * width_hz / SAMPLE_RATE_HZ).exp();
    let turn = TAU * hz / SAMPLE_RATE_HZ;
    let gain = (1.0 - radius) * (1.0 - 2.0 * radius * (2.0 * turn).cos() + radius * radius).sqrt();
    let (mut before, mut earlier) = (0.0, 0.0);
    samples
        .iter()
        .map(|x| {
            let y = gain * x + 2.0 * radius * turn.cos() * before - radius * radius * earlier;
            (earlier, before) = (before, y);
            y
        })
        .collect()
}

/// Noise that falls by 6 dB per octave above a frequency.
pub(crate) fn red_noise(dice: &mut Dice, corner_hz: f64, length_s: f64) -> Vec<f64> {
    let pole = (-TAU * corner_hz / SAMPLE_RATE_HZ).exp();
    dice.coloured(&Noise::low_passed(1.0, pole, 0.0), sample_count(length_s))
}
