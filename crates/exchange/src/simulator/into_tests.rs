//! Models of other people in which only the measured numbers change.

use super::tests::{agrees, rotor};
use super::*;

/// A file of each program, with comments, odd spacing and other numbers that must stay; and what stands in place of the old number.
const FILES: [(SimulatorFormat, &str, &str, &str); 7] = [
    (
        SimulatorFormat::Gazebo,
        "\u{feff}<?xml version='1.0'?>\r\n<!-- <motorConstant>1</motorConstant> -->\r\n<sdf version='1.6'>\r\n <model name='iris'>\r\n  \
         <plugin name='a' filename='b'>\r\n   <motorConstant> 5.84e-06 </motorConstant> <!-- mine -->\r\n   \
         <momentConstant>0.06</momentConstant>\r\n  </plugin>\r\n </model>\r\n</sdf>\r\n",
        " 5.84e-06 ",
        " 7.0775300e-6 ",
    ),
    (
        SimulatorFormat::Rotors,
        "<?xml version=\"1.0\"?>\n<robot name=\"hummingbird\" xmlns:xacro=\"http://ros.org/wiki/xacro\">\n  \
         <xacro:property name=\"motor_constant\" value='8.54858e-06' /> <!-- [kg.m/s^2] -->\n  \
         <xacro:property value=\"0.016\" name=\"moment_constant\" />\n  <motorConstant>${motor_constant}</motorConstant>\n</robot>\n",
        "'8.54858e-06'",
        "'7.0775300e-6'",
    ),
    (
        SimulatorFormat::GymPybulletDrones,
        "<?xml version=\"1.0\" ?>\n<robot name=\"cf2\">\n  <properties arm=\"0.0397\" kf=\"3.16e-10\" km=\"7.94e-12\" thrust2weight=\"2.25\" />\n\
         </robot>\n",
        "kf=\"3.16e-10\"",
        "kf=\"7.7613801e-8\"",
    ),
    (
        SimulatorFormat::Rotorpy,
        "# 'k_eta': 1.0,\nquad_params = {\n    'k_eta': 5.57e-06,   # N/(rad/s)**2\n    'k_m':   1.36e-07,\n    'c': [1, 2],\n}\n",
        " 5.57e-06,   #",
        " 7.0775300e-6,   #",
    ),
    (
        SimulatorFormat::Flightmare,
        "quadrotor_dynamics:\n  mass: 0.73\n  thrust_map: [1.3298e-06, 0.003836, -1.7689] # a\n  kappa: 0.016 # b\n",
        "[1.3298e-06, 0.003836, -1.7689]",
        "[7.0775300e-6, 0.0, 0.0]",
    ),
    (
        SimulatorFormat::Crazyflow,
        "[cf2x]\nmass = 0.033 # kg\nrpm2thrust = [0.0, 0.0, 3.16e-10] # N\nrpm2torque = [0.0, 0.0, 7.94e-12]\n",
        "[0.0, 0.0, 3.16e-10]",
        "[0.0, 0.0, 7.7613801e-8]",
    ),
    (
        SimulatorFormat::Airsim,
        "struct RotorParams {\n    real_T C_T = 0.109919f; // C_T = 1\n    real_T C_P = 0.040164f;\n    real_T air_density = 1.225f;\n    \
         real_T propeller_diameter = 0.2286f;\n};\n",
        " 0.109919f;",
        " 8.3521919e-2f;",
    ),
];

#[test]
fn only_the_measured_numbers_change() {
    for (format, text, old, new) in FILES {
        let updated = updated_model(text, &rotor()).unwrap_or_else(|error| panic!("{}: {error}", format.name()));
        agrees(
            model_from_text(&updated.text).unwrap().thrust_constant_n_s2,
            rotor().thrust_constant_n_s2,
            format.name(),
        );
        let (before, after) = text.split_once(old).unwrap();
        assert!(updated.text.starts_with(&format!("{before}{new}")), "{}", updated.text);
        assert!(updated.text.ends_with(after), "{}", updated.text);
        let [change] = &updated.changes[..] else { panic!("one line changes: {:?}", updated.changes) };
        // a carriage return before the line feed is a part of the line
        assert_eq!(text.split('\n').nth(change.line_number - 1).unwrap(), change.before);
        assert!(
            updated_model(&updated.text, &rotor()).unwrap().changes.len()
                <= usize::from(format == SimulatorFormat::Airsim)
        );
    }
}

#[test]
fn a_measured_torque_changes_too() {
    let with_torque = IdentifiedRotor { torque_constant_n_m_s2: Some(2.1308e-7), ..rotor() };
    for (format, text, ..) in FILES {
        let updated = updated_model(text, &with_torque).unwrap();
        let moment_m = model_from_text(&updated.text).unwrap().moment_constant_m.unwrap();
        let expected_m = with_torque.moment_constant_m().unwrap();
        assert!((moment_m / expected_m - 1.0).abs() < 1e-6, "{}: {moment_m} {expected_m}", format.name());
    }
}

#[test]
fn every_rotor_of_a_model_is_changed_and_an_expression_is_refused() {
    let plugin = "<plugin>\n<motorConstant>5.84e-06</motorConstant>\n</plugin>\n";
    let updated = updated_model(&format!("<sdf>\n{}</sdf>\n", plugin.repeat(4)), &rotor()).unwrap();
    assert_eq!(updated.changes.len(), 4);
    let mixed = format!("<sdf>{plugin}<plugin><motorConstant>${{k}}</motorConstant></plugin></sdf>");
    assert!(matches!(updated_model(&mixed, &rotor()), Err(ModelError::Expression { .. })));
    assert!(matches!(
        updated_model("'k_eta': 5e-6*2,\n'k_eta': 5e-6,\n", &rotor()),
        Err(ModelError::Expression { .. })
    ));
}

#[test]
fn every_export_can_be_brought_up_to_date_or_is_written_again() {
    let newer = IdentifiedRotor { thrust_constant_n_s2: 6.5e-6, ..rotor() };
    for format in SimulatorFormat::ALL {
        let text = export_text(&rotor(), format).unwrap();
        match updated_model(&text, &newer) {
            Ok(updated) => agrees(model_from_text(&updated.text).unwrap().thrust_constant_n_s2, 6.5e-6, format.name()),
            Err(error) => {
                assert_eq!(error, ModelError::OwnExport);
                assert!(matches!(format, SimulatorFormat::Json | SimulatorFormat::Yaml));
            }
        }
    }
}

#[test]
fn exports_of_xml_are_whole_files_with_one_root() {
    for (format, root) in [
        (SimulatorFormat::Gazebo, "sdf"),
        (SimulatorFormat::Rotors, "robot"),
        (SimulatorFormat::GymPybulletDrones, "robot"),
    ] {
        for rotor in [rotor(), IdentifiedRotor { mass_kg: None, propeller_diameter_m: None, ..rotor() }] {
            let text = export_text(&rotor, format).unwrap();
            assert!(text.starts_with("<?xml version=\"1.0\"?>\n"), "{text}");
            let document = roxmltree::Document::parse(&text).unwrap_or_else(|error| panic!("{error}\n{text}"));
            assert_eq!(document.root_element().tag_name().name(), root);
            assert!(document.descendants().any(|node| node.has_tag_name("link")) || format == SimulatorFormat::Rotors);
        }
    }
}
