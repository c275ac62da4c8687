//! Rotors that something known leaves out, though their lines are far more probable: with other blades, or at another speed.

use super::excess::Looks;
use super::hypotheses::{Beliefs, RESOLVED_REV_S, nats_of_vehicle};
use super::level_model::LevelModel;
use super::levels::levels_of_lines;
use super::rotor_lines::RotorLines;
use super::search::FACTORS;
use super::second_look::path_in_long_frames;
use super::settings::EvidenceConfig;
use super::votes::VoteTable;
use hovertone_vehicle::KnownRotor;
use std::ops::RangeInclusive;

/// Propellers as they are where nothing is known of them.
#[derive(Clone, Debug)]
pub(crate) struct AnyPropeller {
    /// Numbers of blades, and how common each is.
    pub(crate) blade_shares: Vec<(u32, f64)>,
    /// Slowest and fastest shaft.
    pub(crate) speeds_rev_s: RangeInclusive<f64>,
}

/// A rotor that what is known leaves out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct OtherRotor {
    pub(crate) blades: u32,
    pub(crate) speed_rev_s: f64,
}

impl Beliefs {
    /// The rotor with the most probable lines at a simple ratio of the path that was found, where nothing is known but the lines. `None` where it is
    /// the first hypothesis, at odds below `belief_min`, and where a gear mesh is followed.
    ///
    /// Measured on real recordings of 36 runs and flights: none where the blades are right; with 3 blades in place of 2 one on all 16 benches that
    /// are answered, and in 4 of 14 flights, as the lines of the shaft are seldom heard there.
    pub(crate) fn better_elsewhere(
        &self,
        looks: &Looks,
        any: &AnyPropeller,
        config: &EvidenceConfig,
    ) -> Option<OtherRotor> {
        let first = self.hypotheses.first().filter(|first| first.lines.mesh_order.is_none() && !self.is_faint)?;
        let own_blades = first.lines.blades?;
        let long_rev_s = path_in_long_frames(looks, &first.speeds_rev_s, &VoteTable::of(&first.lines))?;
        let mut of_looks =
            [(&looks.short, &first.speeds_rev_s, self.noise), (&looks.long, &long_rev_s, self.long_noise?)]
                .map(|(look, speeds_rev_s, noise)| (look, speeds_rev_s, LevelModel::of_speeds(noise, &config.levels)));
        let share_of =
            |blades: u32| any.blade_shares.iter().find(|(of, _)| *of == blades).map_or(1.0, |(_, share)| *share);
        // the mean of the looks, as of all hypotheses, with how common such a rotor is
        let mut nats_of = |rotor: &OtherRotor| {
            let (lines, ratio) = (RotorLines::of_blades(rotor.blades), rotor.speed_rev_s / first.hover_rev_s);
            let levels_nats = of_looks.each_mut().map(|(look, speeds_rev_s, model)| {
                let speeds_rev_s: Vec<f64> = speeds_rev_s.iter().map(|speed_rev_s| ratio * speed_rev_s).collect();
                model.evidence_nats(&levels_of_lines(look, &speeds_rev_s, &lines), &lines)
            });
            let prior_nats =
                share_of(rotor.blades).ln() + nats_of_vehicle(rotor.speed_rev_s, &KnownRotor::default(), config);
            levels_nats.into_iter().sum::<f64>() / f64::from(levels_nats.len() as u32) + prior_nats
        };
        let own_nats = nats_of(&OtherRotor { blades: own_blades, speed_rev_s: first.hover_rev_s });
        let others = any.blade_shares.iter().flat_map(|&(blades, _)| {
            let blade_pass_hz = f64::from(own_blades) * first.hover_rev_s;
            FACTORS.map(|factor| OtherRotor { blades, speed_rev_s: factor * blade_pass_hz / f64::from(blades) })
        });
        let is_possible =
            |other: &OtherRotor| any.speeds_rev_s.contains(&other.speed_rev_s) && other.speed_rev_s >= RESOLVED_REV_S;
        let best =
            others.filter(is_possible).map(|other| (nats_of(&other), other)).max_by(|(a, _), (b, _)| a.total_cmp(b));
        let odds_nats_min = (config.belief_min / (1.0 - config.belief_min)).ln();
        best.filter(|(nats, _)| nats - own_nats >= odds_nats_min).map(|(_, other)| other)
    }
}
