//! A source without a named tone → its tone families, the rotor's among them, and the rotor's speed. No arithmetic of
//! spectra here: that is in `tone/`.

use crate::config::Config;
use crate::error::Error;
use crate::pipeline::{passes_after_survey, passes_of_speed, speed_from_survey};
use crate::stages::{Silence, survey_from_source};
use crate::survey::{RowSettings, RowsBuilder, Survey};
use crate::tone::{DiscoveryConfig, families_from_surveys};
use hovertone_analysis::{NoTone, Outcome, Reading, Remark, SpeedAnalysis, SpeedEstimate, ToneFamily};
use hovertone_signal::SignalSource;
use hovertone_signal::passes::{Passes, Progress};
use hovertone_vehicle::{KnownRotor, RotorSpeed};
use serde::Serialize;

/// Other speeds of the same rotor are looked for up to this factor: below an octave, so that it stays settled.
const OTHER_SPEED_FACTOR: f64 = 1.9;
/// The analysis must find the family's own tone, within this share.
const SAME_TONE_SHARE: f64 = 0.08;
/// Rows of the finer spectrum that are kept: 64 of a second are 6 MB at 44.1 kHz.
const DETAIL_ROWS_MAX: usize = 64;
/// Frames of the finer spectrum to a row. They follow each other without overlap, which costs half as much.
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
/// The strongest family that a rotor can make (not a brief one, where there is another) is read in its most plausible way,
/// and then analysed as if its order had been given: [`crate::speed_from_source`] says how, and whether it is a rotor.
/// When several readings stay plausible they are the `alternatives`, and the speed of the analysis is only the first's.
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
    let families = families_from_surveys(survey, &detail, &discovery.known, &scanned, &|family: &ToneFamily| {
        !discovery.wants_all && doubt(family) == Some(0)
    });
    let Some(rotor) = rotor_among(&families) else { return Ok(nothing(NoTone::NoSeries, families)) };
    let Some(first) = families[rotor].readings.first() else { return Ok(nothing(NoTone::NoSeries, families)) };
    let mut config_of_found = config.clone();
    config_of_found.ridge.company_share_min = config.ridge.company_share_min.max(discovery.config.company_share_min);
    let mut is_first = true;
    let mut analysed = |reading: &Reading, factor: f64| -> Result<(Config, SpeedAnalysis), Error> {
        let found = config_for(&config_of_found, reading, factor);
        if !std::mem::take(&mut is_first) {
            passes.expect_more(passes_after_survey(&found));
        }
        let analysis = speed_from_survey(passes, &surveyed, &found)?;
        Ok((found, analysis))
    };
    let mut reading = first;
    let (mut found, mut analysis) = analysed(reading, OTHER_SPEED_FACTOR)?;
    // lines that one reading cannot explain refute it, not the others
    let is_refuted = |analysis: &SpeedAnalysis| {
        matches!(analysis.outcome, Outcome::NoRotorTone { reason: NoTone::ForeignSeries { .. } })
    };
    for other in families[rotor].plausible_readings(discovery.config.plausible_min).into_iter().skip(1) {
        if !is_refuted(&analysis) {
            break;
        }
        let next = analysed(other, OTHER_SPEED_FACTOR)?;
        if !is_refuted(&next.1) {
            (reading, (found, analysis)) = (other, next);
        }
    }
    if !speed_of(&analysis, &found).is_none_or(|speed| is_near(speed.speed, reading)) {
        (found, analysis) = analysed(reading, 1.0 + SAME_TONE_SHARE)?;
    }
    let alternatives = match speed_of(&analysis, &found) {
        Some(speed) if !families[rotor].is_settled => {
            alternatives_of(&families[rotor], reading, speed, &discovery.config)
        }
        _ => Vec::new(),
    };
    Ok(FoundSpeed { rotor: Some(rotor), config: found, analysis, alternatives, families })
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

fn config_for(config: &Config, reading: &Reading, factor: f64) -> Config {
    let mut config = config.clone();
    config.tone.order = reading.order;
    config.tone.blades = reading.meaning.blades();
    config.tone.band_hz = None;
    config.tone.speed_min = RotorSpeed::from_rad_s(reading.speed.rad_s() / factor);
    config.tone.speed_max = RotorSpeed::from_rad_s(reading.speed.rad_s() * factor);
    config
}

fn speed_of<'a>(analysis: &'a SpeedAnalysis, config: &Config) -> Option<&'a SpeedEstimate> {
    match &analysis.outcome {
        Outcome::Ok(tone) => tone.speed(config.method),
        Outcome::NoRotorTone { .. } => None,
    }
}

fn is_near(speed: RotorSpeed, reading: &Reading) -> bool {
    (speed.rad_s() / reading.speed.rad_s() - 1.0).abs() < SAME_TONE_SHARE
}

/// The plausible readings with the speeds that the analysis gives them: it knows the tone better than the survey.
fn alternatives_of(
    family: &ToneFamily,
    analysed: &Reading,
    speed: &SpeedEstimate,
    config: &DiscoveryConfig,
) -> Vec<Reading> {
    let ratio = speed.speed.rad_s() / analysed.speed.rad_s();
    let scaled = |speed: RotorSpeed| RotorSpeed::from_rad_s(ratio * speed.rad_s());
    let plausible = family.plausible_readings(config.plausible_min).into_iter().cloned();
    plausible
        .map(|reading| Reading {
            tone_hz: ratio * reading.tone_hz,
            speed: scaled(reading.speed),
            motor_speed: scaled(reading.motor_speed),
            tip_mach: reading.tip_mach.map(|mach| ratio * mach),
            thrust_coefficient: reading.thrust_coefficient.map(|coefficient| coefficient / ratio.powi(2)),
            ..reading
        })
        .collect()
}
