//! `tabray merge`: puts an image together from its parts.

use crate::command::{Command, Group, Run};
use crate::files::output::{self, Output};
use crate::files::paths::are_same;
use crate::options::threads;
use crate::process::failure::Failure;
use crate::process::progress::Progress;
use crate::process::{memory, messages};
use crate::rendering::part::beside as beside_image;
use crate::rendering::part_files::{Parts, open};
use crate::rendering::{aov, bands};
use std::fs;
use std::io::{self, BufWriter};
use std::iter;
use std::path::{Path, PathBuf};
use std::time::Instant;
use tabray_core::files::in_held_folder;
use tabray_core::output::aov::Aov;
use tabray_core::output::aov_values::Values;
use tabray_core::output::full_range::FullRange;
use tabray_core::output::picture::{About, Format};
use tabray_core::render::renderer::Renderer;
use tabray_core::render::tiles::TILE;
use tabray_core::text;
use tabray_lang::registry::Registry;
use tabray_tools::pixels::{self, PixelFormat, Reader};

/// The maximum number of parts that are named in a message.
const NAMED: usize = 12;

/// Join the parts of an image
///
/// The parts are those that `tabray render --part K/N -o IMAGE` wrote. The image, and the images of --aov, have the
/// same bytes as from a single render.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {
    /// The image to write, as given to `render --part` with -o
    image: PathBuf,
    /// The parts, in any order; by default, all files beside the image that are named like its parts
    parts: Vec<PathBuf>,
    /// Remove the parts once the image is written
    #[arg(long)]
    remove_parts: bool,
    #[command(flatten)]
    threads: threads::Args,
}

const EXAMPLES: &str = "\
Examples:
  tabray merge big.png
  tabray merge big.png --remove-parts
  tabray merge big.png node1/big.png.part-* node2/big.png.part-*";

inventory::submit! {
    Command::new("merge", Group::Rendering, &Run(run)).placed(2, 1)
}

fn run(_: &Registry, args: Args) -> Result<(), Failure> {
    let is_full_range = FullRange::of(&args.image).is_some();
    let renderer = args.threads.renderer()?;
    let is_main = |what: PixelFormat| !matches!(what, PixelFormat::Beside(..));
    let main = Parts::gather(&args.image, &args.parts, is_main)?;
    main.refuse_name(&args.image)?;
    if !main.label.identity.is_of_this_program()? {
        messages::warning(
            "the parts were made by another build of this program",
            Some("its images have the same pixels, but their files may be compressed differently"),
        );
    }
    let names = if is_full_range { args.image.with_extension("png") } else { args.image.clone() };
    let mut beside = Vec::new();
    for aov in &main.label.beside {
        let path = aov::picture(&names, *aov);
        let is_this = |what: PixelFormat| matches!(what, PixelFormat::Beside(other, ..) if other == *aov);
        let parts = Parts::gather(&path, &args.parts, is_this)?;
        main.refuse_other_scene(&parts)?;
        beside.push((path, parts));
    }
    main.write(&args.image, &renderer)?;
    for (path, parts) in &beside {
        parts.write(path, &renderer)?;
    }
    let all = iter::once(&main).chain(beside.iter().map(|(_, parts)| parts));
    if args.remove_parts {
        for path in all.flat_map(|parts| &parts.paths) {
            let cannot = |error| {
                Failure::Failed(format!("cannot remove `{}`: {}", text::shown(path), text::reason(&error)))
            };
            in_held_folder(path).and_then(fs::remove_file).map_err(cannot)?;
        }
    }
    Ok(())
}

impl Parts {
    /// Refuses to write the image to a file whose name belongs to something else, unless the parts are named like it.
    fn refuse_name(&self, image: &Path) -> Result<(), Failure> {
        let (format, full_range) = (Format::of(image), FullRange::of(image));
        let (extension, is_right) = match self.label.what {
            PixelFormat::Ppm => ("ppm", matches!(format, Some(Format::Ppm))),
            PixelFormat::Png(_) | PixelFormat::PngAlpha(_) => ("png", matches!(format, Some(Format::Png(_)))),
            PixelFormat::Exr | PixelFormat::ExrAlpha => ("exr", matches!(full_range, Some(FullRange::Exr))),
            PixelFormat::Pfm => ("pfm", matches!(full_range, Some(FullRange::Pfm))),
            PixelFormat::Beside(..) => return Ok(()),
        };
        let of = self.paths.len();
        let is_named_like_it = |(index, path): (usize, &PathBuf)| {
            path.file_name() == beside_image(image, [index + 1, of]).file_name()
        };
        if is_right || image == Path::new("-") || self.paths.iter().enumerate().all(is_named_like_it) {
            return Ok(());
        }
        Err(Failure::usage(format!(
            "the parts are those of a .{extension} image, not of `{}`",
            text::shown(image)
        ))
        .help(format!("end the name in .{extension}")))
    }

