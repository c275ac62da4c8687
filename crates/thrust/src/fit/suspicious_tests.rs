//! Suspicious input: it is refused, or its result has a warning.

use super::campaign_tests::{GRAVITY_M_S2, TRUTH_N_S2, VEHICLE_KG, exact_hovers, fitted, load, weight};
use crate::*;
use hovertone_analysis::{Method, RotorsHeard};
use hovertone_vehicle::RotorSpeed;

#[test]
fn an_outlier_of_three_hundred_per_cent_is_named_and_left_out() {
    // a trial heard at half its speed: C four times too large
    let mut loads = exact_hovers(&[0.0, 0.05, 0.2], 4);
    let half = RotorSpeed::from_rad_s(loads[1].trials[2].samples[0].speed.rad_s() / 2.0);
    loads[1].trials[2].samples[0].speed = half;
    let table = fitted(&loads);
    let error = table.thrust_constant_total_n_s2.unwrap().value / TRUTH_N_S2 - 1.0;
    assert!(error.abs() < 2e-3, "{error}");
    assert!(table.warnings.iter().any(
        |warning| matches!(warning, ThrustWarning::TrialLeftOut { recording, .. } if recording == "load 1/2.wav")
    ));
    // a load written in the wrong unit
    let mut loads = exact_hovers(&[0.0, 0.05, 0.2, 0.1], 4);
    loads[3].force = weight(4.0 * (VEHICLE_KG + 0.1) - VEHICLE_KG);
    let table = fitted(&loads);
    let error = table.thrust_constant_total_n_s2.unwrap().value / TRUTH_N_S2 - 1.0;
    assert!(error.abs() < 2e-3, "{error}");
    let row = &table.loads[3];
    assert_eq!(row.fits, Some(false));
    assert!((row.mass_that_fits_kg.unwrap() - (VEHICLE_KG + 0.1)).abs() < 2e-3, "{row:?}");
    assert!(
        table.warnings.iter().any(|warning| matches!(warning, ThrustWarning::LoadDoesNotFit { is_left_out: true, .. }))
    );
    assert!(table.loads[..3].iter().all(|row| row.fits == Some(true)));
}

/// A recording that the constant does not use is not counted among those in which the rotors are heard.
#[test]
fn a_recording_that_is_left_out_is_not_counted() {
    let mut loads = exact_hovers(&[0.0, 0.05, 0.2, 0.1], 4);
    for trial in loads.iter_mut().flat_map(|load| &mut load.trials) {
        trial.rotors_heard = Some(RotorsHeard::Separated);
    }
    assert_eq!(fitted(&loads).rotors_heard.separated, 16);
    let wrong = &mut loads[1].trials[2];
    wrong.rotors_heard = Some(RotorsHeard::Group);
    wrong.samples[0].speed = RotorSpeed::from_rad_s(wrong.samples[0].speed.rad_s() / 2.0);
    let heard = fitted(&loads).rotors_heard;
    assert_eq!((heard.separated, heard.group), (15, 0));
    // a load that is left out has four recordings
    loads[3].force = weight(4.0 * (VEHICLE_KG + 0.1) - VEHICLE_KG);
    let heard = fitted(&loads).rotors_heard;
    assert_eq!((heard.separated, heard.group), (11, 0));
}

#[test]
fn loads_that_show_nothing_of_the_law_say_so() {
    let one = fitted(&exact_hovers(&[0.0], 3));
    assert!(one.warnings.contains(&ThrustWarning::SingleLoad) && one.loads[0].fits.is_none());
    assert!(one.measured_std_total_n_s2.is_some());
    let equal = fitted(&exact_hovers(&[0.0, 0.0, 0.0], 3));
    assert!(equal.warnings.contains(&ThrustWarning::EqualLoads { count: 3 }), "{:?}", equal.warnings);
    let mut mixed = exact_hovers(&[0.0, 0.05], 3);
    mixed[1].force = Force::Thrust { thrust_n: mixed[1].force.newtons() / 4.0, thrust_std_n: 0.005 };
    mixed[1].rotors_running = 1;
    let mixed = fitted(&mixed);
    assert!(mixed.warnings.contains(&ThrustWarning::MixedBenchAndHover));
    assert!((mixed.thrust_constant_total_n_s2.unwrap().value / TRUTH_N_S2 - 1.0).abs() < 2e-3);
    // the paper's range, and trials that scatter by 0.63 %
    let mut hovers = exact_hovers(&[0.0, 0.031, 0.049], 5);
    for load in &mut hovers {
        let middle = load.trials[2].samples[0].speed.rad_s();
        for sample in load.trials.iter_mut().flat_map(|trial| &mut trial.samples) {
            sample.speed = RotorSpeed::from_rad_s(middle + 4.0 * (sample.speed.rad_s() - middle));
        }
    }
    let narrow = fitted(&hovers);
    let range = narrow.fit.unwrap().range.unwrap();
    assert!((range.force_ratio - 1.119).abs() < 1e-3 && !range.shows_intercept, "{range:?}");
    assert!(range.force_ratio_needed.is_some_and(|ratio| ratio > 1.2), "{range:?}");
    assert!(narrow.warnings.iter().any(|warning| matches!(warning, ThrustWarning::NarrowLoadRange(_))));
}

