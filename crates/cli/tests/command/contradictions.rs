//! What contradicts a known vehicle, or the results of one, is refused: on the command line and in a file alike.

use crate::testkit::{hovertone, recordings, refused_with, steady_bench, steady_hover, text, write_hover};
use hovertone_sim::HoverSettings;
use hovertone_vehicle::{RotorSpeed, find_preset};
use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};

#[test]
fn a_vehicle_contradicts_the_same_by_flags_and_in_a_file() {
    let folder = tempfile::tempdir().unwrap();
    let experiment = folder.path().join("experiment.toml");
    for (flags, vehicle, tone, words) in [
        (&["--blades", "3"][..], "blades = 3", "", ["blades = 3", "have 2 blades"]),
        (&["--gear", "8:68"], "gear = { pinion = 8, wheel = 68 }", "", ["gear = 8:68", "is 8:69"]),
        (&["--order", "46"], "", "order = 46", ["order = 46", "is at 69 times"]),
        (&["--order", "4"], "", "order = 4", ["order = 4", "harmonics"]),
        (&["--band", "100:130"], "", "band_hz = [100.0, 130.0]", ["means 1.4 to 1.9 rev/s", "920 to 8280 Hz"]),
        (&["--rotors", "6"], "rotors = 6", "", ["rotors = 6", "has 4 rotors"]),
        (&["--diameter-m", "0.02"], "propeller_diameter_m = 0.02", "", ["diameter_m = 0.02", "Mach 0.84"]),
        (&["--diameter-m", "4"], "propeller_diameter_m = 4.0", "", ["diameter_m = 4", "at 0.3 rev/s"]),
    ] {
        refused_with(&[&["speed", "a.wav", "--vehicle", "ardrone"], flags].concat(), &words);
        let load = "[[load]]\nname = \"a\"\nrecordings = [\"a.wav\"]\n";
        fs::write(&experiment, format!("[vehicle]\npreset = \"ardrone\"\n{vehicle}\n[tone]\n{tone}\n{load}")).unwrap();
        refused_with(&["identify", text(&experiment)], &[&words[..], &["experiment.toml"]].concat());
    }
    for command in ["identify", "init"] {
        let flown = [command, "--vehicle", "ardrone", "--mass", "413g=a.wav"];
        refused_with(&[&flown[..], &["--rotors", "2"]].concat(), &["rotors = 2", "all rotors of the vehicle turn"]);
        refused_with(&[&flown[..], &["--diameter-m", "0.02"]].concat(), &["diameter_m = 0.02", "Mach 0.84"]);
    }
}

/// A speed that no multirotor has with this vehicle is doubtful, and the vehicle is to be checked: nobody gave a diameter.
#[test]
fn a_speed_too_fast_for_the_propellers_of_a_vehicle_is_doubtful() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("hover.wav");
    write_hover(&sound, steady_bench("crazyflie", RotorSpeed::from_rev_s(348.0), 3.0));
    let run = hovertone(&["speed", text(&sound), "--vehicle", "f450", "--mean-only"]).ends_with(3);
    assert!(run.stderr.contains("at Mach 0.8") && run.stderr.contains("(hint: check the vehicle)"), "{}", run.stderr);
}

/// The vehicle tells no blades and no gear: what was given beside it may be wrong too.
#[test]
fn a_fact_given_beside_a_vehicle_is_named_beside_it() {
    let Some(videos) = recordings("flight-video") else { return };
    let video = videos.join("takeoff.mp4");
    let run = hovertone(&["speed", text(&video), "--vehicle", "tello", "--gear", "10:40"]).ends_with(3);
    assert!(run.stderr.contains("in place of the vehicle and the gear"), "{}", run.stderr);
    let Some(real) = recordings("real") else { return };
    let bebop = real.join("bebop_B_S2_D1_067.flac");
    let run = hovertone(&["speed", text(&bebop), "--vehicle", "tello"]).ends_with(3);
    let left = "the given facts leave one rotor speed only, and the sound does not show it clearly; check the vehicle (--vehicle)";
    assert!(run.stderr.contains(left), "{}", run.stderr);
    let wrong_blades = hovertone(&["speed", text(&video), "--blades", "2"]).ends_with(3);
    let asked = "check the number of blades (--blades), and give the diameter of the propellers (--diameter-m)";
    assert!(wrong_blades.stderr.contains(asked), "{}", wrong_blades.stderr);
    let of_preset = hovertone(&["speed", text(&video), "--vehicle", "f450"]).ends_with(3);
    let asked = "check the vehicle (--vehicle), and give the mass (--mass-kg)";
    assert!(of_preset.stderr.contains(asked), "{}", of_preset.stderr);
}

