//! A source without a named tone → its tone families, the rotor's among them, and the rotor's speed. No arithmetic of
//! spectra here: that is in `tone/`.

mod by_beliefs;
mod by_family;

use crate::config::Config;
use crate::error::Error;
use crate::pipeline::{passes_after_survey, passes_of_speed};
use crate::stages::{Silence, at_ratio, survey_from_source};
use crate::survey::{RowSettings, RowsBuilder, Survey};
use crate::tone::{DiscoveryConfig, families_from_surveys};
use by_beliefs::Believed;
use by_family::speed_of_family;
use hovertone_analysis::{NoTone, Outcome, Reading, Remark, SpeedAnalysis, SpeedEstimate, ToneFamily};
use hovertone_signal::SignalSource;
use hovertone_signal::passes::{Passes, Progress};
use hovertone_vehicle::{KnownRotor, RotorSpeed};
use serde::Serialize;

/// Rows of the finer spectrum that are kept: 64 of a second are 6 MB at 44.1 kHz. *Numeric.*
const DETAIL_ROWS_MAX: usize = 64;
/// Frames of the finer spectrum to a row. They follow each other without overlap, which costs half as much. *Numeric.*
const DETAIL_FRAMES: f64 = 2.0;

/// What is looked for, and what is known beforehand.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Discovery {
    /// How families are found.
    pub config: DiscoveryConfig,
    /// What is known of the vehicle.
    pub known: KnownRotor,
    /// Whether all families are wanted, or only those up to the first that is a rotor's beyond doubt.
    pub wants_all: bool,
}

/// The tone families of a recording, and its rotor's speed as far as the sound tells it.
#[derive(Clone, Debug)]
pub struct FoundSpeed {
    /// All families, strongest first.
    pub families: Vec<ToneFamily>,
    /// Which of them was taken for the rotor's, where one was.
    pub rotor: Option<usize>,
    /// Settings of the analysis with the tone that was found; those given where none was.
    pub config: Config,
    /// The analysis of the most plausible reading, with its verdict whether there is a rotor at all.
    pub analysis: SpeedAnalysis,
    /// The plausible readings, with their speeds from the analysis; empty where one is settled and where there is no rotor.
    pub alternatives: Vec<Reading>,
}

impl FoundSpeed {
    /// The reading that the speed rests on: settled, or the most plausible.
    pub fn reading(&self) -> Option<&Reading> {
        self.families.get(self.rotor?)?.readings.first()
    }
}

/// From a recording of which nothing is known to its tone families and the speed of its rotors.
///
/// The strongest family that a rotor can make (not a brief one, where there is another) is read in its most plausible way, and then analysed as
/// if its order had been given: [`crate::speed_from_source`] says how, and whether it is a rotor. Where the lines do not settle the reading and the
/// evidence of all orders hears a rotor, each reading has half of its belief from the evidence (all of it where the blades are given), and the
/// evidence says that it is a rotor. Where several readings stay plausible they are the `alternatives`, and the speed of the analysis is only
/// that of the first.
///
/// `config` gives all settings but the tone's order, blades and range of speeds; a band in it is where the fundamental is
/// looked for. Reads the source twice.
///
/// # Errors
/// Settings that mean nothing, a source that fails. That there is no rotor is an outcome.
pub fn tones_from_source(
    source: &mut dyn SignalSource,
    config: &Config,
    discovery: &Discovery,
    on_progress: &mut dyn FnMut(Progress),
) -> Result<FoundSpeed, Error> {
    tones_from_passes(&mut Passes::planned(source, passes_of_speed(config), on_progress)?, config, discovery)
}

