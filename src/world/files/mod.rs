//! Opens files that a scene or a command names. A path may lead to something other than a file, or out of the folder
//! to which the program is confined.

pub mod held;
mod root;

use root::Root;
use std::fs::{self, File, Metadata};
use std::io::{self, BufRead, Seek};
use std::path::{Component, Path, PathBuf};
use std::sync::OnceLock;

/// The bytes of an image's file. Decoders take it as `&mut dyn`, so each is compiled once.
pub trait ImageBytes: BufRead + Seek {}

impl<B: BufRead + Seek> ImageBytes for B {}

/// The folder that the program is confined to, if it is.
static ROOT: OnceLock<Root> = OnceLock::new();

/// What a file is opened for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Access {
    /// Reading, without ever waiting.
    Read,
    /// Reading once, which may wait for another program.
    Stream,
    /// Writing.
    Write,
    /// Reading and writing.
    Both,
}

/// Confines the program to a folder, once and for good: outside of it, nothing is opened.
///
/// # Errors
/// Returns the errors of the system, and an error where the path does not lead to a folder.
pub fn confine(root: &Path) -> io::Result<()> {
    let root = Root::new(root)?;
    ROOT.get_or_init(|| root);
    Ok(())
}

/// Refuses a path that leads out of the folder that the program is confined to, by its real path: after all links. A
/// path that does not exist counts as lying where its nearest existing folder lies.
///
/// # Errors
/// Returns an error if the path leads outside.
pub fn refuse_outside(path: &Path) -> io::Result<()> {
    let is_inside = |root: &Root| {
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
        real.starts_with(&root.path) && is_plain
    };
    if ROOT.get().is_none_or(is_inside) {
        return Ok(());
    }
    Err(outside())
}

fn outside() -> io::Error {
    io::Error::new(io::ErrorKind::PermissionDenied, "it is outside of the folder of `--root`")
}

/// Opens a file, a device or a pipe that exists. What waits at a pipe is the caller's business.
///
/// # Errors
/// Returns the errors of the system, and an error where the path leads [outside](refuse_outside).
pub fn open_any(path: &Path, access: Access) -> io::Result<File> {
    refuse_outside(path)?;
    match ROOT.get() {
        Some(root) => root.open(&path.canonicalize()?, access),
        None => access.options().open(path),
    }
}

/// Returns a path to a folder: where the program is confined, one that leads to the same folder even when another takes
/// its name.
///
/// # Errors
/// Returns the errors of the system, and an error where the path leads [outside](refuse_outside).
pub fn held_folder(folder: &Path) -> io::Result<PathBuf> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    refuse_outside(folder)?;
    match ROOT.get() {
        Some(root) => root.hold(&folder.canonicalize()?),
        None => Ok(folder.to_owned()),
    }
}

/// Returns a path to a file in its [held folder](held_folder).
///
/// # Errors
/// Returns the errors of [`held_folder`], and an error where the path has no name of a file.
pub fn in_held_folder(path: &Path) -> io::Result<PathBuf> {
    let folder = held_folder(path.parent().unwrap_or(Path::new("")))?;
    Ok(folder.join(path.file_name().ok_or(io::ErrorKind::InvalidInput)?))
}

/// Makes a folder and its parents, where they do not exist.
///
/// # Errors
/// Returns the errors of the system, and an error where the path leads [outside](refuse_outside).
pub fn create_folder(path: &Path) -> io::Result<()> {
    refuse_outside(path)?;
    let existing = path.ancestors().find(|folder| folder.is_dir()).unwrap_or(Path::new(""));
    let rest = path.strip_prefix(existing).unwrap_or(path);
    fs::create_dir_all(held_folder(existing)?.join(rest))
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
    let file = open_any(path, Access::Read)?;
    refuse_other(&file.metadata()?)?;
    Ok(file)
}

/// Lists a folder, in any order.
///
/// # Errors
/// Returns the errors of the system, and an error where the folder is [outside](refuse_outside).
pub fn read_dir(folder: &Path) -> io::Result<fs::ReadDir> {
    held_folder(folder)?.read_dir()
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
