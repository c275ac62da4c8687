//! Arguments of `vehicles`.

use clap::Args;

/// The vehicles that hovertone knows: every number with the document it was read in
#[derive(Args, Debug)]
pub(crate) struct VehiclesArguments {
    /// Print JSON
    #[arg(long)]
    pub(crate) json: bool,
}
