//! Slips of the person who files the recordings: a wrong load, exchanged masses, a wrong decimal point.

use super::campaign_tests::{VEHICLE_KG, exact_hovers, fitted, weight};
use crate::*;
use hovertone_analysis::Method;
use hovertone_vehicle::RotorSpeed;

/// Multiplies the thrust that a trial needs.
fn stretch(trial: &mut TrialSpeeds, thrust_factor: f64) {
    for sample in &mut trial.samples {
        sample.speed = RotorSpeed::from_rad_s(sample.speed.rad_s() * thrust_factor.sqrt());
    }
}

fn misfiled(table: &ThrustTable) -> Vec<String> {
    table.warnings.iter().filter(|warning| warning.is_of_misfiled()).map(ToString::to_string).collect()
}

#[test]
fn a_trial_under_the_wrong_load_is_named() {
    let mut loads = exact_hovers(&[0.0, 0.05], 5);
    assert_eq!(misfiled(&fitted(&loads)), [""; 0]);
    // moving air: 2 % are no slip
    stretch(&mut loads[0].trials[2], 1.02);
    assert_eq!(misfiled(&fitted(&loads)), [""; 0]);
    stretch(&mut loads[0].trials[2], 1.10);
    let table = fitted(&loads);
    let said = misfiled(&table);
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(
        said[0].starts_with(
            "by its rotor speed, load 0/2.wav has 12 % more thrust than the other recordings of load \"load 0\""
        ),
        "{said:?}"
    );
    let is_about_range = |warning: &ThrustWarning| matches!(warning, ThrustWarning::NarrowLoadRange(_));
    assert!(!table.warnings.iter().any(is_about_range), "{:?}", table.warnings);
}

#[test]
fn one_load_for_trials_of_three_masses_is_asked_about() {
    let mut loads = exact_hovers(&[0.0], 6);
    for (index, trial) in loads[0].trials.iter_mut().enumerate() {
        stretch(trial, [1.0, 1.08, 1.16][index / 2] * (1.0 + 0.002 * (index % 2) as f64));
    }
    let said = misfiled(&fitted(&loads));
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(said[0].contains("the recordings of load \"load 0\" form 3 groups of speeds"), "{said:?}");
}

#[test]
fn of_two_trials_that_differ_both_are_named() {
    let mut loads = exact_hovers(&[0.0], 2);
    stretch(&mut loads[0].trials[1], 1.12);
    let said = misfiled(&fitted(&loads));
    assert_eq!(said.len(), 1, "{said:?}");
    assert!(
        said[0].contains(
            "by the rotor speeds, load 0/1.wav has 12 % more thrust than load 0/0.wav, but both are of load \"load 0\""
        ),
        "{said:?}"
    );
}

#[test]
fn exchanged_masses_are_asked_about() {
    for trials in [1, 5] {
        let mut loads = exact_hovers(&[0.0, 0.031, 0.049], trials);
        assert_eq!(misfiled(&fitted(&loads)), [""; 0], "{trials}");
        (loads[0].force, loads[2].force) = (loads[2].force, loads[0].force);
        let table = fitted(&loads);
        let said = misfiled(&table);
        let slower = "the rotors turned slower under the heavier load \"load 0\" than under the lighter \"load 2\"";
        assert!(said.iter().any(|said| said == slower), "{said:?}");
        // there are no others that they could fit
        let together = said.iter().any(|said| said == "the loads do not fit each other: load 0, load 1, load 2");
        assert_eq!(together, trials > 1, "{said:?}");
        let hints = || table.warnings.iter().map(ThrustWarning::hint);
        assert_eq!(hints().any(|hint| hint.contains("must not include the mass of the vehicle")), trials > 1);
        let forbids = table.warnings.iter().filter(|warning| warning.forbids_use());
        assert!(
            forbids.clone().count() > 0 && forbids.map(ThrustWarning::hint).all(|hint| hint.starts_with("do not use"))
        );
    }
}

