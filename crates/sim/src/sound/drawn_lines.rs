//! Lines of a rotor with levels drawn from those of real rotors.

use super::line_scatter::{ClassScatter, LineScatter};
use super::settings::{MotorTones, SourceSettings};
use super::tone_settings::{BladePassTones, ToneSettings};
use crate::seed::{Part, stream};
use hovertone_vehicle::{LineLevels, RotorSpeed, Vehicle};
use rand::RngExt;
use rand_distr::StandardNormal;
use rand_pcg::Pcg64;

/// Pole pairs of motors without a gear: 12 slots and 14 magnets are usual.
const POLE_PAIRS: f64 = 7.0;
/// Number of lines of the motor: on a bench of four rotors, orders 14, 21 and 28 are among the strongest.
const MOTOR_LINES: u32 = 4;
/// Mean level of a line of the motor against the blade pass, dB. On that bench some are over the blade pass; flights were not measured. Assumed.
const MOTOR_DB: f64 = -15.0;
/// Its standard deviation over vehicles and lines, dB. Assumed.
const MOTOR_STD_DB: f64 = 10.0;
/// The fall of the table was measured up to this harmonic of the blade pass.
const FALL_HARMONICS: f64 = 12.0;

impl ToneSettings {
    /// The lines of one vehicle with levels drawn from the table:
    ///
    /// - the fall of the blade pass, 0 or more (an exponent of −fall/2 of the pressure);
    /// - how much its lines scatter;
    /// - the offset of the shaft lines: of alike or unlike blades, or inaudible;
    /// - the lines below the blade pass, and the shares of lines that are missing.
    ///
    /// Levels of the table are over the floor; here they are over a flat one. Lines of something else, echoes, notches and smeared lines are not
    /// drawn: rooms, voices and the wander of the rotors make them.
    pub fn drawn(vehicle: &Vehicle, table: &LineLevels, seed: u64) -> Self {
        let mut random = Draws(stream(seed, Part::Levels, 0));
        let plain = Self::for_vehicle(vehicle);
        let fall = random.normal(table.fall, table.fall_std).max(0.0);
        let factor = random.scatter_factor();
        let class = |spread_db, missing_share| ClassScatter { spread_db, missing_share };
        let blade_pass = plain.blade_pass.map(|blades| BladePassTones { exponent: -fall / 2.0, ..blades });
        let blade_level = blade_pass.as_ref().map_or(1.0, |blades| blades.level);
        Self {
            shaft_level: blade_level * amplitude_share(table.below_db),
            unlike_blades_level: random.shaft_offset_db(table).map_or(0.0, amplitude_share),
            scatter: Some(LineScatter {
                blade_pass: class(factor * table.line_std_db, table.blade_pass_missing),
                shaft: class(factor * table.shaft_line_std_db, table.shaft_missing),
                below: class(table.below_std_db, table.below_missing),
            }),
            blade_pass,
            ..plain
        }
    }
}

impl MotorTones {
    /// The lines of a motor without a gear: multiples of its pole pairs, with levels against this level of the blade pass.
    fn drawn(blade_level: f64, random: &mut Draws) -> Self {
        let level = |_| blade_level * amplitude_share(random.normal(MOTOR_DB, MOTOR_STD_DB));
        Self { order: POLE_PAIRS, harmonic_levels: (0..MOTOR_LINES).map(level).collect() }
    }
}

impl SourceSettings {
    /// As [`for_vehicle`](Self::for_vehicle), with levels drawn from those of real rotors, and with the lines of a motor without a gear. Levels of
    /// the table are over the floor, so that the lines also fall by as much as the broadband noise between the first and the twelfth harmonic.
    pub fn drawn(vehicle: &Vehicle, hover_speed: RotorSpeed, table: &LineLevels, seed: u64) -> Self {
        let plain = Self::for_vehicle(vehicle, hover_speed);
        let mut tones = ToneSettings::drawn(vehicle, table, seed);
        if let (Some(blades), Some(noise)) = (&mut tones.blade_pass, &plain.broadband) {
            let first_hz = f64::from(blades.blade_count) * hover_speed.rev_s();
            let noise_fall_db = noise.density_db(first_hz) - noise.density_db(FALL_HARMONICS * first_hz);
            blades.exponent -= noise_fall_db / (20.0 * FALL_HARMONICS.log10());
        }
        let blade_level = tones.blade_pass.as_ref().map_or(1.0, |blades| blades.level);
        let motor =
            plain.motor.or_else(|| Some(MotorTones::drawn(blade_level, &mut Draws(stream(seed, Part::Levels, 1)))));
        Self { tones, motor, ..plain }
    }
}

fn amplitude_share(level_db: f64) -> f64 {
    10_f64.powf(level_db / 20.0)
}

/// Random numbers of a vehicle.
struct Draws(Pcg64);

impl Draws {
    fn normal(&mut self, mean: f64, std: f64) -> f64 {
        let normal: f64 = self.0.sample(StandardNormal);
        mean + std * normal
    }

    fn is_one_of(&mut self, share: f64) -> bool {
        self.0.random::<f64>() < share
    }

    /// Scatter of the lines of a vehicle over that of most.
    fn scatter_factor(&mut self) -> f64 {
        let mut left = self.0.random::<f64>();
        for (factor, share) in LineLevels::SCATTERS {
            if left < share {
                return factor;
            }
            left -= share;
        }
        1.0
    }

