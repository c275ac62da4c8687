//! Exports that load, and models that are changed in place.

use crate::testkit::{Run, hovertone, refused_with, text};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const IRIS: &str = "<?xml version=\"1.0\" ?>\n<!-- my model, from PX4 -->\n<sdf version='1.6'>\n  <model name='iris'>\n    \
                    <link name='base_link'>\n      <inertial><mass>1.5</mass></inertial>\n    </link>\n    \
                    <plugin name='front_right' filename='libgazebo_motor_model.so'>\n      \
                    <motorConstant>5.84e-06</motorConstant> <!-- theirs -->\n      <momentConstant>0.06</momentConstant>\n    \
                    </plugin>\n  </model>\n</sdf>\n";

/// Results of a fit, for an export.
fn write_results(folder: &Path) -> std::path::PathBuf {
    let (table, results) = (folder.join("stand.csv"), folder.join("results.json"));
    fs::write(&table, "rpm,thrust_n\n3000,0.70\n3600,1.00\n4200,1.38\n5000,1.94\n").unwrap();
    let fitted = hovertone(&["fit", "--json", "--diameter-m", "0.2", text(&table)]).ends_with(0);
    fs::write(&results, fitted.stdout).unwrap();
    results
}

fn export(results: &Path, words: &[&str]) -> Run {
    hovertone(&[&["export", text(results)], words].concat())
}

#[test]
fn the_diameter_of_an_export_may_have_a_unit() {
    let folder = tempfile::tempdir().unwrap();
    let results = write_results(folder.path());
    let airsim =
        |diameter: &str| export(&results, &["--to", "airsim", "--air-density-kg-m3", "1.2", "--diameter-m", diameter]);
    assert_eq!(airsim("8in").ends_with(0).stdout, airsim("0.2032").ends_with(0).stdout);
}

#[test]
fn facts_that_a_format_does_not_hold_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let results = write_results(folder.path());
    for (words, is_used) in [
        (["--to", "gazebo", "--hover-command", "0.5"], false),
        (["--to", "rotorpy", "--hover-command", "0.5"], false),
        (["--to", "gazebo", "--torque-constant-n-m-s2", "1e-8"], true),
        (["--to", "json", "--torque-constant-n-m-s2", "1e-8"], true),
    ] {
        let said = export(&results, &words).ends_with(0).stderr;
        assert_eq!(said.contains(&format!("{} changes nothing", words[2])), !is_used, "{words:?}: {said}");
    }
}

/// The model with its torque constant, and without.
fn models_with_and_without_torque(folder: &Path) -> (PathBuf, PathBuf) {
    let (model, bare) = (folder.join("iris.sdf"), folder.join("bare.sdf"));
    fs::write(&model, IRIS).unwrap();
    fs::write(&bare, IRIS.replace("<momentConstant>0.06</momentConstant>", "")).unwrap();
    (model, bare)
}

#[test]
fn facts_that_a_model_does_not_hold_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let results = write_results(folder.path());
    let (model, bare) = models_with_and_without_torque(folder.path());
    for (model, flag, value, is_used) in [
        (&model, "--torque-constant-n-m-s2", "1e-8", true),
        (&bare, "--torque-constant-n-m-s2", "1e-8", false),
        (&bare, "--hover-command", "0.5", false),
        (&bare, "--diameter-m", "0.2", false),
        (&bare, "--air-density-kg-m3", "1.2", false),
    ] {
        let copy = folder.path().join(format!("{}.sdf", flag.trim_start_matches('-')));
        let words = ["--into", text(model), flag, value, "--force", "-o", text(&copy)];
        let said = export(&results, &words).ends_with(0).stderr;
        assert_eq!(said.contains(&format!("{flag} changes nothing")), !is_used, "{words:?}: {said}");
    }
}

