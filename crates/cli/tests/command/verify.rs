//! `hovertone verify`: sound of a simulated flight against a log of it.

use crate::testkit::{flown_hover, hovertone, recordings, refused_with, text, write_steady_hover_and_log};
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

pub(crate) const OFFSET_S: f64 = -12.34;

/// A log of the flight, with every so many rows of the truth, on a clock of its own; the speeds are rounded to 1 rpm and multiplied.
pub(crate) fn write_log(flown: &Path, path: &Path, every: usize, factor: f64) {
    let mut truth = csv::Reader::from_path(flown.join("truth.csv")).unwrap();
    let headers = truth.headers().unwrap().clone();
    let place = |name: &str| headers.iter().position(|header| header == name).unwrap();
    let places = [1, 2, 3, 4].map(|rotor| place(&format!("speed_{rotor}_rad_s")));
    let mut log = String::from("time_s,rotor1_rpm,rotor2_rpm,rotor3_rpm,rotor4_rpm\n");
    for row in truth.records().step_by(every) {
        let row = row.unwrap();
        let value = |at: usize| row[at].parse::<f64>().unwrap();
        write!(log, "{:.3}", value(place("time_s")) - OFFSET_S).unwrap();
        for at in places {
            write!(log, ",{:.0}", factor * value(at) * 60.0 / std::f64::consts::TAU).unwrap();
        }
        log += "\n";
    }
    fs::write(path, log).unwrap();
}

#[test]
fn a_flight_agrees_with_its_log_and_a_wrong_order_does_not() {
    let folder = tempfile::tempdir().unwrap();
    let (file, _) = flown_hover(folder.path(), 5, 12.0, 0.02);
    let vehicle = file.vehicle.preset.as_str();
    let flown = folder.path().join("flown");
    let (right, half) = (folder.path().join("right.csv"), folder.path().join("half.csv"));
    write_log(&flown, &right, 10, 1.0);
    write_log(&flown, &half, 10, 0.5);
    let sound = fs::read_dir(&flown).unwrap().map(|entry| entry.unwrap().path());
    let sound = sound.into_iter().find(|path| path.extension().is_some_and(|ending| ending == "wav")).unwrap();
    let asked = ["verify", text(&sound), text(&right), "--vehicle", vehicle];
    let line = hovertone(&[&asked[..], &["--json"]].concat()).ends_with(0).json_lines().remove(0);
    assert_eq!(line["status"], "passed");
    // the sound takes some ms to the microphone
    assert!((line["offset_s"].as_f64().unwrap() - OFFSET_S).abs() < 0.05 && line["is_offset_told"] == true, "{line}");
    let rotors = line["rotors"].as_array().unwrap();
    assert!(rotors.len() >= 3, "{line}");
    for rotor in rotors {
        assert!(rotor["bias_rev_s"].as_f64().unwrap().abs() < 0.1, "{rotor}");
        assert!(rotor["scatter_rev_s"].as_f64().unwrap() < 0.5, "{rotor}");
    }
    // one tone for all rotors: its ± has their spread
    let of_mean = hovertone(&[&asked[..], &["--mean-only", "--json"]].concat()).ends_with(0).json_lines().remove(0);
    let rotor = &of_mean["rotors"][0];
    assert!(rotor["coverage"].as_f64().unwrap() > 0.9 && of_mean["rotors"].as_array().unwrap().len() == 1, "{of_mean}");
    let figure = folder.path().join("check.svg");
    let drawn = hovertone(&[&asked[..], &["--figure", text(&figure)]].concat()).ends_with(0);
    assert!(drawn.stdout.contains(
        "passed: the number of blades (or the gear) is right, and the clock of the recorder is right within 0.5 %"
    ));
    assert!(fs::read_to_string(&figure).unwrap().contains("difference rotor-1"));
    let refused = |figure: &str, words: &[&str]| refused_with(&[&asked[..], &["--figure", figure]].concat(), words);
    refused("check.gif", &["must end with .png or .svg"]);
    refused(text(&figure), &["exists already"]);
    let wrong = hovertone(&["verify", text(&sound), text(&half), "--vehicle", vehicle]).ends_with(3);
    assert!(wrong.stdout.contains("failed: the heard speeds are 2.00 times the logged speeds"), "{}", wrong.stdout);
    let electrical = folder.path().join("erpm.csv");
    write_log(&flown, &electrical, 10, 7.0);
    let pairs = hovertone(&["verify", text(&sound), text(&electrical), "--vehicle", vehicle]).ends_with(3);
    assert!(pairs.stdout.contains("electrical speeds of motors with 7 pole pairs"), "{}", pairs.stdout);
    // hundreds of electrical rpm, as Betaflight writes them
    write_log(&flown, &electrical, 10, 0.07);
    let csv = fs::read_to_string(&electrical).unwrap();
    let headers = [1, 2, 3, 4].map(|rotor| (format!("rotor{rotor}_rpm"), format!("eRPM[{}]", rotor - 1)));
    fs::write(&electrical, headers.iter().fold(csv, |csv, (name, header)| csv.replace(name, header))).unwrap();
    let asked_electrical = ["verify", text(&sound), text(&electrical), "--vehicle", vehicle, "--json"];
    let refused = hovertone(&asked_electrical).ends_with(1).stderr;
    assert!(refused.contains("have electrical speeds"), "{refused}");
    let names = [1, 2, 3, 4].map(|rotor| format!("eRPM[{}]=rotor{rotor}_erpm100_14_poles", rotor - 1));
    let columns: Vec<&str> = names.iter().flat_map(|name| ["--column", name]).collect();
    let line = hovertone(&[&asked_electrical[..], &columns].concat()).json_lines().remove(0);
    assert!((line["speed_ratio"].as_f64().unwrap() - 1.0).abs() < 0.005, "{line}");
    let in_rev_s = folder.path().join("rev_s.csv");
    write_log(&flown, &in_rev_s, 10, 1.0 / 60.0);
    let unit = hovertone(&["verify", text(&sound), text(&in_rev_s), "--vehicle", vehicle]).ends_with(3);
    assert!(
        unit.stdout.contains("times the logged speeds: the log seems to hold rev/s, but is read as rpm"),
        "{}",
        unit.stdout
    );
}

