//! C_τ on a bench: the torque of the load at settled speeds.
//!
//! τ = τ₀ + C_τ ω², with τ₀ of a scale that was not set to zero. Where a speed is settled, the rotor's inertia takes no torque.

use crate::plateaus::{HeldCommand, settled_of};
use crate::series::{MotorSeries, rows_between, std_uncertainty_of_long_mean};
use crate::weighted_line::{WeightedLine, WeightedPoint};
use hovertone_signal::statistics::mean;
use hovertone_vehicle::{Ending, Estimate};
use std::f64::consts::TAU;

/// Fewest speeds: a straight line through two points has no scatter. *Numeric.*
const LEVELS_MIN: usize = 3;
/// Smallest ratio of the largest to the smallest ω²: the line from ω² to the torque has no slope where all speeds are one. *Numeric.*
const SQUARE_RATIO_MIN: f64 = 1.01;
/// A scatter below this share of the torque is that of rounding in sums. *Numeric.*
const EQUAL_SHARE: f64 = 1e-12;

/// Torque on one rotor over time, on the clock of its speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TorqueSeries<'a> {
    /// Times of the rows, increasing.
    pub time_s: &'a [f64],
    /// Torque; its sign is the direction of the rotor. As many values as times.
    pub torque_n_m: &'a [f64],
}

/// C_τ of one rotor, or why it is not told.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum BenchTorque {
    /// Told by the torques at several speeds.
    Told {
        /// C_τ, N m s², without sign; its uncertainty is that of the fit alone.
        constant_n_m_s2: Estimate,
        /// τ₀, the torque at rest.
        offset_n_m: f64,
        /// Number of speeds.
        level_count: usize,
    },
    /// The log has no torque.
    NoTorque,
    /// Several motors turn, and the torque is of all together.
    SeveralMotors,
    /// Too few speeds are held by a command.
    FewLevels {
        /// How many.
        level_count: usize,
    },
    /// All commands hold the same speed.
    OneSpeed,
    /// The torque never changes while a speed is held, so nothing shows its uncertainty.
    SteadyTorque,
}

impl BenchTorque {
    /// Why it is not told, with what would tell it.
    pub fn reason(&self) -> Option<String> {
        match self {
            Self::Told { .. } => None,
            Self::NoTorque => Some(
                "no column of this log has a torque; log the torque of one motor on a test stand, or fly yaw manoeuvres and use \
                `hovertone greybox`"
                    .to_owned(),
            ),
            Self::SeveralMotors => {
                Some("several motors turn, and the torque is of all together; let one motor turn alone".to_owned())
            }
            Self::FewLevels { level_count } => Some(format!(
                "the commands of this log hold {level_count} speed{} for a second or longer, and {LEVELS_MIN} or more are needed; hold more speeds",
                if *level_count == 1 { "" } else { "s" }
            )),
            Self::OneSpeed => {
                Some("all commands of this log hold the same speed; hold different speeds for a second each".to_owned())
            }
            Self::SteadyTorque => Some(
                "the torque does not change at all while a speed is held, so its uncertainty is not known; log each \
                measured value of the torque, not a mean"
                    .to_owned(),
            ),
        }
    }
}

/// A settled speed and its torque.
struct Level {
    speed_square_rad2_s2: f64,
    torque_n_m: f64,
    torque_std_n_m: f64,
}

/// C_τ from the levels of the held commands: least squares of the torque over ω², weighted by the uncertainty of each level, which a larger scatter
/// about the line increases.
pub(crate) fn torque_of_levels(series: &MotorSeries, torque: &TorqueSeries, held: &[HeldCommand]) -> BenchTorque {
    let levels: Vec<Level> = held.iter().filter_map(|held| level_of(series, torque, held)).collect();
    let level_count = levels.len();
    if level_count < LEVELS_MIN {
        return BenchTorque::FewLevels { level_count };
    }
    // a level whose rows are all equal is not exact
    let std_min = levels.iter().map(|level| level.torque_std_n_m).sum::<f64>() / (10.0 * level_count as f64);
    let largest_n_m = levels.iter().map(|level| level.torque_n_m.abs()).fold(0.0, f64::max);
    if std_min <= EQUAL_SHARE * largest_n_m {
        return BenchTorque::SteadyTorque;
    }
    let squares = || levels.iter().map(|level| level.speed_square_rad2_s2);
    let (least, most) = (squares().fold(f64::INFINITY, f64::min), squares().fold(0.0, f64::max));
    if most < SQUARE_RATIO_MIN * least {
        return BenchTorque::OneSpeed;
    }
    let point = |level: &Level| WeightedPoint {
        x: level.speed_square_rad2_s2,
        y: level.torque_n_m,
        weight: level.torque_std_n_m.max(std_min).powi(-2),
    };
    let line = WeightedLine::through(&levels.iter().map(point).collect::<Vec<WeightedPoint>>());
    BenchTorque::Told {
        constant_n_m_s2: Estimate {
            value: line.slope.abs(),
            std_uncertainty: Some(line.slope_variance.sqrt()),
            ending: Ending::Solved,
        },
        offset_n_m: line.at_zero() * line.slope.signum(),
        level_count,
    }
}

