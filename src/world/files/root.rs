//! The folder that the program is confined to. On Linux since 5.6, the kernel holds it: a link that is swapped between the
//! check of a path and its opening is not followed.

use super::Access;
use std::fs::{File, OpenOptions};
use std::io;
use std::path::{Path, PathBuf};

/// A folder, by its real path.
#[derive(Debug)]
pub(super) struct Root {
    pub path: PathBuf,
    #[cfg(target_os = "linux")]
    folder: File,
}

impl Root {
    /// Finds the folder of a path.
    pub fn new(path: &Path) -> io::Result<Self> {
        let path = path.canonicalize()?;
        if !path.is_dir() {
            return Err(io::ErrorKind::NotADirectory.into());
        }
        Ok(Self {
            #[cfg(target_os = "linux")]
            folder: File::open(&path)?,
            path,
        })
    }

    /// Opens a file of the folder by its real path, in which no part is a link any more.
    pub fn open(&self, real: &Path, access: Access) -> io::Result<File> {
        #[cfg(target_os = "linux")]
        if let Some(opened) = kernel::open(&self.folder, real.strip_prefix(&self.path), access.flags()) {
            return opened;
        }
        access.options().open(real)
    }

    /// Returns a path that leads to a folder of this one by its real path, and stays there whatever happens to its name.
    pub fn hold(&self, real: &Path) -> io::Result<PathBuf> {
        #[cfg(target_os = "linux")]
        if let Some(held) = kernel::hold(&self.folder, real, real.strip_prefix(&self.path)) {
            return held;
        }
        Ok(real.to_owned())
    }
}

impl Access {
    /// Returns options of opening. Some files of the system, such as `/proc/kmsg`, have nothing more to read until later.
    pub(super) fn options(self) -> OpenOptions {
        let mut options = OpenOptions::new();
        options.read(self != Self::Write).write(matches!(self, Self::Write | Self::Both));
        #[cfg(unix)]
        if self == Self::Read {
            std::os::unix::fs::OpenOptionsExt::custom_flags(&mut options, libc::O_NONBLOCK | libc::O_NOCTTY);
        }
        options
    }
}

#[cfg(target_os = "linux")]
mod kernel {
    use super::super::{Access, outside};
    use nix::errno::Errno;
    use nix::fcntl::{OFlag, OpenHow, ResolveFlag, openat2};
    use std::collections::BTreeMap;
    use std::fs::File;
    use std::io;
    use std::os::fd::AsRawFd;
    use std::path::{Path, PathBuf, StripPrefixError};
    use std::sync::{Mutex, PoisonError};

    impl Access {
        pub(super) fn flags(self) -> OFlag {
            match self {
                Self::Read => OFlag::O_RDONLY | OFlag::O_NONBLOCK | OFlag::O_NOCTTY,
                Self::Stream => OFlag::O_RDONLY,
                Self::Write => OFlag::O_WRONLY,
                Self::Both => OFlag::O_RDWR,
            }
        }
    }

    /// Opens what lies beneath a folder, through no link. `None` where the system cannot do that, or a container forbids it.
    pub fn open(
        root: &File,
        beneath: Result<&Path, StripPrefixError>,
        flags: OFlag,
    ) -> Option<io::Result<File>> {
        let Ok(beneath) = beneath else { return Some(Err(outside())) };
        let beneath = if beneath.as_os_str().is_empty() { Path::new(".") } else { beneath };
        let resolve = ResolveFlag::RESOLVE_BENEATH | ResolveFlag::RESOLVE_NO_SYMLINKS;
        match openat2(root, beneath, OpenHow::new().flags(flags | OFlag::O_CLOEXEC).resolve(resolve)) {
            Ok(file) => Some(Ok(file.into())),
            Err(Errno::ENOSYS | Errno::EPERM) => None,
            Err(Errno::ELOOP | Errno::EXDEV) => Some(Err(outside())),
            Err(error) => Some(Err(error.into())),
        }
    }

    /// The folders that are held, by their real paths.
    static HELD: Mutex<BTreeMap<PathBuf, File>> = Mutex::new(BTreeMap::new());

    /// Keeps a folder open, and returns the path by which the system names an open file. `None` where there is none.
    pub fn hold(
        root: &File,
        real: &Path,
        beneath: Result<&Path, StripPrefixError>,
    ) -> Option<io::Result<PathBuf>> {
        let name = |folder: &File| PathBuf::from(format!("/proc/self/fd/{}", folder.as_raw_fd()));
        let mut held = HELD.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(folder) = held.get(real) {
            return Some(Ok(name(folder)));
        }
        let folder = match open(root, beneath, OFlag::O_RDONLY | OFlag::O_DIRECTORY)? {
            Ok(folder) => folder,
            Err(error) => return Some(Err(error)),
        };
        let path = name(&folder);
        path.is_dir().then(|| {
            held.insert(real.to_owned(), folder);
            Ok(path)
        })
    }
}

#[cfg(all(test, target_os = "linux"))]
mod tests {
    use super::*;
    use std::fs;
    use std::os::unix::fs::symlink;
    use tempfile::TempDir;

    /// What was checked is a link to elsewhere by the time of opening.
    #[test]
    fn a_swapped_link_gains_nothing() {
        let folder = TempDir::new().expect("a folder");
        let at = |name: &str| folder.path().canonicalize().expect("a folder").join(name);
        for name in ["in/deep", "in/held", "out"] {
            fs::create_dir_all(at(name)).expect("a folder");
        }
        for name in ["in/a", "in/deep/a", "out/a", "out/secret"] {
            fs::write(at(name), name).expect("a file");
        }
        let root = Root::new(&at("in")).expect("a root");
        let read = |name: &str| root.open(&at(name), Access::Read).and_then(io::read_to_string);
        for name in ["in/a", "in/deep/a"] {
            assert_eq!(read(name).expect("it is inside"), name);
        }
        let held = root.hold(&at("in/held")).expect("it is inside");
        for (name, target) in [("in/a", "out/secret"), ("in/deep", "out"), ("in/held", "out")] {
            fs::rename(at(name), at("in/aside")).expect("another name");
            symlink(at(target), at(name)).expect("a link");
            if name != "in/held" {
                let _ = fs::remove_file(at("in/aside")).or_else(|_| fs::remove_dir_all(at("in/aside")));
            }
        }
        for name in ["in/a", "in/deep/a", "in/deep/secret", "out/a"] {
            for access in [Access::Read, Access::Write, Access::Both] {
                let error = root.open(&at(name), access).expect_err(name);
                assert_eq!(error.kind(), io::ErrorKind::PermissionDenied, "{name}");
            }
        }
        assert!(root.hold(&at("in/deep")).is_err());
        // What is written into a folder stays there.
        fs::write(held.join("new"), "").expect("a file");
        assert!(at("in/aside/new").exists() && !at("out/new").exists());
        assert_eq!(fs::read_to_string(at("out/secret")).expect("a file"), "out/secret");
    }
}