/// A number that is not there, and one that is there already, are two different things.
#[test]
fn a_number_that_a_model_has_already_is_said_to_be_there() {
    let folder = tempfile::tempdir().unwrap();
    let results = write_results(folder.path());
    let (model, bare) = models_with_and_without_torque(folder.path());
    let torque = ["--torque-constant-n-m-s2", "1e-8"];
    let (there, absent) = ("this model has the same number already", "this model has no number for it");
    let first = export(&results, &[&["--into", text(&model)], &torque[..]].concat()).ends_with(0);
    assert!(!first.stderr.contains("changes nothing"), "{}", first.stderr);
    let again = export(&results, &[&["--into", text(&model)], &torque[..]].concat()).ends_with(0);
    assert!(again.stderr.contains(there) && !again.stderr.contains(absent), "{}", again.stderr);
    let without = export(&results, &[&["--into", text(&bare)], &torque[..]].concat()).ends_with(0);
    assert!(without.stderr.contains(absent) && !without.stderr.contains(there), "{}", without.stderr);
}

/// A format without a place for a number: the advice names the formats that have one, or the other number that C_T needs.
#[test]
fn a_number_without_a_place_is_told_a_format_that_has_one() {
    let folder = tempfile::tempdir().unwrap();
    let results = write_results(folder.path());
    let said = |words: &[&str]| export(&results, words).ends_with(0).stderr;
    let command = said(&["--to", "json", "--hover-command", "0.5"]);
    assert!(command.contains("--hover-command changes nothing: the thrust in a hover needs the mass"), "{command}");
    let density = said(&["--to", "flightmare", "--air-density-kg-m3", "1.2"]);
    assert!(!density.contains("changes nothing"), "the results have the diameter: {density}");
    let bare = folder.path().join("bare.csv");
    fs::write(&bare, "rpm,thrust_n\n3000,0.70\n3600,1.00\n4200,1.38\n5000,1.94\n").unwrap();
    let without_diameter = folder.path().join("bare.json");
    fs::write(&without_diameter, hovertone(&["fit", "--json", text(&bare)]).ends_with(0).stdout).unwrap();
    let said = |words: &[&str]| export(&without_diameter, words).ends_with(0).stderr;
    let diameter = said(&["--to", "flightmare", "--diameter-m", "0.2"]);
    assert!(diameter.contains("give --air-density-kg-m3 too"), "{diameter}");
    let density = said(&["--to", "flightmare", "--air-density-kg-m3", "1.2"]);
    assert!(density.contains("C_T needs the diameter of the propellers too"), "{density}");
    assert!(density.contains("give --diameter-m too, or leave --air-density-kg-m3 out"), "{density}");
}

#[test]
fn a_constant_that_is_an_expression_is_said_to_be() {
    let folder = tempfile::tempdir().unwrap();
    let results = write_results(folder.path());
    let sdf = IRIS.replace("5.84e-06", "${kf}");
    let urdf = "<robot name='a'><properties kf='${2 * 3e-10}' km='1e-12' /></robot>";
    let xacro = "<robot><xacro:property name='motor_constant' value='${kf}' /></robot>";
    for (name, content) in [("a.sdf", sdf.as_str()), ("b.urdf", urdf), ("c.xacro", xacro)] {
        let model = folder.path().join(name);
        fs::write(&model, content).unwrap();
        let (into, compare) =
            (export(&results, &["--into", text(&model)]), hovertone(&["compare", text(&results), text(&model)]));
        for said in [into.ends_with(1).stderr, compare.ends_with(1).stderr] {
            assert!(said.contains("is the expression `${") && said.contains("write the number"), "{said}");
        }
    }
}

