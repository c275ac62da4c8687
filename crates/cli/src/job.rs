//! What is to be heard, and how: a recording with its settings.

use crate::args::HearingArguments;
use crate::stored::{is_address, opened};
use hovertone::speed::Config;
use hovertone::tones::Discovery;
use hovertone_media::{MediaError, OpenOptions, Recording, Samples};
use hovertone_report::SpeedRecord;
pub(crate) use hovertone_workflow::Requests;
use hovertone_workflow::Task;
use std::path::PathBuf;

/// How every file is opened, and what its output needs.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Hearing {
    /// Number of the audio track, counted from 1; the first that is not silent where absent.
    pub(crate) audio_track: Option<usize>,
    /// Number of the channel, counted from 1; the mean of all channels where absent.
    pub(crate) channel: Option<usize>,
    /// Correction of the recorder's clock, in millionths.
    pub(crate) clock_correction_ppm: f64,
    /// Whether the output contains the hash of the file.
    pub(crate) wants_hash: bool,
    /// Whether the samples of the hover are used, and with them their warnings.
    pub(crate) wants_samples: bool,
    /// Whether a small spectrogram is drawn, in another pass over the sound.
    pub(crate) wants_thumbnail: bool,
}

impl Hearing {
    /// What the arguments say, without hash and samples.
    pub(crate) fn of(arguments: &HearingArguments) -> Self {
        Self {
            audio_track: arguments.audio_track,
            channel: arguments.channel,
            clock_correction_ppm: arguments.clock_correction_ppm.unwrap_or(0.0),
            ..Self::default()
        }
    }

    /// How every file is opened.
    pub(crate) fn open_options(self) -> OpenOptions {
        OpenOptions {
            audio_track: self.audio_track,
            channel: self.channel,
            clock_correction_ppm: self.clock_correction_ppm,
            ..OpenOptions::default()
        }
    }
}

/// One recording to analyse.
#[derive(Clone, Debug)]
pub(crate) struct Job {
    /// Path of the file.
    pub(crate) path: PathBuf,
    /// Name in the output.
    pub(crate) name: String,
    /// Settings of the analysis.
    pub(crate) config: Config,
    /// The search for the tone, where its order is unknown; the order in `config` is then a placeholder.
    pub(crate) discovery: Option<Discovery>,
    /// Analyses of the rotors after the speed.
    pub(crate) requests: Requests,
    /// Hash of the file, where the search for copies has made it.
    pub(crate) sha256: Option<String>,
    /// The sound itself, where a program that calls has it in memory; the path then is no file.
    pub(crate) samples: Option<Samples>,
}

impl Job {
    /// Opens the recording.
    pub(crate) fn open(&self, hearing: Hearing) -> Result<Recording, MediaError> {
        match &self.samples {
            Some(samples) => Recording::of_samples(samples, &hearing.open_options()),
            None if is_address(&self.path) => opened(&self.path, &hearing.open_options()),
            None => Recording::open(&self.path, &hearing.open_options()),
        }
    }

    /// What is to be heard in it.
    pub(crate) fn task(&self, hearing: Hearing) -> Task<'_> {
        Task {
            name: &self.name,
            config: &self.config,
            discovery: self.discovery,
            requests: self.requests,
            wants_samples: hearing.wants_samples,
        }
    }
}

/// Jobs with their answers, in the same order.
pub(crate) struct HeardJobs {
    pub(crate) jobs: Vec<Job>,
    pub(crate) records: Vec<SpeedRecord>,
    pub(crate) hearing: Hearing,
}

/// Puts the sound of the first job into memory, where a program has it there.
pub(crate) fn in_memory(jobs: &mut [Job], samples: Option<Samples>) {
    if let (Some(job), Some(samples)) = (jobs.first_mut(), samples) {
        job.samples = Some(samples);
    }
}
