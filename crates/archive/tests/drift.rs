//! Changes between two archives, against drawn speeds of known truth.

#![allow(clippy::unwrap_used)]

use hovertone_archive::{Archives, Drift, RotorSummary, Summary, drift_of, drift_text};
use rand::{RngExt, SeedableRng};
use rand_distr::StandardNormal;
use rand_pcg::Pcg64;

const SPEED_REV_S: f64 = 60.0;
/// Standard uncertainty of one recording as a share, clock included.
const STD_SHARE: f64 = 1e-3;
const CLOCK_STD_SHARE: f64 = 3e-5;

/// How the speeds of an archive are drawn.
#[derive(Clone, Copy)]
struct Drawn {
    count: usize,
    /// Change of rotor 2 as a share.
    change_share: f64,
    /// Scatter between flights beyond the reported uncertainty, as a share.
    between_share: f64,
    names: &'static str,
}

fn archive(drawn: Drawn, random: &mut Pcg64) -> Vec<Summary> {
    let own_share = (STD_SHARE * STD_SHARE - CLOCK_STD_SHARE * CLOCK_STD_SHARE).sqrt();
    let clock: f64 = CLOCK_STD_SHARE * random.sample::<f64, _>(StandardNormal);
    let mut rotor = |factor: f64| {
        let error = own_share * random.sample::<f64, _>(StandardNormal);
        let flight = drawn.between_share * random.sample::<f64, _>(StandardNormal);
        let speed_rev_s = SPEED_REV_S * factor * (1.0 + error + flight + clock);
        RotorSummary { speed_rev_s, std_rev_s: Some(STD_SHARE * SPEED_REV_S), spread_rev_s: None, label_number: None }
    };
    let recording = |number: usize| Summary {
        file: format!("{}{number}.wav", drawn.names),
        status: "ok".to_owned(),
        reason: None,
        tone_hz: Some(2.0 * SPEED_REV_S),
        speed: Some(rotor(1.0)),
        clock_std_rev_s: CLOCK_STD_SHARE * SPEED_REV_S,
        rotors: vec![rotor(1.01), rotor(1.0 + drawn.change_share)],
        used_s: Some((0.0, 2.0)),
        warnings: Vec::new(),
        is_doubtful: false,
        is_prefix: false,
    };
    (0..drawn.count).map(recording).collect()
}

fn drift(earlier: Drawn, later: Drawn, seed: u64) -> Drift {
    let mut random = Pcg64::seed_from_u64(seed);
    let (earlier, later) = (archive(earlier, &mut random), archive(later, &mut random));
    drift_of(Archives { earlier: &earlier, later: &later })
}

const STILL: Drawn = Drawn { count: 10, change_share: 0.0, between_share: 0.0, names: "" };

/// Share of 400 comparisons in which anything is said to have changed.
fn false_alarm_share(earlier: Drawn, later: Drawn, of: fn(&Drift) -> bool) -> f64 {
    (0..400).filter(|seed| of(&drift(earlier, later, *seed))).count() as f64 / 400.0
}

fn a_rotor_has_changed(drift: &Drift) -> bool {
    drift.rotors.iter().any(|row| row.change.has_changed)
}

/// 5 % are allowed; 400 draws of 5 % stay below 7.5 % in 98.9 % of all cases.
#[test]
fn rotors_that_did_not_change_are_said_to_in_one_of_twenty_comparisons_at_most() {
    let scattered = Drawn { between_share: 4e-3, ..STILL };
    let other_names = Drawn { names: "later ", count: 7, ..STILL };
    for (name, earlier, later) in [
        ("pairs", STILL, STILL),
        ("pairs that scatter more than reported", scattered, scattered),
        ("groups", STILL, other_names),
        ("groups that scatter", scattered, Drawn { between_share: 4e-3, ..other_names }),
    ] {
        let share = false_alarm_share(earlier, later, a_rotor_has_changed);
        assert!(share <= 0.075, "{name}: {share}");
    }
}

#[test]
fn single_recordings_that_did_not_change_are_said_to_in_one_of_twenty_archives_at_most() {
    let share = false_alarm_share(STILL, STILL, |drift| drift.recordings.iter().any(|row| row.change.has_changed));
    assert!(share > 0.005 && share <= 0.075, "{share}");
}

#[test]
fn the_rotor_that_changed_is_named_and_no_other() {
    for (is_paired, names) in [(true, ""), (false, "later ")] {
        let changed = Drawn { change_share: 4e-3, names, ..STILL };
        let (mut named, mut others) = (0, 0);
        for seed in 0..100 {
            let drift = drift(STILL, changed, seed);
            assert_eq!(drift.is_paired, is_paired);
            let row = &drift.rotors[2];
            named += usize::from(row.change.has_changed);
            others += drift.rotors[..2].iter().filter(|row| row.change.has_changed).count();
            assert!((row.change.change_share - 4e-3).abs() < 5.0 * row.change.std_uncertainty_share);
        }
        // the mean of ten is known to 0.045 %
        assert!(named >= 99 && others <= 10, "{named} times rotor 2, {others} times another");
    }
}

