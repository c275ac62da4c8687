//! Changes between two archives, against drawn speeds of known truth.

#![allow(clippy::unwrap_used)]

use hovertone_archive::{Archives, Drift, RotorSummary, Summary, drift_of};
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
        RotorSummary { speed_rev_s, std_rev_s: Some(STD_SHARE * SPEED_REV_S), spread_rev_s: None }
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
        warning_count: 0,
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
    assert_eq!((drift.rotors.len(), drift.earlier_unused), (0, 10));
}
