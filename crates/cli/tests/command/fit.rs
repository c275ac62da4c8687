//! `hovertone fit` on tables whose truth is known, and its plans.

use crate::testkit::{files_in, hovertone, recordings, text};
use hovertone_vehicle::RotorSpeed;
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// The paper's table 1 as a CSV, with its speeds' standard errors over 25 samples.
fn paper_table(folder: &Path, big_hull_g: u32) -> PathBuf {
    let path = folder.join("paper.csv");
    let rows = format!(
        "mass_g,mass_std_g,rpm,speed_std_rpm\n413,0.5,3610.3438,8.89832\n444,0.5,3742.0275,9.67626\n{big_hull_g},0.5,3820.1625,9.54946\n"
    );
    fs::write(&path, rows).unwrap();
    path
}

pub(crate) fn number(value: &Value, pointer: &str) -> f64 {
    value.pointer(pointer).and_then(Value::as_f64).unwrap_or_else(|| panic!("{pointer} in {value}"))
}

#[test]
fn the_papers_rows_fit_with_462_g_and_not_with_472() {
    let folder = tempfile::tempdir().unwrap();
    let fit = |big_hull_g: u32| {
        let table = paper_table(folder.path(), big_hull_g);
        let arguments = ["fit", text(&table), "--rotors", "4", "--gravity-m-s2", "9.8", "--json"];
        hovertone(&arguments).ends_with(0).json_lines().remove(0)
    };
    let right = fit(462);
    assert!((number(&right, "/thrust_constant_total_n_s2/value") - 2.8314e-5).abs() < 5e-10);
    assert!((number(&right, "/thrust_constant_total_n_s2/std_uncertainty") - 0.0084e-5).abs() < 5e-9);
    let rotor = number(&right, "/thrust_constant_per_rotor_n_s2/value");
    assert!((rotor * 4.0 - number(&right, "/thrust_constant_total_n_s2/value")).abs() < 1e-18);
    assert!(number(&right, "/fit/agreement/chi_square") < 0.1);
    assert!(
        right
            .to_string()
            .contains("is 1.12 times the smallest, but with speeds as uncertain as these, it must be 1.41 times"),
        "{right}"
    );
    let wrong = fit(472);
    assert!((number(&wrong, "/fit/agreement/p_value") - 0.0055).abs() < 2e-4);
    let misfits: Vec<&Value> =
        wrong["fit"]["points"].as_array().unwrap().iter().filter(|point| point["fits"] == false).collect();
    assert_eq!(misfits.len(), 1);
    let mass_g = 1e3 * number(misfits[0], "/force_that_fits_n") / 9.8;
    assert!((mass_g - 462.4).abs() < 0.5, "{mass_g}");
    let words = hovertone(&["fit", text(&paper_table(folder.path(), 472)), "--gravity-m-s2", "9.8"]).ends_with(0);
    assert!(words.stderr.contains("line 4 of the file does not fit the others; a mass of 462."), "{}", words.stderr);
}

/// Constants and exponents as the README of the recordings has them, to its digits.
#[test]
fn thrust_stands_as_their_readme_says() {
    let Some(data) = recordings("thrust-stands") else { return };
    let mut fits: Vec<Value> = Vec::new();
    for path in files_in(&data, ".csv") {
        let document: Value =
            serde_json::from_str(&hovertone(&["fit", text(&path), "--json"]).ends_with(0).stdout).unwrap();
        match document["groups"].as_array() {
            Some(groups) => fits.extend(groups.iter().cloned()),
            None => fits.push(document),
        }
    }
    assert_eq!(fits.len(), 7, "three runs and four motors");
    for (name, constant, unit) in
        [("b4_7", 6.1, 1e-7), ("g8_11", 1.45, 1e-6), ("m8_11", 1.36, 1e-6), ("DJI 9450", 1.12, 1e-5)]
    {
        let is_named = |fit: &&Value| {
            fit["file"].as_str().unwrap().contains(name) || fit["group"].as_str().unwrap().contains(name)
        };
        let fit = fits.iter().find(is_named).unwrap();
        let found = number(fit, "/thrust_constant_per_rotor_n_s2/value") / unit;
        let digits = if constant == 6.1 { 0.05 } else { 0.005 };
        assert!((found - constant).abs() <= digits, "{name}: {found}");
        let residual_percent = (100.0 * number(fit, "/fit/residual_max_share")).round();
        assert!((1.0..=3.0).contains(&residual_percent), "{name}: {residual_percent} % of full scale");
    }
    for fit in &fits {
        let exponent = number(fit, "/fit/power_law/exponent/value");
        assert!((1.95..2.25).contains(&exponent), "{exponent}: 2.0 to 2.2");
    }
    let m8_11 = fits.iter().find(|fit| fit["file"].as_str().unwrap().contains("m8_11")).unwrap();
    assert!(m8_11["notices"].to_string().contains("used as positive ones"), "{m8_11}");
    let bitcraze = recordings("crazyflie-propeller").unwrap().join("pwm_to_thrust.csv");
    let fit = hovertone(&["fit", text(&bitcraze), "--rotors", "4", "--json"]).ends_with(0).json_lines().remove(0);
    assert!((number(&fit, "/thrust_constant_per_rotor_n_s2/value") - 2.218e-8).abs() < 5e-12);
    assert!((number(&fit, "/fit/power_law/exponent/value") - 2.15).abs() < 0.005);
}

