//! The experiment file: what was flown, with which masses, and how it is to be analysed. Data only: where the recordings
//! are and how they are read is the caller's.

use crate::config::{
    Config, HoverConfig, Method, RidgeConfig, SampleConfig, SpanConfig, SpectrogramConfig, ToneConfig,
};
use crate::error::ConfigError;
use crate::thrust::{Air, Force, GRAVITY_STANDARD_M_S2, gravity_m_s2};
use hovertone_vehicle::{Gear, Order, QuantityError, Vehicle, find_preset};
use serde::{Deserialize, Serialize};

/// Standard uncertainty of a kitchen scale that shows whole grams.
const MASS_STD_KG: f64 = 0.0005;

/// An experiment file as it is written. Unknown keys are refused.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExperimentFile {
    /// What flew.
    pub vehicle: VehicleSection,
    /// Which tone is followed.
    #[serde(default)]
    pub tone: ToneSection,
    /// How a hover is cut into samples.
    #[serde(default)]
    pub samples: SampleConfig,
    /// Frames and their spectra.
    #[serde(default)]
    pub spectrogram: SpectrogramConfig,
    /// How ridges are drawn.
    #[serde(default)]
    pub ridge: RidgeConfig,
    /// How hovering is found.
    #[serde(default)]
    pub hover: HoverConfig,
    /// The air, for the thrust coefficients.
    pub air: Option<Air>,
    /// The loads.
    #[serde(default, rename = "load")]
    pub loads: Vec<LoadSection>,
}

/// What flew: a preset, or its numbers, which win over the preset's.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VehicleSection {
    /// Name of a preset.
    pub preset: Option<String>,
    /// Number of rotors.
    pub rotors: Option<u32>,
    /// Blades of each rotor.
    pub blades: Option<u32>,
    /// Gear between motor and rotor.
    pub gear: Option<Gear>,
    /// Diameter of the propellers.
    pub propeller_diameter_m: Option<f64>,
    /// Mass ready to fly, without added load.
    pub mass_kg: Option<f64>,
    /// Standard uncertainty of a weighing.
    pub mass_std_kg: Option<f64>,
    /// Local gravity …
    pub gravity_m_s2: Option<f64>,
    /// … or where it was flown: latitude
    pub latitude_deg: Option<f64>,
    /// and height above the sea.
    pub height_m: Option<f64>,
}

/// The order of a tone: a number, or `"auto"` for the vehicle's own tone (its gear mesh if it has a gear, else its blade
/// pass).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "a number of lines per turn, or \"auto\"")]
pub enum OrderSetting {
    /// Lines per turn.
    Lines(Order),
    /// The vehicle's own tone.
    #[default]
    #[serde(with = "auto_word")]
    Auto,
}

mod auto_word {
    use serde::{Deserialize, Deserializer, Serializer, de::Error};

    pub(super) fn serialize<S: Serializer>(serializer: S) -> Result<S::Ok, S::Error> {
        serializer.serialize_str("auto")
    }

    pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<(), D::Error> {
        match String::deserialize(deserializer)?.as_str() {
            "auto" => Ok(()),
            other => Err(D::Error::custom(format!("{other:?} is no order"))),
        }
    }
}

/// Which tone is followed.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ToneSection {
    /// Its order.
    pub order: OrderSetting,
    /// How many harmonics are followed.
    pub harmonics: Option<u32>,
    /// Band of the first harmonic, low and high edge.
    pub band_hz: Option<(f64, f64)>,
    /// Half width of a found band as a share of its middle.
    pub band_half_width_share: Option<f64>,
}

/// One load.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LoadSection {
    /// Its name.
    pub name: String,
    /// A hover: mass added to the vehicle's.
    pub added_mass_kg: Option<f64>,
    /// A bench run: thrust of the running rotors.
    pub thrust_n: Option<f64>,
    /// Standard uncertainty of that thrust.
    pub thrust_std_n: Option<f64>,
    /// Rotors that run; all of them in a hover.
    pub rotors_running: Option<u32>,
    /// Its recordings: names or patterns.
    pub recordings: Vec<String>,
    /// Start of the part to use, in every recording of this load.
    pub from_s: Option<f64>,
    /// End of the part to use.
    pub to_s: Option<f64>,
}

/// An experiment with everything settled.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Experiment {
    /// Name of what flew.
    pub vehicle_name: String,
    /// Number of rotors.
    pub rotor_count: u32,
    /// Diameter of the propellers, where known.
    pub propeller_diameter_m: Option<f64>,
    /// Settings of the analysis, the same for all loads but for their spans.
    pub config: Config,
    /// The air, where known.
    pub air: Option<Air>,
    /// The loads.
    pub loads: Vec<ExperimentLoad>,
}