#[test]
fn a_drift_of_the_battery_is_seen_and_chance_is_not() {
    let mut loads = exact_hovers(&[0.0, 0.05, 0.2], 5);
    let drifting = fitted(&loads);
    // the trials of exact_hovers grow by 0.1 % each
    let drift = drifting.drifts.first().expect("a drift");
    assert_eq!(drift.kind, DriftKind::PerTrial);
    assert!((drift.constant_share / -2e-3 - 1.0).abs() < 1e-2, "{drift:?}");
    for load in &mut loads {
        // in an order that goes neither up nor down
        load.trials = [3, 0, 2, 4, 1].map(|place| load.trials[place].clone()).to_vec();
    }
    assert!(fitted(&loads).drifts.is_empty());
}

#[test]
fn a_power_law_is_seen_over_a_wide_range() {
    let added_kg = [0.0, 0.1, 0.2, 0.3, 0.4];
    let mut loads = exact_hovers(&added_kg, 5);
    for load in &mut loads {
        // F ~ ω^2.3 through the lightest load
        let stretch = (load.force.newtons() / weight(0.0).newtons()).powf(1.0 / 2.3 - 0.5);
        for sample in load.trials.iter_mut().flat_map(|trial| &mut trial.samples) {
            sample.speed = RotorSpeed::from_rad_s(sample.speed.rad_s() * stretch);
        }
    }
    let fit = fitted(&loads).fit.unwrap();
    assert!((fit.power_law.unwrap().exponent.value - 2.3).abs() < 0.01, "{:?}", fit.power_law);
    assert_ne!(fit.preferred, ForceLaw::Square);
    assert_eq!(preferred_law(&fit), Some(fit.preferred));
    let mut even = fit.clone();
    even.laws.iter_mut().for_each(|law| law.probability = if law.law == fit.preferred { 0.5 } else { 0.25 });
    assert_eq!(preferred_law(&even), None, "twice as probable is not clearly better");
    let sum: f64 = fit.laws.iter().map(|law| law.probability).sum();
    assert!((sum - 1.0).abs() < 1e-12 && fit.laws.len() == 3);
    let square = fitted(&exact_hovers(&added_kg, 5)).fit.unwrap();
    assert_eq!(square.preferred, ForceLaw::Square);
}

#[test]
fn loads_without_any_uncertainty_have_that_of_their_scatter() {
    let mut loads = exact_hovers(&[0.0, 0.05, 0.2, 0.1], 1);
    for (load, offset) in loads.iter_mut().zip([1.0, -1.0, -1.0, 1.0]) {
        if let Force::Weight { mass_std_kg, .. } = &mut load.force {
            *mass_std_kg = 0.0;
        }
        for sample in load.trials.iter_mut().flat_map(|trial| &mut trial.samples) {
            sample.std_uncertainty_rev_s = None;
            sample.speed = RotorSpeed::from_rad_s(sample.speed.rad_s() * (1.0 + 0.002 * offset));
        }
    }
    let table = fitted(&loads);
    let total = table.thrust_constant_total_n_s2.unwrap();
    // four constants 0.4 % off either way: their mean is known to about 0.4 %·√(4/3)/√4, and three degrees of freedom make that 3.307/2
    // times as large (JCGM 100:2008, table G.2)
    let expected = 0.004 * (4.0f64 / 3.0).sqrt() / 2.0 * 3.307 / 2.0;
    assert!((table.measured_std_total_n_s2.unwrap() / total.value / expected - 1.0).abs() < 0.1, "{total:?}");
    let budget = table.budget.unwrap();
    let scatter = budget.lines.iter().find(|line| line.input == BudgetInput::SpeedStatistics).unwrap();
    assert_eq!(scatter.degrees_of_freedom, Some(3.0));
    assert!(table.measured_std_total_n_s2.unwrap() < 1.001 * scatter.contribution_n_s2, "{scatter:?}");
}

