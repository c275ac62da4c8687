//! From recordings to records. No other file of the command line decodes sound.

use crate::failure::Failure;
use crate::files::sha256_of;
pub(crate) use crate::job::{HeardJobs, Hearing, Job, Requests, in_memory};
use crate::nearest::meant_file;
use crate::progress::{Progress, Share};
use crate::recording_files::of_wrong_kind;
use crate::stored::is_address;
use crate::thumbnail::thumbnail_of;
use hovertone::motors::{
    HeardCommands, HeardMotor, HeardTone, PASSES_OF_MOTOR, level_of_analysis, level_of_rotors, motor_from_sound,
};
use hovertone::rotors::SpinUp;
use hovertone::sound::{HeardBand, Passes, line_frequency};
use hovertone::speed::{Config, NoTone, OtherRotor, better_rotor_from_passes, passes_of_speed};
use hovertone::tones::{Meaning, tones_from_passes};
use hovertone_dynamics::{HeardLines, LineOrders, lines_from_passes};
use hovertone_media::{MediaError, Recording};
use hovertone_report::{Notice, SpeedRecord, printable};
use hovertone_workflow::{NotHeard, failed_record, notices_of, progress_of};
use rayon::prelude::*;
use std::ops::Range;
use std::path::Path;

/// A recording that was analysed.
#[cfg_attr(not(feature = "archive"), allow(dead_code))] // archives alone have classes of errors and thumbnails
pub(crate) struct Heard {
    /// The result.
    pub(crate) record: SpeedRecord,
    /// The settings of the analysis: the settings of the job with the tone that was found.
    pub(crate) config: Config,
    /// The start of each rotor, where it was requested.
    pub(crate) spin_up: Option<SpinUp>,
    /// The kind of error in one word, where the recording could not be heard.
    pub(crate) error_class: Option<&'static str>,
    /// A small spectrogram as the URI of a PNG, where it was requested.
    pub(crate) thumbnail: Option<String>,
}

/// Analyses all recordings in parallel; the results are in the order of the jobs.
pub(crate) fn hear_all(jobs: &[Job], hearing: Hearing, progress: &Progress) -> Vec<Heard> {
    jobs.par_iter().map(|job| heard_or_failed(job, hearing, &mut progress.recording())).collect()
}

/// Analyses a recording. One that could not be heard has its reason in place of an answer.
pub(crate) fn heard_or_failed(job: &Job, hearing: Hearing, share: &mut Share<'_>) -> Heard {
    hear(job, hearing, share).unwrap_or_else(|failure| failed(job, failure))
}

/// A recording that broke the analysis, which is a bug.
#[cfg(feature = "archive")]
pub(crate) fn broken(job: &Job) -> Heard {
    let reason = "this recording broke the analysis: this is a bug of hovertone; please report it";
    failed(job, NotHeard::because("internal", reason))
}

fn failed(job: &Job, failure: NotHeard) -> Heard {
    let class = failure.class;
    Heard {
        record: failed_record(&job.task(Hearing::default()), failure),
        config: job.config.clone(),
        spin_up: None,
        error_class: Some(class),
        thumbnail: None,
    }
}

/// Analyses all recordings and keeps only the records.
pub(crate) fn records_of(jobs: &[Job], hearing: Hearing, progress: &Progress) -> Vec<SpeedRecord> {
    hear_all(jobs, hearing, progress).into_iter().map(|heard| heard.record).collect()
}

