//! A source without a named tone → its tone families, the rotor's among them, and the rotor's speed. No arithmetic of
//! spectra here: that is in `tone/`.

mod by_beliefs;

use crate::config::Config;
use crate::detection::or_mains_hum;
use crate::error::Error;
use crate::pipeline::{passes_after_survey, passes_of_speed, speed_of_heard_rotor};
use crate::stages::{HeardRotor, Silence, Surveyed, at_ratio, heard_instead, survey_from_source};
use crate::survey::{RowSettings, RowsBuilder, Survey};
use crate::thresholds::BELOW_OCTAVE;
use crate::tone::{DiscoveryConfig, families_from_surveys, reading_at, search_range_rev_s};
use by_beliefs::{Believed, BelievedSpeed, SAME_LINE_SHARE};
use hovertone_analysis::{Meaning, NoTone, Outcome, Reading, Remark, SpeedAnalysis, SpeedEstimate, ToneFamily};
use hovertone_signal::SignalSource;
use hovertone_signal::passes::{Passes, Progress};
use hovertone_vehicle::{KnownRotor, Order, RotorSpeed};
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
    /// Whether all families are wanted, or only the rotor's.
    pub wants_all: bool,
}

impl Discovery {
    /// Whether the levels of the lines may deceive about the speed: neither the blades nor the diameter are known.
    pub fn may_be_deceived(&self) -> bool {
        self.known.blade_count.is_none() && self.known.diameter_m.is_none()
    }
}

