//! The recordings in memory, and their speeds by the library: without the start of a program for each case.

use super::answer::{Answer, Status, ToldReading};
use super::cases::{Case, Mode, Told, TruthSet};
use hovertone::sound::{Signal, SignalSource};
use hovertone::speed::{Config, Method, Outcome, SpeedAnalysis, ToneConfig, speed_from_source};
use hovertone::tones::Reading;
use hovertone_media::{OpenOptions, Recording};
use hovertone_vehicle::{KnownRotor, Order};
use std::path::Path;

/// A case that the library can hear: its sound and its settings.
pub(super) struct LoadedCase<'a> {
    pub(super) case: Case<'a>,
    pub(super) sound: Signal,
    facts: Facts,
}

/// What the flags of a case say.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Facts {
    blades: u32,
    known: KnownRotor,
    channel: Option<usize>,
}

impl Facts {
    /// `None` where the flags say more than blades, rotors, diameter, mass and channel.
    fn of(flags: &[String]) -> Option<Self> {
        let mut facts = Self::default();
        for pair in flags.chunks(2) {
            let [name, value] = pair else { return None };
            match name.as_str() {
                "--blades" => facts.blades = value.parse().ok()?,
                "--channel" => facts.channel = Some(value.parse().ok()?),
                "--rotors" => facts.known.rotor_count = Some(value.parse().ok()?),
                "--diameter-m" => facts.known.diameter_m = Some(value.parse().ok()?),
                "--mass-kg" => facts.known.mass_kg = Some(value.parse().ok()?),
                _ => return None,
            }
        }
        (facts.blades > 0).then_some(facts)
    }

    /// The default settings with these facts. Rotors are not separated: the exam asks for octaves.
    fn config(&self) -> Result<Config, String> {
        let order = Order::from_blades(self.blades).map_err(|error| error.to_string())?;
        let tone = ToneConfig { blades: Some(self.blades), ..ToneConfig::of_order(order) };
        let mut config = Config { known: self.known, method: Method::Harmonic, ..Config::for_tone(tone) };
        config.rotors.count = self.known.rotor_count.unwrap_or(config.rotors.count);
        config.rotors.is_count_known = self.known.rotor_count.is_some();
        Ok(config)
    }
}

impl<'a> LoadedCase<'a> {
    /// The trusted cases over the whole recording of which `is_wanted` says so, where blades are given, alone or with rotors, diameter and mass.
    pub(super) fn all(set: &'a TruthSet, is_wanted: impl Fn(Told) -> bool) -> Result<Vec<Self>, String> {
        let is_meant = |case: &Case<'_>| {
            let mode = Mode::of(case.flags);
            is_wanted(mode.told) && !mode.is_spanned && !case.truth.is_low_confidence()
        };
        let meant = set.cases().into_iter().filter(is_meant);
        let with_facts = meant.filter_map(|case| Facts::of(case.flags).map(|facts| (case, facts)));
        with_facts.map(|(case, facts)| Self::load(set, case, facts)).collect()
    }

    fn load(set: &TruthSet, case: Case<'a>, facts: Facts) -> Result<Self, String> {
        let sound = sound_of(&set.path(&case.truth.file), facts.channel)?;
        Ok(Self { case, sound, facts })
    }

    /// The blades that the flags say.
    pub(super) fn blades(&self) -> u32 {
        self.facts.blades
    }

    /// The default settings of this case.
    pub(super) fn config(&self) -> Result<Config, String> {
        self.facts.config()
    }

    /// What the library hears with these settings.
    pub(super) fn answer(&self, config: &Config) -> Result<Answer, String> {
        answer_to(self.sound.clone(), config)
    }
}

/// The default settings where the blades are known and nothing else.
pub(super) fn config_of_blades(blades: u32) -> Result<Config, String> {
    Facts { blades, ..Facts::default() }.config()
}

/// The sound of a file.
pub(super) fn sound_of(path: &Path, channel: Option<usize>) -> Result<Signal, String> {
    let failed = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
    let options = OpenOptions { channel, ..OpenOptions::default() };
    let mut recording = Recording::open(path, &options).map_err(|error| failed(&error))?;
    let mut samples = Vec::new();
    while let Some(block) = recording.next_block().map_err(|error| failed(&error))? {
        samples.extend_from_slice(block);
    }
    Ok(Signal::new(samples, recording.sample_rate_hz()))
}

/// What the library hears in a sound.
pub(super) fn answer_to(mut sound: Signal, config: &Config) -> Result<Answer, String> {
    let analysis = speed_from_source(&mut sound, config, &mut |_| {}).map_err(|error| error.to_string())?;
    Ok(answer_of(&analysis, config.method))
}

fn answer_of(analysis: &SpeedAnalysis, method: Method) -> Answer {
    let Outcome::Ok(tone) = &analysis.outcome else {
        return Answer { status: Status::NoRotorTone, ..Answer::default() };
    };
    if !tone.alternatives.is_empty() {
        let told =
            |reading: &Reading| ToldReading { speed_rev_s: reading.speed.rev_s(), plausibility: reading.plausibility };
        let alternatives = tone.alternatives.iter().map(told).collect();
        return Answer { status: Status::Ambiguous, alternatives, ..Answer::default() };
    }
    match tone.speed(method) {
        Some(speed) => Answer {
            status: Status::Ok,
            speed_rev_s: Some(speed.speed.rev_s()),
            combined_std_uncertainty_rev_s: speed.combined_std_uncertainty_rev_s(),
            ..Answer::default()
        },
        None => Answer { status: Status::NoRotorTone, ..Answer::default() },
    }
}

#[cfg(test)]
mod tests {
    use super::Facts;

    fn facts(text: &str) -> Option<Facts> {
        Facts::of(&text.split_whitespace().map(str::to_owned).collect::<Vec<_>>())
    }

    #[test]
    fn flags_are_facts_or_the_case_is_left_out() {
        let all = facts("--blades 2 --rotors 4 --diameter-m 0.24 --mass-kg 1.3 --channel 2").unwrap();
        assert_eq!(
            (all.blades, all.known.rotor_count, all.known.mass_kg, all.channel),
            (2, Some(4), Some(1.3), Some(2))
        );
        assert_eq!(facts("--blades 2 --vehicle ardrone"), None);
        assert_eq!(facts("--rotors 4"), None);
        assert_eq!(facts("--blades"), None);
    }
}
