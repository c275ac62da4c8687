//! Every format is written and read back. The arithmetic of a hover in the unit of the format checks its number.

use super::*;
use std::f64::consts::TAU;

pub(super) fn rotor() -> IdentifiedRotor {
    IdentifiedRotor {
        vehicle_name: "Parrot AR.Drone (the paper's) -- test".to_owned(),
        thrust_constant_n_s2: 7.07753e-6,
        expanded_uncertainty_n_s2: Some(1.4e-7),
        measured_std_total_n_s2: None,
        rotors_std_share: 0.0,
        tone: None,
        method: None,
        trial_std_share: None,
        rotor_count: 4,
        mass_kg: Some(0.413),
        hover_speed_rad_s: Some(378.07),
        gravity_m_s2: 9.80,
        propeller_diameter_m: Some(0.2),
        air_density_kg_m3: Some(1.17),
        torque_constant_n_m_s2: None,
        hover_command: Some(0.45),
        forbids_use: false,
        doubts: Vec::new(),
        recordings_sha256: Vec::new(),
        clock_correction_ppm: 0.0,
        origin: "a test".to_owned(),
    }
}

/// Relative precision of exported numbers.
const TOLERANCE: f64 = 1e-7;

pub(super) fn agrees(value: f64, expected: f64, what: &str) {
    assert!((value / expected - 1.0).abs() < TOLERANCE, "{what}: {value} {expected}");
}

#[test]
fn every_format_is_read_back() {
    for torque in [None, Some(2.1308e-7)] {
        let rotor = IdentifiedRotor { torque_constant_n_m_s2: torque, ..rotor() };
        for format in SimulatorFormat::ALL {
            let text = export_text(&rotor, format).unwrap();
            let model = model_from_text(&text).unwrap_or_else(|error| panic!("{}: {error}\n{text}", format.name()));
            assert_eq!(model.format, format, "{text}");
            agrees(model.thrust_constant_n_s2, rotor.thrust_constant_n_s2, format.name());
            assert_eq!(model.moment_constant_m.is_some(), torque.is_some(), "{text}");
            // a plugin and a polynomial have no diameter
            let has_diameter = !matches!(format, SimulatorFormat::Gazebo | SimulatorFormat::Flightmare);
            assert_eq!(model.propeller_diameter_m.is_some(), has_diameter, "{text}");
            agrees(model.propeller_diameter_m.unwrap_or(0.2), 0.2, format.name());
            agrees(model.mass_kg.unwrap_or(0.413), 0.413, format.name());
            if let (Some(read), Some(written)) = (model.moment_constant_m, rotor.moment_constant_m()) {
                assert!((read / written - 1.0).abs() < 3.0 * TOLERANCE, "{}: {read} {written}", format.name());
            }
            if format != SimulatorFormat::Airsim {
                // a class of rotor parameters has neither
                assert!(model.rotor_count.is_none_or(|count| count == 4));
            }
            for word in ["N/(rad/s)^2", "N/(rev/s)^2", "N/rpm^2", "g/rpm^2", "N/command^2"] {
                assert!(format == SimulatorFormat::Json || text.contains(word), "{word}:\n{text}");
            }
            let marks_missing = text.contains("MISSING") || text.contains("\"moment_constant_m\": null");
            assert_eq!(marks_missing, torque.is_none(), "{}:\n{text}", format.name());
        }
    }
}

