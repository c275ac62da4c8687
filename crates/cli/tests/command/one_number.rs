//! One number, one ±, no contradiction: the constant in all outputs of a run, and what stands above and below it.

use crate::identify::write_experiment;
use crate::testkit::{Run, hovertone, refused_with, repository, text};
use serde_json::Value;
use std::fs;
use std::path::Path;

const GROUPS: &str = "motor,rpm,thrust_n\nA,3000,0.701\nA,4000,1.249\nA,5000,1.952\nA,6000,2.81\n\
                      B,3000,1.402\nB,4000,2.498\nB,5000,3.904\nB,6000,5.62\n";

/// "(7.073 ± 0.035) 1e-6 N s²" behind a text: the value and its ±.
fn quoted_after(line: &str, begin: &str) -> (f64, f64) {
    let (_, quoted) = line.split_once(begin).unwrap_or_else(|| panic!("{begin:?} in {line:?}"));
    let (digits, unit) = quoted.split_once(") ").unwrap();
    let (value, plus_minus) = digits.trim_start_matches('(').split_once(" ± ").unwrap();
    let power: f64 = unit.split_whitespace().next().unwrap().parse().unwrap();
    (value.parse::<f64>().unwrap() * power, plus_minus.parse::<f64>().unwrap() * power)
}

fn number(value: &Value, pointer: &str) -> f64 {
    value.pointer(pointer).and_then(Value::as_f64).unwrap_or_else(|| panic!("no {pointer}"))
}

/// Equal but for the rounding to two digits.
fn assert_rounded(found: f64, exact: f64, what: &str) {
    assert!((found / exact - 1.0).abs() < 0.05, "{what}: {found:e}, not {exact:e}");
}

/// An identified experiment with all its outputs.
struct Identified {
    folder: tempfile::TempDir,
    out: std::path::PathBuf,
    run: Run,
    results: Value,
}

fn identified(more: &[&str]) -> Identified {
    let folder = tempfile::tempdir().unwrap();
    let experiment = write_experiment(folder.path());
    let out = folder.path().join("out");
    let run = hovertone(&[&["identify", &experiment, "-o", text(&out)], more].concat()).ends_with(0);
    let results = serde_json::from_str(&fs::read_to_string(out.join("results.json")).unwrap()).unwrap();
    Identified { folder, out, run, results }
}

fn exported(results: &Path, format: &str) -> String {
    hovertone(&["export", text(results), "--to", format]).ends_with(0).stdout
}

#[test]
fn the_constant_of_one_rotor_has_one_uncertainty_in_every_output() {
    let Identified { folder: _folder, out, run, results } = identified(&["-v"]);
    let expanded = number(&results, "/expanded_uncertainty_per_rotor_n_s2");
    // the whole budget, k = 2
    let of_budget = number(&results, "/uncertainty_budget/expanded_uncertainty_n_s2") / 4.0;
    assert!((expanded / of_budget - 1.0).abs() < 1e-12, "{expanded} {of_budget}");
    let std = number(&results, "/thrust_constant_per_rotor_n_s2/std_uncertainty");
    assert!((expanded / std - number(&results, "/coverage_factor")).abs() < 1e-9, "{expanded} {std}");
    assert!(number(&results, "/measured_std_total_n_s2") < 4.0 * std);

    let line = run.stdout.lines().find(|line| line.starts_with("C_f = (")).unwrap();
    let (rotor, plus_minus) = quoted_after(line, "C_f = ");
    assert_rounded(rotor, number(&results, "/thrust_constant_per_rotor_n_s2/value"), "terminal");
    assert_rounded(plus_minus, expanded, "terminal");
    assert!(line.contains("k = 2"), "{line}");

    for (file, between) in [("tables.md", " | "), ("tables.tex", " & ")] {
        let tables = fs::read_to_string(out.join(file)).unwrap().replace("$\\pm$", "±");
        let row = tables.lines().find(|line| line.contains("(reported)")).unwrap();
        let cell = row.split(between).nth(2).unwrap();
        let (_, plus_minus) = cell.split_once(" ± ").unwrap();
        assert_rounded(plus_minus.trim().parse::<f64>().unwrap() * 1e-6, expanded, file);
    }
    let page = fs::read_to_string(out.join("report.html")).unwrap();
    let (_, element) = page.split_once("<data id=\"per_rotor\"").unwrap();
    let (_, exact) = element.split_once("data-uncertainty=\"").unwrap();
    assert_eq!(exact.split('"').next().unwrap().parse::<f64>().unwrap(), expanded, "page");

    let of_export: Value = serde_json::from_str(&exported(&out.join("results.json"), "json")).unwrap();
    assert!((number(&of_export, "/expanded_uncertainty_per_rotor_n_s2") / expanded - 1.0).abs() < 1e-9);
    let gazebo = exported(&out.join("results.json"), "gazebo");
    let (_, stated) = gazebo.split_once("expanded uncertainty (k = 2) ").unwrap();
    assert_rounded(stated.split_whitespace().next().unwrap().parse().unwrap(), expanded, "gazebo");
}

