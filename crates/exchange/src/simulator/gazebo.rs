//! SDF of Gazebo (gz-sim and classic) and PX4: one motor plugin for each rotor, motorConstant in N/(rad/s)², momentConstant in m.

use super::header::{missing_torque, number, plain, xml_comment};
use super::xml::{constant_in, indented, model_name, numbers_in, parsed, rooted, shared};
use super::{ModelError, SimulatorFormat, SimulatorModel};
use crate::identified::IdentifiedRotor;

pub(super) fn write(rotor: &IdentifiedRotor) -> String {
    let moment = match rotor.moment_constant_m() {
        Some(moment_m) => format!("<momentConstant>{}</momentConstant> <!-- torque/thrust, m -->", number(moment_m)),
        None => format!("<!-- {} -->", missing_torque("momentConstant")),
    };
    let plugins: String = (0..rotor.rotor_count)
        .map(|index| {
            format!(
                "<plugin filename=\"gz-sim-multicopter-motor-model-system\" name=\"gz::sim::systems::MulticopterMotorModel\">\n\
                 \x20 <!-- for Gazebo Classic: name='motor_{index}' filename='libgazebo_motor_model.so'; all elements stay the same -->\n\
                 \x20 <jointName>rotor_{index}_joint</jointName>\n\
                 \x20 <linkName>rotor_{index}</linkName>\n\
                 \x20 <motorNumber>{index}</motorNumber>\n\
                 \x20 <motorType>velocity</motorType>\n\
                 \x20 <!-- turningDirection, timeConstantUp, timeConstantDown, maxRotVelocity: copy them from your model -->\n\
                 \x20 <motorConstant>{}</motorConstant> <!-- N/(rad/s)^2 -->\n\
                 \x20 {moment}\n\
                 </plugin>\n",
                number(rotor.thrust_constant_n_s2)
            )
        })
        .collect();
    let mass = match rotor.mass_kg {
        Some(mass_kg) => {
            format!(
                "<inertial>\n  <mass>{}</mass> <!-- kg, of the whole vehicle -->\n  <!-- inertia: copy it from \
                your model -->\n</inertial>",
                plain(mass_kg)
            )
        }
        None => "<!-- mass and inertia: copy them from your model -->".to_owned(),
    };
    let links = "<!-- the links rotor_N and their joints rotor_N_joint: copy them from your model -->\n";
    let base = format!("<link name=\"base_link\">\n{}</link>\n", indented(&mass, 2));
    let model = indented(&format!("{base}{links}{plugins}"), 4);
    let comment = indented(&xml_comment(rotor), 2);
    let name = model_name(&rotor.vehicle_name);
    format!(
        "<?xml version=\"1.0\"?>\n<sdf version=\"1.6\">\n{comment}  <model name=\"{name}\">\n{model}  </model>\n</sdf>\n"
    )
}

pub(super) fn read(text: &str) -> Result<SimulatorModel, ModelError> {
    let rooted = rooted(text);
    let document = parsed(&rooted, "SDF")?;
    let elements = document.descendants().filter(|node| node.tag_name().name() == "motorConstant");
    let constants: Vec<f64> =
        elements.map(|node| constant_in("motorConstant", node.text())).collect::<Result<_, _>>()?;
    let masses = numbers_in(&document, "mass");
    Ok(SimulatorModel {
        rotor_count: u32::try_from(constants.len()).ok(),
        mass_kg: (!masses.is_empty()).then(|| masses.iter().sum()),
        moment_constant_m: numbers_in(&document, "momentConstant").first().copied(),
        ..SimulatorModel::square(SimulatorFormat::Gazebo, shared(&constants)?)
    })
}
