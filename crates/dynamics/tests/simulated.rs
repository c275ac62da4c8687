//! Logs of a motor of first order with dead time, in closed form, with noise and rounding: what the fit makes of them.

// The lints know tests by their attribute, and what tests share has none.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stdout)]

use hovertone_dynamics::{
    CommandSeries, MotorConfig, MotorModel, MotorSeries, StepVerdict, constants_of, motor_from_series,
};
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;

/// A motor and its log.
#[derive(Clone, Copy, Debug)]
struct SimulatedMotor {
    time_constant_up_s: f64,
    time_constant_down_s: f64,
    dead_time_s: f64,
    rate_hz: f64,
    noise_rev_s: f64,
    rounding_rev_s: f64,
}

struct SimulatedLog {
    time_s: Vec<f64>,
    speed_rev_s: Vec<f64>,
    command: Vec<f64>,
}

const LEVELS: [f64; 9] = [0.3, 0.5, 0.35, 0.6, 0.4, 0.7, 0.5, 0.8, 0.45];
const SPEED_PER_COMMAND_REV_S: f64 = 300.0;
const HOLD_S: f64 = 2.0;

fn logged(motor: SimulatedMotor, rng: &mut Pcg64) -> SimulatedLog {
    let mut log = SimulatedLog { time_s: Vec::new(), speed_rev_s: Vec::new(), command: Vec::new() };
    let rows = (HOLD_S * LEVELS.len() as f64 * motor.rate_hz) as usize;
    // the speed at the start of each command's effect
    let mut before = vec![LEVELS[0]];
    for at in 1..LEVELS.len() {
        let last = LEVELS[at - 1];
        before.push(last + (before[at - 1] - last) * (-HOLD_S / motor.time_constant(last > before[at - 1])).exp());
    }
    for row in 0..rows {
        // the period of the logger is not that of the commands
        let time_s = row as f64 / motor.rate_hz + 0.1 / motor.rate_hz * rng.random::<f64>();
        let level = |time_s: f64| ((time_s / HOLD_S).max(0.0) as usize).min(LEVELS.len() - 1);
        let at = level(time_s - motor.dead_time_s);
        let since_s = time_s - motor.dead_time_s - HOLD_S * at as f64;
        let left = (-since_s / motor.time_constant(LEVELS[at] > before[at])).exp();
        let done = if at == 0 { LEVELS[0] } else { LEVELS[at] + (before[at] - LEVELS[at]) * left };
        let noise: f64 = StandardNormal.sample(rng);
        let speed_rev_s = SPEED_PER_COMMAND_REV_S * done + motor.noise_rev_s * noise;
        log.time_s.push(time_s);
        log.speed_rev_s.push((speed_rev_s / motor.rounding_rev_s).round() * motor.rounding_rev_s);
        log.command.push(LEVELS[level(time_s)]);
    }
    log
}

impl SimulatedMotor {
    fn time_constant(&self, is_up: bool) -> f64 {
        if is_up { self.time_constant_up_s } else { self.time_constant_down_s }
    }

    fn random(rng: &mut Pcg64) -> Self {
        let rate_hz = 50.0 * 10f64.powf(rng.random::<f64>());
        let time_constant_up_s = (0.03 + 0.07 * rng.random::<f64>()).max(1.2 / rate_hz);
        Self {
            time_constant_up_s,
            time_constant_down_s: time_constant_up_s * (1.0 + rng.random::<f64>()),
            dead_time_s: 0.06 * rng.random::<f64>(),
            rate_hz,
            noise_rev_s: 0.1 + 0.4 * rng.random::<f64>(),
            rounding_rev_s: [1.0 / 60.0, 10.0 / 60.0, 1.0][rng.random_range(0..3)],
        }
    }
}

fn model(log: &SimulatedLog, has_command: bool) -> MotorModel {
    let series = MotorSeries { time_s: &log.time_s, speed_rev_s: &log.speed_rev_s };
    let command = CommandSeries { time_s: &log.time_s, command: &log.command };
    motor_from_series(series, has_command.then_some(command), &MotorConfig::default()).unwrap()
}

/// Errors of an estimate over its standard uncertainty, and as a share of the truth.
#[derive(Default)]
struct Errors {
    in_std: Vec<f64>,
    share: Vec<f64>,
}

impl Errors {
    fn add(&mut self, estimate: hovertone_vehicle::Estimate, truth: f64) {
        self.in_std.push((estimate.value - truth) / estimate.std_uncertainty.unwrap());
        self.share.push(estimate.value / truth - 1.0);
    }

