//! YAML of Flightmare: `quadrotor_dynamics.thrust_map`, thrust of one motor as [c, b, a] of c ω² + b ω + a, ω in rad/s.

use super::header::{commented, missing_torque, number, plain};
use super::{ModelError, SimulatorFormat, SimulatorModel};
use crate::identified::IdentifiedRotor;
use saphyr::{LoadableYamlNode, Yaml};

/// The vehicle of Flightmare is a quadrotor.
const ROTOR_COUNT: u32 = 4;

pub(super) fn write(rotor: &IdentifiedRotor) -> String {
    let mut text = commented(rotor, "#") + "quadrotor_dynamics:\n";
    if let Some(mass_kg) = rotor.mass_kg {
        text += &format!("  mass: {} # kg\n", plain(mass_kg));
    }
    text += &format!(
        "  thrust_map: [{}, 0.0, 0.0] # N = [0] w^2 + [1] w + [2], w in rad/s\n",
        number(rotor.thrust_constant_n_s2)
    );
    text += &match rotor.moment_constant_m() {
        Some(kappa_m) => format!("  kappa: {} # torque/thrust, m\n", number(kappa_m)),
        None => format!("  # {}\n", missing_torque("kappa")),
    };
    text
}

pub(super) fn read(text: &str) -> Result<SimulatorModel, ModelError> {
    // the file of Flightmare is invalid YAML by its indentation; all needed keys stand in one section
    let section = text.split_once("quadrotor_dynamics:").ok_or(ModelError::Unknown)?.1;
    let lines = section.lines().skip(1).take_while(|line| line.is_empty() || line.starts_with([' ', '#']));
    let section: String = lines.map(|line| format!("{line}\n")).collect();
    let broken = |reason: String| ModelError::Broken { format: "YAML", reason };
    let documents = Yaml::load_from_str(&section).map_err(|error| broken(error.to_string()))?;
    let dynamics = documents.first().ok_or(ModelError::Unknown)?;
    let map = dynamics.as_mapping_get("thrust_map").and_then(Yaml::as_sequence).ok_or(ModelError::Unknown)?;
    let map: Vec<f64> = map.iter().filter_map(number_of).collect();
    let [c, b, a] = map[..] else {
        return Err(ModelError::Incomplete { reason: "thrust_map must have three numbers".to_owned() });
    };
    let of = |name: &str| dynamics.as_mapping_get(name).and_then(number_of);
    Ok(SimulatorModel {
        thrust_linear_n_s: b,
        thrust_offset_n: a,
        rotor_count: Some(ROTOR_COUNT),
        mass_kg: of("mass"),
        moment_constant_m: of("kappa"),
        ..SimulatorModel::square(SimulatorFormat::Flightmare, c)
    })
}

/// A number, also one without a decimal point.
pub(super) fn number_of(yaml: &Yaml<'_>) -> Option<f64> {
    yaml.as_floating_point().or_else(|| yaml.as_integer().map(|whole| whole as f64))
}
