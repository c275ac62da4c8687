//! Why a recording has no speed, and what to do: the advice names the facts that were given, and asks for those that are missing.

use crate::number::significant;
use crate::recording::{Answer, SpeedRecord};
use hovertone_analysis::{GivenFacts, NoTone, Outcome, Reading, SpeedAnalysis};
use hovertone_vehicle::{BLADES_MAX, THRUST_COEFFICIENT, in_list};

const SEVERAL_SPEEDS: &str = "several rotor speeds explain this sound";

const DIAMETER: &str = "the diameter of the propellers (--diameter-m)";
const MASS: &str = "the mass (--mass-kg)";
const ROTORS: &str = "the number of rotors (--rotors)";

/// In less sound, hovering longer is no advice: there is too little of it. *Decision.*
const HOVER_S_MIN: f64 = 1.0;

/// Length of the sound where it is too short for most rotors: then no other reason tells more. `None` where it is long enough, silent, or left out.
fn too_short_s(analysis: &SpeedAnalysis, reason: &NoTone) -> Option<f64> {
    let is_other = matches!(reason, NoTone::Silence | NoTone::OutsideRecording { .. });
    Some(analysis.heard.length_s()).filter(|heard_s| !is_other && (0.0..HOVER_S_MIN).contains(heard_s))
}

impl SpeedRecord {
    /// Reason for a missing speed.
    pub fn reason(&self) -> Option<String> {
        match &self.answer {
            Answer::Failed { reason } => Some(reason.clone()),
            Answer::Heard(analysis) => self.reason_of(analysis).map(|reason| self.wording.of(&reason)),
        }
    }

    /// Reason for a missing speed of an analysis, with the flags of `hovertone speed`.
    fn reason_of(&self, analysis: &SpeedAnalysis) -> Option<String> {
        match &analysis.outcome {
            Outcome::NoRotorTone { reason } if let Some(heard_s) = too_short_s(analysis, reason) => {
                Some(NoTone::TooShort { heard_s }.to_string())
            }
            Outcome::NoRotorTone { reason } => {
                let of_mesh = || self.no_mesh(reason).unwrap_or_else(|| reason.in_words(self.given_facts()));
                Some(self.spoiled.clone().unwrap_or_else(of_mesh))
            }
            Outcome::Ok(_) => self.is_ambiguous().then(|| self.why_ambiguous()),
        }
    }

    /// What to do where several speeds explain the sound.
    fn why_ambiguous(&self) -> String {
        let blades = "count the blades, and give --blades N too";
        if self.alternatives().len() == 1 {
            return format!(
                "the given facts leave one rotor speed only, and the sound does not show it clearly; check {}",
                self.facts_to_check()
            );
        }
        if self.found.as_ref().is_some_and(|found| !found.are_blades_given()) {
            let more = match self.has_thrust_coefficients() {
                true => String::new(),
                false => format!("; if that is not enough, give also {}", self.missing_facts()),
            };
            return format!("{SEVERAL_SPEEDS}; {blades}{more}");
        }
        if !self.are_blades_known() {
            return format!("{SEVERAL_SPEEDS}; {blades}: the tone of the blades shows the speed");
        }
        if self.has_thrust_coefficients() {
            return self.facts_that_do_not_fit().unwrap_or_else(|| {
                format!(
                    "{SEVERAL_SPEEDS}, and the vehicle could fly at more than one of them; check {}, or place the \
                     microphone nearer",
                    self.facts_to_check()
                )
            });
        }
        let (given, missing) = (self.given_facts(), self.missing_facts());
        let of_tone = or_given_facts(&of_tone(given));
        // a vehicle with a mass is in flight
        if self.is_one_rotor() && !self.is_known("/known/mass_kg") {
            let band = if given.band { "a narrower --band" } else { "--band LOW:HIGH" };
            return format!(
                "{SEVERAL_SPEEDS}; check {of_tone}; on a bench, give the band around the tone of the blades with {band}; \
                 in flight, give {missing}"
            );
        }
        format!("{SEVERAL_SPEEDS}; check {of_tone}, and give {missing}")
    }

