//! A hover by settings, rendered block by block: memory does not grow with the length.
//!
//! ```text
//! seed ─▶ Ornstein-Uhlenbeck ─▶ shaft (speed, phase, exact integrals) ─▶ tones ─┐
//!                   profile ──────┘                              └─▶ truth       ├─▶ fixed gain ─▶ samples
//!                                                                      noise ───┘
//! ```

mod noise;
mod paper_trial;
mod profile;
mod settings;
mod shaft;
mod tones;

pub use noise::NoiseSettings;
pub use paper_trial::PaperSimulation;
pub use profile::{ProfileParts, SpeedProfile};
pub use settings::{HoverSettings, RotorSound};

use super::phasors::BLOCK;
use super::truth::{Truth, TruthRow};
use crate::ornstein_uhlenbeck::OrnsteinUhlenbeck;
use crate::seed::{Part, stream};
use hovertone_vehicle::QuantityError;
use noise::Noise;
use shaft::{Shaft, hover_mean_sum_of_squares};
use std::f64::consts::TAU;
use tones::RotorTones;

/// The headroom counts noise up to this many standard deviations. One sample in 500 million is larger, and the other
/// half of the headroom is above it.
const NOISE_PEAK_STD: f64 = 6.0;
/// Lines near half the sample rate are left out for a wander up to this many standard deviations.
const WANDER_PEAK_STD: f64 = 6.0;

/// The sound of a hover, rendered on demand. The size of its state does not depend on the length.
///
/// The same settings give the same samples on the same machine, for any sizes of the buffers given to
/// [`render`](Self::render). A longer duration adds samples and changes none (unless there is a landing, or the hover balance
/// is held).
pub struct HoverSound {
    settings: HoverSettings,
    parts: ProfileParts,
    gain: f64,
    rotors: Vec<(Shaft, RotorTones)>,
    rotor_noise: Option<Noise>,
    ambient_noise: Option<Noise>,
    sample_count: u64,
    truth_step: u64,
    /// Number of samples made so far.
    made: u64,
    /// The last block: its samples, how many of them were handed out, and how many there are.
    block: [f64; BLOCK],
    handed_out: usize,
    in_block: usize,
}

impl HoverSound {
    /// Draws all levels and phases and fixes the gain. Fails on a setting that is out of bounds, naming it.
    pub fn new(settings: HoverSettings) -> Result<Self, QuantityError> {
        settings.check()?;
        let parts = settings.profile.parts(settings.duration_s)?;
        let rate_hz = f64::from(settings.sample_rate_hz);
        let sample_count = (settings.duration_s * rate_hz).round() as u64;
        let mut rotors: Vec<_> = (0_u64..)
            .zip(&settings.rotors)
            .map(|(index, rotor)| (shaft(&settings, index, rotor), tones(&settings, index, rotor)))
            .collect();
        if settings.hold_hover_balance {
            let shafts: Vec<_> = rotors.iter().map(|(shaft, _)| shaft.clone()).collect();
            let wanted: f64 = shafts.iter().map(|shaft| (TAU * shaft.mean_rev_s()).powi(2)).sum();
            let found = hover_mean_sum_of_squares(&shafts, &parts, sample_count, rate_hz);
            for (shaft, _) in &mut rotors {
                shaft.scale_mean_speed((wanted / found).sqrt());
            }
        }
        let rotor_noise = noise(&settings, settings.rotor_noise, Part::RotorNoise)?;
        let ambient_noise = noise(&settings, settings.ambient_noise, Part::AmbientNoise)?;
        let noise_std: f64 = [&rotor_noise, &ambient_noise].into_iter().flatten().map(Noise::std).sum();
        let peak = rotors.iter().map(|(_, tones)| tones.peak()).sum::<f64>() + NOISE_PEAK_STD * noise_std;
        let gain = if peak > 0.0 { settings.peak / peak } else { 1.0 };
        let truth_step = ((settings.truth_step_s * rate_hz).round() as u64).max(1);
        Ok(Self {
            settings,
            parts,
            gain,
            rotors,
            rotor_noise,
            ambient_noise,
            sample_count,
            truth_step,
            made: 0,
            block: [0.0; BLOCK],
            handed_out: 0,
            in_block: 0,
        })
    }

    /// The settings.
    pub fn settings(&self) -> &HoverSettings {
        &self.settings
    }

    /// The spans of take-off, hover and landing.
    pub fn parts(&self) -> ProfileParts {
        self.parts
    }

    /// Full scale per unit of level: a line of level 1 comes out with this amplitude.
    pub fn gain(&self) -> f64 {
        self.gain
    }

    /// Number of samples of the whole sound.
    pub fn sample_count(&self) -> u64 {
        self.sample_count
    }

    /// Writes the next samples, full scale ±1, and returns their number: the length of `samples`, less at the end, then 0.
    /// Appends the rows of the truth up to there, and at most 48 samples beyond, to `truth`.
    pub fn render(&mut self, samples: &mut [f32], truth: &mut Vec<TruthRow>) -> usize {
        let mut written = 0;
        while written < samples.len() {
            if self.handed_out == self.in_block {
                self.make_block(truth);
                if self.in_block == 0 {
                    break;
                }
            }
            let count = (self.in_block - self.handed_out).min(samples.len() - written);
            let made = &self.block[self.handed_out..self.handed_out + count];
            for (sample, value) in samples[written..written + count].iter_mut().zip(made) {
                *sample = *value as f32;
            }
            self.handed_out += count;
            written += count;
        }
        written
    }

