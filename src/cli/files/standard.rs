//! Standard output, which may have been closed before the program began.

#[cfg(unix)]
use std::fs;
#[cfg(unix)]
use std::io::ErrorKind::NotFound;
use std::io::{self, Write};
use std::sync::atomic::{AtomicBool, Ordering};

/// Standard output. Writing to one that was closed is an error.
pub struct StandardOutput;

impl Write for StandardOutput {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if was_closed() {
            return Err(io::Error::other("it is closed"));
        }
        io::stdout().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        io::stdout().flush()
    }
}

/// Tells whether standard output was closed when the program began.
fn was_closed() -> bool {
    WAS_CLOSED.load(Ordering::Relaxed)
}

static WAS_CLOSED: AtomicBool = AtomicBool::new(false);

/// What looks at standard output before `main`. There, Rust's runtime opens `/dev/null` in place of an output that was closed,
/// and no one can tell that from a `/dev/null` that the caller opened.
#[cfg(unix)]
struct BeforeMain;

/// Constructors ask for the registry, and thus run this.
#[cfg(unix)]
impl inventory::Collect for BeforeMain {
    fn registry() -> &'static inventory::Registry {
        static REGISTRY: inventory::Registry = inventory::Registry::new();
        // Where the folder cannot be seen, as without `/proc`, nothing is known.
        let is_closed = || fs::symlink_metadata("/dev/fd/1").is_err_and(|error| error.kind() == NotFound);
        WAS_CLOSED.store(fs::read_dir("/dev/fd").is_ok() && is_closed(), Ordering::Relaxed);
        &REGISTRY
    }
}

#[cfg(unix)]
inventory::submit! { BeforeMain }
