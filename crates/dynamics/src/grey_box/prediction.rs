//! The speeds that the model predicts for a log.

use super::inputs::LoopInputs;
use super::parameters::{GreyBoxModel, LoopModel};
use hovertone_vehicle::Axis;

/// Shortest time constant of the model, s: shorter ones cannot be told from none on the grid. *Numeric.*
const TIME_CONSTANT_S_MIN: f64 = 1e-3;
/// Smallest time over time constant for which the response is not that of its series. *Numeric.*
const SHARE_MIN: f64 = 1e-6;

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
        let asked = Asked::new(inputs, model);
        let whole = Response::over(step_s, model.time_constant_s);
        let mut speed_rad_s = Vec::with_capacity(count);
        let mut delta = [0.0; 4];
        let mut before = asked.at(0.0, asked.held(0.0));
        for point in 0..count {
            let now = asked.at(point as f64, asked.held(point as f64));
            match asked.step_before(point) {
                None => whole.advance(&mut delta, inputs, model, Span { before, now }),
                // a command steps at once, so that the target has a jump between the points
                Some(Step { share, from, to }) => {
                    let place = point as f64 - 1.0 + share;
                    let first = Response::over(share * step_s, model.time_constant_s);
                    first.advance(&mut delta, inputs, model, Span { before, now: asked.at(place, from) });
                    let second = Response::over((1.0 - share) * step_s, model.time_constant_s);
                    second.advance(&mut delta, inputs, model, Span { before: asked.at(place, to), now });
                }
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

/// u of each loop between two times.
#[derive(Clone, Copy)]
struct Span {
    before: [f64; 4],
    now: [f64; 4],
}

/// The exact response of a motor, over some time, to a target on a straight line.
struct Response {
    keep: f64,
    of_before: f64,
    of_now: f64,
}

impl Response {
    fn over(time_s: f64, time_constant_s: f64) -> Self {
        let time_constant_s = time_constant_s.max(TIME_CONSTANT_S_MIN);
        let share = time_s / time_constant_s;
        let keep = (-share).exp();
        // of a time near zero, the first terms of the series
        let of_now = if share > SHARE_MIN { 1.0 - (1.0 - keep) / share } else { share / 2.0 };
        Self { keep, of_now, of_before: 1.0 - keep - of_now }
    }

    fn advance(&self, delta: &mut [f64; 4], inputs: &LoopInputs, model: &GreyBoxModel, asked: Span) {
        for (rotor, delta) in delta.iter_mut().enumerate() {
            let target = |axis: usize| {
                inputs.mixer[rotor][axis] * (self.of_before * asked.before[axis] + self.of_now * asked.now[axis])
            };
            let load = model.load_s_rad * *delta * *delta;
            let moved = model.motor_gain[rotor] * (0..4).map(target).sum::<f64>();
            *delta = self.keep * *delta + moved - (1.0 - self.keep) * load;
        }
    }
}

/// A step of the commands between two points.
struct Step {
    /// Its place between the points, 0 to 1.
    share: f64,
    /// Wanted values before and behind it.
    from: [f64; 4],
    to: [f64; 4],
}

/// What the loops ask for, over time.
struct Asked<'a> {
    inputs: &'a LoopInputs,
    model: &'a GreyBoxModel,
    /// Delays in steps of the grid.
    command_delay: f64,
    measured_delay: f64,
}

impl<'a> Asked<'a> {
    fn new(inputs: &'a LoopInputs, model: &'a GreyBoxModel) -> Self {
        let steps = |delay_s: f64| delay_s / inputs.step_s;
        Self {
            inputs,
            model,
            command_delay: steps(model.command_delay_s),
            measured_delay: steps(model.measured_delay_s),
        }
    }

    /// The wanted values at a place: a command is held until the next.
    fn held(&self, place: f64) -> [f64; 4] {
        self.wanted((place - self.command_delay).floor())
    }

    fn wanted(&self, index: f64) -> [f64; 4] {
        self.inputs.wanted[index.clamp(0.0, (self.inputs.len() - 1) as f64) as usize]
    }

    /// The step of the commands between a point and the one before it, if there is one.
    fn step_before(&self, point: usize) -> Option<Step> {
        let (from_place, to_place) = (point as f64 - 1.0 - self.command_delay, point as f64 - self.command_delay);
        let (from, to) = (self.wanted(from_place.floor()), self.wanted(to_place.floor()));
        (point > 0 && from != to).then(|| Step { share: to_place.floor() - from_place, from, to })
    }

    /// u of each loop at a place, with these wanted values.
    fn at(&self, place: f64, wanted: [f64; 4]) -> [f64; 4] {
        let place = place - self.measured_delay;
        let measured = between(&self.inputs.measured, place);
        let rate = between(&self.inputs.measured_rate, place);
        Axis::ALL.map(|axis| {
            let at = axis as usize;
            limited(&self.model.loops[at], wanted[at] - measured[at], -rate[at])
        })
    }
}

/// `l tanh(x/l)` with x = P e + D e'. It is smooth in 1/l² through 0, and goes on as the cubic of tanh for values below, so that a fit can cross 0.
fn limited(loop_model: &LoopModel, error: f64, error_rate: f64) -> f64 {
    let asked = loop_model.proportional * error + loop_model.derivative * error_rate;
    let share = loop_model.inverse_square_limit * asked * asked;
    if share > 1e-6 { asked * share.sqrt().tanh() / share.sqrt() } else { asked * (1.0 - share.max(-3.0) / 3.0) }
}

/// Values at a place between the points.
fn between(values: &[[f64; 4]], place: f64) -> [f64; 4] {
    let place = place.clamp(0.0, (values.len() - 1) as f64);
    let (before, share) = (place as usize, place.fract());
    let next = (before + 1).min(values.len() - 1);
    std::array::from_fn(|axis| values[before][axis] + share * (values[next][axis] - values[before][axis]))
}

#[cfg(test)]
mod tests {
    use super::super::inputs::{ControlKnowns, ControlLog};
    use super::*;
    use hovertone_vehicle::find_flight_parameters;

    /// A roll command that steps at one second, in a log with rows every 4 ms; the vehicle does not move.
    fn stepping(delay_s: f64) -> (SpeedPrediction, GreyBoxModel, f64) {
        let vehicle = find_flight_parameters("f450").unwrap();
        let mut model = GreyBoxModel::of(vehicle, vehicle.mass_kg.value, 9.8);
        (model.command_delay_s, model.load_s_rad) = (delay_s, 0.0);
        let time_s: Vec<f64> = (0..500).map(|row| 0.004 * f64::from(row)).collect();
        let none = || Some(vec![0.0; time_s.len()]);
        let command: Vec<f64> = time_s.iter().map(|time_s| if *time_s > 0.999 { 0.3 } else { 0.0 }).collect();
        let log = ControlLog {
            command: [Some(command), None, None, None],
            measured: [none(), None, None, None],
            tilt_rate_rad_s: [none(), None],
            time_s: time_s.clone(),
        };
        let knowns = ControlKnowns::of(vehicle);
        let inputs = LoopInputs::from_log(&log, &knowns).unwrap();
        let target = inputs.mixer[0][0] * limited(&model.loops[0], 0.3 * knowns.scales[0], 0.0);
        (SpeedPrediction::new(&inputs, &model), model, target)
    }

    #[test]
    fn a_command_steps_at_once_wherever_it_lies_between_two_points() {
        for delay_s in [0.0, 0.0007, 0.0133, -0.0011] {
            let (prediction, model, target) = stepping(delay_s);
            for (point, speeds) in prediction.speed_rad_s.iter().enumerate() {
                let since_s = point as f64 * prediction.step_s - 1.0 - delay_s;
                let expected =
                    if since_s > 0.0 { target * (1.0 - (-since_s / model.time_constant_s).exp()) } else { 0.0 };
                let told = speeds[0] - model.hover_rad_s[0];
                assert!(
                    (told - expected).abs() < 1e-9 * target.abs().max(1.0),
                    "{delay_s} {since_s}: {told} {expected}"
                );
            }
        }
    }
}
