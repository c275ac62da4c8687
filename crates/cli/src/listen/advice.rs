//! Advice about live sound that names the flags which were given.

use crate::args::{KnownArguments, ToneArguments};
use hovertone_vehicle::in_list;

/// Words before "the given facts" that make sense before flags too.
const BEFORE_FACTS: [&str; 4] = ["in place of", "check", "fits", "contradicts"];

/// What a person can do.
#[derive(Clone, Debug, Default)]
pub(crate) struct Advice {
    /// What to do where several speeds are possible.
    which_is_right: String,
    /// The flags about the rotor, as "--blades 2 and --mass-kg".
    given: String,
}

impl Advice {
    pub(crate) fn new(tone: &ToneArguments, known: &KnownArguments, which_is_right: String) -> Self {
        let flags = [
            tone.vehicle.as_ref().map(|name| format!("--vehicle {name}")),
            tone.blades.map(|blades| format!("--blades {blades}")),
            tone.gear.map(|_| "--gear".to_owned()),
            tone.order.map(|_| "--order".to_owned()),
            tone.band.map(|_| "--band".to_owned()),
            known.diameter_m.map(|_| "--diameter-m".to_owned()),
            known.mass_kg.map(|_| "--mass-kg".to_owned()),
        ];
        let flags: Vec<String> = flags.into_iter().flatten().collect();
        let given = if flags.is_empty() { "the given facts".to_owned() } else { in_list(&flags, "and") };
        Self { which_is_right, given }
    }

    pub(crate) fn which_is_right(&self) -> &str {
        &self.which_is_right
    }

    /// The flags that were given.
    pub(crate) fn given(&self) -> &str {
        &self.given
    }

    /// A remark that names the given flags.
    pub(crate) fn naming(&self, remark: &str) -> String {
        BEFORE_FACTS.iter().fold(remark.to_owned(), |remark, before| {
            remark.replace(&format!("{before} the given facts"), &format!("{before} {}", self.given))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_remark_names_the_flags_that_were_given() {
        let tone = ToneArguments { blades: Some(2), ..ToneArguments::default() };
        let known = KnownArguments { mass_kg: Some(0.4), ..KnownArguments::default() };
        let advice = Advice::new(&tone, &known, String::new());
        assert_eq!(
            advice.naming("no rotor that fits the given facts is heard; check the given facts"),
            "no rotor that fits --blades 2 and --mass-kg is heard; check --blades 2 and --mass-kg"
        );
        let advice = Advice::new(&tone, &KnownArguments::default(), String::new());
        let told = advice.naming("give --blades 4 alone, in place of the given facts");
        assert_eq!(told, "give --blades 4 alone, in place of --blades 2");
    }
}
