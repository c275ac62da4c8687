//! The beliefs in the speeds of a rotor, and what follows from them.

use super::companions::Companions;
use super::excess::Looks;
use super::hypotheses::Hypothesis;
use super::levels::NoiseLevel;
use super::own_lines::OwnPropeller;
use super::settings::EvidenceConfig;
use hovertone_analysis::OtherRotor;

/// The beliefs that a recording gives rise to, where a rotor is heard.
#[derive(Clone, Debug)]
pub(crate) struct Beliefs {
    /// All hypotheses that are possible, most probable first; at least one.
    pub(crate) hypotheses: Vec<Hypothesis>,
    /// The noise between the lines.
    pub(super) noise: NoiseLevel,
    /// Whether only long frames hear the rotor.
    pub(crate) is_faint: bool,
    /// A rotor that something known leaves out, whose lines are far more probable than those of the most probable one.
    pub(crate) better: Option<OtherRotor>,
    /// The frames that tell the beliefs, where a voice was left out of them.
    pub(super) without_voice: Option<Looks>,
}

impl Beliefs {
    /// Orders of the most probable rotor whose lines stand out of the noise.
    pub(crate) fn heard_orders(&self) -> impl Iterator<Item = u32> {
        let lines = self.hypotheses.iter().take(1).flat_map(|first| &first.levels.shaft);
        lines.filter(|line| self.noise.is_below(line.level_db)).map(|line| line.order)
    }

    /// What is heard of other rotors beside the most probable one. `None` where its propeller is not followed.
    pub(crate) fn companions(&self, looks: &Looks, config: &EvidenceConfig) -> Option<Companions> {
        let first = self.hypotheses.first()?;
        if self.is_faint {
            return Some(Companions::UNHEARD);
        }
        let propeller = OwnPropeller { blades: first.lines.blades?, prior: &config.levels };
        Companions::beside(self.without_voice.as_ref().unwrap_or(looks), &first.speeds_rev_s, &propeller, config)
    }

    /// The same, where all hypotheses with one speed are one: the most probable of them, with the belief in all.
    pub(crate) fn with_equal_speeds_joined(mut self) -> Self {
        let mut joined: Vec<Hypothesis> = Vec::new();
        for it in self.hypotheses {
            match joined.iter_mut().find(|other| other.is_of_same_vehicle(it.speed_rev_s)) {
                Some(same) => same.belief += it.belief,
                None => joined.push(it),
            }
        }
        joined.sort_by(|a, b| b.belief.total_cmp(&a.belief));
        self.hypotheses = joined;
        self
    }

    /// The speed of the hover of the most probable rotor.
    pub(crate) fn hover_rev_s(&self) -> Option<f64> {
        self.hypotheses.first().map(|first| first.hover_rev_s)
    }

    /// Those that remain possible where odds of `belief_min` decide; only one where it is decided.
    pub(crate) fn possible(&self, belief_min: f64) -> &[Hypothesis] {
        let is_decided = self.hypotheses.first().is_some_and(|first| first.belief >= belief_min);
        let possible =
            self.hypotheses.iter().take_while(|hypothesis| hypothesis.belief >= 1.0 - belief_min).count().max(2);
        &self.hypotheses[..if is_decided { 1 } else { possible.min(self.hypotheses.len()) }]
    }
}