#[test]
fn bad_tables_are_refused_or_flagged() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("table.csv");
    let run = |rows: &str| {
        fs::write(&path, rows).unwrap();
        hovertone(&["fit", text(&path), "--json"])
    };
    for (rows, words) in [
        ("rpm,mass_g\n3600,0\n", &["line 2", "above 0", "table.csv"][..]),
        ("rpm,mass_g\n3600,-413\n", &["line 2", "above 0"]),
        ("rpm,mass_g\n3600,NaN\n", &["line 2", "no number"]),
        ("rpm,volts\n3600,11\n", &["rpm, volts", "docs/formats.md lists the words"]),
        ("rpm,thrust_n\n0,1\n", &["nothing to fit"]),
        ("rpm,mass_g\n3600,413\n", &["at least 3 usable rows", "has 1", "mass_std_g"]),
        ("rpm,mass_g\n3600,413\n3700,1744\n", &["at least 3 usable rows", "has 2", "mass_std_g"]),
        // three rows that are one row
        ("rpm,mass_g\n3600,413\n3600,413\n3600,413\n", &["exactly on F = C ω²", "scatter of measured rows"]),
    ] {
        let refused = run(rows).ends_with(2);
        assert!(refused.stdout.is_empty());
        assert!(words.iter().all(|word| refused.stderr.contains(word)), "{rows:?}: {}", refused.stderr);
    }
    let one = run("rpm,mass_g,mass_std_g\n3600,413,1\n").ends_with(0).json_lines().remove(0);
    assert!(one["notices"].to_string().contains("only one row"), "{one}");
    let equal = run("rpm,mass_g\n3600,413\n3610,413\n3605,413\n").ends_with(0).json_lines().remove(0);
    assert!(equal["notices"].to_string().contains("all 3 loads have the same force"), "{equal}");
    assert!(equal["fit"]["with_intercept"].is_null() && equal["fit"]["power_law"].is_null(), "{equal}");
    // three rows that are nearly one
    for rows in ["rpm,thrust_n\n3600,1.00\n3601,1.002\n3602,0.999\n", "rpm,thrust_n\n3600,1\n3620,1.012\n3640,1.021\n"]
    {
        let near = run(rows).ends_with(0).json_lines().remove(0);
        assert!(near["fit"]["with_intercept"].is_null() && near["fit"]["power_law"].is_null(), "{near}");
        let said = hovertone(&["fit", text(&path)]).ends_with(0);
        assert!(
            said.stdout.contains("the laws have no probabilities, because") && !said.stdout.contains("F₀ + C"),
            "{}",
            said.stdout
        );
        let is_said = ["have the same force", "forces are too alike"].iter().any(|words| said.stderr.contains(words));
        assert!(is_said && said.stderr.contains("hint: "), "{}", said.stderr);
    }
    // half of the rows are four times too heavy, and nobody knows which half
    let halves = run("rpm,mass_g\n3600,413\n3610,416\n3700,1744\n3710,1755\n").ends_with(3).json_lines().remove(0);
    assert!(
        halves["notices"].to_string().contains("nothing shows which group is right (hint: do not use this constant"),
        "{halves}"
    );
    let said = hovertone(&["fit", text(&path)]).ends_with(3).stdout;
    assert!(said.contains("\ndo not use this constant: C_f, one rotor = "), "{said}");
    // 300 % too heavy
    let outlier = run("rpm,mass_g\n3600,400\n3818,450\n4025,2000\n4221,550\n").ends_with(0).json_lines().remove(0);
    assert!(outlier["notices"].to_string().contains("line 4 of the file does not fit"), "{outlier}");
    assert!(outlier["notices"].to_string().contains("left out"), "{outlier}");
    let said = hovertone(&["fit", text(&path)]).ends_with(0).stdout;
    assert!(said.contains("4 table rows, 1 of them left out of the fit: mass_g against rpm"), "{said}");
    let expected = 0.4 * 9.80665 / RotorSpeed::from_rpm(3600.0).rad_s().powi(2);
    let found = number(&outlier, "/thrust_constant_total_n_s2/value");
    assert!((found / expected - 1.0).abs() < 2e-3, "{found} {expected}");
}