/// Frames of a length that the method of the answer does not use tell nothing against the vehicle.
#[test]
fn a_length_of_frames_does_not_contradict_the_vehicle() {
    let folder = tempfile::tempdir().unwrap();
    let flown = HoverSettings::for_vehicle(find_preset("ardrone").unwrap(), RotorSpeed::from_rev_s(60.1));
    write_hover(&folder.path().join("hover.wav"), HoverSettings { duration_s: 6.0, ..flown });
    let experiment = folder.path().join("experiment.toml");
    let of_load = "[[load]]\nname = \"a\"\nrecordings = [\"hover.wav\"]\n";
    let vehicle = "[vehicle]\npreset = \"ardrone\"\nmass_kg = 0.413\n";
    fs::write(&experiment, format!("{vehicle}[spectrogram]\nwindow_s = 1.0\n{of_load}")).unwrap();
    let run = hovertone(&["identify", text(&experiment)]).ends_with(0);
    assert!(run.stderr.contains("leave window_s under [spectrogram] out"), "{}", run.stderr);
    assert!(!run.stderr.contains("does not fit the sound"), "{}", run.stderr);
}

#[test]
fn a_band_outside_of_all_rotors_is_refused_without_a_vehicle() {
    refused_with(
        &["speed", "a.wav", "--gear", "8:69", "--band", "100:130"],
        &["69 times the rotor speed", "1.4 to 1.9 rev/s"],
    );
    refused_with(&["speed", "a.wav", "--mass-kg", "413"], &["mass_kg = 413", "for 413 g write 0.413"]);
    let plan = ["fit", "--plan", "--mass-kg", "413"];
    refused_with(&plan, &["mass_kg = 413", "for 413 g write 0.413"]);
    refused_with(&[&plan[..], &["--diameter-m", "0.2"]].concat(), &["mass_kg = 413", "Mach"]);
    hovertone(&["fit", "--plan", "--mass-kg", "360", "--diameter-m", "1.6", "--rotors", "8", "--wanted-share", "0.2"])
        .ends_with(0);
}

/// Results of the AR.Drone, as far as `weigh` reads them.
pub(crate) fn results_of_four_rotors(folder: &Path) -> PathBuf {
    let path = folder.join("results.json");
    let tone = "{\"order\":69,\"harmonics\":3,\"blades\":2,\"band_half_width_share\":0.1,\"speed_rad_s_min\":84,\"speed_rad_s_max\":754}";
    let written = format!(
        "{{\"thrust_constant_per_rotor_n_s2\":{{\"value\":7.075e-6}},\
         \"settings\":{{\"experiment\":{{\"vehicle_name\":\"own vehicle\",\"rotor_count\":4,\"config\":{{\"tone\":{tone}}}}}}}}}"
    );
    fs::write(&path, written).unwrap();
    path
}

/// A mass that the sound contradicts makes a sure speed ambiguous: the answer says which facts to check, and why.
#[test]
fn facts_that_make_a_sure_speed_ambiguous_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("hover.wav");
    write_hover(&sound, steady_hover("ardrone", RotorSpeed::from_rev_s(60.5), 6.0));
    let asked = ["speed", text(&sound), "--blades", "2", "--rotors", "4"];
    let sure = hovertone(&asked).ends_with(0);
    assert!(!sure.stderr.contains("ambiguous"), "{}", sure.stderr);
    let mut named = 0;
    for mass_kg in ["0.08", "0.1", "0.12"] {
        let run = hovertone(&[&asked[..], &["--diameter-m", "0.1", "--mass-kg", mass_kg]].concat());
        if run.stderr.contains("ambiguous:") {
            let facts = "check the number of blades (--blades), the diameter of the propellers (--diameter-m), the mass (--mass-kg)";
            let words = [
                "One of them, 60.",
                "does not fit the given diameter, mass and number of rotors",
                facts,
                "0.03 to 0.25",
            ];
            words.iter().for_each(|word| assert!(run.stderr.contains(word), "{word}: {}", run.stderr));
            named += 1;
        }
    }
    assert!(named > 0);
}

