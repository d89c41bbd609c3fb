//! `tabray render --part`: renders a part of an image into a file beside it, from which `tabray merge` makes the image.

use crate::files::output::{self, Output};
use crate::files::provenance::Provenance;
use crate::options::size::Region;
use crate::process::failure::Failure;
use crate::process::progress::Progress;
use crate::process::{memory, messages};
use crate::rendering::bands::TileRender;
use crate::rendering::resume::ResumedImage;
use crate::rendering::{aov, resume};
use std::io::{self, BufWriter, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use tabray_core::files;
use tabray_core::output::aov::{Aov, Setting};
use tabray_core::output::aov_values::Values;
use tabray_core::output::full_range::FullRange;
use tabray_core::output::picture::Format;
use tabray_core::parallel;
use tabray_core::render::division::{self, Grid};
use tabray_core::render::plan::Plan;
use tabray_core::render::renderer::Renderer;
use tabray_core::text;
use tabray_tools::pixels::{Label, MAX_PARTS, PixelFormat, Reader, Writer, take_tile};

/// The message for a stopped part, of which nothing is kept.
const UNKEPT: &str = "the part was not finished, and nothing is written";

#[derive(clap::Args)]
#[group(id = "which part")]
#[command(next_help_heading = "Parts and frames")]
pub struct Args {
    /// Render only part K of N, into a file beside the image: `-o a.png --part 3/16` writes a.png.part-3-of-16, and
    /// `merge a.png` joins all parts. The parts take about equal work, and are the same on every machine. With
    /// --resume, an existing part is not rendered again
    #[arg(long, value_name = "K/N", value_parser = share)]
    pub part: Option<[usize; 2]>,
}

fn share(text: &str) -> Result<[usize; 2], String> {
    let (number, of) = text.split_once('/').unwrap_or_default();
    let wrong =
        || format!("give a part as `3/16`: its number, from 1, and of how many parts, up to {MAX_PARTS}");
    let [number, of]: [usize; 2] = [number.parse().map_err(|_| wrong())?, of.parse().map_err(|_| wrong())?];
    match (number, of) {
        (_, of) if !(1..=MAX_PARTS).contains(&of) => Err(wrong()),
        (0, _) => Err(format!("parts are counted from 1: the first is `1/{of}`")),
        _ if number > of => Err(format!("the last of {of} parts is `{of}/{of}`")),
        _ => Ok([number, of]),
    }
}

/// Returns the path of a part of an image.
pub fn beside(picture: &Path, [number, of]: [usize; 2]) -> PathBuf {
    output::append_to_path(picture, format!(".part-{number}-of-{of}"))
}

/// A part that is to be rendered.
pub struct PartRender<'a> {
    pub part: [usize; 2],
    /// What the file says of how the image was made.
    pub made: &'a Provenance,
    /// Its tiles.
    pub tiles: TileRender<'a>,
    /// The path of the image, and that of an image whose name those beside it have.
    pub paths: [&'a Path; 2],
    pub full_range: Option<FullRange>,
    pub beside: &'a [Aov],
    /// The format of an image of bytes, and of the images beside the main one.
    pub format: Format,
}

/// Returns the tiles of a part of an image.
pub fn tiles(
    [number, of]: [usize; 2],
    region: &Region,
    plan: &Plan,
    renderer: &Renderer,
) -> Result<Range<usize>, Failure> {
    let ([width, height], tiles) = (region.size(), Grid { size: region.size() }.count());
    if of > tiles {
        return Err(Failure::usage(format!("an image of {width} x {height} pixels cannot have {of} parts"))
            .help(format!("it has {}, and a part at least one", text::count(tiles, "tile"))));
    }
    let ends = division::divide(renderer, plan, [&region.columns, &region.rows], of);
    Ok(ends[number - 1]..ends[number])
}

impl PartRender<'_> {
    /// Renders the part of the main image and of those beside it. `truth` calls what it is given with the plan of the
    /// reference for errors.
    pub fn run(
        &self,
        resumes: bool,
        truth: impl FnOnce(&mut dyn FnMut(&Plan) -> Result<(), Failure>) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let (TileRender { plan, region, tiles, stop, .. }, [path, beside]) = (&self.tiles, self.paths);
        let whole = resume::label(plan.model, region, self.format, self.made)?;
        let (part, tiles, others) = (self.part, [tiles.start, tiles.end], self.beside.to_vec());
        let label = Label { part, tiles, beside: others, ..whole };
        let main = match self.full_range {
            Some(format) => Label { what: PixelFormat::full_range(format, self.made.alpha), ..label.clone() },
            None => label.clone(),
        };
        let main = beside_and_label(path, main);
        if resumes && is_complete(&main)? {
            // Where the program was killed just after it had finished the part, its checkpoint is still there.
            // What belongs to another part stays.
            if let Ok(Some(begun)) = self.begun(&main) {
                begun.remove()?;
            }
        } else {
            match self.full_range {
                Some(_) => self.full_range(&main)?,
                None => self.bytes(&main, resumes)?,
            }
            add_writing_time(&main.0, &main.1);
        }
        if self.beside.is_empty() {
            return Ok(());
        }
        stop.exit_on_interrupt()?;
        truth(&mut |truth| {
            for aov in self.beside {
                let compression = match self.format {
                    Format::Png(compression) => Some(compression),
                    Format::Ppm => None,
                };
                let what = PixelFormat::Beside(*aov, compression, Setting::of(&plan.camera));
                let file = beside_and_label(&aov::picture(beside, *aov), Label { what, ..label.clone() });
                if !(resumes && is_complete(&file)?) {
                    self.values(&file, *aov, truth)?;
                    add_writing_time(&file.0, &file.1);
                }
            }
            Ok(())
        })
    }

    /// Opens the checkpoint of the part, if there is one.
    fn begun(&self, (path, label): &(PathBuf, Label)) -> Result<Option<ResumedImage>, Failure> {
        ResumedImage::find(resume::beside(path), || Ok(label.clone()))
    }

    /// Renders bytes, or stops and keeps the finished part.
    fn bytes(&self, file: &(PathBuf, Label), resumes: bool) -> Result<(), Failure> {
        let (path, label) = file;
        let mut begun = if resumes { self.begun(file)? } else { None };
        let mut writer = begin(path, label)?;
        self.tiles.stop.begin();
        self.tiles.bands(&mut begun, |bands| {
            let mut bytes = Vec::new();
            for band in bands {
                let band = band?;
                for (tile, is_done) in self.tiles.of_band(&band) {
                    self.tiles.take(&band, tile, &mut bytes);
                    let written = writer.tile(is_done.then_some(&bytes));
                    written.map_err(|error| Failure::cannot_write(path, &error))?;
                }
            }
            match writer.done.is_whole() {
                true => finish(path, writer),
                false => Err(self.leave(file, writer).err().unwrap_or(Failure::Stopped)),
            }
        })?;
        begun.map_or(Ok(()), ResumedImage::remove)
    }

    /// Keeps the finished tiles of a part that is stopped as its checkpoint.
    fn leave(
        &self,
        (path, label): &(PathBuf, Label),
        writer: Writer<BufWriter<Output>>,
    ) -> Result<(), Failure> {
        let pixels = writer.done.pixels(label.grid());
        if pixels == 0 {
            messages::note(resume::NOTHING);
            return Ok(());
        }
        let path = resume::beside(path);
        let mut checkpoint = Output::open(&path)?;
        let copied = writer.finish().and_then(|mut out| {
            out.flush()?;
            io::copy(&mut out.get_ref().read()?, &mut checkpoint)?;
            checkpoint.finish()
        });
        copied.map_err(|error| Failure::cannot_write(&path, &error))?;
        let share = resume::share(pixels, label.grid().pixels_of(label.tiles()));
        let ([number, of], path) = (self.part, text::shown(path));
        messages::note(&format!(
            "wrote {share} of part {number}/{of} to {path}, from which `--resume` renders the rest"
        ));
        Ok(())
    }

    /// Renders colours of full range. Nothing is kept of a part that is stopped.
    fn full_range(&self, (path, label): &(PathBuf, Label)) -> Result<(), Failure> {
        let (mut writer, grid, mut tile) = (begin(path, label)?, label.grid(), Vec::new());
        let pixel = label.what.pixel();
        self.tiles.colours(UNKEPT, |run, [wide, tall], colours| {
            let bytes: Vec<u8> = colours.iter().flat_map(|number| number.to_le_bytes()).collect();
            for index in run {
                let [of, at] = grid.tile(index);
                let (of, at) =
                    (of.start - wide.start..of.end - wide.start, at.start - tall.start..at.end - tall.start);
                take_tile(&bytes, pixel * wide.len(), [of, at], pixel, &mut tile);
                writer.tile(Some(&tile)).map_err(|error| Failure::cannot_write(path, &error))?;
            }
            Ok(())
        })?;
        finish(path, writer)
    }

    /// Computes the numbers of an image beside the main one.
    fn values(&self, file: &(PathBuf, Label), aov: Aov, truth: &Plan) -> Result<(), Failure> {
        let (path, label) = file;
        let (plan, grid) = (self.tiles.plan, label.grid());
        let (tiles, height) = (label.tiles(), plan.camera.pixels[1]);
        memory::refuse_too_large(24 * grid.pixels_of(tiles.clone()), "the part")?;
        let progress = Progress::new(tiles.len());
        let tile = |index: usize| {
            let [columns, rows] = grid.tile(tiles.start + index);
            let pixels = rows.flat_map(|row| columns.clone().map(move |column| (column, row)));
            let values: Vec<Values> =
                pixels.map(|(x, row)| aov.values(plan, truth, x, height - 1 - row)).collect();
            progress.step();
            values
        };
        let values = self.tiles.renderer.run(|| parallel::map(tiles.len(), tile));
        progress.end();
        let mut writer = begin(path, label)?;
        for tile in values {
            let bytes: Vec<u8> = tile.iter().flatten().flat_map(|number| number.to_le_bytes()).collect();
            writer.tile(Some(&bytes)).map_err(|error| Failure::cannot_write(path, &error))?;
        }
        finish(path, writer)
    }
}

