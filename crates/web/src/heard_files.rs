//! Files of the page, and the records of those that were heard. A record is kept with the settings it was heard by, and is used again as
//! long as they are the same.

use crate::experiment::in_hexadecimal;
use crate::slices::SlicedFile;
use hovertone::speed::Config;
use hovertone::tones::Discovery;
use hovertone_media::{CodedSound, DecodedSound, FfmpegUse, FileAccess, MediaError, OpenOptions, Recording};
use hovertone_report::SpeedRecord;
use hovertone_workflow::{NotHeard, Requests, Task, failed_record, hear};
use sha2::{Digest, Sha256};
use std::collections::BTreeMap;
use std::io::Read;
use std::sync::Arc;

/// Bytes that are hashed at once.
const HASHED_BYTES: usize = 1024 * 1024;

/// A listener to progress: the share that is done, 0 to 1.
pub(crate) type OnShare<'a> = &'a mut dyn FnMut(f64);

/// A record, and by which settings it was heard.
struct Kept {
    file: u32,
    settings: String,
    record: SpeedRecord,
}

/// The files, their hashes and their records.
#[derive(Default)]
pub(crate) struct HeardFiles {
    files: BTreeMap<u32, Arc<SlicedFile>>,
    hashes: BTreeMap<u32, String>,
    /// The sound of files that the browser decoded.
    decoded: BTreeMap<u32, DecodedSound>,
    kept: Vec<Kept>,
}

impl HeardFiles {
    /// Takes a file.
    pub(crate) fn add(&mut self, file: SlicedFile) {
        self.files.insert(file.number, Arc::new(file));
    }

    /// Forgets a file.
    pub(crate) fn remove(&mut self, number: u32) {
        self.files.remove(&number);
        self.hashes.remove(&number);
        self.decoded.remove(&number);
        self.kept.retain(|kept| kept.file != number);
    }

    /// The record of a file by itself.
    pub(crate) fn record_of(
        &mut self,
        number: u32,
        config: &Config,
        discovery: Option<Discovery>,
        on_share: OnShare<'_>,
    ) -> &SpeedRecord {
        let settings = format!("{config:?} {discovery:?}");
        let name = self.name_of(number);
        let task = Task { name: &name, config, discovery, requests: Requests::default(), wants_samples: false };
        let index = self.heard(number, settings, &task, 0.0, on_share);
        &self.kept[index].record
    }

    /// Name of a file.
    fn name_of(&self, number: u32) -> String {
        self.files.get(&number).map_or(String::new(), |file| file.name.display().to_string())
    }

    /// The packets of a file that needs the decoder of the browser; `None` where hovertone decodes it, or knows no packets of it.
    pub(crate) fn coded(&self, number: u32) -> Option<CodedSound> {
        CodedSound::open(&**self.files.get(&number)?)
    }

    /// Takes what the browser decoded of a file.
    pub(crate) fn add_decoded(&mut self, number: u32, sound: DecodedSound) {
        self.decoded.insert(number, sound);
    }

    /// Opens a file for a pass.
    pub(crate) fn opened(&self, number: u32, clock_correction_ppm: f64) -> Result<Recording, String> {
        self.open(number, clock_correction_ppm).map_err(|failure| failure.reason)
    }

    fn open(&self, number: u32, clock_correction_ppm: f64) -> Result<Recording, NotHeard> {
        let file =
            self.files.get(&number).ok_or_else(|| NotHeard::because("not_found", "the file is gone; add it again"))?;
        let decoded = self.decoded.get(&number).cloned();
        let options = OpenOptions { ffmpeg: FfmpegUse::Never, clock_correction_ppm, decoded, ..OpenOptions::default() };
        Recording::open_file(file.clone(), &options).map_err(|error| NotHeard::because(error.class(), in_words(&error)))
    }

    /// SHA-256 of a file, in hexadecimal.
    pub(crate) fn sha256(&mut self, number: u32) -> Result<String, String> {
        if let Some(known) = self.hashes.get(&number) {
            return Ok(known.clone());
        }
        let file = self.files.get(&number).ok_or("the file is gone; add it again")?;
        let unreadable = |error: std::io::Error| format!("the file could not be read to its end: {error}");
        let mut bytes = file.open().map_err(unreadable)?;
        let mut hasher = Sha256::new();
        let mut piece = vec![0; HASHED_BYTES];
        loop {
            let count = bytes.read(&mut piece).map_err(unreadable)?;
            if count == 0 {
                break;
            }
            hasher.update(&piece[..count]);
        }
        let sha256 = in_hexadecimal(&hasher.finalize());
        self.hashes.insert(number, sha256.clone());
        Ok(sha256)
    }

    /// The record of a file by a task: the kept one, or a new one. Returns its place.
    fn heard(&mut self, number: u32, settings: String, task: &Task<'_>, ppm: f64, on_share: OnShare<'_>) -> usize {
        let is_same = |kept: &Kept| kept.file == number && kept.settings == settings;
        if let Some(index) = self.kept.iter().position(is_same) {
            return index;
        }
        let sha256 = self.hashes.get(&number).cloned();
        let heard = self
            .open(number, ppm)
            .and_then(|mut recording| hear(&mut recording, task, sha256, |share| on_share(share.done)));
        let record = heard.map_or_else(|failure| failed_record(task, failure), |heard| heard.record);
        self.kept.push(Kept { file: number, settings, record });
        self.kept.len() - 1
    }

    /// The record of a recording of an experiment.
    pub(crate) fn record_of_trial(
        &mut self,
        number: u32,
        name: &str,
        config: &Config,
        clock_correction_ppm: f64,
        on_share: OnShare<'_>,
    ) -> SpeedRecord {
        let task = Task { name, config, discovery: None, requests: Requests::default(), wants_samples: true };
        let settings = format!("{name:?} of an experiment, {clock_correction_ppm} {config:?}");
        let index = self.heard(number, settings, &task, clock_correction_ppm, on_share);
        self.kept[index].record.clone()
    }
}

/// An error in the words of the page, where there is no ffmpeg to install.
fn in_words(error: &MediaError) -> String {
    match error {
        MediaError::NeedsFfmpeg { container, codec, .. } => format!(
            "the {container} holds {codec}, which the page cannot decode; convert the sound to WAV or FLAC, or \
            install ffmpeg and use the command `hovertone speed`"
        ),
        error => error.to_string(),
    }
}
