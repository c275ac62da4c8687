//! `hovertone tones`: the tone families of recordings and what each can mean.

use crate::args::{KnownArguments, TonesArguments};
use crate::failure::{Ending, Failure};
use crate::progress::Progress;
use crate::recording::{Hearing, Requests, records_of};
use crate::speed::{ending_of, jobs_of};
use crate::terminal::Terminal;
use crate::vehicles::preset;
use hovertone::speed::{Config, ToneConfig};
use hovertone::tones::{Discovery, DiscoveryConfig, KnownRotor};
use hovertone_report::{tones_json, tones_text};
use hovertone_vehicle::Order;

/// Hears all files and prints their families.
pub(crate) fn run(arguments: &TonesArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let (tone, discovery) = discovery_of(&arguments.known, arguments.vehicle.as_deref(), true)?;
    let mut config = Config::for_tone(tone);
    (config.span.from_s, config.span.to_s) = (arguments.from, arguments.to);
    config.check().map_err(|error| Failure::usage(error.to_string(), "see `hovertone tones --help`"))?;
    let jobs = jobs_of(&arguments.files, &config, Some(discovery), Requests::default());
    let hearing = Hearing {
        audio_track: arguments.hearing.audio_track,
        channel: arguments.hearing.channel,
        wants_hash: arguments.json,
        wants_samples: false,
    };
    let progress = Progress::new("listening to", jobs.len(), !arguments.hearing.no_progress);
    let records = records_of(&jobs, hearing, &progress);
    progress.finish();
    if arguments.json {
        for record in &records {
            terminal.data(&(tones_json(record).map_err(Failure::internal)? + "\n"))?;
        }
    } else {
        let blocks: Vec<String> = records.iter().map(tones_text).collect();
        terminal.data(&blocks.join("\n"))?;
    }
    terminal.flush()?;
    terminal.notes(&records.iter().collect::<Vec<_>>());
    Ok(ending_of(&records))
}

/// How a tone is found that nobody names, with what is known of the vehicle; and settings whose order is to be replaced.
/// `wants_all` lists every family, not only those up to the rotor's.
pub(crate) fn discovery_of(
    arguments: &KnownArguments,
    vehicle: Option<&str>,
    wants_all: bool,
) -> Result<(ToneConfig, Discovery), Failure> {
    let of_vehicle = vehicle.map(preset).transpose()?.map(KnownRotor::of_vehicle).unwrap_or_default();
    let known = KnownRotor {
        diameter_m: arguments.diameter_m.or(of_vehicle.diameter_m),
        mass_kg: arguments.mass_kg.or(of_vehicle.mass_kg),
        rotor_count: arguments.rotors.or(of_vehicle.rotor_count),
        ..of_vehicle
    };
    known
        .check()
        .map_err(|error| Failure::usage(error.to_string(), "give metres, kilograms and a number of rotors"))?;
    let order = Order::new(1.0).map_err(Failure::internal)?;
    Ok((ToneConfig::of_order(order), Discovery { config: DiscoveryConfig::default(), known, wants_all }))
}
