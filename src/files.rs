//! Opening what a scene or a command names, which may be no file at all.

use std::fs::{self, File};
use std::io;
use std::path::Path;
use std::sync::mpsc;
use std::thread;
use std::time::Duration;

/// How long somebody may take to begin to write to a named pipe.
const PATIENCE: Duration = Duration::from_secs(5);

/// Opens a file to read it. A pipe, at which this might wait for ever, and a device, which might never end, are none.
///
/// # Errors
/// Those of the system, and where there is something else than a file.
pub fn open(path: &Path) -> io::Result<File> {
    let kind = fs::metadata(path)?;
    if kind.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    if !kind.is_file() {
        return Err(io::Error::other("it is a pipe or a device, not a file"));
    }
    File::open(path)
}

/// Opens a file, a device or a pipe to read it once. At a pipe it waits for somebody to write, but not for ever.
///
/// # Errors
/// Those of the system, and where nobody writes.
pub fn open_stream(path: &Path) -> io::Result<File> {
    if !is_pipe(path) {
        return File::open(path);
    }
    let (sender, opened) = mpsc::channel();
    let path = path.to_owned();
    // Where nobody ever writes, the thread ends with the program.
    thread::Builder::new().name("pipe".to_owned()).spawn(move || sender.send(File::open(path)))?;
    opened.recv_timeout(PATIENCE).unwrap_or_else(|_| {
        Err(io::Error::other(format!("no program writes to this pipe (waited {} s)", PATIENCE.as_secs())))
    })
}

#[cfg(unix)]
fn is_pipe(path: &Path) -> bool {
    use std::os::unix::fs::FileTypeExt;
    fs::metadata(path).is_ok_and(|kind| kind.file_type().is_fifo())
}

#[cfg(not(unix))]
fn is_pipe(_: &Path) -> bool {
    false
}
