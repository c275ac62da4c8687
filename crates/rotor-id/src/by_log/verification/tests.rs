//! Tracks against logs: offsets, motors, wrong orders and clocks.

use super::*;
use hovertone_analysis::Agreement;

fn speed_rev_s(motor: usize, time_s: f64) -> f64 {
    let phase = motor as f64;
    80.0 + 1.5 * phase + 2.0 * (0.9 * time_s + phase).sin() + 1.2 * (0.23 * time_s - phase).cos()
}

fn track(motor: usize, factor: f64) -> Vec<TrackPoint> {
    let point = |at: usize| {
        let time_s = 1.0 + 0.04 * at as f64;
        let error = 0.05 * ((at * 7919 % 100) as f64 / 50.0 - 1.0) * 3f64.sqrt();
        let speed_rev_s = factor * (speed_rev_s(motor, time_s) + error);
        TrackPoint { time_s, tone_hz: 2.0 * speed_rev_s, speed_rev_s, std_uncertainty_rev_s: 0.05, level_db: -30.0 }
    };
    (0..2000).map(point).collect()
}

fn verified(factor: f64, rate: f64) -> Verification {
    let time_s: Vec<f64> = (0..1000).map(|row| 40.0 + 0.1 * f64::from(row)).collect();
    // the log's clock is 37.3 s ahead and runs faster by `rate`
    let of_recording = |row_s: f64| (row_s - 37.3) / (1.0 + rate);
    let speeds_rev_s: Vec<Vec<f64>> =
        (0..4).map(|motor| time_s.iter().map(|&row_s| speed_rev_s(motor, of_recording(row_s))).collect()).collect();
    let names: Vec<String> = (1..=4).map(|motor| format!("motor {motor}")).collect();
    let tracks = [track(2, factor), track(0, factor), track(3, factor), track(1, factor)];
    let tracks: Vec<&[TrackPoint]> = tracks.iter().map(Vec::as_slice).collect();
    verification_from_log(&tracks, LoggedSpeeds { time_s: &time_s, names: &names, speeds_rev_s: &speeds_rev_s }, None)
        .unwrap()
}

#[test]
fn offset_motors_and_coverage_are_found() {
    let found = verified(1.0, 0.0);
    assert!((found.offset_s + 37.3).abs() < 0.01 && found.is_offset_told && found.passes(), "{found:?}");
    assert_eq!(found.rotors.iter().map(|rotor| rotor.motor).collect::<Vec<_>>(), [2, 0, 3, 1]);
    for rotor in &found.rotors {
        assert!(rotor.bias_rev_s.abs() < 0.01 && (rotor.scatter_rev_s - 0.05).abs() < 0.02, "{rotor:?}");
        assert!(rotor.coverage > 0.9, "{rotor:?}");
    }
    assert!(found.clock_rate_share.unwrap().abs() < 3e-4);
}

/// A group is the mean of all rotors: a motor that turns as the tone, 1 % too fast, is no match for it.
#[test]
fn a_group_is_compared_with_the_mean_alone() {
    let mean_rev_s = |time_s: f64| (0..4).map(|motor| speed_rev_s(motor, time_s)).sum::<f64>() / 4.0;
    let tone = |factor: f64| -> Vec<TrackPoint> {
        let of_mean = |point: TrackPoint| TrackPoint { speed_rev_s: factor * mean_rev_s(point.time_s), ..point };
        track(0, 1.0).into_iter().map(of_mean).collect()
    };
    let time_s: Vec<f64> = (0..900).map(|row| 0.1 * f64::from(row)).collect();
    let of_motor = |motor: usize| time_s.iter().map(|&row_s| speed_rev_s(motor, row_s)).collect();
    // the fourth motor turns as a tone that is 1 % too fast
    let fast = time_s.iter().map(|&row_s| 1.01 * mean_rev_s(row_s)).collect();
    let speeds_rev_s: Vec<Vec<f64>> = (0..3).map(of_motor).chain([fast]).collect();
    let names: Vec<String> = (1..=4).map(|motor| format!("motor {motor}")).collect();
    let log = LoggedSpeeds { time_s: &time_s, names: &names, speeds_rev_s: &speeds_rev_s };
    let of_group = verification_of_group(&tone(1.01), log, None).unwrap();
    assert!(!of_group.is_right() && of_group.rotors[0].name == MEAN_OF_MOTORS, "{of_group:?}");
    let of_one_tone = verification_from_log(&[&tone(1.01)], log, None).unwrap();
    assert!(of_one_tone.is_right() && of_one_tone.rotors[0].name == "motor 4", "{of_one_tone:?}");
}

