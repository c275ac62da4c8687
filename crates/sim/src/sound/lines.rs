//! The lines of one rotor: multiples of its shaft, in phase with it at every sample except for a slow unsteadiness.

use super::level::amplitude_pa;
use super::line_scatter::LineClass;
use super::phasors::{CHUNK, LANES, Phasors};
use super::settings::SourceSettings;
use rand::RngExt;
use rand_distr::StandardNormal;
use rand_pcg::Pcg64;

/// Samples between two draws of the unsteadiness; straight between them. Part of the meaning of a seed.
pub(crate) const UNSTEADY_STEP: i64 = 256;
/// Lines fade out from this share of the sample rate up to half of it, as behind a recorder's anti-alias filter.
const FADE_FROM: f64 = 0.46;

#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Complex {
    re: f32,
    im: f32,
}

/// A line `Re(a e^(iθ·order))` whose a wanders about its mean.
#[derive(Clone)]
struct Line {
    order: f64,
    mean: Complex,
    re: SlowNormal,
    im: SlowNormal,
}

/// A stationary normal process, critically damped: `y ← 2k y₁ - k² y₂ + e`, k = e^(-step/τ), with variance 1.
#[derive(Clone, Copy)]
struct SlowNormal {
    now: f64,
    before: f64,
}

impl SlowNormal {
    fn new(keep: f64, random: &mut Pcg64) -> Self {
        let (first, second): (f64, f64) = (random.sample(StandardNormal), random.sample(StandardNormal));
        let correlation = 2.0 * keep / (1.0 + keep * keep);
        Self { before: first, now: correlation * first + (1.0 - correlation * correlation).sqrt() * second }
    }

    fn step(&mut self, keep: f64, random: &mut Pcg64) {
        let square = keep * keep;
        let kick_std = ((1.0 - square).powi(3) / (1.0 + square)).sqrt();
        let kick: f64 = random.sample(StandardNormal);
        let next = 2.0 * keep * self.now - square * self.before + kick_std * kick;
        (self.before, self.now) = (self.now, next);
    }
}

/// The lines in the order in which they are summed: shaft; blade pass; for each harmonic of the mesh carrier, (above,
/// below) for each sideband, (above, below) of the pinion; motor; unlike blades.
pub(crate) struct LineBank {
    lines: Vec<Line>,
    /// Amplitudes of the present chunk.
    amplitudes: Vec<Complex>,
    blade_count: u32,
    blade_lines: usize,
    mesh_order: u32,
    mesh_harmonics: usize,
    sidebands: usize,
    /// Motor turns per turn of the rotor; `None` without pinion sidebands.
    pinion_order: Option<f64>,
    pinion_teeth: u32,
    motor_order: f64,
    motor_lines: usize,
    unlike_lines: usize,
    order_max: f64,
    unsteadiness: f64,
    keep: f64,
    sample_rate_hz: f64,
    random: Pcg64,
    shaft: Phasors,
    mesh: Phasors,
    pinion: Phasors,
    motor: Phasors,
    blade_cosine: [f32; CHUNK],
}

impl LineBank {
    pub(crate) fn new(settings: &SourceSettings, sample_rate_hz: f64, mut random: Pcg64) -> Self {
        let keep = (-(UNSTEADY_STEP as f64) / sample_rate_hz / settings.unsteadiness_time_constant_s).exp();
        let unit_pa = amplitude_pa(settings.tone_level_db_spl);
        let mut lines = Vec::new();
        let mut line = |class: LineClass, order: f64, level: f64| {
            let draw = settings.tones.draw_line(class, &mut random);
            let (amplitude, phase) = (unit_pa * level * draw.factor, draw.phase_rad);
            let mean = Complex { re: (amplitude * phase.cos()) as f32, im: (amplitude * phase.sin()) as f32 };
            let (re, im) = (SlowNormal::new(keep, &mut random), SlowNormal::new(keep, &mut random));
            lines.push(Line { order, mean, re, im });
        };
        line(settings.tones.class_of_shaft(), 1.0, settings.tones.shaft_level);
        let (mut blade_count, mut blade_lines) = (1, 0);
        if let Some(blades) = &settings.tones.blade_pass {
            (blade_count, blade_lines) = (blades.blade_count, blades.harmonic_count as usize);
            for order in (1..=blades.harmonic_count).map(|number| f64::from(blade_count * number)) {
                line(LineClass::BladePass, order, blades.level_of_order(order));
            }
        }
        let (mut mesh_order, mut mesh_harmonics, mut sidebands, mut pinion_order) = (1, 0, 0, None);
        if let Some(mesh) = &settings.tones.gear_mesh {
            (mesh_order, mesh_harmonics) = (mesh.order, mesh.harmonic_levels.len());
            sidebands = mesh.sideband_levels.len();
            pinion_order = settings
                .pinion_teeth
                .filter(|_| settings.pinion_sideband_level > 0.0)
                .map(|teeth| f64::from(mesh.order) / f64::from(teeth));
            for (number, &level) in (1_u32..).zip(&mesh.harmonic_levels) {
                let order = f64::from(mesh.order) * f64::from(number);
                line(LineClass::Machine, order, level);
                for (away, &share) in (1_u32..).zip(&mesh.sideband_levels) {
                    line(LineClass::Machine, order + f64::from(away), level * share);
                    line(LineClass::Machine, order - f64::from(away), level * share);
                }
                if let Some(away) = pinion_order {
                    line(LineClass::Machine, order + away, level * settings.pinion_sideband_level);
                    line(LineClass::Machine, order - away, level * settings.pinion_sideband_level);
                }
            }
        }
        let (mut motor_order, mut motor_lines) = (1.0, 0);
        if let Some(motor) = &settings.motor {
            (motor_order, motor_lines) = (motor.order, motor.harmonic_levels.len());
            for (number, &level) in (1_u32..).zip(&motor.harmonic_levels) {
                line(LineClass::Machine, motor.order * f64::from(number), level);
            }
        }
        let mut unlike_lines = 0;
        for it in settings.tones.lines_of_unlike_blades() {
            line(it.class, it.order, it.level);
            unlike_lines += 1;
        }
        let order_max = lines.iter().map(|line| line.order).fold(0.0, f64::max);
        Self {
            amplitudes: lines.iter().map(|line| line.mean).collect(),
            lines,
            blade_count,
            blade_lines,
            mesh_order,
            mesh_harmonics,
            sidebands,
            pinion_order,
            pinion_teeth: settings.pinion_teeth.unwrap_or(1),
            motor_order,
            motor_lines,
            unlike_lines,
            order_max,
            unsteadiness: settings.unsteadiness,
            keep,
            sample_rate_hz,
            random,
            shaft: Phasors::new(),
            mesh: Phasors::new(),
            pinion: Phasors::new(),
            motor: Phasors::new(),
            blade_cosine: [1.0; CHUNK],
        }
    }

