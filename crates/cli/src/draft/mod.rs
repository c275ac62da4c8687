//! An experiment that a person describes by flags or answers, and its text as an experiment file.

mod masses;
mod paths;
mod text;

pub(crate) use masses::{LoadDraft, loads_from_words, mass_kg_from_text, mass_words, put_load};
pub(crate) use paths::recordings_from;

use crate::args::DraftArguments;
use crate::failure::Failure;
use crate::place::{gravity_of, refuse_height_alone};
use hovertone_vehicle::{
    Gear, KnownRotor, MASS_FACTOR_MAX, SaidOfVehicle, Vehicle, are_masses_of_one_vehicle, check_diameter,
};

/// An experiment without its settings.
#[derive(Clone, Debug, Default)]
pub(crate) struct Draft {
    /// Name of a known vehicle.
    pub(crate) preset: Option<String>,
    /// Number of rotors.
    pub(crate) rotors: Option<u32>,
    /// Blades of each propeller.
    pub(crate) blades: Option<u32>,
    /// Gear between motor and rotor.
    pub(crate) gear: Option<Gear>,
    /// Diameter of a propeller.
    pub(crate) diameter_m: Option<f64>,
    /// Band in which the tone lies, Hz.
    pub(crate) band_hz: Option<(f64, f64)>,
    /// Number of harmonics to follow.
    pub(crate) harmonics: Option<u32>,
    /// Local gravity, or the place of the flights.
    pub(crate) gravity_m_s2: Option<f64>,
    pub(crate) latitude_deg: Option<f64>,
    pub(crate) height_m: Option<f64>,
    /// Correction of the recorder's clock, in millionths.
    pub(crate) clock_correction_ppm: Option<f64>,
    /// The loads.
    pub(crate) loads: Vec<LoadDraft>,
}

impl Draft {
    /// What the flags say, checked against limits and against the vehicle.
    pub(crate) fn from_arguments(arguments: &DraftArguments, vehicle: Option<&Vehicle>) -> Result<Self, Failure> {
        gravity_of(&arguments.place)?;
        refuse_height_alone(&arguments.place)?;
        arguments.gear.map_or(Ok(()), Gear::check)?;
        let said = SaidOfVehicle {
            blades: arguments.blades,
            gear: arguments.gear,
            rotors: arguments.rotors,
            is_hovering: true,
            ..SaidOfVehicle::default()
        };
        vehicle.map_or(Ok(()), |vehicle| vehicle.check_said(&said))?;
        arguments.diameter_m.map_or(Ok(()), |diameter_m| check_diameter("diameter_m", diameter_m))?;
        let draft = Self {
            preset: arguments.vehicle.clone(),
            rotors: arguments.rotors,
            blades: arguments.blades,
            gear: arguments.gear,
            diameter_m: arguments.diameter_m,
            band_hz: arguments.band,
            harmonics: arguments.harmonics,
            gravity_m_s2: arguments.place.gravity_m_s2,
            latitude_deg: arguments.place.latitude_deg,
            height_m: arguments.place.height_m,
            clock_correction_ppm: None,
            loads: loads_from_words(&arguments.mass)?,
        };
        draft.check_masses(vehicle)?;
        draft.check_hovers(vehicle)?;
        Ok(draft)
    }

    /// Refuses masses that are not of one vehicle, or not of the known one.
    fn check_masses(&self, vehicle: Option<&Vehicle>) -> Result<(), Failure> {
        let masses_kg = || self.loads.iter().map(|load| load.mass_kg);
        let Some(lightest_kg) = masses_kg().min_by(f64::total_cmp) else { return Ok(()) };
        let said = SaidOfVehicle { mass_kg: Some(lightest_kg), ..SaidOfVehicle::default() };
        vehicle.map_or(Ok(()), |vehicle| vehicle.check_said(&said)).map_err(|contradiction| {
            Failure::usage(format!("--mass {lightest_kg}: {contradiction}"), contradiction.hint())
        })?;
        let Some(heavy_kg) = masses_kg().find(|mass_kg| !are_masses_of_one_vehicle(*mass_kg, lightest_kg)) else {
            return Ok(());
        };
        let of_vehicle = vehicle.and_then(|vehicle| Some((vehicle.id, vehicle.mass_kg?.value)));
        let weighs = of_vehicle.map_or_else(String::new, |(id, mass_kg)| {
            format!(", and the vehicle \"{id}\" weighs {}", mass_words(mass_kg))
        });
        let what = format!(
            "--mass {} and --mass {}: the masses of one vehicle cannot differ by more than a factor of {MASS_FACTOR_MAX}{weighs}",
            mass_words(heavy_kg),
            mass_words(lightest_kg)
        );
        let hint = match of_vehicle {
            Some((_, mass_kg)) => {
                let is_light = mass_kg / lightest_kg > heavy_kg / mass_kg;
                let far = mass_words(if is_light { lightest_kg } else { heavy_kg });
                format!("check the decimal point and the unit of --mass {far}")
            }
            None => {
                "check the decimal points and the units of both masses: 0.413 (kg) and 413g are the same".to_owned()
            }
        };
        Err(Failure::usage(what, hint))
    }

    /// Refuses propellers that cannot carry the loads.
    fn check_hovers(&self, vehicle: Option<&Vehicle>) -> Result<(), Failure> {
        let of_vehicle = vehicle.map(KnownRotor::of_vehicle).unwrap_or_default();
        let known = KnownRotor {
            diameter_m: self.diameter_m.or(of_vehicle.diameter_m),
            rotor_count: self.rotors.or(of_vehicle.rotor_count),
            ..of_vehicle
        };
        let check = |load: &LoadDraft| KnownRotor { mass_kg: Some(load.mass_kg), ..known }.check_hover();
        Ok(self.loads.iter().try_for_each(check)?)
    }

    /// The flags that are still needed before the draft describes an experiment.
    pub(crate) fn missing(&self, vehicle: Option<&Vehicle>) -> Vec<&'static str> {
        let has_tone = self.blades.is_some()
            || self.gear.is_some()
            || vehicle.is_some_and(|vehicle| vehicle.tone_order().is_some());
        let has_rotors = self.rotors.is_some() || vehicle.is_some();
        let needs: [(bool, &'static str); 4] = [
            (
                vehicle.is_some() || has_tone,
                if has_rotors {
                    "--vehicle NAME, or --blades N (with a gear, --gear P:W)"
                } else {
                    "--vehicle NAME, or both --rotors N and --blades N (with a gear, --rotors N and --gear P:W)"
                },
            ),
            (
                vehicle.is_none() || has_tone,
                "--blades N, or --gear P:W for a gear (hovertone does not know the blades of this vehicle)",
            ),
            (has_rotors || !has_tone, "--rotors N"),
            (!self.loads.is_empty(), "--mass KG=FILES, once for each load"),
        ];
        needs.into_iter().filter(|(has, _)| !has).map(|(_, flag)| flag).collect()
    }

    /// Mass of the lightest load: that of the vehicle.
    pub(crate) fn vehicle_mass_kg(&self) -> f64 {
        self.loads.iter().map(|load| load.mass_kg).fold(f64::INFINITY, f64::min)
    }
}
