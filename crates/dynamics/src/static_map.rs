//! The static map: the speed that a command leads to.

use crate::config::MotorConfig;
use crate::plateaus::Plateau;
use crate::series::{CommandedSpeed, correlation, std_uncertainty_of_long_mean};
use hovertone_vehicle::{Ending, Estimate};

/// Commands this near, as a share of the largest, are one command: a controller holds none exactly. *Numeric.*
const SAME_SHARE: f64 = 0.005;

/// Where a static map comes from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum MapOrigin {
    /// Commands that were held until the speed had settled.
    Plateaus,
    /// All rows of a log whose command is never held, such as a flight: the motor's lag makes the gain too small.
    Rows,
}

/// A command and its speed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MapPoint {
    /// Command, in the unit of the log.
    pub command: f64,
    /// Settled speed.
    pub speed_rev_s: f64,
    /// Its standard uncertainty.
    pub speed_std_rev_s: f64,
    /// Whether the speed follows no longer: left out of the gain.
    pub is_saturated: bool,
}

/// Speed of each command.
#[derive(Clone, Debug, PartialEq)]
pub struct StaticMap {
    /// Where it comes from.
    pub origin: MapOrigin,
    /// Plateaus in the order of their commands; empty for a map of all rows.
    pub points: Vec<MapPoint>,
    /// Slope of the straight line through the points that are not saturated, in rev/s per unit of the command. Absent for one point.
    pub gain_rev_s: Option<Estimate>,
    /// Speed of that line at command 0.
    pub offset_rev_s: Option<f64>,
}

/// The map of plateaus. A command that was held several times is one point. The highest plateaus are saturated while the gain to the last one
/// is far below the gain before it.
pub(crate) fn map_of_plateaus(plateaus: &[Plateau], config: &MotorConfig) -> Option<StaticMap> {
    let mut sorted = plateaus.to_vec();
    sorted.sort_by(|a, b| a.command.total_cmp(&b.command));
    let same = SAME_SHARE * sorted.iter().map(|plateau| plateau.command.abs()).fold(0.0, f64::max);
    let mut points: Vec<MapPoint> =
        sorted.chunk_by(|a, b| b.command - a.command <= same).filter_map(point_of_plateaus).collect();
    let mut kept = points.len();
    while kept >= 3 && gain(&points[kept - 2..kept]) < config.saturated_gain_share * gain(&points[kept - 3..kept - 1]) {
        kept -= 1;
        points[kept].is_saturated = true;
    }
    let pairs: Vec<CommandedSpeed> = points[..kept]
        .iter()
        .map(|point| CommandedSpeed { command: point.command, speed_rev_s: point.speed_rev_s })
        .collect();
    let own_std = points[..kept].iter().map(|point| point.speed_std_rev_s).fold(0.0, f64::max);
    let line = line_of(&pairs, own_std);
    (!points.is_empty()).then_some(StaticMap {
        origin: MapOrigin::Plateaus,
        points,
        gain_rev_s: line.map(|line| line.gain_rev_s),
        offset_rev_s: line.map(|line| line.offset_rev_s),
    })
}

/// The map of all rows; `None` where commands and speeds have little to do with each other.
pub(crate) fn map_of_rows(pairs: &[CommandedSpeed], config: &MotorConfig) -> Option<StaticMap> {
    correlation(pairs).filter(|correlation| *correlation >= config.correlation_min)?;
    let line = line_of(pairs, 0.0)?;
    Some(StaticMap {
        origin: MapOrigin::Rows,
        points: Vec::new(),
        gain_rev_s: Some(line.gain_rev_s),
        offset_rev_s: Some(line.offset_rev_s),
    })
}