/// One recording of each load: the law is not tested, but a load far outside of the scatter of the others is named.
#[test]
fn a_wrong_mass_among_single_recordings_is_named() {
    let mut loads = exact_hovers(&[0.0, 0.05, 0.1, 0.15, 0.2, 0.25], 1);
    for (index, load) in loads.iter_mut().enumerate() {
        let offset = [1.0, -1.0, 0.5, -1.2, 0.8, -0.3][index];
        for sample in load.trials.iter_mut().flat_map(|trial| &mut trial.samples) {
            sample.speed = RotorSpeed::from_rad_s(sample.speed.rad_s() * (1.0 + 0.002 * offset));
        }
    }
    let said = |loads: &[LoadSpeeds]| {
        let table = fitted(loads);
        let warned = |is: fn(&ThrustWarning) -> bool| table.warnings.iter().any(is);
        assert!(warned(|warning| matches!(warning, ThrustWarning::OneRecordingEach { load_count: 6 })));
        assert!(table.fit.unwrap().agreement.is_none());
        table.loads.iter().map(|row| row.fits).collect::<Vec<_>>()
    };
    assert_eq!(said(&loads), [None; 6]);
    if let Force::Weight { added_mass_kg, .. } = &mut loads[3].force {
        *added_mass_kg += 0.1;
    }
    assert_eq!(said(&loads), [None, None, None, Some(false), None, None]);
}

#[test]
fn small_numbers_are_not_printed_as_zero() {
    assert_eq!(
        [0.9, 0.0349, 0.00123, 0.00004, 0.0].map(p_value_text),
        ["p = 0.90", "p = 0.035", "p = 0.0012", "p < 0.0001", "p < 0.0001"]
    );
    let drift =
        Drift { kind: DriftKind::PerSecond, constant_share: -1.234e-6, std_uncertainty_share: 1e-7, p_value: 1e-9 };
    let text = ThrustWarning::ConstantDrifts(drift).to_string();
    assert_eq!(
        text,
        "the constant drifts by −0.00012 % with each second of a recording (chance of this without a true drift: p < 0.0001)"
    );
}

#[test]
fn points_that_mean_nothing_are_refused_by_number() {
    let good = ForcePoint {
        name: "a".to_owned(),
        speed_square_rad2_s2: 1e5,
        speed_square_std_rad2_s2: 1e2,
        force_n: 1.0,
        force_std_n: 0.01,
    };
    for (force_n, speed_square) in [(0.0, 1e5), (-1.0, 1e5), (f64::NAN, 1e5), (1.0, 0.0), (1.0, f64::INFINITY)] {
        let bad = ForcePoint { force_n, speed_square_rad2_s2: speed_square, ..good.clone() };
        let refusal = square_law_fit(&[good.clone(), bad], PointNoise::Stated);
        assert_eq!(refusal.unwrap_err(), crate::regression::FitError::UnusablePoint { number: 2 });
    }
    assert!(square_law_fit(&[], PointNoise::Stated).is_err());
}

#[test]
fn constants_of_single_recordings_that_differ_are_told() {
    let mut two = exact_hovers(&[0.0, 0.05], 1);
    assert!(!fitted(&two).warnings.iter().any(|warning| matches!(warning, ThrustWarning::ConstantsDiffer { .. })));
    two[1].force = weight(0.4 * VEHICLE_KG);
    let table = fitted(&two);
    let differ = table.warnings.iter().find(|warning| matches!(warning, ThrustWarning::ConstantsDiffer { .. }));
    assert!(differ.is_some(), "{:?}", table.warnings);
}

/// A table of thrust that is right to a tenth cannot show constants that differ by less.
#[test]
fn constants_that_differ_within_the_stated_uncertainty_are_no_contradiction() {
    let differing = |stated_share: f64, constant_share: f64| {
        let mut loads = exact_hovers(&[0.0, 0.05], 1);
        for (load, factor) in loads.iter_mut().zip([1.0, 1.0 + constant_share]) {
            let thrust_n = factor * load.force.newtons();
            load.force = Force::Thrust { thrust_n, thrust_std_n: stated_share * thrust_n };
        }
        let warnings = fitted(&loads).warnings;
        warnings.into_iter().find(|warning| matches!(warning, ThrustWarning::ConstantsDiffer { .. }))
    };
    assert!(differing(0.0, 0.14).is_some());
    assert_eq!(differing(0.1, 0.14), None, "twice the root of two tenths squared is 28 %");
    let told = differing(0.1, 0.4).unwrap().to_string();
    assert!(
        told.ends_with("; the stated uncertainties of the forces (k = 2) explain a difference of only 28 %"),
        "{told}"
    );
    assert!(!differing(0.0, 0.14).unwrap().to_string().contains("explain"));
}

