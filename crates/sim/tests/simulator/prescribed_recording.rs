//! A recording of rotors at prescribed speeds against its own truth and against formulas.

use hovertone_sim::Span;
use hovertone_sim::prescribed::{
    Line, Nodes, Noise, PhaseWalk, Recording, Rotor, Sampling, SineWander, Wander, seeded,
};
use std::f64::consts::TAU;

const RATE_HZ: f64 = 48_000.0;

fn sampling(length_s: f64) -> Sampling {
    Sampling::new(RATE_HZ, length_s)
}

fn power(samples: &[f64]) -> f64 {
    samples.iter().map(|sample| sample * sample).sum::<f64>() / samples.len() as f64
}

/// The phase of a line is its order times the turns of the truth, at every sample, while the speed wanders by 1 %.
#[test]
fn lines_turn_exactly_as_the_truth_says() {
    let wander = SineWander::drawn(0.01, 5, 0.1..3.0, &mut seeded(1));
    let lines = [69.0, 138.0, 2.5].map(|order| Line::new(order, 1.0 / order).with_phase_rad(0.3 * order));
    for start_turns in [0.0, 0.7] {
        let rotor = Rotor::new(|time_s| 60.0 * (1.0 + wander.at(time_s)), lines.to_vec()).from_turns(start_turns);
        let recording = Recording::of_rotors(&[rotor], sampling(5.0).with_truth_at_every_sample());
        let rows = recording.truth().rows();
        assert_eq!(rows.len(), recording.samples().len() + 1);
        for (sample, row) in recording.samples().iter().zip(rows) {
            let turns = start_turns + row.rotors[0].turns;
            let line = |line: &Line| line.level * (TAU * (line.order * turns).fract() + line.phase_rad).cos();
            let expected: f64 = lines.iter().map(line).sum();
            assert!((sample - expected).abs() < 1e-10, "{} s: {sample} {expected}", row.time_s);
        }
    }
}

/// Means of the truth against integrals by hand: of a speed `n (1 + a sin wt)` the mean is `n (1 + a (cos wp - cos wq) /
/// (w (q - p)))`; the mean square follows from `sin² = (1 - cos 2wt) / 2`.
#[test]
fn means_are_the_integrals_of_the_prescribed_speed() {
    let (n, a, w) = (60.0, 0.01, TAU * 0.7);
    let rotor = || Rotor::new(|time_s| n * (1.0 + a * (w * time_s).sin()), Vec::new());
    let recording = Recording::of_rotors(&[Rotor::steady(50.0, Vec::new()), rotor()], sampling(4.0));
    let truth = recording.truth();
    let integral = |to_s: f64| n * (to_s - a / w * (w * to_s).cos());
    let square_integral = |to_s: f64| {
        let sine_square = to_s / 2.0 - (2.0 * w * to_s).sin() / (4.0 * w);
        n * n * (to_s - 2.0 * a / w * (w * to_s).cos() + a * a * sine_square)
    };
    let spans =
        [Span { from_s: 0.0, to_s: 4.0 }, Span { from_s: 0.5, to_s: 1.3 }, Span { from_s: 1.234_56, to_s: 3.3 }];
    for Span { from_s, to_s } in spans {
        let mean = (integral(to_s) - integral(from_s)) / (to_s - from_s);
        assert!((truth.mean_speed(1, from_s, to_s).unwrap().rev_s() / mean - 1.0).abs() < 1e-8);
        let mean_square = TAU * TAU * (square_integral(to_s) - square_integral(from_s)) / (to_s - from_s);
        assert!((truth.mean_square(1, from_s, to_s).unwrap() / mean_square - 1.0).abs() < 1e-8);
        assert!((truth.mean_speed(0, from_s, to_s).unwrap().rev_s() - 50.0).abs() < 1e-9);
    }
    let length_s: f64 = spans.iter().map(|span| span.to_s - span.from_s).sum();
    let turned: f64 = spans.iter().map(|span| integral(span.to_s) - integral(span.from_s)).sum();
    assert!((truth.mean_speed_over(1, &spans).unwrap().rev_s() / (turned / length_s) - 1.0).abs() < 1e-8);
    assert_eq!(truth.mean_speed_over(1, &[]), None);
    assert_eq!(truth.mean_speed_over(1, &[Span { from_s: 3.0, to_s: 4.1 }]), None);
    let speeds = truth.speeds_rev_s_at(1.003).unwrap();
    assert!(speeds[0] == 50.0 && (speeds[1] - n * (1.0 + a * (w * 1.003_f64).sin())).abs() < 1e-4, "{speeds:?}");
    assert_eq!(truth.speeds_rev_s_at(4.1), None);
}

