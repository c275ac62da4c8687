//! The identified vehicle as a scenario file.

use super::flight::GreyBoxVehicle;
use crate::failure::Failure;
use hovertone_dynamics::{GreyBoxFit, IdentifiedVehicle};
use hovertone_sim::scenario::{ControllerSection, ScenarioFile, SpreadSection, VehicleSection};
use hovertone_vehicle::GRAVITY_STANDARD_M_S2;

const HEAD: &str = "# The identified vehicle of `hovertone greybox`. Gains and inertia are identified; the voltage \
                    scale and all other numbers come from the preset.\n";

/// The identified vehicle, to be flown by `hovertone simulate`: a hover, to which manoeuvres can be added.
pub(crate) fn scenario_file(fit: &GreyBoxFit, vehicle: &GreyBoxVehicle) -> ScenarioFile {
    let IdentifiedVehicle { vehicle: identified, thrust_shares, motor_gains } =
        fit.vehicle(&vehicle.parameters, vehicle.mass_kg * GRAVITY_STANDARD_M_S2);
    let controller = &identified.controller;
    ScenarioFile {
        vehicle: VehicleSection {
            preset: vehicle.id().to_owned(),
            mass_kg: Some(vehicle.mass_kg),
            thrust_constant_per_rotor_n_s2: Some(identified.rotor.thrust_constant_n_s2.value),
            motor_inertia_kg_m2: Some(identified.motor.inertia_kg_m2.value),
            ..VehicleSection::default()
        },
        controller: Some(ControllerSection {
            roll: Some(controller.roll.value.into()),
            pitch: Some(controller.pitch.value.into()),
            yaw_rate: Some(controller.yaw_rate.value.into()),
            climb: Some(controller.climb.value.into()),
            ..ControllerSection::default()
        }),
        spread: Some(SpreadSection {
            thrust_shares: Some(thrust_shares),
            motor_gains: Some(motor_gains),
            ..SpreadSection::default()
        }),
        ..ScenarioFile::default()
    }
}

/// Its text.
pub(crate) fn scenario_toml(fit: &GreyBoxFit, vehicle: &GreyBoxVehicle) -> Result<String, Failure> {
    let text = toml::to_string(&scenario_file(fit, vehicle)).map_err(Failure::internal)?;
    Ok(format!("{HEAD}\n{text}"))
}
