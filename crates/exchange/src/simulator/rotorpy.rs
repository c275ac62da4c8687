//! Python of RotorPy: a dictionary with k_eta in N/(rad/s)² and k_m in N m/(rad/s)².

use super::header::{commented, missing_torque, number, plain};
use super::{ModelError, SimulatorFormat, SimulatorModel};
use crate::identified::IdentifiedRotor;

pub(super) fn write(rotor: &IdentifiedRotor) -> String {
    let mut text = commented(rotor, "#");
    text += "#\n# use: from rotorpy.vehicles.hummingbird_params import quad_params; quad_params.update(identified)\n";
    text += "identified = {\n";
    if let Some(mass_kg) = rotor.mass_kg {
        text += &format!("    'mass': {},  # kg\n", plain(mass_kg));
    }
    // a rotor of a stand is one of a vehicle that has more
    text += &match rotor.rotor_count {
        1 => "    # 'num_rotors': one rotor was measured alone: keep the number of your vehicle\n".to_owned(),
        count => format!("    'num_rotors': {count},\n"),
    };
    if let Some(diameter_m) = rotor.propeller_diameter_m {
        text += &format!("    'rotor_radius': {},  # m\n", plain(diameter_m / 2.0));
    }
    text += &format!("    'k_eta': {},  # N/(rad/s)**2\n", number(rotor.thrust_constant_n_s2));
    text += &match rotor.torque_constant_n_m_s2 {
        Some(torque) => format!("    'k_m': {},  # Nm/(rad/s)**2\n", number(torque)),
        None => format!("    # {}\n", missing_torque("'k_m'")),
    };
    text + "}\n"
}

pub(super) fn read(text: &str) -> Result<SimulatorModel, ModelError> {
    let entry = |name: &str| -> Option<f64> {
        let line = text.lines().map(str::trim_start).filter(|line| !line.starts_with('#'));
        let mut value = line.filter_map(|line| {
            let (key, value) = line.split_once(':')?;
            (key.trim().trim_matches(['\'', '"']) == name).then_some(value)
        });
        let value = value.next_back()?.split(['#', ',']).next()?.trim();
        value.parse().ok()
    };
    let k_eta = entry("k_eta").ok_or(ModelError::Unknown)?;
    Ok(SimulatorModel {
        rotor_count: entry("num_rotors").map(|count| count as u32),
        mass_kg: entry("mass"),
        propeller_diameter_m: entry("rotor_radius").map(|radius_m| 2.0 * radius_m),
        moment_constant_m: entry("k_m").map(|k_m| k_m / k_eta),
        ..SimulatorModel::square(SimulatorFormat::Rotorpy, k_eta)
    })
}
