//! From the bytes of a video or audio file to a stream of samples that is never resampled.
//!
//! [`Recording::open`] recognises a file by its content, chooses an audio track and provides its sound as a
//! [`SignalSource`](hovertone_signal::SignalSource): mono, finite, at the recorded rate, in blocks, so that memory does not grow with the
//! length. The data flow:
//!
//! ```text
//! container   recognises the content                  wave, matroska, ogg, iso, mpeg_audio: facts in the headers
//! tracks      the audio tracks, a plan for each       choose: the first that is not silent
//! plan        how one track is decoded                native, opus, wave, quicktime, ffmpeg: packets or samples → frames
//! recording   trims, mixes, counts errors             frames, mix, mix_loss, warning; recording_info: its facts
//! coded_file  needs another decoder                   coded, packets: packets for it; decoded: its samples
//! ```
//!
//! [`PipedSound`] is the same for sound that arrives through a pipe, once; [`Samples`] are sound that is in memory already.
//!
//! Files that Symphonia and opus-pure cannot read go through an `ffmpeg`, if one is available ([`FfmpegUse`]). Where there is another decoder,
//! as in a browser, it gets the packets of [`CodedSound`], and its samples take the place of a decoder as [`DecodedSound`].

mod choose;
mod clipped;
mod codec;
mod coded;
mod coded_file;
mod container;
mod decoded;
mod error;
mod ffmpeg;
mod file_access;
mod frames;
mod guard;
mod iso;
mod matroska;
mod mix;
mod mix_loss;
mod mpeg_audio;
mod native;
mod ogg;
mod opus;
mod packets;
mod pcm_layout;
mod piped;
mod plan;
mod quicktime;
mod recording;
mod recording_info;
mod samples;
mod source;
mod tracks;
mod warning;
mod wave;

pub use coded::{CodedFormat, CodedPacket, CodedSound};
pub use container::Container;
pub use decoded::DecodedSound;
pub use error::MediaError;
pub use ffmpeg::FfmpegUse;
pub use file_access::{FileAccess, OpenFile, ReadSeek};
pub use piped::PipedSound;
pub use recording::{OpenOptions, Recording};
pub use recording_info::{Decoder, RecordingInfo};
pub use samples::Samples;
pub use warning::MediaWarning;
