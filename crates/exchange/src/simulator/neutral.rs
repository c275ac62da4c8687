//! JSON and YAML for other programs, with the unit in every name.

use super::flightmare::number_of;
use super::header::{commented, missing_torque, number};
use super::{ModelError, SimulatorFormat, SimulatorModel};
use crate::identified::{IdentifiedRotor, json_fault};
use crate::units::ConstantUnits;
use saphyr::{LoadableYamlNode, Yaml};
use serde::{Deserialize, Serialize};
use serde_json::error::Category;

#[derive(Serialize, Deserialize)]
struct Neutral {
    vehicle: String,
    thrust_constant_per_rotor_n_s2: f64,
    thrust_constant_per_rotor_n_rev_s2: f64,
    thrust_constant_per_rotor_n_rpm2: f64,
    thrust_constant_per_rotor_g_rpm2: f64,
    thrust_constant_total_n_s2: f64,
    expanded_uncertainty_per_rotor_n_s2: Option<f64>,
    coverage_factor: f64,
    rotor_count: u32,
    mass_kg: Option<f64>,
    gravity_m_s2: f64,
    hover_speed_rad_s: Option<f64>,
    propeller_diameter_m: Option<f64>,
    air_density_kg_m3: Option<f64>,
    moment_constant_m: Option<f64>,
    made_by: String,
}

fn neutral(rotor: &IdentifiedRotor) -> Neutral {
    let units = ConstantUnits::from_n_s2(rotor.thrust_constant_n_s2);
    Neutral {
        vehicle: rotor.vehicle_name.clone(),
        thrust_constant_per_rotor_n_s2: units.n_s2(),
        thrust_constant_per_rotor_n_rev_s2: units.n_rev_s2(),
        thrust_constant_per_rotor_n_rpm2: units.n_rpm2(),
        thrust_constant_per_rotor_g_rpm2: units.g_rpm2(),
        thrust_constant_total_n_s2: units.n_s2() * f64::from(rotor.rotor_count),
        expanded_uncertainty_per_rotor_n_s2: rotor.expanded_uncertainty_n_s2,
        coverage_factor: 2.0,
        rotor_count: rotor.rotor_count,
        mass_kg: rotor.mass_kg,
        gravity_m_s2: rotor.gravity_m_s2,
        hover_speed_rad_s: rotor.hover_speed_by_balance_rad_s(),
        propeller_diameter_m: rotor.propeller_diameter_m,
        air_density_kg_m3: rotor.air_density_kg_m3,
        moment_constant_m: rotor.moment_constant_m(),
        made_by: rotor.origin.clone(),
    }
}

pub(super) fn write_json(rotor: &IdentifiedRotor) -> Result<String, ModelError> {
    let json = serde_json::to_string_pretty(&neutral(rotor));
    json.map(|text| text + "\n").map_err(|error| ModelError::Broken { format: "JSON", reason: error.to_string() })
}

pub(super) fn write_yaml(rotor: &IdentifiedRotor) -> String {
    let all = neutral(rotor);
    let optional = |value: Option<f64>| value.map_or("null".to_owned(), number);
    let mut text = commented(rotor, "#");
    for (name, value) in [
        // a JSON string is a valid YAML string
        ("vehicle", serde_json::Value::from(all.vehicle).to_string()),
        ("thrust_constant_per_rotor_n_s2", number(all.thrust_constant_per_rotor_n_s2)),
        ("thrust_constant_per_rotor_n_rev_s2", number(all.thrust_constant_per_rotor_n_rev_s2)),
        ("thrust_constant_per_rotor_n_rpm2", number(all.thrust_constant_per_rotor_n_rpm2)),
        ("thrust_constant_per_rotor_g_rpm2", number(all.thrust_constant_per_rotor_g_rpm2)),
        ("thrust_constant_total_n_s2", number(all.thrust_constant_total_n_s2)),
        ("expanded_uncertainty_per_rotor_n_s2", optional(all.expanded_uncertainty_per_rotor_n_s2)),
        ("coverage_factor", number(all.coverage_factor)),
        ("rotor_count", all.rotor_count.to_string()),
        ("mass_kg", optional(all.mass_kg)),
        ("gravity_m_s2", number(all.gravity_m_s2)),
        ("hover_speed_rad_s", optional(all.hover_speed_rad_s)),
        ("propeller_diameter_m", optional(all.propeller_diameter_m)),
        ("air_density_kg_m3", optional(all.air_density_kg_m3)),
        ("moment_constant_m", optional(all.moment_constant_m)),
    ] {
        text += &format!("{name}: {value}\n");
    }
    if all.moment_constant_m.is_none() {
        text += &format!("# {}\n", missing_torque("moment_constant_m"));
    }
    text
}

pub(super) fn read(text: &str) -> Result<SimulatorModel, ModelError> {
    if text.trim_start().starts_with('{') {
        let broken = |error: serde_json::Error| match error.classify() {
            Category::Data => ModelError::NoExport,
            _ => ModelError::Broken { format: "JSON", reason: json_fault(&error) },
        };
        let all: Neutral = serde_json::from_str(text).map_err(broken)?;
        return Ok(SimulatorModel {
            rotor_count: Some(all.rotor_count),
            mass_kg: all.mass_kg,
            propeller_diameter_m: all.propeller_diameter_m,
            moment_constant_m: all.moment_constant_m,
            ..SimulatorModel::square(SimulatorFormat::Json, all.thrust_constant_per_rotor_n_s2)
        });
    }
    let broken = |reason: String| ModelError::Broken { format: "YAML", reason };
    let documents = Yaml::load_from_str(text).map_err(|error| broken(error.to_string()))?;
    let all = documents.first().ok_or(ModelError::Unknown)?;
    let of = |name: &str| all.as_mapping_get(name).and_then(number_of);
    Ok(SimulatorModel {
        rotor_count: of("rotor_count").map(|count| count as u32),
        mass_kg: of("mass_kg"),
        propeller_diameter_m: of("propeller_diameter_m"),
        moment_constant_m: of("moment_constant_m"),
        ..SimulatorModel::square(
            SimulatorFormat::Yaml,
            of("thrust_constant_per_rotor_n_s2").ok_or(ModelError::Unknown)?,
        )
    })
}
