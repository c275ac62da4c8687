//! Facts that a person gave before a recording was heard. Advice names those, and no others.

use crate::Warning;
use hovertone_vehicle::in_list;

/// Part of the advice where rotors are not separated: it means nothing to a person who has given their number.
pub const FEWER_ROTORS: &str = "if fewer rotors turn, give their number with --rotors; ";

/// Advice where several rotors sound in the band.
const NARROWER_BAND: &str = "hovertone follows whichever rotor is loudest at each moment; if several rotors turn, give their number with --rotors; to follow one \
     rotor, give a --band around its tone that is a few per cent wide";

/// Which facts were given. Beside a vehicle, the other facts are those that the vehicle does not tell in this way itself.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct GivenFacts {
    /// A known vehicle, with the blades, the gear, the diameter and the mass that it tells.
    pub vehicle: bool,
    /// The blades.
    pub blades: bool,
    /// The gear.
    pub gear: bool,
    /// The order of the tone alone: of blades or of a gear.
    pub order: bool,
    /// The diameter of the propellers, where it is not that of the vehicle.
    pub diameter: bool,
    /// The mass, where it is not that of the vehicle.
    pub mass: bool,
    /// The mass is that of a load of an experiment, which cannot be left out.
    pub is_load: bool,
    /// The band of the tone.
    pub band: bool,
    /// The length of the frames.
    pub window: bool,
    /// The number of rotors, by itself.
    pub rotors: bool,
}

impl GivenFacts {
    /// "the number of blades, the mass or the band"; "the given facts" where none is known. `last` is the word before the last fact.
    pub fn in_words(self, last: &str) -> String {
        let facts = [
            (self.vehicle, "the vehicle"),
            (self.blades, "the number of blades"),
            // --gear and --order say the same
            (self.gear, "the gear (--gear or --order)"),
            (self.order, "the number of --order"),
            (self.diameter, "the diameter"),
            (self.mass, "the mass"),
            // it tells how much of the mass a rotor carries
            (self.mass && self.rotors, "the number of rotors"),
            (self.band, "the band"),
        ];
        let given = named(&facts);
        if given.is_empty() { "the given facts".to_owned() } else { in_list(&given, last) }
    }

    /// The facts that the number of blades alone replaces. A diameter and a mass may stay beside it.
    pub fn replaced_by_blades(self) -> String {
        let is_about_tone = self.vehicle || self.gear || self.order || self.band;
        let beside = |is_given: bool| is_given && !is_about_tone;
        let (diameter, mass) = (beside(self.diameter), beside(self.mass));
        Self { blades: self.blades && !is_about_tone, diameter, mass, ..self }.in_words("and")
    }

    /// Advice that asks for a check of the number of blades, in words for the facts that were given: no gear is blamed that nobody gave.
    fn in_given_words(self, advice: &str) -> String {
        let facts = [
            (self.vehicle, "the vehicle"),
            (self.blades, "the number of blades"),
            (self.gear, "the gear"),
            (self.order, "the number of --order"),
        ];
        let of_tone = match self.vehicle || self.gear || self.order {
            true => in_list(&named(&facts), "and"),
            false => "the number of blades".to_owned(),
        };
        let of_tone_or_vehicle =
            if self.vehicle || !(self.gear || self.order) { "the vehicle and its blades" } else { &of_tone };
        advice.replace("the number of blades", &of_tone).replace("the vehicle and its blades", of_tone_or_vehicle)
    }

    /// Advice for each warning about one recording. It asks for one change of a window or a band at most, since that may mend all.
    pub fn hints(self, warnings: &[&Warning]) -> Vec<String> {
        let is_band_wrong = self.band
            && warnings.iter().any(|warning| {
                matches!(
                    warning,
                    Warning::RidgeOnBandEdge { .. } | Warning::ManyGaps { .. } | Warning::FitsElsewhere(_)
                )
            });
        let is_about_ridge = |warning: &Warning| {
            matches!(
                warning,
                Warning::RidgeOnBandEdge { .. }
                    | Warning::HarmonicLeftOut { .. }
                    | Warning::FewHarmonicsAgree { .. }
                    | Warning::ManyGaps { .. }
                    | Warning::FewFrames { needed_s: None, .. }
                    | Warning::SeveralLines { .. }
            )
        };
        let hint = |warning: &&Warning| match warning {
            Warning::FitsElsewhere(_) => {
                let load = if self.is_load { ", and the mass of its load" } else { "" };
                format!(
                    "check {}{load}; if nothing is wrong there, record again with the microphone nearer",
                    self.in_words("and")
                )
            }
            warning if self.window && is_about_ridge(warning) => {
                "leave --window-s out: hovertone then chooses a length that fits the tone".to_owned()
            }
            warning if is_band_wrong && is_about_ridge(warning) => "leave --band out, or give a wider one".to_owned(),
            Warning::FewHarmonicsAgree { .. } if self.band => {
                format!("{}, or give a narrower --band", self.in_given_words(warning.hint()))
            }
            Warning::SeveralLines { .. } if self.band => NARROWER_BAND.to_owned(),
            Warning::RotorsNotApart { .. } if self.rotors => warning.hint().replace(FEWER_ROTORS, ""),
            other => self.in_given_words(other.hint()),
        };
        warnings.iter().map(hint).collect()
    }
}

