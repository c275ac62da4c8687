//! What a person can do where several speeds are possible. It names only facts that were not given.

use hovertone::speed::Config;
use hovertone::tones::Discovery;
use hovertone_vehicle::in_list;

/// "count the blades and give --blades N", "give --mass-kg and --rotors".
pub(crate) fn which_is_right(config: &Config, discovery: Option<&Discovery>) -> String {
    let blades = config.tone.blades.or_else(|| discovery?.known.blade_count);
    if blades.is_none() {
        return "count the blades and give --blades N".to_owned();
    }
    let known = discovery.map_or(config.known, |discovery| discovery.known);
    let facts = [
        ("--diameter-m", known.diameter_m.is_some()),
        ("--mass-kg", known.mass_kg.is_some()),
        ("--rotors", known.rotor_count.is_some()),
    ];
    let missing: Vec<&str> = facts.into_iter().filter(|(_, is_given)| !is_given).map(|(flag, _)| flag).collect();
    match missing.is_empty() {
        true => "check the given facts about the vehicle, or place the microphone nearer".to_owned(),
        false => format!("give {}", in_list(&missing, "and")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone::speed::ToneConfig;
    use hovertone_vehicle::{KnownRotor, Order};

    #[test]
    fn only_facts_that_are_missing_are_asked_for() {
        let mut config = Config::for_tone(ToneConfig::of_order(Order::from_blades(2).unwrap()));
        assert_eq!(which_is_right(&config, None), "count the blades and give --blades N");
        config.tone.blades = Some(2);
        assert_eq!(which_is_right(&config, None), "give --diameter-m, --mass-kg and --rotors");
        config.known = KnownRotor { diameter_m: Some(0.2), mass_kg: Some(0.4), ..KnownRotor::default() };
        assert_eq!(which_is_right(&config, None), "give --rotors");
        config.known.rotor_count = Some(4);
        assert!(!which_is_right(&config, None).contains("--"));
    }
}
