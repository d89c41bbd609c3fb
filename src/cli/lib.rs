//! The command line: one file per subcommand, and in folders what they share: `rendering`, `files`, `options` and, below
//! all of it, `process`.

mod check;
pub mod command;
mod completions;
mod convert;
mod course;
mod dump;
pub mod files;
#[cfg(feature = "fuzz")]
#[doc(hidden)]
#[path = "../../tests/fuzz/entries.rs"]
pub mod fuzz;
mod heap;
mod list;
mod man;
mod merge;
mod new;
mod notes;
pub mod options;
pub mod plan;
mod probe;
pub mod process;
pub mod render;
mod rendering;
mod verify;

pub use clap;
pub use command::{Command, Group, Run};
pub use heap::Heap;
pub use process::failure::{Failure, print};

use clap::{CommandFactory, FromArgMatches, Parser};
use command::Outcome;
#[cfg(target_os = "linux")]
use nix::sys::signal::{SigSet, Signal};
use process::failure::report;
#[cfg(target_os = "linux")]
use process::interrupt;
use process::messages::Verbosity;
use process::{arguments, bounds, color, crash, help, memory, messages, program, progress, time_limit};
use std::io::{self, IsTerminal, Write};
use std::process::ExitCode;
use tabray_lang::registry::Registry;

/// A ray tracer in which a scene is data and every entity type is a plugin
///
/// Without a command, behaves like the program of the course notes: reads a scene from standard input, prints its dump
/// to standard error and writes its image, a PPM, to standard output. Unless the scene's camera says otherwise, it uses
/// the notes' own methods. Warnings follow the dump; `--quiet` leaves them out.
#[derive(Parser)]
#[command(name = "tabray", version, after_help = EXIT_STATUS)]
struct Cli {
    /// The format of messages
    #[arg(long, global = true, value_name = "FORM", default_value = "human")]
    message_format: messages::Form,
    /// Print only errors and warnings
    #[arg(short, long, global = true)]
    quiet: bool,
    /// The form of the progress display
    #[arg(long, global = true, value_name = "FORM", default_value = "bar")]
    progress: progress::Form,
    /// Whether messages have colours
    #[arg(long, global = true, value_name = "WHEN", default_value = "auto")]
    color: color::Color,
    #[command(flatten)]
    bounds: bounds::Args,
}

macro_rules! exit_status {
    () => {
        "\
Exit status:
    0  success
    1  failure: something could not be read, written or started
    2  bad input: a scene or a command line with errors
  130  interrupted, or stopped at a limit"
    };
}

const EXIT_STATUS: &str = exit_status!();

const EXAMPLES: &str = concat!(
    exit_status!(),
    "\n\nExamples:
  tabray new scene ball                     # writes ball.ray, a scene to start from
  tabray render ball.ray                    # writes ball.png
  tabray watch ball.ray --open              # shows it in the browser, and each change
  tabray render ball.ray -o big.png --size 1600 --samples 16
  tabray help render                        # explains the options of `render`"
);

/// Returns [`EXAMPLES`] without those of commands that are not linked.
fn examples() -> String {
    let is_linked = |line: &&str| {
        let command = line.strip_prefix("  tabray ").and_then(|rest| rest.split(' ').next());
        command.is_none_or(|name| name == "help" || Command::named(name).is_some())
    };
    EXAMPLES.lines().filter(is_linked).collect::<Vec<_>>().join("\n")
}

/// Returns the command line, under the name of the running program.
pub fn line() -> clap::Command {
    help::grouped(program::named(command::with_all(Cli::command().after_long_help(examples()))))
}

/// Runs the command that the program's arguments name, with every plugin that is linked in. Messages go to standard
/// error, and the exit status tells how the command ended.
pub fn run() -> ExitCode {
    // A file that exceeds the limit on file sizes then causes an error, like a full disk, and does not end the program
    // without a message. If the signal cannot be blocked, it ends the program as before.
    #[cfg(target_os = "linux")]
    let _ = SigSet::from(Signal::SIGXFSZ).thread_block();
    #[cfg(target_os = "linux")]
    interrupt::keep_ignoring_hangups();
    crash::capture_panics();
    memory::report_refused_allocations();
    crash::catch(chosen).unwrap_or_else(|failure| report(&failure))
}

fn chosen() -> ExitCode {
    if let Some(faults) = command::contradictions() {
        return refused(faults);
    }
    let matches = match arguments::matches(line()) {
        Ok(matches) => matches,
        Err(failure) => return report(&failure),
    };
    let cli = Cli::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
    color::choose(cli.color);
    let chosen = matches.subcommand();
    let verbosity = match (cli.quiet, chosen) {
        (false, _) => Verbosity::All,
        (true, Some(_)) => Verbosity::ErrorsAndWarnings,
        (true, None) => Verbosity::Errors,
    };
    messages::choose(cli.message_format, verbosity);
    progress::choose(cli.progress);
    if let Err(failure) = cli.bounds.keep() {
        return report(&failure);
    }
    let registry = match Registry::get() {
        Ok(registry) => registry,
        Err(faults) => return refused(faults),
    };
    let chosen = chosen.map(|(name, matches)| {
        (Command::named(name).expect("clap knows the registered commands alone"), matches)
    });
    let is_kept = chosen.is_some_and(|(command, _)| command.keeps_time_limit);
    if !is_kept && let Err(failure) = time_limit::watch() {
        return report(&failure);
    }
    match chosen {
        Some((command, matches)) => command.run(registry, matches),
        None if io::stdin().is_terminal() => {
            let _ = write!(io::stderr(), "{}", help::on_one_screen(line()).render_help());
            report(&Failure::AlreadyReported)
        }
        None => notes::run(registry).exit_code(),
    }
}

/// Prints the contradictions of what plugins register.
fn refused(faults: &str) -> ExitCode {
    faults.lines().for_each(|fault| messages::error(fault, None));
    ExitCode::from(1)
}

// Tests read scenes, and so need entity types.
#[cfg(test)]
use tabray_plugins as _;
