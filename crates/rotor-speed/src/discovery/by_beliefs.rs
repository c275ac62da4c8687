//! The speed of the rotor that the evidence hears where nothing is known of its tone.

use super::by_family::OTHER_SPEED_FACTOR;
use super::{Discovery, Families, FoundSpeed, config_for, speed_of};
use crate::config::Config;
use crate::error::Error;
use crate::evidence::{Beliefs, Hypothesis, WantedPropeller, WantedRotor};
use crate::pipeline::speed_of_heard_rotor;
use crate::stages::{Surveyed, at_ratio, reading_of};
use crate::tone::{BLADES, ToneConfig, normalise, rule_out, search_range_rev_s};
use hovertone_analysis::{Reading, SeenHarmonic, ToneFamily};
use hovertone_signal::passes::Passes;
use hovertone_vehicle::Order;

/// The analysis knows the speed better than the evidence where it followed the same line: within this share, the width of a line of the
/// evidence. *Numeric.*
pub(super) const SAME_LINE_SHARE: f64 = 0.01;

/// Readings whose speeds differ by less are one reading: the evidence and the survey hear different parts of a recording. *Decision.*
const SAME_READING_SHARE: f64 = 0.05;

/// A rotor that the evidence hears.
pub(super) struct Believed {
    beliefs: Beliefs,
    /// Its readings, most plausible first; at least one.
    readings: Vec<Reading>,
    /// Whether the evidence decides for one speed.
    is_decided: bool,
}

impl Believed {
    /// `None` where no rotor is heard.
    pub(super) fn of(surveyed: &Surveyed, sample_rate_hz: f64, config: &Config, discovery: &Discovery) -> Option<Self> {
        let propeller = |(blades, share): (u32, f64)| {
            let tone = ToneConfig { order: Order::from_blades(blades).ok()?, ..config.tone.clone() };
            Some(WantedPropeller { blades, share, speeds_rev_s: search_range_rev_s(&tone, sample_rate_hz).ok()? })
        };
        let propellers = match discovery.known.blade_count {
            Some(blades) => propeller((blades, 1.0)).into_iter().collect(),
            None => BLADES.into_iter().zip(discovery.config.blade_shares).filter_map(propeller).collect(),
        };
        let wanted = WantedRotor { propellers, known: discovery.known };
        let beliefs = surveyed.beliefs(&wanted, config).ok()?.filter(Beliefs::is_resolved)?;
        let readings = readings_of(&beliefs, discovery);
        readings.first().filter(|first| first.plausibility > 0.0 && beliefs.is_clear(&config.evidence))?;
        let is_decided = beliefs.possible(config.evidence.belief_min).len() == 1;
        Some(Self { beliefs, readings, is_decided })
    }

    /// Whether a family of lines has one of the readings that the evidence finds possible.
    pub(super) fn has_lines_in(&self, family: &ToneFamily, discovery: &Discovery) -> bool {
        let mut possible =
            self.readings.iter().take_while(|reading| reading.plausibility >= discovery.config.plausible_min);
        possible.any(|reading| reading_like(&family.readings, reading).is_some())
    }

    /// Whether the speed is settled: the evidence decides, and the lines do not speak for another reading. By the sound alone the levels do
    /// not tell the blades surely enough.
    fn is_settled(&self, leading: &Reading, discovery: &Discovery) -> bool {
        let is_known = discovery.known.blade_count.is_some() || discovery.known.diameter_m.is_some();
        let is_first = reading_like(&self.readings[..1], leading).is_some();
        self.is_decided && is_known && is_first
    }

