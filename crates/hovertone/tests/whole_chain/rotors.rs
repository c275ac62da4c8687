//! Several rotors told apart from one microphone, with the truth known at every instant. `hovertone-bench rotors` does it with
//! many more, and with echoes.

use hovertone::sound::Signal;
use hovertone::speed::{Config, Method, Outcome, RotorTone, SpeedAnalysis, ToneConfig, Warning, speed_from_source};
use hovertone_sim::Truth;
use hovertone_sim::prescribed::{Line, Noise, PhaseWalk, Recording, Rotor, Sampling};
use hovertone_vehicle::Order;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
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

/// The lines of each rotor by order and amplitude, the noise beside lines of amplitude 1, and the time for which a line
/// keeps its phase.
struct Sound<'a> {
    lines: &'a [(f64, f64)],
    noise_std: f64,
    coherence_s: f64,
}

const SOUND: Sound = Sound { lines: &LINES, noise_std: QUIET, coherence_s: f64::INFINITY };

/// The motion of a rotor, and its loudness: mean speed, level, and depth and frequency of the swings around its mean.
struct Motion {
    mean_rev_s: f64,
    level: f64,
    swing_share: f64,
    swing_hz: f64,
}

impl Motion {
    fn at(mean_rev_s: f64) -> Self {
        Self { mean_rev_s, level: 1.0, swing_share: 0.0, swing_hz: 0.1 }
    }

    fn swinging(mean_rev_s: f64) -> Self {
        Self { swing_share: 0.002, swing_hz: 0.3, ..Self::at(mean_rev_s) }
    }

    fn speed_rev_s(&self, time_s: f64) -> f64 {
        self.mean_rev_s * (1.0 + self.swing_share * (TAU * self.swing_hz * time_s).sin())
    }

    /// The rotor with phases and levels drawn.
    fn drawn(&self, sound: &Sound, sampling: &Sampling, random: &mut Pcg64) -> Rotor<'_> {
        let line = |&(order, level): &(f64, f64)| {
            let line = Line::new(order, level * self.level).with_random_phase(random);
            let line = line.times(random.random_range(0.8..1.25));
            if sound.coherence_s.is_infinite() {
                return line;
            }
            let walk = PhaseWalk {
                start_rad: line.phase_rad,
                coherence_s: sound.coherence_s,
                step_s: sampling.node_step_s(),
                count: sampling.node_count(),
            };
            line.changing_phase(walk.drawn_rad(random))
        };
        let lines = sound.lines.iter().map(line).collect();
        Rotor::new(|time_s| self.speed_rev_s(time_s), lines)
    }
}

/// The analysis of a sound, and the truth of its rotors in the order in which they were given.
struct Heard {
    analysis: SpeedAnalysis,
    truth: Truth,
}

impl Heard {
    fn tone(&self) -> &RotorTone {
        match &self.analysis.outcome {
            Outcome::Ok(tone) => tone,
            Outcome::NoRotorTone { reason } => panic!("{reason}"),
        }
    }

    fn true_mean_rev_s(&self, rotor: usize) -> f64 {
        self.truth.mean_speed(rotor, 0.0, LENGTH_S).unwrap().rev_s()
    }

    /// Mean over the rotors of the mean square.
    fn true_mean_square_rad2_s2(&self) -> f64 {
        let rotors = self.truth.rows()[0].rotors.len();
        self.truth.mean_sum_of_squares(0.0, LENGTH_S).unwrap() / rotors as f64
    }
}

fn tone_of_gear_and_blades() -> ToneConfig {
    let mut tone = ToneConfig::of_order(Order::new(69.0).unwrap());
    tone.blades = Some(2);
    tone
}

fn heard(rotors: &[Motion], seed: u64) -> Heard {
    heard_by(rotors, &SOUND, tone_of_gear_and_blades(), seed)
}