/// A log of a climb that the recording does not have: the offset that leaves the climb out fits best, and tells nothing.
#[test]
fn a_steady_recording_has_no_offset() {
    let steady: Vec<TrackPoint> =
        track(0, 1.0).into_iter().map(|point| TrackPoint { speed_rev_s: 80.0, ..point }).collect();
    let time_s: Vec<f64> = (0..800).map(|row| 0.1 * f64::from(row)).collect();
    let climb = |time_s: &f64| if (30.0..33.0).contains(time_s) { 84.0 } else { 80.0 };
    let speeds_rev_s = [time_s.iter().map(climb).collect()];
    let names = ["motor 1".to_owned()];
    let log = LoggedSpeeds { time_s: &time_s, names: &names, speeds_rev_s: &speeds_rev_s };
    assert!(!verification_from_log(&[&steady], log, None).unwrap().is_offset_told);
}

/// The right offset lies outside of the limits: the offset that is used lies within them.
#[test]
fn an_offset_stays_within_its_limits() {
    let time_s: Vec<f64> = (0..1000).map(|row| 0.1 * f64::from(row)).collect();
    let speeds_rev_s = [time_s.iter().map(|&row_s| speed_rev_s(0, row_s)).collect()];
    let names = ["motor 1".to_owned()];
    let log = LoggedSpeeds { time_s: &time_s, names: &names, speeds_rev_s: &speeds_rev_s };
    for [low_s, high_s] in [[0.02, 5.0], [-5.0, -0.02]] {
        let found = verification_from_log(&[&track(0, 1.0)], log, Some([low_s, high_s])).unwrap();
        assert!((low_s..=high_s).contains(&found.offset_s), "{}", found.offset_s);
    }
}

/// The limits leave the right offset out by 0.09 s: equal means do not pass, and the better offset is named.
#[test]
fn an_offset_that_is_forced_to_be_wrong_does_not_pass() {
    let time_s: Vec<f64> = (0..1000).map(|row| 0.1 * f64::from(row)).collect();
    let speeds_rev_s = [time_s.iter().map(|&row_s| speed_rev_s(0, row_s)).collect()];
    let names = ["motor 1".to_owned()];
    let log = LoggedSpeeds { time_s: &time_s, names: &names, speeds_rev_s: &speeds_rev_s };
    let found = verification_from_log(&[&track(0, 1.0)], log, Some([0.09, 0.5])).unwrap();
    assert!(found.is_right() && !found.passes(), "{found:?}");
    assert!(found.better_offset_s.unwrap() < 0.05, "{:?}", found.better_offset_s);
    // limits that hold the right offset
    let found = verification_from_log(&[&track(0, 1.0)], log, Some([-0.5, 0.5])).unwrap();
    assert!(found.passes() && found.better_offset_s.is_none(), "{found:?}");
}

/// Another flight of the same vehicle: the means are equal, and the points are not.
#[test]
fn a_log_of_another_flight_with_the_same_mean_does_not_pass() {
    let time_s: Vec<f64> = (0..800).map(|row| 0.1 * f64::from(row)).collect();
    let other = |time_s: &f64| 80.0 + 2.0 * (0.7 * time_s).cos() + 1.2 * (1.9 * time_s).sin();
    let speeds_rev_s = [time_s.iter().map(other).collect()];
    let names = ["motor 1".to_owned()];
    let log = LoggedSpeeds { time_s: &time_s, names: &names, speeds_rev_s: &speeds_rev_s };
    let found = verification_from_log(&[&track(0, 1.0)], log, None).unwrap();
    assert!(found.is_right() && found.coverage() < 0.3, "{} {}", found.speed_ratio, found.coverage());
    assert_eq!((found.agreement, found.passes()), (Agreement::Scattered, false));
}

