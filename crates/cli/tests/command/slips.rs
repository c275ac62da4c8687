//! Slips of units and names: each is taken as meant where a unit is typed, and refused with the plausible slip where none is.

use crate::testkit::{
    hovertone, hovertone_with, refused_with, steady_hover, text, write_hover, write_noise, write_steady_hover_and_log,
};
use hovertone_vehicle::RotorSpeed;
use std::fs;

#[test]
fn init_by_flags_writes_what_identify_can_read() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    for (name, duration_s) in [("no_hull/a.wav", 0.5), ("no_hull/b.wav", 0.6), ("big/c.wav", 0.7)] {
        fs::create_dir_all(at(name).parent().unwrap()).unwrap();
        write_noise(&at(name), duration_s);
    }
    fs::create_dir(at("empty")).unwrap();
    let init = |more: &[&str]| {
        let arguments = [&["init", "--vehicle", "ardrone", "--mass", "413g=no_hull"], more].concat();
        hovertone_with(&arguments, |command| command.current_dir(folder.path()))
    };
    for name in ["nowhere.wav", "empty", "big/*.mov"] {
        let refused = init(&["--mass", &format!("444g={name}")]).ends_with(1);
        assert!(
            refused.stderr.contains(name) && refused.stderr.contains("no recording has this name"),
            "{}",
            refused.stderr
        );
        assert!(!at("experiment.toml").exists());
    }
    init(&["--mass", "444g=big/c.wav", "--diameter-m", "8in"]).ends_with(0);
    let written = fs::read_to_string(at("experiment.toml")).unwrap();
    for words in ["\"no_hull/*.wav\"", "\"big/c.wav\"", "propeller_diameter_m = 0.2032"] {
        assert!(written.contains(words), "{words}: {written}");
    }
    hovertone(&["identify", text(&at("experiment.toml")), "--check"]).ends_with(0);
}

#[test]
fn a_slip_of_a_mass_or_a_comma_is_named() {
    let check = ["identify", "--vehicle", "ardrone", "--mass", "41.3g=a.wav", "--mass", "444g=b.wav", "--check"];
    refused_with(&check, &["the vehicle \"ardrone\" weighs 413 g", "of --mass 41.3 g"]);
    let comma = ["identify", "--vehicle", "ardrone", "--mass", "0,413", "a.wav"];
    refused_with(&comma, &["--mass 0,413: the decimal sign is a point", "write --mass 0.413"]);
    refused_with(&["speed", "a.wav", "--mass-kg", "0,413kg"], &["the decimal sign is a point", "write 0.413kg"]);
    refused_with(&["speed", "a.wav", "--band", "100,5:200"], &["the decimal sign is a point", "write 100.5:200"]);
    refused_with(&["speed", "a.wav", "--gear", "8,69"], &["write the teeth as PINION:WHEEL"]);
    let place = ["identify", "--vehicle", "ardrone", "--mass", "413g=a.wav", "--latitude-deg", "-20,3"];
    refused_with(&place, &["--latitude-deg -20,3: the decimal sign is a point", "write -20.3"]);
}

#[test]
fn init_refuses_what_identify_would_refuse() {
    let folder = tempfile::tempdir().unwrap();
    let (sound, other) = (folder.path().join("a.wav"), folder.path().join("results.json"));
    write_noise(&sound, 0.5);
    fs::write(&other, "{}").unwrap();
    let place = folder.path().join("new.toml");
    let init = |more: &[&str]| hovertone(&[&["init", "--vehicle", "ardrone", "-o", text(&place)], more].concat());
    let no_sound = init(&["--mass", "413g", text(&other)]).ends_with(1).stderr;
    assert!(no_sound.contains("not an audio or video file"), "{no_sound}");
    let twice = init(&["--mass", "413g", text(&sound), "--mass", "444g", text(&sound)]).ends_with(2).stderr;
    assert!(twice.contains("is given twice") && twice.contains("name each recording once"), "{twice}");
    assert!(!place.exists());
}

