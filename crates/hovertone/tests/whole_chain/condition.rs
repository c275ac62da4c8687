//! What the lines of rotors say of their state, with the truth known.

use crate::testkit::{SAMPLE_RATE_HZ, analyse, rotor, sound, tone};
use hovertone::rotors::{RotorCondition, condition_of_one_rotor, conditions_from_analysis};
use hovertone::sound::{Passes, Signal};
use hovertone::speed::{Config, Method, ToneConfig};
use hovertone_vehicle::Order;

const LENGTH_S: f64 = 9.0;
const NOISE_STD: f64 = 0.05;
/// Amplitudes of the lines of a sound rotor of two blades; those of the shaft but for the blade pass are weak.
const HEALTHY: [(f64, f64); 8] =
    [(1.0, 0.002), (2.0, 0.1), (4.0, 0.07), (6.0, 0.05), (8.0, 0.04), (10.0, 0.04), (12.0, 0.03), (14.0, 0.03)];

fn with(changes: &[(f64, f64)]) -> Vec<(f64, f64)> {
    let mut lines: Vec<(f64, f64)> =
        HEALTHY.into_iter().filter(|(order, _)| changes.iter().all(|(changed, _)| changed != order)).collect();
    lines.extend(changes);
    lines
}

fn conditions(means_rev_s: [f64; 3], lines: [Vec<(f64, f64)>; 3]) -> Vec<RotorCondition> {
    // fastest first, each with a swing of its own
    let [fastest, middle, slowest] = means_rev_s;
    let first = |time_s: f64| fastest + 0.2 * (1.3 * time_s).sin();
    let second = |time_s: f64| middle + 0.15 * (0.9 * time_s).cos();
    let third = |time_s: f64| slowest + 0.1 * (1.7 * time_s).sin();
    let speeds: [&dyn Fn(f64) -> f64; 3] = [&first, &second, &third];
    let rotors: Vec<_> = speeds.iter().zip(&lines).map(|(&speed_rev_s, lines)| rotor(speed_rev_s, lines)).collect();
    let mut config = Config::for_tone(ToneConfig::of_order(Order::from_blades(2).unwrap()));
    (config.rotors.count, config.method) = (3, Method::Separated);
    let sound = sound(&rotors, LENGTH_S, NOISE_STD, 5);
    let analysis = analyse(sound.clone(), &config);
    assert_eq!(tone(&analysis).rotors.len(), 3);
    let (mut source, on_progress) = (Signal::new(sound, SAMPLE_RATE_HZ), &mut |_| {});
    let mut passes = Passes::planned(&mut source, 1, on_progress).unwrap();
    let conditions = conditions_from_analysis(&mut passes, &analysis, &config.tone).unwrap();
    conditions.into_iter().map(Option::unwrap).collect()
}

/// Levels to within three standard uncertainties, and half a decibel for what the track's own error smears.
#[test]
fn an_unbalanced_rotor_shows_once_per_turn_and_unlike_blades_between() {
    let heard = conditions([71.8, 70.1, 68.7], [with(&[(1.0, 0.012)]), with(&[(3.0, 0.008)]), with(&[])]);
    let db = |amplitude: f64| 20.0 * (amplitude / 0.1).log10();
    let line = |rotor: usize, order: u32| heard[rotor].lines.iter().find(|line| line.order == order).copied().unwrap();
    for (rotor, order, amplitude) in [(0, 1, 0.012), (1, 3, 0.008), (0, 4, 0.07), (2, 6, 0.05)] {
        let line = line(rotor, order);
        let tolerance_db = 3.0 * line.std_uncertainty_db.unwrap() + 0.5;
        let level_db = line.level_db.unwrap();
        assert!((level_db - db(amplitude)).abs() < tolerance_db, "{rotor} {order}: {level_db} {}", db(amplitude));
        assert!(tolerance_db < 3.0, "{line:?}");
    }
    assert_eq!(heard[0].shaft_over_blade_pass_db(), line(0, 1).level_db);
    assert_eq!(heard[1].loudest_between().map(|line| line.order), Some(3));
    // the others' weak ones are far below
    for rotor in [1, 2] {
        assert!(heard[rotor].shaft_over_blade_pass_db().is_none_or(|level_db| level_db < -20.0), "{:?}", heard[rotor]);
    }
    assert!(heard.iter().all(|rotor| rotor.missing_harmonics.is_empty()), "{heard:?}");
    assert!(heard[0].loudest_between().is_none() && heard[2].loudest_between().is_none(), "{heard:?}");
}

/// The same of the only rotor of a bench, along the track of its tone.
#[test]
fn an_unbalanced_rotor_shows_on_a_bench() {
    let speed_rev_s = |time_s: f64| 71.8 + 0.2 * (1.3 * time_s).sin();
    let sound = sound(&[rotor(speed_rev_s, &with(&[(1.0, 0.012), (3.0, 0.008)]))], LENGTH_S, NOISE_STD, 6);
    let config = Config::for_tone(ToneConfig::of_order(Order::from_blades(2).unwrap()));
    let analysis = analyse(sound.clone(), &config);
    let (mut source, on_progress) = (Signal::new(sound, SAMPLE_RATE_HZ), &mut |_| {});
    let mut passes = Passes::planned(&mut source, 1, on_progress).unwrap();
    let heard = condition_of_one_rotor(&mut passes, &analysis, &config.tone).unwrap().unwrap();
    for (order, amplitude) in [(1, 0.012), (3, 0.008), (4, 0.07), (6, 0.05), (8, 0.04)] {
        let line = heard.lines.iter().find(|line| line.order == order).copied().unwrap();
        let (level_db, expected_db) = (line.level_db.unwrap(), 20.0 * (amplitude / 0.1_f64).log10());
        let tolerance_db = 3.0 * line.std_uncertainty_db.unwrap() + 0.5;
        assert!((level_db - expected_db).abs() < tolerance_db, "{order}: {level_db} {expected_db}");
    }
    assert_eq!(heard.loudest_between().map(|line| line.order), Some(3));
    assert!(heard.missing_harmonics.is_empty());
}

#[test]
fn a_harmonic_that_one_rotor_lacks_is_named() {
    let heard = conditions([74.0, 70.5, 67.0], [with(&[]), with(&[(4.0, 0.0)]), with(&[])]);
    assert_eq!(heard[1].missing_harmonics, [2]);
    assert!([0, 2].iter().all(|&rotor| heard[rotor].missing_harmonics.is_empty()), "{heard:?}");
}
