//! From the experiment file to a resolved experiment: preset and own numbers, gravity, the order of the tone, the force of each load.

use super::limits::{check_hovers, check_model, missing, not_negative, positive};
use super::{Experiment, ExperimentError, ExperimentFile, ExperimentLoad, LoadSection, OrderSetting, RecordingSection};
use hovertone_analysis::Method;
use hovertone_rotor_speed::{BudgetConfig, Config, SpanConfig, ToneConfig};
use hovertone_thrust::{Air, Force, Gravity, VehicleModel, check_gravity, check_latitude};
use hovertone_vehicle::{
    CLOCK_CORRECTION_PPM_MAX, GRAMS_FACTOR, GRAVITY_STANDARD_M_S2, Gear, KnownRotor, MASS_FACTOR_MAX, Order,
    SaidOfVehicle, Vehicle, are_masses_of_one_vehicle, check_diameter, check_range, is_swamped, presets,
};

/// Default standard uncertainty of a mass, kg: a kitchen scale that shows whole grams. *Decision.*
const MASS_STD_KG: f64 = 0.0005;

/// Sources of the numbers that the file leaves out.
#[derive(Clone, Copy)]
struct Known<'a> {
    preset: Option<&'a Vehicle>,
    model: Option<&'a VehicleModel>,
}

impl Known<'_> {
    /// Number of rotors of the preset or of the model. The two must agree, since the file of a model can be a fragment with one of
    /// several rotors.
    fn rotor_count(&self) -> Result<Option<u32>, ExperimentError> {
        let of_preset = self.preset.map(|preset| preset.rotor_count.value);
        match (of_preset, self.model.and_then(|model| model.rotor_count)) {
            (Some(of_preset), Some(of_model)) if of_preset != of_model => Err(ExperimentError::Contradiction {
                what: format!("the preset has {of_preset} rotors, but the model has {of_model}"),
                hint: "write the right number as rotors = N under [vehicle]",
            }),
            (of_preset, of_model) => Ok(of_preset.or(of_model)),
        }
    }

    fn mass_kg(&self) -> Option<f64> {
        let of_model = self.model.and_then(|model| model.mass_kg);
        of_model.or_else(|| Some(self.preset?.mass_kg.as_ref()?.value))
    }

    fn propeller_diameter_m(&self) -> Option<f64> {
        let of_model = self.model.and_then(|model| model.propeller_diameter_m);
        of_model.or_else(|| Some(self.preset?.propeller_diameter_m.as_ref()?.value))
    }
}

impl ExperimentFile {
    /// Resolves preset, model and own numbers, gravity, the order of the tone and the force of each load. `model` is the content of the
    /// file that `vehicle.model` names.
    ///
    /// # Errors
    /// An entry that is missing, out of range or in contradiction to another one.
    pub fn resolve(&self, model: Option<VehicleModel>) -> Result<Experiment, ExperimentError> {
        self.resolve_among(presets(), model)
    }

