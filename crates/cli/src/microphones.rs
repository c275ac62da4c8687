//! Which rotor is which, by several microphones at known positions.

use crate::args::LabelArguments;
use crate::failure::Failure;
use crate::labels::{notice_of, refuse_fewer_than_two, with_known_frame};
use crate::progress::{Progress, Share};
use crate::recording::{Heard, Hearing, Job};
use crate::toml_file::{NO_RECORDING, TomlFile};
use hovertone::rotors::{
    ArrayError, MicrophoneArray, MicrophoneLines, MicrophonesConfig, NotTold, PlacedRotor, labels_from_microphones,
    microphone_lines_from_source,
};
use hovertone::speed::TrackPoint;
use hovertone_report::{Notice, NoticeKind};
use hovertone_vehicle::Vehicle;
use serde::Deserialize;

const SEE_EXAMPLE: &str = "docs/formats.md shows an example of a file of microphones";

/// The file of microphones.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MicrophonesFile {
    position_std_m: Option<f64>,
    gain_std_db: Option<f64>,
    temperature_c: Option<f64>,
    #[serde(rename = "microphone", default)]
    microphones: Vec<MicrophoneSection>,
    #[serde(rename = "rotor", default)]
    rotors: Vec<RotorSection>,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MicrophoneSection {
    position_m: [f64; 3],
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct RotorSection {
    name: String,
    position_m: [f64; 3],
}

/// The meaning of the file.
pub(crate) struct ArrayPlan {
    array: MicrophoneArray,
    config: MicrophonesConfig,
    hearing: Hearing,
}

/// Reads the file, where the arguments name one, and compares the number of microphones with the channels of the recordings.
pub(crate) fn resolve(
    arguments: &LabelArguments,
    vehicle: Option<&Vehicle>,
    jobs: &[Job],
    hearing: Hearing,
    rotors: u32,
) -> Result<Option<ArrayPlan>, Failure> {
    let Some(path) = &arguments.microphones else { return Ok(None) };
    let refused = |what: String, hint: &str| Failure::Usage { what, hint: hint.to_owned(), path: Some(path.clone()) };
    refuse_fewer_than_two(rotors, "--microphones")?;
    let file: MicrophonesFile =
        TomlFile::read(path, "file of microphones", NO_RECORDING, SEE_EXAMPLE)?.with_content()?.parse()?;
    let defaults = MicrophonesConfig::default();
    let config = MicrophonesConfig {
        position_std_m: file.position_std_m.unwrap_or(defaults.position_std_m),
        gain_std_db: file.gain_std_db.unwrap_or(defaults.gain_std_db),
        temperature_c: file.temperature_c.unwrap_or(defaults.temperature_c),
        ..defaults
    };
    config.check().map_err(|error| refused(error.to_string(), SEE_EXAMPLE))?;
    let given = file.rotors.into_iter().map(|RotorSection { name, position_m }| PlacedRotor { name, position_m });
    let given: Vec<PlacedRotor> = given.collect();
    let Some(places) = Some(given).filter(|given| !given.is_empty()).or_else(|| places_of(vehicle?)) else {
        return Err(refused(
            "this file has no places of the rotors".to_owned(),
            &format!(
                "add a [[rotor]] with name and position_m for each rotor, or give --vehicle with {}",
                with_known_frame()
            ),
        ));
    };
    let microphones_m = file.microphones.iter().map(|microphone| microphone.position_m).collect();
    let array = MicrophoneArray::new(microphones_m, places).map_err(|error| {
        let hint = match error {
            ArrayError::TooFewMicrophones { .. } => "add a [[microphone]] with its position_m for each channel",
            ArrayError::WrongRotorCount { .. } => "add a [[rotor]] with name and position_m for each rotor",
            _ => "correct its position_m: metres in the vehicle's frame",
        };
        refused(error.to_string(), hint)
    })?;
    if array.rotor_count() != rotors as usize {
        let what = format!(
            "{rotors} rotors turn, but the number of rotors with a position is {}: the two numbers must be equal",
            array.rotor_count()
        );
        return Err(refused(what, "give the number of rotors with --rotors, and one [[rotor]] for each of them"));
    }
    for job in jobs {
        check_channels(job, hearing, &array)?;
    }
    Ok(Some(ArrayPlan { array, config, hearing }))
}

/// The rotors of a vehicle with known frame.
fn places_of(vehicle: &Vehicle) -> Option<Vec<PlacedRotor>> {
    let known = vehicle.flight_parameters()?;
    let placed = known
        .layout
        .value
        .places(known.arm_length_m.value)
        .map(|place| PlacedRotor { name: place.name.to_owned(), position_m: [place.x_m, place.y_m, 0.0] });
    Some(placed.to_vec())
}

/// Refuses a recording whose number of channels is not the number of microphones. A recording that cannot be opened fails later.
fn check_channels(job: &Job, hearing: Hearing, array: &MicrophoneArray) -> Result<(), Failure> {
    let Ok(recording) = job.open(Hearing { channel: None, ..hearing }) else { return Ok(()) };
    let (channels, microphones) = (recording.info().channel_count, array.microphone_count());
    if channels == microphones {
        return Ok(());
    }
    Err(Failure::Usage {
        what: NotTold::OtherChannels { channels, microphones }.to_string(),
        hint: "give one [[microphone]] for each channel, in the sequence of the channels; --audio-track N chooses another track of the file"
            .to_owned(),
        path: Some(job.path.clone()),
    })
}

/// Labels the rotors of all recordings in another pass over each channel, with a notice where a label is missing.
pub(crate) fn label_all(all: &mut [Heard], jobs: &[Job], plan: &ArrayPlan, wants_progress: bool) {
    let progress = Progress::new("comparing the microphones of", all.len(), wants_progress);
    for (heard, job) in all.iter_mut().zip(jobs) {
        label(heard, job, plan, &mut progress.recording());
    }
    progress.finish();
}

fn label(heard: &mut Heard, job: &Job, plan: &ArrayPlan, share: &mut Share<'_>) {
    let Heard { record, config, .. } = heard;
    let Some(facts) = record.recording.as_ref().filter(|_| record.speed().is_some()) else { return };
    let tracks: Vec<&[TrackPoint]> = record.rotors().iter().map(|rotor| rotor.track.as_slice()).collect();
    let channels = plan.array.microphone_count();
    let end_s = tracks.iter().filter_map(|track| track.last()).map(|point| point.time_s).fold(0.0, f64::max);
    let mut channel_lines: Vec<MicrophoneLines> = Vec::new();
    for channel in 1..=channels {
        let hearing = Hearing { audio_track: Some(facts.audio_track), channel: Some(channel), ..plan.hearing };
        let mut on_progress = |progress: hovertone::sound::Progress| {
            share.set(((channel - 1) as f64 + (progress.time_s / end_s).clamp(0.0, 1.0)) / channels as f64);
        };
        let lines = job.open(hearing).map_err(|error| error.to_string()).and_then(|mut recording| {
            microphone_lines_from_source(&mut recording, &tracks, &config.tone, &plan.config, &mut on_progress)
                .map_err(|error| error.to_string())
        });
        match lines {
            Ok(lines) => channel_lines.push(lines),
            Err(error) => {
                let text = format!("no rotor is named, because channel {channel} could not be heard: {error}");
                let hint = "leave the file in its place while hovertone hears it, and run the command again";
                record.notices.push(Notice::new(text, hint).of_kind(NoticeKind::NoNames));
                return;
            }
        }
    }
    let labels = labels_from_microphones(&channel_lines, &plan.array, &plan.config);
    record.notices.extend(notice_of(&labels));
    record.labels = Some(labels);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::recording::Requests;
    use hovertone::speed::{Config, ToneConfig};
    use hovertone_media::Samples;
    use hovertone_vehicle::Order;

    /// The sound is that of the job, which need not be a file on a disk.
    #[test]
    fn the_channels_of_a_sound_that_is_no_file_are_counted() {
        let config = Config::for_tone(ToneConfig::of_order(Order::from_blades(2).unwrap()));
        let samples = Some(Samples::new(vec![0.0; 9600].into(), 3, 48_000.0));
        let (path, name) = ("s3://bucket/hover.wav".into(), "hover.wav".to_owned());
        let job = Job { path, name, config, discovery: None, requests: Requests::default(), sha256: None, samples };
        let array = |microphones: usize| {
            let rotor = |x_m: f64| PlacedRotor { name: format!("{x_m}"), position_m: [x_m, 0.0, 0.0] };
            MicrophoneArray::new(vec![[1.0, 0.0, 0.0]; microphones], vec![rotor(0.1), rotor(-0.1)]).unwrap()
        };
        // where one channel is heard, the recording still has all of them
        let hearing = Hearing { channel: Some(2), ..Hearing::default() };
        assert!(check_channels(&job, hearing, &array(3)).is_ok());
        assert!(matches!(check_channels(&job, hearing, &array(2)), Err(Failure::Usage { .. })));
    }
}
