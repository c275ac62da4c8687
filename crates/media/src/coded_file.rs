//! Whether a file needs another decoder: this crate lists its tracks, and has no decoder for the only one.

use crate::coded::CodedSound;
use crate::error::MediaError;
use crate::ffmpeg::FfmpegUse;
use crate::file_access::FileAccess;
use crate::recording::sniffed_from_file;
use crate::tracks::Tracks;

impl CodedSound {
    /// Opens the only track of a file that needs another decoder; `None` where this crate decodes the file, or knows no packets of it.
    pub fn open(file: &dyn FileAccess) -> Option<Self> {
        let no_ffmpeg = FfmpegUse::Never;
        let tracks = Tracks::of(file, &sniffed_from_file(file, &no_ffmpeg).ok()?, &no_ffmpeg, None).ok()?;
        let is_foreign = tracks.count() == 1 && matches!(tracks.plan(0), Err(MediaError::NeedsFfmpeg { .. }));
        if is_foreign { tracks.coded_sound() } else { None }
    }
}
