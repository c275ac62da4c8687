//! Sections of a scenario file: vehicle, air, sound, place, microphones.

use hovertone_vehicle::Layout;
use serde::{Deserialize, Serialize};

/// The vehicle: a preset, and the numbers that replace the preset's.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct VehicleSection {
    /// Id of a vehicle with flight parameters.
    pub preset: String,
    /// Take-off mass without payloads.
    pub mass_kg: Option<f64>,
    /// Ixx, Iyy, Izz about the centre of mass.
    pub inertia_kg_m2: Option<[f64; 3]>,
    /// Layout of the rotors: "x" or "plus".
    pub layout: Option<LayoutName>,
    /// Centre to rotor shaft.
    pub arm_length_m: Option<f64>,
    /// Linear drag along the body's axes.
    pub drag_n_s_m: Option<[f64; 3]>,
    /// C_f of one rotor.
    pub thrust_constant_per_rotor_n_s2: Option<f64>,
    /// C_τ of one rotor.
    pub torque_constant_per_rotor_n_m_s2: Option<f64>,
    /// Density of the air in which both constants were measured.
    pub air_density_kg_m3: Option<f64>,
    /// R of a motor.
    pub motor_resistance_ohm: Option<f64>,
    /// k_m = k_b of a motor.
    pub motor_constant_v_s_rad: Option<f64>,
    /// B_m of a motor.
    pub motor_viscous_n_m_s: Option<f64>,
    /// J_m: inertia of all turning parts at the motor's shaft.
    pub motor_inertia_kg_m2: Option<f64>,
    /// Voltage that limits the motors.
    pub battery_voltage_v: Option<f64>,
    /// Charge of the battery.
    pub battery_capacity_a_h: Option<f64>,
    /// Resistance of the battery with its leads.
    pub battery_resistance_ohm: Option<f64>,
}

impl Default for VehicleSection {
    /// The paper's.
    fn default() -> Self {
        Self {
            preset: "ardrone".to_owned(),
            mass_kg: None,
            inertia_kg_m2: None,
            layout: None,
            arm_length_m: None,
            drag_n_s_m: None,
            thrust_constant_per_rotor_n_s2: None,
            torque_constant_per_rotor_n_m_s2: None,
            air_density_kg_m3: None,
            motor_resistance_ohm: None,
            motor_constant_v_s_rad: None,
            motor_viscous_n_m_s: None,
            motor_inertia_kg_m2: None,
            battery_voltage_v: None,
            battery_capacity_a_h: None,
            battery_resistance_ohm: None,
        }
    }
}

/// Name of a layout in the file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LayoutName {
    /// Arms at 45° to the axes.
    X,
    /// Arms along the axes.
    Plus,
}

impl From<LayoutName> for Layout {
    fn from(name: LayoutName) -> Self {
        match name {
            LayoutName::X => Self::X,
            LayoutName::Plus => Self::Plus,
        }
    }
}

/// A point mass.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PayloadSection {
    /// Its mass.
    pub mass_kg: f64,
    /// Its position, body axes from the centre of mass of the vehicle without payloads.
    #[serde(default)]
    pub position_m: [f64; 3],
}

/// Standard deviations of an unsteadiness on the four commands (±1), from the pilot's thumbs or from errors of the embedded
/// controller's sensors. The process is smooth (critically damped, second order), so a vertical rate of `std` m/s means
/// accelerations of `std / time_constant_s`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct JitterSection {
    /// On roll.
    pub roll_std: f64,
    /// On pitch.
    pub pitch_std: f64,
    /// On the yaw rate.
    pub yaw_rate_std: f64,
    /// On the vertical rate.
    pub climb_std: f64,
    /// Time constant τ of its autocovariance (1 + t/τ) e^(-t/τ).
    pub time_constant_s: f64,
}

impl Default for JitterSection {
    fn default() -> Self {
        Self { roll_std: 0.0, pitch_std: 0.0, yaw_rate_std: 0.0, climb_std: 0.0, time_constant_s: 0.3 }
    }
}

/// Differences among rotors and motors: given one by one, or drawn from the seed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SpreadSection {
    /// C_f of each rotor over the vehicle's C_f.
    pub thrust_shares: Option<[f64; 4]>,
    /// Gain of each motor: voltage felt over voltage given.
    pub motor_gains: Option<[f64; 4]>,
    /// Standard deviation of C_f, if the shares are not given.
    pub thrust_std_share: f64,
    /// Standard deviation of the motors' gains, if they are not given.
    pub motor_gain_std_share: f64,
}

/// The random wander of each motor's gain in flight, independent for each motor.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct MotorWanderSection {
    /// Standard deviation of each gain over its mean. With 0.3 % the speeds wander by 0.2 %, as for real quadrotors that hover in a room.
    pub gain_std_share: f64,
    /// Time constant τ of its autocovariance e^(-t/τ).
    pub time_constant_s: f64,
}

impl Default for MotorWanderSection {
    fn default() -> Self {
        Self { gain_std_share: 0.003, time_constant_s: 0.4 }
    }
}

/// The air, as a weather station reports it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct AirSection {
    /// Temperature.
    pub temperature_c: f64,
    /// Pressure at the place.
    pub pressure_hpa: f64,
    /// Relative humidity, 0 to 100.
    pub humidity_percent: f64,
}

impl Default for AirSection {
    /// ISO 2533.
    fn default() -> Self {
        Self { temperature_c: 15.0, pressure_hpa: 1013.25, humidity_percent: 0.0 }
    }
}

/// Steady wind.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WindSection {
    /// Velocity of the air, world axes.
    pub velocity_m_s: [f64; 3],
}

