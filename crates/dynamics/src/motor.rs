//! The whole chain for one motor, and the constants of several.

use crate::bench_torque::{BenchTorque, TorqueSeries, torque_of_levels};
use crate::combined::{CombinedEstimate, combined};
use crate::config::MotorConfig;
use crate::load::{LoadTerm, load_term_of};
use crate::plateaus::{HeldCommand, Plateau, held_commands, long_of, plateaus_of};
use crate::search::Interval;
use crate::series::{CommandSeries, MotorSeries, pairs_of};
use crate::static_map::{StaticMap, map_of_plateaus, map_of_rows};
use crate::step::{MotorStep, StepContext, StepVerdict, step_of_transition};
use crate::transitions::{Transition, scatter_rev_s, transitions_of_commands, transitions_of_speeds};

/// What a log tells about a motor.
#[derive(Clone, Debug, PartialEq)]
pub struct MotorModel {
    /// Median time between rows of the speed.
    pub interval_s: f64,
    /// Whether the rows are too slow for any time constant: only the static map is given.
    pub is_too_slow: bool,
    /// Steps of the speed, in the sequence of time.
    pub steps: Vec<MotorStep>,
    /// Speed of each command; absent without commands, or where they have little to do with the speed.
    pub static_map: Option<StaticMap>,
    /// Largest speed that some rows one after another reach.
    pub speed_rev_s_max: f64,
}

/// Constants of one motor, or of several that are alike.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotorConstants {
    /// τ of rising speeds.
    pub time_constant_up_s: Option<CombinedEstimate>,
    /// τ of falling speeds.
    pub time_constant_down_s: Option<CombinedEstimate>,
    /// Time from the command to the change of the speed.
    pub dead_time_s: Option<CombinedEstimate>,
    /// The square term of the load; absent where the range of speeds is too small to tell it.
    pub load_term: Option<LoadTerm>,
    /// Largest speed.
    pub speed_rev_s_max: f64,
}

/// The constants from the steps of all these motors that can tell them.
pub fn constants_of(models: &[MotorModel]) -> MotorConstants {
    let used = || models.iter().flat_map(|model| &model.steps).filter(|step| step.verdict == StepVerdict::Used);
    let time_constant_s =
        |is_up: bool| combined(used().filter(|step| step.is_up() == is_up).filter_map(|step| step.time_constant_s));
    MotorConstants {
        time_constant_up_s: time_constant_s(true),
        time_constant_down_s: time_constant_s(false),
        dead_time_s: combined(used().filter_map(|step| step.dead_time_s)),
        load_term: load_term_of(models.iter().flat_map(|model| &model.steps)),
        speed_rev_s_max: models.iter().map(|model| model.speed_rev_s_max).fold(0.0, f64::max),
    }
}

/// The steps and the static map of a motor, from its speed and from its command where the log has it. Steps are those of the command, if it is
/// held before and behind any; else they are found in the speed. `None` for fewer than two rows, or a motor that never turns.
pub fn motor_from_series(
    series: MotorSeries,
    command: Option<CommandSeries>,
    config: &MotorConfig,
) -> Option<MotorModel> {
    let interval_s = series.interval_s().filter(|interval_s| *interval_s > 0.0)?;
    let speed_rev_s_max = series.speed_rev_s_max();
    if speed_rev_s_max <= 0.0 {
        return None;
    }
    let held = command.as_ref().map_or_else(Vec::new, held_commands);
    let plateaus = plateaus_of(&series, &long_of(&held, config));
    let of_plateaus = map_of_plateaus(&plateaus, config).filter(|map| map.gain_rev_s.is_some());
    let static_map = of_plateaus.or_else(|| map_of_rows(&pairs_of(&series, command.as_ref()?), config));
    let is_too_slow = interval_s > config.interval_s_max;
    let transitions = if is_too_slow { Vec::new() } else { transitions_of(&series, &held, interval_s, config) };
    let saturated = saturated_plateaus(&plateaus, static_map.as_ref());
    let context = StepContext {
        series,
        interval_s,
        command_interval_s: command.map_or(0.0, |command| command.interval_s()),
        scatter_rev_s: scatter_rev_s(&series),
        saturated: &saturated,
        config,
    };
    let steps: Vec<MotorStep> =
        transitions.iter().filter_map(|transition| step_of_transition(&context, transition)).collect();
    let speed_rev_s_max = series.reached_rev_s_max().unwrap_or(speed_rev_s_max);
    Some(MotorModel { interval_s, is_too_slow, static_map, speed_rev_s_max, steps })
}

/// C_τ of a motor from the torque of a bench, at the speeds to which held commands lead.
pub fn torque_of_motor(
    series: &MotorSeries,
    command: Option<&CommandSeries>,
    torque: &TorqueSeries,
    config: &MotorConfig,
) -> BenchTorque {
    let held = command.map_or_else(Vec::new, held_commands);
    torque_of_levels(series, torque, &long_of(&held, config))
}

fn transitions_of(
    series: &MotorSeries,
    held: &[HeldCommand],
    interval_s: f64,
    config: &MotorConfig,
) -> Vec<Transition> {
    let of_commands = transitions_of_commands(held, interval_s, config);
    let all = if of_commands.is_empty() { transitions_of_speeds(series, interval_s, config) } else { of_commands };
    // nobody saw the curve where the rows have a gap
    let is_seen = |transition: &Transition| {
        let Interval { low, high } = transition.start_s;
        series.between(low, high).longest_interval_s() <= config.interval_s_max.max(3.0 * interval_s)
    };
    all.into_iter().filter(is_seen).collect()
}

fn saturated_plateaus(plateaus: &[Plateau], map: Option<&StaticMap>) -> Vec<Plateau> {
    let points = map.map_or(&[][..], |map| &map.points);
    let is_saturated =
        |plateau: &&Plateau| points.iter().any(|point| point.is_saturated && point.command == plateau.command);
    plateaus.iter().filter(is_saturated).copied().collect()
}
