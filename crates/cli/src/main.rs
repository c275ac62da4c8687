//! `hovertone`: hears a multirotor hover and tells its rotor speeds and its thrust constant.

use std::process::ExitCode;

fn main() -> ExitCode {
    hovertone_cli::run()
}