#[test]
fn a_mass_is_not_scaled_by_other_rotors_or_another_order() {
    let folder = tempfile::tempdir().unwrap();
    let results = results_of_four_rotors(folder.path());
    let wav = folder.path().join("hover.wav");
    write_hover(&wav, steady_hover("ardrone", RotorSpeed::from_rev_s(58.7), 3.0));
    let weigh = ["weigh", text(&wav), "--constant", text(&results)];
    for (more, words) in [
        (&["--rotors", "8"][..], ["with 4 rotors", "--rotors says 8", "leave --rotors out"]),
        (&["--rotors", "2"], ["with 4 rotors", "--rotors says 2", "leave --rotors out"]),
        (&["--order", "46"], ["sounds 69 times per turn", "by --order it sounds 46 times", "leave --order"]),
        (&["--blades", "3"], ["sounds 69 times per turn", "by --blades it sounds 3 times", "leave --blades"]),
    ] {
        refused_with(&[&weigh[..], more].concat(), &words);
    }
    let mass_kg = |more: &[&str]| -> f64 {
        let run = hovertone(&[&weigh[..], more, &["--json"]].concat()).ends_with(0);
        let weighed: Value = serde_json::from_str(&run.stdout).unwrap();
        weighed["mass_kg"]["value"].as_f64().unwrap()
    };
    let alone = mass_kg(&[]);
    for more in [&["--rotors", "4"][..], &["--order", "69"], &["--blades", "2"], &["--vehicle", "ardrone"]] {
        assert!((mass_kg(more) / alone - 1.0).abs() < 2e-3, "{more:?}");
    }
    let by_constant = ["weigh", text(&wav), "--constant-n-s2", "2.83e-5", "--vehicle", "ardrone"];
    refused_with(&[&by_constant[..], &["--rotors", "8"]].concat(), &["rotors = 8", "has 4 rotors"]);
    refused_with(&[&by_constant[..], &["--order", "46"]].concat(), &["order = 46", "is at 69 times"]);
}

/// What the vehicle has already changes no digit: speed, ± and budget.
#[test]
fn saying_what_the_vehicle_has_changes_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let wav = folder.path().join("hover.wav");
    let mut settings = steady_hover("ardrone", RotorSpeed::from_rev_s(60.0), 3.0);
    for (rotor, rev_s) in settings.rotors.iter_mut().zip([59.2, 59.8, 60.3, 60.9]) {
        *rotor = hovertone_sim::prescribed::RotorSound::steady(RotorSpeed::from_rev_s(rev_s));
    }
    write_hover(&wav, settings);
    let vehicle = find_preset("ardrone").unwrap();
    let mass_kg = vehicle.mass_kg.unwrap().value.to_string();
    let heard = |more: &[&str]| {
        let run = hovertone(&[&["speed", "--json", text(&wav), "--vehicle", "ardrone"], more].concat());
        let mut line = run.json_lines().remove(0);
        line.as_object_mut().unwrap().remove("settings").unwrap();
        line
    };
    let alone = heard(&[]);
    assert!(alone["combined_std_uncertainty_rev_s"].as_f64().unwrap() > 0.0, "{alone}");
    for more in [
        &["--blades", "2"][..],
        &["--gear", "8:69"],
        &["--gear", "69", "--blades", "2"],
        &["--order", "69"],
        &["--rotors", "4"],
        &["--mass-kg", &mass_kg],
        &["--blades", "2", "--rotors", "4", "--mass-kg", &mass_kg],
    ] {
        assert_eq!(heard(more), alone, "{more:?}");
    }
}

#[test]
fn a_vehicle_that_the_results_contradict_is_named_and_no_mass_that_nobody_gave() {
    let folder = tempfile::tempdir().unwrap();
    let (sound, out) = (folder.path().join("hover.wav"), folder.path().join("out"));
    write_hover(&sound, steady_hover("crazyflie", RotorSpeed::from_rev_s(350.0), 5.0));
    let identify = ["identify", "--blades", "2", "--rotors", "4", "--diameter-m", "0.046", "--mass", "30g"];
    hovertone(&[&identify[..], &[text(&sound), "-o", text(&out)]].concat()).ends_with(0);
    let results = out.join("results.json");
    let weigh = ["weigh", text(&sound), "--constant", text(&results)];
    let run = hovertone(&[&weigh[..], &["--vehicle", "ardrone"]].concat()).ends_with(2);
    let says = "--vehicle ardrone contradicts the results: the measured vehicle weighs 0.03 kg and hovers at ";
    assert!(run.stderr.contains(says) && run.stderr.contains("leave --vehicle out"), "{}", run.stderr);
    assert!(!run.stderr.contains("--mass-kg"), "{}", run.stderr);
    hovertone(&weigh).ends_with(0);
}