#[test]
fn identify_ends_with_four_lines_and_warnings_stand_above_counted() {
    let Identified { folder: _folder, out, run, .. } = identified(&[]);
    let lines: Vec<&str> = run.stdout.lines().collect();
    let [.., constants, verdict, heard, page] = lines.as_slice() else { panic!("{}", run.stdout) };
    assert!(constants.starts_with("C_f = (") && constants.contains("for one rotor, ("), "{constants}");
    assert!(constants.contains("for the whole vehicle; ± is "), "{constants}");
    assert!(verdict.starts_with("verdict: every load agrees with the others"), "{verdict}");
    assert!(!verdict.contains("rotors"), "{verdict}");
    assert_eq!(*heard, "rotors: heard as a group in 4 recordings");
    assert_eq!(*page, format!("page: {}", out.join("report.html").display()));
    // a headline and these four; the tables are in the files
    assert_eq!(lines.len(), 5, "{}", run.stdout);
    assert!(!run.stdout.contains('─'), "{}", run.stdout);
    let count = run.stderr.matches("warning: ").count();
    assert!(count > 0, "this test needs a warning");
    let counted = format!("{count} {}", if count == 1 { "warning" } else { "warnings" });
    assert_eq!(run.stderr.lines().next().unwrap(), counted);
    assert!(lines[0].ends_with(&format!("; {counted}")), "{}", lines[0]);
}

/// Four rotors at one speed: nothing can separate them.
#[test]
fn rotors_that_are_heard_as_a_group_are_called_that() {
    let Identified { folder: _folder, out, run, results } = identified(&["-v"]);
    assert_eq!(results["method"], "separated");
    let counts = &results["rotors_heard"];
    assert_eq!((&counts["separated"], &counts["group"], &counts["one_tone"]), (&0.into(), &4.into(), &0.into()));
    assert!(results["inputs"].as_array().unwrap().iter().all(|input| input["rotors_heard"] == "group"));
    let read = |name: &str| fs::read_to_string(out.join(name)).unwrap();
    let export = exported(&out.join("results.json"), "gazebo");
    for (what, output) in [
        ("terminal", &run.stdout),
        ("tables.md", &read("tables.md")),
        ("tables.tex", &read("tables.tex")),
        ("page", &read("report.html")),
        ("figure", &read("figures/fit.svg")),
        ("export", &export),
    ] {
        let output = output.to_lowercase();
        assert!(output.contains("as a group"), "{what}");
        assert!(
            !output.contains("rotors: separated")
                && !output.contains("rotors separated")
                && !output.contains("told apart"),
            "{what}"
        );
    }
    let sound = out.parent().unwrap().join("load0/trial0.wav");
    let written = out.join("results.json");
    let command = hovertone(&["export", text(&written), "--to", "json", "--hover-command", "0.5"]).ends_with(0).stderr;
    assert!(command.contains("--hover-command changes nothing: the format json has no number for it"), "{command}");
    assert!(command.contains("a number for it: --to gazebo, ") && command.contains(" or yaml)"), "{command}");
    let alone = hovertone(&["speed", "--vehicle", "ardrone", "--json", text(&sound)]).ends_with(0);
    assert_eq!(alone.json_lines()[0]["rotors_heard"], "group");
}

