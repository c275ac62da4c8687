//! Valid and invalid experiment files.

use super::*;
use hovertone_vehicle::GRAVITY_STANDARD_M_S2;

const GOOD: &str = r#"
[vehicle]
preset = "ardrone"
latitude_deg = -20.76
height_m = 650.0

[tone]
order = 69

[[load]]
name = "no hull"
recordings = ["no_hull/*.mov"]

[[load]]
name = "small hull"
added_mass_kg = 0.031
recordings = ["small_hull/*.mov"]
"#;

fn resolve(text: &str) -> Result<Experiment, String> {
    let file: ExperimentFile = toml::from_str(text).map_err(|error| error.to_string())?;
    file.resolve(None).map_err(|error| error.to_string())
}

fn refusal(from: &str, to: &str) -> String {
    assert!(GOOD.contains(from), "{from}");
    resolve(&GOOD.replacen(from, to, 1)).expect_err(to)
}

#[test]
fn a_preset_fills_what_the_file_leaves_out() {
    let experiment = resolve(GOOD).expect("a good file");
    assert_eq!((experiment.rotor_count, experiment.loads.len()), (4, 2));
    assert_eq!(experiment.config.tone.blades, Some(2));
    assert!(experiment.config.tone.speed_max.rev_s() < 200.0, "the preset's range narrows the search");
    let Force::Weight { vehicle_mass_kg, added_mass_kg, mass_std_kg, gravity_m_s2, gravity_std_m_s2 } =
        experiment.loads[1].force
    else {
        panic!("a hover has a weight");
    };
    assert_eq!((vehicle_mass_kg, added_mass_kg, mass_std_kg), (0.413, 0.031, 0.0005));
    assert!((gravity_m_s2 - 9.7848).abs() < 1e-4);
    assert_eq!(gravity_std_m_s2, 0.0005);
}

#[test]
fn auto_takes_the_gear_mesh_and_then_the_blade_pass() {
    let order = |text: &str| resolve(text).expect("a good file").config.tone.order.lines_per_turn();
    assert_eq!(order(&GOOD.replace("order = 69", "order = \"auto\"")), 69.0);
    assert_eq!(order(&GOOD.replace("order = 69", "")), 69.0);
    assert_eq!(
        order(
            &GOOD
                .replace("order = 69", "")
                .replace("ardrone", "crazyflie")
                .replace("[vehicle]", "[vehicle]\nmass_kg = 0.03")
        ),
        2.0
    );
}

#[test]
fn a_bench_run_has_the_scales_uncertainty_unless_it_says_better() {
    let text = GOOD.replace("added_mass_kg = 0.031", "thrust_n = 1.5\nrotors_running = 1");
    let load = &resolve(&text).expect("a good file").loads[1];
    assert_eq!(load.rotors_running, 1);
    let Force::Thrust { thrust_n, thrust_std_n } = load.force else { panic!("write thrust_n for a bench run") };
    assert_eq!(thrust_n, 1.5);
    assert!((thrust_std_n - 0.0005 * GRAVITY_STANDARD_M_S2).abs() < 1e-12);
}

/// With diameter and mass, the shaft speed has a prior: it tells a speed from its double and its half.
#[test]
fn diameter_and_mass_are_known_before_the_sound() {
    let text = GOOD.replace("[tone]", "propeller_diameter_m = 0.2\n[tone]");
    let experiment = resolve(&text).expect("a good file");
    let known = |load: usize| experiment.loads[load].config(&experiment).known;
    assert_eq!((known(0).diameter_m, known(0).mass_kg, known(0).rotor_count), (Some(0.2), Some(0.413), Some(4)));
    assert!((known(1).mass_kg.expect("a mass") - 0.444).abs() < 1e-12);
    assert!(known(1).hover_thrust_coefficient(60.0, 1.2).is_some());
    let bench =
        resolve(&text.replace("added_mass_kg = 0.031", "thrust_n = 0.980665\nrotors_running = 1")).expect("good");
    let known = bench.loads[1].config(&bench).known;
    assert!((known.mass_kg.expect("a mass") - 0.1).abs() < 1e-12 && known.rotor_count == Some(1));
}

