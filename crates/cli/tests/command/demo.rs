//! `hovertone demo`: the whole way, with the truth known.

#[cfg(unix)]
use crate::sigint;
use crate::testkit::{hovertone, hovertone_with, text};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;

/// Largest error of the constant, in every load by both methods.
const ERROR_SHARE_MAX: f64 = 0.005;
/// Largest page of the demo, with the sound of all recordings.
const PAGE_BYTES_MAX: usize = 4_000_000;

#[test]
#[ignore = "exam: a minute of doublets, heard and identified"]
fn the_low_level_model_flies_like_the_true_one() {
    let folder = tempfile::tempdir().unwrap();
    let demo = folder.path().join("low");
    let run = hovertone(&["demo", "--low-level", "-o", text(&demo), "--no-progress"]).ends_with(0);
    for words in ["equation 1", "k_p", "not used for the fit", "Identified beside the truth", "C_τ of one rotor"] {
        assert!(run.stdout.contains(words), "{words}:\n{}", run.stdout);
    }
    let results: Value = serde_json::from_str(&fs::read_to_string(demo.join("results.json")).unwrap()).unwrap();
    assert!(results["check"]["rms_share"].as_f64().unwrap() < 0.005, "{}", results["check"]);
    let page = fs::read_to_string(demo.join("report.html")).unwrap();
    assert!(page.contains("<svg") && page.contains("Identified beside the truth") && page.len() < PAGE_BYTES_MAX);
    let identified = demo.join("identified.toml");
    hovertone(&["simulate", text(&identified), "-o", text(&folder.path().join("flown")), "--no-progress"]).ends_with(0);
    // the folder belongs to another demo
    assert_eq!(hovertone(&["demo", "-o", text(&demo), "--no-progress"]).code, 2);
}

/// A demo that has run to its end with seed 1. It takes half a minute of two processors, so that all tests share one.
pub(crate) struct FinishedDemo {
    /// Its folder, which nobody changes.
    pub(crate) folder: PathBuf,
    stdout: String,
}

pub(crate) fn finished_demo() -> &'static FinishedDemo {
    static DEMO: OnceLock<FinishedDemo> = OnceLock::new();
    DEMO.get_or_init(|| {
        let around = Path::new(env!("CARGO_TARGET_TMPDIR")).join("finished-demo");
        if around.exists() {
            fs::remove_dir_all(&around).unwrap();
        }
        fs::create_dir(&around).unwrap();
        let stdout = hovertone_with(&["demo"], |command| command.current_dir(&around)).ends_with(0).stdout;
        FinishedDemo { folder: around.join("demo"), stdout }
    })
}

#[test]
#[ignore = "exam: fifteen flights, identified twice"]
fn both_methods_find_the_truth_in_every_load() {
    let FinishedDemo { folder: demo, stdout } = finished_demo();
    for words in ["table 1", "table 2", "paper", "truth", "3610.3", "2.8903", "seed 1"] {
        assert!(stdout.contains(words), "{words}:\n{stdout}");
    }
    let results = fs::read_to_string(demo.join("results.json")).unwrap();
    let parsed: Value = serde_json::from_str(&results).unwrap();
    let truths = truth_of_loads(demo);
    for method in ["maximum_trace", "gaussian"] {
        let loads = parsed["methods"][method]["loads"].as_array().unwrap();
        assert_eq!(loads.len(), 3);
        for load in loads {
            let (name, mass_kg) = (load["name"].as_str().unwrap(), load["mass_kg"].as_f64().unwrap());
            let truth = 4.0 * mass_kg * 9.80 / truths[name];
            let value = load["thrust_constant_total_n_s2"]["value"].as_f64().unwrap();
            assert!((value / truth - 1.0).abs() < ERROR_SHARE_MAX, "{method}, {name}: {value}, truth {truth}");
        }
    }
    let page = fs::read_to_string(demo.join("report.html")).unwrap();
    assert!(page.len() < PAGE_BYTES_MAX, "{} bytes", page.len());
    assert_eq!(page.matches("src=\"data:audio/ogg").count(), 15);
    // what the demo wrote is an experiment like any other
    let experiment = demo.join("experiment.toml");
    let identified = hovertone(&["identify", text(&experiment), "--json"]).ends_with(0).stdout;
    assert_eq!(identified, results);
}

#[test]
#[ignore = "exam: three demos"]
fn a_seed_repeats_to_the_byte() {
    let FinishedDemo { folder: first, stdout } = finished_demo();
    let folder = tempfile::tempdir().unwrap();
    let second = folder.path().join("demo");
    let read = |demo: &Path, name: &str| fs::read(demo.join(name)).unwrap();
    // a demo of another seed, which was interrupted
    #[cfg(unix)]
    {
        let arguments = ["demo", "-o", text(&second), "--seed", "2", "--no-progress"];
        let mut begun = sigint::begun(&arguments, |command| command);
        sigint::wait_for_writing(&mut begun, &second.join("big_hull"));
        assert!(sigint::interrupted(begun).0);
        sigint::assert_whole(&second);
        assert_ne!(read(&second, "no_hull/trial_1.wav"), read(first, "no_hull/trial_1.wav"));
    }
    // it can simply be run again
    hovertone(&["demo", "-o", text(&second), "--seed", "2"]).ends_with(0);
    assert_ne!(read(&second, "results.json"), read(first, "results.json"));
    // the seed of the first, over an earlier demo
    let again = hovertone_with(&["demo", "--seed", "1"], |command| command.current_dir(folder.path())).ends_with(0);
    assert_eq!(&again.stdout, stdout);
    for name in
        ["results.json", "samples.csv", "truth.csv", "truth_tracks.csv", "experiment.toml", "no_hull/trial_1.wav"]
    {
        assert_eq!(read(first, name), read(&second, name), "{name}");
    }
}

/// Mean over the trials of each load of the mean of Σω², from the file.
fn truth_of_loads(folder: &Path) -> BTreeMap<String, f64> {
    let mut table = csv::Reader::from_path(folder.join("truth.csv")).unwrap();
    let head = table.headers().unwrap().clone();
    let column = |name: &str| head.iter().position(|known| known == name).unwrap();
    let (load, squares) = (column("load"), column("mean_sum_of_squares_rad2_s2"));
    let mut of_loads: BTreeMap<String, Vec<f64>> = BTreeMap::new();
    for row in table.records() {
        let row = row.unwrap();
        of_loads.entry(row[load].to_owned()).or_default().push(row[squares].parse().unwrap());
    }
    assert!(of_loads.len() == 3 && of_loads.values().all(|trials| trials.len() == 5), "{of_loads:?}");
    of_loads.into_iter().map(|(name, trials)| (name, trials.iter().sum::<f64>() / 5.0)).collect()
}

#[test]
fn a_folder_that_is_no_demo_is_left_alone() {
    let folder = tempfile::tempdir().unwrap();
    fs::write(folder.path().join("thesis.txt"), "precious").unwrap();
    let run = hovertone(&["demo", "-o", text(folder.path())]).ends_with(2);
    assert!(
        run.stderr.contains("has files that do not come from an earlier run") && run.stderr.contains("-o DIR"),
        "{}",
        run.stderr
    );
    fs::write(folder.path().join("experiment.toml"), "[vehicle]\npreset = \"ardrone\"\n").unwrap();
    hovertone(&["demo", "-o", text(folder.path())]).ends_with(2);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
}
