//! Rotors that differ and that nothing separates: every command states a ± that contains this.

use crate::testkit::{hovertone, text};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

/// A hover of an AR.Drone 2.0 (0.429 kg) in a room, with rotors that are 7 % slower or faster than their mean.
const FLIGHT: &str = r#"
seed = 32
[vehicle]
preset = "ardrone2"
[spread]
thrust_shares = [0.86, 1.14, 1.14, 0.86]
[pilot]
jitter = { climb_std = 0.05, roll_std = 0.05, pitch_std = 0.05, yaw_rate_std = 0.05, time_constant_s = 0.3 }
[motor_wander]
gain_std_share = 0.004
[gusts]
std_m_s = [0.15, 0.15, 0.1]
length_m = [1.0, 1.0, 1.0]
airspeed_m_s = 1.0
[sound]
line_levels = "drawn"
[room]
[ambient]
[[microphone]]
position_m = [-2.0, 1.0, 1.5]
[[maneuver]]
kind = "hover"
duration_s = 10.0
"#;

fn flown(folder: &Path, flight: &str) -> PathBuf {
    let scenario = folder.join("scenario.toml");
    fs::write(&scenario, flight).unwrap();
    let output = folder.join("flown");
    hovertone(&["simulate", text(&scenario), "-o", text(&output)]).ends_with(0);
    output.join("sound.wav")
}

#[test]
fn the_constant_has_the_uncertainty_of_the_speed_of_all_rotors() {
    let folder = tempfile::tempdir().unwrap();
    let sound = flown(folder.path(), FLIGHT);
    let vehicle = ["--vehicle", "ardrone2"];
    let line = &hovertone(&[&["speed", "--json", text(&sound)], &vehicle[..]].concat()).ends_with(0).json_lines()[0];
    assert_eq!(line["rotors_heard"], "one_tone");
    let of = |value: &Value| value.as_f64().unwrap();
    let speed_share = of(&line["combined_std_uncertainty_rev_s"]) / of(&line["speed_rev_s"]);
    assert!(speed_share > 0.03, "{speed_share}");

    let output = folder.path().join("results");
    let mass = format!("429g={}", text(&sound));
    hovertone(&[&["identify", "--mass", &mass, "-o", text(&output)], &vehicle[..]].concat()).ends_with(0);
    let results: Value = serde_json::from_str(&fs::read_to_string(output.join("results.json")).unwrap()).unwrap();
    let constant = of(&results["thrust_constant_total_n_s2"]["value"]);
    let expanded = of(&results["expanded_uncertainty_total_n_s2"]);
    assert!(expanded / constant > 0.99 * 4.0 * speed_share, "{expanded} of {constant}, speed {speed_share}");

    let by_constant = ["--constant-n-s2", "3.1531e-5", "--constant-std-n-s2", "1e-8", "--mass-kg", "0.4"];
    let weigh = [&["weigh", "--json", text(&sound)], &vehicle[..], &by_constant].concat();
    let weighed: Value = serde_json::from_str(&hovertone(&weigh).ends_with(0).stdout).unwrap();
    let (mass_kg, std_kg) = (of(&weighed["mass_kg"]["value"]), of(&weighed["mass_kg"]["std_uncertainty"]));
    assert!(std_kg / mass_kg > 0.99 * 2.0 * speed_share, "{mass_kg} ± {std_kg} kg");
    assert!((mass_kg - 0.429).abs() < 2.0 * std_kg, "{mass_kg} ± {std_kg} kg");
}

/// Of a vehicle that is known, mass and diameter tell the octave, also where its payload is asked for.
#[test]
fn a_payload_is_weighed_by_all_that_is_known_of_the_vehicle() {
    let folder = tempfile::tempdir().unwrap();
    let sound = flown(folder.path(), &FLIGHT.replace("ardrone2", "crazyflie").replace("seed = 32", "seed = 24"));
    let by_constant = ["--constant-n-s2", "9.168e-8", "--constant-std-n-s2", "1e-12"];
    let weigh = [&["weigh", "--json", text(&sound), "--vehicle", "crazyflie"], &by_constant[..]].concat();
    let weighed: Value = serde_json::from_str(&hovertone(&weigh).ends_with(0).stdout).unwrap();
    let of = |name: &str| weighed["mass_kg"][name].as_f64().unwrap();
    assert!((of("value") - 0.027).abs() < 2.0 * of("std_uncertainty"), "{weighed}");
}
