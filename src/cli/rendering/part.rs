//! `tabray render --part`: renders a part of an image into a file beside it, from which `tabray merge` makes the image.

use crate::files::output::{self, Output};
use crate::options::size::Part;
use crate::options::stop::Stop;
use crate::process::failure::{self, Failure};
use crate::process::progress::Progress;
use crate::process::{memory, messages};
use crate::rendering::job::{report_proofs, warn_of};
use crate::rendering::part_begun::{UnfinishedPart, is_complete, remove};
use crate::rendering::stats::Stats;
use crate::rendering::{aov, full_range, resume, unfinished};
use std::fs;
use std::io::{self, BufWriter, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::thread;
use tabray_core::output::aov::{Aov, Setting};
use tabray_core::output::aov_values::Values;
use tabray_core::output::picture::Format;
use tabray_core::parallel;
use tabray_core::render::division::{self, Grid};
use tabray_core::render::plan::Plan;
use tabray_core::render::ray_stats::RayStats;
use tabray_core::render::renderer::{RenderCallbacks, Renderer};
use tabray_core::render::tiles::{Band, TILE};
use tabray_core::text;
use tabray_tools::part::{self, Label, MOST_PARTS, PixelFormat, Writer};

/// The message if a part is stopped of which nothing is kept.
const UNKEPT: &str = "the part was not finished, and nothing is written";

#[derive(clap::Args)]
#[group(id = "which part")]
#[command(next_help_heading = "Parts and frames")]
pub struct Args {
    /// Render only part K of N, into a file beside the image: `-o a.png --part 3/16` writes a.png.part-3-of-16, and
    /// `merge a.png` makes the image of all parts. Parts have about equal work, and are the same on every machine; with
    /// --resume, an existing part is not rendered again
    #[arg(long, value_name = "K/N", value_parser = share)]
    pub part: Option<[usize; 2]>,
}

fn share(text: &str) -> Result<[usize; 2], String> {
    let (number, of) = text.split_once('/').unwrap_or_default();
    let wrong =
        || format!("give a part as `3/16`: its number, from 1, and of how many parts, up to {MOST_PARTS}");
    let [number, of]: [usize; 2] = [number.parse().map_err(|_| wrong())?, of.parse().map_err(|_| wrong())?];
    match (number, of) {
        (_, of) if !(1..=MOST_PARTS).contains(&of) => Err(wrong()),
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
pub struct Share<'a> {
    pub part: [usize; 2],
    /// The texts that a PNG records about how the image was made.
    pub made: &'a [(&'a str, String)],
    pub plan: &'a Plan<'a>,
    /// The part of the image that is rendered.
    pub region: &'a Part,
    pub renderer: &'a Renderer,
    /// The path of the image, and that of an image whose name those beside it have.
    pub paths: [&'a Path; 2],
    pub what: PixelFormat,
    pub beside: &'a [Aov],
    /// The format of the images beside the main one.
    pub format: Format,
    /// The maximum number of pixels in memory at one time.
    pub at_once: usize,
    pub stop: &'a Stop,
    pub stats: &'a Stats,
}

impl Share<'_> {
    /// Renders the part of the main image and of those beside it. `truth` calls what it is given with the plan of the
    /// reference for errors.
    pub fn run(
        &self,
        resumes: bool,
        truth: impl FnOnce(&mut dyn FnMut(&Plan) -> Result<(), Failure>) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let (tiles, [path, beside]) = (self.tiles()?, self.paths);
        let identity = resume::identity(self.plan.model, self.region)?;
        let label = |what, unfinished| {
            let identity = identity.clone();
            let (part, size, beside) = (self.part, self.region.size(), self.beside.to_vec());
            let made = self.made.iter().map(|(keyword, text)| ((*keyword).to_owned(), text.clone()));
            let (made, tiles) = (made.collect(), [tiles.start, tiles.end]);
            Label { part, tiles, size, what, beside, identity, made, unfinished }
        };
        let main = beside_and_label(path, label(self.what, false));
        if resumes && is_complete(&main)? {
            // Where the program was killed just after it had finished the part, its checkpoint is still there.
            UnfinishedPart::remove(&resume::beside(&main.0), &main.1)?;
        } else {
            match self.what {
                PixelFormat::Exr | PixelFormat::Pfm => self.full_range(&main)?,
                _ => self.bytes(&main, resumes, label(self.what, true))?,
            }
            add_writing_time(&main.0, &main.1);
        }
        if self.beside.is_empty() {
            return Ok(());
        }
        self.stop.exit_on_interrupt()?;
        truth(&mut |truth| {
            for aov in self.beside {
                let compression = match self.format {
                    Format::Png(compression) => Some(compression),
                    Format::Ppm => None,
                };
                let what = PixelFormat::Beside(*aov, compression, Setting::of(&self.plan.camera));
                let file = beside_and_label(&aov::picture(beside, *aov), label(what, false));
                if !(resumes && is_complete(&file)?) {
                    self.values(&file, *aov, truth)?;
                    add_writing_time(&file.0, &file.1);
                }
            }
            Ok(())
        })
    }

    fn grid(&self) -> Grid {
        Grid { size: self.region.size() }
    }

    /// Returns the tiles of the part.
    fn tiles(&self) -> Result<Range<usize>, Failure> {
        let ([number, of], [width, height], tiles) = (self.part, self.region.size(), self.grid().count());
        if of > tiles {
            return Err(Failure::Usage(
                format!("an image of {width} x {height} pixels cannot have {of} parts"),
                Some(format!("it has {}, and a part at least one", text::count(tiles, "tile"))),
            ));
        }
        let region = [&self.region.columns, &self.region.rows];
        let ends = division::divide(self.renderer, self.plan, region, of);
        Ok(ends[number - 1]..ends[number])
    }

    /// Renders bytes, or stops and leaves what is done.
    fn bytes(&self, file: &(PathBuf, Label), resumes: bool, unfinished: Label) -> Result<(), Failure> {
        let (path, label) = file;
        let checkpoint = resume::beside(path);
        let mut begun = if resumes { UnfinishedPart::open(&checkpoint, label)? } else { None };
        let was_begun = begun.is_some();
        let tiles = label.tiles();
        let progress = Progress::new(self.grid().rows(&tiles).len());
        let overseer = RenderCallbacks { stops: &|| self.stop.is_due(), row: &|| progress.step() };
        let sum = &self.stats.tally;
        let add = |tally: RayStats| sum.add(&tally);
        let cannot = |error: io::Error| Failure::cannot_write(path, &error);
        let mut writer = begin(path, label)?;
        let mut mask = Vec::new();
        self.stop.begin();
        thread::scope(|scope| {
            let (all, mut bytes) = (self.region.columns.len(), Vec::new());
            for rows in Band::split(&(0..all), &self.grid().rows(&tiles), self.at_once) {
                if self.stop.is_due() && begun.is_none() {
                    break;
                }
                memory::refuse_too_large(3 * rows.len() * all, "the image")?;
                let mut band = self.band(&tiles, rows.clone(), begun.as_mut())?;
                if begun.as_ref().is_some_and(UnfinishedPart::is_over) {
                    begun = None;
                }
                self.stats
                    .timed(|| unfinished::fill(scope, (self.renderer, self.plan), &mut band, overseer, &add));
                for index in self.of_rows(&tiles, &rows) {
                    let (columns, at) = self.place(index);
                    let strip = band.strip((at.start - rows.start) / TILE);
                    let inside = 0..at.len();
                    let pixels = strip.pixels.as_flattened();
                    part::take_tile(pixels, 3 * all, [columns.clone(), inside], 3, &mut bytes);
                    mask.push(u8::from(strip.tiles[columns.start / TILE]));
                    writer.put(&bytes).map_err(cannot)?;
                }
            }
            progress.end();
            let tally = &self.stats.tally;
            warn_of(&tally.flaws(), self.plan.model);
            report_proofs(tally.proofs(), self.plan);
            let is_whole = mask.len() == tiles.len() && mask.iter().all(|done| *done == 1);
            if is_whole {
                return Ok::<_, Failure>(());
            }
            self.stop.report();
            // Threads may be at work on tiles of which nothing is kept.
            failure::end(&match self.leave(&checkpoint, unfinished, &mask, writer.begin, &mut writer) {
                Ok(()) => Failure::Stopped,
                Err(failure) => failure,
            })
        })?;
        finish(path, writer)?;
        if was_begun { remove(&checkpoint) } else { Ok(()) }
    }

    /// Returns the tiles of the part that lie in some rows.
    fn of_rows(&self, tiles: &Range<usize>, rows: &Range<usize>) -> Range<usize> {
        let across = self.grid().across();
        let all = rows.start / TILE * across..rows.end.div_ceil(TILE) * across;
        tiles.start.max(all.start)..tiles.end.min(all.end)
    }

    /// Returns the columns and rows of a tile.
    fn place(&self, index: usize) -> (Range<usize>, Range<usize>) {
        let [columns, rows] = self.grid().tile(index);
        (columns, rows)
    }

    /// Makes a band of rows of the region in which only the tiles of the part are to be rendered that the checkpoint does
    /// not have.
    fn band(
        &self,
        tiles: &Range<usize>,
        rows: Range<usize>,
        mut begun: Option<&mut UnfinishedPart>,
    ) -> Result<Band, Failure> {
        let Part { columns, rows: all } = self.region;
        let band = Band::blank(columns.clone(), all.start + rows.start..all.start + rows.end);
        let across = self.grid().across();
        for index in rows.start / TILE * across..rows.end.div_ceil(TILE) * across {
            let (place, at) = self.place(index);
            let mut strip = band.strip((at.start - rows.start) / TILE);
            let is_done = match begun.as_deref_mut().filter(|_| tiles.contains(&index)) {
                Some(begun) => {
                    let pixels = strip.pixels.as_flattened_mut();
                    begun.tile(pixels, 3 * columns.len(), [place.clone(), 0..at.len()])?
                }
                None => !tiles.contains(&index),
            };
            strip.tiles[place.start / TILE] = is_done;
        }
        Ok(band)
    }

    /// Writes what is done of a part, from what was written of it so far.
    fn leave(
        &self,
        path: &Path,
        label: Label,
        mask: &[u8],
        begin_at: u64,
        written: &mut Writer<BufWriter<Output>>,
    ) -> Result<(), Failure> {
        let done = mask.iter().filter(|done| **done == 1).count();
        if done == 0 {
            messages::note("nothing has been rendered yet, and nothing is written");
            return Ok(());
        }
        let cannot = |error: io::Error| Failure::cannot_write(path, &error);
        let tiles = label.tiles();
        let mut mask = mask.to_vec();
        let kept = self.grid().pixels_of(tiles.start..tiles.start + mask.len());
        let rest = self.grid().pixels_of(tiles.start + mask.len()..tiles.end);
        mask.resize(tiles.len(), 0);
        let mut writer = begin(path, &label)?;
        let mut file = read_from(written, begin_at).map_err(cannot)?;
        let mut copied = || -> io::Result<()> {
            writer.put(&mask)?;
            copy(&mut io::Read::take(&mut file, 3 * kept as u64), &mut writer)?;
            copy(&mut io::Read::take(io::repeat(0), 3 * rest as u64), &mut writer)
        };
        copied().map_err(cannot)?;
        finish(path, writer)?;
        let share = (1000.0 * done as f64 / tiles.len() as f64).floor() / 10.0;
        let ([number, of], path) = (self.part, path.display());
        messages::note(&format!(
            "wrote {share:.1} % of part {number}/{of} to {path}, from which `--resume` renders the rest"
        ));
        Ok(())
    }

    /// Renders colours of full range. Nothing is kept of a part that is stopped.
    fn full_range(&self, file: &(PathBuf, Label)) -> Result<(), Failure> {
        let (path, label) = file;
        let (tiles, grid) = (label.tiles(), self.grid());
        let Part { columns, rows } = self.region;
        let progress = Progress::new(grid.rows(&tiles).len());
        let overseer = RenderCallbacks { stops: &|| self.stop.is_due(), row: &|| progress.step() };
        let sum = &self.stats.tally;
        let add = |tally: RayStats| sum.add(&tally);
        let mut writer = begin(path, label)?;
        self.stop.begin_unkept(UNKEPT);
        let mut tile = Vec::new();
        for run in grid.rectangles(&tiles, self.at_once / (TILE * columns.len())) {
            let [first, last] = [grid.tile(run.start), grid.tile(run.end - 1)];
            let (wide, tall) = (first[0].start..last[0].end, first[1].start..last[1].end);
            memory::refuse_too_large(full_range::PIXEL * wide.len() * tall.len(), "the image")?;
            let whole = [
                &(columns.start + wide.start..columns.start + wide.end),
                &(rows.start + tall.start..rows.start + tall.end),
            ];
            let mut colours = None;
            self.stats.timed(|| colours = self.renderer.colours(self.plan, whole, overseer, &add));
            let Some(colours) = colours else {
                progress.end();
                self.stop.report();
                messages::note(UNKEPT);
                return Err(Failure::Stopped);
            };
            let bytes: Vec<u8> = colours.iter().flat_map(|number| number.to_le_bytes()).collect();
            for index in run {
                let (of, at) = self.place(index);
                let (of, at) =
                    (of.start - wide.start..of.end - wide.start, at.start - tall.start..at.end - tall.start);
                part::take_tile(&bytes, 12 * wide.len(), [of, at], 12, &mut tile);
                writer.put(&tile).map_err(|error| Failure::cannot_write(path, &error))?;
            }
        }
        progress.end();
        warn_of(&self.stats.tally.flaws(), self.plan.model);
        report_proofs(self.stats.tally.proofs(), self.plan);
        finish(path, writer)
    }

    /// Computes the numbers of an image beside the main one.
    fn values(&self, file: &(PathBuf, Label), aov: Aov, truth: &Plan) -> Result<(), Failure> {
        let (path, label) = file;
        let (plan, grid) = (self.plan, self.grid());
        let (tiles, height) = (label.tiles(), plan.camera.pixels[1]);
        memory::refuse_too_large(24 * self.grid().pixels_of(tiles.clone()), "the part")?;
        let progress = Progress::new(tiles.len());
        let tile = |index: usize| {
            let [columns, rows] = grid.tile(tiles.start + index);
            let pixels = rows.flat_map(|row| columns.clone().map(move |column| (column, row)));
            let values: Vec<Values> =
                pixels.map(|(x, row)| aov.values(plan, truth, x, height - 1 - row)).collect();
            progress.step();
            values
        };
        let values = self.renderer.run(|| parallel::map(tiles.len(), tile));
        progress.end();
        let mut writer = begin(path, label)?;
        for numbers in values.iter().flatten().flatten() {
            writer.put(&numbers.to_le_bytes()).map_err(|error| Failure::cannot_write(path, &error))?;
        }
        finish(path, writer)
    }
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

fn copy(from: &mut dyn io::Read, to: &mut Writer<BufWriter<Output>>) -> io::Result<()> {
    let mut block = vec![0; 1 << 16];
    loop {
        match from.read(&mut block)? {
            0 => return Ok(()),
            read => to.put(&block[..read])?,
        }
    }
}

/// Opens what was written so far, from this byte on.
fn read_from(written: &mut Writer<BufWriter<Output>>, byte: u64) -> io::Result<fs::File> {
    let out = written.out();
    out.flush()?;
    let mut file = out.get_ref().read()?;
    io::Seek::seek(&mut file, io::SeekFrom::Start(byte))?;
    Ok(file)
}

fn add_writing_time(path: &Path, label: &Label) {
    let [number, of] = label.part;
    let tiles = text::count(label.tiles().len(), "tile");
    messages::note(&format!("wrote {} (part {number} of {of}, {tiles})", path.display()));
}
