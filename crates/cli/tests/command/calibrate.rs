//! The recorder's clock and the order, against one known speed.

use crate::testkit::{
    Run, hovertone, recordings, refused_with, steady_bench, steady_hover, text, write_hover, write_wav,
};
use hovertone_sim::HoverSettings;
use hovertone_vehicle::RotorSpeed;
use std::fs;
use std::path::Path;

/// One rotor of two blades at a true speed, by a recorder whose clock runs fast by `fast_ppm`: it takes more samples per second than the
/// file says, so that all is heard slower.
fn write_bench(path: &Path, rpm: f64, fast_ppm: f64) {
    let speed = RotorSpeed::from_rpm(rpm / (1.0 + fast_ppm / 1e6));
    let settings = steady_bench("crazyflie", speed, 4.0);
    write_hover(path, HoverSettings { seed: 3, ..settings });
}

fn calibrated(path: &Path, more: &[&str]) -> Run {
    hovertone(&[&["calibrate", text(path), "--tachometer-rpm", "21000", "--known-std-ppm", "5"], more].concat())
}

#[test]
fn a_fast_clock_fails_and_its_correction_passes_everywhere() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("bench.wav");
    write_bench(&sound, 21_000.0, 400.0);
    let failed = calibrated(&sound, &["--vehicle", "crazyflie"]).ends_with(3);
    for words in [
        "blades or gear: pass",
        "clock: fail, it runs fast by",
        "\nresult: fail (clock)\n",
        "--clock-correction-ppm",
        "[recorder]",
    ] {
        assert!(failed.stdout.contains(words), "{words}:\n{}", failed.stdout);
    }
    // the printed correction has no more digits than its ±
    let printed = failed.stdout.split("clock_correction_ppm = ").nth(1).unwrap().lines().next().unwrap();
    let json = calibrated(&sound, &["--vehicle", "crazyflie", "--json"]).ends_with(3).json_lines().remove(0);
    let expanded_ppm = 2.0 * json["clock_correction_std_ppm"].as_f64().unwrap();
    assert_eq!(printed.contains('.'), expanded_ppm < 10.0, "{}", failed.stdout);
    let ppm = json["clock_correction_ppm"].as_f64().unwrap();
    let std_ppm = json["clock_correction_std_ppm"].as_f64().unwrap();
    assert!((ppm - 400.0).abs() < 4.0 * std_ppm && std_ppm < 20.0, "{json}");
    assert_eq!((json["passes"].as_bool(), json["order_that_fits"].as_f64()), (Some(false), Some(2.0)));
    let flag = format!("{ppm:.1}");
    let passed = calibrated(&sound, &["--vehicle", "crazyflie", "--clock-correction-ppm", &flag]).ends_with(0);
    assert!(passed.stdout.ends_with("\nresult: pass\n"), "{}", passed.stdout);
    let flag_ppm: f64 = flag.parse().unwrap();
    let keep = format!("correction of heard speeds: keep --clock-correction-ppm {flag_ppm}, because");
    assert!(passed.stdout.contains(&keep), "{}", passed.stdout);
    // the correction is a flag of every command that hears, and a setting of an experiment
    let rpm = |words: &[&str]| {
        let run =
            hovertone(&[&["speed", "--vehicle", "crazyflie", "--rotors", "1", "--json", text(&sound)], words].concat());
        let line = run.ends_with(0).json_lines().remove(0);
        let corrected_ppm = line["recording"]["clock_correction_ppm"].as_f64().unwrap();
        (line["speed_rpm"].as_f64().unwrap(), corrected_ppm)
    };
    let (corrected, plain) = (rpm(&["--clock-correction-ppm", &flag]), rpm(&[]));
    assert_eq!([corrected.1, plain.1], [flag_ppm, 0.0]);
    let ratio = corrected.0 / plain.0;
    assert!((1e6 * (ratio - 1.0) - ppm).abs() < 1.0, "{ratio}");
    let experiment = folder.path().join("experiment.toml");
    let identified = |recorder: &str| {
        let load = "[[load]]\nname = \"bench\"\nthrust_n = 0.1\nrotors_running = 1\nrecordings = [\"bench.wav\"]\n";
        fs::write(&experiment, format!("[vehicle]\npreset = \"crazyflie\"\n{recorder}{load}")).unwrap();
        let run = hovertone(&["identify", "--json", text(&experiment)]).ends_with(0);
        let results: serde_json::Value = serde_json::from_str(&run.stdout).unwrap();
        results["loads"][0]["speed_rpm"].as_f64().unwrap()
    };
    let ratio = identified(&format!("[recorder]\nclock_correction_ppm = {flag}\n")) / identified("");
    assert!((1e6 * (ratio - 1.0) - ppm).abs() < 1.0, "{ratio}");
    // a flag that replaces the correction of the file is said, and the results hold the one that was used
    let replaced = hovertone(&["identify", "--json", text(&experiment), "--clock-correction-ppm", &flag]).ends_with(0);
    assert!(!replaced.stderr.contains("is used, and clock_correction_ppm"), "{}", replaced.stderr);
    identified("[recorder]\nclock_correction_ppm = 7.0\n");
    let replaced = hovertone(&["identify", "--json", text(&experiment), "--clock-correction-ppm", &flag]).ends_with(0);
    assert!(replaced.stderr.contains("is used, and clock_correction_ppm = 7 of the"), "{}", replaced.stderr);
    let results: serde_json::Value = serde_json::from_str(&replaced.stdout).unwrap();
    let used_ppm = results["settings"]["experiment"]["clock_correction_ppm"].as_f64().unwrap();
    assert_eq!(used_ppm, flag.parse::<f64>().unwrap());
    // without a file: the one that is written has it
    let out = folder.path().join("out");
    let mass = format!("0.03={}", text(&sound));
    let typed =
        ["identify", "--vehicle", "crazyflie", "--mass", &mass, "--clock-correction-ppm", &flag, "-o", text(&out)];
    hovertone(&typed);
    let written = fs::read_to_string(out.join("experiment.toml")).unwrap();
    assert!(written.contains(&format!("[recorder]\nclock_correction_ppm = {flag_ppm} ")), "{written}");
}

