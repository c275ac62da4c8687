//! The settings of an analysis, from the arguments about tone, vehicle and analysis.

use crate::args::{AnalysisArguments, KnownArguments, ToneArguments, TonesArguments};
use crate::caller::typed_words;
use crate::failure::Failure;
use crate::see_help::see_help;
use crate::vehicles::preset;
use hovertone::speed::{Config, Method, NoTone, Outcome, SpanConfig, ToneConfig};
use hovertone::tones::{Discovery, KnownRotor};
use hovertone_report::{Notice, SpeedRecord};
use hovertone_vehicle::{RotorSpeed, check_not_negative, check_tips};
use hovertone_workflow::{NoSettings, Said};

/// The settings of an analysis. The second part is the search for the tone, where the arguments do not name its order.
pub(crate) fn config_of(
    asked: &ToneArguments,
    known: &KnownArguments,
    analysis: &AnalysisArguments,
) -> Result<(Config, Option<Discovery>), Failure> {
    let said = Said {
        method: analysis.method,
        mean_only: analysis.mean_only,
        span: span_of(analysis.from, analysis.to)?,
        ..said_of(asked, known)?
    };
    let (mut config, discovery) = said.settings()?;
    check_read(analysis, config.method)?;
    config.budget.clock_ppm = analysis.clock_ppm.unwrap_or(config.budget.clock_ppm);
    config.budget.radial_speed_m_s_max = analysis.radial_speed_m_s_max.unwrap_or(config.budget.radial_speed_m_s_max);
    config.budget.drift_m_max = analysis.drift_m_max.unwrap_or(config.budget.drift_m_max);
    config.spectrogram.window_s = analysis.window_s;
    config.spectrogram.hop_share = analysis.hop_share.unwrap_or(config.spectrogram.hop_share);
    let threshold_share = analysis.gaussian_threshold_share;
    config.ridge.gaussian_threshold_share = threshold_share.unwrap_or(config.ridge.gaussian_threshold_share);
    config.check()?;
    Ok((config, discovery))
}

/// Refuses settings of the paper's methods where another method reads the speed.
fn check_read(analysis: &AnalysisArguments, method: Method) -> Result<(), Failure> {
    const OF_RIDGES: &str = "--method maximum_trace or --method gaussian";
    let reads_no_ridges = !method.reads_ridges();
    let flags = [
        (
            analysis.gaussian_threshold_share.is_some() && method != Method::Gaussian,
            "--gaussian-threshold-share",
            "--method gaussian",
        ),
        (analysis.hop_share.is_some() && reads_no_ridges, "--hop-share", OF_RIDGES),
        (analysis.window_s.is_some() && reads_no_ridges, "--window-s", OF_RIDGES),
    ];
    let Some((_, flag, methods)) = flags.into_iter().find(|(is_unused, ..)| *is_unused) else { return Ok(()) };
    let what = format!("{flag} changes nothing, because the method {} does not use it", method.name());
    Err(Failure::usage(what, format!("leave {flag} out, or give {methods}")))
}

/// Refuses what tells only of the ± and of the shaft's lines, where neither is shown.
pub(crate) fn refuse_of_table(analysis: &AnalysisArguments, why: &str) -> Result<(), Failure> {
    let flags = [
        ("--condition", analysis.condition),
        ("--clock-ppm", analysis.clock_ppm.is_some()),
        ("--drift-m-max", analysis.drift_m_max.is_some()),
        ("--radial-speed-m-s-max", analysis.radial_speed_m_s_max.is_some()),
    ];
    match flags.into_iter().find(|(_, is_given)| *is_given) {
        Some((flag, _)) => Err(Failure::usage(
            format!("{flag} changes nothing: {why}"),
            format!("leave {flag} out here; it works with `hovertone speed`"),
        )),
        None => Ok(()),
    }
}

/// The tone that the arguments name; `None` where it has to be searched for.
pub(crate) fn tone_of(arguments: &ToneArguments) -> Result<Option<ToneConfig>, Failure> {
    Ok(said_of(arguments, &KnownArguments::default())?.tone()?)
}

