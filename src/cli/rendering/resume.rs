//! Checkpoints beside images: written where a render stops, and continued from by `--resume`.

use crate::files::output::{self, Output};
use crate::files::provenance::Provenance;
use crate::options::size::Region;
use crate::process::failure::Failure;
use crate::process::messages;
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use tabray_core::files;
use tabray_core::output::picture::{AS_SHOWN, Format, Rows};
use tabray_core::render::division::Grid;
use tabray_core::render::tiles::{Band, TILE};
use tabray_core::scene::model::Model;
use tabray_core::text;
use tabray_tools::identity::Identity;
use tabray_tools::pixels::{Label, PixelFormat, Reader, TileSet, Writer, take_tile};

/// The message if a render is stopped before its first tile is finished.
pub const NOTHING: &str = "nothing has been rendered yet, and nothing is written";

/// The checkpoint that a render continues from.
pub struct ResumedImage {
    path: PathBuf,
    reader: Reader,
}

/// Returns the path of an image's checkpoint.
pub fn beside(picture: &Path) -> PathBuf {
    output::append_to_path(picture, ".checkpoint")
}

impl ResumedImage {
    /// Opens the checkpoint of an image, if there is one and it is `wanted`.
    pub fn open(
        wanted: bool,
        picture: &Path,
        output: &Output,
        label: impl FnOnce() -> Result<Label, Failure>,
    ) -> Result<Option<Self>, Failure> {
        if !matches!(output, Output::File(..)) {
            return if wanted {
                Err(Failure::usage(format!("cannot keep a checkpoint beside `{}`", text::shown(picture)))
                    .help("name a file for the image with `-o FILE`, or leave out `--resume`"))
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
        let begun = Self::find(path, label)?;
        if begun.is_none() {
            messages::note(&missing);
        }
        Ok(begun)
    }

    /// Opens the checkpoint of this path, if there is one. Refuses that of another image than one of this label.
    pub fn find(
        path: PathBuf,
        label: impl FnOnce() -> Result<Label, Failure>,
    ) -> Result<Option<Self>, Failure> {
        match files::open(&path) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(None),
            file => Self::read(path, file, &label()?).map(Some),
        }
    }

    /// Reads the beginning of a checkpoint. Refuses that of another image than one of this label.
    pub fn read(path: PathBuf, file: io::Result<File>, label: &Label) -> Result<Self, Failure> {
        let reader = file.and_then(Reader::open).map_err(|error| cannot_read(&path, &error))?;
        let there = &reader.label;
        let mut differences = label.identity.differences(&there.identity);
        if differences.is_empty() && there.tiles != label.tiles {
            differences.push("it is another part".to_owned());
        }
        if !differences.is_empty() {
            return Err(Failure::usage(format!(
                "`{}` belongs to another image: {}",
                text::shown(&path),
                differences.join(", ")
            ))
            .help(BEGIN_ANEW));
        }
        // The format may be another: it says how the image is written.
        if (there.size, there.what.pixel()) != (label.size, label.what.pixel()) {
            return Err(cannot_read(&path, &io::ErrorKind::InvalidData.into()));
        }
        Ok(Self { path, reader })
    }

    /// Tells whether bands have been filled with the whole checkpoint.
    pub fn is_over(&self) -> bool {
        self.reader.is_over()
    }

    /// Fills a band, whose first row of tiles has this index, with the pixels that are already rendered. Bands must be
    /// passed in order, from the top.
    pub fn fill(&mut self, band: &Band, strip: usize) -> Result<(), Failure> {
        self.reader.fill(band, strip).map_err(|error| cannot_read(&self.path, &error))
    }

    /// Removes the checkpoint after its image is finished, unless another render that continued from it has done so.
    pub fn remove(self) -> Result<(), Failure> {
        match files::in_held_folder(&self.path).and_then(fs::remove_file) {
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
    Failure::usage(format!("cannot read `{}`: {reason}", text::shown(path))).help(BEGIN_ANEW)
}

/// Writes an unfinished image to its path, and a checkpoint beside it, whose path is returned. `written` contains
/// `rows` rows of the image, black where nothing is rendered.
///
/// Both files are complete before either is moved to its path.
pub fn leave(
    label: &Label,
    (picture, format): (&Path, Format),
    written: Output,
    (done, rows): (&TileSet, usize),
) -> Result<PathBuf, Failure> {
    let (path, grid) = (beside(picture), Grid { size: [label.size[0], rows] });
    let cannot_keep = |error: io::Error| Failure::cannot_write(&path, &error);
    let cannot_write = |error: io::Error| Failure::cannot_write(picture, &error);
    let pixel = label.what.pixel();
    let strips = || written.read().and_then(|file| format.read(file)).map(|shown| strips(shown, grid, pixel));
    let mut checkpoint = Output::open(&path)?;
    let kept = strips().and_then(|strips| keep(&mut checkpoint, label, done, strips));
    kept.map_err(cannot_keep)?;
    let partial = match format {
        Format::Ppm => {
            // The missing end of the file becomes a hole, which reads as black.
            let len = format.len(label.size).unwrap_or_default();
            written.set_len(len).map_err(cannot_write)?;
            written
        }
        Format::Png(_) => {
            let mut partial = Output::open(picture)?;
            let shown = strips().and_then(|strips| show(&mut partial, grid, (done, pixel), strips));
            shown.map_err(cannot_write)?;
            partial
        }
    };
    checkpoint.finish().map_err(cannot_keep)?;
    partial.finish().map_err(cannot_write)?;
    Ok(path)
}

/// Reads the rows of tiles of an image, from the top. A pixel has as many bytes.
fn strips(mut shown: Rows, grid: Grid, pixel: usize) -> impl Iterator<Item = io::Result<Vec<u8>>> {
    let [width, height] = grid.size;
    (0..height).step_by(TILE).map(move |row| {
        let mut bytes = vec![0; pixel * width * TILE.min(height - row)];
        bytes.chunks_mut(pixel * width).try_for_each(|row| shown.next(row))?;
        Ok(bytes)
    })
}

/// Writes the finished tiles of an image to a checkpoint.
fn keep(
    out: impl Write,
    label: &Label,
    done: &TileSet,
    strips: impl Iterator<Item = io::Result<Vec<u8>>>,
) -> io::Result<()> {
    let (grid, pixel, mut tile) = (label.grid(), label.what.pixel(), Vec::new());
    let mut writer = Writer::new(BufWriter::with_capacity(1 << 16, out), label)?;
    for (strip, bytes) in strips.enumerate() {
        let bytes = bytes?;
        for index in grid.across() * strip..grid.across() * (strip + 1) {
            let [columns, rows] = grid.tile(index);
            take_tile(&bytes, pixel * grid.size[0], [columns, 0..rows.len()], pixel, &mut tile);
            writer.tile(done.has(index).then_some(&tile))?;
        }
    }
    writer.finish()?.flush()
}

/// Writes an unfinished image as a PNG that is transparent where nothing is rendered. A pixel has as many bytes.
fn show(
    out: impl Write,
    grid: Grid,
    (done, pixel): (&TileSet, usize),
    strips: impl Iterator<Item = io::Result<Vec<u8>>>,
) -> io::Result<()> {
    let side = |pixels: usize| u32::try_from(pixels).map_err(io::Error::other);
    let [width, height] = grid.size;
    let mut out = BufWriter::with_capacity(1 << 16, out);
    let mut encoder = png::Encoder::new(&mut out, side(width)?, side(height)?);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_compression(png::Compression::Fast);
    encoder.set_source_srgb(AS_SHOWN);
    let mut writer = encoder.write_header()?;
    let mut stream = writer.stream_writer()?;
    for (strip, bytes) in strips.enumerate() {
        let bytes = bytes?;
        for row in bytes.chunks(pixel * width) {
            let shown = |(column, bytes): (usize, &[u8])| {
                let is_done = done.has(strip * grid.across() + column / TILE);
                let alpha = bytes.get(3).copied().unwrap_or(u8::MAX);
                if is_done { [bytes[0], bytes[1], bytes[2], alpha] } else { [0; 4] }
            };
            let row: Vec<u8> = row.chunks(pixel).enumerate().flat_map(shown).collect();
            stream.write_all(&row)?;
        }
    }
    stream.finish()?;
    writer.finish()?;
    out.flush()
}

/// Says how much of an image is finished. That is rounded down, so that an unfinished image does not show 100 %.
pub fn share(pixels: usize, of: usize) -> String {
    format!("{:.1} %", (1000.0 * pixels as f64 / of as f64).floor() / 10.0)
}

/// Returns the label of an image of bytes: it is part 1 of 1.
pub fn label(model: &Model, region: &Region, format: Format, made: &Provenance) -> Result<Label, Failure> {
    let (identity, what) = (identity(model, region)?, PixelFormat::picture(format, made.alpha));
    let (part, size, beside) = ([1, 1], region.size(), Vec::new());
    let (dpi, texts) = (made.dpi, made.texts.iter());
    let made = texts.map(|(keyword, text)| ((*keyword).to_owned(), text.clone())).collect();
    Ok(Label { part, tiles: [0, Grid { size }.count()], size, what, beside, identity, made, dpi })
}

/// Describes what a part of a model's image depends on.
fn identity(model: &Model, region: &Region) -> Result<Identity, Failure> {
    Identity::of(model, &region.columns, &region.rows).map_err(|error| {
        let reason = text::reason(&error);
        Failure::Failed(format!(
            "cannot read the program's own file, whose hash a checkpoint contains: {reason}"
        ))
    })
}