/// The tone families of a recording, and its rotor's speed as far as the sound tells it.
#[derive(Clone, Debug)]
pub struct FoundSpeed {
    /// The rotor's family first, where there is one; then the others, strongest first, where they are wanted.
    pub families: Vec<ToneFamily>,
    /// Which of them is the rotor's, where one is.
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
/// The evidence compares the shaft speeds of all propellers that are possible, those behind a known gear among them. The most plausible one is
/// analysed as if it had been given: [`crate::speed_from_source`] says how. Where several readings stay plausible they are the `alternatives`,
/// and the speed of the analysis is only that of the first. The families of lines are listed beside it; they decide nothing.
///
/// `config` gives all settings but the tone's order, blades and range of speeds; a band in it is where the fundamental is
/// looked for. Makes the passes over the source that [`passes_of_speed`] names.
///
/// # Errors
/// Settings that mean nothing, a band above half the sample rate, a source that fails. That there is no rotor is an outcome.
pub fn tones_from_source(
    source: &mut dyn SignalSource,
    config: &Config,
    discovery: &Discovery,
    on_progress: &mut dyn FnMut(Progress),
) -> Result<FoundSpeed, Error> {
    tones_from_passes(&mut Passes::planned(source, passes_of_speed(config), on_progress)?, config, discovery)
}

/// The same, where the caller has planned the passes: as many as [`passes_of_speed`] says.
///
/// # Errors
/// As [`tones_from_source`].
pub fn tones_from_passes(passes: &mut Passes<'_>, config: &Config, discovery: &Discovery) -> Result<FoundSpeed, Error> {
    config.check()?;
    discovery.config.check()?;
    discovery.known.check()?;
    if config.tone.band_hz.is_some() {
        // a band that the recording cannot hold is refused before a pass is made
        search_range_rev_s(&config.tone, passes.sample_rate_hz())?;
    }
    let mut detail = discovery.wants_all.then(|| {
        let start_s = config.span.start_s(passes.start_s());
        let window_s = discovery.config.detail_window_s;
        let rows =
            RowSettings { window_s, hop_s: window_s, row_s: DETAIL_FRAMES * window_s, rows_max: DETAIL_ROWS_MAX };
        RowsBuilder::new(passes.sample_rate_hz(), start_s, rows)
    });
    let surveyed = survey_from_source(passes, config, detail.as_mut())?;
    let (survey, heard) = (&surveyed.survey, surveyed.heard);
    let detail = detail.map(|detail| Survey::of_rows(detail.finish(heard.to_s)));
    let nothing = |reason: NoTone| FoundSpeed {
        families: Vec::new(),
        rotor: None,
        config: config.clone(),
        analysis: Silence::because(reason).analysis(heard),
        alternatives: Vec::new(),
    };
    if let Err(Silence { reason, .. }) = surveyed.check(config) {
        return Ok(nothing(reason));
    }
    let (fundamental_hz_min, fundamental_hz_max) =
        config.tone.band_hz.unwrap_or((discovery.config.fundamental_hz_min, discovery.config.fundamental_hz_max));
    let scanned = DiscoveryConfig { fundamental_hz_min, fundamental_hz_max, ..discovery.config };
    let families =
        |rotor_hz: Option<f64>| families_from_surveys(survey, detail.as_ref(), rotor_hz, &discovery.known, &scanned);
    let sample_rate_hz = passes.sample_rate_hz();
    let is_known = discovery.known != KnownRotor::default();
    let instead = || is_known.then(|| heard_instead(&surveyed, sample_rate_hz, config)).flatten();
    let no_series =
        || or_mains_hum(NoTone::NoSeries { only_rev_s: config.tone.known_rev_s(), instead: instead() }, survey);
    let believed = Believed::of(&surveyed, sample_rate_hz, config, discovery);
    let Some(believed) = believed else {
        let families = with_refined_line(passes, &surveyed, families(None), config)?;
        return Ok(FoundSpeed { families, ..nothing(no_series()) });
    };
    let BelievedSpeed { config: found, mut analysis, ratio } = believed.speed(passes, &surveyed, config)?;
    if let Outcome::NoRotorTone { reason: reason @ NoTone::NoSeries { .. } } = &mut analysis.outcome {
        // the range around the believed speed is our own, not the caller's
        *reason = no_series();
    }
    let Some(ratio) = ratio else {
        let families = families(None);
        if families.iter().take(1).any(is_single_line) {
            passes.expect_more(passes_after_survey(config));
        }
        let families = with_refined_line(passes, &surveyed, families, config)?;
        return Ok(FoundSpeed { families, rotor: None, config: found, analysis, alternatives: Vec::new() });
    };
    let mut families = families(Some(believed.fundamental_hz())).into_iter();
    let family = families.next().map(|lines| believed.family(lines, ratio));
    let mesh_hz = |other: &ToneFamily| other.gear_mesh_hz_of(family.as_ref()?);
    let others: Vec<ToneFamily> = families
        .map(|other| match mesh_hz(&other) {
            Some(mesh_hz) => as_mesh(other, mesh_hz),
            None => other,
        })
        .collect();
    Ok(FoundSpeed {
        rotor: family.is_some().then_some(0),
        families: family.into_iter().chain(others).collect(),
        config: found,
        analysis,
        alternatives: believed.alternatives(ratio),
    })
}

/// The family of a gear mesh: the readings of the rotor are its readings, and so is the frequency.
fn as_mesh(mut family: ToneFamily, mesh_hz: f64) -> ToneFamily {
    let ratio = mesh_hz / family.fundamental_hz;
    move_lines(&mut family, ratio);
    ToneFamily { readings: Vec::new(), remark: Some(Remark::GearMesh), ..family }
}

/// Multiplies the frequencies of all lines of a family.
fn move_lines(family: &mut ToneFamily, ratio: f64) {
    family.fundamental_hz *= ratio;
    family.harmonics.iter_mut().for_each(|harmonic| harmonic.hz *= ratio);
}

fn is_single_line(family: &ToneFamily) -> bool {
    family.remark == Some(Remark::SingleLine)
}

/// The families, where the first is a single line, with its frequency from all of the sound: as if it were a tone once a turn.
fn with_refined_line(
    passes: &mut Passes<'_>,
    surveyed: &Surveyed,
    mut families: Vec<ToneFamily>,
    config: &Config,
) -> Result<Vec<ToneFamily>, Error> {
    let Some(line) = families.first_mut().filter(|family| is_single_line(family)) else { return Ok(families) };
    let Ok(once_a_turn) = Order::new(1.0) else { return Ok(families) };
    let speed = RotorSpeed::from_tone_hz(line.fundamental_hz, once_a_turn);
    let found = config_for(config, &reading_at(speed, once_a_turn, Meaning::GivenOrder));
    let rotor = HeardRotor { speed_rev_s: speed.rev_s(), is_faint: false, companions: None };
    let analysis = speed_of_heard_rotor(passes, surveyed, rotor, &found)?;
    let ratio = speed_of(&analysis, &found).map(|found| found.speed.rad_s() / speed.rad_s());
    if let Some(ratio) = ratio.filter(|ratio| (ratio - 1.0).abs() < SAME_LINE_SHARE) {
        move_lines(line, ratio);
        line.readings = line.readings.iter().map(|reading| at_ratio(reading, ratio)).collect();
    }
    Ok(families)
}

/// The speed that an analysis with these settings found.
fn speed_of<'a>(analysis: &'a SpeedAnalysis, config: &Config) -> Option<&'a SpeedEstimate> {
    match &analysis.outcome {
        Outcome::Ok(tone) => tone.speed(config.method),
        Outcome::NoRotorTone { .. } => None,
    }
}

/// Settings for the tone of a reading.
fn config_for(config: &Config, reading: &Reading) -> Config {
    let mut config = config.clone();
    config.tone.order = reading.order;
    config.tone.blades = reading.meaning.blades();
    config.tone.band_hz = None;
    config.tone.speed_min = RotorSpeed::from_rad_s(reading.speed.rad_s() / BELOW_OCTAVE);
    config.tone.speed_max = RotorSpeed::from_rad_s(reading.speed.rad_s() * BELOW_OCTAVE);
    config
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tone::ToneConfig;
    use hovertone_signal::Signal;

    #[test]
    fn a_band_that_the_recording_cannot_hold_is_refused() {
        let tone = ToneConfig { band_hz: Some((3000.0, 5000.0)), ..ToneConfig::of_order(Order::new(1.0).unwrap()) };
        let mut source = Signal::new(vec![0.0; 8000], 8000.0);
        let found = tones_from_source(&mut source, &Config::for_tone(tone), &Discovery::default(), &mut |_| {});
        assert!(matches!(found, Err(Error::BandAboveNyquist { .. })));
    }
}
