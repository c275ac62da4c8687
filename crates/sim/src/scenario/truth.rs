//! The truth about a flight in a few numbers, for comparison with an estimate from its sound.

use crate::flight::FlightState;
use serde::Serialize;

/// Rotors of the flight model.
const ROTOR_COUNT: f64 = 4.0;

/// Exact means over the flight's hovers.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ScenarioTruth {
    /// Mass of the vehicle with payloads.
    pub mass_kg: f64,
    /// Gravity.
    pub gravity_m_s2: f64,
    /// C_f of each rotor in this flight, with its spread and in its air.
    pub rotor_thrust_constants_n_s2: [f64; 4],
    /// Speeds of the exact hover in still air.
    pub trim_speed_rad_s: [f64; 4],
    /// All hovers together; absent without a hover.
    pub hover: Option<SpanTruth>,
    /// Each hover.
    pub hovers: Vec<SpanTruth>,
    /// The whole flight.
    pub flight: SpanTruth,
}

/// Means over a span of time. As in the sound, speeds are straight lines between the steps.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct SpanTruth {
    /// Start of the first span.
    pub from_s: f64,
    /// End of the last span.
    pub to_s: f64,
    /// Total time of the spans, without the time between them.
    pub duration_s: f64,
    /// Mean speed of each rotor's shaft.
    pub mean_speed_rad_s: [f64; 4],
    /// Standard deviation of each rotor's speed.
    pub std_speed_rad_s: [f64; 4],
    /// Mean of each rotor's squared speed.
    pub mean_square_rad2_s2: [f64; 4],
    /// Mean of the sum of the squared speeds; in hover it is proportional to the weight.
    pub mean_sum_of_squares_rad2_s2: f64,
    /// Thrust constant of the whole vehicle by hover balance, C = m g / mean(Σω²) times the number of rotors: the result of a
    /// perfect estimator. It differs from the constants of the flight if the vehicle climbed (by Δv/(g T)) or tilted, and if
    /// unlike rotors carry unlike loads.
    pub thrust_constant_total_n_s2: f64,
    /// The same for one rotor.
    pub thrust_constant_per_rotor_n_s2: f64,
    /// Gain in vertical speed.
    pub climb_rate_change_m_s: f64,
}

/// The sums for the means.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Means {
    from_s: Option<f64>,
    to_s: f64,
    duration_s: f64,
    turns_rad: [f64; 4],
    squares: [f64; 4],
    climb_rate_change_m_s: f64,
}

impl Means {
    /// Adds one step, with speeds that are straight from one state to the next: ∫ω² = h (a² + a b + b²)/3.
    pub(super) fn add(&mut self, before: &FlightState, after: &FlightState) {
        let step_s = after.time_s - before.time_s;
        self.from_s.get_or_insert(before.time_s);
        self.to_s = after.time_s;
        self.duration_s += step_s;
        for k in 0..4 {
            let (a, b) = (before.speed_rad_s[k], after.speed_rad_s[k]);
            self.turns_rad[k] += 0.5 * step_s * (a + b);
            self.squares[k] += step_s * (a * a + a * b + b * b) / 3.0;
        }
        self.climb_rate_change_m_s += after.velocity_m_s[2] - before.velocity_m_s[2];
    }

    /// The means; none without steps.
    pub(super) fn span(&self, weight_n: f64) -> Option<SpanTruth> {
        let from_s = self.from_s?;
        let mean_speed_rad_s = self.turns_rad.map(|turns| turns / self.duration_s);
        let mean_square_rad2_s2 = self.squares.map(|squares| squares / self.duration_s);
        let std = |k: usize| (mean_square_rad2_s2[k] - mean_speed_rad_s[k].powi(2)).max(0.0).sqrt();
        let sum: f64 = mean_square_rad2_s2.iter().sum();
        let per_rotor = if sum > 0.0 { weight_n / sum } else { 0.0 };
        Some(SpanTruth {
            from_s,
            to_s: self.to_s,
            duration_s: self.duration_s,
            mean_speed_rad_s,
            std_speed_rad_s: std::array::from_fn(std),
            mean_square_rad2_s2,
            mean_sum_of_squares_rad2_s2: sum,
            thrust_constant_total_n_s2: ROTOR_COUNT * per_rotor,
            thrust_constant_per_rotor_n_s2: per_rotor,
            climb_rate_change_m_s: self.climb_rate_change_m_s,
        })
    }
}
