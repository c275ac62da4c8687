//! The radiated sound of one rotor: two signals, one for each term of the directivity, readable between samples.

use super::interpolator::{Interpolator, REACH, TERMS};
use super::level::rms_pa;
use super::lines::{LineBank, UNSTEADY_STEP};
use super::noise_colour::ColouredNoise;
use super::phasors::CHUNK;
use super::settings::SourceSettings;
use crate::seed::{Part, stream};
use std::f64::consts::TAU;

/// Smallest number of samples that are removed together.
const FORGET_AT_ONCE: i64 = 256;

/// One control step; the speed is straight between its ends. Times are in samples.
#[derive(Clone, Copy)]
pub(crate) struct Stretch {
    pub(crate) from: f64,
    pub(crate) to: f64,
}

/// A rotor's signals as polynomials between samples: `terms[k][i]` is term k at sample `base + i`.
pub(crate) struct Emission {
    pub(crate) base: i64,
    pub(crate) in_plane: [Vec<f32>; TERMS],
    pub(crate) on_axis: [Vec<f32>; TERMS],
}

pub(crate) struct Source {
    settings: SourceSettings,
    sample_rate_hz: f64,
    lines: LineBank,
    noise: Option<ColouredNoise>,
    /// Turns at the start of the current stretch, and since the first state.
    turns: f64,
    /// The last `2 REACH` samples and the new ones.
    raw_in_plane: Vec<f32>,
    raw_on_axis: Vec<f32>,
    emission: Emission,
    scratch: Scratch,
    /// Gains at the end of the last chunk.
    loudness: Loudness,
}

struct Scratch {
    blades: [f32; CHUNK],
    mechanical: [f32; CHUNK],
    noise: [f32; CHUNK],
}

impl Source {
    /// A rotor whose first sample is number `start`. Its first turn is such that the turns are 0 at time 0 if the speed stays
    /// the same.
    pub(crate) fn new(
        settings: &SourceSettings,
        sample_rate_hz: f64,
        seed: u64,
        rotor: u64,
        start: i64,
        speed_rad_s: f64,
    ) -> Self {
        let noise = settings.broadband.map(|noise| {
            let random = stream(seed, Part::RotorNoise, rotor);
            let std = rms_pa(noise.level_db_spl);
            ColouredNoise::new(std, noise.slope_db_per_octave, noise.flat_below_hz, sample_rate_hz, random)
        });
        Self {
            lines: LineBank::new(settings, sample_rate_hz, stream(seed, Part::Tones, rotor)),
            loudness: Loudness::at(speed_rad_s / TAU, settings),
            settings: settings.clone(),
            sample_rate_hz,
            noise,
            turns: speed_rad_s / TAU * start as f64 / sample_rate_hz,
            raw_in_plane: vec![0.0; 2 * REACH],
            raw_on_axis: vec![0.0; 2 * REACH],
            emission: Emission {
                // Nothing was radiated before the start.
                base: start - REACH as i64,
                in_plane: std::array::from_fn(|_| Vec::new()),
                on_axis: std::array::from_fn(|_| Vec::new()),
            },
            scratch: Scratch { blades: [0.0; CHUNK], mechanical: [0.0; CHUNK], noise: [0.0; CHUNK] },
        }
    }

    pub(crate) fn emission(&self) -> &Emission {
        &self.emission
    }

    /// First sample that cannot yet be read.
    pub(crate) fn readable_end(&self) -> i64 {
        self.emission.base + self.emission.in_plane[0].len() as i64
    }

    /// Removes the samples before this one, once there are enough of them.
    pub(crate) fn forget_before(&mut self, sample: i64) {
        let count = (sample - self.emission.base).clamp(0, self.emission.in_plane[0].len() as i64);
        // To remove samples means to move the rest, so it is done seldom.
        if count < FORGET_AT_ONCE {
            return;
        }
        for term in self.emission.in_plane.iter_mut().chain(&mut self.emission.on_axis) {
            term.drain(..count as usize);
        }
        self.emission.base += count;
    }

    pub(crate) fn buffered(&self) -> usize {
        2 * (TERMS * self.emission.in_plane[0].len() + self.raw_in_plane.len())
    }

    /// Makes samples `first..end`, all within the stretch; adds this rotor's share of the diffuse field to `diffuse`, which
    /// begins at `first`.
    pub(crate) fn extend(
        &mut self,
        stretch: Stretch,
        speeds_rad_s: [f64; 2],
        first: i64,
        end: i64,
        interpolator: &Interpolator,
        diffuse: &mut [f32],
    ) {
        let speed_rev_s = speeds_rad_s.map(|speed| speed / TAU);
        let samples = stretch.to - stretch.from;
        let mut at = first;
        while at < end {
            let to_step = UNSTEADY_STEP - at.rem_euclid(UNSTEADY_STEP);
            if to_step == UNSTEADY_STEP {
                self.lines.step();
            }
            let count = (end - at).min(to_step).min(CHUNK as i64) as usize;
            let done = (at - first) as usize;
            let offset = at as f64 - stretch.from;
            let slope_rev_s = (speed_rev_s[1] - speed_rev_s[0]) / samples;
            let speed = |sample: f64| speed_rev_s[0] + slope_rev_s * sample;
            let ends = [speed(offset), speed(offset + count as f64)];
            if ends[0] > 0.0 || ends[1] > 0.0 {
                let turns = std::array::from_fn(|sample| {
                    // By way of 32 bits, for vector conversion.
                    let u = offset + f64::from(sample as i32);
                    self.turns + (speed_rev_s[0] * u + 0.5 * slope_rev_s * u * u) / self.sample_rate_hz
                });
                let share = 1.0 - to_step as f64 / UNSTEADY_STEP as f64;
                self.radiate(&turns, ends, count, share, &mut diffuse[done..done + count]);
            } else {
                self.raw_in_plane.resize(self.raw_in_plane.len() + count, 0.0);
                self.raw_on_axis.resize(self.raw_on_axis.len() + count, 0.0);
            }
            at += count as i64;
        }
        self.turns += 0.5 * (speed_rev_s[0] + speed_rev_s[1]) * samples / self.sample_rate_hz;
        for (raw, terms) in
            [(&mut self.raw_in_plane, &mut self.emission.in_plane), (&mut self.raw_on_axis, &mut self.emission.on_axis)]
        {
            interpolator.append(raw, terms);
            let used = raw.len() - 2 * REACH;
            raw.drain(..used);
        }
    }