/// The facts that were given, of these.
fn named(facts: &[(bool, &'static str)]) -> Vec<&'static str> {
    facts.iter().filter(|(is_given, _)| *is_given).map(|(_, fact)| *fact).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_given_number_of_rotors_is_not_asked_for() {
        let apart = Warning::RotorsNotApart { resolved: 0, of: 4, in_mean: 4, is_assumed: false, spread_share: 0.006 };
        let hint = |rotors: bool| GivenFacts { rotors, ..GivenFacts::default() }.hints(&[&apart]).remove(0);
        assert!(hint(false).contains(FEWER_ROTORS) && !hint(true).contains("--rotors"), "{}", hint(true));
    }

    #[test]
    fn only_given_facts_are_named() {
        let nothing = GivenFacts::default();
        assert_eq!(nothing.in_words("and"), "the given facts");
        let all = GivenFacts {
            vehicle: true,
            blades: true,
            gear: true,
            order: false,
            diameter: true,
            mass: true,
            is_load: false,
            band: true,
            window: true,
            rotors: false,
        };
        let named =
            "the vehicle, the number of blades, the gear (--gear or --order), the diameter, the mass and the band";
        assert_eq!(all.in_words("and"), named);
        let of_vehicle = GivenFacts { vehicle: true, band: true, ..nothing };
        assert_eq!(of_vehicle.in_words("and"), "the vehicle and the band");
        let alone = GivenFacts { blades: true, mass: true, band: true, ..nothing };
        assert_eq!(alone.in_words("or"), "the number of blades, the mass or the band");
        let carried = GivenFacts { rotors: true, ..alone };
        assert_eq!(carried.in_words("and"), "the number of blades, the mass, the number of rotors and the band");
        assert_eq!(GivenFacts { rotors: true, blades: true, ..nothing }.in_words("and"), "the number of blades");
        assert_eq!(all.replaced_by_blades(), "the vehicle, the gear (--gear or --order) and the band");
        assert_eq!(of_vehicle.replaced_by_blades(), "the vehicle and the band");
        assert_eq!(alone.replaced_by_blades(), "the band");
        assert_eq!(GivenFacts { blades: true, ..nothing }.replaced_by_blades(), "the number of blades");
        let by_numbers = GivenFacts { diameter: true, mass: true, ..nothing };
        assert_eq!(by_numbers.in_words("and"), "the diameter and the mass");
    }

    #[test]
    fn a_gear_is_blamed_only_where_one_was_given() {
        let left_out = Warning::HarmonicLeftOut { harmonic: 1, reason: String::new() };
        let hardly_heard = Warning::ManyGaps { gap_share: 0.9, clear: None };
        let hints = |given: GivenFacts| given.hints(&[&left_out, &hardly_heard]);
        let nothing = GivenFacts::default();
        assert!(hints(nothing).iter().all(|hint| !hint.contains("gear")), "{:?}", hints(nothing));
        assert!(hints(nothing)[0].ends_with("check the number of blades"), "{:?}", hints(nothing));
        let geared = GivenFacts { blades: true, gear: true, ..nothing };
        assert!(
            hints(geared).iter().all(|hint| hint.contains("check the number of blades and the gear")),
            "{:?}",
            hints(geared)
        );
        let by_order = GivenFacts { order: true, ..nothing };
        assert_eq!(by_order.in_words("and"), "the number of --order");
        assert!(hints(by_order).iter().all(|hint| hint.contains("the number of --order")), "{:?}", hints(by_order));
        let vehicle = GivenFacts { vehicle: true, ..nothing };
        assert!(hints(vehicle).iter().all(|hint| hint.contains("check the vehicle")), "{:?}", hints(vehicle));
        let own_blades = GivenFacts { blades: true, ..vehicle };
        assert!(
            hints(own_blades)[0].ends_with("check the vehicle and the number of blades"),
            "{:?}",
            hints(own_blades)
        );
    }

    /// One warning would ask for a wider band, another for a narrower one, and a third for none.
    #[test]
    fn advice_about_a_band_does_not_contradict_itself() {
        let warnings = [
            Warning::RidgeOnBandEdge { harmonic: 1, frames_share: 0.5, band_hz_low: 140.0, band_hz_high: 165.0 },
            Warning::FewHarmonicsAgree { used: 1, of: 3 },
            Warning::ManyGaps { gap_share: 0.4, clear: None },
            Warning::SeveralLines { spread_share: 0.02 },
            Warning::HarmonicLeftOut { harmonic: 1, reason: String::new() },
        ];
        let hints = |given: GivenFacts, warnings: &[Warning]| given.hints(&warnings.iter().collect::<Vec<_>>());
        let about = |flag: &str, hints: Vec<String>| -> Vec<String> {
            let mut about: Vec<String> = hints.into_iter().filter(|hint| hint.contains(flag)).collect();
            about.dedup();
            about
        };
        let in_band = GivenFacts { band: true, ..GivenFacts::default() };
        assert_eq!(about("--band", hints(in_band, &warnings)), ["leave --band out, or give a wider one"]);
        assert!(
            hints(in_band, &warnings[3..4])[0].ends_with("give a --band around its tone that is a few per cent wide")
        );
        let in_window = GivenFacts { band: true, window: true, ..GivenFacts::default() };
        assert_eq!(about("--", hints(in_window, &warnings)).len(), 1);
        let without = about("--band", hints(GivenFacts::default(), &warnings));
        assert!(without.len() == 1 && without[0].contains("give --band LOW:HIGH"), "{without:?}");
    }
}
