//! URDF of gym-pybullet-drones: `<properties kf=… km=…>`, kf in N/rpm², km in N m/rpm².

use super::header::{missing_torque, number, plain, xml_comment};
use super::xml::{constant_in, indented, model_name, parsed, rooted};
use super::{ModelError, SimulatorFormat, SimulatorModel};
use crate::identified::IdentifiedRotor;
use crate::units::ConstantUnits;

/// All drones of gym-pybullet-drones are quadrotors.
const ROTOR_COUNT: u32 = 4;

pub(super) fn write(rotor: &IdentifiedRotor) -> String {
    let kf = ConstantUnits::from_n_s2(rotor.thrust_constant_n_s2).n_rpm2();
    let mut attributes = format!("kf=\"{}\"", number(kf));
    if let Some(torque) = rotor.torque_constant_n_m_s2 {
        attributes += &format!(" km=\"{}\"", number(ConstantUnits::from_n_s2(torque).n_rpm2()));
    }
    if let Some(diameter_m) = rotor.propeller_diameter_m {
        attributes += &format!(" prop_radius=\"{}\"", plain(diameter_m / 2.0));
    }
    let mut text = xml_comment(rotor);
    text += "<!-- kf in N/rpm^2, km in N m/rpm^2; arm, thrust2weight and the other attributes: copy them from your model -->\n";
    if rotor.torque_constant_n_m_s2.is_none() {
        text += &format!("<!-- {} -->\n", missing_torque("km"));
    }
    text += &format!("<properties {attributes} />\n");
    // a parser of URDF takes a mass only with an inertia, which is not known
    text += &match rotor.mass_kg {
        Some(mass_kg) => format!(
            "<!-- for the inertial of base_link: <mass value=\"{}\" />; inertia: copy it from your model -->\n",
            plain(mass_kg)
        ),
        None => "<!-- mass and inertia: copy them from your model -->\n".to_owned(),
    };
    text += "<link name=\"base_link\" />\n";
    let name = model_name(&rotor.vehicle_name);
    format!("<?xml version=\"1.0\"?>\n<robot name=\"{name}\">\n{}</robot>\n", indented(&text, 2))
}

pub(super) fn read(text: &str) -> Result<SimulatorModel, ModelError> {
    let rooted = rooted(text);
    let document = parsed(&rooted, "URDF")?;
    let attribute = |element: &str, name: &str| -> Vec<f64> {
        let elements = document.descendants().filter(|node| node.tag_name().name() == element);
        elements.filter_map(|node| node.attribute(name)?.trim().parse().ok()).collect()
    };
    let first = |name: &str| attribute("properties", name).first().copied();
    let mut properties = document.descendants().filter(|node| node.tag_name().name() == "properties");
    let kf = constant_in("kf", properties.find_map(|node| node.attribute("kf")))?;
    let masses = attribute("mass", "value");
    Ok(SimulatorModel {
        rotor_count: Some(ROTOR_COUNT),
        mass_kg: (!masses.is_empty()).then(|| masses.iter().sum()),
        propeller_diameter_m: first("prop_radius").map(|radius_m| 2.0 * radius_m),
        moment_constant_m: first("km").map(|km| km / kf),
        ..SimulatorModel::square(SimulatorFormat::GymPybulletDrones, ConstantUnits::from_n_rpm2(kf).n_s2())
    })
}