#[test]
fn times_and_the_recorders_clock_are_settings() {
    let text = GOOD.replace("added_mass_kg = 0.031", "added_mass_kg = 0.031\nfrom_s = \"1:02.5\"\nto_s = 70")
        + "\n[recorder]\nclock_ppm = 10.0\nclock_correction_ppm = -83.5\n";
    let experiment = resolve(&text).expect("a good file");
    assert_eq!((experiment.loads[1].span.from_s, experiment.loads[1].span.to_s), (Some(62.5), Some(70.0)));
    assert_eq!((experiment.clock_correction_ppm, experiment.config.budget.clock_ppm), (-83.5, 10.0));
    assert!(resolve(&text.replace("-83.5", "83500.0")).expect_err("no clock").contains("clock_correction_ppm"));
    assert!(resolve(&text.replace("1:02.5", "1:62.5")).expect_err("no time").contains("1:62.5"));
}

#[test]
fn what_means_nothing_is_refused_by_name() {
    for (from, to, said) in [
        ("order = 69", "order = 0", "order"),
        ("order = 69", "order = \"gear\"", "auto"),
        ("order = 69", "ordre = 69", "ordre"),
        ("\"ardrone\"", "\"ardrone9\"", "ardrone9"),
        ("height_m = 650.0", "mass_kg = 413", "kg"),
        ("height_m = 650.0", "mass_kg = nan", "mass_kg"),
        ("height_m = 650.0", "mass_kg = 0.0", "mass_kg"),
        ("height_m = 650.0", "mass_kg = -0.4", "mass_kg"),
        ("height_m = 650.0", "mass_kg = inf", "mass_kg"),
        ("height_m = 650.0", "gravity_std_m_s2 = -1.0", "gravity_std_m_s2"),
        ("height_m = 650.0", "mass_std_kg = -1.0", "mass_std_kg"),
        ("height_m = 650.0", "gravity_m_s2 = 9.8", "gravity"),
        ("latitude_deg = -20.76", "latitude_deg = 200.0", "latitude"),
        ("latitude_deg = -20.76", "", "latitude"),
        ("latitude_deg = -20.76\nheight_m = 650.0", "gravity_m_s2 = 98.0", "Earth"),
        ("latitude_deg = -20.76", "latitude_deg = 0.0\nblades = 0", "blades"),
        ("latitude_deg = -20.76", "latitude_deg = 0.0\nblades = 20000000", "blades"),
        ("latitude_deg = -20.76", "latitude_deg = 0.0\nrotors = 0", "rotors"),
        ("small hull", "no hull", "name of its own"),
        ("added_mass_kg = 0.031", "added_mass_kg = -0.05", "added_mass_kg"),
        ("added_mass_kg = 0.031", "added_mass_kg = 0.031\nthrust_n = 1.0", "thrust_n"),
        ("added_mass_kg = 0.031", "thrust_n = inf", "thrust_n"),
        ("added_mass_kg = 0.031", "rotors_running = 5", "rotors_running"),
        ("added_mass_kg = 0.031", "rotors_running = 2", "hovers with 2 of 4 rotors"),
        ("added_mass_kg = 0.031", "added_mass_kg = nan", "added_mass_kg"),
        ("height_m = 650.0", "propeller_diameter_m = 254.0", "metres"),
        ("height_m = 650.0", "propeller_diameter_m = nan", "propeller_diameter_m"),
        ("height_m = 650.0", "model = \"iris.sdf\"", "vehicle.model"),
        ("added_mass_kg = 0.031", "added_mass_kg = 31.0", "masses are in kg"),
        ("added_mass_kg = 0.031", "from_s = -5.0", "from_s"),
        ("added_mass_kg = 0.031", "from_s = 5.0\nto_s = 4.0", "later to_s"),
        ("latitude_deg = -20.76", "latitude_deg = 0.0\ngear = { pinion = 69, wheel = 8 }", "swapped"),
        ("[\"small_hull/*.mov\"]", "[]", "recordings"),
        ("[\"small_hull/*.mov\"]", "[\"\"]", "the name of a file of load"),
        ("[\"small_hull/*.mov\"]", "[{ file = \"a.wav\", log = \" \" }]", "the name of a file of load"),
        ("latitude_deg = -20.76", "latitude_deg = 0.0\nblades = 3", "blades = 3"),
        ("latitude_deg = -20.76", "latitude_deg = 0.0\ngear = { pinion = 8, wheel = 68 }", "gear = 8:68"),
        ("latitude_deg = -20.76", "latitude_deg = 0.0\nrotors = 6", "rotors = 6"),
        ("latitude_deg = -20.76", "latitude_deg = 0.0\nrotors = 2", "rotors = 2"),
        ("order = 69", "order = 46", "order = 46"),
        ("order = 69", "band_hz = [100.0, 130.0]", "band = 100:130"),
        ("height_m = 650.0", "propeller_diameter_m = 0.02", "Mach"),
        ("height_m = 650.0", "mass_std_kg = 0.5", "mass_std_kg"),
        ("[tone]", "[air]\ntemperature_c = 298.0\npressure_hpa = 937.0\n[tone]", "temperature_c"),
        ("[tone]", "[air]\ntemperature_c = 25.0\npressure_hpa = 93700.0\n[tone]", "pressure_hpa"),
        ("[tone]", "[air]\ntemperature_c = 25.0\nheight_m = 20000.0\n[tone]", "height_m"),
        ("[tone]", "[uncertainty]\ntilt_deg_max = 90.0\n[tone]", "tilt_deg_max"),
        ("[tone]", "[uncertainty]\ntilt = 2.0\n[tone]", "tilt"),
        ("recordings = [\"small_hull/*.mov\"]", "power_w = -5.0\nrecordings = [\"a\"]", "power_w"),
        ("[tone]", "[samples]\nlength_s = 0.0\n[tone]", "length_s"),
    ] {
        let message = refusal(from, to);
        assert!(message.contains(said), "{to:?}: {message}");
    }
    let many = refusal("preset = \"ardrone\"", "rotors = 4\nblades = 13");
    assert!(many.contains("blades = 13, but it must be from 1 to 12"), "{many}");
    assert!(resolve("[vehicle]\npreset = \"ardrone\"\n").expect_err("no loads").contains("load"));
    assert!(
        resolve("[vehicle]\n[[load]]\nname = \"a\"\nrecordings = [\"a\"]\n").expect_err("no rotors").contains("rotors")
    );
}

