//! Where live sound comes from.

use crate::failure::Failure;
use crate::inputs::is_stdin;
#[cfg(feature = "microphone")]
use crate::listen::microphone::Microphone;
use crate::recording_files::of_wrong_kind;
use hovertone::sound::SignalSource;
use hovertone_media::{OpenOptions, PipedSound, Recording};
use hovertone_report::Notice;
use hovertone_workflow::notices_of;
use std::path::{Path, PathBuf};

/// Name of the pipe in messages.
const PIPE: &str = "stdin";

/// Sound that arrives block by block.
pub(crate) enum LiveSound {
    /// A recording on disk.
    File { path: PathBuf, recording: Box<Recording> },
    /// A pipe.
    Pipe(Box<PipedSound>),
    /// A device.
    #[cfg(feature = "microphone")]
    Microphone(Microphone),
}

impl LiveSound {
    /// Opens a recording, a pipe where the name is `-`, or the microphone where there is no name.
    pub(crate) fn open(name: Option<&Path>, channel: Option<usize>) -> Result<Self, Failure> {
        match name {
            Some(name) if is_stdin(name) => {
                let sound = PipedSound::open(std::io::stdin(), channel);
                Ok(Self::Pipe(Box::new(sound.map_err(|error| failed(&error, Path::new(PIPE)))?)))
            }
            Some(path) => {
                if let Some(reason) = of_wrong_kind(path) {
                    return Err(Failure::failed(reason, "", path));
                }
                let options = OpenOptions { channel, ..OpenOptions::default() };
                let recording = Recording::open(path, &options).map_err(|error| failed(&error, path))?;
                Ok(Self::File { path: path.to_owned(), recording: Box::new(recording) })
            }
            #[cfg(feature = "microphone")]
            None => Ok(Self::Microphone(Microphone::open(channel)?)),
            #[cfg(not(feature = "microphone"))]
            None => Err(Failure::internal("listen without a sound")),
        }
    }

    /// What is heard, in words.
    pub(crate) fn name(&self) -> String {
        match self {
            Self::File { path, .. } => path.file_name().unwrap_or(path.as_os_str()).to_string_lossy().into_owned(),
            Self::Pipe(_) => "a pipe".to_owned(),
            #[cfg(feature = "microphone")]
            Self::Microphone(microphone) => microphone.name(),
        }
    }

    /// What weakens the sound that was heard to its end.
    pub(crate) fn notices(&self) -> Vec<Notice> {
        match self {
            Self::File { recording, .. } => notices_of(recording),
            Self::Pipe(pipe) => pipe.warning().iter().map(|it| Notice::new(it.to_string(), it.hint())).collect(),
            #[cfg(feature = "microphone")]
            Self::Microphone(_) => Vec::new(),
        }
    }

    pub(crate) fn sample_rate_hz(&self) -> f64 {
        match self {
            Self::File { recording, .. } => recording.sample_rate_hz(),
            Self::Pipe(pipe) => pipe.sample_rate_hz(),
            #[cfg(feature = "microphone")]
            Self::Microphone(microphone) => microphone.sample_rate_hz(),
        }
    }

    /// The next samples. `None` at the end.
    pub(crate) fn next_block(&mut self) -> Result<Option<&[f32]>, Failure> {
        match self {
            Self::File { path, recording } => recording.next_block().map_err(|error| failed(&error, path)),
            Self::Pipe(pipe) => pipe.next_block().map_err(|error| failed(&error, Path::new(PIPE))),
            #[cfg(feature = "microphone")]
            Self::Microphone(microphone) => microphone.next_block(),
        }
    }
}

/// The reason of a recording says what to do.
fn failed(error: &dyn std::fmt::Display, path: &Path) -> Failure {
    Failure::failed(error.to_string(), "", path)
}
