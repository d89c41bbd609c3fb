//! The command line: one file per subcommand, and what they share.

mod aov;
mod check;
mod convert;
mod debug;
mod diff;
mod dump;
mod explain;
mod input;
mod interrupt;
mod list;
mod method;
mod notes;
mod output;
mod picture;
mod probe;
mod render;
mod report;
mod review;
mod schema;
mod serve;
mod verify;

use crate::registry::Registry;
use crate::scene::Report;
use annotate_snippets::{Group, Level, Renderer};
use clap::{CommandFactory, Parser, Subcommand};
use std::io::{self, IsTerminal, Write};
use std::process::ExitCode;

/// A ray tracer in which a scene is data and every entity type is a plugin
///
/// Without a command it does what the course notes' program does: it reads a scene from standard input, prints
/// its dump to standard error and writes its picture, a PPM, to standard output.
#[derive(Parser)]
#[command(version, after_help = EXIT_STATUS)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

#[derive(Subcommand)]
enum Command {
    Render(render::Args),
    Dump(dump::Args),
    Convert(convert::Args),
    Check(check::Args),
    Probe(probe::Args),
    Verify(verify::Args),
    Diff(diff::Args),
    Review(review::Args),
    List(list::Args),
    Schema(schema::Args),
}

const EXIT_STATUS: &str = "\
Exit status:
    0  all went well
    1  a failure: something could not be read, written or started
    2  bad input: a scene or a command line with faults
  130  interrupted";

/// Why a command did not do what it was asked to.
enum Failure {
    /// The scene has faults.
    Scene(Report),
    /// What was asked for makes no sense; what would, if that can be said.
    Usage(String, Option<String>),
    /// The machine or another program stood in the way.
    Failed(String),
    /// The user stopped it.
    Interrupted,
    /// Faults that were printed already.
    Told,
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        Self::Failed(error.to_string())
    }
}

/// Runs the command that the program's arguments name, with every plugin that is linked into it. Its messages go to
/// standard error, and its exit status tells how it went.
pub fn run() -> ExitCode {
    let cli = Cli::parse();
    let outcome = match Registry::get() {
        Ok(registry) => match cli.command {
            Some(Command::Render(args)) => render::run(registry, args),
            Some(Command::Dump(args)) => dump::run(registry, args),
            Some(Command::Convert(args)) => convert::run(registry, args),
            Some(Command::Check(args)) => check::run(registry, args),
            Some(Command::Probe(args)) => probe::run(registry, args),
            Some(Command::Verify(args)) => verify::run(registry, args),
            Some(Command::Diff(args)) => return diff::run(registry, &args),
            Some(Command::Review(args)) => review::run(registry, &args),
            Some(Command::List(args)) => list::run(registry, args),
            Some(Command::Schema(_)) => schema::run(registry),
            None if io::stdin().is_terminal() => {
                let mut command = Cli::command();
                let _ = write!(io::stderr(), "{}", command.render_long_help());
                Err(Failure::Told)
            }
            None => notes::run(registry),
        },
        Err(fault) => Err(Failure::Failed(fault.to_owned())),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => tell(&failure),
    }
}

fn tell(failure: &Failure) -> ExitCode {
    let message = match failure {
        Failure::Scene(report) => report.styled(),
        Failure::Usage(message, help) => plain(message, help.as_deref()),
        Failure::Failed(message) => plain(message, None),
        Failure::Interrupted => "interrupted: the picture was not finished\n".to_owned(),
        Failure::Told => String::new(),
    };
    // Where standard error is closed there is nobody to tell.
    let _ = anstream::stderr().write_all(message.as_bytes());
    ExitCode::from(match failure {
        Failure::Failed(_) => 1,
        Failure::Scene(_) | Failure::Usage(..) | Failure::Told => 2,
        Failure::Interrupted => 130,
    })
}

fn plain(message: &str, help: Option<&str>) -> String {
    let help = help.map(|help| Level::HELP.message(help));
    let group = Group::with_title(Level::ERROR.primary_title(message)).elements(help);
    Renderer::styled().render(&[group]) + "\n"
}

/// Prints to standard output. A reader that has had enough is no failure.
fn print(text: &str) -> Result<(), Failure> {
    match io::stdout().write_all(text.as_bytes()).and_then(|()| io::stdout().flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::Failed(format!("cannot write to standard output: {error}")))
        }
        _ => Ok(()),
    }
}
