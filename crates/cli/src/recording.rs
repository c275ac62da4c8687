//! Recordings to answers: the one place that knows how files are decoded.

use crate::files::{is_pattern, sha256_of_file};
use crate::progress::{Progress, Share};
use hovertone::{Config, Discovery, FoundSpeed, SpeedAnalysis, Warning, speed_from_source, tones_from_source};
use hovertone_media::{Decoder, OpenOptions, Recording};
use hovertone_report::{Answer, Found, Notice, RecordingFacts, SpeedRecord};
use rayon::prelude::*;
use std::path::{Path, PathBuf};

/// What to hear of every file.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Hearing {
    /// The audio track, counted from 1; the first that is not silent where absent.
    pub(crate) audio_track: Option<usize>,
    /// The channel, counted from 1; the mean of all where absent.
    pub(crate) channel: Option<usize>,
    /// Whether the output will name the hash of the file.
    pub(crate) wants_hash: bool,
    /// Whether the samples of the hover are used, so that their warnings matter.
    pub(crate) wants_samples: bool,
}

/// One recording to hear.
#[derive(Clone, Debug)]
pub(crate) struct Job {
    /// Where it is.
    pub(crate) path: PathBuf,
    /// What it is called.
    pub(crate) name: String,
    /// How it is analysed.
    pub(crate) config: Config,
    /// How the tone is found, where nobody says which it is; the order of `config` then means nothing.
    pub(crate) discovery: Option<Discovery>,
}

/// Hears all recordings, in parallel; the answers are in the order of the jobs.
pub(crate) fn hear_all(jobs: &[Job], hearing: Hearing, progress: &Progress) -> Vec<SpeedRecord> {
    jobs.par_iter().map(|job| hear(job, hearing, &mut progress.recording())).collect()
}

fn hear(job: &Job, hearing: Hearing, share: &mut Share<'_>) -> SpeedRecord {
    let failed = |reason: String, recording| SpeedRecord {
        file: job.name.clone(),
        config: job.config.clone(),
        recording,
        answer: Answer::Failed { reason },
        found: None,
        labels: None,
        notices: Vec::new(),
    };
    if let Some(reason) = wrong_kind(&job.path) {
        return failed(reason, None);
    }
    let options = OpenOptions { audio_track: hearing.audio_track, channel: hearing.channel, ..OpenOptions::default() };
    let mut recording = match Recording::open(&job.path, &options) {
        Ok(recording) => recording,
        Err(error) => return failed(error.to_string(), None),
    };
    let sha256 = match hearing.wants_hash.then(|| sha256_of_file(&job.path)).transpose() {
        Ok(sha256) => sha256,
        Err(error) => return failed(format!("the file could not be read to its end: {error}; check the disk"), None),
    };
    let analysis = analysis_of(&mut recording, job, share);
    let facts = facts_of(&recording, sha256);
    let (analysis, config, found) = match analysis {
        Ok(analysis) => analysis,
        Err(error) => return failed(error.to_string(), Some(facts)),
    };
    let of_the_file = recording.warnings().iter().map(|warning| Notice::new(warning.to_string(), warning.hint()));
    let matters =
        |warning: &&Warning| hearing.wants_samples || !matches!(warning, Warning::HoverShorterThanSample { .. });
    let notices = of_the_file.chain(analysis.warnings.iter().filter(matters).map(Notice::from)).collect();
    let mut record = SpeedRecord {
        file: job.name.clone(),
        config,
        recording: Some(facts),
        answer: Answer::Heard(Box::new(analysis)),
        found,
        labels: None,
        notices,
    };
    record.notices.extend(notice_of_reading(&record));
    record
}

/// What only somebody who knows what was typed can say.
fn wrong_kind(path: &Path) -> Option<String> {
    if path.is_dir() {
        return Some("this is a folder, not a recording; name the recordings in it, as in FOLDER/*.wav".to_owned());
    }
    (!path.exists() && is_pattern(&path.to_string_lossy()))
        .then(|| "no file matches this pattern; check the folder and the ending of its files".to_owned())
}

/// What was taken for granted where nobody said which tone is the rotor's.
fn notice_of_reading(record: &SpeedRecord) -> Option<Notice> {
    let reading = record.found_reading().filter(|_| record.speed().is_some())?;
    let text = format!(
        "the tone was found by itself and read as order {}, {}: {}",
        reading.order, reading.meaning, reading.why
    );
    Some(Notice::new(text, "check the blades and say --blades N; `hovertone tones` shows the other readings"))
}

fn analysis_of(
    recording: &mut Recording,
    job: &Job,
    share: &mut Share<'_>,
) -> Result<(SpeedAnalysis, Config, Option<Found>), hovertone::Error> {
    let (start_s, declared_s) = (recording.info().start_s, recording.info().declared_duration_s);
    let mut heard_s: f64 = 0.0;
    let mut on_progress = |progress: hovertone::Progress| {
        let time_s = progress.time_s - start_s;
        // once it was heard, we know better than the header
        let length_s = if progress.pass == 1 { declared_s } else { Some(heard_s) };
        heard_s = heard_s.max(time_s);
        let of_pass = length_s.filter(|&length_s| length_s > 0.0).map_or(0.0, |length_s| (time_s / length_s).min(1.0));
        share.set((f64::from(progress.pass - 1) + of_pass) / f64::from(progress.pass_count));
    };
    let Some(discovery) = job.discovery else {
        let analysis = speed_from_source(recording, &job.config, &mut on_progress)?;
        return Ok((analysis, job.config.clone(), None));
    };
    let found = tones_from_source(recording, &job.config, &discovery, &mut on_progress)?;
    let FoundSpeed { families, rotor, config, analysis, alternatives } = found;
    Ok((analysis, config, Some(Found { discovery, families, rotor, alternatives })))
}

fn facts_of(recording: &Recording, sha256: Option<String>) -> RecordingFacts {
    let info = recording.info();
    RecordingFacts {
        sha256,
        container: info.container.to_string(),
        codec: info.codec.clone(),
        decoder: match info.decoder {
            Decoder::Native => "hovertone",
            Decoder::Ffmpeg => "ffmpeg",
            _ => "other",
        }
        .to_owned(),
        sample_rate_hz: info.sample_rate_hz,
        channel_count: info.channel_count,
        channel: info.channel,
        audio_track: info.audio_track,
        audio_track_count: info.audio_track_count,
        is_prefix: recording.is_prefix(),
    }
}