/// With many recordings the clock is what remains: a change by the clock alone is no change of the rotors.
#[test]
fn a_clock_that_differs_is_no_drift_however_many_recordings_there_are() {
    let many = Drawn { count: 2000, ..STILL };
    let said = (0..40).filter(|seed| a_rotor_has_changed(&drift(many, many, *seed))).count();
    assert!(said <= 5, "{said} of 40");
}

#[test]
fn nothing_is_compared_with_nothing() {
    let drift = drift_of(Archives { earlier: &[], later: &[] });
    assert!(drift.rotors.is_empty() && drift.recordings.is_empty() && !drift.is_paired);
    let mut random = Pcg64::seed_from_u64(1);
    let mut silent = archive(STILL, &mut random);
    for summary in &mut silent {
        summary.speed = None;
        summary.rotors.clear();
    }
    let sounding = archive(STILL, &mut random);
    let drift = drift_of(Archives { earlier: &silent, later: &sounding });
    let files: Vec<&str> = drift.earlier_unused.iter().map(|unused| unused.file.as_str()).collect();
    assert_eq!((drift.rotors.len(), files), (0, silent.iter().map(|summary| summary.file.as_str()).collect()));
    assert!(drift.earlier_unused.iter().all(|unused| !unused.has_speed) && silent.len() == 10);
}

/// The speeds of rotors with their labels, each with an error of 0.1 % in each recording.
fn of_speeds(names: &'static str, count: u64, seed: u64, rotors: &[(f64, Option<usize>)]) -> Vec<Summary> {
    let mut random = Pcg64::seed_from_u64(seed);
    let template = archive(Drawn { names, count: count as usize, ..STILL }, &mut random);
    let with_rotors = |summary: Summary| {
        let drawn = |(speed_rev_s, label_number): &(f64, Option<usize>)| RotorSummary {
            speed_rev_s: speed_rev_s * (1.0 + STD_SHARE * random.sample::<f64, _>(StandardNormal)),
            std_rev_s: Some(STD_SHARE * speed_rev_s),
            spread_rev_s: None,
            label_number: *label_number,
        };
        let mut rotors: Vec<RotorSummary> = rotors.iter().map(drawn).collect();
        rotors.sort_by(|one, other| other.speed_rev_s.total_cmp(&one.speed_rev_s));
        let speed_rev_s = rotors.iter().map(|rotor| rotor.speed_rev_s).sum::<f64>() / rotors.len() as f64;
        Summary { speed: Some(RotorSummary { speed_rev_s, ..rotors[0] }), rotors, ..summary }
    };
    template.into_iter().map(with_rotors).collect()
}

/// The rotor at 66.1 rev/s slows down to 57.3 rev/s, and the other one stays at 61.3 rev/s. A rotor that did not change is said to in one of twenty
/// comparisons at most.
#[test]
fn a_rotor_that_did_not_change_is_not_blamed_where_the_ranks_cross() {
    const SEEDS: u64 = 400;
    for (name, count, is_paired) in [("", 10, true), ("", 1, true), ("later ", 10, false)] {
        let (mut blamed, mut blamed_in_recordings) = (0, 0);
        for seed in 0..SEEDS {
            let earlier = of_speeds("", count, 2 * seed, &[(61.3, None), (66.1, None)]);
            let later = of_speeds(name, count, 2 * seed + 1, &[(61.3, None), (57.3, None)]);
            let drift = drift_of(Archives { earlier: &earlier, later: &later });
            assert_eq!((drift.is_paired, drift.is_labelled, drift.rotors.len()), (is_paired, false, 3));
            assert!(drift.rotors[0].change.has_changed && drift.rotors[0].change.is_rotor_known, "the mean of all");
            let is_blamed = drift.rotors[1..].iter().any(|row| row.change.has_changed);
            blamed += u64::from(is_blamed);
            let of_recordings = drift.recordings.iter().any(|row| row.rotor > 0 && row.change.has_changed);
            blamed_in_recordings += u64::from(of_recordings);
            let told = drift_text(&drift, None);
            assert!(is_blamed || told.contains("cannot tell which rotor"), "{told}");
        }
        // 400 draws of 5 % stay below 7.5 % in 98.9 % of all cases
        for blamed in [blamed, blamed_in_recordings] {
            assert!(blamed as f64 <= 0.075 * SEEDS as f64, "{count} recordings {name:?}: {blamed}");
        }
        println!("{count} recordings {name:?}: {blamed} and {blamed_in_recordings} of {SEEDS} blamed");
    }
}