    /// The same with other vehicles as presets: those of the user beside those of this project.
    ///
    /// # Errors
    /// As of [`ExperimentFile::resolve`].
    pub fn resolve_among(
        &self,
        vehicles: &[Vehicle],
        model: Option<VehicleModel>,
    ) -> Result<Experiment, ExperimentError> {
        if self.vehicle.model.is_some() != model.is_some() {
            return Err(missing("the model of the vehicle", "give the file that vehicle.model names"));
        }
        model.as_ref().map_or(Ok(()), check_model)?;
        let preset = match &self.vehicle.preset {
            Some(name) => {
                let named = vehicles.iter().find(|vehicle| vehicle.id == name);
                Some(named.ok_or_else(|| ExperimentError::UnknownPreset { name: name.clone() })?)
            }
            None => None,
        };
        let known = Known { preset, model: model.as_ref() };
        let rotor_count = match self.vehicle.rotors {
            Some(rotor_count) => Some(rotor_count),
            None => known.rotor_count()?,
        };
        let rotor_count = rotor_count
            .ok_or_else(|| missing("the number of rotors", "write rotors = N or preset = \"NAME\" under [vehicle]"))?;
        positive("vehicle.rotors", f64::from(rotor_count))?;
        self.vehicle.gear.map_or(Ok(()), Gear::check)?;
        preset.map_or(Ok(()), |preset| self.check_said(preset))?;
        let own_diameter_m = self.vehicle.propeller_diameter_m;
        own_diameter_m.map_or(Ok(()), |diameter_m| check_diameter("vehicle.propeller_diameter_m", diameter_m))?;
        let config = self.resolve_config(known, rotor_count)?;
        if self.loads.is_empty() {
            return Err(missing("a load", "write at least one [[load]] with its recordings"));
        }
        self.check_names()?;
        let loads =
            self.loads.iter().map(|load| self.resolve_load(load, known, rotor_count)).collect::<Result<Vec<_>, _>>()?;
        check_hovers(&loads, &config.known)?;
        // the height of the place also gives the pressure, where the file has none
        let air = self.air.map(|air| Air { height_m: air.height_m.or(self.vehicle.height_m), ..air });
        if let Some(air) = air {
            air.check()?;
            if air.pressure_hpa.is_none() && air.height_m.is_none() {
                return Err(missing("air.pressure_hpa", "write pressure_hpa or height_m under [air]"));
            }
        }
        self.uncertainty.check()?;
        let clock_correction_ppm = self.recorder.clock_correction_ppm.unwrap_or(0.0);
        check_range("clock_correction_ppm", clock_correction_ppm, -CLOCK_CORRECTION_PPM_MAX, CLOCK_CORRECTION_PPM_MAX)?;
        Ok(Experiment {
            vehicle_name: preset.map_or("own vehicle", |preset| preset.name).to_owned(),
            rotor_count,
            propeller_diameter_m: own_diameter_m.or_else(|| known.propeller_diameter_m()),
            is_weighed: self.vehicle.mass_kg.is_some(),
            known_mass_kg: known.mass_kg(),
            config,
            air,
            uncertainty: self.uncertainty,
            clock_correction_ppm,
            loads,
            model,
        })
    }

    /// Compares the file's own numbers with those of its preset. A model has priority over the preset in its number of rotors, and the mass
    /// is compared with that of either.
    fn check_said(&self, preset: &Vehicle) -> Result<(), ExperimentError> {
        let order = match self.tone.order {
            OrderSetting::Lines(order) => Some(order),
            OrderSetting::Auto => None,
        };
        let said = SaidOfVehicle {
            blades: self.vehicle.blades,
            gear: self.vehicle.gear,
            order,
            rotors: self.vehicle.rotors.filter(|_| self.vehicle.model.is_none()),
            is_hovering: self.loads.iter().any(|load| load.thrust_n.is_none()),
            mass_kg: None,
        };
        Ok(preset.check_said(&said)?)
    }

    /// The settings of the analysis. The diameter of the propellers is part of the prior on the shaft speed.
    fn resolve_config(&self, known: Known<'_>, rotor_count: u32) -> Result<Config, ExperimentError> {
        let tone = self.resolve_tone(known.preset)?;
        let of_preset = known.preset.map(KnownRotor::of_vehicle).unwrap_or_default();
        let defaults = BudgetConfig::default();
        let config = Config {
            known: KnownRotor {
                diameter_m: self.vehicle.propeller_diameter_m.or_else(|| known.propeller_diameter_m()),
                mass_kg: None, // that of each load
                rotor_count: Some(rotor_count),
                blade_count: tone.blades,
                ..of_preset
            },
            samples: self.samples,
            spectrogram: self.spectrogram,
            ridge: self.ridge,
            hover: self.hover,
            budget: BudgetConfig {
                clock_ppm: self.recorder.clock_ppm.unwrap_or(defaults.clock_ppm),
                drift_m_max: self.uncertainty.drift_m_max,
                rotor_spread_share: self.uncertainty.rotor_spread_share,
                ..defaults
            },
            method: Method::for_rotors(rotor_count),
            all_methods: true,
            ..Config::for_tone(tone)
        };
        config.check()?;
        Ok(config)
    }

