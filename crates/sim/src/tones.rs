//! The lines of one rotor: sums of whole multiples of its shaft, in phase with it at every sample.

use crate::shaft::BLOCK;
use hovertone_vehicle::{QuantityError, Vehicle};
use rand::RngExt;
use rand_distr::StandardNormal;
use rand_pcg::Pcg64;
use std::f64::consts::{PI, TAU};

/// Lines of the gear between motor and rotor. Levels are amplitudes; 1 is the measure of all levels.
#[derive(Clone, Debug, PartialEq)]
pub struct GearMeshTones {
    /// Teeth of the wheel on the rotor's shaft: lines per turn.
    pub order: u32,
    /// Level of the mesh tone and of its harmonics.
    pub harmonic_levels: Vec<f64>,
    /// Levels of the sidebands at ±1, ±2, … shaft speeds, as shares of the harmonic that they stand beside.
    pub sideband_levels: Vec<f64>,
}

impl GearMeshTones {
    /// The mesh of a wheel with that many teeth: harmonics 1, 0.5, 0.25 with sidebands of 0.3 and 0.15 (the project's
    /// prototype, PHYSICS section 6.2; no published levels were found).
    pub fn with_order(order: u32) -> Self {
        Self { order, harmonic_levels: vec![1.0, 0.5, 0.25], sideband_levels: vec![0.3, 0.15] }
    }
}

/// Lines of the blades, `level · h^exponent` at `h` times the blade pass, h = 1…harmonic_count.
#[derive(Clone, Debug, PartialEq)]
pub struct BladePassTones {
    /// Blades of the propeller: lines per turn.
    pub blade_count: u32,
    /// How many harmonics, the blade pass itself counted.
    pub harmonic_count: u32,
    /// Level of the blade pass.
    pub level: f64,
    /// How the levels fall with the harmonic's number.
    pub exponent: f64,
}

impl BladePassTones {
    /// Twenty harmonics at 2 h^-0.7 (the project's prototype, PHYSICS section 6.2).
    pub fn with_blades(blade_count: u32) -> Self {
        Self { blade_count, harmonic_count: 20, level: 2.0, exponent: -0.7 }
    }
}

/// Which lines each rotor has. All have the same set, each with random phases and levels of its own.
#[derive(Clone, Debug, PartialEq)]
pub struct ToneSettings {
    /// Lines of the gear; absent for direct drive.
    pub gear_mesh: Option<GearMeshTones>,
    /// Lines of the blades.
    pub blade_pass: Option<BladePassTones>,
    /// Level of the line at the shaft speed itself: imbalance.
    pub shaft_level: f64,
    /// Standard deviation of every line's level about the set one, drawn once per rotor and line.
    pub level_spread_db: f64,
}

impl Default for ToneSettings {
    /// The AR.Drone: a 69-tooth wheel and two blades. The shaft line is small, 0.2; the spread, 3 dB, is what makes one
    /// rotor the loudest (real rotors differ by more).
    fn default() -> Self {
        Self {
            gear_mesh: Some(GearMeshTones::with_order(69)),
            blade_pass: Some(BladePassTones::with_blades(2)),
            shaft_level: 0.2,
            level_spread_db: 3.0,
        }
    }
}

impl ToneSettings {
    /// The lines that a vehicle's gear and blades make.
    pub fn for_vehicle(vehicle: &Vehicle) -> Self {
        Self {
            gear_mesh: vehicle.gear.map(|gear| GearMeshTones::with_order(gear.value.wheel)),
            blade_pass: vehicle.blade_count.map(|blades| BladePassTones::with_blades(blades.value)),
            ..Self::default()
        }
    }

    /// One line at that order and level 1, nothing else: for checking an estimator against a closed form.
    pub fn single(order: u32) -> Self {
        let mesh = GearMeshTones { order, harmonic_levels: vec![1.0], sideband_levels: Vec::new() };
        Self { gear_mesh: Some(mesh), blade_pass: None, shaft_level: 0.0, level_spread_db: 0.0 }
    }

