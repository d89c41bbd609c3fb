//! How a command ends: with what it prints, or with a failure.

use super::{messages, progress, temporary};
use crate::scene::reader::Report;
use crate::words;
use std::io::{self, Write};
use std::path::Path;
use std::process::{self, ExitCode};

/// Why a command did not do what it was asked to.
pub enum Failure {
    /// The scene has faults.
    Scene(Report),
    /// What was asked for makes no sense; what would, if that can be said.
    Usage(String, Option<String>),
    /// The machine or another program stood in the way.
    Failed(String),
    /// The user stopped it: what is there of it, or is not.
    Interrupted(&'static str),
    /// It was stopped with a part of its work done, of which the user was told already.
    Stopped,
    /// Faults that were printed already.
    Told,
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        Self::Failed(words::reason(&error))
    }
}

impl Failure {
    /// What the system does not let be written, and why.
    pub fn cannot_write(path: &Path, error: &io::Error) -> Self {
        if path == Path::new("-") {
            return Self::Failed(format!("cannot write to standard output: {}", words::reason(error)));
        }
        let folder = path.parent().filter(|folder| *folder != Path::new("") && !folder.exists());
        let reason = match folder {
            Some(folder) if error.kind() == io::ErrorKind::NotFound => {
                format!("there is no folder `{}`", folder.display())
            }
            _ => words::reason(error),
        };
        Self::Failed(format!("cannot write `{}`: {reason}", path.display()))
    }
}

/// Says why a command failed, and gives the exit status that tells it.
pub fn tell(failure: &Failure) -> ExitCode {
    told(failure).into()
}

/// Says why a command failed, and ends the program, whatever its other threads are at.
pub fn end(failure: &Failure) -> ! {
    progress::clear();
    // Nobody else says anything from here on.
    let _held = io::stderr().lock();
    let status = told(failure);
    temporary::remove_all();
    process::exit(status.into())
}

fn told(failure: &Failure) -> u8 {
    match failure {
        Failure::Scene(report) => messages::report(report),
        Failure::Usage(message, help) => messages::error(message, help.as_deref()),
        Failure::Failed(message) => messages::error(message, None),
        Failure::Interrupted(what) => messages::note(&format!("interrupted: {what}")),
        Failure::Stopped | Failure::Told => {}
    }
    match failure {
        Failure::Failed(_) => 1,
        Failure::Scene(_) | Failure::Usage(..) | Failure::Told => 2,
        Failure::Interrupted(_) | Failure::Stopped => 130,
    }
}

/// Prints to standard output. A reader that has had enough is no failure.
pub fn print(text: &str) -> Result<(), Failure> {
    match io::stdout().write_all(text.as_bytes()).and_then(|()| io::stdout().flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::cannot_write(Path::new("-"), &error))
        }
        _ => Ok(()),
    }
}