    fn resolve_tone(&self, preset: Option<&Vehicle>) -> Result<ToneConfig, ExperimentError> {
        let blades = self.vehicle.blades.or_else(|| preset.and_then(|preset| Some(preset.blade_count.as_ref()?.value)));
        let gear = self.vehicle.gear.or_else(|| preset.and_then(|preset| Some(preset.gear.as_ref()?.value)));
        let order = match (self.tone.order, gear, blades) {
            (OrderSetting::Lines(order), ..) => order,
            (OrderSetting::Auto, Some(gear), _) => gear.mesh_order()?,
            (OrderSetting::Auto, None, Some(blades)) => Order::from_blades(blades)?,
            (OrderSetting::Auto, None, None) => {
                return Err(missing(
                    "the order of the tone",
                    "write blades = N or gear under [vehicle], or order under [tone]",
                ));
            }
        };
        let known = preset.and_then(|preset| Some(preset.shaft_speed.as_ref()?.value));
        let defaults = ToneConfig::of_order(order);
        let defaults = known.map_or_else(|| defaults.clone(), |known| defaults.clone().within(&known));
        let tone = ToneConfig {
            harmonics: self.tone.harmonics.unwrap_or(defaults.harmonics),
            blades,
            band_hz: self.tone.band_hz,
            band_half_width_share: self.tone.band_half_width_share.unwrap_or(defaults.band_half_width_share),
            ..defaults
        };
        tone.check_band()?;
        Ok(tone)
    }

    fn resolve_load(
        &self,
        load: &LoadSection,
        known: Known<'_>,
        rotor_count: u32,
    ) -> Result<ExperimentLoad, ExperimentError> {
        let named = |field: &str| format!("{field} of load {:?}", load.name);
        let force = match (load.thrust_n, load.added_mass_kg) {
            (Some(_), Some(_)) => {
                return Err(ExperimentError::Contradiction {
                    what: format!("load {:?} has both thrust_n and added_mass_kg", load.name),
                    hint: "write thrust_n for a bench run, or added_mass_kg for a hover",
                });
            }
            (Some(thrust_n), None) => Force::Thrust {
                thrust_n: positive(&named("thrust_n"), thrust_n)?,
                thrust_std_n: not_negative(&named("thrust_std_n"), load.thrust_std_n.unwrap_or(self.scale_std_n()?))?,
            },
            (None, added_mass_kg) => self.weight(added_mass_kg.unwrap_or(0.0), known, &named)?,
        };
        let rotors_running = load.rotors_running.unwrap_or(rotor_count);
        if !(1..=rotor_count).contains(&rotors_running) {
            return Err(ExperimentError::OutOfRange {
                name: named("rotors_running"),
                value: f64::from(rotors_running),
                must_be: "must be from 1 to the number of rotors of the vehicle (rotors under [vehicle], or that of the preset)",
            });
        }
        if rotors_running != rotor_count && load.thrust_n.is_none() {
            return Err(ExperimentError::Contradiction {
                what: format!(
                    "load {:?} has no thrust_n, so it hovers with {rotors_running} of {rotor_count} rotors",
                    load.name
                ),
                hint: "in a hover all rotors turn: remove rotors_running; for a bench run, write thrust_n",
            });
        }
        if load.recordings.is_empty() {
            return Err(missing(&named("a recording"), "name at least one file or pattern in recordings = [...]"));
        }
        if load.recordings.iter().any(RecordingSection::has_empty_name) {
            return Err(missing(
                &named("the name of a file"),
                "write a name between the quotation marks, or remove them",
            ));
        }
        for (field, time_s) in [("from_s", load.from_s), ("to_s", load.to_s)] {
            not_negative(&named(field), time_s.unwrap_or(0.0))?;
        }
        let span = SpanConfig { from_s: load.from_s, to_s: load.to_s };
        span.check().map_err(|error| ExperimentError::Contradiction {
            what: format!("load {:?}: {error}", load.name),
            hint: "write a later to_s or an earlier from_s, in seconds of the recording",
        })?;
        let power_w = load.power_w.map(|power_w| positive(&named("power_w"), power_w)).transpose()?;
        Ok(ExperimentLoad {
            name: load.name.clone(),
            force,
            rotors_running,
            power_w,
            recordings: load.recordings.clone(),
            span,
        })
    }

