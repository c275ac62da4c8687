//! The lines of one rotor of a hover: sums of whole multiples of its shaft, in phase with it at every sample.

use crate::prescribed::phasors::{Amplitude, BLOCK, Phasors};
use crate::sound::{LineClass, ToneSettings};
use rand_pcg::Pcg64;
use std::f64::consts::PI;

/// A harmonic of the gear mesh, with its sidebands at +1, +2, … and -1, -2, … shaft speeds.
#[derive(Clone)]
struct MeshHarmonic {
    carrier: Amplitude,
    above: Vec<Amplitude>,
    below: Vec<Amplitude>,
}

/// The lines of one rotor, with their phases and levels drawn.
#[derive(Clone)]
pub(super) struct RotorTones {
    shaft: Amplitude,
    blade_count: u32,
    blade_pass: Vec<Amplitude>,
    /// Lines of unlike blades: orders 2, 3, …, silent at those of the blade pass.
    unlike_blades: Vec<Amplitude>,
    mesh_order: u32,
    mesh: Vec<MeshHarmonic>,
}

impl RotorTones {
    /// Draws levels and phases. Lines at orders above `order_max` are silent, as behind a recorder's anti-alias filter,
    /// but they are drawn too, so that the other lines do not depend on the sample rate.
    pub(super) fn new(settings: &ToneSettings, level: f64, order_max: f64, random: &mut Pcg64) -> Self {
        let mut line = |class: LineClass, order: f64, relative_level: f64| {
            let draw = settings.draw_line(class, random);
            let heard = if (0.0..=order_max).contains(&order) { 1.0 } else { 0.0 };
            Amplitude::polar(heard * level * relative_level * draw.factor, draw.phase_rad)
        };
        let shaft = line(settings.class_of_shaft(), 1.0, settings.shaft_level);
        let mut mesh = Vec::new();
        let mut mesh_order = 0;
        if let Some(gear) = &settings.gear_mesh {
            mesh_order = gear.order;
            for (number, &harmonic_level) in (1_u32..).zip(&gear.harmonic_levels) {
                let order = f64::from(gear.order) * f64::from(number);
                let carrier = line(LineClass::Machine, order, harmonic_level);
                let (mut above, mut below) = (Vec::new(), Vec::new());
                for (away, &sideband_level) in (1_u32..).zip(&gear.sideband_levels) {
                    above.push(line(LineClass::Machine, order + f64::from(away), harmonic_level * sideband_level));
                    below.push(line(LineClass::Machine, order - f64::from(away), harmonic_level * sideband_level));
                }
                mesh.push(MeshHarmonic { carrier, above, below });
            }
        }
        let (mut blade_pass, mut blade_count) = (Vec::new(), 0);
        if let Some(blades) = &settings.blade_pass {
            blade_count = blades.blade_count;
            for order in (1..=blades.harmonic_count).map(|number| f64::from(blade_count * number)) {
                blade_pass.push(line(LineClass::BladePass, order, blades.level_of_order(order)));
            }
        }
        let unlike_blades = settings.lines_of_unlike_blades().map(|it| line(it.class, it.order, it.level)).collect();
        Self { shaft, blade_count, blade_pass, unlike_blades, mesh_order, mesh }
    }

    /// Adds the rotor's sound at these phases, shares of a turn.
    pub(super) fn add(&self, turns: &[f64; BLOCK], sum: &mut [f64; BLOCK]) {
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
        if !self.unlike_blades.is_empty() {
            let mut harmonic = shaft.clone();
            for &line in &self.unlike_blades {
                harmonic.turn_on(&shaft, 1.0);
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

    /// A close upper bound of |sound| over all phases. The sound repeats with each turn, so one turn is sampled at 16
    /// points for each period of the highest order; between two points a band-limited signal rises by a factor of at most
    /// 1/cos(π/16) (Ehlich and Zeller 1964).
    pub(super) fn peak(&self) -> f64 {
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
    use std::f64::consts::TAU;

    fn tones(settings: &ToneSettings, order_max: f64) -> RotorTones {
        RotorTones::new(settings, 1.0, order_max, &mut stream(7, Part::Tones, 0))
    }

    /// The slow definition: one cosine per line.
    fn slow(tones: &RotorTones, turn: f64) -> f64 {
        let at = |order: f64, line: Amplitude| {
            let amplitude = line.cosine.hypot(line.sine);
            amplitude * (TAU * order * turn + line.sine.atan2(line.cosine)).cos()
        };
        let mut sum = at(1.0, tones.shaft);
        for (number, &line) in (1..).zip(&tones.blade_pass) {
            sum += at(f64::from(tones.blade_count) * f64::from(number), line);
        }
        for (order, &line) in (2..).zip(&tones.unlike_blades) {
            sum += at(f64::from(order), line);
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
        let unlike = ToneSettings { unlike_blades_level: 0.2, ..ToneSettings::default() };
        let tones = tones(&unlike, f64::INFINITY);
        let turns = std::array::from_fn(|sample| sample as f64 / BLOCK as f64 + 0.003);
        let mut sum = [0.0; BLOCK];
        tones.add(&turns, &mut sum);
        // Phases near 2π·209 carry a rounding of 2e-13 rad; 74 lines of amplitude about 1.
        for (fast, turn) in sum.into_iter().zip(turns) {
            assert!((fast - slow(&tones, turn)).abs() < 74.0 * 1e-12, "{fast}");
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
        let silent = Amplitude { cosine: 0.0, sine: 0.0 };
        assert!(some.mesh[1..].iter().all(|lines| lines.carrier.cosine.hypot(lines.carrier.sine) == 0.0));
        assert_eq!(some.mesh[0].above, all.mesh[0].above);
        assert_eq!(some.blade_pass, all.blade_pass);
        assert!(all.blade_pass.iter().all(|&line| line != silent));
    }
}