#[test]
fn an_order_whose_tone_is_hardly_heard_does_not_pass() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("bench.wav");
    let settings = steady_bench("crazyflie", RotorSpeed::from_rpm(5699.41), 10.0);
    write_hover(&sound, HoverSettings { seed: 3, ..settings });
    let with = |more: &[&str]| {
        let words = ["calibrate", text(&sound), "--rotors", "1", "--tachometer-rpm", "5699.41"];
        hovertone(&[&words[..], more].concat())
    };
    // two blades without a gear; the blades of the vehicle give the right speed, and the mesh of its gear is not there
    let geared = with(&["--vehicle", "ardrone"]).ends_with(3);
    for words in [
        "not decided: the tone at 69 times the rotor speed is missing for ",
        "give --blades 2 alone, in place of the vehicle",
    ] {
        assert!(geared.stderr.contains(words), "{words}:\n{}", geared.stderr);
    }
    assert!(!geared.stdout.contains("pass"), "{}", geared.stdout);
    let json = with(&["--vehicle", "ardrone", "--json"]).ends_with(3).json_lines().remove(0);
    assert_eq!((json["status"].as_str(), json["passes"].as_bool()), (Some("tone_hardly_heard"), None));
    let bladed = with(&["--blades", "2", "--band", "185:195"]).ends_with(0);
    assert!(bladed.stdout.contains("blades or gear: pass, the tone sounds 2 times per turn"), "{}", bladed.stdout);
}

#[test]
fn a_wrong_order_is_named_with_the_one_that_fits() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("bench.wav");
    write_bench(&sound, 21_000.0, 0.0);
    assert!(
        calibrated(&sound, &["--vehicle", "crazyflie"])
            .ends_with(0)
            .stdout
            .contains("blades or gear: pass, the tone sounds 2 times per turn")
    );
    let wrong = calibrated(&sound, &["--order", "1", "--band", "650:750"]).ends_with(3);
    for words in [
        "blades or gear: fail",
        "the tone may sound 2 times per turn of the rotor, not once. If so, give --order 2",
        "the known speed: a tachometer with a wrong number of blades in its settings shows a wrong speed. If this is so, give --tachometer-rpm 42000",
        "--order 2",
        "--band 341",
        "\nresult: fail (blades or gear)\n",
    ] {
        assert!(wrong.stdout.contains(words), "{words}:\n{}", wrong.stdout);
    }
    assert!(!wrong.stdout.contains("\nclock: "), "{}", wrong.stdout);
    // turns per second as if they were per minute
    let slip =
        hovertone(&["calibrate", text(&sound), "--vehicle", "crazyflie", "--tachometer-rpm", "350"]).ends_with(3);
    assert!(
        slip.stdout
            .contains("Does the rotor turn 350 times per second, not per minute? Then give --tachometer-rpm 21000"),
        "{}",
        slip.stdout
    );
    assert!(!slip.stdout.contains("\nclock: "), "{}", slip.stdout);
    let other =
        hovertone(&["calibrate", text(&sound), "--vehicle", "crazyflie", "--tachometer-rpm", "15000"]).ends_with(3);
    assert!(other.stdout.contains("No other number of blades and no gear gives this ratio"), "{}", other.stdout);
}