/// Dryden gusts, from the wind outdoors or from their own numbers.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct GustSection {
    /// Wind at 6 m above the ground; MIL-F-8785C gives the other numbers for the height of the start.
    pub wind_at_6_m_m_s: Option<f64>,
    /// Standard deviation along, across and up.
    pub std_m_s: Option<[f64; 3]>,
    /// Length along, across and up.
    pub length_m: Option<[f64; 3]>,
    /// Speed at which the turbulence is carried past the vehicle.
    pub airspeed_m_s: Option<f64>,
}

/// Format of the recording and strength of the sources.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct SoundSection {
    /// Samples per second.
    pub sample_rate_hz: u32,
    /// Format of a sample.
    pub sample_format: SampleFormat,
    /// Level of a rotor's line of level 1 at 1 m, at its hover speed.
    pub tone_level_db_spl: f64,
    /// Level of a rotor's broadband noise at 1 m.
    pub broadband_level_db_spl: f64,
    /// Standard deviation of every line's slow change in amplitude and phase.
    pub unsteadiness: f64,
    /// Where the levels of the lines come from.
    pub line_levels: LineLevelsName,
}

/// Where the levels of the lines come from.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum LineLevelsName {
    /// One assumed set for each vehicle.
    #[default]
    Assumed,
    /// Drawn from the levels of real rotors, by the seed.
    Drawn,
}

impl Default for SoundSection {
    /// The levels of [`SourceSettings::for_vehicle`](crate::SourceSettings::for_vehicle), at 48 kHz.
    fn default() -> Self {
        Self {
            sample_rate_hz: 48_000,
            sample_format: SampleFormat::Int16,
            tone_level_db_spl: 53.0,
            broadband_level_db_spl: 60.0,
            unsteadiness: 0.1,
            line_levels: LineLevelsName::Assumed,
        }
    }
}

/// Format of a sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SampleFormat {
    /// Whole numbers of 16 bits.
    Int16,
    /// Whole numbers of 24 bits.
    Int24,
    /// Floating point of 32 bits.
    Float32,
}

impl SampleFormat {
    /// Bits of a whole number; none for floating point.
    pub fn integer_bits(self) -> Option<u32> {
        match self {
            Self::Int16 => Some(16),
            Self::Int24 => Some(24),
            Self::Float32 => None,
        }
    }

    /// Bytes of a sample.
    pub fn byte_count(self) -> u32 {
        self.integer_bits().unwrap_or(32) / 8
    }
}

/// A room; defaults as in [`Room`](crate::Room).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RoomSection {
    /// The corner with the smallest coordinates; its z is the floor.
    pub corner_m: Option<[f64; 3]>,
    /// Length along x, along y, and height.
    pub size_m: Option<[f64; 3]>,
    /// Absorption of all four walls.
    pub wall_absorption: Option<f64>,
    /// Absorption of the floor.
    pub floor_absorption: Option<f64>,
    /// Absorption of the ceiling.
    pub ceiling_absorption: Option<f64>,
    /// Reverberation time: the tail falls by 60 dB in it; 0 for first reflections only.
    pub reverberation_s: Option<f64>,
}

/// A level ground.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct GroundSection {
    /// Share of the sound energy that it absorbs.
    pub absorption: f64,
}

impl Default for GroundSection {
    /// Concrete (tables: 0.02 at 1 kHz).
    fn default() -> Self {
        Self { absorption: 0.02 }
    }
}

/// Noise of the place; default as in [`AmbientSettings`](crate::AmbientSettings).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct AmbientSection {
    /// Level over the whole band.
    pub level_db_spl: Option<f64>,
}

/// People talking; defaults as in [`BabbleSettings`](crate::BabbleSettings).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct PeopleSection {
    /// Level of all voices together at 1 m.
    pub level_db_spl: Option<f64>,
    /// Number of people who talk at once.
    pub voices: Option<u32>,
    /// Position of the source.
    pub position_m: Option<[f64; 3]>,
}

/// A microphone; defaults as in [`MicrophoneSettings::at`](crate::MicrophoneSettings::at).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct MicrophoneSection {
    /// Its position.
    pub position_m: [f64; 3],
    /// Whether it has no filters and no noise, and no rounding unless the sample format is a whole number.
    #[serde(default)]
    pub ideal: bool,
    /// Level of a sine with peaks at full scale.
    #[serde(default)]
    pub full_scale_db_spl: Option<f64>,
    /// Its own noise.
    #[serde(default)]
    pub self_noise_db_spl: Option<f64>,
    /// Noise of the wind over it.
    #[serde(default)]
    pub wind_noise_db_spl: Option<f64>,
    /// Gain of the recorder that follows the level.
    #[serde(default)]
    pub automatic_gain: Option<AutomaticGainSection>,
}

impl MicrophoneSection {
    /// The default microphone at this position.
    pub fn at(position_m: [f64; 3]) -> Self {
        Self {
            position_m,
            ideal: false,
            full_scale_db_spl: None,
            self_noise_db_spl: None,
            wind_noise_db_spl: None,
            automatic_gain: None,
        }
    }
}

/// An automatic gain; defaults as in [`AutomaticGain`](crate::AutomaticGain).
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct AutomaticGainSection {
    /// Level that the sound is brought to: its rms over that of a full-scale sine.
    pub target_dbfs: Option<f64>,
    /// Time constant of a gain that falls.
    pub attack_s: Option<f64>,
    /// Time constant of a gain that rises.
    pub release_s: Option<f64>,
    /// Largest gain.
    pub gain_db_max: Option<f64>,
}
