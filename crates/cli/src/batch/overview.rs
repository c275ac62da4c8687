//! The page of a batch: a table of all recordings with small spectrograms.

use crate::failure::Failure;
use hovertone_archive::{BatchIdentity, Summary};
use hovertone_page::{ArchivePage, ArchiveRecording, ArchiveRecordings, HeardSpeed, archive_html};

/// The page, as its recordings come in.
pub(crate) struct Overview<'a> {
    identity: &'a BatchIdentity,
    recordings: ArchiveRecordings,
}

impl<'a> Overview<'a> {
    pub(crate) fn new(identity: &'a BatchIdentity) -> Self {
        Self { identity, recordings: ArchiveRecordings::default() }
    }

    /// Adds a recording. What the page does not show is not kept.
    pub(crate) fn add(&mut self, summary: Summary, picture: Option<String>) {
        let speed = |rotor: &hovertone_archive::RotorSummary| HeardSpeed {
            speed_rev_s: rotor.speed_rev_s,
            std_rev_s: rotor.std_rev_s,
        };
        self.recordings.push(ArchiveRecording {
            speed: summary.speed.as_ref().map(speed),
            rotors: summary.rotors.iter().map(speed).collect(),
            file: summary.file,
            status: summary.status,
            reason: summary.reason,
            tone_hz: summary.tone_hz,
            used_s: summary.used_s,
            warnings: summary.warnings,
            is_doubtful: summary.is_doubtful,
            picture,
        });
    }

    /// The page.
    pub(crate) fn html(self) -> Result<String, Failure> {
        let settings = serde_json::to_string_pretty(&self.identity.settings).map_err(Failure::internal)?;
        let page = ArchivePage {
            inputs: &self.identity.inputs,
            settings: &settings,
            recordings: &self.recordings,
            picture_hz_high: crate::thumbnail::HZ_HIGH,
        };
        archive_html(&page).map_err(Failure::internal)
    }
}