/// Four rotors at the measured hover speed carry the weight, in the unit and by the formula of each format.
#[test]
fn each_format_hovers_in_its_own_unit() {
    let rotor = rotor();
    let speed_rad_s = rotor.hover_speed_by_balance_rad_s().unwrap();
    let (rpm, rev_s) = (speed_rad_s * 60.0 / TAU, speed_rad_s / TAU);
    let weight_n = 0.413 * 9.80;
    let written = |format: SimulatorFormat, before: &str, after: &str| -> f64 {
        let text = export_text(&rotor, format).unwrap();
        let start = text.find(before).unwrap_or_else(|| panic!("{before} in {text}")) + before.len();
        text[start..].split_once(after).unwrap().0.parse().unwrap()
    };
    let square = |constant: f64, speed: f64| 4.0 * constant * speed * speed;
    agrees(square(written(SimulatorFormat::Gazebo, "<motorConstant>", "<"), speed_rad_s), weight_n, "gazebo");
    agrees(
        square(written(SimulatorFormat::Rotors, "\"motor_constant\" value=\"", "\""), speed_rad_s),
        weight_n,
        "rotors",
    );
    agrees(square(written(SimulatorFormat::GymPybulletDrones, " kf=\"", "\""), rpm), weight_n, "gym-pybullet-drones");
    agrees(square(written(SimulatorFormat::Rotorpy, "'k_eta': ", ","), speed_rad_s), weight_n, "rotorpy");
    agrees(square(written(SimulatorFormat::Flightmare, "thrust_map: [", ","), speed_rad_s), weight_n, "flightmare");
    agrees(square(written(SimulatorFormat::Crazyflow, "rpm2thrust = [0.0, 0.0, ", "]"), rpm), weight_n, "crazyflow");
    let coefficient = written(SimulatorFormat::Airsim, "real_T C_T = ", "f");
    agrees(square(coefficient * 1.17 * 0.2f64.powi(4), rev_s), weight_n, "airsim");
    agrees(
        square(written(SimulatorFormat::Json, "thrust_constant_per_rotor_n_rev_s2\": ", ","), rev_s),
        weight_n,
        "json",
    );
    // an XML comment must not contain a double hyphen
    assert!(!export_text(&rotor, SimulatorFormat::Gazebo).unwrap().contains(" -- "));
}

/// Files of the programs, shortened to the parts that are read.
#[test]
fn models_as_they_are_shipped() {
    for (text, constant, rotors, mass_kg, moment_m) in [
        (
            "<?xml version=\"1.0\"?>\n<sdf version='1.6'><model name='iris'><link name='base_link'><inertial><mass>1.5</mass>\
             </inertial></link><plugin name='front_right_motor_model' filename='libgazebo_motor_model.so'>\
             <motorConstant>5.84e-06</motorConstant><momentConstant>0.06</momentConstant></plugin></model></sdf>",
            5.84e-6,
            Some(1),
            Some(1.5),
            Some(0.06),
        ),
        (
            "<robot name=\"hummingbird\" xmlns:xacro=\"http://ros.org/wiki/xacro\"><xacro:property name=\"mass\" value=\"0.68\" />\
             <xacro:property name=\"mass_rotor\" value=\"0.009\" /><xacro:property name=\"motor_constant\" value=\"8.54858e-06\" />\
             <xacro:property name=\"moment_constant\" value=\"0.016\" /><xacro:vertical_rotor/><xacro:vertical_rotor/>\
             <xacro:vertical_rotor/><xacro:vertical_rotor/></robot>",
            8.54858e-6,
            Some(4),
            Some(0.716),
            Some(0.016),
        ),
        (
            "<?xml version=\"1.0\" ?>\n<robot name=\"cf2\"><properties arm=\"0.0397\" kf=\"3.16e-10\" km=\"7.94e-12\"/>\
             <link name=\"base_link\"><inertial><mass value=\"0.027\"/></inertial></link></robot>",
            3.16e-10 * (60.0 / TAU) * (60.0 / TAU),
            Some(4),
            Some(0.027),
            Some(7.94e-12 / 3.16e-10),
        ),
        (
            "quad_params = {\n    'mass': 0.500,       # kg\n    'num_rotors': 4,    # for looping\n    'k_eta': 5.57e-06,  # N/(rad/s)**2\n\
             \x20   'k_m':   1.36e-07,\n}\n",
            5.57e-6,
            Some(4),
            Some(0.5),
            Some(1.36e-7 / 5.57e-6),
        ),
        (
            "quadrotor_env:\n   camera: no\n  world_box: [-15, 15]\n\nquadrotor_dynamics:\n  mass: 0.73\n  motor_omega_max: 3000.0 # x\n\
             \x20 thrust_map: [1.3298253500372892e-06, 0.0038360810526746033, -1.7689986848125325]\n  kappa: 0.016\n\nrl:\n  a: 1\n",
            1.3298253500372892e-6,
            Some(4),
            Some(0.73),
            Some(0.016),
        ),
        (
            "            real_T C_T = 0.109919f; // the thrust\n            real_T C_P = 0.040164f;\n            real_T air_density = 1.225f;\n\
             \x20           real_T propeller_diameter = 0.2286f;   //diameter\n max_thrust = C_T * air_density * nsquared;\n",
            0.109919 * 1.225 * 0.2286 * 0.2286 * 0.2286 * 0.2286 / (TAU * TAU),
            None,
            None,
            Some(0.055562 / 4.179446268),
        ),
        (
            "[cf2x_L250]\nmass = 0.033\nrpm2thrust = [0.0, 0.0, 3.16e-10] # index is order\nrpm2torque = [0.0, 0.0, 7.94e-12]\n",
            3.16e-10 * (60.0 / TAU) * (60.0 / TAU),
            Some(4),
            Some(0.033),
            Some(7.94e-12 / 3.16e-10),
        ),
    ] {
        let model = model_from_text(text).unwrap_or_else(|error| panic!("{error}\n{text}"));
        agrees(model.thrust_constant_n_s2, constant, text);
        assert_eq!(model.rotor_count, rotors, "{text}");
        assert!(model.mass_kg.is_some() == mass_kg.is_some());
        assert!((model.mass_kg.unwrap_or(0.0) - mass_kg.unwrap_or(0.0)).abs() < 1e-12, "{model:?}");
        let moment = model.moment_constant_m.unwrap_or(0.0);
        assert!((moment / moment_m.unwrap_or(1.0) - 1.0).abs() < 1e-4, "{model:?}");
    }
}

