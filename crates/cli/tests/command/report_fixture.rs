//! Small experiments, identified, with their report written.

use crate::testkit::{hovertone, steady_hover, text, write_hover, write_noise, write_wav};
use hovertone_sim::HoverSettings;
use hovertone_vehicle::RotorSpeed;
use serde_json::Value;
use std::f64::consts::TAU;
use std::fs;
use std::path::Path;

const GRAVITY_M_S2: f64 = 9.80;
const TRUTH_TOTAL_N_S2: f64 = 2.83e-5;
const ADDED_KG: [f64; 2] = [0.0, 0.05];
pub(crate) const DURATION_S: f64 = 4.0;
/// Names that would be markup if they were not escaped. A slash parts folders: this one is in a folder of its own.
pub(crate) const HOSTILE_FILE: &str = "<script>alert(1)</script>.wav";
pub(crate) const HOSTILE_LOAD: &str = "<img src=x onerror=alert(1)>";

/// Two loads, the first with a hostile name and a hostile recording, the second with a recording of noise; identified.
pub(crate) fn identified(folder: &Path) -> Value {
    let mut experiment = format!(
        "[vehicle]\npreset = \"ardrone\"\nmass_kg = 0.413\ngravity_m_s2 = {GRAVITY_M_S2}\n[tone]\norder = 69\n[samples]\nlength_s = 2.0\n"
    );
    let files = [[HOSTILE_FILE, "a.wav"], ["b.wav", "noise.wav"]];
    for (added_kg, files) in ADDED_KG.into_iter().zip(files) {
        let name = if added_kg == 0.0 { HOSTILE_LOAD } else { "loaded" };
        experiment += &format!(
            "[[load]]\nname = \"{name}\"\nadded_mass_kg = {added_kg}\nrecordings = [\"{}\", \"{}\"]\n",
            files[0], files[1]
        );
        for (seed, file) in (0..).zip(files) {
            let path = folder.join(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            if file == "noise.wav" {
                write_noise(&path, DURATION_S);
                continue;
            }
            let speed = RotorSpeed::from_rad_s(((0.413 + added_kg) * GRAVITY_M_S2 / TRUTH_TOTAL_N_S2).sqrt());
            let settings = steady_hover("ardrone", speed, DURATION_S);
            write_hover(&path, HoverSettings { seed, ..settings });
        }
    }
    fs::write(folder.join("experiment.toml"), experiment).unwrap();
    let out = folder.join("out");
    hovertone(&["identify", text(&folder.join("experiment.toml")), "-o", text(&out)]).ends_with(3);
    serde_json::from_str(&fs::read_to_string(out.join("results.json")).unwrap()).unwrap()
}

/// Recordings of [`many_identified`].
pub(crate) const MANY: usize = 60;
const MANY_RATE_HZ: u32 = 16_000;
const MANY_S: f64 = 2.4;

/// Sixty short recordings of one rotor at six loads, with long names; one is noise, and some begin with silence.
pub(crate) fn many_identified(folder: &Path) -> Value {
    let mut experiment =
        "[vehicle]\nrotors = 1\nblades = 2\nmass_kg = 0.5\n[tone]\norder = 2\n[samples]\nlength_s = 2.0\n".to_owned();
    for load in 0..6 {
        let added_kg = 0.05 * f64::from(load);
        let names: Vec<String> = (0..10)
            .map(|number| format!("campaign_of_a_long_day/load_{load}/recording_with_a_long_name_{number}.wav"))
            .collect();
        let listed = names.iter().map(|name| format!("\"{name}\"")).collect::<Vec<_>>().join(", ");
        experiment += &format!(
            "[[load]]\nname = \"payload number {load}\"\nadded_mass_kg = {added_kg}\nrecordings = [{listed}]\n"
        );
        for (number, name) in (0..).zip(&names) {
            let path = folder.join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            match (load, number) {
                (2, 3) => write_noise(&path, MANY_S),
                _ => {
                    let speed_rev_s = 100.0 * (1.0 + added_kg / 0.5).sqrt() * (1.0 + 0.001 * f64::from(number % 3));
                    let silence_s = if number == 5 { 2.0 } else { 0.0 };
                    write_rotor(&path, speed_rev_s, silence_s, MANY_S, 10 * load + number);
                }
            }
        }
    }
    fs::write(folder.join("experiment.toml"), experiment).unwrap();
    let out = folder.join("out");
    hovertone(&["identify", text(&folder.join("experiment.toml")), "-o", text(&out)]).ends_with(3);
    serde_json::from_str(&fs::read_to_string(out.join("results.json")).unwrap()).unwrap()
}

/// Loads and recordings with long names: a trial that differs, a heavier load with slower rotors, and a recording of noise.
pub(crate) fn contradictory_identified(folder: &Path) {
    let mut experiment =
        "[vehicle]\nrotors = 1\nblades = 2\nmass_kg = 0.5\n[tone]\norder = 2\n[samples]\nlength_s = 2.0\n".to_owned();
    for (load, speeds_rev_s) in (0..).zip([[100.0, 106.0], [112.0, 112.1], [96.0, 96.1], [0.0, 120.0]]) {
        let name = format!("payload of the campaign of a very long day with the camera and second battery, no. {load}");
        let files =
            [1, 2].map(|number| format!("{load}/recording_of_a_very_long_day_with_the_camera_no_{load}_{number}.wav"));
        let added_kg = 0.05 * f64::from(load);
        experiment += &format!("[[load]]\nname = \"{name}\"\nadded_mass_kg = {added_kg}\nrecordings = {files:?}\n");
        for (file, speed_rev_s) in files.iter().zip(speeds_rev_s) {
            let path = folder.join(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            match speed_rev_s {
                0.0 => write_noise(&path, MANY_S),
                _ => write_rotor(&path, speed_rev_s, 0.0, MANY_S, load),
            }
        }
    }
    fs::write(folder.join("experiment.toml"), experiment).unwrap();
    hovertone(&["identify", text(&folder.join("experiment.toml")), "-o", text(&folder.join("out"))]).ends_with(3);
}

/// One rotor of two blades with five harmonics in noise, after silence; faster to make than a simulated hover.
pub(crate) fn write_rotor(path: &Path, speed_rev_s: f64, silence_s: f64, rotor_s: f64, seed: u32) {
    let rate = f64::from(MANY_RATE_HZ);
    let mut state = u64::from(seed) + 1;
    let samples: Vec<f32> = (0..((silence_s + rotor_s) * rate) as usize)
        .map(|n| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            let noise = 0.02 * ((state >> 40) as f64 / f64::from(1 << 23) - 1.0);
            let time_s = n as f64 / rate;
            let line = |harmonic: f64| 0.1 / harmonic * (TAU * 2.0 * harmonic * speed_rev_s * time_s).sin();
            let rotor: f64 = if time_s < silence_s { 0.0 } else { (1..=5).map(f64::from).map(line).sum() };
            (noise + rotor) as f32
        })
        .collect();
    write_wav(path, &samples, MANY_RATE_HZ);
}
