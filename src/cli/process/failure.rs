//! The end of a command: its output, or a failure.

use crate::files::standard::StandardOutput;
use crate::process::{messages, progress, temporary};
use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::process::{self, ExitCode};
use std::thread;
use std::time::Duration;
use tabray_core::text;
use tabray_lang::reader::Report;

/// The time in which a program that ends must have said why.
const SAYING: Duration = Duration::from_millis(500);

/// The reason why a command failed.
pub enum Failure {
    /// The scene has faults.
    Scene(Report),
    /// The request makes no sense. The cure is given where there is one.
    Usage(String, Option<String>),
    /// The system or another program caused the failure.
    Failed(String),
    /// A file that the command names cannot be read; with what was probably meant.
    Unread(String, Option<String>),
    /// The user interrupted the command; with the state of its work.
    Interrupted(&'static str),
    /// The command stopped with a part of its work done, and the user was told already.
    Stopped,
    /// Faults were printed already.
    AlreadyReported,
    /// Some of several scenes failed, which was printed already; with the worst exit status of these.
    Several(u8),
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Self {
        Self::Failed(text::reason(&error))
    }
}

impl Failure {
    /// Makes a failure of a request that makes no sense.
    pub fn usage(message: impl Into<String>) -> Self {
        Self::Usage(message.into(), None)
    }

    /// Adds the cure, or what was probably meant.
    pub fn help(mut self, cure: impl Into<String>) -> Self {
        if let Self::Usage(_, help) | Self::Unread(_, help) = &mut self {
            *help = Some(cure.into());
        }
        self
    }

    /// Makes a failure of a path that could not be written, with the reason.
    pub fn cannot_write(path: &Path, error: &io::Error) -> Self {
        if path == Path::new("-") {
            return Self::Failed(format!("cannot write to standard output: {}", text::reason(error)));
        }
        let folder = path.parent().filter(|folder| *folder != Path::new("") && !folder.exists());
        let reason = match folder {
            Some(folder) if error.kind() == io::ErrorKind::NotFound => {
                format!("there is no folder `{}`", text::shown(folder))
            }
            _ => text::reason(error),
        };
        Self::Failed(format!("cannot write `{}`: {reason}", text::shown(path)))
    }

    /// Makes a failure of a path that could not be read, with the reason: that of the system, or what is wrong with a file
    /// that is not what the command needs.
    pub fn cannot_read(path: &Path, error: &io::Error) -> Self {
        let message = format!("cannot read `{}`: {}", text::shown(path), text::reason(error));
        match error.kind() {
            io::ErrorKind::InvalidData => Self::usage(message),
            _ => Self::Unread(message, None),
        }
    }
}

/// Prints why a command failed, and returns the exit status.
pub fn report(failure: &Failure) -> ExitCode {
    report_and_status(failure).into()
}

/// Prints why a command failed, and ends the program, whatever its other threads are doing.
pub fn end(failure: &Failure) -> ! {
    progress::clear();
    end_keeping_bar(failure)
}

/// Lets the program end soon with a failure's status, even if the reader of standard error does not read, so that no
/// thread can say any more why it ends.
pub fn end_even_if_blocked(failure: &Failure) {
    let status = status(failure);
    // Without the thread, the program still ends once somebody reads.
    let _ = thread::Builder::new().spawn(move || {
        thread::sleep(SAYING);
        temporary::remove_all();
        process::exit(status.into());
    });
}

/// Ends the program as [`end`] does, but a bar on the terminal stays: it may be what the thread was drawing.
pub fn end_keeping_bar(failure: &Failure) -> ! {
    // From here on no other thread prints anything.
    let _held = io::stderr().lock();
    let status = report_and_status(failure);
    temporary::remove_all();
    process::exit(status.into())
}

/// Ends the program after it has finished its work, without waiting for other threads.
pub fn exit() -> ! {
    progress::clear();
    temporary::remove_all();
    process::exit(0)
}

fn report_and_status(failure: &Failure) -> u8 {
    match failure {
        Failure::Scene(report) => messages::report(report),
        Failure::Usage(message, help) | Failure::Unread(message, help) => {
            messages::error(message, help.as_deref());
        }
        Failure::Failed(message) => messages::error(message, None),
        Failure::Interrupted(what) => messages::note(&format!("interrupted: {what}")),
        Failure::Stopped | Failure::AlreadyReported | Failure::Several(_) => {}
    }
    if let (Failure::Interrupted(_) | Failure::Stopped, Some([done, all])) = (failure, progress::overall()) {
        messages::note(&format!("{done} of {all} scenes are rendered"));
    }
    status(failure)
}

/// Returns the exit status of a failure.
pub fn status(failure: &Failure) -> u8 {
    match failure {
        Failure::Several(worst) => *worst,
        Failure::Failed(_) | Failure::Unread(..) => 1,
        Failure::Scene(_) | Failure::Usage(..) | Failure::AlreadyReported => 2,
        Failure::Interrupted(_) | Failure::Stopped => 130,
    }
}

/// Prints text for people to standard output. A reader that closes the pipe is no failure.
pub fn print(text: &str) -> Result<(), Failure> {
    print_bytes(text::visible_lines(text).as_bytes())
}

/// Prints a scene, which another program may read, to standard output: as it is, unless that is a terminal.
pub fn print_scene(text: &str) -> Result<(), Failure> {
    if io::stdout().is_terminal() { print(text) } else { print_bytes(text.as_bytes()) }
}

fn print_bytes(bytes: &[u8]) -> Result<(), Failure> {
    match StandardOutput.write_all(bytes).and_then(|()| StandardOutput.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::cannot_write(Path::new("-"), &error))
        }
        _ => Ok(()),
    }
}
