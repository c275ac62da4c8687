//! Arguments of `listen`.

use super::groups::{KnownArguments, ToneArguments, typed_path};
use clap::Args;
use std::path::PathBuf;

const LISTEN_EXAMPLES: &str = "\
Keys on the screen: q ends, f freezes the numbers, 1 to 9 decides for a speed where several are possible.

A pipe is heard as it arrives. Linux: `arecord -q -f S16_LE -r 48000 | hovertone listen --blades 2 --from-file -`.
A Mac: `ffmpeg -v quiet -f avfoundation -i :0 -f wav - | hovertone listen --blades 2 --from-file -`.

Examples:
  hovertone listen --blades 2 --from-file hover.mp4
  hovertone listen --vehicle ardrone --from-file hover.mov --speed 20 --json";

/// Rotor speed of sound as it arrives: a pipe or a microphone, or a recording played as if it were live
///
/// After two seconds, and every four seconds from then on, the last four seconds are analysed as `hovertone speed` does. In between, the
/// rotors are followed in steps of 0.1 s.
#[derive(Args, Debug)]
#[command(after_help = LISTEN_EXAMPLES)]
pub(crate) struct ListenArguments {
    /// Hear this recording; - is a pipe, heard as it arrives
    #[cfg_attr(not(feature = "microphone"), arg(required = true))]
    #[arg(long, value_name = "FILE", value_parser = typed_path())]
    pub(crate) from_file: Option<PathBuf>,
    /// Play the recording at this multiple of its own speed
    #[arg(long, value_name = "X", default_value_t = 1.0)]
    pub(crate) speed: f64,
    #[command(flatten)]
    pub(crate) tone: ToneArguments,
    #[command(flatten)]
    pub(crate) known: KnownArguments,
    /// Find only the mean speed, without separating the rotors
    #[arg(long, help_heading = "How it is analysed")]
    pub(crate) mean_only: bool,
    /// Channel to hear, counted from 1 [default: the mean of all]
    #[arg(long, value_name = "N", help_heading = "Reading files")]
    pub(crate) channel: Option<usize>,
    /// Print a line every second instead of drawing a screen; this is the default where stdout is no terminal
    #[arg(long, help_heading = "Output", conflicts_with = "json")]
    pub(crate) plain: bool,
    /// Print one JSON object per line, ten for each second of sound
    #[arg(long, help_heading = "Output")]
    pub(crate) json: bool,
}
