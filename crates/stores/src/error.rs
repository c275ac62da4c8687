//! Why a store gave no bytes, in words that are the same in each run: no times, and no numbers of attempts.

use object_store::client::{HttpError, HttpErrorKind};
use object_store::path::Error as PathError;
use std::error::Error;
use std::io;
use thiserror::Error as ThisError;

/// What comes before the status of an answer in the messages of `object_store`, which has no other way to tell it.
const STATUS: &str = "status code: ";

/// Why an address cannot be read.
#[derive(Clone, Debug, PartialEq, Eq, ThisError)]
#[non_exhaustive]
pub enum StoreError {
    /// The text is no address that can be read.
    #[error("{0}")]
    BadAddress(String),
    /// Nothing is there.
    #[error("nothing is at this address")]
    NotFound,
    /// The store asks for other credentials.
    #[error("the store refuses access: it asks for credentials, and the environment variables have none or wrong ones")]
    Refused,
    /// Variables of the environment that are missing or have no meaning.
    #[error("an environment variable of the store is missing, or has a wrong value: {0}")]
    Settings(String),
    /// A server that gives whole files only.
    #[error("the server sends whole files only, but hovertone reads recordings in parts")]
    WholeFilesOnly,
    /// A server that lists no folders.
    #[error("the server does not list folders")]
    ListsNothing,
    /// No connection.
    #[error("the store cannot be reached")]
    NotReached,
    /// No answer for a long time.
    #[error("the store did not answer in time")]
    TooSlow,
    /// Fewer bytes than were asked for, after all attempts.
    #[error("the store sent fewer bytes than hovertone asked for")]
    CutShort,
    /// Another file has taken its place.
    #[error("the file changed while it was read")]
    Changed,
    /// A status that tells of an error.
    #[error("the store answered {0}")]
    Status(String),
    /// Any other reason.
    #[error("{0}")]
    Other(String),
}

impl StoreError {
    /// What to do.
    pub fn hint(&self) -> &'static str {
        match self {
            Self::BadAddress(_) => {
                "write it as s3://BUCKET/FOLDER, gs://BUCKET/FOLDER, az://CONTAINER/FOLDER or https://HOST/FILE"
            }
            Self::NotFound => "check the name",
            Self::Refused | Self::Settings(_) => {
                "docs/batch.md lists the environment variables of each store, such as AZURE_STORAGE_ACCOUNT_NAME or AWS_REGION: set them"
            }
            Self::WholeFilesOnly => "copy the recordings to a disk",
            Self::ListsNothing => "give the address of a recording, or of a list of recordings whose name ends in .txt",
            Self::Changed => "run the same command again",
            _ => "check the connection and the store, and run the same command again",
        }
    }

    /// Whether an answer began and did not end.
    pub(crate) fn is_broken_off(&self) -> bool {
        matches!(self, Self::TooSlow | Self::CutShort)
    }
}

impl From<object_store::Error> for StoreError {
    fn from(error: object_store::Error) -> Self {
        use object_store::Error as E;
        match &error {
            E::NotFound { .. } => Self::NotFound,
            E::PermissionDenied { .. } | E::Unauthenticated { .. } => Self::Refused,
            E::NotSupported { .. } => Self::WholeFilesOnly,
            E::Precondition { .. } | E::NotModified { .. } => Self::Changed,
            E::InvalidPath { source } => Self::BadAddress(name_fault(source)),
            _ => of_text(&error),
        }
    }
}

/// Why a name is none of a store, without the words of the library.
pub(crate) fn name_fault(error: &PathError) -> String {
    let why = match error {
        PathError::EmptySegment { .. } => "has an empty part: two slashes stand side by side",
        PathError::BadSegment { .. } => "has a part that no store takes, such as . or ..",
        PathError::NonUnicode { .. } => "has % codes that are no UTF-8",
        _ => "cannot be read",
    };
    format!("the name in this address {why}")
}

fn of_text(error: &object_store::Error) -> StoreError {
    let text = error.to_string();
    if let Some((_, status)) = text.rsplit_once(STATUS) {
        let status = status.split(':').next().unwrap_or(status).trim();
        return match status.split(' ').next() {
            Some("401" | "403") => StoreError::Refused,
            Some("404") => StoreError::NotFound,
            _ => StoreError::Status(status.to_owned()),
        };
    }
    match transport(error) {
        Some(HttpErrorKind::Timeout) => StoreError::TooSlow,
        Some(HttpErrorKind::Connect) => StoreError::NotReached,
        Some(_) => StoreError::CutShort,
        None if text.contains("non-partial response") => StoreError::WholeFilesOnly,
        None => StoreError::Other(format!("the store gave no usable answer ({})", first_line(&text))),
    }
}

/// The failure below HTTP, where there was one.
fn transport(error: &object_store::Error) -> Option<HttpErrorKind> {
    let mut current: &(dyn Error + 'static) = error;
    loop {
        if let Some(error) = current.downcast_ref::<HttpError>() {
            return Some(error.kind());
        }
        current = current.source()?;
    }
}

fn first_line(text: &str) -> &str {
    text.lines().next().unwrap_or_default()
}

/// A store error with its advice, for who reads the bytes as those of a file.
#[derive(Debug, ThisError)]
#[error("{}; {}", .0, .0.hint())]
struct Advised(StoreError);

impl From<StoreError> for io::Error {
    fn from(error: StoreError) -> Self {
        let kind = match error {
            StoreError::NotFound => io::ErrorKind::NotFound,
            StoreError::TooSlow => io::ErrorKind::TimedOut,
            StoreError::CutShort => io::ErrorKind::ConnectionAborted,
            _ => io::ErrorKind::Other,
        };
        Self::new(kind, Advised(error))
    }
}