/// Equal means are no pass where the clock is wrong, or where the log is of another flight.
#[test]
fn a_wrong_offset_and_another_flight_do_not_pass() {
    let folder = tempfile::tempdir().unwrap();
    let (file, _) = flown_hover(folder.path(), 5, 12.0, 0.02);
    let vehicle = file.vehicle.preset.as_str();
    let flown = folder.path().join("flown");
    let log = folder.path().join("log.csv");
    write_log(&flown, &log, 10, 1.0);
    let sound = flown.join("sound.wav");
    let asked = ["verify", text(&sound), text(&log), "--vehicle", vehicle];
    let limits = format!("--log-offset-s={}:{}", OFFSET_S + 0.09, OFFSET_S + 2.0);
    let run = hovertone(&[&asked[..], &[&limits]].concat()).ends_with(3);
    assert!(run.stdout.contains("not decided: the log fits better at an offset near −12.3"), "{}", run.stdout);
    assert!(run.stdout.contains("give wider limits"), "{}", run.stdout);
    // far from the right offset, the log is as good as that of another flight
    let limits = format!("--log-offset-s={}:{}", OFFSET_S + 3.0, OFFSET_S + 3.2);
    let run = hovertone(&[&asked[..], &[&limits, "--json"]].concat()).ends_with(3);
    let line = run.json_lines().remove(0);
    assert!(line["status"] == "not_decided" && line["coverage"].as_f64().unwrap() < 0.68, "{line}");
}

/// Steady speeds agree with the log of any flight: only a given offset shows that it is this one.
#[test]
fn steady_speeds_do_not_show_whose_log_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let (sound, log) = write_steady_hover_and_log(folder.path());
    let asked = ["verify", text(&sound), text(&log), "--vehicle", "ardrone", "--mean-only"];
    let run = hovertone(&asked).ends_with(3);
    for words in
        ["not decided: ", "nothing shows which offset of the log is right", "another flight", "--log-offset-s LOW:HIGH"]
    {
        assert!(run.stdout.contains(words), "{words}: {}", run.stdout);
    }
    let line = hovertone(&[&asked[..], &["--json"]].concat()).ends_with(3).json_lines().remove(0);
    assert!(line["status"] == "not_decided" && line["is_offset_told"] == false, "{line}");
    let run = hovertone(&[&asked[..], &["--log-offset-s=-0.2:0.2"]].concat()).ends_with(0);
    assert!(
        run.stdout.contains(
            "passed: the number of blades (or the gear) is right, and the clock of the recorder is right within 0.5 %"
        ),
        "{}",
        run.stdout
    );
}