    /// Share of the errors within two standard uncertainties.
    fn coverage(&self) -> f64 {
        self.in_std.iter().filter(|error| error.abs() <= 2.0).count() as f64 / self.in_std.len() as f64
    }

    fn within(&self, share: f64) -> f64 {
        self.share.iter().filter(|error| error.abs() <= share).count() as f64 / self.share.len() as f64
    }
}

#[test]
fn time_constants_of_simulated_logs_are_right_and_their_uncertainty_is_true() {
    for has_command in [true, false] {
        let mut rng = Pcg64::seed_from_u64(11);
        let (mut steps, mut combined, mut dead) = (Errors::default(), Errors::default(), Errors::default());
        for _ in 0..100 {
            let motor = SimulatedMotor::random(&mut rng);
            let found = model(&logged(motor, &mut rng), has_command);
            assert_eq!(found.steps.len(), LEVELS.len() - 1, "{motor:?}");
            for step in &found.steps {
                assert_eq!(step.verdict, StepVerdict::Used, "{motor:?} {step:?}");
                steps.add(step.time_constant_s.unwrap(), motor.time_constant(step.is_up()));
            }
            let constants = constants_of(std::slice::from_ref(&found));
            combined.add(constants.time_constant_up_s.unwrap().estimate, motor.time_constant_up_s);
            combined.add(constants.time_constant_down_s.unwrap().estimate, motor.time_constant_down_s);
            assert_eq!(constants.dead_time_s.is_some(), has_command);
            if let Some(dead_time_s) = constants.dead_time_s {
                // the row that names a command comes half an interval after it, on average
                dead.add(dead_time_s.estimate, motor.dead_time_s - 0.5 / motor.rate_hz);
                let gain = found.static_map.as_ref().unwrap().gain_rev_s.unwrap();
                assert!((gain.value / SPEED_PER_COMMAND_REV_S - 1.0).abs() < 0.01, "{gain:?}");
            }
        }
        println!(
            "command {has_command}: steps within 3 % {:.3}, coverage {:.3}; combined {:.3}, {:.3}; dead time coverage {:.3}",
            steps.within(0.03),
            steps.coverage(),
            combined.within(0.03),
            combined.coverage(),
            dead.coverage()
        );
        assert!(combined.within(0.03) >= 0.95);
        for errors in [&steps, &combined] {
            assert!((0.90..=0.98).contains(&errors.coverage()), "{}", errors.coverage());
        }
    }
}

/// Steps of a motor with the square term, in closed form: behind a step of size S to ω the rest decays as r/(k S + (r − k S) e^{r t}), with
/// r = 1/τ₀ + 2 k ω.
fn with_load(levels_rev_s: &[f64], square_per_rev: f64, rng: &mut Pcg64) -> SimulatedLog {
    let mut log = SimulatedLog { time_s: Vec::new(), speed_rev_s: Vec::new(), command: Vec::new() };
    for row in 0..(HOLD_S * 200.0) as usize * levels_rev_s.len() {
        let time_s = row as f64 / 200.0;
        let at = ((time_s / HOLD_S) as usize).min(levels_rev_s.len() - 1);
        let (level, before) = (levels_rev_s[at], levels_rev_s[at.saturating_sub(1)]);
        let rate = 10.0 + 2.0 * square_per_rev * level;
        let of_load = square_per_rev * (level - before);
        let left = rate / (of_load + (rate - of_load) * (rate * (time_s - HOLD_S * at as f64)).exp());
        let noise: f64 = StandardNormal.sample(rng);
        log.time_s.push(time_s);
        log.speed_rev_s.push(level + (before - level) * left + 0.2 * noise);
        log.command.push(level);
    }
    log
}

#[test]
fn the_square_term_is_told_where_the_range_of_speeds_allows_it() {
    let wide = [60.0, 100.0, 140.0, 180.0, 220.0, 260.0, 300.0];
    let narrow = [200.0, 210.0, 220.0, 230.0, 240.0];
    let (mut rng, mut errors) = (Pcg64::seed_from_u64(5), Errors::default());
    for square_per_rev in [0.02, 0.04] {
        for _ in 0..20 {
            let found = constants_of(&[model(&with_load(&wide, square_per_rev, &mut rng), true)]).load_term.unwrap();
            errors.add(found.square_per_rev, square_per_rev);
        }
    }
    println!("square term: within 10 % {:.3}, coverage {:.3}", errors.within(0.1), errors.coverage());
    assert!(errors.within(0.1) >= 0.9 && errors.coverage() >= 0.9);
    let found = constants_of(&[model(&with_load(&narrow, 0.02, &mut rng), true)]);
    assert!(found.time_constant_up_s.is_some() && found.load_term.is_none());
}
