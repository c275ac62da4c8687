//! Live listening on sound with known truth.

// The lints know tests by their attribute, and what tests share has none.
#![allow(clippy::unwrap_used)]

use hovertone_analysis::{Method, Outcome};
use hovertone_live::{Listener, LiveConfig, LiveSpeed, LiveStatus};
use hovertone_rotor_speed::{Config, ToneConfig, speed_from_source};
use hovertone_signal::Signal;
use hovertone_sim::prescribed::{Line, Noise, Recording, Rotor, Sampling, SineWander, seeded};
use hovertone_vehicle::Order;

const RATE_HZ: f64 = 48_000.0;
const LINES: [(f64, f64); 6] = [(1.0, 0.01), (2.0, 0.1), (4.0, 0.05), (6.0, 0.03), (8.0, 0.02), (10.0, 0.01)];

fn lines() -> Vec<Line> {
    LINES.iter().map(|&(order, level)| Line::new(order, level).with_phase_rad(order)).collect()
}

/// Rotors of two blades in white noise, whose power is less than that of the lines of all by `snr_db`.
fn sound(rotors: &[Rotor<'_>], length_s: f64, snr_db: f64, seed: u64) -> Vec<f32> {
    let power: f64 = rotors.len() as f64 * lines().iter().map(Line::power).sum::<f64>();
    let mut recording = Recording::of_rotors(rotors, Sampling::new(RATE_HZ, length_s));
    recording.add_noise(&Noise::white((power / 10_f64.powf(snr_db / 10.0)).sqrt()), &mut seeded(seed));
    recording.samples_f32()
}

fn analysis() -> Config {
    Config::for_tone(ToneConfig::of_order(Order::from_blades(2).unwrap()))
}

/// Hears all sound in blocks.
fn live_speeds(samples: &[f32], block: usize) -> Vec<LiveSpeed> {
    live_speeds_by(analysis(), samples, block)
}

fn live_speeds_by(analysis: Config, samples: &[f32], block: usize) -> Vec<LiveSpeed> {
    let mut listener = Listener::new(RATE_HZ, LiveConfig::of_analysis(analysis, None)).unwrap();
    let mut speeds = Vec::new();
    for mut rest in samples.chunks(block) {
        while !rest.is_empty() {
            rest = listener.push(rest, &mut |speed| speeds.push(speed));
            if listener.wants_review() {
                listener.review().unwrap();
            }
        }
    }
    speeds
}

fn speed_of(speed: &LiveSpeed) -> f64 {
    assert_eq!(speed.status, LiveStatus::Ok, "{speed:?}");
    speed.speed_rev_s.unwrap()
}

#[test]
fn a_steady_rotor_is_told_to_a_twentieth_of_a_percent_at_10_db() {
    let (mut squares, mut count, mut within) = (0.0, 0.0, 0.0);
    for seed in 0..4 {
        let truth_rev_s = 83.7 + 31.1 * seed as f64;
        let samples = sound(&[Rotor::steady(truth_rev_s, lines())], 8.0, 10.0, seed);
        let speeds = live_speeds(&samples, 4800);
        // the first review is after 2 s
        for speed in speeds.iter().filter(|speed| speed.time_s > 2.15) {
            let error = speed_of(speed) - truth_rev_s;
            squares += (error / truth_rev_s).powi(2);
            within += f64::from(error.abs() <= 2.0 * speed.std_uncertainty_rev_s.unwrap());
            count += 1.0;
        }
    }
    let rms_share = f64::sqrt(squares / count);
    assert!(rms_share < 5e-4, "{rms_share}");
    assert!(within / count > 0.9, "2 u holds in {within} of {count}");
}

#[test]
fn a_step_is_followed_within_three_tenths_of_a_second() {
    for (seed, (before, after)) in
        [(100.0, 110.0), (110.0, 100.0), (61.0, 67.1), (250.0, 225.0)].into_iter().enumerate()
    {
        let step_s = 5.03;
        let rotor = Rotor::new(|time_s| if time_s < step_s { before } else { after }, lines());
        let speeds = live_speeds(&sound(&[rotor], 8.0, 10.0, seed as u64), 4800);
        for speed in speeds.iter().filter(|speed| speed.time_s > 2.15) {
            let truth_rev_s = if speed.time_s < step_s { before } else { after };
            let is_settled = speed.time_s < step_s || speed.time_s > step_s + 0.3;
            let share = speed_of(speed) / truth_rev_s - 1.0;
            assert!(!is_settled || share.abs() < 0.01, "{before} to {after} at {} s: {share}", speed.time_s);
        }
    }
}

/// The even lines of half of the new speed are within the reach of the step.
#[test]
fn a_step_to_nearly_twice_the_speed_is_not_told_as_half_of_it() {
    for (seed, (before, after)) in [(52.9, 91.8), (60.0, 110.0), (110.0, 62.0)].into_iter().enumerate() {
        let step_s = 6.03;
        let rotor = Rotor::new(|time_s| if time_s < step_s { before } else { after }, lines());
        let speeds = live_speeds(&sound(&[rotor], 14.0, 10.0, seed as u64), 4800);
        // a rotor that is lost is heard again once there are two seconds of its new speed
        let is_back = |speed: &LiveSpeed| {
            speed.time_s > step_s && speed.speed_rev_s.is_some_and(|it| (it / after - 1.0).abs() < 0.02)
        };
        let back_s = speeds.iter().find(|speed| is_back(speed)).map(|speed| speed.time_s);
        assert!(back_s.is_some_and(|back_s| back_s < step_s + 3.0), "{before} to {after}: {back_s:?}");
        // in the step, a speed is on its way, and never beyond both
        let between = 0.98 * f64::min(before, after)..1.02 * f64::max(before, after);
        let in_step = speeds.iter().filter(|speed| (step_s..step_s + 0.6).contains(&speed.time_s));
        for speed_rev_s in in_step.filter_map(|speed| speed.speed_rev_s) {
            assert!(between.contains(&speed_rev_s), "{before} to {after}: {speed_rev_s}");
        }
        for speed in speeds.iter().filter(|speed| speed.time_s > step_s + 0.6) {
            let share = speed.speed_rev_s.map_or(0.0, |speed_rev_s| speed_rev_s / after - 1.0);
            assert!(share.abs() < 0.02, "{before} to {after} at {} s: {share}", speed.time_s);
            assert!(speed.time_s < step_s + 6.0 || speed.status == LiveStatus::Ok, "{speed:?}");
        }
    }
}

#[test]
fn where_it_has_settled_it_has_the_numbers_of_the_recording() {
    let wander = SineWander::drawn(0.004, 4, 0.05..1.2, &mut seeded(3));
    let rotor = Rotor::new(|time_s| 90.0 * (1.0 + wander.at(time_s)), lines());
    let samples = sound(&[rotor], 10.0, 20.0, 3);
    let speeds = live_speeds(&samples, 4800);
    let settled: Vec<f64> = speeds.iter().filter(|speed| speed.time_s > 3.0).map(speed_of).collect();
    let live_rev_s = settled.iter().sum::<f64>() / settled.len() as f64;
    // a live speed is that of some tenths of a second before
    let mut config = analysis();
    (config.span.from_s, config.span.to_s) = (Some(2.75), Some(9.75));
    let batch = speed_from_source(&mut Signal::new(samples, RATE_HZ), &config, &mut |_| {}).unwrap();
    let Outcome::Ok(tone) = batch.outcome else { panic!("no rotor") };
    let batch_rev_s = tone.speed(config.method).unwrap().speed.rev_s();
    assert!((live_rev_s / batch_rev_s - 1.0).abs() < 5e-4, "{live_rev_s} {batch_rev_s}");
}

#[test]
fn the_length_of_the_blocks_makes_no_difference() {
    let samples = sound(&[Rotor::steady(120.0, lines())], 4.0, 10.0, 1);
    let whole = live_speeds(&samples, 4800);
    for block in [1152, 7000, 100_000] {
        assert_eq!(live_speeds(&samples, block), whole);
    }
}

#[test]
fn four_rotors_are_their_mean() {
    let speeds = [96.0, 98.5, 101.0, 104.5];
    let rotors: Vec<Rotor<'_>> = speeds.iter().map(|&speed| Rotor::steady(speed, lines())).collect();
    for speed in live_speeds(&sound(&rotors, 9.0, 10.0, 5), 4800).iter().filter(|speed| speed.time_s > 4.1) {
        let share = speed_of(speed) / 100.0 - 1.0;
        assert!(share.abs() < 0.01, "{speed:?}");
    }
}

#[test]
fn rotors_far_apart_are_not_taken_for_their_neighbours() {
    let wanders: Vec<SineWander> =
        (0..4).map(|rotor| SineWander::drawn(0.003, 4, 0.2..1.5, &mut seeded(40 + rotor))).collect();
    let speeds_rev_s = [88.0, 92.0, 97.0, 103.0].into_iter();
    let rotors: Vec<Rotor<'_>> = speeds_rev_s
        .zip(&wanders)
        .map(|(speed, wander)| Rotor::new(move |time_s| speed * (1.0 + wander.at(time_s)), lines()))
        .collect();
    let mut config = analysis();
    (config.rotors.count, config.method) = (4, Method::Separated);
    let speeds = live_speeds_by(config, &sound(&rotors, 10.0, 20.0, 6), 4800);
    let heard: Vec<f64> =
        speeds.iter().filter(|speed| speed.time_s > 4.1).filter_map(|speed| speed.speed_rev_s).collect();
    assert!(heard.len() > 30, "{}", heard.len());
    for speed_rev_s in heard {
        assert!((speed_rev_s / 95.0 - 1.0).abs() < 0.01, "{speed_rev_s}");
    }
}

#[test]
fn a_rotor_that_stops_is_lost_in_half_a_second() {
    let rotor = Rotor::steady(120.0, lines()).with_level(|time_s| if time_s < 4.0 { 1.0 } else { 0.0 });
    let speeds = live_speeds(&sound(&[rotor], 7.0, 10.0, 2), 4800);
    for speed in &speeds {
        match speed.time_s {
            2.15..4.0 => assert!((speed_of(speed) - 120.0).abs() < 0.5),
            4.5.. => assert_eq!((speed.status, speed.speed_rev_s), (LiveStatus::NoRotorTone, None), "{speed:?}"),
            _ => {}
        }
    }
}

#[test]
fn noise_and_silence_are_no_rotor() {
    for level in [0.0, 0.1] {
        let mut recording = Recording::of_rotors(&[], Sampling::new(RATE_HZ, 6.0));
        recording.add_noise(&Noise::white(level), &mut seeded(1));
        let speeds = live_speeds(&recording.samples_f32(), 4800);
        assert_eq!(speeds.len(), 60);
        assert!(speeds.iter().all(|speed| speed.speed_rev_s.is_none()));
        // nothing is said before the first review, after 2 s
        let (before, after): (Vec<&LiveSpeed>, Vec<&LiveSpeed>) = speeds.iter().partition(|speed| speed.time_s < 2.05);
        assert!(before.iter().all(|speed| speed.status == LiveStatus::Listening), "{before:?}");
        assert!(after.iter().all(|speed| speed.status == LiveStatus::NoRotorTone), "{after:?}");
        let expected_db = if level > 0.0 { 10.0 * (2.0 * level * level).log10() } else { -200.0 };
        assert!(speeds.iter().all(|speed| (speed.level_db - expected_db).abs() < 0.3));
    }
}
