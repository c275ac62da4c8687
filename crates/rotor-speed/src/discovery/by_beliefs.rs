//! The speed of the rotor that the evidence hears where nothing is known of its tone.

use super::{Discovery, config_for, speed_of};
use crate::config::Config;
use crate::error::Error;
use crate::evidence::{Beliefs, Hypothesis, RotorLines, WantedPropeller, WantedRotor};
use crate::pipeline::speed_of_heard_rotor;
use crate::stages::{
    HARDLY_FITS, HeardRotor, Surveyed, any_propellers, at_ratio, geared_propellers, known_gears, reading_of,
};
use crate::tone::{BLADES, ToneConfig, normalise, reading_at, rule_out, search_range_rev_s};
use hovertone_analysis::{Meaning, Outcome, Reading, SeenHarmonic, SpeedAnalysis, ToneFamily, Warning};
use hovertone_signal::passes::Passes;
use hovertone_vehicle::{Gear, Order, RotorSpeed};

/// The analysis knows the speed better than the evidence where it followed the same line: within this share, the width of a line of the
/// evidence. *Numeric.*
pub(super) const SAME_LINE_SHARE: f64 = 0.01;

/// Readings whose speeds differ by less are one reading. *Decision.*
const SAME_READING_SHARE: f64 = 0.05;

/// A rotor that the evidence hears.
pub(super) struct Believed {
    beliefs: Beliefs,
    /// Its readings, most plausible first; at least one.
    readings: Vec<Reading>,
    /// Whether one speed has the belief that decides.
    is_settled: bool,
}

impl Believed {
    /// `None` where no rotor is heard.
    pub(super) fn of(surveyed: &Surveyed, sample_rate_hz: f64, config: &Config, discovery: &Discovery) -> Option<Self> {
        let propellers = propellers(sample_rate_hz, config, discovery);
        // where the blades are not known, all propellers are compared already
        let where_unknown =
            if discovery.known.blade_count.is_some() { any_propellers(sample_rate_hz) } else { Vec::new() };
        let wanted = WantedRotor { propellers, known: discovery.known, may_be_slow: false, where_unknown };
        let beliefs = surveyed.beliefs(&wanted, config)?;
        let readings = readings_of(&beliefs, discovery);
        let is_heard = readings.first().is_some_and(|first| first.plausibility > 0.0);
        let is_settled = readings.first().is_some_and(|first| first.plausibility >= config.evidence.belief_min);
        is_heard.then_some(Self { beliefs, readings, is_settled })
    }

    /// The frequency of which the lines of the most plausible reading are multiples: the shaft speed, or the blade pass where no other line is
    /// heard.
    pub(super) fn fundamental_hz(&self) -> f64 {
        let first = &self.readings[0];
        let common = self.beliefs.heard_orders().fold(0, gcd);
        if common > 0 { f64::from(common) * first.speed.rev_s() } else { first.tone_hz }
    }

    /// The speed of the rotor, with a warning where a rotor with other blades is far more probable.
    ///
    /// # Errors
    /// A source that fails.
    pub(super) fn speed(
        &self,
        passes: &mut Passes<'_>,
        surveyed: &Surveyed,
        config: &Config,
    ) -> Result<BelievedSpeed, Error> {
        let first = &self.readings[0];
        let found = config_for(config, first);
        let companions = self.beliefs.companions(&surveyed.looks, &config.evidence);
        let rotor = HeardRotor { speed_rev_s: first.speed.rev_s(), is_faint: self.beliefs.is_faint, companions };
        let mut analysis = speed_of_heard_rotor(passes, surveyed, rotor, &found)?;
        if matches!(analysis.outcome, Outcome::Ok(_)) {
            analysis.warnings.extend(self.beliefs.better.map(Warning::FitsElsewhere));
        }
        // the analysis knows the speed better
        let ratio = speed_of(&analysis, &found).map(|it| it.speed.rad_s() / first.speed.rad_s());
        let ratio = ratio.map(|ratio| if (ratio - 1.0).abs() < SAME_LINE_SHARE { ratio } else { 1.0 });
        Ok(BelievedSpeed { config: found, analysis, ratio })
    }

    /// The readings that are possible, with their speeds times a ratio; none where one is settled.
    pub(super) fn alternatives(&self, ratio: f64) -> Vec<Reading> {
        let possible = self.readings.iter().filter(|reading| reading.plausibility > 0.0 && !self.is_settled);
        possible.map(|reading| at_ratio(reading, ratio)).collect()
    }