/// A log at 44 Hz, spinning up and down: hundreds of rows, most of them sound.
#[test]
fn a_log_of_a_stand_is_fitted_without_a_flood_of_warnings() {
    let Some(data) = recordings("logs") else { return };
    let log = data.join("rcbenchmark_command_steps.csv");
    let run = hovertone(&["fit", text(&log), "--json"]).ends_with(0);
    let fit = run.json_lines().remove(0);
    assert!(number(&fit, "/row_count") > 500.0);
    assert!(fit["notices"].as_array().unwrap().len() < 10, "{}", fit["notices"]);
    assert!(fit["notices"].to_string().contains("rows do not fit the others: line "), "{}", fit["notices"]);
    assert!(number(&fit, "/torque_constant_per_rotor_n_m_s2") > 0.0);
}

#[test]
fn a_row_that_fits_the_preferred_law_is_not_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("offset.csv");
    fs::write(&table, "rad/s,thrust_n\n100,0.31\n200,0.62\n300,1.12\n400,1.83\n500,2.74\n600,3.85\n").unwrap();
    let run = hovertone(&["fit", text(&table)]).ends_with(0);
    assert!(
        run.stdout.contains("6 table rows used: thrust_n") && run.stdout.contains("F = F₀ + C ω² (preferred)"),
        "{}",
        run.stdout
    );
    assert!(!run.stderr.contains("left out"), "{}", run.stderr);
    // a tenth of the speed is no offset
    fs::write(&table, "rad/s,thrust_n\n20,0.62\n300,1.12\n400,1.83\n500,2.74\n600,3.85\n").unwrap();
    assert!(hovertone(&["fit", text(&table)]).stderr.contains("left out"));
}

#[test]
fn rows_that_contradict_each_other_are_no_complete_answer() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("two.csv");
    fs::write(&table, "rpm,thrust_n,thrust_std_n\n3000,0.511,0.003\n3000,0.6,0.003\n6000,2.3,0.003\n6000,2.05,0.003\n")
        .unwrap();
    let run = hovertone(&["fit", text(&table)]).ends_with(3);
    assert!(run.stderr.contains("no single C_f in F = C_f ω² fits these rows: line 2, line 3"), "{}", run.stderr);
}

