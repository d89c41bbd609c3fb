//! Writes images beside their targets first and then replaces the targets, so that a target never holds half an image.

#[cfg(unix)]
use crate::files::in_place;
use crate::files::input;
use crate::files::paths::{are_same, open_sink};
use crate::files::standard::StandardOutput;
use crate::process::failure::Failure;
use crate::process::messages;
use crate::process::temporary::Temporary;
use same_file::Handle;
use std::ffi::OsStr;
use std::fs::{self, File};
use std::io::{self, BufWriter, IsTerminal, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering};
use tabray_core::files;
use tabray_core::output::deflate::Compression;
use tabray_core::output::picture::Format;
use tabray_core::scene::model::{Item, Model};
use tabray_core::scene::store::Record;
use tabray_core::text;
use tabray_core::world::texture::Texture;

/// A place to write to, which is opened before any work is done.
pub enum Output {
    /// Standard output.
    Standard,
    /// A target that is not a regular file, such as a device or a pipe; it cannot be replaced.
    Special(File),
    /// A temporary file beside the target, and the target's path.
    File(Temporary, PathBuf),
}

/// The number of bytes that were sent to readers: to standard output, to devices and to pipes.
static SENT: AtomicU64 = AtomicU64::new(0);

/// Returns how many bytes were sent to readers.
pub fn sent() -> u64 {
    SENT.load(Ordering::Relaxed)
}

/// Writes a new file as a whole; an existing file is not replaced.
pub fn create(path: &Path, text: &str) -> Result<(), Failure> {
    refuse_existing(path)?;
    let cannot = |error: io::Error| match error.kind() {
        io::ErrorKind::AlreadyExists => already_exists(path),
        _ => Failure::cannot_write(path, &error),
    };
    let folder = path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    let file = Temporary::new(folder).map_err(cannot)?;
    file.file().write_all(text.as_bytes()).map_err(cannot)?;
    file.persist_new(path).map_err(cannot)
}

/// Writes a text, replacing an existing file, which keeps its names, its owner and its mode.
pub fn replace(path: &Path, text: &[u8]) -> Result<(), Failure> {
    let mut output = Output::open(path)?;
    let write = move || {
        #[cfg(unix)]
        if let Output::File(file, target) = &output
            && target.exists()
            && in_place::must_remain(target, file.file())?
        {
            return in_place::write(target, text);
        }
        output.write_all(text)?;
        output.finish()
    };
    write().map_err(|error| Failure::cannot_write(path, &error))
}

/// Writes an image or a file beside it, moves it to its path, and reports it.
pub fn write_image(
    path: &Path,
    output: Output,
    write: impl FnOnce(&mut BufWriter<Output>) -> io::Result<()>,
) -> Result<(), Failure> {
    let mut out = BufWriter::new(output);
    let written = write(&mut out);
    finished(path, written, out)?;
    messages::note(&format!("wrote {}", text::shown(path)));
    Ok(())
}

/// Moves a file to its path, if it was written without an error. A pipe that its reader has closed is an error: what is
/// there is no whole file.
pub fn finished(path: &Path, written: io::Result<()>, out: BufWriter<Output>) -> Result<(), Failure> {
    match written.and_then(|()| out.into_inner().map_err(|error| error.into_error())?.finish()) {
        Err(error) => Err(Failure::cannot_write(path, &error)),
        _ => Ok(()),
    }
}

/// Appends to a path. `with_extension` would replace the end of the name.
pub fn append_to_path(path: &Path, end: impl AsRef<OsStr>) -> PathBuf {
    let mut path = path.as_os_str().to_owned();
    path.push(end);
    path.into()
}

/// Makes a folder and its parents, where they do not exist.
pub fn create_folder(path: &Path) -> Result<(), Failure> {
    files::create_folder(path).map_err(|error| {
        let reason = match error.kind() {
            io::ErrorKind::AlreadyExists => "a file of this name exists".to_owned(),
            _ => text::reason(&error),
        };
        Failure::Failed(format!("cannot create the folder `{}`: {reason}", text::shown(path)))
    })
}

/// Refuses a path that already exists.
pub fn refuse_existing(path: &Path) -> Result<(), Failure> {
    if path.symlink_metadata().is_ok() { Err(already_exists(path)) } else { Ok(()) }
}

fn already_exists(path: &Path) -> Failure {
    Failure::usage(format!("`{}` already exists", text::shown(path)))
        .help("existing files are not overwritten: choose another name")
}

/// Returns the file that is written under this name: for a link its target, whether that exists or not.
fn target(path: &Path) -> io::Result<PathBuf> {
    match path.canonicalize() {
        Err(error) if error.kind() == io::ErrorKind::NotFound => match fs::read_link(path) {
            Ok(next) => target(&path.with_file_name(next)),
            Err(_) => Ok(path.to_owned()),
        },
        Err(_) if !path.is_symlink() => Ok(path.to_owned()),
        target => target,
    }
}

/// Refuses to write an image to a file that the model was read from, whatever its name here.
pub fn refuse_source(path: &Path, scene: &Path, model: &Model) -> Result<(), Failure> {
    refuse_source_by(path, "the image", scene, model)
}

/// Refuses to replace a file that the model was read from, whatever its name here. `what` is what would replace it.
pub fn refuse_source_by(path: &Path, what: &str, scene: &Path, model: &Model) -> Result<(), Failure> {
    source(path, scene, model).map_or(Ok(()), |source| Err(would_replace(path, &source, what)))
}

