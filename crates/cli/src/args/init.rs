//! Arguments of `init`.

use super::draft::{DraftArguments, MASS_HELP};
use super::groups::{ReplaceArguments, typed_path};
use clap::Args;
use std::path::PathBuf;

const INIT_EXAMPLES: &str = "\
Examples:
  hovertone init
  hovertone init --vehicle ardrone --mass 0.413=demo/no_hull/*.wav -o new.toml
  hovertone init --blades 2 --rotors 4 --diameter-m 0.2 --mass 413g=hover.mov -o mine.toml";

/// Writes an experiment file: it asks for the vehicle, the masses and the recordings, or takes them as flags
///
/// On a terminal, it asks for what no flag gives, and lists the recordings of the current folder and of the folders in it.
/// The file has comments, and `hovertone identify` reads it.
#[derive(Args, Debug)]
#[command(after_help = format!("{MASS_HELP}\n\n{INIT_EXAMPLES}"))]
pub(crate) struct InitArguments {
    #[command(flatten)]
    pub(crate) draft: DraftArguments,
    /// Name of the new experiment file
    #[arg(short, long, value_name = "FILE", default_value = "experiment.toml", help_heading = "Output", value_parser = typed_path())]
    pub(crate) output: PathBuf,
    #[command(flatten)]
    pub(crate) replace: ReplaceArguments,
}