#[test]
fn only_the_constant_of_a_model_changes_and_the_difference_is_a_patch() {
    let folder = tempfile::tempdir().unwrap();
    let results = write_results(folder.path());
    let model = folder.path().join("iris.sdf");
    fs::write(&model, IRIS).unwrap();
    let changed = export(&results, &["--into", text(&model)]).ends_with(0);
    let after = fs::read_to_string(&model).unwrap();
    let (start, end) = IRIS.split_once("5.84e-06").unwrap();
    assert!(after.starts_with(start) && after.ends_with(end) && after != IRIS, "{after}");
    for words in ["--- ", "+++ ", "@@ -9 +9 @@", "-      <motorConstant>5.84e-06<", "+      <motorConstant>", "theirs"]
    {
        assert!(changed.stdout.contains(words), "{words}:\n{}", changed.stdout);
    }
    assert!(changed.stderr.contains("written: "), "{}", changed.stderr);
    let patch = folder.path().join("change.patch");
    fs::write(&patch, &changed.stdout).unwrap();
    match Command::new("patch").arg("-R").args([&model, &patch]).output() {
        Ok(output) => {
            assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stdout));
            assert_eq!(fs::read_to_string(&model).unwrap(), IRIS);
        }
        Err(_) => println!("skipped: no `patch`"),
    }
    fs::write(&model, IRIS.replace("theirs", "5.84e-6 is the maker's")).unwrap();
    let said = export(&results, &["--into", text(&model), "-o", text(&folder.path().join("copy.sdf"))]).ends_with(0);
    assert!(!said.stderr.contains("old number"), "a line that is changed is shown: {}", said.stderr);
    fs::write(&model, IRIS.replace("from PX4", "from PX4: 5.84e-6")).unwrap();
    let said = export(&results, &["--into", text(&model)]).ends_with(0);
    assert!(
        said.stderr.contains("line 2 still has the old number: --into does not change comments"),
        "{}",
        said.stderr
    );
    let twice = IRIS.replace("from PX4", "from PX4: 5.84e-6");
    fs::write(&model, twice.trim_end().to_owned() + "\n<!-- 5.84e-6, measured in May -->\n").unwrap();
    let (said, last) = (export(&results, &["--into", text(&model)]).ends_with(0), twice.trim_end().lines().count() + 1);
    assert!(said.stderr.contains(&format!("lines 2 and {last} still have the old number")), "{}", said.stderr);
    fs::write(&model, twice).unwrap();
    export(&results, &["--into", text(&model)]).ends_with(0);
    fs::write(&model, &after).unwrap();
    let again = export(&results, &["--into", text(&model)]).ends_with(0);
    assert!(again.stdout.is_empty() && again.stderr.contains("nothing to change"), "{}", again.stderr);
    let compared = hovertone(&["compare", text(&results), text(&model), "--json"]).ends_with(0).json_lines().remove(0);
    assert!((compared["over_heard"].as_f64().unwrap() - 1.0).abs() < 1e-6, "{compared}");
}

/// Ends of lines stay as they are, CR LF too, and the difference is a patch in both directions; also where the last line has no end.
#[test]
fn the_difference_of_a_model_with_other_ends_of_lines_is_a_patch() {
    let folder = tempfile::tempdir().unwrap();
    let results = write_results(folder.path());
    let model = folder.path().join("iris.sdf");
    let on_one_line = IRIS.replace('\n', " ");
    for original in [IRIS.replace('\n', "\r\n"), IRIS.trim_end().to_owned(), on_one_line.trim_end().to_owned()] {
        fs::write(&model, &original).unwrap();
        let changed = export(&results, &["--into", text(&model)]).ends_with(0);
        let after = fs::read_to_string(&model).unwrap();
        assert!(after != original && after.matches("\r\n").count() == original.matches("\r\n").count(), "{after:?}");
        assert_eq!(after.matches('\n').count(), original.matches('\n').count());
        let patch = folder.path().join("change.patch");
        fs::write(&patch, &changed.stdout).unwrap();
        for (direction, expected) in [("--reverse", &original), ("--forward", &after)] {
            let run = Command::new("patch").args(["--fuzz=0", direction]).args([&model, &patch]).output();
            let Ok(run) = run else {
                println!("skipped: no `patch`");
                return;
            };
            assert!(run.status.success(), "{direction}: {}", String::from_utf8_lossy(&run.stdout));
            assert_eq!(&fs::read_to_string(&model).unwrap(), expected, "{direction}");
        }
    }
}

