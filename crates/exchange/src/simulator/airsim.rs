//! C++ of AirSim (`RotorParams.hpp`): T = C_T ρ n² D⁴, n in rev/s.

use super::header::{commented, missing_torque, number, plain};
use super::{ModelError, SimulatorFormat, SimulatorModel};
use crate::identified::IdentifiedRotor;
use crate::units::ConstantUnits;
use std::f64::consts::TAU;

pub(super) fn write(rotor: &IdentifiedRotor) -> Result<String, ModelError> {
    let needs = |what, is_one, flags| Err(ModelError::Needs { format: "airsim", what, is_one, flags });
    let (density, diameter_m) = match (rotor.air_density_kg_m3, rotor.propeller_diameter_m) {
        (Some(density), Some(diameter_m)) => (density, diameter_m),
        (None, Some(_)) => return needs("the density of the air", true, "--air-density-kg-m3"),
        (Some(_), None) => return needs("the diameter of the propellers", true, "--diameter-m"),
        (None, None) => {
            let both = "the diameter of the propellers and the density of the air";
            return needs(both, false, "--diameter-m and --air-density-kg-m3");
        }
    };
    let constant = ConstantUnits::from_n_s2(rotor.thrust_constant_n_s2);
    let coefficient = constant.coefficient(density, diameter_m);
    let mut text = commented(rotor, "//") + "// AirLib/include/vehicles/multirotor/RotorParams.hpp\n";
    text += &format!("real_T C_T = {}f; // T/(rho n^2 D^4), n in rev/s\n", number(coefficient));
    text += &match rotor.torque_constant_n_m_s2 {
        Some(torque) => {
            // AirSim: torque = C_P rho n^2 D^5 / (2 pi)
            let power = torque * TAU.powi(3) / (density * diameter_m.powi(5));
            format!("real_T C_P = {}f; // 2 pi Q/(rho n^2 D^5)\n", number(power))
        }
        None => format!("// {}\n", missing_torque("C_P")),
    };
    text += &format!("real_T air_density = {}f; // kg/m^3\n", plain(density));
    text += &format!("real_T propeller_diameter = {}f; // m\n", plain(diameter_m));
    Ok(text + "// max_rpm: copy it from your settings, and call calculateMaxThrust()\n")
}

pub(super) fn read(text: &str) -> Result<SimulatorModel, ModelError> {
    let field = |name: &str| -> Option<f64> {
        let code = text.lines().map(|line| line.split("//").next().unwrap_or(""));
        let mut values = code.filter_map(|line| {
            let (key, value) = line.split_once('=')?;
            (key.split_whitespace().last()? == name).then(|| value.trim().trim_end_matches(';').trim_end_matches('f'))
        });
        values.next_back()?.parse().ok()
    };
    let (coefficient, density, diameter_m) = (field("C_T"), field("air_density"), field("propeller_diameter"));
    let (Some(coefficient), Some(density), Some(diameter_m)) = (coefficient, density, diameter_m) else {
        return Err(ModelError::Unknown);
    };
    let constant = ConstantUnits::from_coefficient(coefficient, density, diameter_m);
    Ok(SimulatorModel {
        propeller_diameter_m: Some(diameter_m),
        moment_constant_m: field("C_P").map(|power| power / coefficient * diameter_m / TAU),
        ..SimulatorModel::square(SimulatorFormat::Airsim, constant.n_s2())
    })
}
