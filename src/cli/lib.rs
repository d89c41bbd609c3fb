//! The command line: one file per subcommand, and in folders what they share: `rendering`, `files`, `options` and, below
//! all of it, `process`.

mod bench;
mod chart;
mod check;
mod choose;
mod completions;
mod convert;
mod course;
mod diff;
mod dump;
mod explain;
mod farm;
mod files;
mod film;
mod fmt;
#[cfg(feature = "fuzz")]
#[doc(hidden)]
#[path = "../../tests/fuzz/entries.rs"]
pub mod fuzz;
mod grade;
mod grammar;
mod heap;
mod hits;
mod list;
mod lsp;
mod man;
mod measuring;
mod merge;
mod mesh;
mod new;
mod notes;
mod options;
mod plan;
mod probe;
mod process;
mod render;
mod rendering;
mod report;
mod review;
mod schema;
mod serve;
mod verify;
mod watch;

pub use heap::Heap;

use clap::{CommandFactory, FromArgMatches, Parser, Subcommand};
#[cfg(target_os = "linux")]
use nix::sys::signal::{SigSet, Signal};
use process::failure::{Failure, report};
#[cfg(target_os = "linux")]
use process::interrupt;
use process::messages::Told;
use process::{arguments, bounds, color, crash, help, memory, messages, program, progress};
use std::io::{self, IsTerminal, Write};
use std::process::ExitCode;
use tabray_lang::registry::Registry;

/// A ray tracer in which a scene is data and every entity type is a plugin
///
/// Without a command, behaves like the program of the course notes: reads a scene from standard input, prints its dump
/// to standard error and writes its image, a PPM, to standard output. Unless the scene's camera says otherwise, it uses
/// the notes' own methods. Warnings follow the dump; `--quiet` leaves them out.
#[derive(Parser)]
#[command(name = "tabray", version, after_help = EXIT_STATUS, after_long_help = EXAMPLES)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
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

#[derive(Subcommand)]
enum Command {
    Render(Box<render::Args>),
    Merge(merge::Args),
    Film(film::Args),
    Farm(farm::Args),
    Dump(dump::Args),
    Convert(convert::Args),
    Mesh(mesh::Args),
    Check(check::Args),
    Fmt(fmt::Args),
    Plan(plan::Args),
    Probe(probe::Args),
    Hits(Box<hits::Args>),
    Judge(hits::judge::Args),
    Hard(hits::hard::Args),
    Verify(verify::Args),
    Chart(chart::Args),
    Choose(choose::Args),
    Diff(diff::Args),
    Grade(grade::Args),
    Review(review::Args),
    Watch(watch::Args),
    Bench(bench::Args),
    List(list::Args),
    New(new::Args),
    Schema(schema::Args),
    Grammar(grammar::Args),
    Lsp(lsp::Args),
    Completions(completions::Args),
    Man(man::Args),
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

/// Returns the command line, under the name of the running program.
fn command() -> clap::Command {
    help::grouped(program::named(Cli::command()))
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
    let matches = match arguments::matches(command()) {
        Ok(matches) => matches,
        Err(failure) => return report(&failure),
    };
    let cli = Cli::from_arg_matches(&matches).unwrap_or_else(|error| error.exit());
    color::choose(cli.color);
    let told = match (cli.quiet, &cli.command) {
        (false, _) => Told::All,
        (true, Some(_)) => Told::ErrorsAndWarnings,
        (true, None) => Told::Errors,
    };
    messages::choose(cli.message_format, told);
    progress::choose(cli.progress);
    if let Err(failure) = cli.bounds.keep() {
        return report(&failure);
    }
    let outcome = match Registry::get() {
        Ok(registry) => match cli.command {
            Some(Command::Render(args)) => render::run(registry, *args),
            Some(Command::Merge(args)) => merge::run(&args),
            Some(Command::Film(args)) => film::run(&args),
            Some(Command::Farm(args)) => farm::run(registry, &args),
            Some(Command::Dump(args)) => dump::run(registry, args),
            Some(Command::Convert(args)) => convert::run(registry, args),
            Some(Command::Mesh(args)) => mesh::run(registry, &args),
            Some(Command::Check(args)) => check::run(registry, args),
            Some(Command::Fmt(args)) => fmt::run(registry, &args),
            Some(Command::Plan(args)) => plan::run(registry, args),
            Some(Command::Probe(args)) => probe::run(registry, args),
            Some(Command::Hits(args)) => hits::run(registry, *args),
            Some(Command::Judge(args)) => hits::judge::run(registry, args),
            Some(Command::Hard(args)) => hits::hard::run(registry, args),
            Some(Command::Verify(args)) => verify::run(registry, args),
            Some(Command::Chart(args)) => chart::run(registry, args),
            Some(Command::Choose(args)) => choose::run(registry, args),
            Some(Command::Diff(args)) => return diff::run(registry, &args),
            Some(Command::Grade(args)) => return grade::run(registry, &args),
            Some(Command::Review(args)) => review::run(registry, &args),
            Some(Command::Watch(args)) => watch::run(registry, args),
            Some(Command::Bench(args)) => bench::run(registry, args),
            Some(Command::List(args)) => list::run(registry, args),
            Some(Command::New(args)) => new::run(registry, &args),
            Some(Command::Schema(_)) => schema::run(registry),
            Some(Command::Grammar(_)) => grammar::run(registry),
            Some(Command::Lsp(_)) => lsp::run(registry),
            Some(Command::Completions(args)) => completions::run(registry, &args, command()),
            Some(Command::Man(args)) => man::run(registry, &args, command()),
            None if io::stdin().is_terminal() => {
                let _ = write!(io::stderr(), "{}", command().render_long_help());
                Err(Failure::Told)
            }
            None => notes::run(registry),
        },
        Err(faults) => {
            faults.lines().for_each(|fault| messages::error(fault, None));
            return ExitCode::from(1);
        }
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => report(&failure),
    }
}

// Tests read scenes, and so need entity types.
#[cfg(test)]
use tabray_plugins as _;