#[test]
fn slips_in_an_experiment_file_are_answered() {
    let folder = tempfile::tempdir().unwrap();
    let place = folder.path().join("e.toml");
    let check = |load: &str, words: &[&str]| {
        let file = format!("[vehicle]\npreset = \"ardrone\"\n[[load]]\nname = \"a\"\n{load}\n");
        fs::write(&place, file).unwrap();
        refused_with(&["identify", text(&place), "--check"], words);
    };
    check("recordings = [\"flights\\data.wav\"]", &["backslash", "in a path write /"]);
    check("mass_kg = 0.462\nrecordings = []", &["that it adds to the vehicle", "added_mass_kg = 0.049"]);
    let run = hovertone(&["export", text(&place), "--to", "gazebo"]).ends_with(1);
    assert!(run.stderr.contains("this is an experiment file"), "{}", run.stderr);
}

#[test]
fn lengths_and_masses_are_typed_with_their_units() {
    let plan =
        |more: &[&str]| hovertone(&[&["fit", "--plan", "--wanted-share", "0.1"], more].concat()).ends_with(0).stdout;
    let plain = plan(&["--mass-kg", "0.413", "--diameter-m", "0.2", "--mass-std-kg", "0.001"]);
    assert_eq!(plan(&["--mass-kg", "413g", "--diameter-m", "200mm", "--mass-std-kg", "1g"]), plain);
    assert_eq!(
        plan(&["--mass-kg", "413g", "--latitude-deg", "50", "--height-m", "800m"]),
        plan(&["--mass-kg", "413g", "--latitude-deg", "50", "--height-m", "800"])
    );
    refused_with(&["speed", "a.wav", "--rotors", "4", "--mass-kg", "413g", "--diameter-m", "0.5in"], &["Mach"]);
    refused_with(&["speed", "a.wav", "--blades", "2", "--drift-m-max=-30cm"], &["drift_m_max = -0.3"]);
    let refused = hovertone(&["speed", "a.wav", "--diameter-m", "8ft"]).ends_with(2);
    assert!(refused.stderr.contains("8in"), "{}", refused.stderr);
}

#[test]
fn a_standard_uncertainty_is_smaller_than_its_number() {
    let weigh = ["weigh", "a.wav", "--vehicle", "ardrone", "--constant-n-s2", "2.83e-5"];
    for (more, words) in [
        (&["--mass-kg", "0.413", "--mass-std-kg", "413"][..], ["mass_std_kg = 413", "for ± 1 g write 0.0005"]),
        (&["--mass-std-kg", "413"], ["mass_std_kg = 413", "give --mass-kg"]),
        (&["--constant-std-n-s2", "1"], ["constant_std_n_s2 = 1", "give 0.01e-5"]),
        (
            &["--constant-std-n-s2", "2e-5"],
            ["constant_std_n_s2 = 0.00002", "must be less than the constant, 0.0000283 N s²"],
        ),
    ] {
        refused_with(&[&weigh[..], more].concat(), &words);
    }
}

#[test]
fn a_table_in_another_unit_than_its_header_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("stand.csv");
    for (rows, words) in [
        ("rpm,thrust_n\n3000,0.7\n-3610,1\n4000,1.3\n", ["line 3", "-3610 is negative, but a speed must be 0 or more"]),
        ("speed_rev_s,thrust_n\n3000,0.7\n3610,1\n4000,1.3\n", ["3 of 3 numbers", "rename the header to speed_rpm"]),
        ("rpm,mass_kg\n3610,413\n3742,444\n3820,462\n", ["3 of 3 numbers", "rename the header to mass_g"]),
        ("rpm,mass_g\n3610,0.413\n3742,0.444\n3820,0.462\n", ["3 of 3 numbers", "rename the header to mass_kg"]),
    ] {
        fs::write(&table, rows).unwrap();
        refused_with(&["fit", text(&table)], &[&words[..], &["stand.csv"]].concat());
    }
}