/// Half of the speed would be a quarter of the mass: less than the vehicle alone.
#[test]
fn a_speed_at_which_the_vehicle_cannot_hover_makes_no_mass_ambiguous() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("hover.wav");
    let settings = steady_bench("crazyflie", RotorSpeed::from_rev_s(80.0), 10.0);
    write_hover(&sound, settings);
    // 500 g hover at 80 rev/s
    let weigh = ["weigh", text(&sound), "--blades", "2", "--rotors", "1", "--constant-n-s2", "1.9413e-5"];
    let open = hovertone(&weigh).ends_with(3);
    assert!(open.stderr.contains("ambiguous"), "{}", open.stderr);
    let run = hovertone(&[&weigh[..], &["--mass-kg", "0.45"]].concat()).ends_with(0);
    assert!(run.stdout.contains("mass as flown: 500"), "{}", run.stdout);
}

/// The answer stands, since the person may know better, but the exit code says that it is doubtful.
#[test]
fn a_speed_of_a_vehicle_that_the_sound_contradicts_ends_with_3() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("hover.wav");
    write_hover(&sound, steady_hover("ardrone", RotorSpeed::from_rev_s(61.3), 6.0));
    hovertone(&["speed", text(&sound), "--vehicle", "ardrone"]).ends_with(0);
    let run = hovertone(&["speed", text(&sound), "--vehicle", "crazyflie"]).ends_with(3);
    let is_said = ["contradicts the given facts", "no rotor that fits the given facts is heard"]
        .iter()
        .any(|word| run.stderr.contains(word));
    assert!(is_said, "{}", run.stderr);
    // what was not given is not to be checked
    for fact in ["the diameter", "the mass", "the band", "the gear"] {
        assert!(!run.stderr.contains(&format!("check {fact}")) && !run.stderr.contains(&format!("and {fact}")));
    }
}

/// A tone that replaces the tone of the results also leaves their range of speeds behind.
#[test]
fn a_speed_that_the_vehicle_of_a_constant_cannot_have_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let results = results_of_four_rotors(folder.path());
    let sound = folder.path().join("hover.wav");
    write_hover(&sound, steady_hover("crazyflie", RotorSpeed::from_rev_s(250.0), 5.0));
    let run = hovertone(&["weigh", text(&sound), "--constant", text(&results), "--blades", "2"]).ends_with(3);
    for words in ["measured with rotors that turn at 13 to 120 rev/s", "leave --blades out"] {
        assert!(run.stderr.contains(words), "{words}: {}", run.stderr);
    }
    assert!(run.stdout.contains("do not use this mass"), "{}", run.stdout);
    // without the flag, no advice leads to it
    let alone = hovertone(&["weigh", text(&sound), "--constant", text(&results)]).ends_with(3).stderr;
    for astray in ["give --blades", "check the blades", "check the number of blades"] {
        assert!(!alone.contains(astray), "{astray}: {alone}");
    }
    let counted = run.stderr.matches("warning: ").count();
    assert_eq!(run.stderr.matches(&format!("{counted} warning")).count(), 1, "{}", run.stderr);
}

/// The blades are given, so that nothing was searched for: the speed is still compared with what carries the vehicle.
#[test]
fn a_speed_at_which_the_vehicle_cannot_hover_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let sound = folder.path().join("hover.wav");
    write_hover(&sound, steady_hover("ardrone", RotorSpeed::from_rev_s(61.3), 6.0));
    let facts = ["--blades", "2", "--rotors", "4", "--diameter-m", "0.2"];
    let heard = |mass: &str| hovertone(&[&["speed", text(&sound), "--mass-kg", mass], &facts[..]].concat()).stderr;
    let heavy = heard("0.9");
    let is_said = ["cannot hover at 61.3 rev/s", "contradict"].iter().any(|words| heavy.contains(words));
    assert!(is_said, "{heavy}");
    assert!(!heard("0.413").contains("cannot hover"));
    // a payload hovers too, and its mass is what is weighed
    let weigh = ["weigh", text(&sound), "--constant-n-s2", "2.83e-5", "--mass-kg", "0.06"];
    let weighed = hovertone(&[&weigh[..], &facts[..]].concat()).stderr;
    assert!(!weighed.contains("cannot hover"), "{weighed}");
    // a known vehicle with a mass of its own: the mass is named too, and the answer is doubtful
    write_hover(&sound, steady_hover("crazyflie", RotorSpeed::from_rev_s(327.0), 5.0));
    let loaded = hovertone(&["speed", text(&sound), "--vehicle", "crazyflie", "--mass-kg", "0.2"]).ends_with(3);
    let is_mass_named = ["the mass first, then the vehicle", "the vehicle and the mass"]
        .iter()
        .any(|words| loaded.stderr.contains(words));
    assert!(is_mass_named, "{}", loaded.stderr);
}