    pub(crate) fn check(&self) -> Result<(), QuantityError> {
        let mut levels = vec![("shaft_level", self.shaft_level), ("level_spread_db", self.level_spread_db)];
        let mut counts = Vec::new();
        if let Some(mesh) = &self.gear_mesh {
            counts.push(("gear mesh order", mesh.order));
            levels.extend(mesh.harmonic_levels.iter().map(|&level| ("gear mesh harmonic_levels", level)));
            levels.extend(mesh.sideband_levels.iter().map(|&level| ("gear mesh sideband_levels", level)));
        }
        if let Some(blades) = &self.blade_pass {
            counts.push(("blade_count", blades.blade_count));
            levels.push(("blade pass level", blades.level));
            if !blades.exponent.is_finite() {
                return Err(QuantityError { name: "blade pass exponent", value: blades.exponent, must_be: "a number" });
            }
        }
        for (name, value) in levels {
            if !(value.is_finite() && value >= 0.0) {
                return Err(QuantityError { name, value, must_be: "0 or more" });
            }
        }
        for (name, count) in counts {
            if count == 0 {
                return Err(QuantityError { name, value: 0.0, must_be: "at least 1" });
            }
        }
        Ok(())
    }

    /// Order and level of the line that noise is measured against: the mesh, else the blade pass, else the shaft.
    pub(crate) fn reference(&self) -> Option<(f64, f64)> {
        let mesh = self.gear_mesh.as_ref().and_then(|mesh| Some((mesh.order, *mesh.harmonic_levels.first()?)));
        let blades = self.blade_pass.as_ref().map(|blades| (blades.blade_count, blades.level));
        [mesh, blades, Some((1, self.shaft_level))]
            .into_iter()
            .flatten()
            .find(|(_, level)| *level > 0.0)
            .map(|(order, level)| (f64::from(order), level))
    }
}

/// `e^(i·order·θ)` for each sample of a block, by components so that the compiler can make lanes of it.
#[derive(Clone)]
struct Phasors {
    re: [f64; BLOCK],
    im: [f64; BLOCK],
}

impl Phasors {
    fn from_turns(turns: &[f64; BLOCK]) -> Self {
        let mut phasors = Self { re: [0.0; BLOCK], im: [0.0; BLOCK] };
        for ((re, im), turn) in phasors.re.iter_mut().zip(&mut phasors.im).zip(turns) {
            (*im, *re) = (TAU * turn).sin_cos();
        }
        phasors
    }

    fn one() -> Self {
        Self { re: [1.0; BLOCK], im: [0.0; BLOCK] }
    }

    /// Multiplies by `other`: the orders add. With `sign` -1 by its conjugate: they subtract.
    fn turn_on(&mut self, other: &Self, sign: f64) {
        for sample in 0..BLOCK {
            let (re, im) = (self.re[sample], self.im[sample]);
            let (other_re, other_im) = (other.re[sample], sign * other.im[sample]);
            self.re[sample] = re * other_re - im * other_im;
            self.im[sample] = re * other_im + im * other_re;
        }
    }

    /// To a whole power, by squaring: the rounding is that of `log2(order)` products, some 1e-14 at order 69.
    fn power(&self, order: u32) -> Self {
        let (mut result, mut square, mut left) = (Self::one(), self.clone(), order);
        while left > 0 {
            if left & 1 == 1 {
                result.turn_on(&square, 1.0);
            }
            let same = square.clone();
            square.turn_on(&same, 1.0);
            left >>= 1;
        }
        result
    }

    fn add_line(&self, line: Line, sum: &mut [f64; BLOCK]) {
        for ((sum, re), im) in sum.iter_mut().zip(&self.re).zip(&self.im) {
            *sum += line.cosine * re - line.sine * im;
        }
    }
}

/// Amplitude and phase of one line, as the two factors of cosine and (minus) sine. Zero where there is no line.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Line {
    cosine: f64,
    sine: f64,
}

