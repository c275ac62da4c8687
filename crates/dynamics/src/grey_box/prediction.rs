//! The speeds that the model predicts for a log.

use super::inputs::LoopInputs;
use super::parameters::{GreyBoxModel, LoopModel};
use hovertone_vehicle::Axis;

/// Shortest time constant of the model, s: shorter ones cannot be told from none on the grid. *Numeric.*
const TIME_CONSTANT_S_MIN: f64 = 1e-3;

/// Speeds of the four rotors on an even grid.
#[derive(Clone, Debug, PartialEq)]
pub struct SpeedPrediction {
    /// Time of the first point.
    pub start_s: f64,
    /// Step of the grid.
    pub step_s: f64,
    /// Speed of each rotor at each point.
    pub speed_rad_s: Vec<[f64; 4]>,
}

impl SpeedPrediction {
    /// Runs the model over the inputs.
    pub fn new(inputs: &LoopInputs, model: &GreyBoxModel) -> Self {
        let (step_s, count) = (inputs.step_s, inputs.len());
        let time_constant_s = model.time_constant_s.max(TIME_CONSTANT_S_MIN);
        let keep = (-step_s / time_constant_s).exp();
        // of a target on a straight line, the exact response
        let of_now = 1.0 - (1.0 - keep) * time_constant_s / step_s;
        let of_before = 1.0 - keep - of_now;
        let mut speed_rad_s = Vec::with_capacity(count);
        let mut delta = [0.0; 4];
        let mut before = asked(inputs, model, 0);
        for point in 0..count {
            let now = asked(inputs, model, point);
            for (rotor, delta) in delta.iter_mut().enumerate() {
                let moved = |axis: usize| inputs.mixer[rotor][axis] * (of_before * before[axis] + of_now * now[axis]);
                let load = model.load_s_rad * *delta * *delta;
                let moved = model.motor_gain[rotor] * (0..4).map(moved).sum::<f64>();
                *delta = keep * *delta + moved - (1.0 - keep) * load;
            }
            before = now;
            speed_rad_s.push(std::array::from_fn(|rotor| model.hover_rad_s[rotor] + delta[rotor]));
        }
        Self { start_s: inputs.start_s, step_s, speed_rad_s }
    }

    /// The slowest and the fastest speed of any rotor.
    pub fn range_rad_s(&self) -> (f64, f64) {
        let speeds = || self.speed_rad_s.iter().flatten().copied();
        (speeds().fold(f64::INFINITY, f64::min), speeds().fold(0.0, f64::max))
    }

    /// Speeds at a time, on straight lines between the points; the nearest point outside.
    pub fn at(&self, time_s: f64) -> [f64; 4] {
        let place = ((time_s - self.start_s) / self.step_s).clamp(0.0, (self.speed_rad_s.len() - 1) as f64);
        let (before, share) = (place as usize, place.fract());
        let next = (before + 1).min(self.speed_rad_s.len() - 1);
        std::array::from_fn(|rotor| {
            let (from, to) = (self.speed_rad_s[before][rotor], self.speed_rad_s[next][rotor]);
            from + share * (to - from)
        })
    }
}

/// u of each loop at a point.
fn asked(inputs: &LoopInputs, model: &GreyBoxModel, point: usize) -> [f64; 4] {
    let wanted = delayed(&inputs.wanted, point as f64 - model.command_delay_s / inputs.step_s);
    let place = point as f64 - model.measured_delay_s / inputs.step_s;
    let (measured, rate) = (delayed(&inputs.measured, place), delayed(&inputs.measured_rate, place));
    Axis::ALL.map(|axis| {
        let at = axis as usize;
        limited(&model.loops[at], wanted[at] - measured[at], -rate[at])
    })
}

/// `l tanh(x/l)` with x = P e + D e'. It is smooth in 1/l² through 0, and goes on as the cubic of tanh for values below, so that a fit can cross 0.
fn limited(loop_model: &LoopModel, error: f64, error_rate: f64) -> f64 {
    let asked = loop_model.proportional * error + loop_model.derivative * error_rate;
    let share = loop_model.inverse_square_limit * asked * asked;
    if share > 1e-6 { asked * share.sqrt().tanh() / share.sqrt() } else { asked * (1.0 - share.max(-3.0) / 3.0) }
}

/// Values at a place between the points.
fn delayed(values: &[[f64; 4]], place: f64) -> [f64; 4] {
    let place = place.clamp(0.0, (values.len() - 1) as f64);
    let (before, share) = (place as usize, place.fract());
    let next = (before + 1).min(values.len() - 1);
    std::array::from_fn(|axis| values[before][axis] + share * (values[next][axis] - values[before][axis]))
}