    /// That the given facts exclude a speed that the sound does not, and what to check: either may be wrong.
    fn facts_that_do_not_fit(&self) -> Option<String> {
        let coefficient = |reading: &Reading| {
            reading.thrust_coefficient.filter(|coefficient| !THRUST_COEFFICIENT.contains(coefficient))
        };
        let (rev_s, coefficient) =
            self.alternatives().iter().find_map(|reading| Some((reading.speed.rev_s(), coefficient(reading)?)))?;
        let (low, high) = (THRUST_COEFFICIENT.start(), THRUST_COEFFICIENT.end());
        Some(format!(
            "{SEVERAL_SPEEDS}. One of them, {rev_s:.1} rev/s, does not fit the given diameter, mass and number of rotors: the propellers \
             would have a thrust coefficient C_T of {}, and propellers have {low} to {high}; check {}",
            significant(coefficient, 3),
            self.facts_to_check()
        ))
    }

    /// The given facts that decide between speeds, with their flags.
    fn facts_to_check(&self) -> String {
        let given = self.given_facts();
        let mut facts = of_tone(given);
        facts.extend(given.diameter.then_some(DIAMETER));
        facts.extend(given.mass.then_some(MASS));
        facts.extend((!given.vehicle && self.is_known("/known/rotor_count")).then_some(ROTORS));
        or_given_facts(&facts)
    }

    /// That no gear mesh is heard, where that is the tone to follow and nothing else sounds like a rotor.
    fn no_mesh(&self, reason: &NoTone) -> Option<String> {
        let order = self.order.lines_per_turn();
        let NoTone::NoSeries { only_rev_s, instead: None } = reason else { return None };
        let range = only_rev_s.map_or_else(String::new, |(low, high)| {
            format!(" at {:.0} to {:.0} Hz (its frequency at {low:.0} to {high:.0} rev/s)", order * low, order * high)
        });
        let facts = self.given_facts();
        let is_given = facts.vehicle || facts.gear || facts.order;
        let (replaced, given) = (facts.replaced_by_blades(), facts.in_words("and"));
        (order > BLADES_MAX && is_given).then(|| {
            format!(
                "the tone of the gear ({order} times the rotor speed) is not heard{range}; if the rotors have no \
                gear, give --blades N alone, in place of {replaced}; if they have one, check {given}, or move the \
                microphone nearer"
            )
        })
    }

    /// Whether the number of blades is given, told by the vehicle, or told by the sound.
    pub(crate) fn are_blades_known(&self) -> bool {
        self.is_known("/tone/blades") || self.is_known("/known/blade_count")
    }

    fn is_known(&self, place: &str) -> bool {
        self.setting(place).is_some()
    }

    /// Those of diameter, mass and number of rotors that are not known, and what they are for.
    fn missing_facts(&self) -> String {
        let facts = [("/known/diameter_m", DIAMETER), ("/known/mass_kg", MASS), ("/known/rotor_count", ROTORS)];
        let missing: Vec<&str> =
            facts.iter().filter(|(place, _)| !self.is_known(place)).map(|(_, words)| *words).collect();
        let missing = if missing.is_empty() { facts.map(|(_, words)| words).to_vec() } else { missing };
        let they_rule = if missing.len() == 1 { "it rules" } else { "they rule" };
        format!("{}: {they_rule} out speeds that cannot carry the vehicle", in_list(&missing, "and"))
    }

    /// Whether diameter, mass and number of rotors are known, so that each possible speed has a thrust coefficient.
    fn has_thrust_coefficients(&self) -> bool {
        self.alternatives().iter().any(|reading| reading.thrust_coefficient.is_some())
    }
}

/// The facts that were given about the tone, with their flags.
fn of_tone(given: GivenFacts) -> Vec<&'static str> {
    let facts = [
        (given.vehicle, "the vehicle (--vehicle)"),
        (given.gear, "the gear (--gear)"),
        (given.order, "the number of --order"),
        (given.blades, "the number of blades (--blades)"),
    ];
    facts.into_iter().filter_map(|(is_given, words)| is_given.then_some(words)).collect()
}

/// "the mass, the diameter and the number of rotors"; "the given facts" for none.
fn or_given_facts(facts: &[&str]) -> String {
    if facts.is_empty() { "the given facts".to_owned() } else { in_list(facts, "and") }
}
