//! Checkpoints beside images: written where a render stops, and continued from by `--resume`.

use crate::files::output::{self, Output};
use crate::options::size::Region;
use crate::process::failure::Failure;
use crate::process::messages;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use tabray_core::files;
use tabray_core::output::picture::Format;
use tabray_core::render::tiles::{Band, Tiles};
use tabray_core::scene::model::Model;
use tabray_core::text;
use tabray_tools::checkpoint::{self, Checkpoint, Identity};

/// The checkpoint that a render continues from.
pub struct ResumedImage {
    path: PathBuf,
    checkpoint: Checkpoint,
}

/// Returns the path of an image's checkpoint.
pub fn beside(picture: &Path) -> PathBuf {
    output::append_to_path(picture, ".checkpoint")
}

impl ResumedImage {
    /// Opens the checkpoint of an image, if there is one and it is `wanted`.
    pub fn open(
        wanted: bool,
        model: &Model,
        region: &Region,
        picture: &Path,
        output: &Output,
    ) -> Result<Option<Self>, Failure> {
        if !matches!(output, Output::File(..)) {
            return if wanted {
                Err(Failure::Usage(
                    format!("cannot keep a checkpoint beside `{}`", text::shown(picture)),
                    Some("name a file for the image with `-o FILE`, or leave out `--resume`".to_owned()),
                ))
            } else {
                Ok(None)
            };
        }
        let path = beside(picture);
        let shown = text::shown(&path);
        if !wanted {
            if path.exists() {
                messages::note(&format!("{shown} exists: with `--resume` the render would continue from it"));
            }
            return Ok(None);
        }
        let missing = format!("there is no {shown} to continue from: the render starts from the beginning");
        let begun = Self::find(path, || identity(model, region), region.size())?;
        if begun.is_none() {
            messages::note(&missing);
        }
        Ok(begun)
    }

    /// Opens the checkpoint of this path, if there is one. Refuses that of another image.
    pub fn find(
        path: PathBuf,
        identity: impl FnOnce() -> Result<Identity, Failure>,
        size: [usize; 2],
    ) -> Result<Option<Self>, Failure> {
        let file = match files::open(&path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(None),
            file => file,
        };
        let begun = Self::read(path, file)?;
        begun.refuse_other_image(&identity()?, size)?;
        Ok(Some(begun))
    }

    /// Reads the beginning of a checkpoint.
    pub fn read(path: PathBuf, file: io::Result<File>) -> Result<Self, Failure> {
        match file.and_then(Checkpoint::open) {
            Ok(checkpoint) => Ok(Self { path, checkpoint }),
            Err(error) => Err(cannot_read(&path, &error)),
        }
    }

    /// Refuses the checkpoint of another image than this one.
    pub fn refuse_other_image(&self, identity: &Identity, size: [usize; 2]) -> Result<(), Failure> {
        let differences = identity.differences(&self.checkpoint.identity);
        if !differences.is_empty() {
            return Err(Failure::Usage(
                format!("`{}` belongs to another image: {}", text::shown(&self.path), differences.join(", ")),
                Some(BEGIN_ANEW.to_owned()),
            ));
        }
        if !self.checkpoint.fits(size) {
            return Err(cannot_read(&self.path, &io::ErrorKind::InvalidData.into()));
        }
        Ok(())
    }

    /// Tells whether bands have been filled with the whole checkpoint.
    pub fn is_over(&self) -> bool {
        self.checkpoint.rows_left() == 0
    }

    /// Fills a band with the pixels that are already rendered. Bands must be passed in order, from the top.
    pub fn fill(&mut self, band: &Band) -> Result<(), Failure> {
        self.checkpoint.fill(band).map_err(|error| cannot_read(&self.path, &error))
    }

    /// Removes the checkpoint after its image is finished, unless another render that continued from it has done so.
    pub fn remove(self) -> Result<(), Failure> {
        match fs::remove_file(&self.path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => {
                let (path, reason) = (text::shown(&self.path), text::reason(&error));
                Err(Failure::Failed(format!(
                    "cannot remove `{path}`: {reason}; the image is finished, so remove the file by hand"
                )))
            }
            _ => Ok(()),
        }
    }
}

const BEGIN_ANEW: &str = "leave out `--resume` to start from the beginning";

fn cannot_read(path: &Path, error: &io::Error) -> Failure {
    let reason = match error.kind() {
        io::ErrorKind::InvalidData => "it is not a checkpoint, or it is corrupt".to_owned(),
        _ => text::reason(error),
    };
    Failure::Usage(format!("cannot read `{}`: {reason}", text::shown(path)), Some(BEGIN_ANEW.to_owned()))
}

/// Writes a checkpoint, which is not moved to its path yet. The other arguments are those of [`checkpoint::write`].
pub fn write(
    path: &Path,
    size: [usize; 2],
    identity: &Identity,
    tiles: &Tiles,
    next: impl FnMut(&mut [u8]) -> io::Result<()>,
) -> Result<Output, Failure> {
    let mut checkpoint = Output::open(path)?;
    let mut out = BufWriter::with_capacity(1 << 16, &mut checkpoint);
    let written = checkpoint::write(&mut out, size, identity, tiles, next).and_then(|()| out.flush());
    drop(out);
    written.map_err(|error| Failure::cannot_write(path, &error))?;
    Ok(checkpoint)
}

/// Writes an unfinished image to its path, and a checkpoint beside it, whose path is returned. `written` contains
/// `rows` rows of the image, black where nothing is rendered.
///
/// Both files are complete before either is moved to its path.
pub fn leave(
    model: &Model,
    region: &Region,
    (picture, format): (&Path, Format),
    written: Output,
    (tiles, rows): (&Tiles, usize),
) -> Result<PathBuf, Failure> {
    let [width, height] = region.size();
    let path = beside(picture);
    let cannot_write = |error: io::Error| Failure::cannot_write(&path, &error);
    let mut shown = written.read().and_then(|file| format.read(file)).map_err(cannot_write)?;
    let identity = identity(model, region)?;
    let checkpoint = write(&path, [width, rows], &identity, tiles, |row| shown.next(row))?;
    let partial = match format {
        Format::Ppm => {
            // The missing end of the file becomes a hole, which reads as black.
            let len = format.len([width, height]).unwrap_or_default();
            written.set_len(len).map_err(|error| Failure::cannot_write(picture, &error))?;
            written
        }
        // The checkpoint's transparency shows which pixels are missing.
        Format::Png(_) => {
            let mut shown = checkpoint.read().map_err(cannot_write)?;
            let mut partial = Output::open(picture)?;
            io::copy(&mut shown, &mut partial).map_err(|error| Failure::cannot_write(picture, &error))?;
            partial
        }
    };
    checkpoint.finish().map_err(cannot_write)?;
    partial.finish().map_err(|error| Failure::cannot_write(picture, &error))?;
    Ok(path)
}

/// Describes what a part of a model's image depends on.
pub fn identity(model: &Model, region: &Region) -> Result<Identity, Failure> {
    Identity::of(model, &region.columns, &region.rows).map_err(|error| {
        let reason = text::reason(&error);
        Failure::Failed(format!(
            "cannot read the program's own file, whose hash a checkpoint contains: {reason}"
        ))
    })
}
