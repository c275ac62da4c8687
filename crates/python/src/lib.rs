//! The Python package hovertone: its module in Rust. It translates calls and results, and calculates nothing.
//!
//! ```text
//! call        words and arrays of Python → a call of a command, with its progress; the GIL is released while it runs
//! failure     a refusal → an exception with the words of the command line
//! heard       a recording with its answer        identified   an experiment with its constant
//! ```

mod call;
mod failure;
mod heard;
mod identified;

use pyo3::prelude::*;

/// The module `hovertone._native`.
#[pymodule]
mod _native {
    #[pymodule_export]
    use crate::call::{archive_names, archive_row, heard, identified, loaded, printed};
    #[pymodule_export]
    use crate::heard::Heard;
    #[pymodule_export]
    use crate::identified::Identified;
}
