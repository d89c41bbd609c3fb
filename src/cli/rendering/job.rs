//! Renders an image and writes it, or stops and leaves a checkpoint for a later render.

use crate::files::output::{Output, finished, write_image};
use crate::files::provenance::Provenance;
use crate::process::failure::Failure;
use crate::process::messages;
use crate::rendering::bands::TileRender;
use crate::rendering::flaws;
use crate::rendering::resume::{self, ResumedImage};
use std::io::{self, BufWriter};
use std::iter;
use std::path::Path;
use std::time::Instant;
use tabray_core::output::full_range::FullRange;
use tabray_core::output::packing::PIECE;
use tabray_core::output::picture::Format;
use tabray_core::render::Levels;
use tabray_core::render::tiles::{BAND, Band};
use tabray_core::text;
use tabray_tools::pixels::TileSet;

/// The maximum number of blank pixels that are written in place of missing ones. If more are missing, the file ends at
/// the first row of which nothing is rendered.
const MAX_BLANK: usize = 1 << 24;

/// The message if a render of full range is stopped.
const UNKEPT: &str = "an EXR or a PFM is written only when it is complete: nothing is written";

/// An image that is rendered.
pub struct Job<'a> {
    /// All its tiles.
    pub tiles: TileRender<'a>,
    /// The path of the image.
    pub path: &'a Path,
    /// What the file says of how the image was made.
    pub made: &'a Provenance,
}

impl Job<'_> {
    /// Renders what a checkpoint does not have, and writes an image of bytes to its path. If the render is stopped, the
    /// program ends with what is done. Returns the levels of the image.
    pub fn bytes(
        &self,
        output: Output,
        format: Format,
        mut begun: Option<ResumedImage>,
    ) -> Result<Levels, Failure> {
        match output {
            Output::File(..) => self.tiles.stop.begin(),
            Output::Standard | Output::Special(_) => self.tiles.stop.begin_sending(),
        }
        let levels = self.tiles.bands(&mut begun, |bands| self.write(output, format, bands))?;
        begun.map_or(Ok(()), ResumedImage::remove)?;
        Ok(levels)
    }

    fn write(
        &self,
        output: Output,
        format: Format,
        bands: &mut dyn Iterator<Item = Result<Band, Failure>>,
    ) -> Result<Levels, Failure> {
        let TileRender { region, renderer, at_once, stop, .. } = self.tiles;
        let (grid, rows, wide) = (self.tiles.grid(), &region.rows, region.columns.len());
        let channels = self.made.about().channels();
        let (mut done, mut levels) = (TileSet::none(self.tiles.tiles.clone()), Levels::default());
        let (mut next, mut broken, mut is_cut, mut writing) = (rows.start, None, false, None);
        let mut out = BufWriter::with_capacity(1 << 16, output);
        let pieces = iter::from_fn(|| {
            if let Some(since) = writing.take() {
                stop.add_writing_time(Instant::elapsed(&since));
            }
            let band = match bands.next() {
                Some(Ok(band)) => band,
                Some(Err(failure)) => {
                    broken = Some(failure);
                    return Some(vec![Err(io::ErrorKind::InvalidData.into())]);
                }
                // Rendering has ended or stopped.
                None if (rows.end - next) * wide > MAX_BLANK => {
                    is_cut = true;
                    // One row more, so that the compressor writes the rows before it.
                    return Some(vec![Ok(vec![0; channels * wide]), Err(io::ErrorKind::Other.into())]);
                }
                None => {
                    let blank = Band::split(&region.columns, &(next..rows.end), at_once).next()?;
                    Band::blank(region.columns.clone(), blank, self.made.alpha)
                }
            };
            next = band.rows.end;
            let rendered = self.tiles.of_band(&band).into_iter().filter(|(_, is_done)| *is_done);
            rendered.for_each(|(tile, _)| done.add(tile));
            writing = Some(Instant::now());
            let bytes = band.bytes(PIECE);
            bytes.iter().for_each(|bytes| match self.made.alpha {
                true => levels.add_with_alpha(bytes),
                false => levels.add(bytes),
            });
            Some(bytes.into_iter().map(Ok).collect())
        });
        // Pieces that are compressed together are in memory together.
        let renderer = (at_once == BAND).then_some(renderer);
        let written =
            format.write_on(renderer, &self.made.about(), &mut out, region.size(), pieces.flatten());
        let leave = |out, rows| self.leave(out, format, &done, rows).err().unwrap_or(Failure::Stopped);
        match (broken, written) {
            (Some(failure), _) => Err(failure),
            (None, Err(error)) if is_cut && error.kind() == io::ErrorKind::Other => {
                Err(leave(out, done.iter().next_back().map_or(0, |last| grid.tile(last)[1].end)))
            }
            (None, Ok(())) if !done.is_whole() => Err(leave(out, rows.len())),
            (None, written) => finished(self.path, written, out).map(|()| levels),
        }
    }

    /// Writes an unfinished image to its path, and reports it. `out` contains `rows` rows of it, black where nothing is
    /// rendered.
    fn leave(
        &self,
        out: BufWriter<Output>,
        format: Format,
        done: &TileSet,
        rows: usize,
    ) -> Result<(), Failure> {
        let output =
            out.into_inner().map_err(|error| Failure::cannot_write(self.path, &error.into_error()))?;
        let [width, height] = self.tiles.region.size();
        let pixels = done.pixels(self.tiles.grid());
        let share = resume::share(pixels, width * height);
        messages::note(&match &output {
            Output::File(..) if pixels == 0 => resume::NOTHING.to_owned(),
            Output::File(..) => {
                let label = resume::label(self.tiles.plan.model, self.tiles.region, format, self.made)?;
                let checkpoint = resume::leave(&label, (self.path, format), output, (done, rows))?;
                let [picture, checkpoint] = [self.path, &checkpoint].map(Path::display);
                format!(
                    "wrote {share} of {picture}, and {checkpoint}, from which `--resume` renders the rest"
                )
            }
            Output::Standard | Output::Special(_) => {
                let rest = if rows < height { "missing" } else { "black" };
                format!("{share} of the image is rendered, and the rest is {rest}; only files can be resumed")
            }
        });
        Ok(())
    }

    /// Renders an image of full range, and writes it once it is whole: its formats cannot mark pixels that are not
    /// rendered.
    pub fn full_range(&self, output: Output, format: FullRange) -> Result<(), Failure> {
        let mut all = Vec::new();
        self.tiles.colours(UNKEPT, |_, _, colours| {
            all = colours;
            Ok(())
        })?;
        flaws::tell_of_far(self.tiles.stats.tally.flaws().far);
        write_image(self.path, output, |out| {
            format.write(out, self.tiles.region.size(), &all, &self.made.about())
        })
    }
}

/// Returns the error for options that images of full range cannot serve.
pub fn refuse_full_range(path: &Path, what: &str) -> Failure {
    Failure::usage(format!(
        "`{}` cannot be {what}: an EXR or a PFM is written only when it is complete",
        text::shown(path)
    ))
    .help("name a .png or .ppm file, or leave out the option")
}
