//! Whether a rotor sounds at all.

use super::hypotheses::Hypothesis;
use super::level_model::{LevelModel, RotorLevels};
use super::levels::NoiseLevel;
use super::rotor_lines::RotorLines;
use super::settings::EvidenceConfig;
use hovertone_vehicle::LineLevels;

/// The models that tell a rotor from none, in the noise of each look.
pub(super) struct Presence<'a> {
    short: LevelModel<'a>,
    long: Option<LevelModel<'a>>,
}

impl<'a> Presence<'a> {
    pub(super) fn new(short: NoiseLevel, long: Option<NoiseLevel>, prior: &'a LineLevels) -> Self {
        let model = |noise: NoiseLevel| LevelModel::of_presence(noise, prior);
        Self { short: model(short), long: long.map(model) }
    }

    /// Whether a rotor is heard, by the hypotheses with one propeller: the first, most probable one has the levels in each look, and the one with the
    /// best levels has the votes. The quieter frames do not vote against it, because a voice pauses and a rotor does not.
    ///
    /// What is known of the vehicle tells octaves apart, and no rotor from none. A gear mesh that is followed is more probable than none: the
    /// propeller alone may be mains hum. Beside the mesh the propeller may be inaudible, but then it is so in both looks.
    pub(super) fn is_heard(&mut self, hypotheses: &[Hypothesis], config: &EvidenceConfig) -> bool {
        let best = hypotheses.iter().max_by(|a, b| a.levels_nats.total_cmp(&b.levels_nats));
        hypotheses.first().zip(best).is_some_and(|(first, best)| {
            let mesh_nats = self.mesh_nats(first);
            best.votes_nats >= config.votes_nats_min
                && best.quiet_votes_nats >= config.votes_nats_min.min(0.0)
                && mesh_nats >= 0.0
                && mesh_nats.max(self.nats(first)) >= config.levels_nats_min
        })
    }

    /// The evidence for the gear mesh alone; 0 where none is followed.
    pub(super) fn mesh_nats(&mut self, hypothesis: &Hypothesis) -> f64 {
        self.least_nats(hypothesis, LevelModel::flat_mesh_nats)
    }

    /// The evidence for the mesh with the propeller.
    fn nats(&mut self, hypothesis: &Hypothesis) -> f64 {
        self.least_nats(hypothesis, |model, levels, lines| {
            model.flat_mesh_nats(levels, lines) + model.flat_propeller_nats(levels, lines)
        })
    }

    /// The evidence of lines over the local floor, in the look that has the least: what the floor hides is no evidence that a rotor sounds.
    fn least_nats(
        &mut self,
        hypothesis: &Hypothesis,
        nats: impl Fn(&mut LevelModel<'a>, &RotorLevels, &RotorLines) -> f64,
    ) -> f64 {
        let short_nats = nats(&mut self.short, &hypothesis.levels, &hypothesis.lines);
        match self.long.as_mut().zip(hypothesis.near_levels.as_ref()) {
            Some((long, levels)) => short_nats.min(nats(long, levels, &hypothesis.lines)),
            None => short_nats,
        }
    }
}