    /// The speed of the rotor, whose lines are one of the families or none. `None` where no rotor is heard at the believed speed.
    ///
    /// # Errors
    /// A source that fails.
    pub(super) fn speed(
        &self,
        passes: &mut Passes<'_>,
        surveyed: &Surveyed,
        families: &Families,
        config: &Config,
        discovery: &Discovery,
    ) -> Result<Option<FoundSpeed>, Error> {
        let family = match families.of_rotor() {
            Some(family) => self.with_readings(family, discovery),
            None => self.family_of_lines(surveyed),
        };
        let Some(first) = family.readings.first().cloned() else { return Ok(None) };
        let found = config_for(config, &first, OTHER_SPEED_FACTOR);
        let analysis = speed_of_heard_rotor(passes, surveyed, first.speed.rev_s(), &found)?;
        let Some(speed) = speed_of(&analysis, &found) else { return Ok(None) };
        let ratio = speed.speed.rad_s() / first.speed.rad_s();
        let ratio = if (ratio - 1.0).abs() < SAME_LINE_SHARE { ratio } else { 1.0 };
        // the analysis knows the speed better
        let readings = family.readings.iter().map(|reading| at_ratio(reading, ratio)).collect();
        let family = ToneFamily { readings, ..family };
        let is_settled = self.is_settled(&first, discovery);
        let possible = if is_settled { Vec::new() } else { possible(&family, discovery) };
        let alternatives: Vec<Reading> = possible.into_iter().cloned().collect();
        let family = ToneFamily { is_settled: alternatives.is_empty(), ..family };
        let others = families.all.iter().enumerate().filter(|(index, _)| Some(*index) != families.rotor);
        let families = std::iter::once(family).chain(others.map(|(_, family)| family.clone())).collect();
        Ok(Some(FoundSpeed { families, rotor: Some(0), config: found, analysis, alternatives }))
    }

    /// The believed reading and an answer, most plausible first, where the beliefs decide for another octave; otherwise none.
    pub(super) fn objection(&self, answered: Reading) -> Vec<Reading> {
        let rev_s = answered.speed.rev_s();
        let is_other = self.beliefs.hypotheses.first().is_some_and(|first| !first.is_of_same_vehicle(rev_s));
        if !(self.is_decided && is_other) {
            return Vec::new();
        }
        let first = self.readings[0].clone();
        let answered = Reading { plausibility: 1.0 - first.plausibility, ..answered };
        if first.plausibility < answered.plausibility { vec![answered, first] } else { vec![first, answered] }
    }

    /// A family of the survey with these readings, beside its own where the blades are not given; the evidence knows the speed better.
    fn with_readings(&self, family: &ToneFamily, discovery: &Discovery) -> ToneFamily {
        if discovery.known.blade_count.is_some() {
            // with what rules out the others
            let excluded = family.readings.iter().filter(|reading| reading.plausibility == 0.0);
            let readings = self.readings.iter().chain(excluded).cloned().collect();
            return ToneFamily { readings, ..family.clone() };
        }
        let first = &self.readings[0];
        let same = reading_like(&family.readings, first);
        let ratio = same.map_or(1.0, |same| first.speed.rad_s() / same.speed.rad_s());
        let of_lines = family.readings.iter().map(|reading| at_ratio(reading, ratio)).collect();
        ToneFamily { readings: both(self.readings.clone(), of_lines), ..family.clone() }
    }

    /// The lines that the evidence hears, as a family.
    fn family_of_lines(&self, surveyed: &Surveyed) -> ToneFamily {
        let fundamental_hz = self.readings[0].tone_hz;
        let line =
            |(number, level_db): (u32, f64)| SeenHarmonic { number, hz: f64::from(number) * fundamental_hz, level_db };
        let harmonics: Vec<SeenHarmonic> = self.beliefs.harmonics_db().into_iter().map(line).collect();
        ToneFamily {
            fundamental_hz,
            spread_hz: None,
            level_db: harmonics.iter().map(|line| line.level_db).fold(0.0, f64::max),
            harmonics,
            time_share: 1.0,
            span: surveyed.heard(),
            readings: self.readings.clone(),
            is_settled: false,
            remark: None,
        }
    }
}

/// The readings that remain possible; at least two, where there are two.
fn possible<'a>(family: &'a ToneFamily, discovery: &Discovery) -> Vec<&'a Reading> {
    let plausible = family.plausible_readings(discovery.config.plausible_min);
    if plausible.len() > 1 { plausible } else { family.readings.iter().take(2).collect() }
}