fn heard_by(rotors: &[Motion], sound: &Sound, tone: ToneConfig, seed: u64) -> Heard {
    let mut config = Config::for_tone(tone);
    config.rotors.count = 4;
    heard_with(rotors, sound, config, seed)
}

fn heard_with(rotors: &[Motion], sound: &Sound, mut config: Config, seed: u64) -> Heard {
    let mut random = Pcg64::seed_from_u64(seed);
    let sampling = Sampling::new(RATE_HZ, LENGTH_S);
    let rotors: Vec<Rotor<'_>> = rotors.iter().map(|rotor| rotor.drawn(sound, &sampling, &mut random)).collect();
    let mut recording = Recording::of_rotors(&rotors, sampling);
    recording.add_noise(&Noise::white(sound.noise_std), &mut random);
    recording.scale(0.003);
    config.method = Method::Separated;
    let mut signal = Signal::new(recording.samples_f32(), RATE_HZ);
    let analysis = speed_from_source(&mut signal, &config, &mut |_| {}).unwrap();
    Heard { analysis, truth: recording.truth().clone() }
}

#[test]
fn four_rotors_are_told_apart_where_two_of_them_cross() {
    // the second and the third cross several times
    let swing = |mean_rev_s, swing_share, swing_hz| Motion { swing_share, swing_hz, ..Motion::at(mean_rev_s) };
    let rotors =
        [swing(61.0, 0.001, 0.3), swing(60.3, 0.004, 0.4), swing(60.15, 0.002, 0.25), swing(59.4, 0.0005, 0.5)];
    let heard = heard(&rotors, 1);
    let tone = heard.tone();
    assert_eq!(tone.rotors.len(), 4);
    let speed = tone.speed(Method::Separated).unwrap();
    assert_eq!(speed.method, Method::Separated);
    let error = speed.mean_square_rad2_s2.unwrap() / heard.true_mean_square_rad2_s2() - 1.0;
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
fn rotors_that_meet_may_have_changed_places_and_their_uncertainty_says_so() {
    // alike rotors that come together and part again: nobody hears whether they pass each other or turn back
    let slow = |mean_rev_s, swing_share| Motion { swing_share, swing_hz: 1.0 / LENGTH_S, ..Motion::at(mean_rev_s) };
    let meeting = [slow(61.0, 0.01), slow(61.0, -0.01), slow(57.0, 0.0), slow(65.0, 0.0)];
    let tone = heard(&meeting, 3).tone().clone();
    assert_eq!(tone.rotors.len(), 4);
    // both turn at 61.0 on average, or one at 61.39 and the other at 60.61
    for rotor in &tone.rotors[1..3] {
        let (speed_rev_s, std_rev_s) = (rotor.speed.speed.rev_s(), rotor.speed.std_uncertainty_rev_s.unwrap());
        assert!((speed_rev_s - 61.0).abs() < 2.0 * std_rev_s + 0.01, "{speed_rev_s} {std_rev_s}");
    }
    // those that meet nobody are known
    for rotor in [&tone.rotors[0], &tone.rotors[3]] {
        assert!(rotor.speed.std_uncertainty_rev_s.unwrap() < 0.005, "{:?}", rotor.speed);
    }
}

#[test]
fn rotors_that_bob_together_keep_their_distances() {
    // 13 % in a second at its fastest, by 1.4 times what neighbours are apart to either side
    let bobbing = |mean_rev_s| Motion { swing_share: 0.014, swing_hz: 1.5, ..Motion::at(mean_rev_s) };
    let rotors = [61.1, 60.5, 59.9, 59.3].map(bobbing);
    let heard = heard(&rotors, 11);
    let tone = heard.tone();
    assert_eq!(tone.rotors.len(), 4);
    for (index, (found, real)) in tone.rotors.iter().zip(&rotors).enumerate() {
        let error = found.speed.speed.rev_s() - heard.true_mean_rev_s(index);
        assert!(error.abs() < 0.05, "{error}");
        let points = || found.track.iter().filter(|point| (0.3..LENGTH_S - 0.3).contains(&point.time_s));
        let right = points().filter(|point| (point.speed_rev_s - real.speed_rev_s(point.time_s)).abs() < 0.3).count();
        assert!(20 * right > 19 * points().count(), "{right} of {}", points().count());
    }
    let found = tone.speed(Method::Separated).unwrap().mean_square_rad2_s2.unwrap();
    let error = found / heard.true_mean_square_rad2_s2() - 1.0;
    assert!(error.abs() < 5e-4, "{error}");
}

#[test]
fn rotors_far_apart_are_found_wherever_the_loudest_is() {
    for loudest in 0..4 {
        let mut rotors: Vec<Motion> = [54.0, 58.1, 62.0, 66.0].map(Motion::at).into();
        rotors[loudest].level = 2.0;
        let heard = heard(&rotors, 2 + loudest as u64);
        let tone = heard.tone();
        let speeds: Vec<f64> = tone.rotors.iter().rev().map(|rotor| rotor.speed.speed.rev_s()).collect();
        assert_eq!(speeds.len(), 4, "loudest {loudest}: {speeds:?}");
        for (speed, rotor) in speeds.iter().zip(&rotors) {
            assert!((speed - rotor.mean_rev_s).abs() < 1e-3, "loudest {loudest}: {speeds:?}");
        }
        assert!(heard.analysis.warnings.iter().all(|warning| !matches!(warning, Warning::RotorsNotApart { .. })));
    }
}

#[test]
fn a_weak_rotor_is_found_beside_loud_ones() {
    // 14 dB below the others, by its gear mesh alone: what these leave behind when they are taken away is as loud
    let lines = [(69.0, 1.0), (68.0, 0.3), (70.0, 0.3), (138.0, 0.5), (207.0, 0.25)];
    for (weak, seed) in [0, 1, 3].into_iter().zip(60..) {
        let mut rotors = [61.1, 60.5, 59.9, 59.3].map(Motion::swinging);
        rotors[weak].level = 0.2;
        let heard =
            heard_by(&rotors, &Sound { lines: &lines, ..SOUND }, ToneConfig::of_order(Order::new(69.0).unwrap()), seed);
        let tone = heard.tone();
        assert_eq!(tone.rotors.len(), 4, "weak {weak}");
        for (index, found) in tone.rotors.iter().enumerate() {
            let error = found.speed.speed.rev_s() - heard.true_mean_rev_s(index);
            assert!(error.abs() < 2e-3, "weak {weak}: {error}");
        }
    }
}

#[test]
fn many_lines_of_four_rotors_are_no_other_sound() {
    // forty lines, few of them explained by the loudest rotor alone, make chance series; and now one rotor leads, now another
    let lines: Vec<(f64, f64)> = (1..=20).map(|k| (2.0 * f64::from(k), f64::from(k).powf(-0.5))).collect();
    for seed in 0..3 {
        let rotors: Vec<Motion> = [61.98, 60.76, 59.57, 58.37]
            .into_iter()
            .enumerate()
            .map(|(rotor, mean)| Motion { swing_share: 0.002, swing_hz: 0.2 + 0.1 * rotor as f64, ..Motion::at(mean) })
            .collect();
        let tone = ToneConfig::of_order(Order::new(2.0).unwrap());
        let heard = heard_by(&rotors, &Sound { lines: &lines, ..SOUND }, tone, 20 + seed);
        let tone = heard.tone();
        assert_eq!(tone.rotors.len(), 4);
        let unused_s = LENGTH_S - heard.analysis.hover.length_s();
        assert!(unused_s < 0.1, "seed {seed}: {:?}", heard.analysis.hover.cuts);
        for (index, found) in tone.rotors.iter().enumerate() {
            let error = found.speed.speed.rev_s() / heard.true_mean_rev_s(index) - 1.0;
            assert!(error.abs() < 1e-4, "seed {seed}: {error}");
        }
    }
}

#[test]
fn more_rotors_than_those_of_a_quadrotor_are_found() {
    let lines: Vec<(f64, f64)> = (1..=20).map(|k| (2.0 * f64::from(k), f64::from(k).powf(-0.5))).collect();
    // those less than 1 % apart have no path of their own in short frames
    for (count, range_share, seed) in [(4, 0.1, 90), (6, 0.1, 91), (8, 0.1, 92), (6, 0.04, 93), (8, 0.04, 94)] {
        let mean_rev_s = |rotor: u32| 150.0 * (1.0 + range_share * (f64::from(rotor) / f64::from(count - 1) - 0.5));
        let rotors: Vec<Motion> = (0..count).rev().map(mean_rev_s).map(Motion::swinging).collect();
        let mut config = Config::for_tone(ToneConfig::of_order(Order::from_blades(2).unwrap()));
        config.rotors.is_count_known = false;
        let heard = heard_with(&rotors, &Sound { lines: &lines, ..SOUND }, config, seed);
        let tone = heard.tone();
        assert_eq!(tone.rotors.len(), rotors.len(), "{range_share}");
        for (index, found) in tone.rotors.iter().enumerate() {
            let mean_rev_s = heard.true_mean_rev_s(index);
            let error = found.speed.speed.rev_s() / mean_rev_s - 1.0;
            // those that meet may have changed places, and their uncertainty says so
            let std = found.speed.combined_std_uncertainty_rev_s().unwrap() / mean_rev_s;
            assert!(error.abs() < f64::max(1e-4, 3.0 * std), "{count} rotors, {range_share}: {error} ± {std}");
        }
    }
}

#[test]
fn faint_rotors_that_only_long_frames_hear_are_told_apart() {
    let lines: Vec<(f64, f64)> = (1..=6).map(|k| (2.0 * f64::from(k), 0.6f64.powi(k - 1))).collect();
    for (noise_std, seed) in [11.0, 14.0, 17.0].into_iter().zip(70..) {
        let rotors = [133.0, 129.0, 125.0, 121.0].map(Motion::swinging);
        let mut config = Config::for_tone(ToneConfig::of_order(Order::from_blades(2).unwrap()));
        config.rotors.is_count_known = false;
        let heard = heard_with(&rotors, &Sound { lines: &lines, noise_std, ..SOUND }, config, seed);
        let tone = heard.tone();
        assert_eq!(tone.rotors.len(), 4, "noise {noise_std}");
        for (index, found) in tone.rotors.iter().enumerate() {
            let error = found.speed.speed.rev_s() / heard.true_mean_rev_s(index) - 1.0;
            assert!(error.abs() < 1e-3, "noise {noise_std}: {error}");
        }
    }
}

#[test]
fn rotors_in_loud_noise_say_how_little_is_known_of_them() {
    let (mut answered, mut apart, mut within) = (0, 0, 0);
    for (noise_std, seed) in [6.0, 9.0, 12.0, 20.0].into_iter().flat_map(|noise| (0..6).map(move |seed| (noise, seed)))
    {
        let rotors = [59.4, 59.9, 60.3, 60.8].map(Motion::swinging);
        let sound = Sound { noise_std, ..SOUND };
        let heard = heard_by(&rotors, &sound, tone_of_gear_and_blades(), 40 + seed);
        let Outcome::Ok(tone) = &heard.analysis.outcome else { continue };
        let speed = tone.speed(Method::Separated).unwrap();
        let std = speed.combined_std_uncertainty_rev_s().unwrap();
        assert!(tone.rotors.len() == 4 || speed.rotors_std_share() > 0.0);
        answered += 1;
        apart += u32::from(speed.method == Method::Separated);
        // the mean of swings that begin at 0 is 0.1 % higher over 6 s
        let truth = (0..4).map(|rotor| heard.true_mean_rev_s(rotor)).sum::<f64>() / 4.0;
        let error = speed.speed.rev_s() - truth;
        assert!(error.abs() < 4.0 * std, "noise {noise_std}, seed {seed}: {error} ± {std}");
        within += u32::from(error.abs() < 2.0 * std);
    }
    // half in the louder noise are refused; of the rest nine tenths within k = 2
    assert!(answered >= 12 && apart >= 12 && 10 * within >= 9 * answered, "{within} of {answered}, {apart} apart");
}

#[test]
fn rotors_that_speed_up_together_keep_their_places() {
    // in half a second they move by three times what they are apart
    let mean_rev_s = [61.1, 60.4, 59.7, 59.0];
    for seed in 80..83 {
        let rotors = mean_rev_s.map(|mean| Motion { swing_share: 0.02, swing_hz: 0.7, ..Motion::at(mean) });
        let heard = heard(&rotors, seed);
        let tone = heard.tone();
        assert_eq!(tone.rotors.len(), 4);
        for (index, (found, rotor)) in tone.rotors.iter().zip(&rotors).enumerate() {
            let error = found.speed.speed.rev_s() - heard.true_mean_rev_s(index);
            assert!(error.abs() < 0.02, "seed {seed}: {error}");
            for point in found.track.iter().filter(|point| (0.3..LENGTH_S - 0.3).contains(&point.time_s)) {
                let error = point.speed_rev_s - rotor.speed_rev_s(point.time_s);
                assert!(error.abs() < 0.35, "seed {seed}, {} s: {error}", point.time_s);
            }
        }
    }
}

#[test]
fn rotors_in_pairs_have_the_mean_of_all_four() {
    for seed in 90..93 {
        let rotors = [60.8, 60.8, 59.3, 59.3].map(Motion::swinging);
        let heard = heard(&rotors, seed);
        let tone = heard.tone();
        let speed = tone.speed(Method::Separated).unwrap();
        let truth = (0..4).map(|rotor| heard.true_mean_rev_s(rotor)).sum::<f64>() / 4.0;
        let std = speed.combined_std_uncertainty_rev_s().unwrap();
        let error = speed.speed.rev_s() - truth;
        assert!(speed.method == Method::Separated && tone.rotors.len() < 4);
        assert!(error.abs() < 2.0 * std && std < 0.6, "seed {seed}: {error} ± {std}");
    }
}

#[test]
fn rotors_that_turn_alike_are_not_invented() {
    // all alike: they have a mean, and nobody one of its own
    let heard = heard(&[60.0; 4].map(Motion::at), 8);
    let tone = heard.tone();
    assert!(tone.rotors.is_empty());
    assert!(
        heard
            .analysis
            .warnings
            .iter()
            .any(|warning| matches!(warning, Warning::RotorsNotApart { resolved: 0, of: 4, .. }))
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
    let tone = tone_of_gear_and_blades();
    for seed in 70..73 {
        let heard = heard_by(&[Motion::swinging(60.0)], &wide, tone.clone(), seed);
        let answer = heard.tone();
        assert!(answer.rotors.is_empty(), "{} rotors", answer.rotors.len());
        let error = answer.speed(Method::Separated).unwrap().speed.rev_s() - heard.true_mean_rev_s(0);
        assert!(error.abs() < 0.02, "{error}");
    }
    // four of them are told apart where they are far enough apart
    let rotors = [61.4, 60.4, 59.4, 58.4].map(Motion::swinging);
    let heard = heard_by(&rotors, &wide, tone, 73);
    let answer = heard.tone();
    assert_eq!(answer.rotors.len(), 4);
    for (index, found) in answer.rotors.iter().enumerate() {
        let error = found.speed.speed.rev_s() - heard.true_mean_rev_s(index);
        assert!(error.abs() < 0.02, "{error}");
    }
}
