//! Several rotors told apart from one microphone, with the truth known at every instant. `hovertone-bench rotors` does it with
//! many more, and with echoes.

#![allow(clippy::unwrap_used, clippy::panic)] // a test may

use hovertone::sound::Signal;
use hovertone::speed::{Config, Method, Outcome, RotorTone, SpeedAnalysis, ToneConfig, Warning, speed_from_source};
use hovertone_vehicle::Order;
use rand::{RngExt, SeedableRng};
use rand_distr::{Distribution, StandardNormal};
use std::f64::consts::TAU;

const RATE_HZ: f64 = 48000.0;
const LENGTH_S: f64 = 6.0;
/// Noise beside lines of amplitude 1.
const QUIET: f64 = 0.4;
const LINES: [(f64, f64); 9] = [
    (69.0, 1.0),
    (70.0, 0.3),
    (68.0, 0.3),
    (138.0, 0.5),
    (207.0, 0.25),
    (2.0, 2.0),
    (20.0, 0.4),
    (28.0, 0.3),
    (36.0, 0.26),
];

/// What is heard of each rotor, and beside it: lines by order and amplitude, noise beside lines of amplitude 1, and how long a line keeps
/// its phase.
struct Sound<'a> {
    lines: &'a [(f64, f64)],
    noise_std: f64,
    coherence_s: f64,
}

const SOUND: Sound = Sound { lines: &LINES, noise_std: QUIET, coherence_s: f64::INFINITY };

/// A rotor: mean speed, loudness, and how far and how often in a second it swings around its mean.
struct Rotor {
    mean_rev_s: f64,
    level: f64,
    swing_share: f64,
    swing_hz: f64,
}

impl Rotor {
    fn at(mean_rev_s: f64) -> Self {
        Self { mean_rev_s, level: 1.0, swing_share: 0.0, swing_hz: 0.1 }
    }

    fn swinging(mean_rev_s: f64) -> Self {
        Self { swing_share: 0.002, swing_hz: 0.3, ..Self::at(mean_rev_s) }
    }

    fn speed_rev_s(&self, time_s: f64) -> f64 {
        self.mean_rev_s * (1.0 + self.swing_share * (TAU * self.swing_hz * time_s).sin())
    }

    fn turns(&self, time_s: f64) -> f64 {
        let swung = (1.0 - (TAU * self.swing_hz * time_s).cos()) / (TAU * self.swing_hz);
        self.mean_rev_s * (time_s + self.swing_share * swung)
    }
}

fn heard(rotors: &[Rotor], seed: u64) -> SpeedAnalysis {
    let mut tone = ToneConfig::of_order(Order::new(69.0).unwrap());
    tone.blades = Some(2);
    heard_by(rotors, &SOUND, tone, seed)
}

