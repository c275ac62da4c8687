//! The square term of eq 2: the torque of the load grows with ω², so that a motor follows faster at higher speeds.

use crate::step::{MotorStep, StepVerdict};
use crate::weighted_line::{WeightedLine, WeightedPoint};
use hovertone_vehicle::{Ending, Estimate};

/// Fewest steps: a straight line through two points has no scatter. *Numeric.*
pub const LOAD_STEPS_MIN: usize = 3;
/// Largest standard uncertainty of the load's share of 1/τ at the mean speed. *Decision*: at more the range of speeds is too small.
const SHARE_STD_MAX: f64 = 0.1;
/// A curve of first order through a step with the square term has the 1/τ of the speed at its end, less this share of the step. *Physics*:
/// least squares of first order in the term, with start and both levels free.
const STEP_SHARE: f64 = 2.0 / 9.0;

/// dω/dt = (ω_target − ω)/τ₀ − k ω²: near a speed ω the motor follows with 1/τ = 1/τ₀ + 2 k ω.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LoadTerm {
    /// 1/τ₀, without load, per second.
    pub unloaded_rate_per_s: Estimate,
    /// k per turn, for speeds in rev/s.
    pub square_per_rev: Estimate,
    /// Share of the load in 1/τ at the mean speed of the steps.
    pub share: Estimate,
}

/// The term from rising steps at different speeds: the line of 1/τ over the speed, weighted by the uncertainties, which a larger scatter
/// about the line increases. `None` where the range of speeds is too small to tell it.
pub(crate) fn load_term_of<'a>(steps: impl Iterator<Item = &'a MotorStep>) -> Option<LoadTerm> {
    let rising = steps.filter(|step| step.verdict == StepVerdict::Used && step.is_up());
    let rates: Vec<WeightedPoint> = rising.filter_map(rate_of).collect();
    if rates.len() < LOAD_STEPS_MIN {
        return None;
    }
    let line = WeightedLine::through(&rates);
    let WeightedLine { x_mean: speed, y_mean: rate_mean, slope, slope_variance, .. } = line;
    let estimate =
        |value: f64, variance: f64| Estimate { value, std_uncertainty: Some(variance.sqrt()), ending: Ending::Solved };
    let unloaded_variance = line.y_mean_variance + slope_variance * speed * speed;
    let share = estimate(slope * speed / rate_mean, slope_variance * (speed / rate_mean).powi(2));
    let is_told = share.std_uncertainty.is_some_and(|std| std <= SHARE_STD_MAX);
    is_told.then(|| LoadTerm {
        unloaded_rate_per_s: estimate(line.at_zero(), unloaded_variance),
        square_per_rev: estimate(slope / 2.0, slope_variance / 4.0),
        share,
    })
}

/// 1/τ of a step, per second, over the speed that it belongs to, in rev/s.
fn rate_of(step: &MotorStep) -> Option<WeightedPoint> {
    let time_constant_s = step.time_constant_s?;
    let rate_per_s = time_constant_s.value.recip();
    let std_per_s = time_constant_s.std_uncertainty? * rate_per_s * rate_per_s;
    let speed_rev_s = step.speed_to_rev_s - STEP_SHARE * (step.speed_to_rev_s - step.speed_from_rev_s);
    (std_per_s > 0.0).then(|| WeightedPoint { x: speed_rev_s, y: rate_per_s, weight: std_per_s.powi(-2) })
}