/// The strongest line of a recording in a band, and what weakens the recording; a failure is its reason.
pub(crate) fn line_in_band(
    job: &Job,
    hearing: Hearing,
    band_hz: Range<f64>,
    progress: &Progress,
) -> Result<(HeardBand, Vec<Notice>), String> {
    let mut recording = opened_or_not(job, hearing).map_err(|failure| failure.reason)?;
    let highest_hz = recording.info().sample_rate_hz / 2.0;
    if band_hz.end >= highest_hz {
        return Err(format!(
            "this recording has no sound above {highest_hz:.0} Hz; record at a higher sample rate, or use a lower tone"
        ));
    }
    let span_s = job.config.span.from_s.unwrap_or(f64::MIN)..job.config.span.to_s.unwrap_or(f64::INFINITY);
    let mut share = progress.recording();
    let mut on_progress = progress_of(&recording, |done| share.show(done));
    let heard = Passes::planned(&mut recording, 1, &mut on_progress)
        .and_then(|mut passes| line_frequency(&mut passes, span_s, band_hz))
        .map_err(|error| error.to_string())?;
    Ok((heard, notices_of(&recording)))
}

/// What a recording tells of its motors.
pub(crate) struct SoundOfMotor {
    /// The motor, or why no rotor is heard.
    pub(crate) motor: Result<HeardMotor, NoTone>,
    /// What weakens the recording.
    pub(crate) notices: Vec<Notice>,
}

/// The motors of a recording with steps; a failure is its reason.
pub(crate) fn motor_in(
    job: &Job,
    hearing: Hearing,
    commands: Option<HeardCommands<'_>>,
    progress: &Progress,
) -> Result<SoundOfMotor, String> {
    let mut recording = opened_or_not(job, hearing).map_err(|failure| failure.reason)?;
    let mut share = progress.recording();
    let mut on_progress = progress_of(&recording, |done| share.show(done));
    let planned = passes_of_speed(&job.config) + PASSES_OF_MOTOR;
    let (motor, guess) = Passes::planned(&mut recording, planned, &mut on_progress)
        .map_err(hovertone::speed::Error::from)
        .and_then(|mut passes| motor_of_passes(&mut passes, job, commands))
        .map_err(|error| error.to_string())?;
    Ok(SoundOfMotor { motor, notices: notices_of(&recording).into_iter().chain(guess).collect() })
}

/// The motor, and what is said of blades that were guessed.
fn motor_of_passes(
    passes: &mut Passes<'_>,
    job: &Job,
    commands: Option<HeardCommands<'_>>,
) -> Result<(Result<HeardMotor, NoTone>, Option<Notice>), hovertone::speed::Error> {
    let (level, config, guess) = match job.discovery {
        Some(discovery) => {
            let found = tones_from_passes(passes, &job.config, &discovery)?;
            let meaning = found.reading().map(|reading| reading.meaning);
            let guess = meaning.filter(|_| discovery.known.blade_count.is_none()).and_then(guess_in_words);
            (level_of_analysis(&found.analysis), found.config, guess)
        }
        None => (level_of_rotors(passes, &job.config)?, job.config.clone(), None),
    };
    let speed_rev_s = match level {
        Ok(speed_rev_s) => speed_rev_s,
        Err(reason) => return Ok((Err(reason), None)),
    };
    let span_s = job.config.span.from_s.unwrap_or(f64::MIN)..job.config.span.to_s.unwrap_or(f64::INFINITY);
    let motor = motor_from_sound(passes, &HeardTone { tone: &config.tone, speed_rev_s, span_s }, commands)?;
    let guess = guess.filter(|_| motor.model.is_some());
    Ok((Ok(motor), guess))
}

/// That the number of blades is a guess. `None` where it was not needed.
fn guess_in_words(meaning: Meaning) -> Option<Notice> {
    let blades = meaning.blades().filter(|_| meaning.gear().is_none())?;
    let what = format!(
        "the number of blades is not given: the speeds are for propellers with {blades} blades, because the sound suggests this number"
    );
    Some(Notice::new(what, "count the blades and give --blades N"))
}