    /// Level of the shaft lines against the blade pass; `None` where they are inaudible.
    fn shaft_offset_db(&mut self, table: &LineLevels) -> Option<f64> {
        if self.is_one_of(table.shaft_inaudible) {
            return None;
        }
        let is_faint = self.is_one_of(table.faint_shaft);
        let (mean_db, std_db) = match is_faint {
            true => (table.faint_shaft_db, table.faint_shaft_std_db),
            false => (table.shaft_db, table.shaft_std_db),
        };
        Some(self.normal(mean_db, std_db))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone_vehicle::find_preset;

    const COUNT: u64 = 2000;

    fn drawn(table: &LineLevels) -> Vec<ToneSettings> {
        let vehicle = find_preset("crazyflie").unwrap();
        (0..COUNT).map(|seed| ToneSettings::drawn(vehicle, table, seed)).collect()
    }

    fn mean_and_std(values: &[f64]) -> (f64, f64) {
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        (mean, (values.iter().map(|value| (value - mean).powi(2)).sum::<f64>() / count).sqrt())
    }

    /// The mean within five standard errors, the standard deviation within five of its own, std/√(2 n).
    fn assert_normal(table: &LineLevels, value: fn(&ToneSettings) -> f64, mean: f64, std: f64) {
        let (found_mean, found_std) = mean_and_std(&drawn(table).iter().map(value).collect::<Vec<_>>());
        let error = std / (COUNT as f64).sqrt();
        assert!((found_mean - mean).abs() < 5.0 * error, "{found_mean} {mean}");
        assert!((found_std - std).abs() < 5.0 * error / 2_f64.sqrt(), "{found_std} {std}");
    }

    #[test]
    fn levels_have_the_distributions_of_the_table() {
        let table = LineLevels { fall: 3.0, fall_std: 0.5, ..LineLevels::default() };
        let fall = |tones: &ToneSettings| -2.0 * tones.blade_pass.as_ref().unwrap().exponent;
        let offset_db = |tones: &ToneSettings| 20.0 * tones.unlike_blades_level.log10();
        assert_normal(&table, fall, 3.0, 0.5);
        let unlike = LineLevels { faint_shaft: 0.0, shaft_inaudible: 0.0, ..table };
        assert_normal(&unlike, offset_db, table.shaft_db, table.shaft_std_db);
        let alike = LineLevels { faint_shaft: 1.0, ..unlike };
        assert_normal(&alike, offset_db, table.faint_shaft_db, table.faint_shaft_std_db);
    }

    /// Shares within five standard errors √(p (1 − p)/n).
    #[test]
    fn shares_are_those_of_the_table() {
        let table = LineLevels::default();
        let all = drawn(&table);
        let share =
            |is: &dyn Fn(&ToneSettings) -> bool| all.iter().filter(|tones| is(tones)).count() as f64 / COUNT as f64;
        let is_near = |found: f64, expected: f64| {
            let error = (expected * (1.0 - expected) / COUNT as f64).sqrt();
            assert!((found - expected).abs() < 5.0 * error, "{found} {expected}");
        };
        is_near(share(&|tones| tones.unlike_blades_level == 0.0), table.shaft_inaudible);
        for (factor, expected) in LineLevels::SCATTERS {
            let spread_db = factor * table.line_std_db;
            is_near(share(&|tones| tones.scatter.unwrap().blade_pass.spread_db == spread_db), expected);
        }
        let scatter = all[0].scatter.unwrap();
        assert_eq!(scatter.blade_pass.missing_share, table.blade_pass_missing);
        assert_eq!(scatter.shaft.missing_share, table.shaft_missing);
        assert_eq!((scatter.below.missing_share, scatter.below.spread_db), (table.below_missing, table.below_std_db));
    }

    /// From the first to the twelfth harmonic, the lines fall by the drawn fall more than the noise, 5 dB per octave above 1 kHz.
    #[test]
    fn lines_fall_over_the_floor_by_the_drawn_fall() {
        let vehicle = find_preset("f450").unwrap();
        let table = LineLevels { fall: 1.3, fall_std: 0.0, ..LineLevels::default() };
        for (rev_s, noise_fall_db) in [(20.0, 0.0), (80.0, 5.0 * 1.92_f64.log2()), (600.0, 5.0 * 12_f64.log2())] {
            let source = SourceSettings::drawn(vehicle, RotorSpeed::from_rev_s(rev_s), &table, 3);
            let fall_db = -20.0 * source.tones.blade_pass.unwrap().exponent * 12_f64.log10();
            assert!((fall_db - noise_fall_db - 13.0 * 12_f64.log10()).abs() < 1e-9, "{rev_s}: {fall_db}");
        }
    }

    #[test]
    fn a_motor_without_a_gear_sings_at_its_pole_pairs() {
        let source = |id: &str| {
            SourceSettings::drawn(find_preset(id).unwrap(), RotorSpeed::from_rev_s(60.0), &LineLevels::default(), 4)
        };
        let motor = source("f450").motor.unwrap();
        assert_eq!((motor.order, motor.harmonic_levels.len()), (7.0, 4));
        assert!(motor.harmonic_levels.iter().all(|level| *level > 0.0));
        assert_eq!(
            source("ardrone").motor,
            SourceSettings::for_vehicle(find_preset("ardrone").unwrap(), RotorSpeed::from_rev_s(60.0)).motor
        );
    }
}