    fn weight(
        &self,
        added_mass_kg: f64,
        known: Known<'_>,
        named: &dyn Fn(&str) -> String,
    ) -> Result<Force, ExperimentError> {
        let mass_kg = self.vehicle.mass_kg.or_else(|| known.mass_kg());
        let mass_kg = mass_kg.ok_or_else(|| {
            missing("the mass of the vehicle", "weigh the vehicle ready to fly, and write mass_kg under [vehicle]")
        })?;
        let gravity = match (self.vehicle.gravity_m_s2, self.vehicle.latitude_deg, self.vehicle.height_m) {
            (Some(gravity), None, None) => Gravity::given(gravity),
            (None, Some(latitude_deg), height_m) => {
                check_latitude("vehicle.latitude_deg", latitude_deg)?;
                Gravity::at_place(latitude_deg, height_m.unwrap_or(0.0))
            }
            (None, None, None) => Gravity::UNKNOWN,
            (Some(_), _, _) => {
                return Err(ExperimentError::Contradiction {
                    what: "[vehicle] has both gravity_m_s2 and a place (latitude_deg, height_m)".to_owned(),
                    hint: "write either gravity_m_s2, or latitude_deg and height_m",
                });
            }
            (None, None, Some(_)) => {
                return Err(missing(
                    "vehicle.latitude_deg",
                    "the height alone does not give the gravity; write latitude_deg too, or gravity_m_s2 in place of height_m",
                ));
            }
        };
        check_gravity("vehicle.gravity_m_s2", gravity.m_s2)?;
        positive("vehicle.mass_kg", mass_kg)?;
        if is_swamped(mass_kg, self.mass_std_kg()?) {
            return Err(ExperimentError::OutOfRange {
                name: "vehicle.mass_std_kg".to_owned(),
                value: self.mass_std_kg()?,
                must_be: "is more than half the mass; masses are in kg, and 0.5 g are 0.0005",
            });
        }
        if let Some(known_kg) = known.mass_kg()
            && !are_masses_of_one_vehicle(mass_kg, known_kg)
        {
            let is_in_grams = GRAMS_FACTOR.contains(&(mass_kg / known_kg));
            let meant = if is_in_grams { format!(" (did you mean {}?)", mass_kg / 1e3) } else { String::new() };
            let has_model_mass = known.model.is_some_and(|model| model.mass_kg.is_some());
            let other = if has_model_mass { "model" } else { "preset" };
            return Err(ExperimentError::Contradiction {
                what: format!(
                    "vehicle.mass_kg = {mass_kg}{meant}, but the vehicle of the {other} weighs {known_kg} kg"
                ),
                hint: "masses are in kg; check this mass, and whether the preset or the model is of your vehicle",
            });
        }
        not_negative(&named("added_mass_kg"), added_mass_kg)?;
        if added_mass_kg > MASS_FACTOR_MAX * mass_kg {
            return Err(ExperimentError::OutOfRange {
                name: named("added_mass_kg"),
                value: added_mass_kg,
                must_be: "is more than ten times the mass of the vehicle; masses are in kg",
            });
        }
        Ok(Force::Weight {
            vehicle_mass_kg: mass_kg,
            added_mass_kg,
            mass_std_kg: self.mass_std_kg()?,
            gravity_m_s2: gravity.m_s2,
            gravity_std_m_s2: not_negative(
                "vehicle.gravity_std_m_s2",
                self.vehicle.gravity_std_m_s2.unwrap_or(gravity.std_m_s2),
            )?,
        })
    }
}

impl ExperimentFile {
    /// Refuses loads with equal or empty names.
    fn check_names(&self) -> Result<(), ExperimentError> {
        for (index, load) in self.loads.iter().enumerate() {
            let number = index + 1;
            let before = self.loads[..index].iter().position(|before| before.name == load.name);
            let what = match before {
                _ if load.name.trim().is_empty() => format!("load number {number} has no name"),
                Some(before) => {
                    format!("load number {number} has the same name, {:?}, as load number {}", load.name, before + 1)
                }
                None => continue,
            };
            return Err(ExperimentError::Contradiction { what, hint: "give every load a name of its own" });
        }
        Ok(())
    }

    fn mass_std_kg(&self) -> Result<f64, ExperimentError> {
        not_negative("vehicle.mass_std_kg", self.vehicle.mass_std_kg.unwrap_or(MASS_STD_KG))
    }

    /// Standard uncertainty of a thrust that was read from the same scale.
    fn scale_std_n(&self) -> Result<f64, ExperimentError> {
        Ok(self.mass_std_kg()? * GRAVITY_STANDARD_M_S2)
    }
}
