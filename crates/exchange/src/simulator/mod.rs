//! Models of simulators: written from what was identified, and read back to be compared with it.

mod airsim;
mod crazyflow;
mod flightmare;
mod gazebo;
mod header;
mod neutral;
mod pybullet;
mod rotorpy;
mod rotors;
#[cfg(test)]
mod tests;
mod xml;

use crate::identified::IdentifiedRotor;

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
    /// JSON of our own, every unit.
    Json,
    /// The same as YAML.
    Yaml,
}

impl SimulatorFormat {
    /// All of them.
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

    /// How this program names the constant, and in which unit.
    pub fn constant(self) -> (&'static str, &'static str) {
        match self {
            Self::Gazebo => ("motorConstant", "N/(rad/s)^2"),
            Self::Rotors => ("motor_constant", "N/(rad/s)^2"),
            Self::GymPybulletDrones => ("kf", "N/rpm^2"),
            Self::Rotorpy => ("k_eta", "N/(rad/s)^2"),
            Self::Flightmare => ("thrust_map", "N over rad/s"),
            Self::Airsim => ("C_T", "T/(rho n^2 D^4)"),
            Self::Crazyflow => ("rpm2thrust", "N over rpm"),
            Self::Json | Self::Yaml => ("thrust_constant_per_rotor_n_s2", "N/(rad/s)^2"),
        }
    }
}

/// What a simulator's file says of its rotors: T = a + b ω + c ω² for each, ω in rad/s.
#[derive(Clone, Debug, PartialEq)]
pub struct SimulatorModel {
    /// Which program's file it is.
    pub format: SimulatorFormat,
    /// c, N/(rad/s)².
    pub thrust_constant_n_s2: f64,
    /// b, N/(rad/s); 0 in most.
    pub thrust_linear_n_s: f64,
    /// a; 0 in most.
    pub thrust_offset_n: f64,
    /// Rotors, where the file tells.
    pub rotor_count: Option<u32>,
    /// Mass of everything, where the file tells.
    pub mass_kg: Option<f64>,
    /// Diameter of the propellers, where the file tells.
    pub propeller_diameter_m: Option<f64>,
    /// Torque over thrust, where the file tells.
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

    /// Thrust of one rotor over its squared speed, at a speed: what compares with an identified constant.
    pub fn constant_at_n_s2(&self, speed_rad_s: f64) -> f64 {
        self.thrust_n(speed_rad_s) / speed_rad_s.powi(2)
    }

    /// Shaft speed at which one rotor has this thrust.
    pub fn speed_rad_s(&self, thrust_n: f64) -> Option<f64> {
        let (a, b, c) = (self.thrust_constant_n_s2, self.thrust_linear_n_s, self.thrust_offset_n - thrust_n);
        let speed = (-b + (b * b - 4.0 * a * c).sqrt()) / (2.0 * a);
        (speed.is_finite() && speed > 0.0).then_some(speed)
    }
}

/// Why a file is no model.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ModelError {
    /// Text that no known program has.
    #[error(
        "no thrust constant of a known simulator stands in it (looked for motorConstant, motor_constant, kf, k_eta, thrust_map, C_T, rpm2thrust)"
    )]
    Unknown,
    /// A file that is broken.
    #[error("it cannot be read as {format}: {reason}")]
    Broken {
        /// What it should be.
        format: &'static str,
        /// Why it is not.
        reason: String,
    },
    /// A number that no rotor has.
    #[error("{name} = {value}, which no rotor has: it must be a number above 0")]
    OutOfRange {
        /// Which.
        name: &'static str,
        /// What stands there.
        value: f64,
    },
    /// Rotors that differ.
    #[error("its rotors have different constants, from {least:e} to {most:e} N/(rad/s)^2")]
    UnlikeRotors {
        /// Smallest.
        least: f64,
        /// Largest.
        most: f64,
    },
    /// A format that needs more than sound tells.
    #[error("{format} needs {what}")]
    Needs {
        /// Which.
        format: &'static str,
        /// What, and where to write it.
        what: &'static str,
    },
}

/// Lines to paste into a simulator's file, with the constant in its unit and in all others in a comment. What sound does not
/// tell is marked missing and never made up.
///
/// # Errors
/// AirSim without air and diameter.
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

/// Reads a simulator's model; the words in it tell whose it is.
///
/// # Errors
/// No known constant, a broken file, constants that no rotor has, rotors that differ.
pub fn model_from_text(text: &str) -> Result<SimulatorModel, ModelError> {
    let has = |word: &str| text.contains(word);
    let (name, model) = if has("<motorConstant") {
        ("motorConstant", gazebo::read(text)?)
    } else if has("motor_constant") {
        ("motor_constant", rotors::read(text)?)
    } else if has("<properties") && has("kf=") {
        ("kf", pybullet::read(text)?)
    } else if has("k_eta") {
        ("k_eta", rotorpy::read(text)?)
    } else if has("thrust_map") {
        ("thrust_map", flightmare::read(text)?)
    } else if has("rpm2thrust") {
        ("rpm2thrust", crazyflow::read(text)?)
    } else if has("thrust_constant_per_rotor_n_s2") {
        ("thrust_constant_per_rotor_n_s2", neutral::read(text)?)
    } else if has("C_T") {
        ("C_T", airsim::read(text)?)
    } else {
        return Err(ModelError::Unknown);
    };
    // a mass of zero is what files have where nobody knew one
    let model = SimulatorModel { mass_kg: model.mass_kg.filter(|mass_kg| *mass_kg != 0.0), ..model };
    for (name, value) in [
        (name, Some(model.thrust_constant_n_s2)),
        ("the mass", model.mass_kg),
        ("the propellers' diameter", model.propeller_diameter_m),
        ("the number of rotors", model.rotor_count.map(f64::from)),
    ] {
        if let Some(value) = value.filter(|value| !(value.is_finite() && *value > 0.0)) {
            return Err(ModelError::OutOfRange { name, value });
        }
    }
    Ok(model)
}
