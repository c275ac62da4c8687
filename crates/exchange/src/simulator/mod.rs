//! Models of simulators: written from a measured constant, and read for a comparison with it.

mod airsim;
mod crazyflow;
mod flightmare;
mod gazebo;
mod header;
mod into;
#[cfg(test)]
mod into_tests;
mod neutral;
mod pybullet;
mod rotorpy;
mod rotors;
#[cfg(test)]
mod tests;
mod xml;

pub use into::{ChangedLine, UpdatedModel, updated_model};

use crate::identified::IdentifiedRotor;
use hovertone_vehicle::{QuantityError, check_positive};

/// Programs whose files are written and read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum SimulatorFormat {
    /// SDF of Gazebo and PX4: `motorConstant`, N/(rad/s)².
    Gazebo,
    /// xacro of RotorS: `motor_constant`, N/(rad/s)².
    Rotors,
    /// URDF of gym-pybullet-drones: `kf`, N/rpm².
    GymPybulletDrones,
    /// Python of RotorPy: `k_eta`, N/(rad/s)².
    Rotorpy,
    /// YAML of Flightmare: `thrust_map`, a polynomial of rad/s in N.
    Flightmare,
    /// C++ of AirSim: `C_T`, dimensionless.
    Airsim,
    /// TOML of crazyflow and drone-models: `rpm2thrust`, a polynomial of rpm in N.
    Crazyflow,
    /// JSON of this project, with every unit.
    Json,
    /// The same fields as YAML.
    Yaml,
}

impl SimulatorFormat {
    /// All formats.
    pub const ALL: [Self; 9] = [
        Self::Gazebo,
        Self::Rotors,
        Self::GymPybulletDrones,
        Self::Rotorpy,
        Self::Flightmare,
        Self::Airsim,
        Self::Crazyflow,
        Self::Json,
        Self::Yaml,
    ];

    /// Name in flags.
    pub fn name(self) -> &'static str {
        match self {
            Self::Gazebo => "gazebo",
            Self::Rotors => "rotors",
            Self::GymPybulletDrones => "gym-pybullet-drones",
            Self::Rotorpy => "rotorpy",
            Self::Flightmare => "flightmare",
            Self::Airsim => "airsim",
            Self::Crazyflow => "crazyflow",
            Self::Json => "json",
            Self::Yaml => "yaml",
        }
    }

    /// Name and unit of the constant in this program.
    pub fn constant(self) -> (&'static str, &'static str) {
        match self {
            Self::Gazebo => ("motorConstant", "N/(rad/s)^2"),
            Self::Rotors => ("motor_constant", "N/(rad/s)^2"),
            Self::GymPybulletDrones => ("kf", "N/rpm^2"),
            Self::Rotorpy => ("k_eta", "N/(rad/s)^2"),
            Self::Flightmare => ("thrust_map", "polynomial of rad/s in N"),
            Self::Airsim => ("C_T", "T/(rho n^2 D^4)"),
            Self::Crazyflow => ("rpm2thrust", "polynomial of rpm in N"),
            Self::Json | Self::Yaml => ("thrust_constant_per_rotor_n_s2", "N/(rad/s)^2"),
        }
    }
}

/// The rotors in the file of a simulator, with the thrust T = a + b ω + c ω² of each, ω in rad/s.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulatorModel {
    /// Format of the file.
    pub format: SimulatorFormat,
    /// c, N/(rad/s)².
    pub thrust_constant_n_s2: f64,
    /// b, N/(rad/s); 0 in most files.
    pub thrust_linear_n_s: f64,
    /// a, N; 0 in most files.
    pub thrust_offset_n: f64,
    /// Number of rotors, where the file has it.
    pub rotor_count: Option<u32>,
    /// Total mass, where the file has it.
    pub mass_kg: Option<f64>,
    /// Diameter of the propellers, where the file has it.
    pub propeller_diameter_m: Option<f64>,
    /// Torque over thrust, where the file has it.
    pub moment_constant_m: Option<f64>,
}

