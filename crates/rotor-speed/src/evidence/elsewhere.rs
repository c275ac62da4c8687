//! Rotors that something known leaves out, though their lines are far more probable: with other blades, or at another speed.

use super::excess::Looks;
use super::hypotheses::{Beliefs, RESOLVED_REV_S, WantedPropeller, WantedRotor, nats_of_vehicle, odds_nats};
use super::level_model::LevelModel;
use super::levels::levels_of_lines;
use super::second_look::path_in_long_frames;
use super::settings::EvidenceConfig;
use super::votes::VoteTable;
use hovertone_analysis::OtherRotor;

/// Blade passes over that of the path that was found: the lines of a rotor are about those of another at such a ratio. *Decision.*
const RATIOS: [(u32, u32); 19] = [
    (1, 1),
    (2, 1),
    (3, 1),
    (4, 1),
    (5, 1),
    (1, 2),
    (3, 2),
    (5, 2),
    (1, 3),
    (2, 3),
    (4, 3),
    (5, 3),
    (1, 4),
    (3, 4),
    (5, 4),
    (1, 5),
    (2, 5),
    (3, 5),
    (4, 5),
];

impl Beliefs {
    /// The rotor with the most probable lines among `any` that are possible, at a simple ratio of the path that was found. `None` where the first
    /// hypothesis is as probable, at odds below `belief_min`; and where a gear mesh is followed or the rotor is faint.
    ///
    /// Measured on 36 real recordings of single rotors and flights, and on 96 semi-real ones: none where the blades are right. With 3 or 4 blades in
    /// place of 2, one in 25 of 30 cases of benches, and in 7 of 34 of flights: the lines of the shaft tell the blades, and flights seldom show them.
    pub(crate) fn better_elsewhere(
        &self,
        looks: &Looks,
        any: &WantedRotor,
        config: &EvidenceConfig,
    ) -> Option<OtherRotor> {
        let first = self.hypotheses.first().filter(|first| first.lines.mesh_order.is_none() && !self.is_faint)?;
        let own_blades = first.lines.blades?;
        let long_rev_s = path_in_long_frames(looks, &first.speeds_rev_s, &VoteTable::of(&first.lines))?;
        let mut of_looks =
            [(&looks.short, &first.speeds_rev_s, self.noise), (&looks.long, &long_rev_s, self.long_noise?)]
                .map(|(look, speeds_rev_s, noise)| (look, speeds_rev_s, LevelModel::of_speeds(noise, &config.levels)));
        // the mean of the looks, as of all hypotheses, with how common such a rotor is
        let mut nats_of = |propeller: &WantedPropeller, speed_rev_s: f64| {
            let ratio = speed_rev_s / first.hover_rev_s;
            let levels_nats = of_looks.each_mut().map(|(look, speeds_rev_s, model)| {
                let speeds_rev_s: Vec<f64> = speeds_rev_s.iter().map(|speed_rev_s| ratio * speed_rev_s).collect();
                model.evidence_nats(&levels_of_lines(look, &speeds_rev_s, &propeller.lines), &propeller.lines)
            });
            0.5 * levels_nats.into_iter().sum::<f64>()
                + propeller.share.ln()
                + nats_of_vehicle(speed_rev_s, &any.known, config)
        };
        let own = any.propellers.iter().find(|propeller| propeller.lines == first.lines)?;
        let own_nats = nats_of(own, first.hover_rev_s);
        let mut best: Option<(f64, OtherRotor)> = None;
        for propeller in &any.propellers {
            let Some(blades) = propeller.lines.blades else { continue };
            for (over, under) in RATIOS {
                let ratio = f64::from(over * own_blades) / f64::from(under * blades);
                let speed_rev_s = ratio * first.hover_rev_s;
                let is_possible = propeller.speeds_rev_s.contains(&speed_rev_s) && speed_rev_s >= RESOLVED_REV_S;
                if is_possible {
                    let nats = nats_of(propeller, speed_rev_s);
                    if best.is_none_or(|(most, _)| nats > most) {
                        best = Some((nats, OtherRotor { blades, speed_rev_s }));
                    }
                }
            }
        }
        best.filter(|(nats, _)| nats - own_nats >= odds_nats(config.belief_min)).map(|(_, other)| other)
    }
}
