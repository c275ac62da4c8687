//! Steps of simulated rotors, heard: time constants against the truth.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // what tests share has no attribute of a test

use hovertone::motors::{
    HeardCommands, HeardMotor, HeardTone, StepVerdict, constants_of, level_of_rotors, motor_from_sound,
};
use hovertone::sound::{Passes, Signal};
use hovertone::speed::{Config, ToneConfig};
use hovertone::vehicle::Order;
use hovertone_dynamics::CommandSeries;
use hovertone_sim::prescribed::{Line, Noise, Recording, Rotor, Sampling, seeded};
use rand::RngExt;

const LEVELS_REV_S: [f64; 5] = [60.0, 85.0, 65.0, 95.0, 70.0];
const HOLD_S: f64 = 1.8;
const RATE_HZ: f64 = 32_000.0;

#[derive(Clone, Copy)]
struct TrueMotor {
    up_s: f64,
    down_s: f64,
}

impl TrueMotor {
    fn speed_rev_s(self, time_s: f64) -> f64 {
        let mut speed = LEVELS_REV_S[0];
        for (at, &level) in LEVELS_REV_S.iter().enumerate().skip(1) {
            let since_s = (time_s - HOLD_S * at as f64).clamp(0.0, HOLD_S);
            let time_constant_s = if level > speed { self.up_s } else { self.down_s };
            speed = level + (speed - level) * (-since_s / time_constant_s).exp();
        }
        speed
    }
}

fn heard(motor: TrueMotor, shares: &[f64], seed: u64) -> HeardMotor {
    heard_with(motor, shares, seed, None)
}

fn heard_with(motor: TrueMotor, shares: &[f64], seed: u64, commands: Option<HeardCommands<'_>>) -> HeardMotor {
    let random = &mut seeded(seed);
    let rotors: Vec<Rotor> = shares
        .iter()
        .map(|&share| {
            let level = |order: i32| if order % 2 == 0 { 1.0 / f64::from(order) } else { 0.1 / f64::from(order) };
            let lines = (1..=20).map(|order| Line::new(f64::from(order), level(order)).with_random_phase(random));
            Rotor::new(move |time_s| share * motor.speed_rev_s(time_s), lines.collect())
        })
        .collect();
    let mut recording = Recording::of_rotors(&rotors, Sampling::new(RATE_HZ, HOLD_S * LEVELS_REV_S.len() as f64));
    recording.add_noise(&Noise::white(0.05), random);
    recording.scale_to_peak(0.5);
    let mut source = Signal::new(recording.samples_f32(), RATE_HZ);
    let mut on_progress = |_| {};
    let mut passes = Passes::planned(&mut source, 1, &mut on_progress).unwrap();
    let config = Config::for_tone(ToneConfig::of_order(Order::new(2.0).unwrap()));
    let speed_rev_s = level_of_rotors(&mut passes, &config).unwrap().unwrap();
    let heard = HeardTone { tone: &config.tone, speed_rev_s, span_s: 0.0..f64::INFINITY };
    motor_from_sound(&mut passes, &heard, commands).unwrap()
}

#[test]
fn time_constants_of_one_rotor_and_of_four_are_right() {
    let mut random = seeded(3);
    for (seed, spread) in [(1, 0.0), (2, 0.01)] {
        let up_s = 0.04 + 0.05 * random.random::<f64>();
        let motor = TrueMotor { up_s, down_s: up_s * (1.0 + random.random::<f64>()) };
        let shares = [-0.5, -0.2, 0.1, 0.5].map(|share| 1.0 + spread * share);
        let shares = if spread > 0.0 { &shares[..] } else { &shares[..1] };
        let model = heard(motor, shares, seed).model.unwrap();
        // lines that beat within a step may hide it
        let found_min = if spread > 0.0 { 2 } else { LEVELS_REV_S.len() - 1 };
        assert!(model.steps.len() >= found_min, "{:?}", model.steps);
        for step in &model.steps {
            println!("{spread}: {:.3} s, {:?}", step.time_s.value, step.time_constant_s);
            assert_eq!(step.verdict, StepVerdict::Used);
            let of_hold = step.time_s.value / HOLD_S;
            assert!((of_hold - of_hold.round()).abs() * HOLD_S < 0.005, "{step:?}");
        }
        let constants = constants_of(&[model]);
        for (told, truth_s) in
            [(constants.time_constant_up_s, motor.up_s), (constants.time_constant_down_s, motor.down_s)]
        {
            let Some(told) = told else { continue };
            let error = told.estimate.value / truth_s - 1.0;
            assert!(error.abs() < 0.03, "{spread}: {error}");
        }
    }
}

/// The commands come 40 ms before their effects, which is a dead time. Two seconds away no command is where the speed steps.
#[test]
fn commands_at_an_impossible_offset_are_not_used_and_the_possible_one_is_told() {
    let dead_time_s = 0.04;
    let time_s: Vec<f64> = (0..900).map(|row| 0.01 * f64::from(row)).collect();
    let level = |time_s: &f64| (((time_s + dead_time_s) / HOLD_S) as usize).min(LEVELS_REV_S.len() - 1);
    let command: Vec<f64> = time_s.iter().map(|time_s| 20.0 * LEVELS_REV_S[level(time_s)]).collect();
    let motor = TrueMotor { up_s: 0.06, down_s: 0.09 };
    let at = |offset_s: f64| {
        let series = CommandSeries { time_s: &time_s, command: &command };
        heard_with(motor, &[1.0], 1, Some(HeardCommands { series, offset_s: Some(offset_s) }))
    };
    let has_map = |motor: &HeardMotor| motor.model.as_ref().is_some_and(|model| model.static_map.is_some());
    let right = at(0.0);
    assert!(right.other_offset_s.is_none() && has_map(&right));
    for wrong_s in [2.0, -0.5] {
        let wrong = at(wrong_s);
        assert!(!has_map(&wrong), "{wrong_s}");
        let told_s = wrong.other_offset_s.unwrap();
        assert!((told_s - dead_time_s).abs() < 0.02, "{wrong_s}: {told_s}");
    }
}

#[test]
fn steady_rotors_have_no_step_and_noise_has_no_rotor() {
    let steady = Rotor::steady(70.0, (1..=12).map(|order| Line::new(f64::from(order), 0.1)).collect());
    let mut recording = Recording::of_rotors(&[steady], Sampling::new(RATE_HZ, 6.0));
    recording.add_noise(&Noise::white(0.05), &mut seeded(1));
    let mut source = Signal::new(recording.samples_f32(), RATE_HZ);
    let mut on_progress = |_| {};
    let config = Config::for_tone(ToneConfig::of_order(Order::new(2.0).unwrap()));
    let mut passes = Passes::planned(&mut source, 1, &mut on_progress).unwrap();
    let tone = HeardTone { tone: &config.tone, speed_rev_s: 70.0, span_s: 0.0..f64::INFINITY };
    let motor = motor_from_sound(&mut passes, &tone, None).unwrap();
    assert!(motor.model.unwrap().steps.is_empty());
    let mut noise = Recording::of_rotors(&[], Sampling::new(RATE_HZ, 6.0));
    noise.add_noise(&Noise::white(0.1), &mut seeded(1));
    let mut source = Signal::new(noise.samples_f32(), RATE_HZ);
    let mut passes = Passes::planned(&mut source, 1, &mut on_progress).unwrap();
    assert!(level_of_rotors(&mut passes, &config).unwrap().is_err());
    assert!(motor_from_sound(&mut passes, &tone, None).unwrap().model.is_none());
}