#[test]
fn a_fit_with_groups_is_one_document_and_export_takes_a_group() {
    let folder = tempfile::tempdir().unwrap();
    let (table, fitted) = (folder.path().join("stand.csv"), folder.path().join("fit.json"));
    fs::write(&table, GROUPS).unwrap();
    let printed = hovertone(&["fit", text(&table), "--json"]).ends_with(0).stdout;
    let document: Value = serde_json::from_str(&printed).unwrap();
    let names: Vec<&Value> = document["groups"].as_array().unwrap().iter().map(|group| &group["group"]).collect();
    assert_eq!(names, ["A", "B"]);
    fs::write(&fitted, &printed).unwrap();
    for (index, name) in ["A", "B"].into_iter().enumerate() {
        let run = hovertone(&["export", text(&fitted), "--to", "json", "--group", name]).ends_with(0);
        let rotor: Value = serde_json::from_str(&run.stdout).unwrap();
        let constant = number(&document, &format!("/groups/{index}/thrust_constant_per_rotor_n_s2/value"));
        let std = number(&document, &format!("/groups/{index}/thrust_constant_per_rotor_n_s2/std_uncertainty"));
        assert!((number(&rotor, "/thrust_constant_per_rotor_n_s2") / constant - 1.0).abs() < 1e-9);
        assert!((number(&rotor, "/expanded_uncertainty_per_rotor_n_s2") / (2.0 * std) - 1.0).abs() < 1e-9);
        assert!(run.stdout.contains(&format!("\"vehicle\": \"{name}\"")), "{}", run.stdout);
    }
    refused_with(&["export", text(&fitted), "--to", "gazebo"], &["several groups: \"A\", \"B\"", "--group"]);
    refused_with(
        &["export", text(&fitted), "--to", "gazebo", "--group", "C"],
        &["no group \"C\"", "\"A\", \"B\"", "--group"],
    );
    // the table of one group is the fit itself, as it always was
    fs::write(
        &table,
        GROUPS.replace("\nB,", "\nA,").replace("A,3000,1.402\nA,4000,2.498\nA,5000,3.904\nA,6000,5.62\n", ""),
    )
    .unwrap();
    let only: Value = serde_json::from_str(&hovertone(&["fit", text(&table), "--json"]).ends_with(0).stdout).unwrap();
    assert_eq!((&only["group"], only.get("groups")), (&"A".into(), None));
}

/// Rows of F = 0.3 N (ω / 400)^2.3 and of F = 0.5 N + 3e-6 ω²: the printed numbers give the forces back.
#[test]
fn a_preferred_law_is_printed_with_all_its_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("table.csv");
    let speeds_rad_s = [250.0_f64, 320.0, 400.0, 470.0, 550.0, 630.0];
    let rows = |force: &dyn Fn(f64) -> f64| {
        let wobble = [1.0, -1.0, 1.0, 1.0, -1.0, -1.0].map(|sign| 1.0 + 5e-4 * sign);
        let rows = speeds_rad_s.iter().zip(wobble).map(|(s, wobble)| format!("{s},{}\n", wobble * force(*s)));
        format!("speed_rad_s,thrust_n\n{}", rows.collect::<String>())
    };
    let law = |table: String| {
        fs::write(&path, table).unwrap();
        let said = hovertone(&["fit", text(&path)]).ends_with(0).stdout;
        said.lines().find(|line| line.starts_with("preferred law: ")).unwrap_or_else(|| panic!("{said}")).to_owned()
    };
    let after = |line: &str, name: &str| -> f64 {
        let (_, rest) = line.split_once(name).unwrap_or_else(|| panic!("{name} in {line}"));
        rest.trim_start_matches('(').split_whitespace().next().unwrap().replace('−', "-").parse().unwrap()
    };
    let power = |s: f64| 0.3 * (s / 400.0).powf(2.3);
    let line = law(rows(&power));
    let (force, reference, exponent) = (after(&line, "F_ref = "), after(&line, "ω_ref = "), after(&line, "p = "));
    for s in speeds_rad_s {
        assert!((force * (s / reference).powf(exponent) / power(s) - 1.0).abs() < 2e-3, "{line}");
    }
    let shifted = |s: f64| 0.5 + 3e-6 * s * s;
    let line = law(rows(&shifted));
    let intercept = after(&line, "F₀ = ");
    let (constant, _) = quoted_after(&line, ", C = ");
    for s in speeds_rad_s {
        assert!(((intercept + constant * s * s) / shifted(s) - 1.0).abs() < 2e-3, "{line}");
    }
}

