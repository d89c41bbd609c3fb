//! Standard output, which may have been closed before the program began.

use std::io::{self, Write};

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

/// Tells whether standard output was closed when the program began. Rust's runtime then opens `/dev/null` in its place, for
/// reading too, which a shell's `> /dev/null` does not.
#[cfg(unix)]
fn was_closed() -> bool {
    use nix::fcntl::{FcntlArg, OFlag, fcntl};
    use nix::sys::stat::{fstat, stat};
    use std::sync::OnceLock;
    static WAS_CLOSED: OnceLock<bool> = OnceLock::new();
    *WAS_CLOSED.get_or_init(|| {
        let out = io::stdout();
        let mode =
            fcntl(&out, FcntlArg::F_GETFL).map(|flags| OFlag::from_bits_truncate(flags) & OFlag::O_ACCMODE);
        let is_null =
            || matches!((fstat(&out), stat("/dev/null")), (Ok(out), Ok(null)) if out.st_rdev == null.st_rdev);
        mode == Ok(OFlag::O_RDWR) && is_null()
    })
}

#[cfg(not(unix))]
fn was_closed() -> bool {
    false
}