#[test]
fn a_vehicle_of_the_users_can_fly() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("my.toml");
    for (numbers, words) in [
        ("propeller_diameter_m = 0.127\nmass_kg = 250.0", ["[my-drone]", "mass_kg = 250"]),
        ("mass_kg = 250.0", ["more than most multirotors weigh", "for 250 g write 0.25"]),
        ("propeller_diameter_m = 1.27\nshaft_speed_rev_s = [60.0, 400.0]", ["diameter_m = 1.27", "Mach 0.6"]),
        ("propeller_diameter_m = 0.02\nmass_kg = 0.413", ["diameter_m = 0.02", "Mach 0.84"]),
    ] {
        fs::write(&file, format!("[my-drone]\nrotors = 4\nblades = 2\n{numbers}\n")).unwrap();
        let run = hovertone_with(&["vehicles", "--add", text(&file)], |command| {
            command.env("XDG_CONFIG_HOME", folder.path())
        });
        let run = run.ends_with(2);
        words.iter().for_each(|word| assert!(run.stderr.contains(word), "{word}: {}", run.stderr));
        assert!(!folder.path().join("hovertone").exists());
    }
}

#[test]
fn a_known_speed_is_that_of_a_rotor() {
    for rpm in ["0.000000001", "3.6", "1e9"] {
        refused_with(
            &["calibrate", "a.wav", "--blades", "2", "--tachometer-rpm", rpm],
            &["tachometer_rpm", "60 to 90000"],
        );
    }
    refused_with(&["calibrate", "a.wav", "--true-hz", "1e9"], &["true_hz", "1 to 192000"]);
    refused_with(&["fit", "a.csv", "--mass-kg", "413"], &["mass_kg = 413", "--plan"]);
}

#[test]
fn forces_of_several_rotors_are_noticed() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("table.csv");
    for (force, words) in
        [("thrust_g_4rotors", "names 4 rotors"), ("mass_g", "as if one rotor carried it"), ("thrust_g", "")]
    {
        fs::write(&path, format!("{force},rpm\n413,3610\n444,3742\n470,3825\n")).unwrap();
        let said = |more: &[&str]| hovertone(&[&["fit", text(&path)], more].concat()).ends_with(0).stderr;
        let alone = said(&[]);
        assert!(alone.contains(words) && alone.contains("--rotors") != words.is_empty(), "{force}: {alone}");
        assert!(!said(&["--rotors", "4"]).contains("--rotors"), "{force}");
    }
    // a table of this project has the number in a column of its own
    fs::write(&path, "force_n,rotors_running,rpm\n4.05,4,3610\n4.35,4,3742\n4.53,4,3825\n").unwrap();
    let said = hovertone(&["fit", text(&path)]).ends_with(0).stderr;
    assert!(said.contains("the table names 4 rotors") && said.contains("give --rotors 1"), "{said}");
    // the rotors that the table names make the force, so that C_f of one rotor is the same as with the flag
    let constant = |more: &[&str]| {
        hovertone(&[&["fit", text(&path), "--json"], more].concat()).ends_with(0).json_lines().remove(0)
    };
    let per_rotor = |more: &[&str]| constant(more)["thrust_constant_per_rotor_n_s2"]["value"].as_f64().unwrap();
    assert_eq!(per_rotor(&[]), per_rotor(&["--rotors", "4"]));
    assert!((per_rotor(&["--rotors", "1"]) / per_rotor(&[]) - 4.0).abs() < 1e-9);
}

