//! The parameters of the model, as a structure and as a vector.

use hovertone_vehicle::Axis;
use hovertone_vehicle::FlightParameters;

/// Number of parameters.
pub const PARAMETER_COUNT: usize = 23;

/// One loop of eq 1, in rad/s of the rotors.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoopModel {
    /// P = k_p/s: rad/s per unit of the error.
    pub proportional: f64,
    /// D = k_d/s: rad/s per unit of the error's rate.
    pub derivative: f64,
    /// 1/l², s²/rad², with the limit l of the loop; 0 for a loop without limit.
    pub inverse_square_limit: f64,
}

/// The model of eqs 1 and 2 about hover.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GreyBoxModel {
    /// The loops, in the order of [`Axis::ALL`].
    pub loops: [LoopModel; 4],
    /// τ = c/s.
    pub time_constant_s: f64,
    /// β = b/s, s/rad.
    pub load_s_rad: f64,
    /// From a command in the log to its effect: dead time, and what the clocks differ by.
    pub command_delay_s: f64,
    /// From a measured value in the log to its effect.
    pub measured_delay_s: f64,
    /// Speed of each rotor in hover.
    pub hover_rad_s: [f64; 4],
    /// Gain of each motor over their mean: its share of the voltage.
    pub motor_gain: [f64; 4],
}

/// One parameter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Parameter {
    /// P of a loop.
    Proportional(Axis),
    /// D of a loop.
    Derivative(Axis),
    /// 1/l² of a loop.
    Limit(Axis),
    /// τ.
    TimeConstant,
    /// β.
    Load,
    /// The delay of commands.
    CommandDelay,
    /// The delay of measured values.
    MeasuredDelay,
    /// Hover speed of a rotor, counted from 0.
    Hover(usize),
    /// Gain of the motor of rotor 0, 1 or 2 over the mean; that of rotor 3 follows.
    MotorGain(usize),
}

impl Parameter {
    /// All, in the order of the vector.
    pub fn all() -> [Self; PARAMETER_COUNT] {
        std::array::from_fn(|at| match at {
            0..4 => Self::Proportional(Axis::ALL[at]),
            4..8 => Self::Derivative(Axis::ALL[at - 4]),
            8..12 => Self::Limit(Axis::ALL[at - 8]),
            12 => Self::TimeConstant,
            13 => Self::Load,
            14 => Self::CommandDelay,
            15 => Self::MeasuredDelay,
            16..20 => Self::Hover(at - 16),
            _ => Self::MotorGain(at - 20),
        })
    }

    /// Its name in files.
    pub fn name(self) -> String {
        match self {
            Self::Proportional(axis) => format!("{}_proportional", axis.name()),
            Self::Derivative(axis) => format!("{}_derivative", axis.name()),
            Self::Limit(axis) => format!("{}_inverse_square_limit", axis.name()),
            Self::TimeConstant => "time_constant_s".to_owned(),
            Self::Load => "load_s_rad".to_owned(),
            Self::CommandDelay => "command_delay_s".to_owned(),
            Self::MeasuredDelay => "measured_delay_s".to_owned(),
            Self::Hover(rotor) => format!("hover_{}_rad_s", rotor + 1),
            Self::MotorGain(rotor) => format!("motor_gain_{}", rotor + 1),
        }
    }

    /// Its name in sentences.
    pub fn in_words(self) -> String {
        match self {
            Self::Proportional(axis) => format!("the gain k_p of {}", axis.in_words()),
            Self::Derivative(axis) => format!("the gain k_d of {}", axis.in_words()),
            Self::Limit(axis) => format!("the limit of {}", axis.in_words()),
            Self::TimeConstant => "the time constant".to_owned(),
            Self::Load => "the square term of the load".to_owned(),
            Self::CommandDelay => "the delay of commands".to_owned(),
            Self::MeasuredDelay => "the delay of measured values".to_owned(),
            Self::Hover(rotor) => format!("the hover speed of rotor {}", rotor + 1),
            Self::MotorGain(rotor) => format!("the gain of motor {}", rotor + 1),
        }
    }