/// What the arguments say of tone and vehicle.
fn said_of(asked: &ToneArguments, known: &KnownArguments) -> Result<Said<'static>, Failure> {
    Ok(Said {
        vehicle: asked.vehicle.as_deref().map(preset).transpose()?,
        blades: asked.blades,
        gear: asked.gear,
        order: asked.order,
        band_hz: asked.band,
        harmonics: asked.harmonics,
        ..said_of_known(known)
    })
}

fn said_of_known(known: &KnownArguments) -> Said<'static> {
    Said { diameter_m: known.diameter_m, mass_kg: known.mass_kg, rotors: known.rotors, ..Said::default() }
}

impl From<NoSettings> for Failure {
    fn from(error: NoSettings) -> Self {
        match error {
            NoSettings::Config(error) => error.into(),
            NoSettings::Quantity(error) => error.into(),
            NoSettings::Contradiction(error) => error.into(),
            error => Self::usage(error.to_string(), see_help(&typed_words())),
        }
    }
}

/// The part of a recording that the arguments name. A recording begins at 0 s.
pub(crate) fn span_of(from_s: Option<f64>, to_s: Option<f64>) -> Result<SpanConfig, Failure> {
    for (name, time_s) in [("--from", from_s), ("--to", to_s)] {
        let hint = "the recording begins at 0 s: give seconds from its beginning";
        let checked = time_s.map_or(Ok(()), |time_s| check_not_negative(name, time_s));
        checked.map_err(|error| Failure::usage(error.to_string(), hint))?;
    }
    Ok(SpanConfig { from_s, to_s })
}

/// Says that a given mass changes nothing, where a fact that it needs beside it is missing.
pub(crate) fn idle_mass(arguments: &KnownArguments, known: &KnownRotor) -> Option<Notice> {
    let needs = match (known.diameter_m, known.rotor_count) {
        (Some(_), Some(_)) => return None,
        (None, Some(_)) => "--diameter-m",
        (Some(_), None) => "--rotors",
        (None, None) => "--diameter-m and --rotors",
    };
    arguments.mass_kg?;
    let what = format!(
        "--mass-kg changes nothing without {needs}: together they rule out speeds that cannot carry the vehicle"
    );
    Some(Notice::new(what, format!("give {needs} too, or leave --mass-kg out")))
}

/// Refuses the diameter of the arguments where the blade tips of a heard rotor would be faster than any multirotor's.
pub(crate) fn check_tips_heard(known: &KnownArguments, records: &[SpeedRecord]) -> Result<(), Failure> {
    let Some(diameter_m) = known.diameter_m else { return Ok(()) };
    let mut speeds = records.iter().filter_map(|record| Some(record.speed()?.speed));
    Ok(speeds.try_for_each(|speed| check_tips(diameter_m, speed))?)
}

/// The same where the diameter rules out the one rotor that is heard, with the blades that are given or any.
pub(crate) fn check_tips_ruled_out(
    known: &KnownArguments,
    blades: Option<u32>,
    records: &[SpeedRecord],
) -> Result<(), Failure> {
    let Some(diameter_m) = known.diameter_m else { return Ok(()) };
    let instead = records.iter().filter_map(|record| match &record.analysis()?.outcome {
        Outcome::NoRotorTone { reason: NoTone::NoSeries { instead, .. } } => *instead,
        _ => None,
    });
    let mut fitting = instead.filter(|other| blades.is_none_or(|blades| blades == other.blades));
    Ok(fitting.try_for_each(|other| check_tips(diameter_m, RotorSpeed::from_rev_s(other.speed_rev_s)))?)
}

/// The search for all families of tones with the facts about the vehicle, and settings for it whose order is a placeholder.
pub(crate) fn search_of(arguments: &TonesArguments) -> Result<(ToneConfig, Discovery), Failure> {
    let vehicle = arguments.vehicle.as_deref().map(preset).transpose()?;
    Ok(Said { vehicle, blades: arguments.blades, ..said_of_known(&arguments.known) }.discovery(true)?)
}