#[derive(Clone)]
struct MeshHarmonic {
    carrier: Line,
    above: Vec<Line>,
    below: Vec<Line>,
}

/// The lines of one rotor, with their phases and levels drawn.
#[derive(Clone)]
pub(crate) struct RotorTones {
    shaft: Line,
    blade_count: u32,
    blade_pass: Vec<Line>,
    mesh_order: u32,
    mesh: Vec<MeshHarmonic>,
}

impl RotorTones {
    /// Lines at orders above `order_max` are left out, as a recorder's anti-alias filter would. They are drawn all the
    /// same, so that the others do not depend on the sample rate.
    pub(crate) fn new(settings: &ToneSettings, level: f64, order_max: f64, random: &mut Pcg64) -> Self {
        let mut line = |order: f64, relative_level: f64| {
            let spread: f64 = random.sample(StandardNormal);
            let phase = TAU * random.random::<f64>();
            let heard = if (0.0..=order_max).contains(&order) { 1.0 } else { 0.0 };
            let amplitude = heard * level * relative_level * 10_f64.powf(settings.level_spread_db * spread / 20.0);
            let (sine, cosine) = phase.sin_cos();
            Line { cosine: amplitude * cosine, sine: amplitude * sine }
        };
        let shaft = line(1.0, settings.shaft_level);
        let mut mesh = Vec::new();
        let mut mesh_order = 0;
        if let Some(gear) = &settings.gear_mesh {
            mesh_order = gear.order;
            for (number, &harmonic_level) in (1_u32..).zip(&gear.harmonic_levels) {
                let order = f64::from(gear.order) * f64::from(number);
                let carrier = line(order, harmonic_level);
                let (mut above, mut below) = (Vec::new(), Vec::new());
                for (away, &sideband_level) in (1_u32..).zip(&gear.sideband_levels) {
                    above.push(line(order + f64::from(away), harmonic_level * sideband_level));
                    below.push(line(order - f64::from(away), harmonic_level * sideband_level));
                }
                mesh.push(MeshHarmonic { carrier, above, below });
            }
        }
        let mut blade_pass = Vec::new();
        let mut blade_count = 0;
        if let Some(blades) = &settings.blade_pass {
            blade_count = blades.blade_count;
            for number in (1..=blades.harmonic_count).map(f64::from) {
                blade_pass.push(line(f64::from(blade_count) * number, blades.level * number.powf(blades.exponent)));
            }
        }
        Self { shaft, blade_count, blade_pass, mesh_order, mesh }
    }

    /// Adds the rotor's sound at those phases (shares of a turn).
    pub(crate) fn add(&self, turns: &[f64; BLOCK], sum: &mut [f64; BLOCK]) {
        let shaft = Phasors::from_turns(turns);
        shaft.add_line(self.shaft, sum);
        if !self.blade_pass.is_empty() {
            let blade = shaft.power(self.blade_count);
            let mut harmonic = Phasors::one();
            for &line in &self.blade_pass {
                harmonic.turn_on(&blade, 1.0);
                harmonic.add_line(line, sum);
            }
        }
        if !self.mesh.is_empty() {
            let mesh = shaft.power(self.mesh_order);
            let mut harmonic = Phasors::one();
            for lines in &self.mesh {
                harmonic.turn_on(&mesh, 1.0);
                harmonic.add_line(lines.carrier, sum);
                for (sidebands, sign) in [(&lines.above, 1.0), (&lines.below, -1.0)] {
                    let mut sideband = harmonic.clone();
                    for &line in sidebands {
                        sideband.turn_on(&shaft, sign);
                        sideband.add_line(line, sum);
                    }
                }
            }
        }
    }