/// Nothing shows an offset at a limit: the log may be of another flight, though most points agree.
#[test]
fn an_offset_at_its_limit_does_not_pass() {
    let heard = |offset_at_limit: bool| Verification {
        is_offset_told: false,
        is_offset_given: true,
        is_offset_at_limit: offset_at_limit,
        better_offset_s: None,
        agreement: Agreement::PlusMinusTooSmall,
        ..verified(1.0, 0.0)
    };
    assert!(heard(false).passes() && !heard(true).passes());
}

/// A log that never changes: the offset at which it covers the calm part of the recording fits best, and tells nothing.
#[test]
fn a_steady_log_has_no_offset() {
    let time_s: Vec<f64> = (0..600).map(|row| 0.1 * f64::from(row)).collect();
    let speeds_rev_s = [vec![80.0; 600]];
    let names = ["motor 1".to_owned()];
    let log = LoggedSpeeds { time_s: &time_s, names: &names, speeds_rev_s: &speeds_rev_s };
    let calm = |point: TrackPoint| TrackPoint {
        speed_rev_s: if point.time_s > 30.0 { 80.0 + 0.1 * (point.speed_rev_s - 80.0) } else { point.speed_rev_s },
        ..point
    };
    let heard: Vec<TrackPoint> = track(0, 1.0).into_iter().map(calm).collect();
    assert!(!verification_from_log(&[&heard], log, None).unwrap().is_offset_told);
}

#[test]
fn a_wrong_order_and_a_wrong_clock_are_told() {
    let half = verified(0.5, 0.0);
    assert!(!half.is_right() && half.near_ratio == Some(0.5) && (half.offset_s + 37.3).abs() < 0.01, "{half:?}");
    let clock = verified(1.01, 0.0);
    assert!(!clock.is_right() && (clock.speed_ratio - 1.01).abs() < 1e-3, "{clock:?}");
    let rate = verified(1.0, 1e-3).clock_rate_share.unwrap();
    assert!((rate + 1e-3).abs() < 3e-4, "{rate}");
}

/// The log ends before the second half of the recording, or one rotor is heard in the first half alone.
#[test]
fn one_half_tells_no_drift_of_the_clocks() {
    let rows_s = |count: u32| -> Vec<f64> { (0..count).map(|row| 0.1 * f64::from(row)).collect() };
    let names = ["motor 1".to_owned(), "motor 2".to_owned()];
    let (first, second) = (track(0, 1.0), track(1, 1.0));
    let drift = |tracks: &[&[TrackPoint]], rows: u32| {
        let time_s = rows_s(rows);
        let of_motor = |motor: usize| time_s.iter().map(|&row_s| speed_rev_s(motor, row_s)).collect();
        let speeds_rev_s: Vec<Vec<f64>> = (0..2).map(of_motor).collect();
        let log = LoggedSpeeds { time_s: &time_s, names: &names, speeds_rev_s: &speeds_rev_s };
        let found = verification_from_log(tracks, log, None).unwrap();
        assert!(found.offset_s.abs() < 0.01, "{}", found.offset_s);
        found.clock_rate_share
    };
    assert!(drift(&[&first, &second], 1000).is_some_and(|share| share.abs() < 3e-4));
    assert_eq!(drift(&[&first, &second], 360), None);
    assert_eq!(drift(&[&first, &second[..900]], 1000), None);
}

#[test]
fn nothing_to_compare_has_a_reason() {
    let names = ["motor 1".to_owned()];
    let speeds = [vec![80.0; 3]];
    let log = LoggedSpeeds { time_s: &[0.0, 0.1, 0.2], names: &names, speeds_rev_s: &speeds };
    let one = track(0, 1.0);
    assert_eq!(verification_from_log(&[], log, None), Err(NotVerified::NoTrack));
    assert!(matches!(
        verification_from_log(&[&one, &one], log, None),
        Err(NotVerified::TooFewMotors { tracks: 2, motors: 1 })
    ));
    assert_eq!(verification_from_log(&[&one], log, None), Err(NotVerified::NoOverlap));
}