impl SimulatorModel {
    pub(crate) fn square(format: SimulatorFormat, thrust_constant_n_s2: f64) -> Self {
        Self {
            format,
            thrust_constant_n_s2,
            thrust_linear_n_s: 0.0,
            thrust_offset_n: 0.0,
            rotor_count: None,
            mass_kg: None,
            propeller_diameter_m: None,
            moment_constant_m: None,
        }
    }

    /// Thrust of one rotor.
    pub fn thrust_n(&self, speed_rad_s: f64) -> f64 {
        self.thrust_offset_n + speed_rad_s * (self.thrust_linear_n_s + speed_rad_s * self.thrust_constant_n_s2)
    }

    /// Thrust of one rotor over its squared speed, at a speed: the value to compare with a measured constant.
    pub fn constant_at_n_s2(&self, speed_rad_s: f64) -> f64 {
        self.thrust_n(speed_rad_s) / speed_rad_s.powi(2)
    }

    /// Shaft speed at which one rotor has the given thrust.
    pub fn speed_rad_s(&self, thrust_n: f64) -> Option<f64> {
        let (a, b, c) = (self.thrust_constant_n_s2, self.thrust_linear_n_s, self.thrust_offset_n - thrust_n);
        let speed = (-b + (b * b - 4.0 * a * c).sqrt()) / (2.0 * a);
        (speed.is_finite() && speed > 0.0).then_some(speed)
    }
}

/// Error in a model.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ModelError {
    /// Text of no known program.
    #[error(
        "the file has no thrust constant of a known simulator (looked for motorConstant, motor_constant, kf, k_eta, thrust_map, C_T, rpm2thrust)"
    )]
    Unknown,
    /// A page in HTML, such as a download that asks for a login.
    #[error("this is a web page, and no model of a simulator")]
    WebPage,
    /// JSON with a constant, but not the export of this project.
    #[error("this JSON is no model of a simulator; it may be the results of hovertone")]
    NoExport,
    /// An invalid file.
    #[error("it cannot be read as {format}: {reason}")]
    Broken {
        /// Expected content.
        format: &'static str,
        /// Reason.
        reason: String,
    },
    /// A valid file without what a model needs.
    #[error("the model cannot be used: {reason}")]
    Incomplete {
        /// Reason.
        reason: String,
    },
    /// A number out of range.
    #[error(transparent)]
    Quantity(#[from] QuantityError),
    /// Rotors with different constants.
    #[error("its rotors have different constants, from {least:e} to {most:e} N/(rad/s)^2")]
    UnlikeRotors {
        /// Smallest constant.
        least: f64,
        /// Largest constant.
        most: f64,
    },
    /// A number that is written as an expression, which only its author can change.
    #[error("{name} is the expression `{value}`, and a number is needed")]
    Expression {
        /// Name of the element or the key.
        name: String,
        /// Its text.
        value: String,
    },
    /// An export of this project, in which every number follows from the result.
    #[error(
        "this file is an export of hovertone itself, so there is nothing of yours to keep: write it again with --to json or --to yaml"
    )]
    OwnExport,
    /// A format that needs more numbers than the result has.
    #[error("the format {format} needs {what}, and the results do not have {}", if *is_one { "it" } else { "them" })]
    Needs {
        /// The format.
        format: &'static str,
        /// The missing numbers.
        what: &'static str,
        /// Whether one number is missing.
        is_one: bool,
        /// Flags of `hovertone export` that give them.
        flags: &'static str,
    },
}