#[test]
fn a_known_number_of_another_part_is_asked_for() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("bench.wav");
    write_bench(&sound, 21_000.0, 0.0);
    let shaft = hovertone(&["calibrate", text(&sound), "--vehicle", "crazyflie", "--true-hz", "350"]).ends_with(3);
    assert!(
        shaft.stdout.contains("Does the shaft turn 350 times per second? Then give --tachometer-rpm 21000"),
        "{}",
        shaft.stdout
    );
    assert!(!shaft.stdout.contains("\nclock: "), "{}", shaft.stdout);
    // 57.3 rev/s of the rotor, 69/8 times as fast the motor
    let geared = folder.path().join("geared.wav");
    write_hover(&geared, steady_hover("ardrone", RotorSpeed::from_rev_s(57.3), 6.0));
    let motor =
        hovertone(&["calibrate", text(&geared), "--vehicle", "ardrone", "--tachometer-rpm", "29653"]).ends_with(3);
    assert!(
        motor.stdout.contains(
            "the speed of the motor? Then give the speed of the rotor, after the gear 8:69: --tachometer-rpm 3438"
        ),
        "{}",
        motor.stdout
    );
    assert!(!motor.stdout.contains("--order") && !motor.stdout.contains("\nclock: "), "{}", motor.stdout);
}

/// A pure tone as a recorder takes it whose clock runs fast by `fast_ppm`: it counts more samples per second than the file says.
fn write_tone(path: &Path, true_hz: f64, fast_ppm: f64, seconds: u32) {
    let spec = hound::WavSpec {
        channels: 1,
        sample_rate: 44_100,
        bits_per_sample: 16,
        sample_format: hound::SampleFormat::Int,
    };
    let true_rate_hz = 44_100.0 * (1.0 + fast_ppm / 1e6);
    let mut writer = hound::WavWriter::create(path, spec).unwrap();
    for index in 0..seconds * 44_100 {
        let turns = (true_hz * f64::from(index) / true_rate_hz).fract();
        writer.write_sample((4095.0 * (std::f64::consts::TAU * turns).sin()).round() as i16).unwrap();
    }
    writer.finalize().unwrap();
}

#[test]
fn a_tone_of_known_frequency_checks_the_clock_alone_in_both_directions() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tone.wav");
    for (hz, fast_ppm, direction) in [("1000", -200.0, "slow"), ("440", 200.0, "fast"), ("2000", 1500.0, "fast")] {
        write_tone(&path, hz.parse().unwrap(), fast_ppm, 4);
        let off = hovertone(&["calibrate", "--true-hz", hz, text(&path)]).ends_with(3);
        assert!(off.stdout.contains(&format!("clock: fail, it runs {direction} by")), "{hz}:\n{}", off.stdout);
        let json =
            hovertone(&["calibrate", "--true-hz", hz, "--json", text(&path)]).ends_with(3).json_lines().remove(0);
        let of = |name: &str| json[name].as_f64().unwrap();
        assert!((of("clock_correction_ppm") - fast_ppm).abs() < 2.0 * of("clock_correction_std_ppm"), "{json}");
        assert!(off.stdout.contains(&format!("--clock-correction-ppm {fast_ppm:.1}")), "{}", off.stdout);
        // no recorder is that bad: the known frequency is more probably wrong
        let is_doubted = off.stdout.contains("so check the known frequency first");
        assert!(is_doubted == (fast_ppm > 1000.0) || fast_ppm.abs() == 200.0, "{}", off.stdout);
        let corrected = ["calibrate", "--true-hz", hz, text(&path), "--clock-correction-ppm", &fast_ppm.to_string()];
        hovertone(&corrected).ends_with(0);
    }
}

