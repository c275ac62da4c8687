//! Rotors that something known leaves out, though their lines are far more probable: with other blades, or at another speed.

use super::excess::{Excess, Looks};
use super::hypotheses::{Hypothesis, RESOLVED_REV_S, WantedPropeller, WantedRotor};
use super::level_model::LevelModel;
use super::levels::levels_of_lines;
use super::prior::{nats_of_vehicle, odds_nats};
use super::rotor_lines::RotorLines;
use super::second_look::path_in_long_frames;
use super::settings::EvidenceConfig;
use super::votes::VoteTable;
use hovertone_analysis::OtherRotor;
use hovertone_vehicle::KnownRotor;

/// The lines of a rotor are about those of another, whose blade pass is at the ratio of two numbers up to this: where speeds are left out, the path
/// may be at any lines. *Decision.*
const RATIO_PARTS: u32 = 5;

/// The path of a rotor in frames of one length.
struct PathInLook<'a, 'b> {
    look: &'a Excess,
    speeds_rev_s: Vec<f64>,
    model: &'a mut LevelModel<'b>,
}

impl PathInLook<'_, '_> {
    /// The evidence of the lines at a multiple of the path.
    fn nats(&mut self, lines: &RotorLines, ratio: f64) -> f64 {
        let speeds_rev_s: Vec<f64> = self.speeds_rev_s.iter().map(|speed_rev_s| ratio * speed_rev_s).collect();
        self.model.evidence_nats(&levels_of_lines(self.look, &speeds_rev_s, lines), lines)
    }
}

/// The rotor with the most probable lines among those that are wanted where nothing is known, at a simple ratio of the path of the most probable
/// hypothesis. `None` where that one is as probable, at odds below `belief_min`, and where a gear mesh is followed. The short look alone refutes what
/// is less probable there, because each comparison costs a third of a millisecond.
///
/// - `models`: those of the short and of the long look.
///
/// Measured (`docs/decisions/0019-one-evidence.md`): none in 106 real and 96 semi-real cases with the right blades, and none in 24 simulated rotors
/// with 4 blades that are alike; with 3 or 4 blades in place of 2, one in most benches. Flights seldom show the lines of the shaft, which tell the
/// blades.
pub(super) fn better_elsewhere(
    first: &Hypothesis,
    looks: &Looks,
    wanted: &WantedRotor,
    models: [&mut LevelModel<'_>; 2],
    config: &EvidenceConfig,
) -> Option<OtherRotor> {
    let own_blades = first.lines.blades.filter(|_| first.lines.mesh_order.is_none())?;
    let any = &wanted.where_unknown;
    let searched_rev_s = &wanted.propellers.first()?.speeds_rev_s;
    // how common a number of blades is tells nothing about one that was counted
    let prior_nats = |speed_rev_s: f64| nats_of_vehicle(speed_rev_s, &KnownRotor::default(), config);
    let own_prior_nats = prior_nats(first.hover_rev_s);

    // facts about the vehicle may have outweighed the lines
    let KnownRotor { diameter_m, mass_kg, shaft_speed, .. } = wanted.known;
    let has_prior = diameter_m.zip(mass_kg).is_some() || shaft_speed.is_some();
    let [short, long] = models;
    let mut short = PathInLook { look: &looks.short, speeds_rev_s: first.speeds_rev_s.clone(), model: short };
    let own_nats = short.nats(&first.lines, 1.0);
    let mut better: Vec<(f64, &WantedPropeller, f64)> = Vec::new();
    for propeller in any {
        let Some(blades) = propeller.lines.blades else { continue };
        let is_compared =
            |speed_rev_s: f64| !has_prior && blades == own_blades && searched_rev_s.contains(&speed_rev_s);
        for (over, under) in (1..=RATIO_PARTS).flat_map(|over| (1..=RATIO_PARTS).map(move |under| (over, under))) {
            let ratio = f64::from(over * own_blades) / f64::from(under * blades);
            let speed_rev_s = ratio * first.hover_rev_s;
            let is_possible = propeller.speeds_rev_s.contains(&speed_rev_s) && speed_rev_s >= RESOLVED_REV_S;
            if is_possible && !is_compared(speed_rev_s) && (over == 1 || over != under) {
                let more_nats = short.nats(&propeller.lines, ratio) - own_nats;
                if more_nats + prior_nats(speed_rev_s) > own_prior_nats {
                    better.push((more_nats, propeller, ratio));
                }
            }
        }
    }
    if better.is_empty() {
        return None;
    }

    let speeds_rev_s = path_in_long_frames(looks, &first.speeds_rev_s, &VoteTable::of(&first.lines))?;
    let mut long = PathInLook { look: &looks.long, speeds_rev_s, model: long };
    let own_nats = long.nats(&first.lines, 1.0);
    // the mean of the looks, as of all hypotheses, with how common such a speed is
    let odds = better.into_iter().filter_map(|(short_nats, propeller, ratio)| {
        let speed_rev_s = ratio * first.hover_rev_s;
        let levels_nats = 0.5 * (short_nats + long.nats(&propeller.lines, ratio) - own_nats);
        let nats = levels_nats + prior_nats(speed_rev_s) - own_prior_nats;
        Some((nats, levels_nats, OtherRotor { blades: propeller.lines.blades?, speed_rev_s }))
    });
    let far_better = odds.filter(|(nats, ..)| *nats >= odds_nats(config.belief_min));
    // of several, one with the blades that are known: the speed alone is wrong then; else the one that the other facts make most probable
    let rank = |levels_nats: f64, other: &OtherRotor| {
        (other.blades == own_blades, levels_nats + nats_of_vehicle(other.speed_rev_s, &wanted.known, config))
    };
    far_better
        .map(|(_, levels_nats, other)| (rank(levels_nats, &other), other))
        .max_by(|((own, a), _), ((other_own, b), _)| own.cmp(other_own).then(a.total_cmp(b)))
        .map(|(_, other)| other)
}
