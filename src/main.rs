//! The `tabray` program.

use std::process::ExitCode;
use tabray::cli;

#[global_allocator]
static HEAP: cli::Heap = cli::Heap;

fn main() -> ExitCode {
    cli::run()
}
