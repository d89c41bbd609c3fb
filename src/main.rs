//! The `tabray` program.

use std::process::ExitCode;

fn main() -> ExitCode {
    tabray::cli::run()
}
