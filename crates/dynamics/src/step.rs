//! A step and what it can tell.

use crate::config::MotorConfig;
use crate::first_order::{EVEN_VARIANCE, FirstOrderFit, FitRange, first_order_from_rows, response};
use crate::frame_response::FrameResponse;
use crate::plateaus::Plateau;
use crate::search::Interval;
use crate::series::MotorSeries;
use crate::transitions::{CommandStep, Transition};
use hovertone_vehicle::{Ending, Estimate};

/// How often the window is cut again by the time constant that it gave. *Numeric.*
const ROUNDS: usize = 3;
/// A step spans this number of time constants to 95 %: ln 20. *Physics.*
const RISE_TIME_CONSTANTS: f64 = 3.0;
/// Shortest time constant that is sought, in intervals between rows. *Numeric*: the response is within one row.
const TIME_CONSTANT_INTERVALS_MIN: f64 = 0.2;
/// Largest standard uncertainty of a time constant as a share of it. *Decision*: more is no value.
const TIME_CONSTANT_STD_SHARE_MAX: f64 = 0.5;
/// A motor below this share of its largest speed is at rest. *Decision.*
const REST_SHARE: f64 = 0.02;

/// What a step can tell.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StepVerdict {
    /// Time constant, and dead time where the command is known.
    Used,
    /// Too few rows within the rise.
    TooSlowRows,
    /// The speed does not follow the command: the supply, or the ESC, is at its limit.
    Saturated,
    /// The motor starts or stops: the ESC starts it by its own rule, and a stopped rotor coasts.
    AtRest,
    /// The speed does not follow a curve of first order.
    OtherCurve,
    /// The curve fits, but the time constant has an uncertainty above half of its value.
    Uncertain,
}

/// A step of the speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotorStep {
    /// When the speed begins to change.
    pub time_s: Estimate,
    /// Speed before.
    pub speed_from_rev_s: f64,
    /// Speed that the curve approaches.
    pub speed_to_rev_s: f64,
    /// τ. Absent where the rows are too slow, or the curve is another one.
    pub time_constant_s: Option<Estimate>,
    /// Time from the first row with the new command to the change. Absent without a step of the command.
    pub dead_time_s: Option<Estimate>,
    /// Command before and behind. Absent without a step of the command.
    pub command: Option<[f64; 2]>,
    /// Rms of the residuals of the curve.
    pub residual_rms_rev_s: f64,
    /// What it can tell.
    pub verdict: StepVerdict,
}

impl MotorStep {
    /// Whether the speed rises.
    pub fn is_up(&self) -> bool {
        self.speed_to_rev_s > self.speed_from_rev_s
    }

    /// The speed of the fitted curve at a time; `None` without a time constant.
    pub fn speed_rev_s_at(&self, time_s: f64) -> Option<f64> {
        let done = response(time_s, self.time_s.value, self.time_constant_s?.value);
        Some(self.speed_from_rev_s + (self.speed_to_rev_s - self.speed_from_rev_s) * done)
    }
}

/// What all steps of a motor share.
#[derive(Clone, Copy, Debug)]
pub(crate) struct StepContext<'a> {
    pub(crate) series: MotorSeries<'a>,
    pub(crate) interval_s: f64,
    pub(crate) command_interval_s: f64,
    pub(crate) scatter_rev_s: f64,
    /// Plateaus whose speed does not follow the command.
    pub(crate) saturated: &'a [Plateau],
    pub(crate) config: &'a MotorConfig,
}

/// The step in a window; `None` where the speed does not change.
pub(crate) fn step_of_transition(context: &StepContext, transition: &Transition) -> Option<MotorStep> {
    let fit = fit_of_window(context, transition)?;
    let config = context.config;
    let size_rev_s = (fit.to_rev_s - fit.from_rev_s).abs();
    let speed_rev_s_max = context.series.speed_rev_s_max();
    let smallest_rev_s =
        (config.step_share_min * speed_rev_s_max).max(config.step_over_scatter_min * context.scatter_rev_s);
    if size_rev_s < smallest_rev_s {
        return None;
    }
    let is_saturated = |step: &CommandStep| {
        context.saturated.iter().any(|plateau| plateau.command == step.to || plateau.command == step.from)
    };
    let verdict = if fit.from_rev_s.min(fit.to_rev_s) < REST_SHARE * speed_rev_s_max {
        StepVerdict::AtRest
    } else if transition.command.as_ref().is_some_and(is_saturated) {
        StepVerdict::Saturated
    } else if RISE_TIME_CONSTANTS * fit.time_constant_s < config.rise_rows_min * context.interval_s {
        StepVerdict::TooSlowRows
    } else if fit.residual_rms_rev_s > config.residual_share_max * size_rev_s {
        StepVerdict::OtherCurve
    } else if fit.time_constant_std_s > TIME_CONSTANT_STD_SHARE_MAX * fit.time_constant_s {
        StepVerdict::Uncertain
    } else {
        StepVerdict::Used
    };
    Some(told_step(context, transition, fit, verdict))
}

fn told_step(context: &StepContext, transition: &Transition, fit: FirstOrderFit, verdict: StepVerdict) -> MotorStep {
    let estimate = |value: f64, std: f64| Estimate { value, std_uncertainty: Some(std), ending: Ending::Solved };
    let has_curve = matches!(verdict, StepVerdict::Used | StepVerdict::Uncertain);
    let dead_time = |step: &CommandStep| {
        let rounding = EVEN_VARIANCE * context.command_interval_s.powi(2);
        estimate(fit.start_s - step.time_s, (fit.start_std_s.powi(2) + rounding).sqrt())
    };
    // what may be anywhere in the range of dead times is not known
    let is_told =
        |dead_time: &Estimate| dead_time.std_uncertainty.is_some_and(|std| std < context.config.dead_time_s_max);
    MotorStep {
        time_s: estimate(fit.start_s, fit.start_std_s),
        speed_from_rev_s: fit.from_rev_s,
        speed_to_rev_s: fit.to_rev_s,
        time_constant_s: has_curve.then(|| estimate(fit.time_constant_s, fit.time_constant_std_s)),
        dead_time_s: transition.command.as_ref().filter(|_| has_curve).map(dead_time).filter(is_told),
        command: transition.command.map(|step| [step.from, step.to]),
        residual_rms_rev_s: fit.residual_rms_rev_s,
        verdict,
    }
}

/// The curve, in a window of some time constants about the start: plateaus drift.
fn fit_of_window(context: &StepContext, transition: &Transition) -> Option<FirstOrderFit> {
    let config = context.config;
    let shortest_s = TIME_CONSTANT_INTERVALS_MIN * context.interval_s;
    let mut about_s = config.window_s_first;
    let mut start_s = transition.start_s.low;
    let frame = FrameResponse::of_frame(config.frame_s);
    let mut fit = None;
    for _ in 0..ROUNDS {
        let from_s = transition.window_from_s.max(start_s - about_s);
        let to_s = transition.window_to_s.min(start_s + about_s);
        let rows = context.series.between(from_s, to_s);
        let time_constant_s = Interval { low: shortest_s, high: shortest_s.max((to_s - start_s) / 2.0) };
        let found = first_order_from_rows(&rows, &frame, FitRange { start_s: transition.start_s, time_constant_s })?;
        start_s = found.start_s;
        about_s = (config.window_time_constants * found.time_constant_s).max(config.hold_s_min);
        fit = Some(found);
    }
    fit
}
