//! `tabray render --part`: renders a part of an image into a file beside it, from which `tabray merge` makes the image.

use crate::files::output::{self, Output};
use crate::options::size::Region;
use crate::options::stop::Stop;
use crate::process::failure::{self, Failure};
use crate::process::progress::Progress;
use crate::process::{memory, messages};
use crate::rendering::job::{report_proofs, warn_of};
use crate::rendering::resume::ResumedImage;
use crate::rendering::stats::Stats;
use crate::rendering::{aov, full_range, resume, unfinished};
use std::fs::File;
use std::io::{self, BufReader, BufWriter, Read, Seek, SeekFrom, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::thread;
use tabray_core::files;
use tabray_core::output::aov::{Aov, Setting};
use tabray_core::output::aov_values::Values;
use tabray_core::output::picture::Format;
use tabray_core::parallel;
use tabray_core::render::division::{self, Grid};
use tabray_core::render::plan::Plan;
use tabray_core::render::ray_stats::RayStats;
use tabray_core::render::renderer::{RenderCallbacks, Renderer};
use tabray_core::render::tiles::{Band, TILE, Tiles};
use tabray_core::text;
use tabray_tools::checkpoint::Identity;
use tabray_tools::part::{self, Label, MOST_PARTS, PixelFormat, Reader, Writer};

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
pub struct PartRender<'a> {
    pub part: [usize; 2],
    /// The texts that a PNG records about how the image was made.
    pub made: &'a [(&'a str, String)],
    pub plan: &'a Plan<'a>,
    /// The part of the image that is rendered.
    pub region: &'a Region,
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

