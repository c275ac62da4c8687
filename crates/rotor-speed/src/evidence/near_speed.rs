//! The evidence for a rotor near one speed: where the search over all speeds heard none, and in an exam.

use super::excess::{Excess, Looks};
use super::level_model::{LevelModel, OrderLevel};
use super::levels::{NoiseLevel, levels_of_orders, noise_level};
use super::own_lines::OwnPropeller;
use super::second_look::path_near;
use super::votes::{VotePlaces, VoteTable, votes_of_frame};
use hovertone_signal::statistics::{mean, median};

/// Largest distance of the path from the speed, as a logarithm. *Decision.*
const NEAR: f64 = 0.1;

/// Evidence of the levels of all orders for a rotor near a speed, in nats, of both looks together: against levels of nothing, where as many places
/// hold lines as between the orders of this rotor. So lines that the rotor leaves unexplained count against it. `None` without a band.
pub(crate) fn nats_near(looks: &Looks, speed_rev_s: f64, propeller: &OwnPropeller<'_>) -> Option<f64> {
    let table = VoteTable::for_blades(propeller.blades);
    let nats_of = |look| Some(PathNear::of(look, speed_rev_s, propeller, &table)?.levels_nats);
    Some(nats_of(&looks.short)? + nats_of(&looks.long)?)
}

/// What frames of one length show of a rotor near a speed.
#[derive(Clone, Debug)]
pub struct LinesNear {
    /// Mean speed along the best path.
    pub speed_rev_s: f64,
    /// Median over the frames of the votes for the path.
    pub votes_nats: f64,
    /// Levels of all orders that are compared.
    pub levels: Vec<OrderLevel>,
    /// Levels between the orders.
    pub noise: NoiseLevel,
    /// Evidence of the levels for the rotor.
    pub levels_nats: f64,
}

/// The lines along the best path near a speed. `None` without a band.
pub(crate) fn lines_near(look: &Excess, speed_rev_s: f64, propeller: &OwnPropeller<'_>) -> Option<LinesNear> {
    let table = VoteTable::for_blades(propeller.blades);
    let PathNear { speeds_rev_s, levels, noise, levels_nats } = PathNear::of(look, speed_rev_s, propeller, &table)?;
    let votes: Vec<f64> = look
        .frames
        .iter()
        .zip(&speeds_rev_s)
        .flat_map(|(frame, &speed)| {
            votes_of_frame(frame, &table, &VotePlaces::new(&[speed], &table, look.bin_hz, frame.levels.len()))
        })
        .map(f64::from)
        .collect();
    Some(LinesNear { speed_rev_s: mean(&speeds_rev_s)?, votes_nats: median(&votes)?, levels, noise, levels_nats })
}

/// The best path near a speed, with the evidence along it.
struct PathNear {
    /// Speed in each frame.
    speeds_rev_s: Vec<f64>,
    levels: Vec<OrderLevel>,
    noise: NoiseLevel,
    levels_nats: f64,
}

impl PathNear {
    /// `None` without a band.
    fn of(look: &Excess, speed_rev_s: f64, propeller: &OwnPropeller<'_>, table: &VoteTable) -> Option<Self> {
        let speeds_rev_s = path_near(look, &vec![speed_rev_s; look.frames.len()], NEAR, table)?;
        let noise = noise_level(look, &speeds_rev_s)?;
        let levels = levels_of_orders(look, &speeds_rev_s, propeller.blades);
        let levels_nats = LevelModel::of_speeds(noise, propeller.prior).flat_nats(&levels, propeller.blades);
        Some(Self { speeds_rev_s, levels, noise, levels_nats })
    }
}
