//! The experiment file: vehicle, loads with their masses, and settings of the analysis. It is data only; the caller finds and reads the
//! recordings.
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

mod limits;
mod recording;
mod resolve;
#[cfg(test)]
mod tests;
mod time;

pub use recording::RecordingSection;
pub use time::time_s_from_text;

use hovertone_rotor_speed::{
    Config, HoverConfig, RidgeConfig, RotorsConfig, SampleConfig, SpanConfig, SpectrogramConfig,
};
use hovertone_thrust::{
    Air, Force, LoadOutline, ThrustSettings, ThrustWarning, UncertaintyInputs, VehicleModel, warnings_of_outline,
};
use hovertone_vehicle::{ConfigError, Contradiction, GRAVITY_STANDARD_M_S2, Gear, KnownRotor, Order, QuantityError};
use serde::{Deserialize, Serialize};

/// An experiment file as written. Unknown keys are refused.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ExperimentFile {
    /// The vehicle.
    pub vehicle: VehicleSection,
    /// The tone to follow.
    #[serde(default)]
    pub tone: ToneSection,
    /// Division of a hover into samples.
    #[serde(default)]
    pub samples: SampleConfig,
    /// Frames and their spectra.
    #[serde(default)]
    pub spectrogram: SpectrogramConfig,
    /// Search of the ridges.
    #[serde(default)]
    pub ridge: RidgeConfig,
    /// Search of the hover.
    #[serde(default)]
    pub hover: HoverConfig,
    /// The air, for the thrust coefficients.
    pub air: Option<Air>,
    /// Limits of the effects that no recording shows.
    #[serde(default)]
    pub uncertainty: UncertaintyInputs,
    /// The device that made the recordings.
    #[serde(default)]
    pub recorder: RecorderSection,
    /// The loads.
    #[serde(default, rename = "load")]
    pub loads: Vec<LoadSection>,
}

/// The vehicle: a preset, a simulator's model, and numbers of its own. Own numbers have priority over the model, the model over the
/// preset.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct VehicleSection {
    /// Name of a preset.
    pub preset: Option<String>,
    /// File name of a simulator's model, relative to the folder of the experiment file. It supplies number of rotors, mass and diameter
    /// where it has them, and a constant for comparison.
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
    /// … and its standard uncertainty,
    pub gravity_std_m_s2: Option<f64>,
    /// or the place of the flights: latitude
    pub latitude_deg: Option<f64>,
    /// and height above the sea.
    pub height_m: Option<f64>,
}

/// The order of a tone: a number, or `"auto"` for the tone of the vehicle (its gear mesh if it has a gear, else its blade pass).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(untagged, expecting = "an order is a number above 0 without quotes, or \"auto\"")]
pub enum OrderSetting {
    /// Lines per turn.
    Lines(Order),
    /// The tone of the vehicle.
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

/// The tone to follow.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct ToneSection {
    /// Its order.
    pub order: OrderSetting,
    /// Number of harmonics to follow.
    pub harmonics: Option<u32>,
    /// Band of the first harmonic, lower and upper edge.
    pub band_hz: Option<(f64, f64)>,
    /// Half width of a band around a found tone, as a share of its centre.
    pub band_half_width_share: Option<f64>,
}

/// The device that made the recordings. `hovertone calibrate` finds the correction.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RecorderSection {
    /// Half width of the error of its clock that remains, in millionths.
    pub clock_ppm: Option<f64>,
    /// Correction of its clock, in millionths: positive where it runs fast, so that it hears all tones too low.
    pub clock_correction_ppm: Option<f64>,
}

/// One load.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LoadSection {
    /// Name of the load.
    pub name: String,
    /// For a hover: mass that is added to the vehicle.
    pub added_mass_kg: Option<f64>,
    /// For a bench run: thrust of the running rotors.
    pub thrust_n: Option<f64>,
    /// Standard uncertainty of that thrust; where absent, `mass_std_kg` times standard gravity, as for a scale.
    pub thrust_std_n: Option<f64>,
    /// Number of running rotors; in a hover all of them.
    pub rotors_running: Option<u32>,
    /// Total power of the running rotors, for the figure of merit.
    pub power_w: Option<f64>,
    /// Its recordings.
    pub recordings: Vec<RecordingSection>,
    /// Start of the used part, in every recording of this load: seconds, or a text such as `"1:02.5"`.
    #[serde(default, deserialize_with = "time::optional")]
    pub from_s: Option<f64>,
    /// End of the used part.
    #[serde(default, deserialize_with = "time::optional")]
    pub to_s: Option<f64>,
}

