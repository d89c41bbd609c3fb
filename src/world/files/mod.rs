//! Opens files that a scene or a command names. A path may lead to something other than a file, or out of the folder
//! to which the program is confined.

pub mod held;

use std::fs::{self, File, Metadata, OpenOptions};
use std::io::{self, BufRead, Seek};
use std::path::{Component, Path, PathBuf};
use std::sync::OnceLock;

/// The bytes of an image's file. Decoders take it as `&mut dyn`, so each is compiled once.
pub trait ImageBytes: BufRead + Seek {}

impl<B: BufRead + Seek> ImageBytes for B {}

/// The real path of the folder that the program is confined to, if it is.
static ROOT: OnceLock<PathBuf> = OnceLock::new();

/// Confines the program to a folder, once and for good: outside of it, nothing is opened.
///
/// # Errors
/// Returns the errors of the system, and an error where the path does not lead to a folder.
pub fn confine(root: &Path) -> io::Result<()> {
    let root = root.canonicalize()?;
    if !root.is_dir() {
        return Err(io::ErrorKind::NotADirectory.into());
    }
    ROOT.get_or_init(|| root);
    Ok(())
}

/// Refuses a path that leads out of the folder that the program is confined to, by its real path: after all links. A
/// path that does not exist counts as lying where its nearest existing folder lies.
///
/// # Errors
/// Returns an error if the path leads outside.
pub fn refuse_outside(path: &Path) -> io::Result<()> {
    let is_inside = |root: &PathBuf| {
        let around = |path: &Path| match path.parent() {
            Some(folder) if folder == Path::new("") => Some(PathBuf::from(".")),
            folder => folder.map(Path::to_owned),
        };
        let mut folder = Some(path.to_owned());
        let real = loop {
            match &folder {
                Some(path) => match path.canonicalize() {
                    Ok(real) => break real,
                    // A link to what does not exist may lead anywhere.
                    Err(_) if path.is_symlink() => return false,
                    Err(_) => folder = around(path),
                },
                None => return false,
            }
        };
        // Behind a folder that does not exist, `..` leads nowhere yet.
        let is_plain = path.exists() || !path.components().any(|part| part == Component::ParentDir);
        real.starts_with(root) && is_plain
    };
    if ROOT.get().is_none_or(is_inside) {
        return Ok(());
    }
    Err(io::Error::new(io::ErrorKind::PermissionDenied, "it is outside of the folder of `--root`"))
}

/// Opens a file to read it. Refuses a pipe, at which opening might wait for ever, and a device, which might have no
/// end.
///
/// # Errors
/// Returns the errors of the system, and an error where the path does not lead to a file, or leads
/// [outside](refuse_outside).
pub fn open(path: &Path) -> io::Result<File> {
    refuse_outside(path)?;
    // Opening a device may already have an effect. By the time of opening, the path may lead to something else.
    refuse_other(&fs::metadata(path)?)?;
    let file = without_waiting().read(true).open(path)?;
    refuse_other(&file.metadata()?)?;
    Ok(file)
}

/// Lists a folder, in any order.
///
/// # Errors
/// Returns the errors of the system, and an error where the folder is [outside](refuse_outside).
pub fn read_dir(folder: &Path) -> io::Result<fs::ReadDir> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    refuse_outside(folder)?;
    folder.read_dir()
}

/// Tells whether a path leads to a file, and not [outside](refuse_outside).
pub fn is_file(path: &Path) -> bool {
    refuse_outside(path).is_ok() && path.is_file()
}

fn refuse_other(kind: &Metadata) -> io::Result<()> {
    if kind.is_dir() {
        return Err(io::ErrorKind::IsADirectory.into());
    }
    if !kind.is_file() {
        return Err(io::Error::other("it is a pipe or a device, not a file"));
    }
    Ok(())
}

/// Returns options of opening and reading that never wait: some files of the system, such as `/proc/kmsg`, have
/// nothing more to read until later.
fn without_waiting() -> OpenOptions {
    #[cfg_attr(not(unix), allow(unused_mut, reason = "only there is something to be set"))]
    let mut options = OpenOptions::new();
    #[cfg(unix)]
    std::os::unix::fs::OpenOptionsExt::custom_flags(&mut options, libc::O_NONBLOCK | libc::O_NOCTTY);
    options
}

/// Returns a path in which each `..` is removed together with the named folder before it.
pub fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::ParentDir if matches!(plain.components().next_back(), Some(Component::Normal(_))) => {
                plain.pop();
            }
            Component::CurDir => {}
            part => plain.push(part),
        }
    }
    plain
}