#[test]
fn every_printed_plus_minus_is_k_2() {
    let Identified { folder: _folder, out, .. } = identified(&[]);
    let sound = out.parent().unwrap().join("load1/trial0.wav");
    let speed =
        |more: &[&str]| hovertone(&[&["speed", "--vehicle", "ardrone", text(&sound)], more].concat()).ends_with(0);
    let std = number(&speed(&["--json"]).json_lines()[0], "/combined_std_uncertainty_rev_s");
    let table = speed(&[]).stdout;
    assert!(table.lines().next().unwrap().contains("± (k = 2)"), "{table}");
    let row = table.lines().find(|line| line.contains("trial0.wav")).unwrap();
    let cells: Vec<&str> = row.split_whitespace().collect();
    assert_rounded(cells[3].parse().unwrap(), 2.0 * std, "speed");

    let results = out.join("results.json");
    let weigh = ["weigh", text(&sound), "--constant", text(&results)];
    let weighed: Value =
        serde_json::from_str(&hovertone(&[&weigh[..], &["--json"]].concat()).ends_with(0).stdout).unwrap();
    let words = hovertone(&weigh).ends_with(0).stdout;
    for (name, pointer) in
        [("mass as flown: ", "/mass_kg/std_uncertainty"), ("payload: ", "/payload_kg/std_uncertainty")]
    {
        let line = words.lines().find(|line| line.starts_with(name)).unwrap();
        let (_, plus_minus) = line.split_once(" ± ").unwrap();
        let grams: f64 = plus_minus.split_whitespace().next().unwrap().parse().unwrap();
        assert_rounded(grams, 2000.0 * number(&weighed, pointer), line);
        assert!(line.ends_with("(k = 2)"), "{line}");
    }
    let table = out.parent().unwrap().join("stand.csv");
    fs::write(&table, GROUPS.lines().take(5).collect::<Vec<_>>().join("\n")).unwrap();
    let said = hovertone(&["fit", text(&table)]).ends_with(0).stdout;
    let fit = hovertone(&["fit", text(&table), "--json"]).ends_with(0).json_lines().remove(0);
    let line = said.lines().find(|line| line.starts_with("C_f, one rotor")).unwrap();
    let (_, plus_minus) = quoted_after(line, "C_f, one rotor = ");
    assert_rounded(plus_minus, 2.0 * number(&fit, "/thrust_constant_per_rotor_n_s2/std_uncertainty"), line);
    assert!(line.ends_with("(k = 2)"), "{line}");
}

/// The page on the budget begins with the command of a plan and the share that it prints.
#[test]
fn the_page_on_the_budget_quotes_the_plan() {
    let page = fs::read_to_string(repository().join("docs/budget.md")).unwrap();
    let (_, rest) = page.split_once("`hovertone fit --plan ").unwrap();
    let (flags, rest) = rest.split_once('`').unwrap();
    let (_, quoted) = rest.split_once("expects ").unwrap();
    let (quoted, _) = quoted.split_once(" %").unwrap();
    let arguments: Vec<&str> = ["fit", "--plan", "--json"].into_iter().chain(flags.split(' ')).collect();
    let plan: Value = serde_json::from_str(&hovertone(&arguments).ends_with(0).stdout).unwrap();
    assert_eq!(format!("{:.1}", 100.0 * number(&plan, "/expanded_share")), quoted);
}
