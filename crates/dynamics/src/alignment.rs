//! Commands on a clock of their own: which offset brings their steps to the steps of the speed.

use crate::config::MotorConfig;
use crate::plateaus::held_commands;
use crate::series::CommandSeries;
use crate::step::MotorStep;
use hovertone_signal::statistics::median;

/// Largest scatter of the times of steps about the offset. *Physics*: dead times of one motor are alike.
const SCATTER_S_MAX: f64 = 0.06;
/// Fewest steps that must agree, of three or more. *Decision*: two agree by chance in a long recording.
const STEPS_MIN: usize = 2;

/// A step as time and sense.
#[derive(Clone, Copy)]
struct TimedStep {
    time_s: f64,
    is_up: bool,
}

/// Time to be added to the commands' clock, so that each command comes when its effect begins. `None` if fewer than two steps agree, or another
/// offset is as good.
pub fn offset_of_commands(steps: &[MotorStep], command: &CommandSeries, config: &MotorConfig) -> Option<f64> {
    let heard: Vec<TimedStep> =
        steps.iter().map(|step| TimedStep { time_s: step.time_s.value, is_up: step.is_up() }).collect();
    let held = held_commands(command);
    let pairs = held.windows(2).filter(|pair| pair[0].length_s().min(pair[1].length_s()) >= config.hold_s_min);
    let commanded: Vec<TimedStep> =
        pairs.map(|pair| TimedStep { time_s: pair[1].from_s, is_up: pair[1].command > pair[0].command }).collect();
    let candidates = heard.iter().flat_map(|heard| commanded.iter().map(move |step| heard.time_s - step.time_s));
    let matched = |offset_s: f64| -> Vec<f64> {
        let distance = |step: &TimedStep| {
            let near = heard.iter().filter(|heard| heard.is_up == step.is_up).map(|heard| heard.time_s - step.time_s);
            near.min_by(|a, b| (a - offset_s).abs().total_cmp(&(b - offset_s).abs()))
        };
        commanded.iter().filter_map(distance).filter(|at_s| (at_s - offset_s).abs() <= SCATTER_S_MAX).collect()
    };
    let mut found: Vec<Vec<f64>> = candidates.map(matched).collect();
    found.sort_by_key(|offsets| std::cmp::Reverse(offsets.len()));
    let best = found.first().filter(|best| best.len() >= STEPS_MIN)?;
    let offset_s = median(best)?;
    let is_other = |offsets: &&Vec<f64>| median(offsets).is_some_and(|at_s| (at_s - offset_s).abs() > SCATTER_S_MAX);
    let runner_up = found.iter().find(is_other).map_or(0, Vec::len);
    (runner_up < best.len()).then_some(offset_s)
}

/// The offset at which most steps agree, where that of the clocks is said to be another: at `said_s` an effect would come before its command, or
/// later than the longest dead time. `None` where the said offset is possible, or no offset is clear.
pub fn other_offset_of_commands(
    steps: &[MotorStep],
    command: &CommandSeries,
    said_s: f64,
    config: &MotorConfig,
) -> Option<f64> {
    let possible_s = said_s - SCATTER_S_MAX..=said_s + config.dead_time_s_max + SCATTER_S_MAX;
    offset_of_commands(steps, command, config).filter(|offset_s| !possible_s.contains(offset_s))
}
