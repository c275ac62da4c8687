//! Arguments of `spectrogram`.

use super::groups::{
    AnalysisArguments, HearingArguments, KnownArguments, ReplaceArguments, ToneArguments, typed_path, whole_number,
};
use clap::Args;
use std::path::PathBuf;

const EXAMPLES: &str = "\
The axis is in Hz; where the order of the tone is known, a second axis shows turns of the shaft per second. The bands of the tone and of \
its harmonics are marked, and parts without hover are pale. The speeds that were found are drawn as lines.

Examples:
  hovertone spectrogram hover.mp4 -o hover.png
  hovertone spectrogram --vehicle ardrone hover.mov -o hover.svg
  hovertone spectrogram --blades 2 --from 14 --to 17 bench.wav -o bench.png";

/// The spectrogram of a recording as a picture for a publication: 180 mm wide, PNG or SVG
#[derive(Args, Debug)]
#[command(after_help = EXAMPLES)]
pub(crate) struct SpectrogramArguments {
    /// Recording: a video or audio file; - is stdin
    #[arg(value_name = "FILE", value_parser = typed_path())]
    pub(crate) file: PathBuf,
    /// Where to write: x.png or x.svg
    #[arg(short, long, value_name = "PICTURE", help_heading = "Output", value_parser = typed_path())]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) replace: ReplaceArguments,
    /// Dots per inch of a PNG [default: 300]
    #[arg(long, value_name = "N", value_parser = whole_number(50u16..=1200), help_heading = "Output")]
    pub(crate) dpi: Option<u16>,
    #[command(flatten)]
    pub(crate) tone: ToneArguments,
    #[command(flatten)]
    pub(crate) known: KnownArguments,
    #[command(flatten)]
    pub(crate) analysis: AnalysisArguments,
    #[command(flatten)]
    pub(crate) hearing: HearingArguments,
}
