//! Rotors of a vehicle whose mass, diameter and number of rotors are known: there the evidence of all orders decides the octave.
use crate::discovery::find;
use crate::testkit::{SAMPLE_RATE_HZ, analyse, config, hears_nothing, rotor, sound, tone, unlike_blades};
use hovertone::speed::{Config, NoTone, OtherRotor, Outcome, SpeedAnalysis, Warning};
use hovertone::tones::KnownRotor;
use hovertone::vehicle::RotorSpeed;
use std::f64::consts::TAU;

const SPEED_REV_S: f64 = 86.0;
const LENGTH_S: f64 = 5.0;

/// A quadrotor of 1.3 kg whose propellers have the thrust coefficient `thrust_coefficient` in hover at 86 rev/s.
fn known(thrust_coefficient: f64) -> Config {
    let (mass_kg, rotor_count) = (1.3, 4);
    let thrust_n = mass_kg * 9.806_65 / f64::from(rotor_count);
    let diameter_m = (thrust_n / (1.2 * SPEED_REV_S.powi(2) * thrust_coefficient)).powf(0.25);
    Config {
        known: KnownRotor {
            diameter_m: Some(diameter_m),
            mass_kg: Some(mass_kg),
            rotor_count: Some(rotor_count),
            ..KnownRotor::default()
        },
        all_methods: false,
        ..config(2.0)
    }
}

/// A speed that wanders by a percent, as in flight.
fn wandering(time_s: f64) -> f64 {
    SPEED_REV_S * (1.0 + 0.01 * (TAU * 0.3 * time_s).sin())
}

fn flight(lines: &[(f64, f64)], seed: u64) -> Vec<f32> {
    sound(&[rotor(wandering, lines)], LENGTH_S, 0.01, seed)
}

#[test]
fn a_second_harmonic_that_is_louder_than_the_first_is_no_octave() {
    let blade_pass = [0.01, 0.05, 0.03, 0.025, 0.02, 0.015];
    let alike: Vec<(f64, f64)> = (1..).map(|k| 2.0 * f64::from(k)).zip(blade_pass).collect();
    for seed in 0..4 {
        for lines in [&unlike_blades(&blade_pass), &alike] {
            let analysis = analyse(flight(lines, seed), &known(0.1));
            let found = tone(&analysis);
            let speed_rev_s = found.speeds[0].speed.rev_s();
            assert!((speed_rev_s / SPEED_REV_S - 1.0).abs() < 0.01, "{speed_rev_s}");
            // without shaft lines, the levels are those of a rotor at twice the speed: the thrust outweighs them, but not by 99 to 1
            let belief = found.alternatives.first().map_or(1.0, |first| first.plausibility);
            assert!(if lines == &alike { belief > 0.9 } else { belief == 1.0 }, "{:?}", found.alternatives);
        }
    }
}

#[test]
fn an_octave_on_which_levels_and_thrust_disagree_is_left_open() {
    // every other line of the blade pass is weak, as behind an echo, or as the shaft lines of a rotor at twice the speed
    let levels = [0.004, 0.04, 0.004, 0.03, 0.003, 0.02, 0.003, 0.015, 0.002, 0.01];
    let lines: Vec<(f64, f64)> = (1..).map(|k| 2.0 * f64::from(k)).zip(levels).collect();
    let analysis = analyse(flight(&lines, 1), &known(0.14));
    let found = tone(&analysis);
    let speeds_rev_s: Vec<f64> = found.alternatives.iter().map(|reading| reading.speed.rev_s()).collect();
    assert!(speeds_rev_s.iter().any(|speed| (speed / SPEED_REV_S - 1.0).abs() < 0.02), "{speeds_rev_s:?}");
    assert!(speeds_rev_s.iter().any(|speed| (speed / SPEED_REV_S - 2.0).abs() < 0.04), "{speeds_rev_s:?}");
    let beliefs: f64 = found.alternatives.iter().map(|reading| reading.plausibility).sum();
    assert!((0.97..=1.0 + 1e-9).contains(&beliefs), "{beliefs}");
}

#[test]
fn a_blade_pass_with_many_harmonics_is_no_faster_rotor() {
    // thirty harmonics as loud, and an echo: twice the speed has more of the lines that vote, and jumps to it are no tune
    let flat: Vec<(f64, f64)> = (1..=30).map(|k| (2.0 * f64::from(k), if k % 2 == 0 { 0.02 } else { 0.012 })).collect();
    for seed in 0..4 {
        let analysis = analyse(flight(&flat, seed), &known(0.11));
        let speed_rev_s = tone(&analysis).speeds[0].speed.rev_s();
        assert!((speed_rev_s / SPEED_REV_S - 1.0).abs() < 0.01, "{seed}: {speed_rev_s}");
    }
}

