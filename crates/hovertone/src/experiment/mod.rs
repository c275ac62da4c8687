//! The experiment file: what was flown, with which masses, and how it is to be analysed. Data only: where the recordings
//! are and how they are read is the caller's.
//!
//! ```
//! use hovertone::experiment::ExperimentFile;
//!
//! let file: ExperimentFile = toml::from_str(
//!     r#"
//!     [vehicle]
//!     preset = "ardrone"
//!     mass_kg = 0.413
//!
//!     [[load]]
//!     name = "no hull"
//!     recordings = ["no_hull/*.mov"]
//!
//!     [[load]]
//!     name = "small hull"
//!     added_mass_kg = 0.031
//!     recordings = ["small_hull/*.mov"]
//!     "#,
//! )?;
//! let experiment = file.resolve(None)?;
//! assert_eq!(experiment.config.tone.order.lines_per_turn(), 69.0); // the gear mesh of the preset
//! assert!((experiment.loads[1].force.newtons() - 0.444 * 9.80665).abs() < 1e-9);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod resolve;
#[cfg(test)]
mod tests;

use hovertone_rotor_speed::{
    Config, HoverConfig, RidgeConfig, RotorsConfig, SampleConfig, SpanConfig, SpectrogramConfig,
};
use hovertone_thrust::{Air, Force, ThrustSettings, UncertaintyInputs, VehicleModel};
use hovertone_vehicle::{ConfigError, Gear, Order, QuantityError};
use serde::{Deserialize, Serialize};

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
    /// How large the effects may be that no recording shows.
    #[serde(default)]
    pub uncertainty: UncertaintyInputs,
    /// The loads.
    #[serde(default, rename = "load")]
    pub loads: Vec<LoadSection>,
}

/// What flew: a preset, a simulator's model, whose numbers win over the preset's, or its own numbers, which win over both.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VehicleSection {
    /// Name of a preset.
    pub preset: Option<String>,
    /// Name of a simulator's model, from the folder of the experiment file: rotors, mass and diameter as far as it has them,
    /// and a constant to be compared with what is heard.
    pub model: Option<String>,
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
    /// Its standard uncertainty
    pub gravity_std_m_s2: Option<f64>,
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
    /// Standard uncertainty of that thrust; where absent, that of a scale, `mass_std_kg` times standard gravity.
    pub thrust_std_n: Option<f64>,
    /// Rotors that run; all of them in a hover.
    pub rotors_running: Option<u32>,
    /// Power that they take together, for the figure of merit.
    pub power_w: Option<f64>,
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
    /// The simulator's model that is compared with what is heard, where one is named.
    pub model: Option<VehicleModel>,
    /// Whether the mass is that of a scale; a preset's or a model's is another specimen's.
    pub is_weighed: bool,
    /// The air, where known.
    pub air: Option<Air>,
    /// How large the effects may be that no recording shows.
    pub uncertainty: UncertaintyInputs,
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
    /// Power that they take together, where known.
    pub power_w: Option<f64>,
    /// Names or patterns of its recordings.
    pub recordings: Vec<String>,
    /// Which part of them is used.
    pub span: SpanConfig,
}

impl Experiment {
    /// What a thrust constant needs to be known beside its loads.
    pub fn thrust_settings(&self) -> ThrustSettings {
        ThrustSettings {
            propeller_diameter_m: self.propeller_diameter_m,
            air_density_kg_m3: self.air.map(|air| air.density_kg_m3()),
            clock_ppm: self.config.budget.clock_ppm,
            is_weighed: self.is_weighed,
            uncertainty: self.uncertainty,
            ..ThrustSettings::for_rotors(self.rotor_count)
        }
    }
}

impl ExperimentLoad {
    /// The settings for a recording of this load.
    pub fn config(&self, experiment: &Experiment) -> Config {
        let rotors = RotorsConfig { count: self.rotors_running, ..experiment.config.rotors };
        let mut budget = experiment.config.budget;
        if matches!(self.force, Force::Thrust { .. }) {
            budget.drift_m_max = 0.0; // a bench stands still
        }
        Config { span: self.span, rotors, budget, ..experiment.config.clone() }
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