/// One of two loads is wrong, or half of the trials of each: nothing shows which, and the result says so.
#[test]
fn halves_that_are_off_by_a_factor_are_not_averaged_in_silence() {
    let mut two = exact_hovers(&[0.0, 0.05], 3);
    two[1].force = weight(4.0 * (VEHICLE_KG + 0.05) - VEHICLE_KG);
    let table = fitted(&two);
    assert!(table.warnings.contains(&ThrustWarning::ConstantsSplit), "{:?}", table.warnings);
    assert!(!table.warnings.iter().any(|warning| matches!(
        warning,
        ThrustWarning::NarrowLoadRange(_)
            | ThrustWarning::OtherLawPreferred { .. }
            | ThrustWarning::TrialLeftOut { .. }
    )));
    assert!(table.loads.iter().all(|row| row.fits == Some(false)), "of two that disagree both are named");
    let total = table.thrust_constant_total_n_s2.unwrap();
    assert!(table.measured_std_total_n_s2.unwrap() > 0.2 * total.value, "{total:?}");
    let mut halves = exact_hovers(&[0.0, 0.05], 2);
    for load in &mut halves {
        let speed = &mut load.trials[1].samples[0].speed;
        *speed = RotorSpeed::from_rad_s(speed.rad_s() / 2.0);
    }
    let table = fitted(&halves);
    assert!(table.warnings.contains(&ThrustWarning::ConstantsSplit), "{:?}", table.warnings);
    assert!(!table.warnings.iter().any(|warning| matches!(warning, ThrustWarning::TrialLeftOut { .. })));
    assert!(fitted(&exact_hovers(&[0.0, 0.05], 3)).warnings.iter().all(|w| *w != ThrustWarning::ConstantsSplit));
}

/// The estimator knows one of two loads far better than the other. Its flights scatter all the same, so it does not decide alone; and no law is told
/// from another by two loads, one of which has a wrong mass.
#[test]
fn no_load_counts_as_better_known_than_its_flights_repeat() {
    let mut two = exact_hovers(&[0.0, 0.05], 3);
    two[1].force = weight(0.03);
    for sample in two[1].trials.iter_mut().flat_map(|trial| &mut trial.samples) {
        sample.std_uncertainty_rev_s = Some(0.01 * sample.speed.rev_s());
    }
    let table = fitted(&two);
    let std_share = |row: &LoadThrust| row.std_uncertainty_rad_s.unwrap() / row.speed.unwrap().rad_s();
    assert!(std_share(&table.loads[0]) > 3e-4, "{}", std_share(&table.loads[0]));
    assert!(std_share(&table.loads[1]) > 5e-3, "{}", std_share(&table.loads[1]));
    // both known to the scatter of their flights: each mass would explain it, and no other law is named
    let mut repeated = exact_hovers(&[0.0, 0.05], 3);
    repeated[1].force = weight(0.03);
    let table = fitted(&repeated);
    let disagree = table.warnings.iter().find(|warning| matches!(warning, ThrustWarning::LoadsDisagree { .. }));
    let told = disagree.unwrap().to_string();
    assert!(told.contains("; they would fit if \"") && told.contains("weighed 463 g"), "{told}");
    assert!(!table.warnings.iter().any(|warning| matches!(warning, ThrustWarning::OtherLawPreferred { .. })));
}

/// Copies of one recording, or of the rows of a table: no scatter, and no panic.
#[test]
fn copies_are_fitted() {
    let rad_s = (VEHICLE_KG * GRAVITY_M_S2 / TRUTH_N_S2).sqrt();
    let copies: Vec<LoadSpeeds> = ["a", "b", "c"].map(|name| load(name, weight(0.0), &[rad_s, rad_s, rad_s])).to_vec();
    let table = fitted(&copies);
    assert!((table.thrust_constant_total_n_s2.unwrap().value / TRUTH_N_S2 - 1.0).abs() < 1e-12);
    let row = ForcePoint::from_speed("line 2".to_owned(), RotorSpeed::from_rpm(3610.3438), 0.0, 4.05, 0.0);
    for count in 1..6 {
        let fit = square_law_fit(&vec![row.clone(); count], PointNoise::FromResiduals).unwrap();
        assert!((fit.thrust_constant_n_s2.value / row.thrust_constant_n_s2() - 1.0).abs() < 1e-12);
        assert!(fit.points.iter().all(|point| point.fits != Some(false)), "{fit:?}");
    }
    // all points exact except one, which is named
    let mut rows = vec![row.clone(); 5];
    rows[2].force_n *= 1.1;
    let fit = square_law_fit(&rows, PointNoise::FromResiduals).unwrap();
    assert_eq!(fit.points.iter().filter(|point| point.fits == Some(false)).count(), 1, "{fit:?}");
}