/// The end of a held command, where the speed has settled. `None` where the rotor does not turn, or the log has no torque then.
fn level_of(series: &MotorSeries, torque: &TorqueSeries, held: &HeldCommand) -> Option<Level> {
    let settled = settled_of(held);
    let speeds = series.between(settled.start, settled.end).speed_rev_s;
    let squares: Vec<f64> = speeds.iter().map(|speed_rev_s| (TAU * speed_rev_s).powi(2)).collect();
    let torques = torque.torque_n_m.get(rows_between(torque.time_s, settled.start, settled.end))?;
    Some(Level {
        speed_square_rad2_s2: mean(&squares).filter(|square| *square > 0.0)?,
        torque_n_m: mean(torques)?,
        torque_std_n_m: std_uncertainty_of_long_mean(torques)?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::config::MotorConfig;
    use crate::plateaus::{held_commands, long_of};
    use crate::series::CommandSeries;

    /// Speeds that follow steps of the command in 40 ms, and torques with noise.
    fn told(levels: usize, constant: f64, offset_n_m: f64) -> BenchTorque {
        let time_s: Vec<f64> = (0..600).map(|row| 0.02 * f64::from(row)).collect();
        let command: Vec<f64> = (0..600usize).map(|row| (1000 + 100 * (row * levels / 600)) as f64).collect();
        let mut speed_rev_s = vec![100.0];
        for command in &command[1..] {
            let before = speed_rev_s[speed_rev_s.len() - 1];
            speed_rev_s.push(before + 0.4 * (100.0 + 0.5 * (command - 1000.0) - before));
        }
        let noise = |row: usize| 1e-4 * ((row * 7919 % 1000) as f64 / 500.0 - 1.0);
        let torque = |(row, speed): (usize, &f64)| -offset_n_m - constant * (TAU * speed).powi(2) + noise(row);
        let torque_n_m: Vec<f64> = speed_rev_s.iter().enumerate().map(torque).collect();
        let held = held_commands(&CommandSeries { time_s: &time_s, command: &command });
        let series = MotorSeries { time_s: &time_s, speed_rev_s: &speed_rev_s };
        let held = long_of(&held, &MotorConfig::default());
        torque_of_levels(&series, &TorqueSeries { time_s: &time_s, torque_n_m: &torque_n_m }, &held)
    }

    #[test]
    fn the_constant_is_found_beside_an_offset_of_the_scale_and_in_either_direction() {
        let BenchTorque::Told { constant_n_m_s2, offset_n_m, level_count } = told(5, 7.7e-9, 0.004) else { panic!() };
        let std = constant_n_m_s2.std_uncertainty.unwrap();
        assert_eq!(level_count, 5);
        assert!((constant_n_m_s2.value - 7.7e-9).abs() < 3.0 * std && std < 0.01 * 7.7e-9, "{constant_n_m_s2:?}");
        assert!((offset_n_m - 0.004).abs() < 1e-4, "{offset_n_m}");
    }

    #[test]
    fn two_speeds_tell_no_scatter() {
        assert_eq!(told(2, 7.7e-9, 0.0), BenchTorque::FewLevels { level_count: 2 });
    }

    #[test]
    fn one_speed_and_a_torque_without_noise_tell_no_constant() {
        let time_s: Vec<f64> = (0..300).map(|row| 0.02 * f64::from(row)).collect();
        let held: Vec<HeldCommand> =
            [0.0, 2.0, 4.0].map(|from_s| HeldCommand { command: 1000.0 + from_s, from_s, to_s: from_s + 2.0 }).into();
        let told = |speed_rev_s: &[f64], torque_n_m: &[f64]| {
            let series = MotorSeries { time_s: &time_s, speed_rev_s };
            torque_of_levels(&series, &TorqueSeries { time_s: &time_s, torque_n_m }, &held)
        };
        let noisy: Vec<f64> = (0..300).map(|row| 0.01 + 1e-4 * f64::from(row * 7919 % 100)).collect();
        let steps: Vec<f64> = (0..300).map(|row| 100.0 + 20.0 * f64::from(row / 100)).collect();
        assert_eq!(told(&[100.0; 300], &noisy), BenchTorque::OneSpeed);
        assert_eq!(told(&steps, &[0.01; 300]), BenchTorque::SteadyTorque);
        assert!(matches!(told(&steps, &noisy), BenchTorque::Told { .. }));
        for untold in [BenchTorque::OneSpeed, BenchTorque::SteadyTorque] {
            assert!(untold.reason().is_some_and(|reason| !reason.contains('0')), "{untold:?}");
        }
    }
}