fn model() -> VehicleModel {
    VehicleModel {
        file: "iris.sdf".to_owned(),
        format: "gazebo".to_owned(),
        rotor_count: Some(4),
        mass_kg: Some(1.5),
        propeller_diameter_m: Some(0.25),
        thrust_constant_n_s2: 5.84e-6,
        thrust_linear_n_s: 0.0,
        thrust_offset_n: 0.0,
    }
}

#[test]
fn a_model_fills_what_the_file_leaves_out_and_wins_over_the_preset() {
    let resolve = |text: &str, model: VehicleModel| {
        let file: ExperimentFile = toml::from_str(text).expect("an experiment file");
        file.resolve(Some(model))
    };
    let text = GOOD.replace("latitude_deg", "model = \"iris.sdf\"\nlatitude_deg");
    let experiment = resolve(&text, model()).expect("a good file");
    assert_eq!((experiment.rotor_count, experiment.propeller_diameter_m), (4, Some(0.25)));
    assert_eq!(experiment.loads[0].force.mass_kg(), Some(1.5));
    assert!(!experiment.is_weighed && !experiment.thrust_settings().is_weighed);
    assert_eq!(experiment.config.tone.blades, Some(2), "what the model does not know is the preset's");
    let own = text.replace("height_m", "mass_kg = 1.6\nrotors = 6\nheight_m");
    let experiment = resolve(&own, model()).expect("a good file");
    assert_eq!((experiment.rotor_count, experiment.loads[0].force.mass_kg()), (6, Some(1.6)));
    assert!(experiment.is_weighed);
    // a fragment with the plugin of one rotor does not make a quadrotor a single-rotor vehicle
    let fragment = VehicleModel { rotor_count: Some(1), ..model() };
    let message = resolve(&text, fragment.clone()).expect_err("rotors").to_string();
    assert!(
        message.contains("4 rotors, but the model has 1") && message.contains("rotors = N under [vehicle]"),
        "{message}"
    );
    assert_eq!(resolve(&own, fragment).expect("a good file").rotor_count, 6);
    for (broken, said) in [
        (VehicleModel { mass_kg: Some(f64::NAN), ..model() }, "mass_kg"),
        (VehicleModel { mass_kg: Some(0.0), ..model() }, "mass_kg"),
        (VehicleModel { propeller_diameter_m: Some(25.4), ..model() }, "propeller_diameter_m"),
        (VehicleModel { rotor_count: Some(0), ..model() }, "rotors"),
    ] {
        let message = resolve(&text, broken).expect_err(said).to_string();
        assert!(message.contains(said) && message.contains("iris.sdf"), "{message}");
    }
}
