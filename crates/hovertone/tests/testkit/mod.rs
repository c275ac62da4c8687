//! Sound with known truth, made here and not by the simulator: the estimator is examined by a stranger.
#![allow(dead_code, missing_docs, unreachable_pub, clippy::expect_used)] // each test file uses its part

pub mod not_rotors;

use hovertone::sound::Signal;
use hovertone::speed::{Config, Outcome, RotorTone, SpeedAnalysis, ToneConfig, speed_from_source};
use hovertone_vehicle::Order;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use std::f64::consts::TAU;

pub const SAMPLE_RATE_HZ: f64 = 44100.0;

/// One rotor: its shaft speed over time and the amplitude of each order that it sounds.
pub struct Rotor<'a> {
    pub speed_rev_s: &'a dyn Fn(f64) -> f64,
    pub lines: &'a [(f64, f64)],
}

/// Steady blade-pass series of a two-bladed rotor.
pub const TWO_BLADES: [(f64, f64); 5] = [(1.0, 0.01), (2.0, 0.1), (4.0, 0.05), (6.0, 0.03), (8.0, 0.02)];

/// The rotors' sound in white noise of a standard deviation, phases continuous.
pub fn sound(rotors: &[Rotor<'_>], length_s: f64, noise_std: f64, seed: u64) -> Vec<f32> {
    let mut rng = rand_pcg::Pcg64::seed_from_u64(seed);
    let mut turns = vec![0.1; rotors.len()];
    (0..(length_s * SAMPLE_RATE_HZ) as usize)
        .map(|n| {
            let time_s = n as f64 / SAMPLE_RATE_HZ;
            let mut sample = noise_std * Distribution::<f64>::sample(&StandardNormal, &mut rng);
            for (rotor, turns) in rotors.iter().zip(&mut turns) {
                for (order, amplitude) in rotor.lines {
                    sample += amplitude * (TAU * (order * *turns + 0.37 * order)).cos();
                }
                *turns += (rotor.speed_rev_s)(time_s) / SAMPLE_RATE_HZ;
            }
            sample as f32
        })
        .collect()
}

/// One steady rotor of two blades.
pub fn steady(speed_rev_s: f64, length_s: f64, noise_std: f64) -> Vec<f32> {
    sound(&[Rotor { speed_rev_s: &|_| speed_rev_s, lines: &TWO_BLADES }], length_s, noise_std, 1)
}

/// Every method is examined.
pub fn config(order: f64) -> Config {
    let tone = ToneConfig::of_order(Order::new(order).expect("an order"));
    Config { all_methods: true, ..Config::for_tone(tone) }
}

pub fn analyse(samples: Vec<f32>, config: &Config) -> SpeedAnalysis {
    let mut source = Signal::new(samples, SAMPLE_RATE_HZ);
    speed_from_source(&mut source, config, &mut |_| {}).expect("an analysis")
}

pub fn tone(analysis: &SpeedAnalysis) -> &RotorTone {
    match &analysis.outcome {
        Outcome::Ok(tone) => tone,
        Outcome::NoRotorTone { reason } => panic!("no rotor tone: {reason}"),
    }
}

pub fn hears_nothing(analysis: &SpeedAnalysis) -> bool {
    matches!(analysis.outcome, Outcome::NoRotorTone { .. })
}