    /// An upper bound of |sound| over all phases, close: the sound repeats with each turn, so one turn is looked at, 16
    /// times for each period of the highest order; between two looks a band-limited signal rises by 1/cos(π/16) at
    /// most (Ehlich and Zeller 1964).
    pub(crate) fn peak(&self) -> f64 {
        let mesh_orders = u64::from(self.mesh_order) * self.mesh.len() as u64
            + self.mesh.iter().map(|lines| lines.above.len()).max().unwrap_or(0) as u64;
        let order_max = mesh_orders.max(u64::from(self.blade_count) * self.blade_pass.len() as u64).max(1);
        let looks = 16 * order_max;
        let mut peak = 0.0_f64;
        for block in 0..looks.div_ceil(BLOCK as u64) {
            let turns = std::array::from_fn(|sample| (block * BLOCK as u64 + sample as u64) as f64 / looks as f64);
            let mut sum = [0.0; BLOCK];
            self.add(&turns, &mut sum);
            peak = sum.iter().fold(peak, |peak, value| peak.max(value.abs()));
        }
        peak / (PI / 16.0).cos()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::seed::{Part, stream};

    fn tones(settings: &ToneSettings, order_max: f64) -> RotorTones {
        RotorTones::new(settings, 1.0, order_max, &mut stream(7, Part::Tones, 0))
    }

    /// The slow definition: one cosine per line.
    fn slow(tones: &RotorTones, turn: f64) -> f64 {
        let at = |order: f64, line: Line| {
            let amplitude = line.cosine.hypot(line.sine);
            amplitude * (TAU * order * turn + line.sine.atan2(line.cosine)).cos()
        };
        let mut sum = at(1.0, tones.shaft);
        for (number, &line) in (1..).zip(&tones.blade_pass) {
            sum += at(f64::from(tones.blade_count) * f64::from(number), line);
        }
        for (number, lines) in (1..).zip(&tones.mesh) {
            let order = f64::from(tones.mesh_order) * f64::from(number);
            sum += at(order, lines.carrier);
            for (away, &line) in (1..).zip(&lines.above) {
                sum += at(order + f64::from(away), line);
            }
            for (away, &line) in (1..).zip(&lines.below) {
                sum += at(order - f64::from(away), line);
            }
        }
        sum
    }

    #[test]
    fn the_fast_sum_is_the_slow_one() {
        let tones = tones(&ToneSettings::default(), f64::INFINITY);
        let turns = std::array::from_fn(|sample| sample as f64 / BLOCK as f64 + 0.003);
        let mut sum = [0.0; BLOCK];
        tones.add(&turns, &mut sum);
        // Phases near 2π·209 carry a rounding of 2e-13 rad; 36 lines of amplitude about 1.
        for (fast, turn) in sum.into_iter().zip(turns) {
            assert!((fast - slow(&tones, turn)).abs() < 36.0 * 1e-12, "{fast}");
        }
        assert!(sum.iter().any(|value| value.abs() > 0.5));
    }

    #[test]
    fn the_peak_is_an_upper_bound_and_a_close_one() {
        for seed in 0..5 {
            let tones = RotorTones::new(&ToneSettings::default(), 1.0, 1e9, &mut stream(seed, Part::Tones, 0));
            let highest = (0..100_003).map(|look| slow(&tones, f64::from(look) / 100_003.0).abs()).fold(0.0, f64::max);
            assert!((highest..=1.03 * highest).contains(&tones.peak()), "{highest} {}", tones.peak());
        }
    }

    #[test]
    fn lines_above_the_highest_order_are_left_out_and_change_no_other() {
        let (all, some) = (tones(&ToneSettings::default(), 1e9), tones(&ToneSettings::default(), 100.0));
        let silent = Line { cosine: 0.0, sine: 0.0 };
        assert!(some.mesh[1..].iter().all(|lines| lines.carrier.cosine.hypot(lines.carrier.sine) == 0.0));
        assert_eq!(some.mesh[0].above, all.mesh[0].above);
        assert_eq!(some.blade_pass, all.blade_pass);
        assert!(all.blade_pass.iter().all(|&line| line != silent));
    }
}
