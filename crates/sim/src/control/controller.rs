//! The embedded loops of eq 1.

use super::mixer::mixer;
use crate::body::{BodyState, Euler};
use hovertone_vehicle::{ControllerParameters, Layout, LoopGains};

/// The joystick's commands, each normalised to ±1 (remark 1): φ_d = u φ_max and so on. Values beyond ±1 are clamped.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Command {
    /// Roll, positive leans and flies right.
    pub roll: f64,
    /// Pitch, positive puts the nose down and flies forward.
    pub pitch: f64,
    /// Yaw rate, positive turns left.
    pub yaw_rate: f64,
    /// Vertical rate, positive climbs.
    pub climb: f64,
}

impl Command {
    /// No command: the embedded controller hovers.
    pub const HOVER: Self = Self { roll: 0.0, pitch: 0.0, yaw_rate: 0.0, climb: 0.0 };

    /// Roll, pitch, yaw rate, climb.
    pub fn to_array(self) -> [f64; 4] {
        [self.roll, self.pitch, self.yaw_rate, self.climb]
    }

    /// From roll, pitch, yaw rate, climb.
    pub fn from_array([roll, pitch, yaw_rate, climb]: [f64; 4]) -> Self {
        Self { roll, pitch, yaw_rate, climb }
    }

    /// Each clamped to ±1; NaN counts as 0.
    pub fn limited(self) -> Self {
        Self::from_array(self.to_array().map(|part| if part.is_nan() { 0.0 } else { part.clamp(-1.0, 1.0) }))
    }
}

/// Eq 1, with errors desired less actual and all signs of the mixer M:
///
/// ```text
/// Δv = M [k_dφ φ̃' + k_pφ φ̃,  k_dθ θ̃' + k_pθ θ̃,  k_dψ ψ̃'' + k_pψ ψ̃',  k_dz z̃'' + k_pz z̃']
/// ```
///
/// The desired values count as constant between commands, so that a step of a command gives no spike. The derivatives of
/// the two rates are filtered differences, as on board; the derivatives of the angles are the gyroscope's rates. Each loop
/// is limited by l tanh(u/l), as in the authors' code; for small errors this is the linear eq 1.
#[derive(Clone, Debug)]
pub struct Controller {
    parameters: ControllerParameters,
    mixer: [[f64; 4]; 4],
    yaw_change: Change,
    climb_change: Change,
}

impl Controller {
    /// A controller that has not run yet.
    pub fn new(parameters: &ControllerParameters, layout: Layout) -> Self {
        let change = Change::new(parameters.period_s.value, parameters.derivative_filter_s.value);
        Self { parameters: parameters.clone(), mixer: mixer(layout), yaw_change: change, climb_change: change }
    }

    /// One run, every [`ControllerParameters::period_s`]: Δv of the rotors, V.
    pub fn run(&mut self, command: &Command, state: &BodyState) -> [f64; 4] {
        let (command, parameters) = (command.limited(), &self.parameters);
        let angles = Euler::from_attitude(&state.attitude);
        let [roll_rate, pitch_rate, yaw_rate] = angles.rates(&state.rates_rad_s);
        let climb_m_s = state.velocity_m_s.z;
        let (tilt, yaw, climb) =
            (parameters.tilt_rad_max.value, parameters.yaw_rate_rad_s_max.value, parameters.climb_m_s_max.value);
        let u = [
            asked_v(&parameters.roll.value, command.roll * tilt - angles.roll_rad, -roll_rate),
            asked_v(&parameters.pitch.value, command.pitch * tilt - angles.pitch_rad, -pitch_rate),
            asked_v(&parameters.yaw_rate.value, command.yaw_rate * yaw - yaw_rate, -self.yaw_change.of(yaw_rate)),
            asked_v(&parameters.climb.value, command.climb * climb - climb_m_s, -self.climb_change.of(climb_m_s)),
        ];
        self.mixer.map(|row| (0..4).map(|k| row[k] * u[k]).sum())
    }
}

fn asked_v(gains: &LoopGains, error: f64, error_rate: f64) -> f64 {
    gains.limit_v * ((gains.proportional * error + gains.derivative * error_rate) / gains.limit_v).tanh()
}

/// Rate of change through a first-order filter; 0 at the first value.
#[derive(Clone, Copy, Debug)]
struct Change {
    period_s: f64,
    keep: f64,
    before: Option<f64>,
    filtered: f64,
}