#[test]
fn a_plan_tells_before_flying() {
    let plan = |wanted: &str, more: &[&str]| {
        let mut arguments = vec!["fit", "--plan", "--mass-kg", "0.413", "--wanted-share", wanted];
        arguments.extend(more);
        hovertone(&arguments)
    };
    let words = plan("0.025", &["--latitude-deg", "-20.3", "--added-mass-kg", "0.1"]).ends_with(0).stdout;
    for word in ["loads", "recordings of each load", "s of steady hover", "k = 2", "rotors not separated"] {
        assert!(words.contains(word), "{words}");
    }
    // the load that it names tests the law
    let added_kg = words.split("--added-mass-kg ").nth(1).unwrap().trim_end().trim_end_matches('.').to_owned();
    let heavier = plan("0.025", &["--latitude-deg", "-20.3", "--added-mass-kg", &added_kg]).ends_with(0).stdout;
    assert!(heavier.contains("These loads also test"), "{words}\n{heavier}");
    let unreachable = plan("0.005", &["--added-mass-kg", "0.1"]).ends_with(2).stderr;
    let nearer = "so near the vehicle that `hovertone speed` separates the rotors or hears them as a group, and plan again with --rotors-separated";
    assert!(unreachable.contains("rotors not separated") && unreachable.contains(nearer), "{unreachable}");
    let apart = plan("0.01", &["--added-mass-kg", "0.1", "--rotors-separated", "--latitude-deg", "-20.3", "--json"])
        .ends_with(0)
        .stdout;
    let plan: Value = serde_json::from_str(&apart).unwrap();
    assert!(number(&plan, "/expanded_share") <= 0.01 && number(&plan, "/load_count") >= 3.0);
    hovertone(&["fit", "--plan"]).ends_with(2);
    // grams as kilograms, and what no share allows
    let in_grams = hovertone(&["fit", "--plan", "--mass-kg", "0.413", "--mass-std-kg", "0.5"]).ends_with(2).stderr;
    assert!(in_grams.contains("mass_std_kg = 0.5") && in_grams.contains("for 0.5 g write 0.0005"), "{in_grams}");
    let vague = hovertone(&["fit", "--plan", "--mass-kg", "0.413", "--mass-std-kg", "0.2"]).ends_with(2).stderr;
    assert!(vague.contains("stays above") && !vague.contains("larger --wanted-share"), "{vague}");
    for (flag, value) in
        [("--mass-std-kg", "nan"), ("--mass-std-kg", "-1"), ("--diameter-m", "nan"), ("--wanted-share", "inf")]
    {
        let refused = hovertone(&["fit", "--plan", "--mass-kg", "0.413", flag, value]).ends_with(2).stderr;
        let name = flag.trim_start_matches("--").replace('-', "_");
        assert!(refused.contains(&name) && refused.contains("must be"), "{flag} {value}: {refused}");
    }
}

/// Masses are weighed by gravity, and where nobody says where, that is uncertain by 0.15 %.
#[test]
fn a_table_of_masses_counts_gravity() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("table.csv");
    fs::write(&path, "mass_g,mass_std_g,rpm\n413,0.1,3610.3438\n826,0.1,5105.797\n").unwrap();
    let share = |more: &[&str]| {
        let fit = hovertone(&[&["fit", text(&path), "--json"], more].concat()).ends_with(0).json_lines().remove(0);
        number(&fit, "/thrust_constant_total_n_s2/std_uncertainty") / number(&fit, "/thrust_constant_total_n_s2/value")
    };
    let (known, unknown) = (share(&["--gravity-m-s2", "9.8"]), share(&[]));
    assert!((unknown.powi(2) - known.powi(2)).sqrt() / (0.015 / 9.80665) - 1.0 < 0.01, "{known} {unknown}");
    assert!(unknown > 5.0 * known, "{known} {unknown}");
}

/// A table that cannot be read ends no answer about the others, in words and in JSON.
#[test]
fn a_bad_table_does_not_hide_the_others() {
    let folder = tempfile::tempdir().unwrap();
    let (good, bad) = (folder.path().join("good.csv"), folder.path().join("bad.csv"));
    std::fs::write(&good, "rpm,mass_g\n3600,413\n3818,462\n4025,515\n").unwrap();
    std::fs::write(&bad, "rpm\n3600\n").unwrap();
    let both = ["fit", text(&bad), text(&good)];
    let words = hovertone(&both).ends_with(1);
    let json = hovertone(&[&both[..], &["--json"]].concat()).ends_with(1);
    assert!(words.stderr.contains("bad.csv") && words.stdout.contains("good.csv"), "{}{}", words.stderr, words.stdout);
    assert!(json.stderr.contains("bad.csv"), "{}", json.stderr);
    let document: Value = serde_json::from_str(&json.stdout).unwrap();
    assert!(document["file"].as_str().unwrap().ends_with("good.csv"), "{document}");
    assert!(hovertone(&["fit", text(&bad), text(&bad), "--json"]).ends_with(1).stdout.is_empty());
}