    /// The rest of the sound in one piece, for short sounds.
    pub fn render_all(mut self) -> (Vec<f32>, Truth) {
        let left = self.sample_count - self.made + (self.in_block - self.handed_out) as u64;
        let (mut samples, mut rows) = (vec![0.0; left as usize], Vec::new());
        self.render(&mut samples, &mut rows);
        (samples, Truth::from_rows(rows))
    }

    fn make_block(&mut self, truth: &mut Vec<TruthRow>) {
        let sample_s = 1.0 / f64::from(self.settings.sample_rate_hz);
        let (start, parts) = (self.made, self.parts);
        let count = (self.sample_count - start).min(BLOCK as u64) as usize;
        self.handed_out = 0;
        self.in_block = count;
        if count == 0 {
            return;
        }
        let time_s = |offset: f64| (start as f64 + offset) * sample_s;
        let share: [f64; BLOCK] = std::array::from_fn(|k| parts.speed_share(time_s(k as f64)));
        let share_between: [f64; BLOCK] = std::array::from_fn(|k| parts.speed_share(time_s(k as f64 + 0.5)));
        let row_offsets: Vec<usize> =
            (0..count).filter(|&k| (start + k as u64).is_multiple_of(self.truth_step)).collect();
        let first_row = truth.len();
        let row = |offset: usize| TruthRow { time_s: time_s(offset as f64), rotors: Vec::new() };
        truth.extend(row_offsets.iter().map(|&offset| row(offset)));
        let at_end = start + count as u64 == self.sample_count;
        if at_end {
            truth.push(row(count));
        }

        let mut lines = [0.0; BLOCK];
        let silent = share.iter().all(|&share| share == 0.0);
        for (shaft, tones) in &mut self.rotors {
            shaft.begin_block();
            let mut turns = [0.0; BLOCK];
            let mut rows = truth[first_row..].iter_mut();
            let mut due = row_offsets.iter().peekable();
            for k in 0..count {
                if due.next_if(|&&offset| offset == k).is_some()
                    && let Some(row) = rows.next()
                {
                    row.rotors.push(shaft.truth(k, share[k]));
                }
                turns[k] = shaft.turn();
                shaft.advance(k, share_between[k], sample_s);
            }
            if let Some(row) = rows.next() {
                row.rotors.push(shaft.truth(count, parts.speed_share(time_s(count as f64))));
            }
            if !silent {
                tones.add(&turns, &mut lines);
            }
        }
        for k in 0..count {
            // Pressure of the lines grows with the square of the speed, power of the noise with its fifth power (edge
            // noise: Ffowcs Williams and Hall 1970). The wander is too small to be heard this way and is left out, so
            // that the carrier-to-noise density is the set one.
            let loudness = share[k] * share[k];
            let mut value = loudness * lines[k];
            if let Some(noise) = &mut self.rotor_noise {
                value += loudness * share[k].sqrt() * noise.next();
            }
            if let Some(noise) = &mut self.ambient_noise {
                value += noise.next();
            }
            self.block[k] = self.gain * value;
        }
        self.made += count as u64;
    }
}

fn shaft(settings: &HoverSettings, index: u64, rotor: &RotorSound) -> Shaft {
    let step_s = BLOCK as f64 / f64::from(settings.sample_rate_hz);
    let random = stream(settings.seed, Part::Wander, index);
    let wander = OrnsteinUhlenbeck::new(rotor.wander_std_share, rotor.wander_time_constant_s, step_s, random);
    Shaft::new(rotor.mean_speed.rev_s(), wander)
}

fn tones(settings: &HoverSettings, index: u64, rotor: &RotorSound) -> RotorTones {
    let fastest_rev_s = rotor.mean_speed.rev_s() * (1.0 + WANDER_PEAK_STD * rotor.wander_std_share);
    let order_max = f64::from(settings.sample_rate_hz) / 2.0 / fastest_rev_s;
    let level = 10_f64.powf(rotor.level_db / 20.0);
    RotorTones::new(&settings.tones, level, order_max, &mut stream(settings.seed, Part::Tones, index))
}

fn noise(settings: &HoverSettings, noise: Option<NoiseSettings>, part: Part) -> Result<Option<Noise>, QuantityError> {
    let Some(noise) = noise else { return Ok(None) };
    noise.check()?;
    let Some((order, level)) = settings.tones.reference() else {
        return Err(QuantityError { name: "lines to measure the noise against", value: 0.0, must_be: "at least one" });
    };
    let speeds_rev_s = settings.rotors.iter().map(|rotor| rotor.mean_speed.rev_s());
    let mean_rev_s = speeds_rev_s.sum::<f64>() / settings.rotors.len() as f64;
    let rate_hz = f64::from(settings.sample_rate_hz);
    let density = noise.density_at_reference(level);
    let random = stream(settings.seed, part, 0);
    Ok(Some(Noise::new(density, order * mean_rev_s, noise.slope_db_per_octave, rate_hz, random)))
}