    /// The loop to which it belongs.
    pub fn axis(self) -> Option<Axis> {
        match self {
            Self::Proportional(axis) | Self::Derivative(axis) | Self::Limit(axis) => Some(axis),
            _ => None,
        }
    }
}

impl GreyBoxModel {
    /// The model of a vehicle by its numbers, with alike rotors: where the fit starts.
    pub fn of(vehicle: &FlightParameters, mass_kg: f64, gravity_m_s2: f64) -> Self {
        let hover_rad_s = (mass_kg * gravity_m_s2 / (4.0 * vehicle.rotor.thrust_constant_n_s2.value)).sqrt();
        let volts = super::scenario::MotorVolts::of(vehicle);
        let slope = volts.slope_v_s_rad(hover_rad_s);
        let controller = &vehicle.controller;
        let gains = [controller.roll, controller.pitch, controller.yaw_rate, controller.climb];
        Self {
            loops: gains.map(|gains| LoopModel {
                proportional: gains.value.proportional / slope,
                derivative: gains.value.derivative / slope,
                inverse_square_limit: (slope / gains.value.limit_v).powi(2),
            }),
            time_constant_s: volts.inertia_v_s2_rad / slope,
            load_s_rad: volts.load_v_s2_rad2 / slope,
            command_delay_s: 0.0,
            measured_delay_s: 0.0,
            hover_rad_s: [hover_rad_s; 4],
            motor_gain: [1.0; 4],
        }
    }

    /// As a vector, in the order of [`Parameter::all`].
    pub fn to_vector(&self) -> [f64; PARAMETER_COUNT] {
        std::array::from_fn(|at| match Parameter::all()[at] {
            Parameter::Proportional(axis) => self.loops[axis as usize].proportional,
            Parameter::Derivative(axis) => self.loops[axis as usize].derivative,
            Parameter::Limit(axis) => self.loops[axis as usize].inverse_square_limit,
            Parameter::TimeConstant => self.time_constant_s,
            Parameter::Load => self.load_s_rad,
            Parameter::CommandDelay => self.command_delay_s,
            Parameter::MeasuredDelay => self.measured_delay_s,
            Parameter::Hover(rotor) => self.hover_rad_s[rotor],
            Parameter::MotorGain(rotor) => self.motor_gain[rotor],
        })
    }

    /// From a vector.
    pub fn from_vector(vector: &[f64; PARAMETER_COUNT]) -> Self {
        Self {
            loops: std::array::from_fn(|at| LoopModel {
                proportional: vector[at],
                derivative: vector[at + 4],
                inverse_square_limit: vector[at + 8],
            }),
            time_constant_s: vector[12],
            load_s_rad: vector[13],
            command_delay_s: vector[14],
            measured_delay_s: vector[15],
            hover_rad_s: std::array::from_fn(|rotor| vector[16 + rotor]),
            motor_gain: [vector[20], vector[21], vector[22], 4.0 - vector[20] - vector[21] - vector[22]],
        }
    }

    /// A size of each parameter, by which the fit is scaled: what changes a speed by about as much as the others.
    pub(super) fn scales(&self) -> [f64; PARAMETER_COUNT] {
        let hover = self.mean_hover_rad_s();
        let mut scales = [0.0; PARAMETER_COUNT];
        for (scale, (parameter, value)) in scales.iter_mut().zip(Parameter::all().into_iter().zip(self.to_vector())) {
            let floor = match parameter {
                Parameter::Proportional(_) | Parameter::Derivative(_) => 1e-3 * hover,
                Parameter::Limit(_) => (20.0 / hover).powi(2),
                Parameter::TimeConstant | Parameter::CommandDelay | Parameter::MeasuredDelay => 0.01,
                Parameter::Load => 0.1 / hover,
                Parameter::Hover(_) => 1e-2 * hover,
                Parameter::MotorGain(_) => 1e-2,
            };
            *scale = match parameter {
                Parameter::TimeConstant | Parameter::Proportional(_) | Parameter::Derivative(_) | Parameter::Load => {
                    value.abs().max(floor)
                }
                _ => floor,
            };
        }
        scales
    }

    /// Mean of the hover speeds.
    pub fn mean_hover_rad_s(&self) -> f64 {
        self.hover_rad_s.iter().sum::<f64>() / 4.0
    }
}
