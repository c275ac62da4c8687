//! xacro of RotorS: properties, motor_constant in N/(rad/s)² (its files say kg·m/s² by mistake), moment_constant in m.

use super::header::{missing_torque, number, plain, xml_comment};
use super::xml::{constant_in, indented, model_name, parsed, rooted};
use super::{ModelError, SimulatorFormat, SimulatorModel};
use crate::identified::IdentifiedRotor;

pub(super) fn write(rotor: &IdentifiedRotor) -> String {
    let property = |name: &str, value: String, unit: &str| {
        format!("<xacro:property name=\"{name}\" value=\"{value}\" /> <!-- [{unit}] -->\n")
    };
    let mut text =
        xml_comment(rotor) + "<!-- use: <xacro:include filename=\"…\" /> behind the properties of your vehicle -->\n";
    if let Some(mass_kg) = rotor.mass_kg {
        text += "<!-- mass is the mass of the whole vehicle; RotorS adds mass_rotor for each rotor: subtract these \
        from mass -->\n";
        text += &property("mass", plain(mass_kg), "kg");
    }
    text += &rotor
        .propeller_diameter_m
        .map_or(String::new(), |diameter_m| property("radius_rotor", plain(diameter_m / 2.0), "m"));
    text += &property("motor_constant", number(rotor.thrust_constant_n_s2), "N/(rad/s)^2 = kg m");
    text += &match rotor.moment_constant_m() {
        Some(moment_m) => property("moment_constant", number(moment_m), "m"),
        None => format!("<!-- {} -->\n", missing_torque("moment_constant")),
    };
    let name = model_name(&rotor.vehicle_name);
    let root = format!("<robot name=\"{name}\" xmlns:xacro=\"http://www.ros.org/wiki/xacro\">");
    format!("<?xml version=\"1.0\"?>\n{root}\n{}</robot>\n", indented(&text, 2))
}

pub(super) fn read(text: &str) -> Result<SimulatorModel, ModelError> {
    let rooted = rooted(text);
    let document = parsed(&rooted, "xacro")?;
    let text_of = |name: &str| {
        let named = document
            .descendants()
            .find(|node| node.tag_name().name() == "property" && node.attribute("name") == Some(name));
        named?.attribute("value")
    };
    let property = |name: &str| -> Option<f64> { text_of(name)?.trim().parse().ok() };
    let constant = constant_in("motor_constant", text_of("motor_constant"))?;
    let rotors = document.descendants().filter(|node| node.tag_name().name() == "vertical_rotor").count();
    Ok(SimulatorModel {
        rotor_count: u32::try_from(rotors).ok().filter(|count| *count > 0),
        // the mass of the frame alone, since the rotors have masses of their own
        mass_kg: property("mass").map(|frame_kg| frame_kg + rotors as f64 * property("mass_rotor").unwrap_or(0.0)),
        propeller_diameter_m: property("radius_rotor").map(|radius_m| 2.0 * radius_m),
        moment_constant_m: property("moment_constant"),
        ..SimulatorModel::square(SimulatorFormat::Rotors, constant)
    })
}
