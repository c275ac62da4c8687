//! Arguments of `batch`.

use super::groups::{
    AnalysisArguments, HearingArguments, KnownArguments, ReplaceArguments, ToneArguments, typed_path, whole_number,
};
use clap::Args;
use hovertone_archive::Shard;
use std::path::PathBuf;

const BATCH_EXAMPLES: &str = "\
Each finished recording is kept at once, so a run that was stopped can go on: give the same command again. It hears only \
recordings that are new or changed. A file that cannot be heard gets a row with its error.
OUT holds recordings.parquet (a row for each recording), tracks/ (its speed over time) and overview.html.

Put a pattern into quotes: then a later run finds new recordings too. Without quotes, the shell replaces the pattern by \
the names of today.

Examples:
  hovertone batch archive -o speeds --blades 2
  hovertone batch archive -o speeds --blades 2 --shard 3/8     one of eight jobs that share a folder
  hovertone batch list.txt -o listed --vehicle ardrone";

/// Rotor speeds of an archive of recordings, as Parquet files: on all cores, and a stopped run can go on
///
/// Hears each recording as `hovertone speed` does, with the same flags.
#[derive(Args, Debug)]
#[command(after_help = BATCH_EXAMPLES)]
pub(crate) struct BatchArguments {
    /// Folders with recordings at any depth, patterns, recordings, or lists: .txt with a name on each line; - is a list from stdin.
    /// Addresses in stores too: s3://BUCKET/FOLDER, gs://, az://, https://HOST/FILE (feature stores)
    #[arg(required = true, value_name = "DIR|PATTERN|LIST|URL", value_parser = typed_path())]
    pub(crate) inputs: Vec<PathBuf>,
    /// Folder of the results
    #[arg(short, long, value_name = "OUT", value_parser = typed_path(), help_heading = "Output")]
    pub(crate) output: PathBuf,
    /// Hear only part I of N of the recordings: all N jobs share OUT, and the last job that ends writes the tables
    #[arg(long, value_name = "I/N", help_heading = "How it runs")]
    pub(crate) shard: Option<Shard>,
    /// Recordings that are heard at the same time [default: one for each core]
    #[arg(long, value_name = "N", value_parser = whole_number(1usize..=1024), help_heading = "How it runs")]
    pub(crate) threads: Option<usize>,
    /// Hear again the recordings that could not be heard
    #[arg(long, help_heading = "How it runs")]
    pub(crate) retry: bool,
    #[command(flatten)]
    pub(crate) tone: ToneArguments,
    #[command(flatten)]
    pub(crate) known: KnownArguments,
    #[command(flatten)]
    pub(crate) analysis: AnalysisArguments,
    #[command(flatten)]
    pub(crate) hearing: HearingArguments,
    /// Print one JSON object with the counts
    #[arg(long, help_heading = "Output")]
    pub(crate) json: bool,
    #[command(flatten)]
    pub(crate) replace: ReplaceArguments,
}

const COMPARE_EXAMPLES: &str = "\
Recordings that have the same name in both archives are compared one by one; the change of a rotor is the weighted mean \
of these changes. Where no name is in both, the means of all recordings are compared (Welch's test). All stated \
uncertainties are used. p is corrected for the number of tests (Holm).

Examples:
  hovertone batch-compare january february
  hovertone batch-compare old-propeller new-propeller --json";

/// Which rotors have changed between two archives: today against last month, a new propeller against the old one
#[derive(Args, Debug)]
#[command(after_help = COMPARE_EXAMPLES)]
pub(crate) struct BatchCompareArguments {
    /// Results of the earlier archive: OUT of `hovertone batch`
    #[arg(value_name = "OUT1", value_parser = typed_path())]
    pub(crate) earlier: PathBuf,
    /// Results of the later archive
    #[arg(value_name = "OUT2", value_parser = typed_path())]
    pub(crate) later: PathBuf,
    /// Print one JSON object
    #[arg(long)]
    pub(crate) json: bool,
}