    /// Writes the image.
    fn write(&self, path: &Path, renderer: &Renderer) -> Result<(), Failure> {
        let start = Instant::now();
        match self.label.what {
            PixelFormat::Ppm => self.bytes(path, Format::Ppm, renderer)?,
            PixelFormat::Png(compression) | PixelFormat::PngAlpha(compression) => {
                self.bytes(path, Format::Png(compression), renderer)?
            }
            PixelFormat::Exr | PixelFormat::ExrAlpha => self.full_range(path, FullRange::Exr)?,
            PixelFormat::Pfm => self.full_range(path, FullRange::Pfm)?,
            PixelFormat::Beside(aov, compression, setting) => {
                let format = compression.map_or(Format::Ppm, Format::Png);
                let numbers = self.all(24)?;
                let number = |bytes: &[u8; 8]| f64::from_le_bytes(*bytes);
                let (pixels, _) = numbers.as_chunks().0.as_chunks::<3>();
                let values: Vec<Values> = pixels.iter().map(|pixel| pixel.each_ref().map(number)).collect();
                drop(numbers);
                let layer = Aov::layer(aov, &values, &setting);
                aov::print_remarks(&layer);
                for (format, path) in aov::numbers(aov, path) {
                    let output = self.open(&path)?;
                    aov::write_numbers(&layer, (format, path, output), self.label.size)?;
                }
                let (rows, about) = (iter::once(Ok(layer.bytes)), self.about());
                return output::write_image(path, self.open(path)?, |out| {
                    format.write_on(None, &about, out, self.label.size, rows)
                });
            }
        }
        if path != Path::new("-") {
            let ([width, height], seconds) = (self.label.size, start.elapsed().as_secs_f64());
            let (shown, parts) = (text::shown(path), text::count(self.paths.len(), "part"));
            messages::note(&format!("wrote {shown} ({width} x {height} pixels, of {parts}, {seconds:.2} s)"));
        }
        Ok(())
    }

    /// Returns what the file of the image says, without texts.
    fn about(&self) -> About<'static> {
        About { texts: &[], dpi: self.label.dpi, alpha: self.label.what.has_alpha() }
    }

    /// Opens a file to write, which must not be a part.
    fn open(&self, path: &Path) -> Result<Output, Failure> {
        if self.paths.iter().any(|part| are_same(part, path)) {
            return Err(Failure::usage(format!(
                "`{}` is a part, which the image would replace",
                text::shown(path)
            ))
            .help("name another file for the image"));
        }
        Output::open(path)
    }

    /// Writes an image of bytes, a row of tiles at a time.
    fn bytes(&self, path: &Path, format: Format, renderer: &Renderer) -> Result<(), Failure> {
        let size = self.label.size;
        let (mut out, mut broken) = (BufWriter::with_capacity(1 << 16, self.open(path)?), None);
        let progress = Progress::new(size[1].div_ceil(TILE));
        let rows = self.rows(self.label.what.pixel()).map(|rows| {
            progress.step();
            rows.map_err(|failure| {
                broken = Some(failure);
                io::ErrorKind::InvalidData.into()
            })
        });
        let made: Vec<_> =
            self.label.made.iter().map(|(keyword, text)| (keyword.as_str(), text.clone())).collect();
        let about = About { texts: &made, ..self.about() };
        let written = format.write_on(Some(renderer), &about, &mut out, size, rows);
        progress.end();
        match broken {
            Some(failure) => Err(failure),
            None => output::finished(path, written, out),
        }
    }

    fn full_range(&self, path: &Path, format: FullRange) -> Result<(), Failure> {
        let [width, height] = self.label.size;
        memory::refuse_too_large(bands::PIXEL.saturating_mul(width).saturating_mul(height), "the image")?;
        let out = self.open(path)?;
        let bytes = self.all(self.label.what.pixel())?;
        let pixels: Vec<f32> = bytes.as_chunks().0.iter().map(|number| f32::from_le_bytes(*number)).collect();
        drop(bytes);
        let mut out = BufWriter::new(out);
        let written = format.write(&mut out, self.label.size, &pixels, &self.about());
        output::finished(path, written, out)
    }

    /// Returns all bytes of an image that is held in memory.
    fn all(&self, pixel: usize) -> Result<Vec<u8>, Failure> {
        let [width, height] = self.label.size;
        memory::refuse_too_large(2 * pixel * width * height, "the image")?;
        let mut all = Vec::with_capacity(pixel * width * height);
        for rows in self.rows(pixel) {
            all.extend(rows?);
        }
        Ok(all)
    }

    /// Reads the parts, and returns the bytes of each row of tiles, from the top.
    fn rows(&self, pixel: usize) -> impl Iterator<Item = Result<Vec<u8>, Failure>> + '_ {
        let (mut paths, mut reader) = (self.paths.iter(), None::<(&PathBuf, Reader)>);
        let grid = self.label.grid();
        pixels::strips(grid, 0..grid.count(), pixel, move |index, tile| {
            let (path, reader) = match &mut reader {
                Some((path, reader)) if reader.label.tiles[1] != index => (path, reader),
                reader => {
                    let changed = || Failure::usage("the parts have changed").help("begin again");
                    let path = paths.next().ok_or_else(changed)?;
                    let (path, reader) = reader.insert((path, open(path)?));
                    (path, reader)
                }
            };
            reader.read(tile).map_err(|error| self.damaged(path, &error))
        })
    }

    /// Returns the error for a part that cannot be read to its end, and for all other such parts.
    fn damaged(&self, path: &Path, error: &io::Error) -> Failure {
        if error.kind() != io::ErrorKind::InvalidData {
            return Failure::cannot_read(path, error);
        }
        let is_damaged = |path: &&PathBuf| open(path).is_ok_and(|mut part| part.check().is_err());
        let damaged: Vec<_> =
            self.paths.iter().filter(is_damaged).map(|path| format!("`{}`", text::shown(path))).collect();
        let (shown, rest) = damaged.split_at(damaged.len().min(NAMED));
        let more = if rest.is_empty() { String::new() } else { format!(" and {} more", rest.len()) };
        Failure::usage(format!("{} damaged: the checksum at the end is wrong{}", are_files(shown), more))
            .help("render these parts again")
    }
}

fn are_files(paths: &[String]) -> String {
    let are = if paths.len() == 1 { "is" } else { "are" };
    format!("{} {are}", paths.join(", "))
}