#[test]
fn a_rotor_that_changed_by_less_than_the_distance_to_the_next_one_is_named() {
    for (name, is_paired) in [("", true), ("later ", false)] {
        let earlier = of_speeds("", 10, 1, &[(61.3, None), (66.1, None)]);
        let later = of_speeds(name, 10, 2, &[(61.3, None), (64.0, None)]);
        let drift = drift_of(Archives { earlier: &earlier, later: &later });
        assert_eq!(drift.is_paired, is_paired);
        let verdicts: Vec<_> =
            drift.rotors.iter().map(|row| (row.change.is_rotor_known, row.change.has_changed)).collect();
        assert_eq!(verdicts, [(true, true), (true, true), (true, false)]);
        let told = drift_text(&drift, None);
        assert!(!told.contains("cannot tell"), "{told}");
        assert!(!told.contains("not compared: 0 recordings"), "{told}");
    }
}

/// Where the ranks cross in some of the recordings alone, the mean by rank is of both rotors.
#[test]
fn ranks_that_cross_in_some_recordings_blame_no_other_rotor() {
    let earlier = of_speeds("", 20, 1, &[(61.3, None), (66.1, None)]);
    let mut later = of_speeds("", 20, 2, &[(61.3, None), (57.3, None)]);
    let near = of_speeds("", 20, 3, &[(61.3, None), (65.0, None)]);
    later[10..].clone_from_slice(&near[10..]);
    let drift = drift_of(Archives { earlier: &earlier, later: &later });
    assert!(drift.rotors[0].change.has_changed);
    assert!(!drift.rotors[2].change.has_changed, "{:?}", drift.rotors[2]);
}

/// Flights scatter by more than their reported uncertainties: then all of them together show that the ranks may have crossed.
#[test]
fn flights_that_scatter_blame_no_other_rotor_in_a_single_recording() {
    let mut earlier = of_speeds("", 10, 1, &[(61.3, None), (66.1, None)]);
    let later = of_speeds("", 10, 2, &[(61.3, None), (57.3, None)]);
    for (number, summary) in earlier.iter_mut().enumerate() {
        let factor = if number % 2 == 0 { 1.008 } else { 0.992 };
        summary.rotors.iter_mut().for_each(|rotor| rotor.speed_rev_s *= factor);
    }
    let drift = drift_of(Archives { earlier: &earlier, later: &later });
    let of_rotors: Vec<_> = drift.recordings.iter().filter(|row| row.rotor > 0).collect();
    assert_eq!(of_rotors.len(), 20);
    assert!(of_rotors.iter().all(|row| !row.change.has_changed), "{of_rotors:?}");
}

#[test]
fn rotors_with_labels_are_paired_by_label() {
    for (name, is_paired) in [("", true), ("later ", false)] {
        let earlier = of_speeds("", 10, 1, &[(61.3, Some(1)), (66.1, Some(3))]);
        let later = of_speeds(name, 10, 2, &[(61.3, Some(1)), (57.3, Some(3))]);
        let drift = drift_of(Archives { earlier: &earlier, later: &later });
        assert_eq!((drift.is_paired, drift.is_labelled), (is_paired, true));
        let verdicts: Vec<_> = drift.rotors.iter().map(|row| (row.rotor, row.change.has_changed)).collect();
        assert_eq!(verdicts, [(0, true), (1, false), (3, true)]);
        assert!((drift.rotors[2].change.change_share - (57.3 / 66.1 - 1.0)).abs() < 2e-3);
        assert!(drift_text(&drift, None).contains("rotor, by label"));
    }
    // one rotor without a label: all are numbered by speed
    let earlier = of_speeds("", 10, 1, &[(61.3, Some(1)), (66.1, None)]);
    let later = of_speeds("", 10, 2, &[(61.3, Some(1)), (57.3, Some(3))]);
    let drift = drift_of(Archives { earlier: &earlier, later: &later });
    assert!(!drift.is_labelled && drift.rotors[1..].iter().all(|row| !row.change.is_rotor_known));
}

/// The verdict "cannot tell" is rare where ranks are clear: speeds 5 % apart that scatter by 0.4 %.
#[test]
fn clear_ranks_are_paired_by_rank() {
    let scattered = Drawn { between_share: 4e-3, change_share: -0.05, count: 40, ..STILL };
    let not_known = |seed| {
        let drift = drift(scattered, scattered, seed);
        drift.rotors.iter().filter(|row| !row.change.is_rotor_known).count()
    };
    assert_eq!((0..50).map(not_known).sum::<usize>(), 0);
}