    /// Draws the next step of the unsteadiness: once every [`UNSTEADY_STEP`] samples.
    pub(crate) fn step(&mut self) {
        if self.unsteadiness > 0.0 {
            for line in &mut self.lines {
                line.re.step(self.keep, &mut self.random);
                line.im.step(self.keep, &mut self.random);
            }
        }
    }

    /// Sums the lines at these turns, over a chunk that begins at a share `step_share` of the way to the next step: the
    /// lines of the blades into `blades`, all others into `mechanical`.
    pub(crate) fn sum(
        &mut self,
        turns: &[f64; CHUNK],
        count: usize,
        step_share: f64,
        speed_rev_s: f64,
        blades: &mut [f32; CHUNK],
        mechanical: &mut [f32; CHUNK],
    ) {
        self.set_amplitudes(step_share, speed_rev_s);
        self.shaft.set(1.0, turns, count);
        match self.pinion_order {
            // The mesh is a whole multiple of the pinion.
            Some(order) => self.pinion.set(order, turns, count),
            None if self.mesh_harmonics > 0 => self.mesh.set(f64::from(self.mesh_order), turns, count),
            None => {}
        }
        if self.motor_lines > 0 {
            self.motor.set(self.motor_order, turns, count);
        }
        for start in (0..count).step_by(LANES) {
            let (blade_cosine, blade, other) = self.tile(start);
            self.blade_cosine[start..start + LANES].copy_from_slice(&blade_cosine.0);
            blades[start..start + LANES].copy_from_slice(&blade.0);
            mechanical[start..start + LANES].copy_from_slice(&other.0);
        }
    }

    /// Cosine of the blade pass over the chunk last summed; 1 without blades.
    pub(crate) fn blade_cosine(&self) -> &[f32; CHUNK] {
        &self.blade_cosine
    }

    fn set_amplitudes(&mut self, step_share: f64, speed_rev_s: f64) {
        let fades = self.order_max * speed_rev_s > FADE_FROM * self.sample_rate_hz;
        if self.unsteadiness == 0.0 && !fades {
            for (amplitude, line) in self.amplitudes.iter_mut().zip(&self.lines) {
                *amplitude = line.mean;
            }
            return;
        }
        for (amplitude, line) in self.amplitudes.iter_mut().zip(&self.lines) {
            let between = |slow: SlowNormal| slow.before + step_share * (slow.now - slow.before);
            let (re, im) = (1.0 + self.unsteadiness * between(line.re), self.unsteadiness * between(line.im));
            let share = line.order * speed_rev_s / self.sample_rate_hz;
            let heard = ((0.5 - share) / (0.5 - FADE_FROM)).clamp(0.0, 1.0);
            let (re, im) = ((heard * re) as f32, (heard * im) as f32);
            let mean = line.mean;
            *amplitude = Complex { re: mean.re * re - mean.im * im, im: mean.re * im + mean.im * re };
        }
    }