/// A resolved experiment: presets, defaults and checks are applied.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Experiment {
    /// Name of the vehicle.
    pub vehicle_name: String,
    /// Number of rotors.
    pub rotor_count: u32,
    /// Diameter of the propellers, where known.
    pub propeller_diameter_m: Option<f64>,
    /// Settings of the analysis, equal for all loads except for their spans.
    pub config: Config,
    /// The simulator's model for comparison, if there is one.
    pub model: Option<VehicleModel>,
    /// Whether the vehicle was weighed. The mass of a preset or a model belongs to another specimen.
    pub is_weighed: bool,
    /// Mass of the preset or of the model, where known.
    pub known_mass_kg: Option<f64>,
    /// The air, where known.
    pub air: Option<Air>,
    /// Limits of the effects that no recording shows.
    pub uncertainty: UncertaintyInputs,
    /// Correction of the recorder's clock, in millionths, for the program that opens the recordings.
    pub clock_correction_ppm: f64,
    /// The loads.
    pub loads: Vec<ExperimentLoad>,
}

/// A resolved load.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ExperimentLoad {
    /// Name of the load.
    pub name: String,
    /// Force that the rotors balance.
    pub force: Force,
    /// Number of rotors that balance it.
    pub rotors_running: u32,
    /// Total power of these rotors, where known.
    pub power_w: Option<f64>,
    /// Its recordings.
    pub recordings: Vec<RecordingSection>,
    /// Used part of the recordings.
    pub span: SpanConfig,
}

impl Experiment {
    /// Whether all loads hover, so that all rotors of the vehicle turn.
    pub fn is_flight(&self) -> bool {
        self.loads.iter().all(|load| matches!(load.force, Force::Weight { .. }))
    }

    /// The settings of the thrust constant.
    pub fn thrust_settings(&self) -> ThrustSettings {
        ThrustSettings {
            propeller_diameter_m: self.propeller_diameter_m,
            air_density_kg_m3: self.air.map(|air| air.density_kg_m3()),
            clock_ppm: self.config.budget.clock_ppm,
            is_weighed: self.is_weighed,
            known_mass_kg: self.known_mass_kg,
            uncertainty: self.uncertainty,
            ..ThrustSettings::for_rotors(self.rotor_count)
        }
    }
}

impl Experiment {
    /// The warnings that the constant will have if all recordings have a speed. `recording_counts` are the recordings of each load.
    pub fn warnings_before_hearing(&self, recording_counts: &[usize]) -> Vec<ThrustWarning> {
        let outlines: Vec<LoadOutline<'_>> = self
            .loads
            .iter()
            .zip(recording_counts)
            .map(|(load, &recording_count)| LoadOutline {
                name: &load.name,
                force: load.force,
                rotors_running: load.rotors_running,
                recording_count,
            })
            .collect();
        warnings_of_outline(&outlines, &self.thrust_settings())
    }
}

impl ExperimentLoad {
    /// The settings of the analysis for a recording of this load. Its mass, with the diameter of the propellers, is a prior on the shaft
    /// speed.
    pub fn config(&self, experiment: &Experiment) -> Config {
        let rotors = RotorsConfig { count: self.rotors_running, ..experiment.config.rotors };
        let mass_kg = match self.force {
            Force::Thrust { thrust_n, .. } => Some(thrust_n / GRAVITY_STANDARD_M_S2),
            Force::Weight { .. } => self.force.mass_kg(),
        };
        let known = KnownRotor { rotor_count: Some(self.rotors_running), mass_kg, ..experiment.config.known };
        // a mass or a diameter that no multirotor has tells nothing about the speed
        let known = if known.check().is_ok() { known } else { experiment.config.known };
        let mut budget = experiment.config.budget;
        if matches!(self.force, Force::Thrust { .. }) {
            budget.drift_m_max = 0.0; // a bench does not move
        }
        Config { span: self.span, rotors, known, budget, ..experiment.config.clone() }
    }
}

/// An error in an experiment.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ExperimentError {
    /// A preset that does not exist.
    #[error("there is no vehicle preset {name:?}; `hovertone vehicles` lists them")]
    UnknownPreset {
        /// The given name.
        name: String,
    },
    /// A missing entry without a default.
    #[error("{what} is missing: {hint}")]
    Missing {
        /// The missing entry.
        what: String,
        /// Advice where to write it.
        hint: &'static str,
    },
    /// A number out of range.
    #[error("{name} = {value}, but it {must_be}")]
    OutOfRange {
        /// Name of the number, with the name of its load.
        name: String,
        /// The given value.
        value: f64,
        /// Allowed values.
        must_be: &'static str,
    },
    /// Entries that exclude each other.
    #[error("{what}: {hint}")]
    Contradiction {
        /// The entries.
        what: String,
        /// Advice.
        hint: &'static str,
    },
    /// An entry that no vehicle has.
    #[error(transparent)]
    Vehicle(#[from] Contradiction),
    /// An error in a setting of the analysis.
    #[error(transparent)]
    Config(#[from] ConfigError),
    /// A quantity out of range.
    #[error(transparent)]
    Quantity(#[from] QuantityError),
}