#[test]
fn a_mass_far_from_the_known_vehicle_is_named_with_both() {
    let said = |mass_kg: f64| {
        let mut loads = exact_hovers(&[0.0], 3);
        loads[0].force = weight(mass_kg - VEHICLE_KG);
        let settings = ThrustSettings { known_mass_kg: Some(0.413), ..ThrustSettings::for_rotors(4) };
        let table = thrust_from_loads(&loads, Method::Harmonic, &settings);
        let of_mass = |warning: &&ThrustWarning| matches!(warning, ThrustWarning::MassFarFromKnown { .. });
        table.warnings.iter().find(of_mass).map(|warning| format!("{warning}: {}", warning.hint()))
    };
    for usual_kg in [0.35, 0.413, 0.462, 1.2] {
        assert_eq!(said(usual_kg), None);
    }
    for (kg, words) in [
        (4.13, ["4130 g, 10 times the mass of the vehicle (413 g)", "decimal point"]),
        (0.0413, ["41.3 g, 0.10 times", "decimal point"]),
        (0.3, ["300 g, 0.73 times", "name of the vehicle"]),
        (1.3, ["1300 g, 3.1 times", "name of the vehicle"]),
    ] {
        let said = said(kg).unwrap_or_default();
        assert!(words.iter().all(|word| said.contains(word)), "{kg}: {said}");
    }
}

#[test]
fn one_trial_in_all_says_so_and_none_says_nothing_of_a_constant() {
    let one = fitted(&exact_hovers(&[0.0], 1));
    assert!(one.has_one_trial() && one.warnings.contains(&ThrustWarning::OneRecordingEach { load_count: 1 }));
    assert!(!fitted(&exact_hovers(&[0.0], 2)).has_one_trial());
    let mut silent = exact_hovers(&[0.0, 0.05], 1);
    silent.iter_mut().for_each(|load| load.trials.clear());
    let silent = fitted(&silent);
    assert_eq!((silent.thrust_constant_total_n_s2, silent.warnings), (None, Vec::new()));
}

/// The range of the loads is wide enough exactly where no wider one is needed, and a printed comparison is true.
#[test]
fn the_needed_range_agrees_with_its_verdict() {
    let (mut enough, mut narrow) = (0, 0);
    for added_kg in [0.02, 0.03, 0.049, 0.06, 0.1, 0.2] {
        for factor in [0.5, 1.0, 2.0, 4.0] {
            let mut loads = exact_hovers(&[0.0, 0.7 * added_kg, added_kg], 5);
            for load in &mut loads {
                let middle = load.trials[2].samples[0].speed.rad_s();
                for sample in load.trials.iter_mut().flat_map(|trial| &mut trial.samples) {
                    sample.speed = RotorSpeed::from_rad_s(middle + factor * (sample.speed.rad_s() - middle));
                }
            }
            let table = fitted(&loads);
            let range = table.fit.as_ref().and_then(|fit| fit.range).unwrap();
            let is_wide = range.force_ratio_needed.is_some_and(|needed| needed <= range.force_ratio);
            assert_eq!(range.shows_intercept, is_wide, "{range:?}");
            let narrow_warning =
                table.warnings.iter().find(|warning| matches!(warning, ThrustWarning::NarrowLoadRange(_)));
            assert_eq!(narrow_warning.is_some(), !range.shows_intercept, "{:?}", table.warnings);
            enough += usize::from(range.shows_intercept);
            narrow += usize::from(!range.shows_intercept);
        }
    }
    assert!(enough > 2 && narrow > 2, "{enough} {narrow}");
}

#[test]
fn a_needed_range_is_printed_above_the_range_of_the_loads() {
    let said = |force_ratio: f64, needed: f64| {
        ThrustWarning::NarrowLoadRange(LoadRange {
            force_ratio,
            intercept_std_share: 0.021,
            shows_intercept: false,
            force_ratio_needed: Some(needed),
        })
        .to_string()
    };
    assert!(
        said(1.1186, 1.14).ends_with(
            "is 1.12 times the smallest, but with speeds as uncertain as these, it must be 1.14 times or more"
        )
    );
    assert!(said(1.1186, 1.12).ends_with(
        "is 1.119 times the smallest, but with speeds as uncertain as these, it must be 1.120 times or more"
    ));
}