/// Lines to paste into the file of a simulator, with the constant in its unit, and in all other units in a comment. Numbers that sound
/// does not contain are marked as missing.
///
/// # Errors
/// The format of AirSim without air and diameter.
pub fn export_text(rotor: &IdentifiedRotor, format: SimulatorFormat) -> Result<String, ModelError> {
    match format {
        SimulatorFormat::Gazebo => Ok(gazebo::write(rotor)),
        SimulatorFormat::Rotors => Ok(rotors::write(rotor)),
        SimulatorFormat::GymPybulletDrones => Ok(pybullet::write(rotor)),
        SimulatorFormat::Rotorpy => Ok(rotorpy::write(rotor)),
        SimulatorFormat::Flightmare => Ok(flightmare::write(rotor)),
        SimulatorFormat::Airsim => airsim::write(rotor),
        SimulatorFormat::Crazyflow => Ok(crazyflow::write(rotor)),
        SimulatorFormat::Json => neutral::write_json(rotor),
        SimulatorFormat::Yaml => Ok(neutral::write_yaml(rotor)),
    }
}

/// Reads the model of a simulator; its keywords identify the format.
///
/// # Errors
/// No known constant, an invalid file, a constant out of range, rotors with different constants.
pub fn model_from_text(text: &str) -> Result<SimulatorModel, ModelError> {
    if is_web_page(text) {
        return Err(ModelError::WebPage);
    }
    let format = format_of(text)?;
    let model = match format {
        SimulatorFormat::Gazebo => gazebo::read(text)?,
        SimulatorFormat::Rotors => rotors::read(text)?,
        SimulatorFormat::GymPybulletDrones => pybullet::read(text)?,
        SimulatorFormat::Rotorpy => rotorpy::read(text)?,
        SimulatorFormat::Flightmare => flightmare::read(text)?,
        SimulatorFormat::Crazyflow => crazyflow::read(text)?,
        SimulatorFormat::Json | SimulatorFormat::Yaml => neutral::read(text)?,
        SimulatorFormat::Airsim => airsim::read(text)?,
    };
    let (name, _) = format.constant();
    // a mass of zero stands for an unknown mass
    let model = SimulatorModel { mass_kg: model.mass_kg.filter(|mass_kg| *mass_kg != 0.0), ..model };
    for (name, value) in [
        (name, Some(model.thrust_constant_n_s2)),
        ("the mass", model.mass_kg),
        ("the diameter of the propellers", model.propeller_diameter_m),
        ("the number of rotors", model.rotor_count.map(f64::from)),
    ] {
        value.map_or(Ok(()), |value| check_positive(name, value))?;
    }
    Ok(model)
}

/// Whether a text begins as a page in HTML does. Its code may name the constant of a simulator.
fn is_web_page(text: &str) -> bool {
    let text = text.trim_start_matches(|letter: char| letter.is_whitespace() || letter == '\u{feff}');
    let begins = |head: &&str| text.get(..head.len()).is_some_and(|start| start.eq_ignore_ascii_case(head));
    ["<!doctype html", "<html"].iter().any(begins)
}

/// The format of a model, known by its keywords.
fn format_of(text: &str) -> Result<SimulatorFormat, ModelError> {
    let has = |word: &str| text.contains(word);
    // a xacro may use its property in the plugin of a motor
    let is_property = has("name=\"motor_constant\"") || has("name='motor_constant'");
    if has("<motorConstant") && !is_property {
        Ok(SimulatorFormat::Gazebo)
    } else if has("motor_constant") {
        Ok(SimulatorFormat::Rotors)
    } else if has("<properties") && has("kf=") {
        Ok(SimulatorFormat::GymPybulletDrones)
    } else if has("k_eta") {
        Ok(SimulatorFormat::Rotorpy)
    } else if has("thrust_map") {
        Ok(SimulatorFormat::Flightmare)
    } else if has("rpm2thrust") {
        Ok(SimulatorFormat::Crazyflow)
    } else if has("thrust_constant_per_rotor_n_s2") {
        Ok(SimulatorFormat::Json)
    } else if has("C_T") {
        Ok(SimulatorFormat::Airsim)
    } else {
        Err(ModelError::Unknown)
    }
}