/// A load with everything settled.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExperimentLoad {
    /// Its name.
    pub name: String,
    /// What the rotors balance.
    pub force: Force,
    /// How many rotors balance it.
    pub rotors_running: u32,
    /// Names or patterns of its recordings.
    pub recordings: Vec<String>,
    /// Which part of them is used.
    pub span: SpanConfig,
}

impl ExperimentLoad {
    /// The settings for a recording of this load.
    pub fn config(&self, experiment: &Experiment) -> Config {
        Config { span: self.span, ..experiment.config.clone() }
    }
}

/// What is wrong with an experiment.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ExperimentError {
    /// A preset that does not exist.
    #[error("there is no vehicle preset {name:?}; `hovertone vehicles` lists them")]
    UnknownPreset {
        /// What was asked for.
        name: String,
    },
    /// Something that cannot be guessed.
    #[error("{what} is missing: {hint}")]
    Missing {
        /// What.
        what: String,
        /// Where to write it.
        hint: &'static str,
    },
    /// A number that means nothing.
    #[error("{name} = {value}, {must_be}")]
    OutOfRange {
        /// Which number, with the load's name where it belongs to one.
        name: String,
        /// What was given.
        value: f64,
        /// What is allowed.
        must_be: &'static str,
    },
    /// Things that exclude each other.
    #[error("{what}: {hint}")]
    Contradiction {
        /// What.
        what: String,
        /// What to do.
        hint: &'static str,
    },
    /// A setting of the analysis.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// A quantity.
    #[error(transparent)]
    Quantity(#[from] QuantityError),
}

impl ExperimentFile {
    /// Settles everything: preset and own numbers, gravity, the tone's order, each load's force.
    pub fn resolve(&self) -> Result<Experiment, ExperimentError> {
        let preset = match &self.vehicle.preset {
            Some(name) => Some(find_preset(name).ok_or_else(|| ExperimentError::UnknownPreset { name: name.clone() })?),
            None => None,
        };
        let rotor_count = self.vehicle.rotors.or(preset.map(|preset| preset.rotor_count.value));
        let rotor_count =
            rotor_count.ok_or_else(|| missing("the number of rotors", "write vehicle.rotors, or a vehicle.preset"))?;
        positive("vehicle.rotors", f64::from(rotor_count))?;
        let config = Config {
            samples: self.samples,
            spectrogram: self.spectrogram,
            ridge: self.ridge,
            hover: self.hover,
            method: Method::default(),
            ..Config::for_tone(self.resolve_tone(preset)?)
        };
        config.check()?;
        if self.loads.is_empty() {
            return Err(missing("the loads", "write at least one [[load]] with its recordings"));
        }
        let loads =
            self.loads.iter().map(|load| self.resolve_load(load, preset, rotor_count)).collect::<Result<_, _>>()?;
        let own_diameter_m = self.vehicle.propeller_diameter_m;
        own_diameter_m.map_or(Ok(0.0), |diameter_m| positive("vehicle.propeller_diameter_m", diameter_m))?;
        if let Some(air) = self.air {
            positive("air.pressure_hpa", air.pressure_hpa)?;
            positive("air.temperature_c above absolute zero", air.temperature_c + 273.15)?;
        }
        Ok(Experiment {
            vehicle_name: preset.map_or("own vehicle", |preset| preset.name).to_owned(),
            rotor_count,
            propeller_diameter_m: own_diameter_m
                .or_else(|| preset.and_then(|preset| Some(preset.propeller_diameter_m.as_ref()?.value))),
            config,
            air: self.air,
            loads,
        })
    }

    fn resolve_tone(&self, preset: Option<&Vehicle>) -> Result<ToneConfig, ExperimentError> {
        let blades = self.vehicle.blades.or_else(|| preset.and_then(|preset| Some(preset.blade_count.as_ref()?.value)));
        let gear = self.vehicle.gear.or_else(|| preset.and_then(|preset| Some(preset.gear.as_ref()?.value)));
        let order = match (self.tone.order, gear, blades) {
            (OrderSetting::Lines(order), ..) => order,
            (OrderSetting::Auto, Some(gear), _) => gear.mesh_order()?,
            (OrderSetting::Auto, None, Some(blades)) => Order::from_blades(blades)?,
            (OrderSetting::Auto, None, None) => {
                return Err(missing("the order of the tone", "write tone.order, vehicle.blades or vehicle.gear"));
            }
        };
        let defaults = ToneConfig::of_order(order);
        Ok(ToneConfig {
            harmonics: self.tone.harmonics.unwrap_or(defaults.harmonics),
            blades,
            band_hz: self.tone.band_hz,
            band_half_width_share: self.tone.band_half_width_share.unwrap_or(defaults.band_half_width_share),
            ..defaults
        })
    }

