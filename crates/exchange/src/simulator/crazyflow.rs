//! TOML of drone-models, which crazyflow flies: `rpm2thrust` is [a, b, c] of a + b rpm + c rpm² in N for one motor.

use super::header::{commented, missing_torque, number, plain};
use super::{ModelError, SimulatorFormat, SimulatorModel};
use crate::identified::IdentifiedRotor;
use crate::units::ConstantUnits;
use std::f64::consts::TAU;
use toml::{Table, Value};

/// All vehicles of crazyflow are quadrotors.
const ROTOR_COUNT: u32 = 4;

pub(super) fn write(rotor: &IdentifiedRotor) -> String {
    let constant = ConstantUnits::from_n_s2(rotor.thrust_constant_n_s2);
    let mut text = commented(rotor, "#");
    text += &format!("[{}]\n", table_name(&rotor.vehicle_name));
    if let Some(mass_kg) = rotor.mass_kg {
        text += &format!("mass = {} # kg\n", plain(mass_kg));
    }
    text += &format!("gravity_vec = [0.0, 0.0, -{}] # m/s^2\n", plain(rotor.gravity_m_s2));
    text +=
        &format!("rpm2thrust = [0.0, 0.0, {}] # N = [0] + [1] rpm + [2] rpm^2, one motor\n", number(constant.n_rpm2()));
    text += &match rotor.torque_constant_n_m_s2 {
        Some(torque) => {
            format!("rpm2torque = [0.0, 0.0, {}] # N m\n", number(ConstantUnits::from_n_s2(torque).n_rpm2()))
        }
        None => format!("# {}\n", missing_torque("rpm2torque")),
    };
    if let Some(diameter_m) = rotor.propeller_diameter_m {
        text += &format!("prop_radius = {} # m\n", plain(diameter_m / 2.0));
    }
    text
}

/// A name that TOML takes without quotes: `parrot_ar_drone` of "Parrot AR.Drone (the paper's)".
fn table_name(vehicle_name: &str) -> String {
    let without_remark = vehicle_name.split('(').next().unwrap_or_default();
    let words = |name: &str| {
        let words = name.split(|c: char| !c.is_ascii_alphanumeric()).filter(|word| !word.is_empty());
        words.map(str::to_ascii_lowercase).collect::<Vec<_>>().join("_")
    };
    let names = [words(without_remark), words(vehicle_name), "vehicle".to_owned()];
    names.into_iter().find(|name| !name.is_empty()).unwrap_or_default()
}

pub(super) fn read(text: &str) -> Result<SimulatorModel, ModelError> {
    let broken = |reason: String| ModelError::Broken { format: "TOML", reason };
    let incomplete = |reason: String| ModelError::Incomplete { reason };
    let file: Table = toml::from_str(text).map_err(|error| broken(error.message().to_owned()))?;
    let vehicles: Vec<&Table> =
        file.values().filter_map(Value::as_table).filter(|vehicle| vehicle.contains_key("rpm2thrust")).collect();
    let vehicle = match vehicles[..] {
        [vehicle] => vehicle,
        [] => return Err(incomplete("no vehicle in it has the key rpm2thrust".to_owned())),
        _ => {
            let count = vehicles.len();
            return Err(incomplete(format!("{count} vehicles in it have the key rpm2thrust, but it must be one")));
        }
    };
    let number = |value: &Value| value.as_float().or_else(|| value.as_integer().map(|whole| whole as f64));
    let polynomial = |name: &str| -> Option<[f64; 3]> {
        let list: Vec<f64> = vehicle.get(name)?.as_array()?.iter().filter_map(number).collect();
        list.try_into().ok()
    };
    let [a, b, c] =
        polynomial("rpm2thrust").ok_or_else(|| incomplete("rpm2thrust must have three numbers".to_owned()))?;
    let rpm_per_rad_s = 60.0 / TAU;
    Ok(SimulatorModel {
        thrust_linear_n_s: b * rpm_per_rad_s,
        thrust_offset_n: a,
        rotor_count: Some(ROTOR_COUNT),
        mass_kg: vehicle.get("mass").and_then(number),
        propeller_diameter_m: vehicle.get("prop_radius").and_then(number).map(|radius_m| 2.0 * radius_m),
        moment_constant_m: polynomial("rpm2torque").map(|[_, _, torque]| torque / c),
        ..SimulatorModel::square(SimulatorFormat::Crazyflow, ConstantUnits::from_n_rpm2(c).n_s2())
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_name_of_a_table_is_words_with_one_underscore_between_them() {
        for (vehicle_name, expected) in [
            ("Parrot AR.Drone (the paper's)", "parrot_ar_drone"),
            ("My drone", "my_drone"),
            ("(first) drone", "first_drone"),
            ("Дрон", "vehicle"),
        ] {
            assert_eq!(table_name(vehicle_name), expected);
        }
    }
}