#[test]
fn a_constant_below_its_uncertainty_is_not_for_use() {
    let folder = tempfile::tempdir().unwrap();
    let [table, results] = ["table.csv", "results.json"].map(|name| folder.path().join(name));
    fs::write(&table, "rpm,thrust_g\n3000,100\n3300,220\n3500,80\n").unwrap();
    let fitted = hovertone(&["fit", text(&table)]).ends_with(3);
    assert!(fitted.stderr.contains("the ± of C_f is larger than C_f itself: it is 140 %"), "{}", fitted.stderr);
    assert!(fitted.stdout.contains("do not use this constant: C_f"), "{}", fitted.stdout);
    let json = hovertone(&["fit", text(&table), "--json"]).ends_with(3);
    assert_eq!(json.json_lines()[0]["forbids_use"], true);
    fs::write(&results, json.stdout).unwrap();
    let exported = hovertone(&["export", text(&results), "--to", "gazebo"]).ends_with(3);
    assert!(exported.stderr.contains("do not use this constant"), "{}", exported.stderr);
    // a force beyond all vehicles is a slip
    fs::write(&table, "rpm,thrust_g\n3000,100\n3300,1e300\n").unwrap();
    refused_with(&["fit", text(&table)], &["line 3: the force is", "1e5 N or less", "correct the cell"]);
}

#[test]
fn groups_of_one_row_are_said_to_be_groups() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("loads.csv");
    fs::write(&path, "motor,mass_g,rpm\na,413,3610\nb,444,3742\na,462,3825\n").unwrap();
    refused_with(&["fit", text(&path)], &["the group has 2", "into 2 groups", "remove these columns"]);
    // words that all differ are names of the loads
    fs::write(&path, "load,mass_g,rpm\nlight,413,3610\nheavier,444,3742\nheavy,462,3825\n").unwrap();
    assert!(hovertone(&["fit", text(&path)]).ends_with(0).stdout.contains("C_f"));
}

#[test]
fn a_mass_with_a_wrong_unit_is_a_mass_and_no_file() {
    refused_with(&["identify", "--vehicle", "ardrone", "--mass", "0.444g", "hover.wav"], &["--mass 0.444g: ", "mass"]);
    refused_with(&["weigh", "hover.wav", "--constant", "2.83e-5"], &["--constant-n-s2 2.83e-5", "whole vehicle"]);
}