/// The hypotheses as readings, most plausible first.
fn readings_of(beliefs: &Beliefs, discovery: &Discovery) -> Vec<Reading> {
    let reading = |hypothesis: &Hypothesis| {
        let order = Order::from_blades(hypothesis.blades).ok()?;
        let mut reading = reading_of(hypothesis, order, &discovery.known);
        rule_out(&mut reading, &discovery.known, &discovery.config);
        Some(reading)
    };
    let mut readings: Vec<Reading> = beliefs.hypotheses.iter().filter_map(reading).collect();
    normalise(&mut readings);
    let listed = readings.iter().filter(|reading| reading.plausibility >= discovery.config.plausible_min).count();
    readings.truncate(listed.max(2));
    readings
}

/// A possible reading with the same number of blades and nearly the same speed.
fn reading_like<'a>(readings: &'a [Reading], wanted: &Reading) -> Option<&'a Reading> {
    readings.iter().find(|reading| {
        let ratio = reading.speed.rad_s() / wanted.speed.rad_s();
        let is_near = (ratio - 1.0).abs() < SAME_READING_SHARE;
        reading.plausibility > 0.0 && reading.meaning.blades() == wanted.meaning.blades() && is_near
    })
}

/// The readings of the evidence and of the lines, most plausible first. Each has half of the belief, because neither knows all lines of the
/// other.
fn both(of_evidence: Vec<Reading>, of_lines: Vec<Reading>) -> Vec<Reading> {
    let half = |reading: Reading| Reading { plausibility: 0.5 * reading.plausibility, ..reading };
    let mut readings: Vec<Reading> = of_lines.into_iter().map(half).collect();
    for reading in of_evidence.into_iter().map(half) {
        let is_like = |other: &&mut Reading| reading_like(std::slice::from_ref(*other), &reading).is_some();
        match readings.iter_mut().find(is_like) {
            Some(same) => {
                same.plausibility += reading.plausibility;
                same.why = format!("{}; {}", reading.why, same.why);
            }
            None => readings.push(reading),
        }
    }
    readings.sort_by(|a, b| b.plausibility.total_cmp(&a.plausibility));
    readings
}

#[cfg(test)]
mod tests {
    use super::*;
    use hovertone_analysis::Meaning;
    use hovertone_vehicle::RotorSpeed;

    fn reading(blades: u32, rev_s: f64, plausibility: f64) -> Reading {
        let order = Order::from_blades(blades).unwrap();
        let speed = RotorSpeed::from_rev_s(rev_s);
        Reading {
            order,
            tone_hz: speed.tone_hz(order),
            meaning: Meaning::BladePass { blades },
            speed,
            motor_speed: speed,
            tip_mach: None,
            thrust_coefficient: None,
            plausibility,
            why: String::new(),
        }
    }

    #[test]
    fn the_evidence_and_the_lines_have_half_of_the_belief_each() {
        let of_evidence = vec![reading(2, 91.0, 0.9), reading(2, 45.5, 0.1)];
        let of_lines = vec![reading(3, 60.0, 0.6), reading(2, 90.0, 0.4)];
        let all = both(of_evidence, of_lines);
        let beliefs: Vec<(u32, f64, f64)> = all
            .iter()
            .map(|it| (it.meaning.blades().unwrap(), it.speed.rev_s().round(), (100.0 * it.plausibility).round()))
            .collect();
        assert_eq!(beliefs, [(2, 90.0, 65.0), (3, 60.0, 30.0), (2, 46.0, 5.0)]);
    }

    #[test]
    fn an_excluded_reading_is_like_no_other() {
        assert!(reading_like(&[reading(2, 90.0, 0.0)], &reading(2, 90.0, 1.0)).is_none());
        assert!(reading_like(&[reading(3, 90.0, 1.0)], &reading(2, 90.0, 1.0)).is_none());
        assert!(reading_like(&[reading(2, 93.0, 1.0)], &reading(2, 90.0, 1.0)).is_some());
    }
}