impl Change {
    fn new(period_s: f64, filter_s: f64) -> Self {
        let keep = if filter_s > 0.0 { (-period_s / filter_s).exp() } else { 0.0 };
        Self { period_s, keep, before: None, filtered: 0.0 }
    }

    fn of(&mut self, value: f64) -> f64 {
        if let Some(before) = self.before.replace(value) {
            self.filtered = self.keep * self.filtered + (1.0 - self.keep) * (value - before) / self.period_s;
        }
        self.filtered
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone_vehicle::find_flight_parameters;

    fn controller() -> Controller {
        Controller::new(&find_flight_parameters("ardrone").unwrap().controller, Layout::X)
    }

    /// Small errors: the linear eq 1, term by term, with the gains of the authors.
    #[test]
    fn small_errors_give_the_papers_sum() {
        let mut state = BodyState::at_rest([0.0, 0.0, 1.0]);
        state.attitude = Euler { roll_rad: 0.01, pitch_rad: -0.02, yaw_rad: 0.0 }.attitude();
        state.rates_rad_s.x = 0.03;
        state.velocity_m_s.z = 0.001;
        let angles = Euler::from_attitude(&state.attitude);
        let [roll_rate, pitch_rate, yaw_rate] = angles.rates(&state.rates_rad_s);
        let deltas = controller().run(&Command { roll: 0.1, ..Command::HOVER }, &state);
        let u = [
            0.065_52 * (0.1 * 0.261_799 - 0.01) - 0.065_52 * roll_rate,
            0.065_52 * 0.02 - 0.065_52 * pitch_rate,
            -0.1310 * yaw_rate,
            -8.736 * 0.001,
        ];
        let rows = [[1.0, -1.0, 1.0, 1.0], [1.0, 1.0, -1.0, 1.0], [-1.0, 1.0, 1.0, 1.0], [-1.0, -1.0, -1.0, 1.0]];
        for (delta, row) in deltas.into_iter().zip(rows) {
            let expected: f64 = row.iter().zip(u).map(|(sign, asked)| sign * asked).sum();
            assert!((delta - expected).abs() < 1e-6, "{delta} {expected}");
        }
    }

    /// Steady accelerations: once the filters have settled, each derivative term opposes its own acceleration by k_d.
    #[test]
    fn the_derivative_terms_of_the_rates_are_against_their_change() {
        let after = |climb_m_s2: f64, yaw_rad_s2: f64| {
            let mut controller = controller();
            let mut deltas = [0.0; 4];
            for run in -400..=0 {
                let mut state = BodyState::at_rest([0.0, 0.0, 1.0]);
                state.velocity_m_s.z = climb_m_s2 * 0.005 * f64::from(run);
                state.rates_rad_s.z = yaw_rad_s2 * 0.005 * f64::from(run);
                deltas = controller.run(&Command::HOVER, &state);
            }
            deltas
        };
        for (delta, sign) in after(0.5, 0.1).into_iter().zip([1.0, -1.0, 1.0, -1.0]) {
            let expected = -0.087_36 * 0.5 - sign * 0.065_52 * 0.1;
            assert!((delta - expected).abs() < 1e-3 * expected.abs(), "{delta} {expected}");
        }
    }

    #[test]
    fn large_errors_are_limited_and_commands_are_cut() {
        let mut state = BodyState::at_rest([0.0, 0.0, 1.0]);
        state.velocity_m_s.z = -20.0;
        let deltas = controller().run(&Command::HOVER, &state);
        assert!(deltas.iter().all(|delta| (delta - 1.7473).abs() < 1e-9));
        let wild = Command { roll: 7.0, pitch: f64::NAN, yaw_rate: -3.0, climb: 0.5 };
        assert_eq!(wild.limited().to_array(), [1.0, 0.0, -1.0, 0.5]);
        state.velocity_m_s.z = 0.0;
        assert_eq!(controller().run(&wild, &state), controller().run(&wild.limited(), &state));
    }

    #[test]
    fn the_change_of_a_ramp_is_its_slope() {
        let mut change = Change::new(0.005, 1.0 / 30.0);
        assert_eq!(change.of(3.0), 0.0);
        let last = (1..200).map(|k| change.of(3.0 + 2.0 * 0.005 * f64::from(k))).last().unwrap();
        assert!((last - 2.0).abs() < 1e-9);
    }
}
