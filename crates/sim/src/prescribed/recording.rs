//! Rotors, echoes and noise put together in memory, with the truth.

use super::echoes::Echoes;
use super::noise::Noise;
use super::rotor::Rotor;
use super::sampling::Sampling;
use super::truth::{Truth, TruthRow};
use rand::Rng;

/// Sound in memory, and the truth about the rotors in it.
///
/// Call the functions in the order in which sound travels: rotors, a room, noise, the recorder's gain. Rotors use no random
/// numbers; phases, levels and wanders are drawn before, by the caller, so the caller decides the order of the draws.
#[derive(Clone, Debug)]
pub struct Recording {
    samples: Vec<f64>,
    truth: Truth,
}

impl Recording {
    /// The sum of rotors. Without rotors: silence, and a truth without rows.
    pub fn of_rotors(rotors: &[Rotor<'_>], sampling: Sampling) -> Self {
        let mut samples = vec![0.0; sampling.sample_count()];
        let mut rows: Vec<TruthRow> = Vec::new();
        for rotor in rotors {
            let truth = rotor.add_to(&mut samples, &sampling);
            if rows.is_empty() {
                let empty =
                    |row| TruthRow { time_s: sampling.row_time_s(row), rotors: Vec::with_capacity(rotors.len()) };
                rows = (0..truth.len()).map(empty).collect();
            }
            rows.iter_mut().zip(truth).for_each(|(row, truth)| row.rotors.push(truth));
        }
        Self { samples, truth: Truth::from_rows(rows) }
    }

    /// Adds the echoes of a room to everything so far.
    pub fn add_echoes(&mut self, echoes: &Echoes) {
        self.samples = echoes.of(&self.samples);
    }

    /// Adds noise.
    pub fn add_noise(&mut self, noise: &Noise, random: &mut impl Rng) {
        noise.add_to(&mut self.samples, random);
    }

    /// Multiplies all samples by a gain.
    pub fn scale(&mut self, gain: f64) {
        self.samples.iter_mut().for_each(|sample| *sample *= gain);
    }

    /// Scales so that the largest sample has this magnitude.
    pub fn scale_to_peak(&mut self, peak: f64) {
        let found = self.samples.iter().fold(0.0_f64, |found, sample| found.max(sample.abs()));
        self.samples.iter_mut().for_each(|sample| *sample = peak * *sample / found);
    }

    /// The samples.
    pub fn samples(&self) -> &[f64] {
        &self.samples
    }

    /// The samples in single precision.
    pub fn samples_f32(&self) -> Vec<f32> {
        self.samples.iter().map(|sample| *sample as f32).collect()
    }

    /// The truth about the rotors, in their order.
    pub fn truth(&self) -> &Truth {
        &self.truth
    }
}
