//! `hovertone speed`: rotor speeds of recordings.

use crate::args::{AnalysisArguments, KnownArguments, SpeedArguments, ToneArguments};
use crate::failure::{Ending, Failure};
use crate::files::files_of;
use crate::labels::{LabelPlan, label};
use crate::microphones::{ArrayPlan, label_all};
use crate::progress::Progress;
use crate::recording::{Hearing, Job, Requests, hear_all};
use crate::terminal::Terminal;
use crate::tones::discovery_of;
use crate::vehicles::preset;
use hovertone::speed::{Config, Method, ToneConfig};
use hovertone::tones::Discovery;
use hovertone_report::{SpeedRecord, condition_table, speed_json, speed_table, track_csv};
use hovertone_vehicle::Order;
use std::path::PathBuf;

/// What the arguments mean.
struct Plan {
    jobs: Vec<Job>,
    hearing: Hearing,
    track: Option<PathBuf>,
    labels: Option<LabelPlan>,
    microphones: Option<ArrayPlan>,
}

/// Hears all files and prints their speeds.
pub(crate) fn run(arguments: &SpeedArguments, terminal: &mut Terminal) -> Result<Ending, Failure> {
    let plan = resolve(arguments)?;
    let progress = Progress::new("listening to", plan.jobs.len(), !arguments.hearing.no_progress);
    let mut heard = hear_all(&plan.jobs, plan.hearing, &progress);
    progress.finish();
    if let Some(labels) = &plan.labels {
        heard.iter_mut().for_each(|heard| label(heard, labels));
    }
    if let Some(array) = &plan.microphones {
        label_all(&mut heard, &plan.jobs, array, !arguments.hearing.no_progress);
    }
    let records: Vec<SpeedRecord> = heard.into_iter().map(|heard| heard.record).collect();
    if arguments.json {
        for record in &records {
            terminal.data(&(speed_json(record).map_err(Failure::internal)? + "\n"))?;
        }
    } else {
        terminal.data(&speed_table(&records))?;
        if let Some(table) = condition_table(&records) {
            terminal.data(&format!("\n{table}"))?;
        }
    }
    terminal.flush()?;
    terminal.notes(&records.iter().collect::<Vec<_>>());
    if let Some(path) = plan.track {
        let track = track_csv(&records).map_err(Failure::internal)?;
        std::fs::write(&path, track).map_err(|error| Failure::cannot_write(&error, &path))?;
    }
    Ok(ending_of(&records))
}

/// How a run over these recordings ended.
pub(crate) fn ending_of<'a>(records: impl IntoIterator<Item = &'a SpeedRecord>) -> Ending {
    let ending = |record: &SpeedRecord| match record {
        record if record.has_failed() => Ending::FilesFailed,
        record if record.is_incomplete() => Ending::Incomplete,
        _ => Ending::Done,
    };
    records.into_iter().map(ending).max().unwrap_or(Ending::Done)
}

fn resolve(arguments: &SpeedArguments) -> Result<Plan, Failure> {
    let (config, discovery) = config_of(&arguments.tone, &arguments.known, &arguments.analysis)?;
    let requests = Requests { condition: arguments.analysis.condition, spin_up: arguments.labels.spin_up.is_some() };
    let jobs = jobs_of(&arguments.files, &config, discovery, requests);
    let hearing = Hearing {
        audio_track: arguments.hearing.audio_track,
        channel: arguments.hearing.channel,
        wants_hash: arguments.json,
        wants_samples: false,
    };
    let vehicle = arguments.tone.vehicle.as_deref().map(preset).transpose()?;
    let labels = crate::labels::resolve(&arguments.labels, vehicle, (jobs.len(), config.rotors.count))?;
    let microphones = crate::microphones::resolve(&arguments.labels, vehicle, (&jobs, hearing), config.rotors.count)?;
    Ok(Plan { jobs, hearing, track: arguments.track.clone(), labels, microphones })
}

/// One job for each file, all alike.
pub(crate) fn jobs_of(
    names: &[PathBuf],
    config: &Config,
    discovery: Option<Discovery>,
    requests: Requests,
) -> Vec<Job> {
    let mut jobs = Vec::new();
    for name in names {
        let files = files_of(name);
        // a pattern without files stays in the list, so that its failure has a place in the output
        let files = if files.is_empty() { vec![name.clone()] } else { files };
        jobs.extend(files.into_iter().map(|path| Job {
            name: path.display().to_string(),
            path,
            config: config.clone(),
            discovery,
            requests,
        }));
    }
    jobs
}

/// The settings, and how the tone is found where nothing tells which it is.
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
    let of_vehicle = asked.vehicle.as_deref().map(preset).transpose()?.map(|vehicle| vehicle.rotor_count.value);
    config.rotors.count = known.rotors.or(of_vehicle).unwrap_or(config.rotors.count);
    config.method = analysis.method.unwrap_or(Method::for_rotors(config.rotors.count));
    config.budget.clock_ppm = analysis.clock_ppm.unwrap_or(config.budget.clock_ppm);
    config.budget.radial_speed_m_s_max = analysis.radial_speed_m_s_max.unwrap_or(config.budget.radial_speed_m_s_max);
    config.budget.drift_m_max = analysis.drift_m_max.unwrap_or(config.budget.drift_m_max);
    config.span.from_s = analysis.from;
    config.span.to_s = analysis.to;
    config.spectrogram.window_s = analysis.window_s;
    config.spectrogram.hop_share = analysis.hop_share.unwrap_or(config.spectrogram.hop_share);
    let threshold_share = analysis.gaussian_threshold_share;
    config.ridge.gaussian_threshold_share = threshold_share.unwrap_or(config.ridge.gaussian_threshold_share);
    config.check().map_err(|error| Failure::usage(error.to_string(), "see `hovertone speed --help`"))?;
    Ok((config, discovery))
}

/// The tone that is meant: `--order` wins, then the gear, then the blades, then the vehicle. Blades that are known
/// beside a gear help to find its tone. `None` where it has to be found.
pub(crate) fn tone_of(arguments: &ToneArguments) -> Result<Option<ToneConfig>, Failure> {
    let vehicle = arguments.vehicle.as_deref().map(preset).transpose()?;
    let blades = arguments.blades.or_else(|| Some(vehicle?.blade_count?.value));
    let order = match (arguments.order, arguments.gear, arguments.blades, vehicle) {
        (Some(lines_per_turn), ..) => Order::new(lines_per_turn),
        (None, Some(gear), ..) => gear.mesh_order(),
        (None, None, Some(blades), _) => Order::from_blades(blades),
        (None, None, None, Some(vehicle)) => match vehicle.tone_order() {
            Some(order) => Ok(order),
            None => return Ok(None),
        },
        (None, None, None, None) => return Ok(None),
    };
    let order = order.map_err(|error| Failure::usage(error.to_string(), "see `hovertone speed --help`"))?;
    let tone = ToneConfig::of_order(order);
    let known = vehicle.and_then(|vehicle| vehicle.shaft_speed.as_ref());
    let mut tone = known.map_or_else(|| tone.clone(), |known| tone.clone().within(&known.value));
    tone.blades = blades;
    tone.band_hz = arguments.band;
    tone.harmonics = arguments.harmonics.unwrap_or(tone.harmonics);
    Ok(Some(tone))
}