#[test]
fn what_is_wrong_in_a_word_is_named_with_what_to_write() {
    let folder = tempfile::tempdir().unwrap();
    let (sound, log) = (folder.path().join("a.wav"), folder.path().join("german.csv"));
    write_noise(&sound, 1.0);
    let row = |n: u32| format!("{},{:02};3600,0\n", n / 100, n % 100);
    fs::write(&log, format!("Zeit;Drehzahl\n{}", (0..200).map(row).collect::<String>())).unwrap();
    let (sound, log) = (text(&sound), text(&log));
    let speed = |more: &[&'static str]| [&["speed", "--blades", "3", sound], more].concat();
    let cases: [(Vec<&str>, &[&str]); 7] = [
        (vec!["identify", "--mass", "500lb", sound], &["does not know the unit \"lb\"", "413g"]),
        (speed(&["--rotors", "0"]), &["from 1 to 12"]),
        (speed(&["--rotors", "40"]), &["from 1 to 12"]),
        (
            speed(&["--order", "2"]),
            &["order = 2 and blades = 3 exclude each other", "blades = 3 alone means order = 3"],
        ),
        (
            speed(&["--log", "flight.csv"]),
            &["to tell by --log which rotor is which, hovertone needs the number of rotors", "--rotors 4"],
        ),
        (speed(&["--from", "1:70"]), &["below 60; if you mean 130 seconds, write 130"]),
        (speed(&["--from", "2s"]), &["a time has no unit; write 2 "]),
    ];
    for (arguments, words) in cases {
        refused_with(&arguments, words);
    }
    let said = hovertone(&["log", log]).ends_with(2).stderr;
    let columns = ["--column", "Zeit=time_s", "--column", "Drehzahl=rotor1_rpm"];
    assert!(said.contains(&format!("hovertone log {log} {}", columns.join(" "))), "{said}");
    hovertone(&[&["log", log], &columns[..]].concat()).ends_with(0);
    // the throttle is no speed, wherever it stands
    let (gas, first) = (folder.path().join("gas.csv"), "Gas;Zeit;Drehzahl\n".to_owned());
    fs::write(&gas, first + "10,5;0,00;3600,0\n11,5;0,01;3610,5\n").unwrap();
    let said = hovertone(&["log", text(&gas)]).ends_with(2).stderr;
    assert!(said.contains(&columns.join(" ")) && !said.contains("Gas="), "{said}");
    fs::write(&gas, "Zeit;Gas\n0,00;10,5\n0,01;11,5\n").unwrap();
    let said = hovertone(&["log", text(&gas)]).ends_with(2).stderr;
    assert!(said.contains("--column Zeit=time_s") && !said.contains("Gas="), "{said}");
}

#[test]
fn a_table_without_names_and_a_unit_that_stands_alone_are_understood() {
    let folder = tempfile::tempdir().unwrap();
    let table = folder.path().join("stand.csv");
    fs::write(&table, "3600,1.20\n3700,1.27\n3800,1.34\n").unwrap();
    for command in ["fit", "log"] {
        let said = hovertone(&[command, text(&table)]).ends_with(1).stderr;
        assert!(said.contains("numbers only, but it must name the columns"), "{said}");
        assert!(said.contains("speed_rpm,thrust_g"), "{said}");
    }
    fs::write(&table, "rad/s,thrust_n\n300,0.90\n400,1.61\n500,2.49\n600,3.61\n").unwrap();
    hovertone(&["fit", text(&table)]).ends_with(0);
}

/// A limit of offsets that excludes the right one is the fault of the flag, and not of the log.
#[test]
fn wrong_limits_of_an_offset_are_named() {
    let folder = tempfile::tempdir().unwrap();
    let (sound, log) = write_steady_hover_and_log(folder.path());
    let asked = ["verify", text(&sound), text(&log), "--vehicle", "ardrone", "--mean-only"];
    let far = hovertone(&[&asked[..], &["--log-offset-s", "100:200"]].concat()).ends_with(1).stderr;
    assert!(
        far.contains("at the offsets that --log-offset-s allows") && far.contains("leave --log-offset-s out"),
        "{far}"
    );
    refused_with(
        &[&asked[..], &["--log-offset-s", "3:1"]].concat(),
        &["exchanged", "write the smaller one first, 1:3"],
    );
    refused_with(&["speed", "a.wav", "--blades", "2", "--band", "300:100"], &["write the lower edge first: 100:300"]);
}

#[test]
fn a_line_with_two_equal_signs_has_one_advice() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("experiment.toml");
    fs::write(&file, "[vehicle]\npreset = = \"ardrone\"\n").unwrap();
    let said = hovertone(&["identify", text(&file)]).ends_with(2).stderr;
    assert!(said.contains("more than one = on this line") && !said.contains("nothing is needed"), "{said}");
}

/// Each too short recording has the same reason, noise or rotor.
#[test]
fn short_recordings_have_one_reason() {
    let folder = tempfile::tempdir().unwrap();
    let (noise, hover) = (folder.path().join("noise.wav"), folder.path().join("hover.wav"));
    for duration_s in [0.1, 0.3, 0.6] {
        write_noise(&noise, duration_s);
        write_hover(&hover, steady_hover("ardrone", RotorSpeed::from_rev_s(60.0), duration_s));
        for sound in [&noise, &hover] {
            let run = hovertone(&["speed", "--blades", "2", text(sound)]);
            let is_told = run.code == 0 || run.stderr.contains("of sound are too short to hear a rotor");
            assert!(is_told, "{duration_s} s: {}{}", run.stdout, run.stderr);
        }
    }
}