#[test]
fn a_slow_rotor_is_not_told_at_twice_its_speed() {
    // 26 rev/s: its lines lie too close to prove a rotor, and yet the evidence tells which speed
    let slow = |time_s: f64| 26.0 / SPEED_REV_S * wandering(time_s);
    let lines: Vec<(f64, f64)> = (1..=40).map(|k| (2.0 * f64::from(k), 0.02)).collect();
    let diameter_m = 0.43;
    let thrust_n = 0.11 * 1.2 * 26.0_f64.powi(2) * f64::powi(diameter_m, 4);
    let known = KnownRotor {
        diameter_m: Some(diameter_m),
        mass_kg: Some(4.0 * thrust_n / 9.806_65),
        rotor_count: Some(4),
        ..KnownRotor::default()
    };
    for seed in 0..4 {
        let config = Config { known, all_methods: false, ..config(2.0) };
        let analysis = analyse(sound(&[rotor(slow, &lines)], LENGTH_S, 0.01, seed), &config);
        if let Outcome::Ok(found) = &analysis.outcome {
            let speed_rev_s = found.speeds[0].speed.rev_s();
            assert!((speed_rev_s / 26.0 - 1.0).abs() < 0.02, "{seed}: {speed_rev_s}");
        }
    }
}

/// The rotor that is heard and that the settings leave out, where one is said.
fn left_out(analysis: &SpeedAnalysis) -> Option<OtherRotor> {
    match &analysis.outcome {
        Outcome::NoRotorTone { reason: NoTone::NoSeries { instead, .. } } => *instead,
        _ => analysis.warnings.iter().find_map(|it| if let Warning::FitsElsewhere(it) = it { Some(*it) } else { None }),
    }
}

#[test]
fn a_rotor_that_the_settings_leave_out_is_said() {
    let lines = unlike_blades(&[0.05, 0.04, 0.03, 0.025, 0.02, 0.015]);
    let with = |blades: f64, change: fn(&mut Config)| {
        let mut config = Config { all_methods: false, ..config(blades) };
        change(&mut config);
        config
    };
    let other_blades = with(3.0, |_| ());
    let of_other_vehicle = with(2.0, |config| {
        config.tone.speed_min = RotorSpeed::from_rev_s(200.0);
        config.tone.speed_max = RotorSpeed::from_rev_s(400.0);
    });
    let in_other_band = with(2.0, |config| config.tone.band_hz = Some((400.0, 500.0)));
    for seed in 0..4 {
        assert_eq!(left_out(&analyse(flight(&lines, seed), &with(2.0, |_| ()))), None, "{seed}");
        for (index, wrong) in [&other_blades, &of_other_vehicle, &in_other_band].into_iter().enumerate() {
            let other = left_out(&analyse(flight(&lines, seed), wrong));
            let other = other.unwrap_or_else(|| panic!("{seed}, {index}: nothing is said"));
            assert_eq!(other.blades, 2, "{seed}, {index}");
            assert!((other.speed_rev_s / SPEED_REV_S - 1.0).abs() < 0.01, "{seed}, {index}: {}", other.speed_rev_s);
            let of_noise = left_out(&analyse(sound(&[], LENGTH_S, 0.05, seed), wrong));
            assert_eq!(of_noise, None, "{seed}, {index}");
        }
    }
}

/// Blades that are alike leave the lines of the blade pass alone, as fewer blades at a higher speed do: such lines contradict no number of blades.
#[test]
fn three_or_four_blades_that_are_alike_are_not_contradicted() {
    for blades in [3.0, 4.0] {
        let lines: Vec<(f64, f64)> = (1..=8).map(|k| (blades * f64::from(k), 0.05 * 0.75f64.powi(k))).collect();
        for seed in 0..4 {
            let analysis = analyse(flight(&lines, seed), &Config { all_methods: false, ..config(blades) });
            let speed_rev_s = tone(&analysis).speeds[0].speed.rev_s();
            assert!((speed_rev_s / SPEED_REV_S - 1.0).abs() < 0.01, "{blades}, {seed}: {speed_rev_s}");
            assert_eq!(left_out(&analysis), None, "{blades}, {seed}");
        }
    }
}

#[test]
fn noise_holds_no_rotor_whatever_is_known() {
    for seed in 0..8 {
        let analysis = analyse(sound(&[], LENGTH_S, 0.05, seed), &known(0.1));
        assert!(hears_nothing(&analysis), "{seed}: {:?}", matches!(analysis.outcome, Outcome::Ok(_)));
    }
}

#[test]
fn a_list_of_tones_says_the_same_of_a_wrong_number_of_blades_as_the_speed() {
    let lines = unlike_blades(&[0.05, 0.04, 0.03, 0.025, 0.02, 0.015]);
    let wrong = Config { all_methods: false, ..config(3.0) };
    for seed in 0..4 {
        let listed = |blades: u32| {
            let known = KnownRotor { blade_count: Some(blades), ..KnownRotor::default() };
            left_out(&find(flight(&lines, seed), SAMPLE_RATE_HZ, known).analysis)
        };
        assert_eq!(listed(2), None, "{seed}");
        let of_speed = left_out(&analyse(flight(&lines, seed), &wrong)).expect("another rotor, for `speed`");
        let of_list = listed(3).unwrap_or_else(|| panic!("{seed}: nothing is said"));
        assert_eq!(of_list.blades, of_speed.blades, "{seed}");
        assert!((of_list.speed_rev_s / of_speed.speed_rev_s - 1.0).abs() < 0.01, "{seed}: {of_list:?} {of_speed:?}");
    }
}