/// The table names what is compared, so the warning about rotors that are not separated does not advise --mean-only.
#[test]
fn rotors_that_are_not_separated_are_compared_without_another_flag() {
    let folder = tempfile::tempdir().unwrap();
    let (sound, log) = write_steady_hover_and_log(folder.path());
    let asked = ["verify", text(&sound), text(&log), "--vehicle", "ardrone", "--log-offset-s=-0.2:0.2"];
    let run = hovertone(&asked).ends_with(0);
    assert!(run.stdout.contains("all    mean of all motors"), "{}", run.stdout);
    assert!(
        run.stderr.contains("only their mean speed is known") && !run.stderr.contains("--mean-only"),
        "{}",
        run.stderr
    );
}

#[test]
fn a_pattern_of_several_recordings_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let (pattern, log) = (folder.path().join("*.wav"), folder.path().join("log.csv"));
    fs::write(&log, "time_s,rotor1_rpm\n0,4000\n1,4100\n2,4200\n").unwrap();
    crate::testkit::write_noise(&folder.path().join("first.wav"), 5.0);
    let asked = ["verify", text(&pattern), text(&log), "--blades", "2"];
    assert!(hovertone(&asked).ends_with(3).stderr.contains("nothing was compared"));
    crate::testkit::write_noise(&folder.path().join("second.wav"), 2.0);
    refused_with(
        &asked,
        &["the log belongs to one flight, but 2 recordings match the name", "give the recording of this flight"],
    );
}

#[test]
fn nothing_to_compare_ends_with_a_sentence() {
    let folder = tempfile::tempdir().unwrap();
    let noise = folder.path().join("noise.wav");
    crate::testkit::write_noise(&noise, 5.0);
    let log = folder.path().join("log.csv");
    fs::write(&log, "time_s,rotor1_rpm\n0,4000\n1,4100\n2,4200\n").unwrap();
    let run = hovertone(&["verify", text(&noise), text(&log), "--blades", "2"]).ends_with(3);
    for words in ["no rotor tone: nothing sounds like a rotor", "nothing was compared"] {
        assert_eq!(run.stderr.matches(words).count(), 1, "{words}:\n{}", run.stderr);
    }
    let run = hovertone(&["verify", "nowhere.wav", text(&log), "--blades", "2"]).ends_with(1);
    assert!(run.stderr.lines().count() == 1 && run.stderr.contains("check its name"), "{}", run.stderr);
    let run = hovertone(&["verify", text(&log), text(&noise), "--blades", "2"]).ends_with(1);
    assert!(run.stderr.contains("give the recording first, then the log"), "{}", run.stderr);
    fs::write(&log, "time_s,motor1_pwm\n0,1000\n1,1100\n").unwrap();
    let run = hovertone(&["verify", text(&noise), text(&log), "--blades", "2"]).ends_with(1);
    assert!(run.stderr.contains("no rotor speed in this log"), "{}", run.stderr);
    refused_with(&["verify", text(&noise)], &["verify needs the log of the same flight"]);
}

#[test]
fn several_possible_speeds_name_the_flags_that_decide() {
    let Some(folder) = recordings("small-multirotors") else { return };
    let scratch = tempfile::tempdir().unwrap();
    let log = scratch.path().join("log.csv");
    fs::write(&log, "time_s,rotor1_rpm\n0,5040\n1,5100\n2,5040\n").unwrap();
    let run = hovertone(&["verify", text(&folder.join("DRONE_001.wav")), text(&log)]).ends_with(3);
    let words = "nothing was compared, because several speeds are possible; to find the right speed, count the blades and give --blades N, or \
                 give --vehicle NAME";
    assert!(run.stderr.contains(words) && !run.stderr.contains("no speed was heard"), "{}", run.stderr);
}