/// The chirps of a rotor with speeds at nodes against the phasors of the same rotor as a function of time. Both sum up some 300
/// turns, by 1000 steps a second or 48000: the rounding of the phase at order 69 is far below 1e-7 rad.
#[test]
fn a_rotor_at_nodes_sounds_like_its_function() {
    let sampling = sampling(5.0009);
    let random = &mut seeded(2);
    let (step_s, count) = (sampling.node_step_s(), sampling.node_count());
    let speeds: Vec<f64> = Wander { std: 0.5, time_constant_s: 0.6, step_s, count }
        .critically_damped(random)
        .into_iter()
        .map(|change| 60.0 + change)
        .collect();
    let swell = Wander { std: 0.1, time_constant_s: 1.0, step_s, count }.critically_damped(random);
    let walk = PhaseWalk { start_rad: 0.3, coherence_s: 0.2, step_s, count }.drawn_rad(random);
    let changing = Line::new(69.0, 0.5).changing_level(swell.iter().map(|change| 1.0 + change).collect());
    let lines = || vec![Line::new(2.0, 1.0).with_phase_rad(1.0), changing.clone().changing_phase(walk.clone())];
    let nodes = Nodes::new(step_s, speeds.clone());
    let level = |time_s: f64| 1.0 + 0.1 * time_s;
    let at_nodes = Rotor::at_nodes(speeds, lines()).from_turns(0.2).with_level(level);
    let by_function = Rotor::new(|time_s| nodes.at(time_s), lines()).from_turns(0.2).with_level(level);
    let at_nodes = Recording::of_rotors(&[at_nodes], sampling);
    let by_function = Recording::of_rotors(&[by_function], sampling);
    for (a, b) in at_nodes.samples().iter().zip(by_function.samples()) {
        assert!((a - b).abs() < 1e-7, "{a} {b}");
    }
    let (a, b) = (at_nodes.truth().rows(), by_function.truth().rows());
    assert_eq!(a.len(), b.len());
    for (a, b) in a.iter().zip(b) {
        assert_eq!(a.time_s, b.time_s);
        let (a, b) = (a.rotors[0], b.rotors[0]);
        assert!((a.speed_rev_s - b.speed_rev_s).abs() < 1e-9 && (a.turns - b.turns).abs() < 1e-8, "{a:?} {b:?}");
        assert!((a.square_integral_rad2_s - b.square_integral_rad2_s).abs() < 1e-8 * b.square_integral_rad2_s.max(1.0));
    }
}

#[test]
fn rotors_add_up_and_each_has_its_level() {
    let lines = || vec![Line::new(2.0, 1.0), Line::new(4.0, 0.5)];
    let level = |time_s: f64| if time_s < 0.5 { 0.0 } else { time_s };
    let first = || Rotor::steady(60.0, lines());
    let second = || Rotor::steady(61.3, lines()).with_level(level);
    let samples = |rotors: &[Rotor<'_>]| Recording::of_rotors(rotors, sampling(1.0)).samples().to_vec();
    let (one, other, both) = (samples(&[first()]), samples(&[second()]), samples(&[first(), second()]));
    let full = samples(&[Rotor::steady(61.3, lines())]);
    for (n, sample) in both.iter().enumerate() {
        assert_eq!(*sample, one[n] + other[n]);
        assert!((other[n] - level(n as f64 / RATE_HZ) * full[n]).abs() < 1e-12);
    }
    assert!(power(&other[..24_000]) == 0.0 && power(&other[24_000..]) > 0.1);
}

#[test]
fn lines_near_half_the_sample_rate_are_silent() {
    let heard = |order: f64| {
        let rotor = Rotor::steady(100.0, vec![Line::new(order, 1.0)]);
        power(Recording::of_rotors(&[rotor], sampling(0.1)).samples())
    };
    assert!(heard(215.0) > 0.4 && heard(217.0) == 0.0);
}

/// The mean square of N white samples has the relative standard deviation √(2/N).
#[test]
fn the_signal_to_noise_ratio_is_the_set_one_and_a_seed_repeats() {
    let lines = || [2.0, 4.0, 69.0].map(|order| Line::new(order, 0.3)).to_vec();
    let tone_power: f64 = lines().iter().map(Line::power).sum();
    let made = |seed: u64| {
        let mut recording = Recording::of_rotors(&[Rotor::steady(60.0, lines())], sampling(5.0));
        let tones = recording.samples().to_vec();
        assert!((power(&tones) / tone_power - 1.0).abs() < 1e-9);
        recording.add_noise(&Noise::white((tone_power * 10.0).sqrt()), &mut seeded(seed));
        let noise: Vec<f64> = recording.samples().iter().zip(tones).map(|(both, tone)| both - tone).collect();
        recording.scale_to_peak(0.5);
        let peak = recording.samples().iter().fold(0.0_f64, |peak, sample| peak.max(sample.abs()));
        assert!((peak - 0.5).abs() < 1e-12);
        (power(&noise), recording.samples_f32())
    };
    let (noise_power, samples) = made(3);
    let ratio = noise_power / tone_power / 10.0;
    assert!((ratio - 1.0).abs() < 5.0 * (2.0_f64 / 240_000.0).sqrt(), "{ratio}");
    assert_eq!(samples, made(3).1);
    assert_ne!(samples, made(4).1);
}
