//! The evidence for a rotor near one speed, for an exam.

use super::excess::Excess;
use super::level_model::{LevelModel, OrderLevel};
use super::levels::{NoiseLevel, levels_of_lines, noise_level};
use super::rotor_lines::RotorLines;
use super::second_look::path_near;
use super::votes::{VotePlaces, VoteTable, votes_of_frame};
use crate::thresholds::SAME_SPEED_SHARE;
use hovertone_signal::statistics::{mean, median};
use hovertone_vehicle::LineLevels;

/// Largest distance of the path from the speed, as a logarithm.
const NEAR: f64 = SAME_SPEED_SHARE;

/// What frames of one length show of a rotor near a speed.
#[derive(Clone, Debug)]
pub struct LinesNear {
    /// Mean speed along the best path.
    pub speed_rev_s: f64,
    /// Median over the frames of the votes for the path.
    pub votes_nats: f64,
    /// Levels of all orders of the shaft that are compared.
    pub levels: Vec<OrderLevel>,
    /// Levels between the orders.
    pub noise: NoiseLevel,
    /// Evidence of the levels for the rotor.
    pub levels_nats: f64,
}

/// The lines along the best path near a speed. `None` without a band.
pub(crate) fn lines_near(look: &Excess, speed_rev_s: f64, lines: &RotorLines, prior: &LineLevels) -> Option<LinesNear> {
    let table = VoteTable::of(lines);
    let speeds_rev_s = path_near(look, &vec![speed_rev_s; look.frames.len()], NEAR, &table)?;
    let noise = noise_level(look, &speeds_rev_s)?;
    let levels = levels_of_lines(look, &speeds_rev_s, lines);
    let levels_nats = LevelModel::of_speeds(noise, prior).flat_nats(&levels, lines);
    let votes: Vec<f64> = look
        .frames
        .iter()
        .zip(&speeds_rev_s)
        .flat_map(|(frame, &speed)| {
            votes_of_frame(frame, &table, &VotePlaces::new(&[speed], &table, look.bin_hz, frame.levels.len()))
        })
        .map(f64::from)
        .collect();
    let (speed_rev_s, votes_nats) = (mean(&speeds_rev_s)?, median(&votes)?);
    Some(LinesNear { speed_rev_s, votes_nats, levels: levels.shaft, noise, levels_nats })
}
