//! The interface of all ways of decoding: interleaved frames, and counts of damage.

use std::io;

/// Interleaved frames of one audio track, in order.
pub(crate) trait Frames: Send {
    fn sample_rate_hz(&self) -> f64;

    fn channel_count(&self) -> usize;

    /// Replaces the content of `out` by the next frames; `false` after the last. The result can be empty although more frames follow.
    fn next_frames(&mut self, out: &mut Vec<f32>, incidents: &mut Incidents) -> io::Result<bool>;
}

/// Counts of errors during the decoding.
#[derive(Clone, Debug, Default)]
pub(crate) struct Incidents {
    pub(crate) corrupt_packets: u64,
    pub(crate) silence_frames: u64,
    pub(crate) is_cut_off: bool,
    pub(crate) format_changed: bool,
    pub(crate) ffmpeg_message: Option<String>,
}

/// Removes the frames that an encoder added before and after the sound.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Trim {
    pub(crate) skip_frames: u64,
    pub(crate) kept_frames: Option<u64>,
}

impl Trim {
    /// Trims the next interleaved frames in place; `false` when all later frames are cut.
    pub(crate) fn apply(&mut self, frames: &mut Vec<f32>, channel_count: usize) -> bool {
        let channel_count = channel_count.max(1);
        let available = (frames.len() / channel_count) as u64;
        let skip = self.skip_frames.min(available);
        self.skip_frames -= skip;
        let keep = self.kept_frames.map_or(available - skip, |kept| kept.min(available - skip));
        if let Some(kept) = &mut self.kept_frames {
            *kept -= keep;
        }
        if skip > 0 {
            frames.drain(..skip as usize * channel_count);
        }
        frames.truncate(keep as usize * channel_count);
        self.kept_frames != Some(0)
    }
}