    /// The family of the rotor's lines with its readings, all with their speeds times a ratio.
    pub(super) fn family(&self, lines: ToneFamily, ratio: f64) -> ToneFamily {
        let fundamental_hz = ratio * self.fundamental_hz();
        let harmonic = |line: &SeenHarmonic| SeenHarmonic { hz: f64::from(line.number) * fundamental_hz, ..*line };
        ToneFamily {
            fundamental_hz,
            harmonics: lines.harmonics.iter().map(harmonic).collect(),
            readings: self.readings.iter().map(|reading| at_ratio(reading, ratio)).collect(),
            is_settled: self.is_settled,
            ..lines
        }
    }
}

/// What the analysis found of a rotor that the evidence hears.
pub(super) struct BelievedSpeed {
    /// Settings for its tone.
    pub(super) config: Config,
    pub(super) analysis: SpeedAnalysis,
    /// The speed over that of the evidence; `None` where the speed is not held.
    pub(super) ratio: Option<f64>,
}

fn gcd(a: u32, b: u32) -> u32 {
    if b == 0 { a } else { gcd(b, a % b) }
}

/// The propellers that are possible: with the blades that are given, or any; and those of the vehicles that are known to have a gear.
fn propellers(sample_rate_hz: f64, config: &Config, discovery: &Discovery) -> Vec<WantedPropeller> {
    let known = discovery.known.blade_count;
    let shares: Vec<(u32, f64)> = match known {
        Some(blades) => vec![(blades, 1.0)],
        None => BLADES.into_iter().zip(discovery.config.blade_shares).collect(),
    };
    let direct = shares.into_iter().filter_map(|(blades, share)| {
        let tone = ToneConfig { order: Order::from_blades(blades).ok()?, ..config.tone.clone() };
        let speeds_rev_s = search_range_rev_s(&tone, sample_rate_hz).ok()?;
        Some(WantedPropeller { lines: RotorLines::of_blades(blades), share, speeds_rev_s })
    });
    direct.chain(geared_propellers(sample_rate_hz, &config.tone, known, discovery.config.gear_share)).collect()
}

/// The hypotheses as readings, most plausible first; those that are excluded last.
///
/// Where neither the blades nor the diameter are known, the levels deceive in a share of all recordings (`deceived_share`): then nothing is known
/// but the tone, which may be the blade pass of any propeller, or its second harmonic. The mesh of a known gear does not deceive.
fn readings_of(beliefs: &Beliefs, discovery: &Discovery) -> Vec<Reading> {
    let (config, known) = (&discovery.config, &discovery.known);
    let mut readings: Vec<Reading> = beliefs.hypotheses.iter().filter_map(|it| reading_of_any(it, discovery)).collect();
    let may_be_deceived = discovery.may_be_deceived();
    let blade_pass = readings.first().filter(|first| first.meaning.gear().is_none() && may_be_deceived);
    if let Some(tone_hz) = blade_pass.map(|first| first.tone_hz) {
        readings.iter_mut().for_each(|reading| reading.plausibility *= 1.0 - config.deceived_share);
        for (blades, share) in BLADES.into_iter().zip(config.blade_shares) {
            for octave in [1.0, 0.5] {
                let Ok(order) = Order::from_blades(blades) else { continue };
                let speed = RotorSpeed::from_tone_hz(octave * tone_hz, order);
                let other = Reading {
                    plausibility: 0.5 * share * config.deceived_share,
                    why: HARDLY_FITS.to_owned(),
                    ..reading_at(speed, order, Meaning::BladePass { blades })
                };
                match readings.iter_mut().find(|reading| is_like(reading, &other)) {
                    Some(same) => same.plausibility += other.plausibility,
                    None => readings.push(other),
                }
            }
        }
    }
    readings.iter_mut().for_each(|reading| rule_out(reading, known));
    normalise(&mut readings);
    readings.retain(|reading| reading.plausibility == 0.0 || reading.plausibility >= config.plausible_min);
    readings
}

/// A hypothesis as a reading: of the blade pass, or of the mesh of a known gear.
fn reading_of_any(hypothesis: &Hypothesis, discovery: &Discovery) -> Option<Reading> {
    let blades = hypothesis.lines.blades?;
    let is_own = |(gear, _): &(Gear, u32)| hypothesis.lines.mesh_order == Some(f64::from(gear.wheel));
    let gear = known_gears().into_iter().find(is_own).map(|(gear, _)| gear);
    let (order, meaning) = match gear {
        Some(gear) => (Order::new(f64::from(gear.wheel)).ok()?, Meaning::BladePassAndMesh { blades, gear }),
        None => (Order::from_blades(blades).ok()?, Meaning::BladePass { blades }),
    };
    Some(reading_of(hypothesis, order, meaning, &discovery.known))
}

/// Whether two readings have the same number of blades and nearly the same speed.
fn is_like(reading: &Reading, other: &Reading) -> bool {
    let ratio = reading.speed.rad_s() / other.speed.rad_s();
    reading.meaning.blades() == other.meaning.blades() && (ratio - 1.0).abs() < SAME_READING_SHARE
}