    /// Makes one chunk, from one speed (rev/s) to another.
    fn radiate(
        &mut self,
        turns: &[f64; CHUNK],
        ends_rev_s: [f64; 2],
        count: usize,
        step_share: f64,
        diffuse: &mut [f32],
    ) {
        let s = &self.settings;
        let scratch = &mut self.scratch;
        let fastest_rev_s = ends_rev_s[0].max(ends_rev_s[1]);
        self.lines.sum(turns, count, step_share, fastest_rev_s, &mut scratch.blades, &mut scratch.mechanical);
        if self.loudness.rev_s != ends_rev_s[0] {
            self.loudness = Loudness::at(ends_rev_s[0], s);
        }
        let before = std::mem::replace(&mut self.loudness, Loudness::at(ends_rev_s[1], s));
        let after = self.loudness;
        Ramp::between(before.blades, after.blades, count).apply(&mut scratch.blades[..count]);
        Ramp::between(before.mechanical, after.mechanical, count).apply(&mut scratch.mechanical[..count]);
        match (&mut self.noise, s.broadband) {
            (Some(noise), Some(broadband)) => {
                noise.fill(&mut scratch.noise[..count]);
                Ramp::between(before.broadband, after.broadband, count).apply(&mut scratch.noise[..count]);
                let depth = broadband.modulation_depth;
                if depth > 0.0 && s.tones.blade_pass.is_some() {
                    let mean = (1.0 / (1.0 + depth * depth / 2.0).sqrt()) as f32;
                    let swing = mean * depth as f32;
                    for (sample, cosine) in scratch.noise[..count].iter_mut().zip(self.lines.blade_cosine()) {
                        *sample *= mean + swing * cosine;
                    }
                }
            }
            _ => scratch.noise = [0.0; CHUNK],
        }
        let kinds = [s.blade_directivity, s.mechanical_directivity, s.broadband_directivity];
        let plane = kinds.map(|kind| kind.in_plane as f32);
        let axis = kinds.map(|kind| kind.on_axis as f32);
        let all = kinds.map(|kind| kind.diffuse() as f32);
        let (blades, mechanical, noise) =
            (&scratch.blades[..count], &scratch.mechanical[..count], &scratch.noise[..count]);
        let start = self.raw_in_plane.len();
        self.raw_in_plane.resize(start + count, 0.0);
        self.raw_on_axis.resize(start + count, 0.0);
        let (in_plane, on_axis) = (&mut self.raw_in_plane[start..], &mut self.raw_on_axis[start..]);
        let diffuse = &mut diffuse[..count];
        for n in 0..count {
            let (b, m, r) = (blades[n], mechanical[n], noise[n]);
            in_plane[n] = plane[0] * b + plane[1] * m + plane[2] * r;
            on_axis[n] = axis[0] * b + axis[1] * m + axis[2] * r;
            diffuse[n] += all[0] * b + all[1] * m + all[2] * r;
        }
    }
}

/// Factors on the amplitudes at one speed, with half the exponents of the powers.
#[derive(Clone, Copy)]
struct Loudness {
    rev_s: f64,
    blades: f64,
    mechanical: f64,
    broadband: f64,
}

impl Loudness {
    fn at(rev_s: f64, settings: &SourceSettings) -> Self {
        let share = rev_s.max(0.0) / settings.reference_speed.rev_s();
        let gain = |exponent: f64| if exponent == 0.0 { 1.0 } else { share.powf(exponent / 2.0) };
        Self {
            rev_s,
            blades: gain(settings.blade_speed_exponent),
            mechanical: gain(settings.mechanical_speed_exponent),
            broadband: settings.broadband.map_or(0.0, |noise| gain(noise.speed_exponent)),
        }
    }
}

/// A factor that changes along a straight line.
struct Ramp {
    from: f32,
    step: f32,
}

impl Ramp {
    fn between(from: f64, to: f64, count: usize) -> Self {
        Self { from: from as f32, step: ((to - from) / count as f64) as f32 }
    }

    fn apply(&self, samples: &mut [f32]) {
        for (number, sample) in (0_u16..).zip(samples) {
            *sample *= self.from + f32::from(number) * self.step;
        }
    }
}