fn heard_by(rotors: &[Rotor], sound: &Sound, tone: ToneConfig, seed: u64) -> SpeedAnalysis {
    let mut rng = rand_pcg::Pcg64::seed_from_u64(seed);
    let mut samples = vec![0.0; (LENGTH_S * RATE_HZ) as usize];
    for rotor in rotors {
        let turns: Vec<f64> = (0..samples.len()).map(|n| rotor.turns(n as f64 / RATE_HZ)).collect();
        for &(order, level) in sound.lines {
            let mut phase: f64 = rng.random_range(0.0..TAU);
            let level = level * rotor.level * rng.random_range(0.8..1.25);
            let phase_step = (2.0 / (RATE_HZ * sound.coherence_s)).sqrt();
            for (sample, turns) in samples.iter_mut().zip(&turns) {
                if phase_step > 0.0 {
                    phase += phase_step * rng.sample::<f64, _>(StandardNormal);
                }
                *sample += level * (TAU * (order * turns).fract() + phase).cos();
            }
        }
    }
    let samples = samples.into_iter().map(|sample| {
        let noise: f64 = StandardNormal.sample(&mut rng);
        (0.003 * (sample + sound.noise_std * noise)) as f32
    });
    let mut config = Config::for_tone(tone);
    config.rotors.count = 4;
    config.method = Method::Separated;
    let mut signal = Signal::new(samples.collect(), RATE_HZ);
    speed_from_source(&mut signal, &config, &mut |_| {}).unwrap()
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

fn tone_of(analysis: &SpeedAnalysis) -> &RotorTone {
    match &analysis.outcome {
        Outcome::Ok(tone) => tone,
        Outcome::NoRotorTone { reason } => panic!("{reason}"),
    }
}

#[test]
fn four_rotors_are_told_apart_where_two_of_them_cross() {
    // the second and the third cross several times
    let swing = |mean_rev_s, swing_share, swing_hz| Rotor { swing_share, swing_hz, ..Rotor::at(mean_rev_s) };
    let rotors =
        [swing(61.0, 0.001, 0.3), swing(60.3, 0.004, 0.4), swing(60.15, 0.002, 0.25), swing(59.4, 0.0005, 0.5)];
    let analysis = heard(&rotors, 1);
    let tone = tone_of(&analysis);
    assert_eq!(tone.rotors.len(), 4);
    let middles = (0..(LENGTH_S / 0.01) as usize).map(|step| (step as f64 + 0.5) * 0.01);
    let mean_square = middles
        .flat_map(|time_s| rotors.iter().map(move |rotor| (TAU * rotor.speed_rev_s(time_s)).powi(2)))
        .sum::<f64>()
        / (4.0 * LENGTH_S / 0.01);
    let speed = tone.speed(Method::Separated).unwrap();
    assert_eq!(speed.method, Method::Separated);
    let error = speed.mean_square_rad2_s2.unwrap() / mean_square - 1.0;
    assert!(error.abs() < 1e-4, "{error}");
    // one labelling from the first to the last instant; but for the moments in which two are in one place
    let points =
        tone.rotors.iter().zip([0, 1, 2, 3]).flat_map(|(rotor, real)| rotor.track.iter().map(move |p| (p, real)));
    let (mut right, mut all) = (0, 0);
    for (point, real) in points.filter(|(point, _)| (0.3..LENGTH_S - 0.3).contains(&point.time_s)) {
        all += 1;
        right += usize::from((point.speed_rev_s - rotors[real].speed_rev_s(point.time_s)).abs() < 0.05);
    }
    assert!(all > 400 && 10 * right > 9 * all, "{right} of {all}");
}

#[test]
fn rotors_that_bob_together_keep_their_distances() {
    // 13 % in a second at its fastest, by 1.4 times what neighbours are apart to either side
    let bobbing = |mean_rev_s| Rotor { swing_share: 0.014, swing_hz: 1.5, ..Rotor::at(mean_rev_s) };
    let rotors = [61.1, 60.5, 59.9, 59.3].map(bobbing);
    let analysis = heard(&rotors, 11);
    let tone = tone_of(&analysis);
    assert_eq!(tone.rotors.len(), 4);
    for (found, real) in tone.rotors.iter().zip(&rotors) {
        let error = found.speed.speed.rev_s() - real.mean_rev_s;
        assert!(error.abs() < 0.05, "{error}");
        let points = || found.track.iter().filter(|point| (0.3..LENGTH_S - 0.3).contains(&point.time_s));
        let right = points().filter(|point| (point.speed_rev_s - real.speed_rev_s(point.time_s)).abs() < 0.3).count();
        assert!(20 * right > 19 * points().count(), "{right} of {}", points().count());
    }
    let mean_square = mean(rotors.iter().map(|rotor| {
        let time_s = |step: u32| f64::from(step) * LENGTH_S / 600.0;
        mean((0..600).map(|step| (TAU * rotor.speed_rev_s(time_s(step))).powi(2)))
    }));
    let error = tone.speed(Method::Separated).unwrap().mean_square_rad2_s2.unwrap() / mean_square - 1.0;
    assert!(error.abs() < 5e-4, "{error}");
}

#[test]
fn rotors_far_apart_are_found_wherever_the_loudest_is() {
    for loudest in 0..4 {
        let mut rotors: Vec<Rotor> = [54.0, 58.1, 62.0, 66.0].map(Rotor::at).into();
        rotors[loudest].level = 2.0;
        let analysis = heard(&rotors, 2 + loudest as u64);
        let tone = tone_of(&analysis);
        let speeds: Vec<f64> = tone.rotors.iter().rev().map(|rotor| rotor.speed.speed.rev_s()).collect();
        assert_eq!(speeds.len(), 4, "loudest {loudest}: {speeds:?}");
        for (speed, rotor) in speeds.iter().zip(&rotors) {
            assert!((speed - rotor.mean_rev_s).abs() < 1e-3, "loudest {loudest}: {speeds:?}");
        }
        assert!(analysis.warnings.iter().all(|warning| !matches!(warning, Warning::RotorsNotApart { .. })));
    }
}

#[test]
fn a_weak_rotor_is_found_beside_loud_ones() {
    // 14 dB below the others, by its gear mesh alone: what these leave behind when they are taken away is as loud
    let lines = [(69.0, 1.0), (68.0, 0.3), (70.0, 0.3), (138.0, 0.5), (207.0, 0.25)];
    for (weak, seed) in [0, 1, 3].into_iter().zip(60..) {
        let mut rotors = [61.1, 60.5, 59.9, 59.3].map(Rotor::swinging);
        rotors[weak].level = 0.2;
        let analysis =
            heard_by(&rotors, &Sound { lines: &lines, ..SOUND }, ToneConfig::of_order(Order::new(69.0).unwrap()), seed);
        let tone = tone_of(&analysis);
        assert_eq!(tone.rotors.len(), 4, "weak {weak}");
        for (heard, rotor) in tone.rotors.iter().zip(&rotors) {
            let error = heard.speed.speed.rev_s() - rotor.turns(LENGTH_S) / LENGTH_S;
            assert!(error.abs() < 2e-3, "weak {weak}: {error}");
        }
    }
}

#[test]
fn many_lines_of_four_rotors_are_no_other_sound() {
    // forty lines, few of them explained by the loudest rotor alone, make chance series; and now one rotor leads, now another
    let lines: Vec<(f64, f64)> = (1..=20).map(|k| (2.0 * f64::from(k), f64::from(k).powf(-0.5))).collect();
    for seed in 0..3 {
        let rotors: Vec<Rotor> = [61.98, 60.76, 59.57, 58.37]
            .into_iter()
            .enumerate()
            .map(|(rotor, mean)| Rotor { swing_share: 0.002, swing_hz: 0.2 + 0.1 * rotor as f64, ..Rotor::at(mean) })
            .collect();
        let tone = ToneConfig::of_order(Order::new(2.0).unwrap());
        let analysis = heard_by(&rotors, &Sound { lines: &lines, ..SOUND }, tone, 20 + seed);
        let tone = tone_of(&analysis);
        assert_eq!(tone.rotors.len(), 4);
        let unused_s = LENGTH_S - analysis.hover.length_s();
        assert!(unused_s < 0.1, "seed {seed}: {:?}", analysis.hover.cuts);
        for (heard, rotor) in tone.rotors.iter().zip(&rotors) {
            let middles = (0..600).map(|step| (f64::from(step) + 0.5) * 0.01);
            let truth = middles.map(|time_s| rotor.speed_rev_s(time_s)).sum::<f64>() / 600.0;
            let error = heard.speed.speed.rev_s() / truth - 1.0;
            assert!(error.abs() < 1e-4, "seed {seed}: {error}");
        }
    }
}

#[test]
fn rotors_in_loud_noise_say_how_little_is_known_of_them() {
    let (mut answered, mut apart, mut within) = (0, 0, 0);
    for (noise_std, seed) in [6.0, 9.0, 12.0, 20.0].into_iter().flat_map(|noise| (0..3).map(move |seed| (noise, seed)))
    {
        let rotors = [59.4, 59.9, 60.3, 60.8].map(Rotor::swinging);
        let mut tone = ToneConfig::of_order(Order::new(69.0).unwrap());
        tone.blades = Some(2);
        let analysis = heard_by(&rotors, &Sound { noise_std, ..SOUND }, tone, 40 + seed);
        let Outcome::Ok(tone) = &analysis.outcome else { continue };
        let speed = tone.speed(Method::Separated).unwrap();
        let std = speed.combined_std_uncertainty_rev_s().unwrap();
        assert!(tone.rotors.len() == 4 || speed.rotors_std_share() > 0.0);
        answered += 1;
        apart += u32::from(speed.method == Method::Separated);
        // the mean of swings that begin at 0 is 0.1 % higher over 6 s
        let truth = rotors.iter().map(|rotor| rotor.turns(LENGTH_S) / LENGTH_S).sum::<f64>() / 4.0;
        let error = speed.speed.rev_s() - truth;
        assert!(error.abs() < 4.0 * std, "noise {noise_std}, seed {seed}: {error} ± {std}");
        within += u32::from(error.abs() < 2.0 * std);
    }
    // half in the louder noise are refused; of the rest nine tenths within k = 2
    assert!(answered >= 6 && apart >= 6 && 10 * within >= 9 * answered, "{within} of {answered}, {apart} apart");
}

#[test]
fn rotors_that_speed_up_together_keep_their_places() {
    // in half a second they move by three times what they are apart
    let mean_rev_s = [61.1, 60.4, 59.7, 59.0];
    for seed in 80..83 {
        let rotors = mean_rev_s.map(|mean| Rotor { swing_share: 0.02, swing_hz: 0.7, ..Rotor::at(mean) });
        let analysis = heard(&rotors, seed);
        let tone = tone_of(&analysis);
        assert_eq!(tone.rotors.len(), 4);
        for (heard, rotor) in tone.rotors.iter().zip(&rotors) {
            let error = heard.speed.speed.rev_s() - rotor.turns(LENGTH_S) / LENGTH_S;
            assert!(error.abs() < 0.02, "seed {seed}: {error}");
            for point in heard.track.iter().filter(|point| (0.3..LENGTH_S - 0.3).contains(&point.time_s)) {
                let error = point.speed_rev_s - rotor.speed_rev_s(point.time_s);
                assert!(error.abs() < 0.35, "seed {seed}, {} s: {error}", point.time_s);
            }
        }
    }
}

#[test]
fn rotors_in_pairs_have_the_mean_of_all_four() {
    for seed in 90..93 {
        let rotors = [60.8, 60.8, 59.3, 59.3].map(Rotor::swinging);
        let analysis = heard(&rotors, seed);
        let tone = tone_of(&analysis);
        let speed = tone.speed(Method::Separated).unwrap();
        let truth = rotors.iter().map(|rotor| rotor.turns(LENGTH_S) / LENGTH_S).sum::<f64>() / 4.0;
        let std = speed.combined_std_uncertainty_rev_s().unwrap();
        let error = speed.speed.rev_s() - truth;
        assert!(speed.method == Method::Separated && tone.rotors.len() < 4);
        assert!(error.abs() < 2.0 * std && std < 0.6, "seed {seed}: {error} ± {std}");
    }
}

#[test]
fn rotors_that_turn_alike_are_not_invented() {
    // all alike: they have a mean, and nobody one of its own
    let analysis = heard(&[60.0; 4].map(Rotor::at), 8);
    let tone = tone_of(&analysis);
    assert!(tone.rotors.is_empty());
    assert!(
        analysis.warnings.iter().any(|warning| matches!(warning, Warning::RotorsNotApart { resolved: 0, of: 4, .. }))
    );
    let speed = tone.speed(Method::Separated).unwrap();
    assert_eq!(speed.method, Method::Separated);
    assert!((tone.speed(Method::Harmonic).unwrap().speed.rev_s() - 60.0).abs() < 1e-3);
    let (error, std) = (speed.speed.rev_s() - 60.0, speed.combined_std_uncertainty_rev_s().unwrap());
    assert!(error.abs() < 0.01 && error.abs() < 2.0 * std, "{error} ± {std}");
    assert!((speed.mean_square_rad2_s2.unwrap() / (TAU * 60.0).powi(2) - 1.0).abs() < 2e-4);
    // any of them may be as far from the others as lines can be without being two
    assert!(speed.rotors_std_share() > 1e-4, "{}", speed.rotors_std_share());
}

#[test]
fn one_rotor_whose_lines_lose_their_phase_is_not_four() {
    // lines that are wider than the frames resolve have room for many paths
    let wide = Sound { coherence_s: 0.2, ..SOUND };
    let mut tone = ToneConfig::of_order(Order::new(69.0).unwrap());
    tone.blades = Some(2);
    for seed in 70..73 {
        let analysis = heard_by(&[Rotor::swinging(60.0)], &wide, tone.clone(), seed);
        let heard = tone_of(&analysis);
        assert!(heard.rotors.is_empty(), "{} rotors", heard.rotors.len());
        let error =
            heard.speed(Method::Separated).unwrap().speed.rev_s() - Rotor::swinging(60.0).turns(LENGTH_S) / LENGTH_S;
        assert!(error.abs() < 0.02, "{error}");
    }
    // four of them are told apart where they are far enough apart
    let rotors = [61.4, 60.4, 59.4, 58.4].map(Rotor::swinging);
    let analysis = heard_by(&rotors, &wide, tone, 73);
    let heard = tone_of(&analysis);
    assert_eq!(heard.rotors.len(), 4);
    for (heard, rotor) in heard.rotors.iter().zip(&rotors) {
        let error = heard.speed.speed.rev_s() - rotor.turns(LENGTH_S) / LENGTH_S;
        assert!(error.abs() < 0.02, "{error}");
    }
}