#[test]
fn a_polynomial_is_more_than_its_square() {
    let text = "quadrotor_dynamics:\n  thrust_map: [1.3298e-6, 0.003836, -1.769]\n";
    let model = model_from_text(text).unwrap();
    let speed = model.speed_rad_s(1.79).unwrap();
    assert!((model.thrust_n(speed) - 1.79).abs() < 1e-9);
    assert!((model.constant_at_n_s2(speed) - 1.79 / speed.powi(2)).abs() < 1e-18);
}

#[test]
fn what_is_no_model_says_why() {
    assert_eq!(model_from_text("nothing"), Err(ModelError::Unknown));
    assert!(matches!(model_from_text("<plugin><motorConstant>1</plugin>"), Err(ModelError::Broken { .. })));
    for zero in ["<motorConstant>0.0</motorConstant>", "'k_eta': -1.0,\n", "'k_eta': nan,\n"] {
        assert!(matches!(model_from_text(zero), Err(ModelError::Quantity(_))), "{zero}");
    }
    for (text, said) in [
        ("'k_eta': 1e-6,\n'mass': -0.5,\n", "mass"),
        ("'k_eta': 1e-6,\n'mass': nan,\n", "mass"),
        ("'k_eta': 1e-6,\n'num_rotors': 0,\n", "rotors"),
        ("'k_eta': 1e-6,\n'rotor_radius': -0.1,\n", "diameter"),
    ] {
        let message = model_from_text(text).unwrap_err().to_string();
        assert!(message.contains(said) && message.contains("above 0"), "{message}");
    }
    let unlike = "<a><motorConstant>1e-6</motorConstant><motorConstant>2e-6</motorConstant></a>";
    assert!(matches!(model_from_text(unlike), Err(ModelError::UnlikeRotors { .. })));
    assert!(matches!(model_from_text("[a]\nrpm2thrust = [1.0]\n"), Err(ModelError::Incomplete { .. })));
    let rotor = IdentifiedRotor { air_density_kg_m3: None, ..rotor() };
    let refusal = export_text(&rotor, SimulatorFormat::Airsim).unwrap_err();
    let said = "the format airsim needs the density of the air, and the results do not have it";
    assert_eq!(refusal.to_string(), said);
}

/// The name of a file or a group cannot end the comment around it.
#[test]
fn names_stay_in_their_comments() {
    let names = ["two\nlines", "ends in \\", "-->", "quote \" and \u{301} accent"];
    for name in names {
        let rotor = IdentifiedRotor { vehicle_name: name.to_owned(), origin: name.to_owned(), ..rotor() };
        for format in SimulatorFormat::ALL {
            let text = export_text(&rotor, format).unwrap();
            let model = model_from_text(&text).unwrap_or_else(|error| panic!("{name:?}: {error}\n{text}"));
            assert_eq!(model.format, format, "{name:?}:\n{text}");
            assert!(!text.lines().any(|line| line.starts_with("lines")) && !text.contains("\\\n"), "{text}");
        }
    }
}

#[test]
fn a_web_page_is_no_model() {
    for page in ["<!DOCTYPE html>\n<p>motor_constant\n", "\u{feff}  <HTML><br><motorConstant>5.84e-06"] {
        let error = model_from_text(page).unwrap_err();
        assert!(matches!(error, ModelError::WebPage), "{error}");
    }
}
