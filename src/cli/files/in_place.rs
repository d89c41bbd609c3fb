//! Replaces the contents of a file that must remain the same file: one that has several names, or whose owner another file
//! cannot have.

use std::fs::File;
use std::io::{self, Read};
use std::os::unix::fs::{FileExt, MetadataExt, fchown};
use std::path::Path;
use tabray_core::files::{Access, open_any};

/// Gives a new file the owner and the group of another, as far as the system lets this user do so.
pub fn give_owner(new: &File, old: &Path) -> io::Result<()> {
    let (old, now) = (old.metadata()?, new.metadata()?);
    if (old.uid(), old.gid()) != (now.uid(), now.gid()) {
        let _ = fchown(new, Some(old.uid()), Some(old.gid()));
    }
    Ok(())
}

/// Tells whether a file must remain, rather than be replaced by this one.
pub fn must_remain(old: &Path, new: &File) -> io::Result<bool> {
    let (old, new) = (old.metadata()?, new.metadata()?);
    Ok(old.nlink() > 1 || (old.uid(), old.gid()) != (new.uid(), new.gid()))
}

/// Writes a text to a file in one step, over the old one. Where the text is shorter, line breaks follow it until the file is
/// cut off; a program that is killed in between leaves them. If the disk fails, the old contents are written back.
pub fn write(path: &Path, text: &[u8]) -> io::Result<()> {
    let mut file = open_any(path, Access::Both)?;
    let mut old = Vec::new();
    file.read_to_end(&mut old)?;
    reserve(&file, text.len())?;
    let mut padded = text.to_vec();
    padded.resize(old.len().max(text.len()), b'\n');
    let replace = |all: &[u8], len: usize| {
        file.write_all_at(all, 0)?;
        file.set_len(len as u64)?;
        file.sync_all()
    };
    replace(&padded, text.len()).inspect_err(|_| {
        let _ = replace(&old, old.len());
    })
}

/// Reserves room on the disk, so that it cannot be full midway.
#[cfg(target_os = "linux")]
fn reserve(file: &File, len: usize) -> io::Result<()> {
    use nix::errno::Errno;
    use nix::fcntl::{FallocateFlags, fallocate};
    match fallocate(file, FallocateFlags::FALLOC_FL_KEEP_SIZE, 0, len as i64) {
        Err(Errno::EOPNOTSUPP | Errno::ENOSYS | Errno::EINVAL) => Ok(()),
        reserved => Ok(reserved?),
    }
}

#[cfg(not(target_os = "linux"))]
fn reserve(_: &File, _: usize) -> io::Result<()> {
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::output;
    use std::fs::{self, Permissions};
    use std::os::unix::fs::PermissionsExt;
    use tempfile::TempDir;

    #[test]
    fn a_file_of_two_names_keeps_both_and_its_mode() {
        let folder = TempDir::new().expect("a folder");
        let [one, two] = ["one", "two"].map(|name| folder.path().join(name));
        fs::write(&one, "a long text\n").expect("a file");
        fs::hard_link(&one, &two).expect("another name");
        fs::set_permissions(&one, Permissions::from_mode(0o640)).expect("a mode");
        for text in ["short\n", "a text that is longer than both of those before\n", ""] {
            assert!(output::replace(&one, text.as_bytes()).is_ok());
            assert_eq!(fs::read_to_string(&two).expect("a text"), text);
        }
        let meta = fs::metadata(&one).expect("it is there");
        assert_eq!((meta.nlink(), meta.mode() & 0o777), (2, 0o640));
        assert_eq!(fs::read_dir(folder.path()).expect("a folder").count(), 2);
    }

    #[test]
    fn a_file_keeps_its_owner() {
        let folder = TempDir::new().expect("a folder");
        let path = folder.path().join("one");
        fs::write(&path, "old").expect("a file");
        // Only the superuser can give files away.
        if std::os::unix::fs::chown(&path, Some(4321), Some(1234)).is_err() {
            return;
        }
        assert!(output::replace(&path, b"new").is_ok());
        let meta = fs::metadata(&path).expect("it is there");
        assert_eq!((meta.uid(), meta.gid()), (4321, 1234));
        assert_eq!(fs::read(&path).expect("a text"), b"new");
    }
}
