//! The evidence for a rotor near one speed, where the search over all speeds heard none.

use super::excess::{Excess, Looks};
use super::level_model::LevelModel;
use super::levels::{levels_of_orders, noise_level};
use super::own_lines::OwnPropeller;
use super::second_look::path_near;
use super::votes::VoteTable;

/// Largest distance of the path from the speed, as a logarithm. *Decision.*
const NEAR: f64 = 0.1;

/// Evidence of the levels of all orders for a rotor near a speed, in nats, of both looks together: against levels of nothing, where as many places
/// hold lines as between the orders of this rotor. So lines that the rotor leaves unexplained count against it. `None` without a band.
pub(crate) fn nats_near(looks: &Looks, speed_rev_s: f64, propeller: &OwnPropeller<'_>) -> Option<f64> {
    Some(nats_of(&looks.short, speed_rev_s, propeller)? + nats_of(&looks.long, speed_rev_s, propeller)?)
}

fn nats_of(look: &Excess, speed_rev_s: f64, propeller: &OwnPropeller<'_>) -> Option<f64> {
    let middles_rev_s = vec![speed_rev_s; look.frames.len()];
    let speeds_rev_s = path_near(look, &middles_rev_s, NEAR, &VoteTable::for_blades(propeller.blades))?;
    let noise = noise_level(look, &speeds_rev_s)?;
    let levels = levels_of_orders(look, &speeds_rev_s, propeller.blades);
    Some(LevelModel::new(noise, propeller.blades, propeller.prior).evidence_nats(&levels))
}