/// No decision about rotors is needed: not whether the tone is hum, nor whether one rotor makes all lines.
#[test]
fn every_pure_tone_calibrates_a_good_clock() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tone.wav");
    for hz in ["50", "100", "440", "880", "1000", "2000", "8000.5"] {
        write_tone(&path, hz.parse().unwrap(), 0.0, 6);
        let json =
            hovertone(&["calibrate", "--true-hz", hz, "--json", text(&path)]).ends_with(0).json_lines().remove(0);
        let (ppm, std_ppm) = (&json["clock_correction_ppm"], &json["clock_correction_std_ppm"]);
        assert!(ppm.as_f64().unwrap().abs() < 0.2 && std_ppm.as_f64().unwrap() < 0.2, "{hz}: {json}");
        let passed = hovertone(&["calibrate", "--true-hz", hz, text(&path)]).ends_with(0);
        // what is within its ± has no direction and no correction
        assert!(
            passed.stdout.contains("clock: pass, its error is ")
                && passed.stdout.contains("correction of heard speeds: none"),
            "{}",
            passed.stdout
        );
    }
    for hz in ["500", "7600"] {
        let none = hovertone(&["calibrate", "--true-hz", hz, text(&path)]).ends_with(3);
        assert!(
            none.stdout.is_empty() && none.stderr.contains("no clear tone that lasts 2 s or more"),
            "{}",
            none.stderr
        );
    }
    let high = hovertone(&["calibrate", "--true-hz", "30000", text(&path)]).ends_with(1);
    assert!(high.stderr.contains("no sound above 22050 Hz"), "{}", high.stderr);
}

#[test]
fn a_wide_uncertainty_decides_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("tone.wav");
    write_tone(&path, 1000.0, 10.0, 4);
    let checked =
        |std_ppm: &str| ["calibrate", "--true-hz", "1000", text(&path), "--known-std-ppm", std_ppm].map(str::to_owned);
    let run = |std_ppm: &str, more: &[&str]| {
        let words = checked(std_ppm);
        hovertone(&[&words.iter().map(String::as_str).collect::<Vec<_>>()[..], more].concat())
    };
    assert!(run("10", &[]).ends_with(0).stdout.contains("clock: pass"));
    let open = run("30", &[]).ends_with(3);
    assert!(
        open.stdout.contains("clock: not decided") && open.stdout.ends_with("\nresult: not decided (clock)\n"),
        "{}",
        open.stdout
    );
    assert!(
        open.stdout.contains("Most of the ± comes from the known frequency: measure it more exactly"),
        "{}",
        open.stdout
    );
    assert!(run("30", &["--json"]).ends_with(3).json_lines()[0]["passes"].is_null());
    run("30", &["--clock-ppm", "80"]).ends_with(0);
}

/// A tachometer reads one rotor.
#[test]
fn several_rotors_are_refused_and_one_is_not_assumed_in_silence() {
    refused_with(
        &["calibrate", "a.wav", "--vehicle", "ardrone", "--tachometer-rpm", "3600", "--rotors", "4"],
        &["--rotors 4: each rotor has its own speed", "one rotor that runs alone, and give --rotors 1"],
    );
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("bench.wav");
    write_bench(&sound, 21_000.0, 0.0);
    let assumed = calibrated(&sound, &["--vehicle", "crazyflie"]).ends_with(0);
    assert!(
        assumed.stderr.contains("the vehicle has 4 rotors, but the known speed belongs to one rotor"),
        "{}",
        assumed.stderr
    );
    let said = calibrated(&sound, &["--vehicle", "crazyflie", "--rotors", "1"]).ends_with(0);
    assert!(!said.stderr.contains("assumed"), "{}", said.stderr);
}