#[test]
fn a_power_that_no_rotor_takes_and_a_mass_that_nobody_weighed_are_said() {
    let mut loads = exact_hovers(&[0.0, 0.1], 3);
    loads[0].power_w = Some(45.0);
    loads[1].power_w = Some(0.045);
    let settings = ThrustSettings {
        propeller_diameter_m: Some(0.2),
        air_density_kg_m3: Some(1.2),
        is_weighed: false,
        ..ThrustSettings::for_rotors(4)
    };
    let table = thrust_from_loads(&loads, Method::Harmonic, &settings);
    let implausible: Vec<&ThrustWarning> = table
        .warnings
        .iter()
        .filter(|warning| matches!(warning, ThrustWarning::ImplausibleFigureOfMerit { .. }))
        .collect();
    assert!(matches!(implausible[..], [ThrustWarning::ImplausibleFigureOfMerit { name, .. }] if name == "load 1"));
    assert!(table.warnings.contains(&ThrustWarning::MassNotWeighed { mass_kg: VEHICLE_KG }));
}

/// A table whose rows lie on the law but for rounding, with the deviations of some rows.
fn table_with(deviations: &[(usize, f64)]) -> Vec<ForcePoint> {
    let row = |index: usize| {
        let speed = RotorSpeed::from_rad_s(400.0 + 60.0 * index as f64);
        let share = deviations.iter().find(|(row, _)| *row == index).map_or(0.0, |(_, share)| *share);
        // a wave of rounding errors
        let rounding = 4e-5 * ((index * 7919 % 100) as f64 / 50.0 - 1.0);
        let force_n = 8e-6 * speed.rad_s().powi(2) * (1.0 + share + rounding);
        ForcePoint::from_speed(format!("line {}", index + 2), speed, 0.0, force_n, 0.0)
    };
    (0..14).map(row).collect()
}

#[test]
fn good_rows_beside_bad_ones_are_not_named_and_bad_ones_keep_their_order() {
    let named = |deviations: &[(usize, f64)]| {
        let points = table_with(deviations);
        let fit = square_law_fit(&points, PointNoise::FromResiduals).unwrap();
        let warnings = warnings_of_points(&points, &fit, None);
        let names = |warning: &ThrustWarning| match warning {
            ThrustWarning::RowsDoNotFit { names, .. } => names.clone(),
            ThrustWarning::LoadDoesNotFit { name, .. } => vec![name.clone()],
            _ => Vec::new(),
        };
        warnings.iter().flat_map(names).collect::<Vec<String>>()
    };
    // 0.08 % is as good as a stand is
    assert!(named(&[(3, 8e-4), (9, -8e-4)]).is_empty());
    assert_eq!(named(&[(3, 8e-4), (9, -0.2)]), ["line 11"]);
    let many = [(1, 8e-4), (2, -0.05), (5, 0.06), (6, -8e-4), (9, 0.30), (11, -0.10)];
    assert_eq!(named(&many), ["line 4", "line 7", "line 11", "line 13"]);
}

#[test]
fn the_warning_and_the_table_have_one_probability() {
    let points: Vec<ForcePoint> = (0..12)
        .map(|index| {
            let speed = RotorSpeed::from_rad_s(400.0 + 60.0 * f64::from(index));
            let scatter = 0.004 * (f64::from(index * 7919 % 100) / 50.0 - 1.0);
            let force_n = 8e-6 * speed.rad_s().powi(2) * (1.0 + scatter) + 0.06;
            ForcePoint::from_speed(format!("line {}", index + 2), speed, 0.0, force_n, 0.0)
        })
        .collect();
    let fit = square_law_fit(&points, PointNoise::FromResiduals).unwrap();
    let warnings = warnings_of_points(&points, &fit, None);
    let told = warnings.iter().find_map(|warning| match warning {
        ThrustWarning::OtherLawPreferred { law, probability } => Some((*law, *probability)),
        _ => None,
    });
    let (law, probability) = told.expect("another law is preferred");
    let in_table = fit.laws.iter().find(|known| known.law == law).unwrap().probability;
    assert_eq!(probability, in_table);
}