/// Refuses to replace a file that is read, whatever its name here. `source` is what is read from it, and `what` is what
/// would replace it.
pub fn refuse_input(path: &Path, input: &Path, source: &str, what: &str) -> Result<(), Failure> {
    if is_input(input, path) { Err(would_replace(path, source, what)) } else { Ok(()) }
}

fn would_replace(path: &Path, source: &str, what: &str) -> Failure {
    Failure::usage(format!("`{}` is {source}, which {what} would replace", text::shown(path)))
        .help("name another file with `-o FILE`")
}

/// Tells whether a path leads to the file of an input, which may be standard input.
fn is_input(input: &Path, path: &Path) -> bool {
    if input::is_standard(input) {
        let is_stdin = || Ok::<_, io::Error>(Handle::from_path(path)? == Handle::stdin()?);
        path.is_file() && is_stdin().unwrap_or(false)
    } else {
        are_same(input, path)
    }
}

/// Says what a file is to the model that was read from it, whatever path names it; `None` for another file.
pub fn source(path: &Path, scene: &Path, model: &Model) -> Option<String> {
    if !path.exists() {
        return None;
    }
    let is_source = |texture: &Item<Arc<Texture>>| are_same(texture.value.path(), path);
    let is_read = |record: &&Record| {
        let args = record.args();
        args.files().any(|file| are_same(&args.setting.folder.join(file), path))
    };
    if is_input(scene, path) {
        return Some("the scene".to_owned());
    }
    if let Some(texture) = model.textures.iter().find(|texture| is_source(texture)) {
        return Some(format!("the image of texture `{}`", texture.args.name()));
    }
    if let Some(record) = model.from_files().into_iter().find(is_read) {
        return Some(format!("the file of {} `{}`", record.entity().name, record.name()));
    }
    let is_included = model.files.iter().any(|file| are_same(file, path));
    is_included.then(|| "a file that the scene is read from".to_owned())
}

impl Output {
    /// Opens `path`, or standard output for `-`. An existing file stays as it is until [`finish`](Self::finish).
    pub fn open(path: &Path) -> Result<Self, Failure> {
        if path == Path::new("-") {
            if io::stdout().is_terminal() {
                return Err(Failure::usage("standard output is a terminal, which cannot show images")
                    .help("redirect it with `> FILE` or `|`, or name a file with `-o FILE`"));
            }
            return Ok(Self::Standard);
        }
        let cannot = |error: io::Error| Failure::cannot_write(path, &error);
        // A link stays a link: its target is replaced.
        let target = target(path).map_err(cannot)?;
        let folder = match target.parent() {
            Some(folder) if folder != Path::new("") => folder,
            _ => Path::new("."),
        };
        match fs::metadata(&target) {
            Ok(meta) if meta.is_dir() => Err(cannot(io::ErrorKind::IsADirectory.into())),
            Ok(meta) if !meta.is_file() => Ok(Self::Special(open_sink(&target).map_err(cannot)?)),
            Ok(meta) if meta.permissions().readonly() => Err(cannot(io::ErrorKind::PermissionDenied.into())),
            Ok(meta) => {
                let file = Temporary::new(folder).map_err(cannot)?;
                #[cfg(unix)]
                in_place::give_owner(file.file(), &target).map_err(cannot)?;
                file.file().set_permissions(meta.permissions()).map_err(cannot)?;
                Ok(Self::File(file, target))
            }
            Err(_) => Ok(Self::File(Temporary::new(folder).map_err(cannot)?, target)),
        }
    }

    /// Opens what was written so far, from its beginning.
    pub fn read(&self) -> io::Result<File> {
        let Self::File(file, _) = self else { return Err(io::ErrorKind::Unsupported.into()) };
        let mut file = file.file().try_clone()?;
        file.rewind()?;
        Ok(file)
    }

    /// Sets the length of the file in bytes; a longer file is filled with zeros.
    pub fn set_len(&self, len: u64) -> io::Result<()> {
        match self {
            Self::File(file, _) => file.file().set_len(len),
            Self::Standard | Self::Special(_) => Err(io::ErrorKind::Unsupported.into()),
        }
    }

    /// Moves what was written to its path.
    pub fn finish(self) -> io::Result<()> {
        match self {
            Self::Standard | Self::Special(_) => Ok(()),
            Self::File(file, target) => file.persist(&target),
        }
    }
}

impl Write for Output {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let sent = match self {
            Self::File(file, _) => return file.file().write(bytes),
            Self::Standard => StandardOutput.write(bytes)?,
            Self::Special(file) => file.write(bytes)?,
        };
        SENT.fetch_add(sent as u64, Ordering::Relaxed);
        Ok(sent)
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Self::Standard => StandardOutput.flush(),
            Self::Special(file) => file.flush(),
            Self::File(file, _) => file.file().flush(),
        }
    }
}

/// Returns the format that a file's name implies, or an error with this help.
pub fn format_by_name(path: &Path, help: &str) -> Result<Format, Failure> {
    Format::of(path).ok_or_else(|| {
        let message = format!("the name `{}` does not determine the format of the image", text::shown(path));
        Failure::usage(message).help(help)
    })
}

/// Returns the format of an image, which may be chosen; a PNG is compressed so.
pub fn format_of(chosen: Option<Format>, path: &Path, compress: Compression) -> Result<Format, Failure> {
    let format = match chosen {
        Some(format) => format,
        None if path == Path::new("-") => Format::Ppm,
        None => format_by_name(path, "end it in .png or .ppm, or give `--format png` or `--format ppm`")?,
    };
    Ok(match format {
        Format::Png(_) => Format::Png(compress),
        Format::Ppm => Format::Ppm,
    })
}
