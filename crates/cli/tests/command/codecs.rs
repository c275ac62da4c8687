//! Sound that a codec has squeezed: the speed stays right, or is declined.

use crate::identify::{TRUTH_TOTAL_N_S2, write_experiment};
use crate::testkit::{files_in, hovertone, steady_hover, text, write_hover};
use hovertone_sim::HoverSettings;
use hovertone_vehicle::RotorSpeed;
use serde_json::Value;
use std::fs;
use std::process::Command;

const CODECS: [(&str, &[&str]); 6] = [
    ("pcm.wav", &[]),
    ("aac.m4a", &["-ac", "1", "-c:a", "aac", "-b:a", "32k"]),
    ("opus.opus", &["-c:a", "libopus", "-b:a", "32k"]),
    ("opus_speech.opus", &["-c:a", "libopus", "-b:a", "12k", "-application", "voip"]),
    ("mp3.mp3", &["-c:a", "libmp3lame", "-b:a", "32k"]),
    ("slow.wav", &["-ar", "8000"]),
];

#[test]
fn a_codec_at_32_kbit_per_second_does_not_change_the_speed() {
    if Command::new("ffmpeg").arg("-version").output().is_err() {
        println!("skipped: no ffmpeg on the search path");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let whole = folder.path().join("whole.wav");
    let speed = RotorSpeed::from_rev_s(60.17);
    write_hover(&whole, HoverSettings { seed: 7, ..steady_hover("ardrone", speed, 8.0) });
    let (mut heard, mut cuts) = (0, 0);
    for (name, arguments) in CODECS {
        let squeezed = folder.path().join(name);
        let run = Command::new("ffmpeg")
            .args(["-v", "error", "-y", "-i", text(&whole)])
            .args(arguments)
            .arg(&squeezed)
            .output()
            .unwrap();
        if !run.status.success() {
            println!("skipped: this ffmpeg cannot make {name}");
            continue;
        }
        for flags in [&["--gear", "8:69", "--blades", "2"][..], &["--blades", "2"]] {
            let run = hovertone(&[&["speed", "--json", text(&squeezed)], flags].concat());
            let line = &run.json_lines()[0];
            match line["status"].as_str().unwrap() {
                "no_rotor_tone" => continue,
                // this rotor has no lines of the shaft: where the codec takes the gear as well, its octave stays open
                "ambiguous" => {
                    let alternatives = line["alternatives"].as_array().unwrap();
                    let is_truth =
                        |reading: &Value| (reading["speed_rev_s"].as_f64().unwrap() / 60.17 - 1.0).abs() < 0.01;
                    assert!(alternatives.iter().any(is_truth), "{name}: {line}");
                    continue;
                }
                status => assert_eq!(status, "ok", "{name}: {line}"),
            }
            let speed_rev_s = line["speed_rev_s"].as_f64().unwrap();
            assert!((speed_rev_s / 60.17 - 1.0).abs() < 2e-3, "{name} {flags:?}: {speed_rev_s}");
            heard += 1;
            cuts += usize::from(line["warnings"].to_string().contains("the recorder or its compression removed it"));
        }
    }
    println!("{heard} heard, {cuts} with a cut said");
    assert!(heard >= 5, "{heard}");
}

/// As the recordings of the README come from a phone.
#[test]
fn the_constant_of_films_lies_within_its_uncertainty() {
    if Command::new("ffmpeg").arg("-version").output().is_err() {
        println!("skipped: no ffmpeg on the search path");
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let experiment = write_experiment(folder.path());
    let toml = fs::read_to_string(&experiment).unwrap();
    for kind in ["mov", "m4a", "mp4"] {
        for load in ["load0", "load1"] {
            for wav in files_in(&folder.path().join(load), ".wav") {
                let film = wav.with_extension(kind);
                let run =
                    Command::new("ffmpeg").args(["-v", "error", "-i", text(&wav), "-c:a", "aac", text(&film)]).output();
                assert!(run.unwrap().status.success(), "{}", film.display());
            }
        }
        fs::write(&experiment, toml.replace("*.wav", &format!("*.{kind}"))).unwrap();
        let run = hovertone(&["identify", &experiment, "--json"]).ends_with(0);
        let results: Value = serde_json::from_str(&run.stdout).unwrap();
        let constant = &results["thrust_constant_total_n_s2"];
        let [found, std] = ["value", "std_uncertainty"].map(|name| constant[name].as_f64().unwrap());
        assert!((found - TRUTH_TOTAL_N_S2).abs() < 2.0 * std && std < 0.01 * found, "{kind}: {constant}");
    }
}
