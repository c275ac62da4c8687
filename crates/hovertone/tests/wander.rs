//! Many hovers of one rotor that wanders: the mean by the harmonic likelihood, and whether its ± holds.
#![allow(missing_docs)]

mod testkit;

use hovertone::speed::{Config, Span};
use rand::{RngExt, SeedableRng};
use std::f64::consts::TAU;
use testkit::{Rotor, SAMPLE_RATE_HZ, analyse, config, sound, tone};

const DRAWS: u64 = 15;
const LENGTH_S: f64 = 5.0;
/// Standard deviation of the wander as a share, and how many swings of drawn frequency it is made of.
const WANDER_STD_SHARE: f64 = 0.004;
const SWINGS: usize = 4;
const SWING_HZ: std::ops::Range<f64> = 0.05..1.2;

/// Mean speed over the spans, as the sound was made: one speed for each sample.
fn mean_over(spans: &[Span], speed_rev_s: &dyn Fn(f64) -> f64) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0);
    for n in 0..(LENGTH_S * SAMPLE_RATE_HZ) as usize {
        let time_s = n as f64 / SAMPLE_RATE_HZ;
        if spans.iter().any(|span| span.contains(time_s)) {
            (sum, count) = (sum + speed_rev_s(time_s), count + 1.0);
        }
    }
    sum / count
}

#[test]
fn the_mean_of_a_wandering_rotor_is_known_to_a_few_millionths_and_its_uncertainty_holds() {
    let mesh: Vec<(f64, f64)> = vec![(69.0, 0.05), (138.0, 0.025), (207.0, 0.0125)];
    let blade_pass: Vec<(f64, f64)> = (1..=20).map(|k| (2.0 * f64::from(k), 0.05 / f64::from(k))).collect();
    for (name, order, lines, rms_share_max) in [("mesh", 69.0, mesh, 4e-6), ("blade pass", 2.0, blade_pass, 15e-6)] {
        let config = Config { all_methods: false, ..config(order) };
        let (mut covered, mut squares) = (0, 0.0);
        for seed in 0..DRAWS {
            let mut random = rand_pcg::Pcg64::seed_from_u64(1000 + seed);
            let mean_rev_s = random.random_range(50.0..70.0);
            let swings: Vec<(f64, f64)> =
                (0..SWINGS).map(|_| (TAU * random.random_range(SWING_HZ), random.random_range(0.0..TAU))).collect();
            let swing = WANDER_STD_SHARE * (2.0 / SWINGS as f64).sqrt();
            let speed_rev_s = |time_s: f64| {
                mean_rev_s * (1.0 + swing * swings.iter().map(|(w, phase)| (w * time_s + phase).sin()).sum::<f64>())
            };
            let rotor = Rotor { speed_rev_s: &speed_rev_s, lines: &lines };
            let analysis = analyse(sound(&[rotor], LENGTH_S, 0.05, seed), &config);
            let got = &tone(&analysis).speeds[0];
            let error_rev_s = got.speed.rev_s() - mean_over(&analysis.hover.segments, &speed_rev_s);
            let std_rev_s = got.std_uncertainty_rev_s.expect("an uncertainty");
            assert!(error_rev_s.abs() < 6.0 * std_rev_s, "{name} {seed}: off by {error_rev_s}, u {std_rev_s}");
            covered += u32::from(error_rev_s.abs() <= 2.0 * std_rev_s);
            squares += (error_rev_s / mean_rev_s).powi(2);
        }
        let rms_share = (squares / DRAWS as f64).sqrt();
        assert!(rms_share < rms_share_max, "{name}: rms error {rms_share:e}");
        // of 15 at 95 %, 11 or fewer are covered once in two hundred times
        assert!(covered >= 12, "{name}: {covered} of {DRAWS} within 2 u");
    }
}