    /// Horner's scheme per family, in registers: each line costs one complex multiplication and addition. Returns the cosine
    /// of the blade pass, the sum of the lines of the blades, and the sum of all others.
    fn tile(&self, start: usize) -> (Lanes, Lanes, Lanes) {
        let shaft = LanePhasor::at(&self.shaft, start);
        let (first, rest) = self.amplitudes.split_at(1);
        let (blade_lines, rest) = rest.split_at(self.blade_lines);
        let per_harmonic = 1 + 2 * self.sidebands + if self.pinion_order.is_some() { 2 } else { 0 };
        let (mesh_lines, rest) = rest.split_at(per_harmonic * self.mesh_harmonics);
        let (motor_lines, unlike_lines) = rest.split_at(self.motor_lines);

        let mut other = LanePhasor::series(first, &shaft);
        let blade = shaft.power(self.blade_count);
        let mut blades = LanePhasor::series(blade_lines, &blade);
        if self.unlike_lines > 0 {
            // from order 2 on
            blades.add_lanes(&LanePhasor::series(unlike_lines, &shaft).times(&shaft));
        }
        if !mesh_lines.is_empty() {
            let pinion = LanePhasor::at(&self.pinion, start);
            let turn = match self.pinion_order {
                Some(_) => pinion.power(self.pinion_teeth),
                None => LanePhasor::at(&self.mesh, start),
            };
            let mut sum = LanePhasor::ZERO;
            for harmonic in mesh_lines.chunks_exact(per_harmonic).rev() {
                sum.add(harmonic[0]);
                let mut away = shaft;
                for (number, pair) in harmonic[1..=2 * self.sidebands].chunks_exact(2).enumerate() {
                    if number > 0 {
                        away = away.times(&shaft);
                    }
                    sum.add_pair(&away, pair[0], pair[1]);
                }
                if self.pinion_order.is_some() {
                    sum.add_pair(&pinion, harmonic[per_harmonic - 2], harmonic[per_harmonic - 1]);
                }
                sum = sum.times(&turn);
            }
            other.add_lanes(&sum);
        }
        if !motor_lines.is_empty() {
            other.add_lanes(&LanePhasor::series(motor_lines, &LanePhasor::at(&self.motor, start)));
        }
        (blade.re, blades.re, other.re)
    }
}

#[derive(Clone, Copy)]
struct Lanes([f32; LANES]);

#[derive(Clone, Copy)]
struct LanePhasor {
    re: Lanes,
    im: Lanes,
}

impl LanePhasor {
    const ZERO: Self = Self { re: Lanes([0.0; LANES]), im: Lanes([0.0; LANES]) };
    const ONE: Self = Self { re: Lanes([1.0; LANES]), im: Lanes([0.0; LANES]) };

    #[inline(always)]
    fn at(phasors: &Phasors, start: usize) -> Self {
        let mut lanes = Self::ZERO;
        lanes.re.0.copy_from_slice(&phasors.re[start..start + LANES]);
        lanes.im.0.copy_from_slice(&phasors.im[start..start + LANES]);
        lanes
    }

    #[inline(always)]
    fn times(&self, other: &Self) -> Self {
        let mut product = Self::ZERO;
        for lane in 0..LANES {
            let (a, b, c, d) = (self.re.0[lane], self.im.0[lane], other.re.0[lane], other.im.0[lane]);
            product.re.0[lane] = a * c - b * d;
            product.im.0[lane] = a * d + b * c;
        }
        product
    }

    /// To a whole power, by squaring: the error is the power times the phasor's error.
    fn power(&self, exponent: u32) -> Self {
        let (mut result, mut square, mut left) = (Self::ONE, *self, exponent);
        while left > 0 {
            if left & 1 == 1 {
                result = result.times(&square);
            }
            square = square.times(&square);
            left >>= 1;
        }
        result
    }

    /// `Σ c_h z^h`, h = 1…, with separate sums of odd and even powers, which run in parallel.
    #[inline(always)]
    fn series(lines: &[Complex], z: &Self) -> Self {
        let square = z.times(z);
        let (mut odd, mut even) = (Self::ZERO, Self::ZERO);
        for pair in lines.chunks(2).rev() {
            odd = odd.times(&square);
            even = even.times(&square);
            odd.add(pair[0]);
            even.add(pair.get(1).copied().unwrap_or_default());
        }
        let mut sum = odd.times(z);
        sum.add_lanes(&even.times(&square));
        sum
    }

    #[inline(always)]
    fn add(&mut self, value: Complex) {
        for lane in 0..LANES {
            self.re.0[lane] += value.re;
            self.im.0[lane] += value.im;
        }
    }

    #[inline(always)]
    fn add_lanes(&mut self, other: &Self) {
        for lane in 0..LANES {
            self.re.0[lane] += other.re.0[lane];
            self.im.0[lane] += other.im.0[lane];
        }
    }

    /// Adds `above z + below z*`.
    #[inline(always)]
    fn add_pair(&mut self, z: &Self, above: Complex, below: Complex) {
        let (re_sum, im_sum) = (above.re + below.re, above.im + below.im);
        let (re_gap, im_gap) = (above.re - below.re, below.im - above.im);
        for lane in 0..LANES {
            let (re, im) = (z.re.0[lane], z.im.0[lane]);
            self.re.0[lane] += re_sum * re + im_gap * im;
            self.im.0[lane] += im_sum * re + re_gap * im;
        }
    }
}

#[cfg(test)]
#[path = "lines_tests.rs"]
mod tests;