/// Tells whether a complete part exists.
fn is_complete((path, label): &(PathBuf, Label)) -> Result<bool, Failure> {
    let Ok(mut reader) = files::open(path).and_then(Reader::open) else { return Ok(false) };
    let there = &reader.label;
    let is_same = label.identity.differences(&there.identity).is_empty()
        && (label.tiles, label.what, &label.beside) == (there.tiles, there.what, &there.beside)
        && label.dpi == there.dpi;
    let is_complete = is_same && reader.done.is_whole() && reader.check().is_ok();
    if is_complete {
        messages::note(&format!("{} exists already", text::shown(path)));
    }
    Ok(is_complete)
}

fn beside_and_label(picture: &Path, label: Label) -> (PathBuf, Label) {
    (beside(picture, label.part), label)
}

fn begin(path: &Path, label: &Label) -> Result<Writer<BufWriter<Output>>, Failure> {
    let out = BufWriter::with_capacity(1 << 16, Output::open(path)?);
    Writer::new(out, label).map_err(|error| Failure::cannot_write(path, &error))
}

fn finish(path: &Path, writer: Writer<BufWriter<Output>>) -> Result<(), Failure> {
    let finished = writer.finish().map_err(|error| Failure::cannot_write(path, &error))?;
    output::finished(path, Ok(()), finished)
}

fn add_writing_time(path: &Path, label: &Label) {
    let [number, of] = label.part;
    let tiles = text::count(label.tiles().len(), "tile");
    messages::note(&format!("wrote {} (part {number} of {of}, {tiles})", text::shown(path)));
}