    fn resolve_load(
        &self,
        load: &LoadSection,
        preset: Option<&Vehicle>,
        rotor_count: u32,
    ) -> Result<ExperimentLoad, ExperimentError> {
        let named = |field: &str| format!("{field} of load {:?}", load.name);
        let force = match (load.thrust_n, load.added_mass_kg) {
            (Some(_), Some(_)) => {
                return Err(ExperimentError::Contradiction {
                    what: format!("load {:?} has both thrust_n and added_mass_kg", load.name),
                    hint: "a bench run has a thrust, a hover an added mass",
                });
            }
            (Some(thrust_n), None) => Force::Thrust {
                thrust_n: positive(&named("thrust_n"), thrust_n)?,
                thrust_std_n: not_negative(&named("thrust_std_n"), load.thrust_std_n.unwrap_or(0.0))?,
            },
            (None, added_mass_kg) => self.weight(added_mass_kg.unwrap_or(0.0), preset, &named)?,
        };
        let rotors_running = load.rotors_running.unwrap_or(rotor_count);
        if !(1..=rotor_count).contains(&rotors_running) {
            return Err(ExperimentError::OutOfRange {
                name: named("rotors_running"),
                value: f64::from(rotors_running),
                must_be: "must be at least 1 and no more than the vehicle has rotors",
            });
        }
        if load.recordings.is_empty() {
            return Err(missing(&named("recordings"), "name at least one file or pattern"));
        }
        let span = SpanConfig { from_s: load.from_s, to_s: load.to_s };
        Config { span, ..Config::for_tone(ToneConfig::of_order(Order::from_blades(1)?)) }.check()?;
        Ok(ExperimentLoad { name: load.name.clone(), force, rotors_running, recordings: load.recordings.clone(), span })
    }

    fn weight(
        &self,
        added_mass_kg: f64,
        preset: Option<&Vehicle>,
        named: &dyn Fn(&str) -> String,
    ) -> Result<Force, ExperimentError> {
        let mass_kg = self.vehicle.mass_kg.or_else(|| preset.and_then(|preset| Some(preset.mass_kg.as_ref()?.value)));
        let mass_kg =
            mass_kg.ok_or_else(|| missing("the vehicle's mass", "weigh it ready to fly and write vehicle.mass_kg"))?;
        let gravity = match (self.vehicle.gravity_m_s2, self.vehicle.latitude_deg, self.vehicle.height_m) {
            (Some(gravity), None, None) => gravity,
            (None, Some(latitude_deg), height_m) if latitude_deg.abs() <= 90.0 => {
                gravity_m_s2(latitude_deg, height_m.unwrap_or(0.0))
            }
            (None, None, None) => GRAVITY_STANDARD_M_S2,
            (None, Some(latitude_deg), _) => {
                return Err(ExperimentError::OutOfRange {
                    name: "vehicle.latitude_deg".to_owned(),
                    value: latitude_deg,
                    must_be: "must lie between -90 and 90",
                });
            }
            (Some(_), _, _) => {
                return Err(ExperimentError::Contradiction {
                    what: "vehicle has both gravity_m_s2 and a place".to_owned(),
                    hint: "write either gravity_m_s2, or latitude_deg and height_m",
                });
            }
            (None, None, Some(_)) => {
                return Err(missing("vehicle.latitude_deg", "height_m alone does not tell gravity"));
            }
        };
        positive("vehicle.mass_kg", mass_kg)?;
        positive(&named("total mass"), mass_kg + added_mass_kg)?;
        Ok(Force::Weight {
            vehicle_mass_kg: mass_kg,
            added_mass_kg,
            mass_std_kg: not_negative("vehicle.mass_std_kg", self.vehicle.mass_std_kg.unwrap_or(MASS_STD_KG))?,
            gravity_m_s2: positive("vehicle.gravity_m_s2", gravity)?,
        })
    }
}

fn missing(what: &str, hint: &'static str) -> ExperimentError {
    ExperimentError::Missing { what: what.to_owned(), hint }
}

fn positive(name: &str, value: f64) -> Result<f64, ExperimentError> {
    if value.is_finite() && value > 0.0 {
        Ok(value)
    } else {
        Err(ExperimentError::OutOfRange { name: name.to_owned(), value, must_be: "must be a number above 0" })
    }
}

fn not_negative(name: &str, value: f64) -> Result<f64, ExperimentError> {
    if value.is_finite() && value >= 0.0 {
        Ok(value)
    } else {
        Err(ExperimentError::OutOfRange { name: name.to_owned(), value, must_be: "must be 0 or more" })
    }
}