fn point_of_plateaus(plateaus: &[Plateau]) -> Option<MapPoint> {
    let count = plateaus.len() as f64;
    let speed_rev_s = plateaus.iter().map(|plateau| plateau.speed_rev_s).sum::<f64>() / count;
    let squares: f64 = plateaus.iter().map(|plateau| plateau.speed_std_rev_s.powi(2)).sum();
    let scatter: f64 = plateaus.iter().map(|plateau| (plateau.speed_rev_s - speed_rev_s).powi(2)).sum();
    let scatter = if plateaus.len() > 1 { scatter / (count - 1.0) / count } else { 0.0 };
    let speed_std_rev_s = (squares / (count * count)).max(scatter).sqrt();
    Some(MapPoint { command: plateaus.first()?.command, speed_rev_s, speed_std_rev_s, is_saturated: false })
}

/// Gain between the first and the last of some points.
fn gain(points: &[MapPoint]) -> f64 {
    match points {
        [first, .., last] => (last.speed_rev_s - first.speed_rev_s) / (last.command - first.command),
        _ => 0.0,
    }
}

#[derive(Clone, Copy)]
struct MapLine {
    gain_rev_s: Estimate,
    offset_rev_s: f64,
}

/// The straight line by least squares. The uncertainty of the gain is from the scatter about the line, which correlation makes larger, or
/// from the points' own uncertainty if that is larger.
fn line_of(pairs: &[CommandedSpeed], own_std_rev_s: f64) -> Option<MapLine> {
    let count = pairs.len() as f64;
    let command_mean = pairs.iter().map(|pair| pair.command).sum::<f64>() / count;
    let speed_mean = pairs.iter().map(|pair| pair.speed_rev_s).sum::<f64>() / count;
    let squares: f64 = pairs.iter().map(|pair| (pair.command - command_mean).powi(2)).sum();
    let products: f64 = pairs.iter().map(|pair| (pair.command - command_mean) * (pair.speed_rev_s - speed_mean)).sum();
    if pairs.len() < 2 || squares <= 0.0 {
        return None;
    }
    let slope = products / squares;
    let residual = |pair: &CommandedSpeed| pair.speed_rev_s - speed_mean - slope * (pair.command - command_mean);
    let residuals: Vec<f64> = pairs.iter().map(residual).collect();
    // (u √n)² is the variance of a row, times the factor by which correlated rows are worth less
    let scatter = std_uncertainty_of_long_mean(&residuals)?.powi(2) * count * (count - 1.0) / (count - 2.0).max(1.0);
    let variance = scatter.max(own_std_rev_s.powi(2)) / squares;
    let ending = if pairs.len() > 2 { Ending::Solved } else { Ending::SingleObservation };
    let gain_rev_s = Estimate { value: slope, std_uncertainty: Some(variance.sqrt()), ending };
    Some(MapLine { gain_rev_s, offset_rev_s: speed_mean - slope * command_mean })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_plateau_that_does_not_follow_is_left_out_of_the_gain() {
        let plateau = |command: f64, speed_rev_s: f64| Plateau { command, speed_rev_s, speed_std_rev_s: 0.1 };
        let plateaus = [
            plateau(1150.0, 55.0),
            plateau(1290.0, 157.0),
            plateau(1710.0, 349.0),
            plateau(1430.0, 241.0),
            plateau(1570.0, 319.0),
            plateau(1290.0, 159.0),
        ];
        let map = map_of_plateaus(&plateaus, &MotorConfig::default()).unwrap();
        let saturated: Vec<f64> =
            map.points.iter().filter(|point| point.is_saturated).map(|point| point.command).collect();
        assert_eq!(saturated, [1710.0]);
        let gain = map.gain_rev_s.unwrap();
        assert!((gain.value - 0.626).abs() < 0.01 && gain.std_uncertainty.unwrap() < 0.1, "{gain:?}");
    }

    #[test]
    fn rows_without_a_relation_have_no_map() {
        let pair = |at: usize| CommandedSpeed { command: (at % 7) as f64, speed_rev_s: (at % 5) as f64 };
        let pairs: Vec<CommandedSpeed> = (0..350).map(pair).collect();
        assert!(map_of_rows(&pairs, &MotorConfig::default()).is_none());
    }
}
