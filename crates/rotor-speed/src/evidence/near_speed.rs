//! The evidence for a rotor near one speed, where the search over all speeds heard none.

use super::excess::{Excess, Looks};
use super::level_model::LevelModel;
use super::levels::{levels_of_orders, noise_level};
use super::own_lines::OwnPropeller;
use super::path::best_path;
use super::votes::{VotePlaces, VoteTable, votes_of_frame};

/// Largest distance of the path from the speed, as a logarithm. *Decision.*
const NEAR: f64 = 0.1;
/// Step of the logarithm of the speed. *Numeric.*
const STEP: f64 = 1e-3;

/// Evidence of the levels of all orders for a rotor near a speed, in nats, of both looks together: against levels of nothing, where as many places
/// hold lines as between the orders of this rotor. So lines that the rotor leaves unexplained count against it. `None` without a band.
pub(crate) fn nats_near(looks: &Looks, speed_rev_s: f64, propeller: &OwnPropeller<'_>) -> Option<f64> {
    Some(nats_of(&looks.short, speed_rev_s, propeller)? + nats_of(&looks.long, speed_rev_s, propeller)?)
}

fn nats_of(look: &Excess, speed_rev_s: f64, propeller: &OwnPropeller<'_>) -> Option<f64> {
    let bins = look.frames.first()?.levels.len();
    let steps = (NEAR / STEP) as i32;
    let speeds_rev_s: Vec<f64> = (-steps..=steps).map(|step| speed_rev_s * (STEP * f64::from(step)).exp()).collect();
    let table = VoteTable::for_blades(propeller.blades);
    let places = VotePlaces::new(&speeds_rev_s, &table, look.bin_hz, bins);
    let votes: Vec<Vec<f32>> = look.frames.iter().map(|frame| votes_of_frame(frame, &table, &places)).collect();
    let path = best_path(&votes, 0..speeds_rev_s.len(), &look.hops(), STEP);
    let speeds_rev_s: Vec<f64> = path.into_iter().map(|point| speeds_rev_s[point]).collect();
    let noise = noise_level(look, &speeds_rev_s)?;
    let levels = levels_of_orders(look, &speeds_rev_s, propeller.blades);
    Some(LevelModel::new(noise, propeller.blades, propeller.prior).evidence_nats(&levels))
}