#[test]
fn a_changed_model_goes_elsewhere_by_the_rules_of_outputs() {
    let folder = tempfile::tempdir().unwrap();
    let results = write_results(folder.path());
    let (model, other) = (folder.path().join("iris.sdf"), folder.path().join("other.sdf"));
    fs::write(&model, IRIS).unwrap();
    let into = ["--into", text(&model), "-o", text(&other)];
    export(&results, &into).ends_with(0);
    assert_eq!(fs::read_to_string(&model).unwrap(), IRIS);
    assert!(fs::read_to_string(&other).unwrap().contains("theirs"));
    assert!(export(&results, &into).ends_with(2).stderr.contains("--force"));
    export(&results, &[&into[..], &["--force"]].concat()).ends_with(0);
    for place in [&model, &results] {
        let refused = export(&results, &["--into", text(&model), "-o", text(place), "--force"]).ends_with(2);
        assert!(refused.stderr.contains("same name as an input"), "{}", refused.stderr);
    }
    assert_eq!(fs::read_to_string(&model).unwrap(), IRIS);
    let results = text(&results);
    assert!(hovertone(&["export", results, "--into", results]).ends_with(1).stderr.contains("no model of a simulator"));
    let torque = ["--torque-constant-n-m-s2", "5"];
    refused_with(
        &[&["export", results, "--to", "gazebo"], &torque[..]].concat(),
        &[" m, and for every", "is less than 1 m"],
    );
    let both = hovertone(&["export", results, "--to", "gazebo", "--into", text(&model)]).ends_with(2);
    assert!(both.stderr.contains("cannot be used with"), "{}", both.stderr);
    fs::write(&model, IRIS.replace("5.84e-06", "${motor_constant}")).unwrap();
    assert!(hovertone(&["export", results, "--into", text(&model)]).ends_with(1).stderr.contains("expression"));
}

#[test]
fn exports_of_xml_have_one_root() {
    let folder = tempfile::tempdir().unwrap();
    let results = write_results(folder.path());
    for (format, root) in [("gazebo", "sdf"), ("px4", "sdf"), ("rotors", "robot"), ("gym-pybullet-drones", "robot")] {
        let text = export(&results, &["--to", format]).ends_with(0).stdout;
        let document = roxmltree::Document::parse(&text).unwrap_or_else(|error| panic!("{format}: {error}\n{text}"));
        assert_eq!(document.root_element().tag_name().name(), root);
    }
}

#[test]
fn a_constant_that_changes_by_more_than_a_factor_of_two_is_asked_about() {
    let folder = tempfile::tempdir().unwrap();
    let results = write_results(folder.path());
    let model = folder.path().join("iris.sdf");
    let said = |constant: &str| {
        fs::write(&model, IRIS.replace("5.84e-06", constant)).unwrap();
        export(&results, &["--into", text(&model)]).ends_with(0).stderr
    };
    assert!(!said("5.84e-06").contains("times the old constant"));
    let words =
        "times the old constant of the model (hint: check that the results and the model belong to the same vehicle";
    assert!(said("5.84e-08").contains(words));
}

#[test]
fn a_web_page_in_place_of_a_model_is_called_one() {
    let folder = tempfile::tempdir().unwrap();
    let results = write_results(folder.path());
    let page = folder.path().join("page.html");
    fs::write(&page, "<!DOCTYPE html>\n<html><br><pre>&lt;motorConstant></pre> motor_constant\n").unwrap();
    let (into, compare) =
        (export(&results, &["--into", text(&page)]), hovertone(&["compare", text(&results), text(&page)]));
    for said in [into.ends_with(1).stderr, compare.ends_with(1).stderr] {
        assert!(said.contains("this is a web page, and no model of a simulator (hint: give the file"), "{said}");
    }
}
