//! Whether a rotor sounds at all.

use super::hypotheses::Hypothesis;
use super::level_model::{LevelModel, OrderLevel};
use super::levels::NoiseLevel;
use super::settings::EvidenceConfig;
use hovertone_vehicle::LineLevels;

/// The models that tell a rotor from none, in the noise of each look.
pub(super) struct Presence<'a> {
    noise: NoiseLevel,
    short: LevelModel<'a>,
    long: Option<LevelModel<'a>>,
}

impl<'a> Presence<'a> {
    pub(super) fn new(short: NoiseLevel, long: Option<NoiseLevel>, prior: &'a LineLevels) -> Self {
        let model = |noise: NoiseLevel| LevelModel::of_presence(noise, prior);
        Self { noise: short, short: model(short), long: long.map(model) }
    }

    /// Whether a rotor is heard, by the hypotheses with one propeller: the first, most probable one has the levels in each look, and the one with the
    /// best levels has the votes. What is known of the vehicle tells octaves apart, and no rotor from none.
    pub(super) fn is_heard(&mut self, hypotheses: &[Hypothesis], config: &EvidenceConfig) -> bool {
        let best = hypotheses.iter().max_by(|a, b| a.levels_nats.total_cmp(&b.levels_nats));
        hypotheses.first().zip(best).is_some_and(|(first, best)| {
            best.votes_nats >= config.votes_nats_min
                && self.least_nats(first) >= config.levels_nats_min
                && self.is_mesh_heard(first)
        })
    }

    /// Whether a line of the gear mesh stands out, where one is followed: its propeller alone may be mains hum.
    fn is_mesh_heard(&self, hypothesis: &Hypothesis) -> bool {
        let is_line = |level: &OrderLevel| self.noise.is_below(level.level_db);
        hypothesis.lines.mesh_order.is_none() || hypothesis.levels.mesh.iter().any(is_line)
    }

    /// The evidence of the lines over the local floor, in the look that has the least: what the floor hides is no evidence that a rotor sounds.
    fn least_nats(&mut self, hypothesis: &Hypothesis) -> f64 {
        let short_nats = self.short.flat_nats(&hypothesis.levels, &hypothesis.lines);
        match self.long.as_mut().zip(hypothesis.long_levels.as_ref()) {
            Some((long, levels)) => short_nats.min(long.flat_nats(levels, &hypothesis.lines)),
            None => short_nats,
        }
    }
}