/// The same, where the caller has planned the passes: as many as [`passes_of_speed`] says; another reading that is tried announces its own.
///
/// # Errors
/// As [`tones_from_source`].
pub fn tones_from_passes(passes: &mut Passes<'_>, config: &Config, discovery: &Discovery) -> Result<FoundSpeed, Error> {
    config.check()?;
    discovery.config.check()?;
    discovery.known.check()?;
    let start_s = config.span.from_s.unwrap_or(f64::MIN).max(passes.start_s());
    let window_s = discovery.config.detail_window_s;
    let rows = RowSettings { window_s, hop_s: window_s, row_s: DETAIL_FRAMES * window_s, rows_max: DETAIL_ROWS_MAX };
    let mut detail = RowsBuilder::new(passes.sample_rate_hz(), start_s, rows);
    let surveyed = survey_from_source(passes, config, Some(&mut detail))?;
    let (survey, heard) = (&surveyed.survey, surveyed.heard);
    let detail = Survey::of_rows(detail.finish(heard.to_s));
    let nothing = |reason: NoTone, families: Vec<ToneFamily>| FoundSpeed {
        families,
        rotor: None,
        config: config.clone(),
        analysis: Silence::because(reason).analysis(heard),
        alternatives: Vec::new(),
    };
    if let Err(Silence { reason, .. }) = surveyed.check(config) {
        return Ok(nothing(reason, Vec::new()));
    }
    let (fundamental_hz_min, fundamental_hz_max) =
        config.tone.band_hz.unwrap_or((discovery.config.fundamental_hz_min, discovery.config.fundamental_hz_max));
    let scanned = DiscoveryConfig { fundamental_hz_min, fundamental_hz_max, ..discovery.config };
    let believed = Believed::of(&surveyed, passes.sample_rate_hz(), config, discovery);
    let is_believed = |family: &ToneFamily| believed.as_ref().is_none_or(|it| it.has_lines_in(family, discovery));
    let families = families_from_surveys(survey, &detail, &discovery.known, &scanned, &|family: &ToneFamily| {
        !discovery.wants_all && doubt(family) == Some(0) && (family.is_settled || is_believed(family))
    });
    let by_lines = rotor_among(&families);
    // with the blades given, a family has one reading, and the evidence compares its octaves
    let is_compared = believed.is_some() && discovery.known.blade_count.is_some();
    let is_settled = !is_compared && by_lines.is_some_and(|rotor| families[rotor].is_settled);
    let by_beliefs = families.iter().position(|family| believed.is_some() && !is_settled && is_believed(family));
    let rotor = by_beliefs.or(by_lines);
    let families = Families { all: families, rotor };
    // the evidence knows no gears
    let believed = believed.filter(|_| !families.of_rotor().is_some_and(is_geared));
    if let Some(believed) = believed.as_ref().filter(|_| !is_settled) {
        if let Some(found) = believed.speed(passes, &surveyed, &families, config, discovery)? {
            return Ok(found);
        }
        passes.expect_more(passes_after_survey(config));
    }
    let Some(rotor) = rotor else { return Ok(nothing(NoTone::NoSeries, families.all)) };
    let found = speed_of_family(passes, &surveyed, families.all, rotor, config, discovery)?;
    let Some(believed) = believed.filter(|_| is_settled) else { return Ok(found) };
    match speed_of(&found.analysis, &found.config).zip(found.reading()) {
        Some((speed, reading)) => {
            let answered = at_ratio(reading, speed.speed.rad_s() / reading.speed.rad_s());
            Ok(FoundSpeed { alternatives: believed.objection(answered), ..found })
        }
        None => {
            passes.expect_more(passes_after_survey(&found.config));
            let families = Families { all: found.families.clone(), rotor: Some(rotor) };
            Ok(believed.speed(passes, &surveyed, &families, config, discovery)?.unwrap_or(found))
        }
    }
}

/// Families of lines, and which of them is the rotor's.
struct Families {
    all: Vec<ToneFamily>,
    rotor: Option<usize>,
}

impl Families {
    fn of_rotor(&self) -> Option<&ToneFamily> {
        self.all.get(self.rotor?)
    }
}

/// Whether the most plausible reading of a family is a gear.
fn is_geared(family: &ToneFamily) -> bool {
    family.readings.first().is_some_and(|reading| reading.plausibility > 0.0 && reading.meaning.gear().is_some())
}

/// The strongest family that any reading can explain; brief ones and single lines only where there is no other.
fn rotor_among(families: &[ToneFamily]) -> Option<usize> {
    let possible = families.iter().enumerate().filter_map(|(index, family)| Some((index, doubt(family)?)));
    possible.min_by_key(|&(_, doubt)| doubt).map(|(index, _)| index)
}

/// How little a family looks like a rotor's; `None` where no reading can explain it.
fn doubt(family: &ToneFamily) -> Option<u32> {
    family.readings.first().filter(|reading| reading.plausibility > 0.0)?;
    Some(match family.remark {
        None | Some(Remark::NearMains) => 0,
        Some(Remark::SingleLine) => 1,
        Some(Remark::Brief) => 2,
    })
}

/// The speed that an analysis with these settings found.
fn speed_of<'a>(analysis: &'a SpeedAnalysis, config: &Config) -> Option<&'a SpeedEstimate> {
    match &analysis.outcome {
        Outcome::Ok(tone) => tone.speed(config.method),
        Outcome::NoRotorTone { .. } => None,
    }
}

/// Settings for a reading, whose speed is looked for up to this factor faster or slower.
fn config_for(config: &Config, reading: &Reading, factor: f64) -> Config {
    let mut config = config.clone();
    config.tone.order = reading.order;
    config.tone.blades = reading.meaning.blades();
    config.tone.band_hz = None;
    config.tone.speed_min = RotorSpeed::from_rad_s(reading.speed.rad_s() / factor);
    config.tone.speed_max = RotorSpeed::from_rad_s(reading.speed.rad_s() * factor);
    config
}