/// A header of an uncertainty says how large it is: the same numbers give half or a third of the ±.
#[test]
fn uncertainties_are_read_as_their_headers_say() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("table.csv");
    let run = |header: &[u8]| {
        let rows = b"3000,0.70,0.02\n4000,1.25,0.02\n5000,1.94,0.02\n6000,2.81,0.02\n";
        fs::write(&path, [&b"rpm,thrust_n,"[..], header, b"\n", rows].concat()).unwrap();
        hovertone(&["fit", text(&path), "--json"]).ends_with(0).json_lines().remove(0)
    };
    let std = |fit: &Value| number(fit, "/thrust_constant_total_n_s2/std_uncertainty");
    let of_std = std(&run(b"thrust_std_n"));
    for (header, factor) in [
        (&b"thrust_uncertainty_k=3_n"[..], 3.0),
        (b"thrust_uncertainty_95%_n", 2.0),
        ("±thrust_n".as_bytes(), 2.0),
        // ± in Latin-1
        (b"\xb1thrust_n", 2.0),
    ] {
        let fit = run(header);
        assert_eq!(fit["force_column"], "thrust_n");
        assert!((std(&fit) * factor / of_std - 1.0).abs() < 1e-9, "{}", fit["notices"]);
        let said = format!("so its numbers are divided by {factor}");
        assert!(fit["notices"].to_string().contains(&said), "{}", fit["notices"]);
    }
    let unused = run(b"thrust_error_n")["notices"].to_string();
    assert!(unused.contains("thrust_error_n") && unused.contains("write std into its name"), "{unused}");
}

#[test]
fn a_table_without_uncertainties_is_judged_by_its_scatter() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("table.csv");
    let rows = "3600,1\n3620,1.012\n3640,1.021\n3660,1.036\n3680,1.044\n";
    let said = |header: &str, rows: &str| {
        fs::write(&path, format!("{header}\n{rows}")).unwrap();
        hovertone(&["fit", text(&path)]).ends_with(0)
    };
    let run = said("rpm,thrust_n", rows);
    assert!(run.stderr.contains("but with as much scatter as in these rows"), "{}", run.stderr);
    let zeros = said("rpm,thrust_n,thrust_std_n", "3000,0.7,0\n4000,1.25,0\n5000,1.94,0\n").stderr;
    assert!(zeros.contains("no row has an uncertainty above 0: the ± comes from"), "{zeros}");
    let copied = said("rpm,thrust_n", &"3000,0.7\n4000,1.25\n5000,1.94\n6000,2.81\n".repeat(10)).stderr;
    assert!(copied.contains("36 of 40 rows are exact copies of other rows"), "{copied}");
}

/// The tips of small racing propellers come near the limit, and C_f needs no diameter.
#[test]
fn tips_that_are_too_fast_leave_a_way_out() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("racing.csv");
    fs::write(&path, "rpm,thrust_n\n16000,3.0\n24000,6.8\n32000,12.1\n").unwrap();
    let refused = hovertone(&["fit", text(&path), "--diameter-m", "5in"]).ends_with(2).stderr;
    assert!(refused.contains("Mach 0.62") && refused.contains("leave --diameter-m out"), "{refused}");
    hovertone(&["fit", text(&path)]).ends_with(0);
}

/// Two groups of a stand whose forces are too alike in one, and prefer no law in the other.
#[test]
fn real_stands_are_told_what_they_have() {
    let Some(data) = recordings("thrust-stands") else { return };
    let groups = hovertone(&["fit", text(&data.join("ctu_mrs_motor_tests.csv")), "--diameter-m", "10in"]).ends_with(0);
    assert!(groups.stderr.contains("with as much scatter as in these rows"), "{}", groups.stderr);
    assert!(!groups.stderr.contains("speeds as uncertain"), "{}", groups.stderr);
    let unpreferred = groups.stdout.matches("none is preferred").count();
    assert!(unpreferred > 1, "{}", groups.stdout);
    assert_eq!(
        groups.stdout.matches("C_f is the constant of the law F = C ω²").count(),
        unpreferred,
        "{}",
        groups.stdout
    );
    let small = data.join("rcbenchmark1520_m8_11.csv");
    let low = hovertone(&["fit", text(&small), "--diameter-m", "8in", "--height-m", "0"]).stderr;
    assert!(
        low.contains("and no propeller has that") && low.contains("pole pairs") && !low.contains("blades"),
        "{low}"
    );
}