impl PartRender<'_> {
    /// Renders the part of the main image and of those beside it. `truth` calls what it is given with the plan of the
    /// reference for errors.
    pub fn run(
        &self,
        resumes: bool,
        truth: impl FnOnce(&mut dyn FnMut(&Plan) -> Result<(), Failure>) -> Result<(), Failure>,
    ) -> Result<(), Failure> {
        let (tiles, [path, beside]) = (self.tiles()?, self.paths);
        let identity = resume::identity(self.plan.model, self.region)?;
        let label = |what| {
            let identity = identity.clone();
            let (part, size, beside) = (self.part, self.region.size(), self.beside.to_vec());
            let made = self.made.iter().map(|(keyword, text)| ((*keyword).to_owned(), text.clone()));
            let (made, tiles) = (made.collect(), [tiles.start, tiles.end]);
            Label { part, tiles, size, what, beside, identity, made }
        };
        let main = beside_and_label(path, label(self.what));
        if resumes && is_complete(&main)? {
            // Where the program was killed just after it had finished the part, its checkpoint is still there.
            // What belongs to another part stays.
            if let Ok(Some(begun)) = self.begun(&main) {
                begun.remove()?;
            }
        } else {
            match self.what {
                PixelFormat::Exr | PixelFormat::Pfm => self.full_range(&main)?,
                _ => self.bytes(&main, resumes)?,
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
                let file = beside_and_label(&aov::picture(beside, *aov), label(what));
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

    /// Opens the checkpoint of the part, if there is one.
    fn begun(&self, (path, label): &(PathBuf, Label)) -> Result<Option<ResumedImage>, Failure> {
        let size = self.rows_size(&label.tiles());
        ResumedImage::find(resume::beside(path), || Ok(checkpoint_of(label)), size)
    }

    /// Returns the width and the height of the rows of tiles that the part has some of, which are the rows of its
    /// checkpoint.
    fn rows_size(&self, tiles: &Range<usize>) -> [usize; 2] {
        [self.region.columns.len(), self.grid().rows(tiles).len()]
    }

    /// Renders bytes, or stops and keeps the finished part.
    fn bytes(&self, file: &(PathBuf, Label), resumes: bool) -> Result<(), Failure> {
        let (path, label) = file;
        let mut begun = if resumes { self.begun(file)? } else { None };
        let tiles = label.tiles();
        let progress = Progress::new(self.grid().rows(&tiles).len());
        let overseer = RenderCallbacks { stops: &|| self.stop.is_due(), row: &|| progress.step() };
        let sum = &self.stats.tally;
        let add = |tally: RayStats| sum.add(&tally);
        let cannot = |error: io::Error| Failure::cannot_write(path, &error);
        let mut writer = begin(path, label)?;
        let mut rendered = Tiles::none(self.rows_size(&tiles));
        self.stop.begin();
        thread::scope(|scope| {
            let (all, mut bytes) = (self.region.columns.len(), Vec::new());
            for rows in Band::split(&(0..all), &self.grid().rows(&tiles), self.at_once) {
                if self.stop.is_due() && begun.as_ref().is_none_or(ResumedImage::is_over) {
                    break;
                }
                memory::refuse_too_large(3 * rows.len() * all, "the image")?;
                let mut band = self.band(&tiles, rows.clone(), begun.as_mut())?;
                self.stats
                    .timed(|| unfinished::fill(scope, (self.renderer, self.plan), &mut band, overseer, &add));
                self.mark_others(&band, &tiles, &rows, false);
                rendered.add(&band);
                for index in self.of_rows(&tiles, &rows) {
                    let [columns, at] = self.grid().tile(index);
                    let strip = band.strip((at.start - rows.start) / TILE);
                    let pixels = strip.pixels.as_flattened();
                    part::take_tile(pixels, 3 * all, [columns, 0..at.len()], 3, &mut bytes);
                    writer.put(&bytes).map_err(cannot)?;
                }
            }
            progress.end();
            let tally = &self.stats.tally;
            warn_of(&tally.flaws(), self.plan.model);
            report_proofs(tally.proofs(), self.plan);
            if rendered.pixels() == self.grid().pixels_of(tiles.clone()) {
                return Ok::<_, Failure>(());
            }
            self.stop.report();
            // Threads may still be at work on tiles that are discarded.
            failure::end(&match self.leave(file, &rendered, &mut writer) {
                Ok(()) => Failure::Stopped,
                Err(failure) => failure,
            })
        })?;
        finish(path, writer)?;
        begun.map_or(Ok(()), ResumedImage::remove)
    }

    /// Returns the tiles of the part that lie in some rows.
    fn of_rows(&self, tiles: &Range<usize>, rows: &Range<usize>) -> Range<usize> {
        let across = self.grid().across();
        let all = rows.start / TILE * across..rows.end.div_ceil(TILE) * across;
        tiles.start.max(all.start)..tiles.end.min(all.end)
    }

    /// Makes a band of rows of the region in which only the tiles of the part are to be rendered that the checkpoint does
    /// not have.
    fn band(
        &self,
        tiles: &Range<usize>,
        rows: Range<usize>,
        begun: Option<&mut ResumedImage>,
    ) -> Result<Band, Failure> {
        let Region { columns, rows: all } = self.region;
        let band = Band::blank(columns.clone(), all.start + rows.start..all.start + rows.end);
        begun.map_or(Ok(()), |begun| begun.fill(&band))?;
        self.mark_others(&band, tiles, &rows, true);
        Ok(band)
    }

    /// Marks the tiles of a band that do not belong to the part.
    fn mark_others(&self, band: &Band, tiles: &Range<usize>, rows: &Range<usize>, is_done: bool) {
        for index in self.of_rows(&(0..self.grid().count()), rows).filter(|index| !tiles.contains(index)) {
            let [columns, at] = self.grid().tile(index);
            band.strip((at.start - rows.start) / TILE).tiles[columns.start / TILE] = is_done;
        }
    }

    /// Writes a checkpoint of the finished pixels of a part, taken from the part's unfinished file.
    fn leave(
        &self,
        (path, label): &(PathBuf, Label),
        rendered: &Tiles,
        written: &mut Writer<BufWriter<Output>>,
    ) -> Result<(), Failure> {
        if rendered.pixels() == 0 {
            messages::note("nothing has been rendered yet, and nothing is written");
            return Ok(());
        }
        let (path, tiles, width) = (resume::beside(path), label.tiles(), self.region.columns.len());
        let cannot = |error: io::Error| Failure::cannot_write(&path, &error);
        let mut file = BufReader::new(read_from(written, written.begin).map_err(cannot)?);
        let mut strips = part::strips(self.grid(), tiles.clone(), 3, |_, tile| file.read_exact(tile));
        let (mut strip, mut at) = (Vec::new(), 0);
        let next = |row: &mut [u8]| {
            if at == strip.len() {
                (strip, at) = (strips.next().unwrap_or(Err(io::ErrorKind::UnexpectedEof.into()))?, 0);
            }
            row.copy_from_slice(&strip[at..at + row.len()]);
            at += row.len();
            Ok(())
        };
        let size = [width, rendered.rows_begun()];
        let checkpoint = resume::write(&path, size, &checkpoint_of(label), rendered, next)?;
        checkpoint.finish().map_err(cannot)?;
        let of_all = rendered.pixels() as f64 / self.grid().pixels_of(tiles) as f64;
        let share = (1000.0 * of_all).floor() / 10.0;
        let ([number, of], path) = (self.part, text::shown(path));
        messages::note(&format!(
            "wrote {share:.1} % of part {number}/{of} to {path}, from which `--resume` renders the rest"
        ));
        Ok(())
    }

    /// Renders colours of full range. Nothing is kept of a part that is stopped.
    fn full_range(&self, file: &(PathBuf, Label)) -> Result<(), Failure> {
        let (path, label) = file;
        let (tiles, grid) = (label.tiles(), self.grid());
        let Region { columns, rows } = self.region;
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
                let [of, at] = self.grid().tile(index);
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

/// Tells whether a complete part exists.
fn is_complete((path, label): &(PathBuf, Label)) -> Result<bool, Failure> {
    let Ok(mut reader) = files::open(path).and_then(Reader::open) else { return Ok(false) };
    let there = &reader.label;
    let is_same = label.identity.differences(&there.identity).is_empty()
        && (label.tiles, label.what, &label.beside) == (there.tiles, there.what, &there.beside);
    let is_complete = is_same && reader.check().is_ok();
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

/// Describes the checkpoint of a part.
fn checkpoint_of(label: &Label) -> Identity {
    label.identity.clone().of_tiles(&label.tiles())
}

/// Opens what was written so far, from this byte on.
fn read_from(written: &mut Writer<BufWriter<Output>>, byte: u64) -> io::Result<File> {
    let out = written.out();
    out.flush()?;
    let mut file = out.get_ref().read()?;
    file.seek(SeekFrom::Start(byte))?;
    Ok(file)
}

fn add_writing_time(path: &Path, label: &Label) {
    let [number, of] = label.part;
    let tiles = text::count(label.tiles().len(), "tile");
    messages::note(&format!("wrote {} (part {number} of {of}, {tiles})", text::shown(path)));
}
