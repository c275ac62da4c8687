//! Files as people have them: every container and codec, damaged ones, and bytes that are no sound.

// The lints know tests by their attribute, and what tests share has none.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::print_stderr)]

mod broken_files;
mod every_container;
mod ffmpeg_route;
mod other_decoder;
mod recordings;
mod robustness;
mod wav_values;
mod without_paths;
