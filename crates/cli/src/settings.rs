//! The settings of an analysis, from the arguments about tone, vehicle and analysis.

use crate::args::{AnalysisArguments, KnownArguments, ToneArguments};
use crate::failure::Failure;
use crate::vehicles::preset;
use hovertone::speed::{Config, Method, SpanConfig, ToneConfig};
use hovertone::tones::{Discovery, DiscoveryConfig, KnownRotor};
use hovertone_report::SpeedRecord;
use hovertone_vehicle::{Gear, Order, SaidOfVehicle, check_not_negative, check_tips};

/// The settings of an analysis. The second part is the search for the tone, where the arguments do not name its order.
pub(crate) fn config_of(
    asked: &ToneArguments,
    known: &KnownArguments,
    analysis: &AnalysisArguments,
) -> Result<(Config, Option<Discovery>), Failure> {
    let (tone, discovery) = match tone_of(asked)? {
        Some(tone) => (tone, None),
        None => {
            let (tone, discovery) = discovery_of(known, asked.vehicle.as_deref(), false)?;
            let harmonics = asked.harmonics.unwrap_or(tone.harmonics);
            (ToneConfig { band_hz: asked.band, harmonics, ..tone }, Some(discovery))
        }
    };
    let mut config = Config::for_tone(tone);
    config.known = known_of(known, asked.vehicle.as_deref())?;
    config.rotors.count = config.known.rotor_count.unwrap_or(config.rotors.count);
    // where nothing is said of the tone, the number of rotors is not searched for
    config.rotors.is_count_known = config.known.rotor_count.is_some() || discovery.is_some();
    let may_be_several = !config.rotors.is_count_known || config.rotors.count > 1;
    let default = if may_be_several && !analysis.mean_only { Method::Separated } else { Method::Harmonic };
    config.method = analysis.method.unwrap_or(default);
    config.budget.clock_ppm = analysis.clock_ppm.unwrap_or(config.budget.clock_ppm);
    config.budget.radial_speed_m_s_max = analysis.radial_speed_m_s_max.unwrap_or(config.budget.radial_speed_m_s_max);
    config.budget.drift_m_max = analysis.drift_m_max.unwrap_or(config.budget.drift_m_max);
    config.span = span_of(analysis.from, analysis.to)?;
    config.spectrogram.window_s = analysis.window_s;
    config.spectrogram.hop_share = analysis.hop_share.unwrap_or(config.spectrogram.hop_share);
    let threshold_share = analysis.gaussian_threshold_share;
    config.ridge.gaussian_threshold_share = threshold_share.unwrap_or(config.ridge.gaussian_threshold_share);
    config.check()?;
    Ok((config, discovery))
}

/// The tone that the arguments name: `--order` has priority, then the gear, then the blades, as given or as the vehicle has them. A known
/// number of blades helps to find the tone of a gear. `None` where the tone has to be searched for.
pub(crate) fn tone_of(arguments: &ToneArguments) -> Result<Option<ToneConfig>, Failure> {
    let vehicle = arguments.vehicle.as_deref().map(preset).transpose()?;
    arguments.gear.map_or(Ok(()), Gear::check)?;
    let order = arguments.order.map(Order::new).transpose()?;
    let said = SaidOfVehicle { blades: arguments.blades, gear: arguments.gear, order, ..SaidOfVehicle::default() };
    vehicle.map_or(Ok(()), |vehicle| vehicle.check_said(&said))?;
    let blades = arguments.blades.or_else(|| Some(vehicle?.blade_count?.value));
    let gear = arguments.gear.or_else(|| Some(vehicle?.gear?.value));
    let order = match (order, gear, blades) {
        (Some(order), ..) => Ok(order),
        (None, Some(gear), _) => gear.mesh_order(),
        (None, None, Some(blades)) => Order::from_blades(blades),
        (None, None, None) => return Ok(None),
    };
    let tone = ToneConfig::of_order(order?);
    let known = vehicle.and_then(|vehicle| vehicle.shaft_speed.as_ref());
    let tone = known.map_or_else(|| tone.clone(), |known| tone.clone().within(&known.value));
    let tone = ToneConfig {
        blades,
        band_hz: arguments.band,
        harmonics: arguments.harmonics.unwrap_or(tone.harmonics),
        ..tone
    };
    // an order alone may be that of another source, such as a signal generator
    if gear.is_some() || blades.is_some() {
        tone.check_band()?;
    }
    Ok(Some(tone))
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

/// Refuses the diameter of the arguments where the blade tips of a heard rotor would be faster than any multirotor's.
pub(crate) fn check_tips_heard(known: &KnownArguments, records: &[SpeedRecord]) -> Result<(), Failure> {
    let Some(diameter_m) = known.diameter_m else { return Ok(()) };
    let mut speeds = records.iter().filter_map(|record| Some(record.speed()?.speed));
    Ok(speeds.try_for_each(|speed| check_tips(diameter_m, speed))?)
}

/// The search for a tone of unknown order with the facts about the vehicle, and settings for it whose order is a placeholder.
/// `wants_all` lists all families of tones; otherwise the search ends at the family of the rotor.
pub(crate) fn discovery_of(
    arguments: &KnownArguments,
    vehicle: Option<&str>,
    wants_all: bool,
) -> Result<(ToneConfig, Discovery), Failure> {
    let known = known_of(arguments, vehicle)?;
    let order = Order::new(1.0).map_err(Failure::internal)?;
    Ok((ToneConfig::of_order(order), Discovery { config: DiscoveryConfig::default(), known, wants_all }))
}

/// What is known of the rotors before they are heard: the arguments, and for the rest the vehicle.
fn known_of(arguments: &KnownArguments, vehicle: Option<&str>) -> Result<KnownRotor, Failure> {
    let vehicle = vehicle.map(preset).transpose()?;
    let of_vehicle = vehicle.map(KnownRotor::of_vehicle).unwrap_or_default();
    let known = KnownRotor {
        diameter_m: arguments.diameter_m.or(of_vehicle.diameter_m),
        mass_kg: arguments.mass_kg.or(of_vehicle.mass_kg),
        rotor_count: arguments.rotors.or(of_vehicle.rotor_count),
        ..of_vehicle
    };
    known.check().map_err(|error| {
        Failure::usage(
            error.to_string(),
            "give the diameter in metres, the mass in kilograms, and the number of rotors",
        )
    })?;
    let said = SaidOfVehicle { rotors: arguments.rotors, mass_kg: arguments.mass_kg, ..SaidOfVehicle::default() };
    vehicle.map_or(Ok(()), |vehicle| vehicle.check_said(&said))?;
    // all rotors of a vehicle carry it, also where fewer of them turn on a bench
    KnownRotor { rotor_count: of_vehicle.rotor_count.or(arguments.rotors), ..known }.check_hover()?;
    Ok(known)
}
