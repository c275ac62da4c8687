//! Arguments of `completions` and `man`.

use super::groups::{ReplaceArguments, typed_path};
use clap::Args;
use clap_complete::Shell;
use std::path::PathBuf;

const COMPLETIONS_EXAMPLES: &str = "\
Where a shell looks for them, on most systems:
  bash   ~/.local/share/bash-completion/completions/hovertone
  zsh    a folder of $fpath, as _hovertone
  fish   ~/.config/fish/completions/hovertone.fish

Examples:
  hovertone completions bash
  hovertone completions zsh";

/// Completions for a shell: bash, zsh, fish, elvish or PowerShell
#[derive(Args, Debug)]
#[command(after_help = COMPLETIONS_EXAMPLES)]
pub(crate) struct CompletionsArguments {
    /// The shell
    #[arg(value_name = "SHELL", value_enum)]
    pub(crate) shell: Shell,
}

const MAN_EXAMPLES: &str = "\
Examples:
  hovertone man
  hovertone man speed
  hovertone man -o man1";

/// Man pages: of the program, of a command, or all of them as files
#[derive(Args, Debug)]
#[command(after_help = MAN_EXAMPLES)]
pub(crate) struct ManArguments {
    /// A command, such as speed [default: the program]
    #[arg(value_name = "COMMAND", conflicts_with = "output")]
    pub(crate) command: Option<String>,
    /// Write all pages there, as hovertone.1 and hovertone-COMMAND.1: a folder that is empty, new, or of earlier pages
    #[arg(short, long, value_name = "DIR", help_heading = "Output", value_parser = typed_path())]
    pub(crate) output: Option<PathBuf>,
    #[command(flatten)]
    pub(crate) replace: ReplaceArguments,
}
