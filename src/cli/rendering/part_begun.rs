//! Existing parts of images, complete or not, when a part is to be rendered with `--resume`.

use crate::process::failure::Failure;
use crate::process::messages;
use std::fs;
use std::io;
use std::ops::Range;
use std::path::{Path, PathBuf};
use tabray_core::files;
use tabray_core::text;
use tabray_tools::part::{self, Label, Reader};

/// Tells whether a complete part exists.
pub fn is_complete((path, label): &(PathBuf, Label)) -> Result<bool, Failure> {
    let Ok(mut reader) = files::open(path).and_then(Reader::open) else { return Ok(false) };
    let there = &reader.label;
    let is_same = label.identity.differences(&there.identity).is_empty()
        && (label.tiles, label.what, &label.beside) == (there.tiles, there.what, &there.beside);
    let is_complete = is_same && !there.unfinished && reader.check().is_ok();
    if is_complete {
        messages::note(&format!("{} exists already", path.display()));
    }
    Ok(is_complete)
}

/// The unfinished part that a stopped render left.
pub struct UnfinishedPart {
    path: PathBuf,
    reader: Reader,
    mask: Vec<u8>,
    /// The number of tiles that were read.
    next: usize,
}

impl UnfinishedPart {
    /// Opens an unfinished part, if there is one.
    pub fn open(path: &Path, label: &Label) -> Result<Option<Self>, Failure> {
        let file = match files::open(path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            file => file,
        };
        let anew = || Some("leave out `--resume` to start from the beginning".to_owned());
        let cannot = |error: io::Error| {
            Failure::Usage(format!("cannot read `{}`: {}", path.display(), text::reason(&error)), anew())
        };
        let mut reader = file.and_then(Reader::open).map_err(cannot)?;
        let there = &reader.label;
        let mut differences = label.identity.differences(&there.identity);
        if (label.tiles, label.what) != (there.tiles, there.what) || !there.unfinished {
            differences.push("it is another part".to_owned());
        }
        if !differences.is_empty() {
            return Err(Failure::Usage(
                format!("`{}` belongs to another image: {}", path.display(), differences.join(", ")),
                anew(),
            ));
        }
        // Damage must be known before any of the pixels are used.
        files::open(path).and_then(Reader::open).and_then(|mut all| all.check()).map_err(cannot)?;
        let mut mask = vec![0; label.tiles().len()];
        reader.read(&mut mask).map_err(cannot)?;
        Ok(Some(Self { path: path.to_owned(), reader, mask, next: 0 }))
    }

    /// Removes the unfinished part beside a complete one, if there is one.
    pub fn remove(path: &Path, label: &Label) -> Result<(), Failure> {
        match Self::open(path, label) {
            Ok(Some(_)) => remove(path),
            // What belongs to another part stays.
            _ => Ok(()),
        }
    }

    /// Reads the next tile into some rows, and tells whether it is rendered.
    pub fn tile(&mut self, rows: &mut [u8], row: usize, place: [Range<usize>; 2]) -> Result<bool, Failure> {
        let mut tile = vec![0; 3 * place[0].len() * place[1].len()];
        self.reader.read(&mut tile).map_err(|error| {
            Failure::Failed(format!("cannot read `{}`: {}", self.path.display(), text::reason(&error)))
        })?;
        part::put_tile(rows, row, place, 3, &tile);
        self.next += 1;
        Ok(self.mask[self.next - 1] == 1)
    }

    /// Tells whether all tiles were read.
    pub fn is_over(&self) -> bool {
        self.next == self.mask.len()
    }
}

/// Removes the checkpoint of a part that is finished.
pub fn remove(checkpoint: &Path) -> Result<(), Failure> {
    fs::remove_file(checkpoint).map_err(|error| Failure::cannot_write(checkpoint, &error))
}
