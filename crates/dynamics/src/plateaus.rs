//! Stretches in which a command is held, and the speeds that they lead to.

use crate::config::MotorConfig;
use crate::series::{CommandSeries, MotorSeries, std_uncertainty_of_long_mean};
use hovertone_signal::statistics::median;
use std::ops::Range;

/// A command changes if it differs by more than this share of its range. *Numeric*: commands are digital.
const CHANGE_SHARE: f64 = 0.005;
/// Share of a held command, at its end, in which the speed has settled. *Decision*: the motor needs ten time constants or less.
const SETTLED_SHARE: f64 = 0.5;

/// A stretch in which the command does not change.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HeldCommand {
    pub(crate) command: f64,
    /// Time of its first row.
    pub(crate) from_s: f64,
    /// Time of the first row with another command, or of the last row of the log.
    pub(crate) to_s: f64,
}

impl HeldCommand {
    pub(crate) fn length_s(&self) -> f64 {
        self.to_s - self.from_s
    }
}

/// Speed to which a held command leads.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Plateau {
    pub(crate) command: f64,
    pub(crate) speed_rev_s: f64,
    pub(crate) speed_std_rev_s: f64,
}

/// All stretches of a command, also short ones.
pub(crate) fn held_commands(series: &CommandSeries) -> Vec<HeldCommand> {
    let finite = || series.command.iter().copied().filter(|command| command.is_finite());
    let (low, high) = (finite().fold(f64::INFINITY, f64::min), finite().fold(f64::NEG_INFINITY, f64::max));
    let mut held: Vec<HeldCommand> = Vec::new();
    for (&time_s, &command) in series.time_s.iter().zip(series.command) {
        match held.last_mut() {
            Some(last) => {
                last.to_s = time_s;
                if (command - last.command).abs() > CHANGE_SHARE * (high - low) {
                    held.push(HeldCommand { command, from_s: time_s, to_s: time_s });
                }
            }
            None => held.push(HeldCommand { command, from_s: time_s, to_s: time_s }),
        }
    }
    held
}

/// The commands that are held long enough for the speed to settle.
pub(crate) fn long_of(held: &[HeldCommand], config: &MotorConfig) -> Vec<HeldCommand> {
    let length_s_min = (config.dead_time_s_max + config.hold_s_min) / (1.0 - SETTLED_SHARE);
    held.iter().filter(|held| held.length_s() >= length_s_min).copied().collect()
}

/// The end of a held command, in which the speed has settled.
pub(crate) fn settled_of(held: &HeldCommand) -> Range<f64> {
    held.to_s - SETTLED_SHARE * held.length_s()..held.to_s
}

/// The speeds of commands that are held long enough, without rotors at rest.
pub(crate) fn plateaus_of(series: &MotorSeries, long: &[HeldCommand]) -> Vec<Plateau> {
    let plateau = |held: &HeldCommand| {
        let settled = settled_of(held);
        let settled = series.between(settled.start, settled.end);
        let speed_rev_s = median(settled.speed_rev_s).filter(|speed_rev_s| *speed_rev_s > 0.0)?;
        let speed_std_rev_s = std_uncertainty_of_long_mean(settled.speed_rev_s)?;
        Some(Plateau { command: held.command, speed_rev_s, speed_std_rev_s })
    };
    long.iter().filter_map(plateau).collect()
}
