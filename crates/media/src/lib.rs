//! The bytes of a video or audio file to a stream of samples, never resampled.
//!
//! [`Recording::open`] tells what a file is by its content, chooses an audio track and gives its sound as a
//! [`SignalSource`](hovertone_signal::SignalSource): mono, finite, at the rate it was recorded at, in blocks, so that memory
//! stays flat whatever the length. The way of the bytes:
//!
//! ```text
//! container   what the content is                  wave, matroska, ogg, iso, mpeg_audio: what their headers promise
//! tracks      the audio tracks, a plan for each    choose: the first that is not silent
//! plan        how one track is decoded             native, opus, wave, quicktime, ffmpeg: packets or samples to frames
//! recording   trim, mix, count what went wrong     frames, mix, warning
//! ```
//!
//! What Symphonia and opus-pure cannot read goes through an `ffmpeg` where there is one ([`FfmpegUse`]).

mod choose;
mod clipped;
mod codec;
mod container;
mod error;
mod ffmpeg;
mod frames;
mod guard;
mod iso;
mod matroska;
mod mix;
mod mpeg_audio;
mod native;
mod ogg;
mod opus;
mod pcm_layout;
mod plan;
mod quicktime;
mod recording;
mod source;
mod tracks;
mod warning;
mod wave;

pub use container::Container;
pub use error::MediaError;
pub use ffmpeg::FfmpegUse;
pub use recording::{Decoder, OpenOptions, Recording, RecordingInfo};
pub use warning::MediaWarning;