#[test]
fn four_rotors_check_no_clock() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("flight.wav");
    let mut settings = steady_hover("crazyflie", RotorSpeed::from_rpm(21_000.0), 4.0);
    for (rotor, share) in settings.rotors.iter_mut().zip([0.98, 0.995, 1.0, 1.02]) {
        rotor.mean_speed = RotorSpeed::from_rpm(21_000.0 * share);
    }
    write_hover(&sound, settings);
    for said in [&["--blades", "2"][..], &["--vehicle", "crazyflie"], &["--blades", "2", "--band", "690:710"]] {
        let run = calibrated(&sound, said).ends_with(3);
        assert!(
            run.stderr.contains(
                "not decided: the known speed must be that of one steady rotor, but several rotors are heard"
            ) && run.stdout.is_empty(),
            "{}",
            run.stderr
        );
        assert!(
            run.stderr.contains(
                "record one rotor that runs alone, at a steady throttle; on average, the heard speed is about "
            ),
            "{}",
            run.stderr
        );
        let line = calibrated(&sound, &[said, &["--json"]].concat()).ends_with(3).json_lines().remove(0);
        assert_eq!((&line["status"], &line["passes"]), (&"several_rotors".into(), &serde_json::Value::Null));
    }
    let half = ["calibrate", text(&sound), "--vehicle", "crazyflie", "--tachometer-rpm", "10500"];
    let half = hovertone(&half).ends_with(3).stderr;
    assert!(half.contains(" rpm, 2 times the known speed: check the number of blades"), "{half}");
    let slip = ["calibrate", text(&sound), "--vehicle", "crazyflie", "--tachometer-rpm", "350"];
    let slip = hovertone(&slip).ends_with(3).stderr;
    assert!(
        slip.contains("Does the rotor turn 350 times per second, not per minute? Then give --tachometer-rpm 21000"),
        "{slip}"
    );
}

#[test]
fn what_is_no_known_speed_is_refused() {
    refused_with(&["calibrate", "a.wav", "--tachometer-rpm", "fast"], &["--tachometer-rpm fast", "a number is needed"]);
    refused_with(&["calibrate", "a.wav", "--true-hz", "-1"], &["true_hz"]);
    refused_with(&["calibrate", "a.wav", "--true-hz", "1000", "--known-std-ppm", "-1"], &["known_std_ppm = -1"]);
    let run = hovertone(&["calibrate", "a.wav"]).ends_with(2);
    assert!(run.stderr.contains("--tachometer-rpm"), "{}", run.stderr);
    let run = hovertone(&["speed", "a.wav", "--clock-correction-ppm", "90000"]).ends_with(2);
    assert!(run.stderr.contains("-2000 to 2000"), "{}", run.stderr);
}

#[test]
fn a_silent_recording_is_said_to_be_silent() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("silence.wav");
    write_wav(&sound, &[0.0; 96_000], 24_000);
    let run = hovertone(&["calibrate", text(&sound), "--true-hz", "440"]).ends_with(3);
    assert!(run.stderr.contains("silence.wav: the recording is silent; check the microphone."), "{}", run.stderr);
}

/// The advice for a sound with several possible speeds can be followed: it asks for blades where none are given, and names no empty band.
#[test]
fn an_ambiguous_sound_is_answered_with_flags_that_are_not_refused() {
    let Some(real) = recordings("real") else { return };
    let sound = real.join("HELICOPTER_007.flac");
    let said = |more: &[&str]| hovertone(&[&["calibrate", text(&sound)], more].concat()).ends_with(3).stderr;
    let slow = said(&["--blades", "2", "--tachometer-rpm", "100"]);
    assert!(slow.contains("100 rpm, is not one of them") && slow.contains("--tachometer-rpm 6000"), "{slow}");
    assert!(!slow.contains("--band"), "{slow}");
    // 60 × 64.1 is not 3846 in binary fractions
    let slow = said(&["--blades", "2", "--tachometer-rpm", "64.1"]);
    assert!(slow.contains("--tachometer-rpm 3846") && !slow.contains("3845.9"), "{slow}");
    let known = said(&["--blades", "2", "--tachometer-rpm", "4500"]);
    assert!(known.contains("give --band 146:154"), "{known}");
    let followed =
        hovertone(&["calibrate", text(&sound), "--blades", "2", "--tachometer-rpm", "4500", "--band", "146:154"]);
    assert!([0, 3].contains(&followed.code), "{}", followed.stderr);
    let without_blades = said(&["--tachometer-rpm", "6000"]);
    assert!(without_blades.contains("give --blades N") && !without_blades.contains("--band"), "{without_blades}");
}
