//! Version of the program.

/// Version of the program that made an output.
pub const VERSION: &str = env!("CARGO_PKG_VERSION");