/// A rotor that the settings leave out, and that fits the sound far better.
pub(crate) fn better_rotor(
    path: &Path,
    config: &Config,
    hearing: Hearing,
    progress: &Progress,
) -> Result<Option<OtherRotor>, Failure> {
    let failed = |what: String| Failure::failed(what, "give another recording", path);
    let mut recording = open_with_advice(path, hearing)?;
    let mut share = progress.recording();
    let mut on_progress = progress_of(&recording, |done| share.show(done));
    Passes::planned(&mut recording, 1, &mut on_progress)
        .map_err(hovertone::speed::Error::from)
        .and_then(|mut passes| better_rotor_from_passes(&mut passes, config))
        .map_err(|error| failed(error.to_string()))
}

/// The lines of all rotors of a recording, in a range of shaft speeds.
pub(crate) fn lines_of(
    path: &Path,
    hearing: Hearing,
    orders: &LineOrders,
    speed_rev_s: Range<f64>,
    progress: &Progress,
) -> Result<HeardLines, Failure> {
    let failed = |what: String| Failure::failed(what, "give a recording of the same flight", path);
    let mut recording = open_with_advice(path, hearing)?;
    let start_s = recording.info().start_s;
    let mut share = progress.recording();
    let mut on_progress = progress_of(&recording, |done| share.show(done));
    Passes::planned(&mut recording, 1, &mut on_progress)
        .and_then(|mut passes| lines_from_passes(&mut passes, start_s..f64::INFINITY, orders, speed_rev_s))
        .map_err(|error| failed(error.to_string()))
}

/// Opens a recording by its name. The reason of a failure contains the advice.
fn open_with_advice(path: &Path, hearing: Hearing) -> Result<Recording, Failure> {
    let failed = |reason: String| Failure::failed(reason, "", path);
    match wrong_kind(path) {
        Some(reason) => Err(failed(reason)),
        None => Recording::open(path, &hearing.open_options()).map_err(|error| failed(error.to_string())),
    }
}

/// Opens the recording of a job.
pub(crate) fn opened(job: &Job, hearing: Hearing) -> Result<Recording, Failure> {
    // the reason contains the advice
    opened_or_not(job, hearing).map_err(|NotHeard { reason, .. }| Failure::failed(reason, "", &job.path))
}

fn opened_or_not(job: &Job, hearing: Hearing) -> Result<Recording, NotHeard> {
    match wrong_kind(&job.path).filter(|_| job.samples.is_none()) {
        Some(reason) => Err(NotHeard::because(if job.path.is_dir() { "not_a_file" } else { "not_found" }, reason)),
        None => job.open(hearing).map_err(|error| with_meant_file(job, NotHeard::because(error.class(), error))),
    }
}

/// The failure of a file that is not there, with the file that was meant.
fn with_meant_file(job: &Job, failure: NotHeard) -> NotHeard {
    match meant_file(&job.path) {
        Some(meant) => {
            NotHeard { reason: format!("{}; did you mean {}?", failure.reason, printable(&meant)), ..failure }
        }
        None => failure,
    }
}

fn hear(job: &Job, hearing: Hearing, share: &mut Share<'_>) -> Result<Heard, NotHeard> {
    let mut recording = opened_or_not(job, hearing)?;
    let hashed = || job.sha256.clone().map_or_else(|| recording.bytes().and_then(sha256_of), Ok);
    let sha256 = (hearing.wants_hash && job.samples.is_none())
        .then(hashed)
        .transpose()
        .map_err(|error| NotHeard::because("unreadable", MediaError::Read(error)))?;
    let heard = hovertone_workflow::hear(&mut recording, &job.task(hearing), sha256, |done| share.show(done))?;
    let hovertone_workflow::Heard { record, config, spin_up } = heard;
    let thumbnail = hearing.wants_thumbnail.then(|| thumbnail_of(&mut recording, record.analysis()?)).flatten();
    Ok(Heard { record, config, spin_up, error_class: None, thumbnail })
}

/// A reason that follows from the typed name: a folder, or a pattern without files.
fn wrong_kind(path: &Path) -> Option<String> {
    of_wrong_kind(path).filter(|_| !is_address(path))
}
