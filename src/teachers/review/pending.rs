//! Pending snapshots: the files that a failing test leaves beside the accepted snapshots, by insta's conventions.
//!
//! `ball.snap.new` comes beside `ball.snap`: a header between two lines of dashes, then a text. If the header says that
//! the snapshot is binary, its content is in a separate file, `ball.snap.png` for `ball.snap` and `ball.snap.new.png`
//! for `ball.snap.new`.

use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use tabray_cli::files::output;
use tabray_cli::process::failure::Failure;
use tabray_core::files;
use tabray_core::text;

/// A snapshot that waits for a decision.
pub struct Pending {
    /// The file of the accepted snapshot, whether it exists or not.
    pub path: PathBuf,
    /// The accepted content, if there is any.
    pub old: Option<Content>,
    /// The content from the last test run.
    pub new: Content,
    /// The whole text of the pending file.
    file: String,
}

/// The content of a snapshot.
#[derive(PartialEq, Eq, Hash)]
pub enum Content {
    /// A text.
    Text(String),
    /// The bytes of a file, and the extension of its name.
    Binary(Vec<u8>, String),
}

impl Content {
    /// Returns the content as text, if it is text; a Markdown page in a separate file is.
    pub fn text(&self) -> Option<&str> {
        match self {
            Self::Binary(bytes, extension) if extension == "md" => str::from_utf8(bytes).ok(),
            Self::Binary(..) => None,
            Self::Text(text) => Some(text),
        }
    }

    /// Returns the content's bytes.
    pub fn bytes(&self) -> &[u8] {
        match self {
            Self::Text(text) => text.as_bytes(),
            Self::Binary(bytes, _) => bytes,
        }
    }
}

/// Finds the files of pending snapshots at a path: all below a folder, sorted, or that of one snapshot.
pub fn find(path: &Path) -> Result<Vec<PathBuf>, Failure> {
    if !path.is_dir() {
        let snapshot = if path.extension() == Some("new".as_ref()) { &path.with_extension("") } else { path };
        return match output::append_to_path(snapshot, ".new") {
            new if new.is_file() => Ok(vec![new]),
            _ if snapshot.is_file() => {
                Err(Failure::usage(format!("nothing is pending for `{}`", text::shown(path))))
            }
            _ => Err(Failure::usage(format!("there is no folder or snapshot `{}`", text::shown(path)))
                .help("name a folder of snapshots, or the `.snap` file of one")),
        };
    }
    let mut found = Vec::new();
    let mut folders = vec![path.to_owned()];
    while let Some(folder) = folders.pop() {
        let cannot = |error: io::Error| Failure::cannot_read(&folder, &error);
        for entry in fs::read_dir(&folder).map_err(cannot)? {
            let entry = entry.map_err(cannot)?;
            if entry.file_type().map_err(cannot)?.is_dir() {
                folders.push(entry.path());
            } else if entry.file_name().to_string_lossy().ends_with(".snap.new") {
                found.push(entry.path());
            }
        }
    }
    found.sort_unstable();
    Ok(found)
}

impl Pending {
    /// Reads a pending snapshot and the accepted one.
    pub fn read(new: &Path) -> Result<Self, Failure> {
        let path = new.with_extension("");
        let cannot = |file: &Path, reason: &str| {
            Failure::usage(format!("cannot read the snapshot `{}`: {reason}", text::shown(file)))
        };
        let file = files::open(new)
            .and_then(io::read_to_string)
            .map_err(|error| cannot(new, &text::reason(&error)))?;
        let is = content(new, &file).map_err(|reason| cannot(new, &reason))?;
        let is = is.ok_or_else(|| cannot(new, "the file beside it is missing"))?;
        let old = match files::open(&path).and_then(io::read_to_string) {
            Ok(old) => content(&path, &old).map_err(|reason| cannot(&path, &reason))?,
            Err(error) if error.kind() == io::ErrorKind::NotFound => None,
            Err(error) => return Err(cannot(&path, &text::reason(&error))),
        };
        Ok(Self { path, old, new: is, file })
    }

    /// Returns a hash that tells this content from other contents of the snapshot.
    pub fn version(&self) -> String {
        let mut hasher = DefaultHasher::new();
        (&self.old, &self.new, &self.file).hash(&mut hasher);
        format!("{:016x}", hasher.finish())
    }

    /// Replaces the accepted snapshot by the pending one.
    pub fn accept(&self) -> Result<(), Failure> {
        if let Content::Binary(bytes, extension) = &self.new {
            output::replace(&output::append_to_path(&self.path, format!(".{extension}")), bytes)?;
        }
        // The line number of the test's source is for reviewing only: it changes too often to be kept.
        let kept = |line: &&str| !line.starts_with("assertion_line:");
        let (header, text) = parts(&self.file).unwrap_or_default();
        let header: String = header.split_inclusive('\n').filter(kept).collect();
        output::replace(&self.path, format!("---\n{header}---\n{text}").as_bytes())?;
        self.reject()
    }

    /// Removes the pending snapshot.
    pub fn reject(&self) -> Result<(), Failure> {
        let new = output::append_to_path(&self.path, ".new");
        let binary = match &self.new {
            Content::Text(_) => None,
            Content::Binary(_, extension) => Some(output::append_to_path(&new, format!(".{extension}"))),
        };
        [Some(new), binary].into_iter().flatten().try_for_each(|file| {
            fs::remove_file(&file).map_err(|error| {
                Failure::Failed(format!("cannot remove `{}`: {}", text::shown(file), text::reason(&error)))
            })
        })
    }
}

/// Returns the content of a snapshot's file or of the separate file beside it; `None` where that is missing.
fn content(path: &Path, file: &str) -> Result<Option<Content>, String> {
    let (header, text) = parts(file).ok_or("it has no header between `---` lines")?;
    let field = |name: &str| {
        header.lines().find_map(|line| Some(line.strip_prefix(name)?.strip_prefix(": ")?.trim_matches('"')))
    };
    if field("snapshot_kind") != Some("binary") {
        return Ok(Some(Content::Text(text.replace("\r\n", "\n"))));
    }
    let extension = field("extension").filter(|extension| extension.chars().all(char::is_alphanumeric));
    let extension = extension.ok_or("its header names no extension")?;
    match bytes(&output::append_to_path(path, format!(".{extension}"))) {
        Ok(bytes) => Ok(Some(Content::Binary(bytes, extension.to_owned()))),
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
        Err(error) => Err(format!("its .{extension} file: {}", text::reason(&error))),
    }
}

fn bytes(path: &Path) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    files::open(path)?.read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Splits a snapshot's file into the lines of its header and the text after them.
fn parts(file: &str) -> Option<(&str, &str)> {
    let header = file.strip_prefix("---\r\n").or_else(|| file.strip_prefix("---\n"))?;
    let mut end = 0;
    for line in header.split_inclusive('\n') {
        if line.trim_end() == "---" {
            return Some((&header[..end], &header[end + line.len()..]));
        }
        end += line.len();
    }
    None
}
