//! Paths that lead to pipes and devices, or to the same file as others.

use std::fs::File;
use std::io;
use std::path::Path;
use std::sync::mpsc;
use std::thread;
use std::time::Duration;
use tabray_core::files::{Access, open_any, refuse_outside};

/// The time that a program may take to open the other end of a named pipe.
const PATIENCE: Duration = Duration::from_secs(5);

/// Opens a file, a device or a pipe to read it once. At a pipe it waits up to 5 s for a program to write.
///
/// # Errors
/// Those of the system, and an error where no program writes to the pipe.
pub fn open_stream(path: &Path) -> io::Result<File> {
    refuse_outside(path)?;
    patiently(path, "writes to", Access::Stream)
}

/// Opens a device or a pipe to write to it. At a pipe it waits up to 5 s for a program to read.
///
/// # Errors
/// Those of the system, and an error where no program reads the pipe.
pub fn open_sink(path: &Path) -> io::Result<File> {
    refuse_outside(path)?;
    patiently(path, "reads", Access::Write)
}

/// Opens a path. At a pipe, this takes no longer than [`PATIENCE`]; `does` says what the program at the other end does with
/// the pipe.
fn patiently(path: &Path, does: &str, access: Access) -> io::Result<File> {
    if !is_pipe(path) {
        return open_any(path, access);
    }
    let (sender, opened) = mpsc::channel();
    let path = path.to_owned();
    // If no program ever opens the other end, the thread ends with this process.
    thread::Builder::new().name("pipe".to_owned()).spawn(move || sender.send(open_any(&path, access)))?;
    opened.recv_timeout(PATIENCE).unwrap_or_else(|_| {
        Err(io::Error::other(format!("no program {does} this pipe (waited {} s)", PATIENCE.as_secs())))
    })
}

#[cfg(unix)]
fn is_pipe(path: &Path) -> bool {
    use std::os::unix::fs::FileTypeExt;
    std::fs::metadata(path).is_ok_and(|kind| kind.file_type().is_fifo())
}

#[cfg(not(unix))]
fn is_pipe(_: &Path) -> bool {
    false
}

/// Returns whether two paths lead to the same file. A pipe is not opened to compare it, because that might wait for ever.
pub fn are_same(one: &Path, other: &Path) -> bool {
    one.is_file() && other.is_file() && same_file::is_same_file(one, other).unwrap_or(false)
}
