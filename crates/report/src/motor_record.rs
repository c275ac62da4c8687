//! The motors of a log or a recording, and where their speeds come from.

use hovertone_dynamics::{BenchTorque, MotorConstants, MotorModel, constants_of};

/// A motor of a log.
#[derive(Clone, Debug, PartialEq)]
pub struct LoggedMotor {
    /// Its name in the log; for a recording a name of our own.
    pub name: String,
    /// Name of its command in the log, where it has one.
    pub command: Option<String>,
    /// What the log tells about it.
    pub model: MotorModel,
}

/// Where the speeds of motors come from.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum MotorSource {
    /// A log.
    #[default]
    Log,
    /// The sound of a recording: all rotors together are one motor.
    Sound(MotorSound),
}

/// What the sound adds.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct MotorSound {
    /// Length of the frames in which the speed is heard.
    pub frame_s: f64,
    /// Reason why no rotor is heard.
    pub no_tone: Option<String>,
    /// Time that was added to the clock of the commands, where it was found from the steps.
    pub offset_s: Option<f64>,
    /// Whether commands were given.
    pub has_commands: bool,
    /// The number of blades that was given.
    pub blades: Option<u32>,
    /// The order of the tone that was given.
    pub order: Option<f64>,
}

impl MotorSound {
    /// The flag that says which tone is followed, with its number.
    pub(crate) fn given_number(&self) -> Option<String> {
        match (self.blades, self.order) {
            (Some(blades), _) => Some(format!("--blades {blades}")),
            (None, Some(order)) => Some(format!("--order {order}")),
            (None, None) => None,
        }
    }
}

/// A log or a recording, and its motors.
#[derive(Clone, Debug, PartialEq)]
pub struct MotorRecord {
    /// Name of the file as given.
    pub file: String,
    /// Where the speeds come from.
    pub source: MotorSource,
    /// Motors that turn.
    pub motors: Vec<LoggedMotor>,
    /// C_τ of one rotor, or why a log does not tell it; absent for a recording.
    pub torque: Option<BenchTorque>,
}

impl MotorRecord {
    /// The constants of all motors together.
    pub fn constants(&self) -> MotorConstants {
        let models: Vec<MotorModel> = self.motors.iter().map(|motor| motor.model.clone()).collect();
        constants_of(&models)
    }

    /// Whether any time constant is told.
    pub fn has_time_constant(&self) -> bool {
        let constants = self.constants();
        constants.time_constant_up_s.is_some() || constants.time_constant_down_s.is_some()
    }
}
