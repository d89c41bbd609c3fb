//! `tabray render`: renders a scene's image.

mod image;

use crate::command::{Command, Group, Run};
use crate::files::input::Source;
use crate::files::output::format_of;
use crate::files::{folders, input, output, several};
use crate::options::frames::{Frame, Range};
use crate::options::named::by_name;
use crate::options::{cpu, frames, keep, method, print, samples, set, size, stop, threads};
use crate::process::failure::Failure;
use crate::rendering::{aov, debug, overlay, part, resume, stats};
use std::path::{Path, PathBuf};
use tabray_core::output::deflate::Compression;
use tabray_core::output::full_range::FullRange;
use tabray_core::output::picture::Format;
use tabray_core::scene::model::Model;
use tabray_lang::registry::Registry;

/// Render scenes to images
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
pub struct Args {
    /// The scenes, or folders of scenes; `-` reads one from standard input
    #[arg(required = true, value_name = "SCENE")]
    scenes: Vec<PathBuf>,
    #[command(flatten)]
    set: set::Args,
    /// The image to write: a .png or .ppm file, an .exr or .pfm file for colours that are neither clamped nor rounded,
    /// or `-` for standard output (a PPM unless --format says otherwise). By default, the image has the scene's name
    /// with .png and lies in the working directory. For several scenes, or if it ends with `/`, this is a folder, which
    /// is created if necessary
    #[arg(short, long, value_name = "FILE|DIR")]
    output: Option<PathBuf>,
    /// The image format, whatever the file's extension
    #[arg(long, value_parser = by_name::<Format>())]
    format: Option<Format>,
    /// The compression of a PNG
    #[arg(long, value_name = "HOW", default_value = "fast", value_parser = by_name::<Compression>())]
    compress: Compression,
    #[command(flatten)]
    size: size::Args,
    /// The exposure in stops: each stop doubles all colours, and each stop below 0 halves them
    #[arg(long, value_name = "STOPS", default_value = "0", value_parser = exposure, allow_negative_numbers = true)]
    #[arg(help_heading = "Image")]
    exposure: f64,
    #[command(flatten)]
    print: print::Args,
    #[command(flatten)]
    overlay: overlay::Args,
    #[command(flatten)]
    samples: samples::Args,
    #[command(flatten)]
    method: method::Args,
    #[command(flatten)]
    aov: aov::Args,
    #[command(flatten)]
    debug: debug::Args,
    #[command(flatten)]
    stats: stats::Args,
    #[command(flatten)]
    part: part::Args,
    #[command(flatten)]
    frames: frames::Args,
    #[command(flatten)]
    stop: stop::Args,
    #[command(flatten, next_help_heading = "Speed")]
    threads: threads::Args,
    #[command(flatten)]
    cpu: cpu::Args,
    #[command(flatten)]
    keep: keep::Args,
}

const EXAMPLES: &str = "\
Examples:
  tabray render ball.ray                                  # writes ball.png
  tabray render ball.ray -o big.png --size 1600 --samples 16
  tabray render ball.ray --quick --set ball.radius=3
  tabray render *.ray -o images/
  tabray render scenes/ -o images/                         # all scenes of a folder
  tabray render ball.ray --max-error 2 --stats             # levels of 255
  tabray render ball.ray -o film.png --frames 1..100 --sweep ball.radius=1..2
  tabray render ball.ray -o big.png --part 1/4             # then 2/4 to 4/4, and `merge`";

inventory::submit! {
    Command::new("render", Group::First, &Run(run)).placed(3, 0).keeping_time_limit()
}

fn run(registry: &Registry, mut args: Args) -> Result<(), Failure> {
    // The images of a folder's scenes go to a folder, however many there are.
    let is_folder = folders::open(&mut args.scenes)?;
    let output = args.output.as_deref();
    let goes_to_folder = is_folder || several::is_folder(output, args.scenes.len());
    if let ([scene], false) = (&args.scenes[..], goes_to_folder) {
        let (scene, path) = (scene.clone(), several::target(output, scene, args.extension())?);
        let frames = args.frames.of(&path, &mut args.part.part)?;
        let stop = args.stop.watch()?;
        let Some(frames) = frames else { return image::render(registry, &args, (&scene, path), &stop) };
        if path == Path::new("-") || input::is_standard(&scene) {
            return Err(Failure::usage("`--frames` needs a scene in a file, and writes files")
                .help("name the scene, and the images with `-o FILE`"));
        }
        let set = args.set.values.clone();
        args.set.set_by = args.frames.set_by();
        // A sweep that ends beyond what the scene allows, and a frame whose files would replace one of the scene, are
        // told before the first frame is rendered.
        if let [_, .., last] = &frames[..] {
            args.set.values = [&set[..], &last.sets].concat();
            let last = Source::read(&scene, &args.set)?.load(registry, args.method.accuracy()?);
            let model = last.map_err(Failure::Scene)?.model;
            for frame in &frames {
                args.refuse_sources(&frame.path, &scene, &model)?;
            }
        }
        for frame in frames {
            stop.exit_on_interrupt()?;
            args.set.values = [&set[..], &frame.sets].concat();
            image::render(registry, &args, (&scene, frame.path), &stop)?;
        }
        return Ok(());
    }
    if args.frames.frames.is_some() {
        return Err(Failure::usage("`--frames` takes one scene")
            .help("render the scenes one after the other, each with `-o FILE`"));
    }
    args.refuse_overlay(
        "`--overlay` takes one scene",
        "render the scenes one after the other, each with its own SVG",
    )?;
    let targets = several::targets(&args.scenes, output, args.extension())?;
    let stop = args.stop.watch()?;
    several::for_each_scene(&args.scenes, |index| {
        stop.exit_on_interrupt()?;
        image::render(registry, &args, (&args.scenes[index], targets[index].clone()), &stop)
    })
}

impl Args {
    /// Checks, for commands that let others render, that one scene and the options make an image, or frames, and
    /// returns which frames; nothing is written.
    pub fn check(mut self, registry: &Registry) -> Result<Option<Range>, Failure> {
        let [scene] = &self.scenes[..] else { return Err(Failure::AlreadyReported) };
        self.refuse_overlay("`--overlay` is for images in one piece", "leave out the option")?;
        let scene = scene.clone();
        let path = several::target(self.output.as_deref(), &scene, self.extension())?;
        if path == Path::new("-") || input::is_standard(&scene) {
            return Err(Failure::usage("standard input and output are those of one machine")
                .help("name the scene, and the image with `-o FILE`, in a folder that all machines share"));
        }
        let (set, mut whole) = (self.set.values.clone(), None);
        self.set.set_by = self.frames.set_by();
        let frames = self.frames.of(&path, &mut whole)?;
        if frames.is_none() {
            self.print.dpi(&path, self.format_of(&path)?)?;
        }
        self.cpu.cpu()?;
        let mut frames = frames.unwrap_or_else(|| vec![Frame { path, sets: Vec::new() }]);
        let last = frames.len() - 1;
        frames.drain(1.min(last)..last);
        for frame in frames {
            self.set.values = [&set[..], &frame.sets].concat();
            let loaded = Source::read(&scene, &self.set)?.load(registry, self.method.accuracy()?);
            let mut model = input::print_warnings(loaded)?.model;
            self.samples.apply(&mut model.camera.value)?;
            self.size.apply(&mut model.camera.value)?;
            self.print.apply_alpha(&frame.path, self.format_of(&frame.path)?, &mut model.camera)?;
            self.refuse_sources(&frame.path, &scene, &model)?;
        }
        Ok(self.frames.frames)
    }

    fn refuse_overlay(&self, message: &str, help: &str) -> Result<(), Failure> {
        if self.overlay.is_wanted() { Err(Failure::usage(message).help(help)) } else { Ok(()) }
    }

    /// Returns the extension of an image whose name derives from its scene's.
    fn extension(&self) -> &'static str {
        if self.format == Some(Format::Ppm) { "ppm" } else { "png" }
    }

    /// Returns the format of an image of bytes, and of those beside any image, and that of one of full range.
    fn format_of(&self, path: &Path) -> Result<(Format, Option<FullRange>), Failure> {
        match self.full_range(path) {
            Some(full_range) => Ok((Format::Png(self.compress), Some(full_range))),
            None => format_of(self.format, path, self.compress).map(|format| (format, None)),
        }
    }

    /// Returns the format of an image of full range.
    fn full_range(&self, path: &Path) -> Option<FullRange> {
        FullRange::of(path).filter(|_| self.format.is_none())
    }

    /// Returns the name from which the names of the images beside an image are derived: beside one of full range, they are
    /// PNGs.
    fn main(&self, path: &Path) -> PathBuf {
        if self.full_range(path).is_some() { path.with_extension("png") } else { path.to_owned() }
    }

    /// Refuses to render an image if one of the files that are written for it would replace a file of which the model was
    /// read: the image, those beside it, a checkpoint where the render is stopped, and the parts of all these.
    fn refuse_sources(&self, path: &Path, scene: &Path, model: &Model) -> Result<(), Failure> {
        let refuse = |path: &Path, what| output::refuse_source_by(path, what, scene, model);
        let mut images = vec![path.to_owned()];
        for (aov, picture) in aov::pictures(&self.aov, &self.main(path)) {
            for (_, path) in aov::numbers(aov, &picture) {
                refuse(&path, "the image")?;
            }
            images.push(picture);
        }
        for image in &images {
            refuse(image, "the image")?;
        }
        let mut begun = path.to_owned();
        if let Some(number) = self.part.part {
            for image in &images {
                refuse(&part::beside(image, number), "a part of the image")?;
            }
            begun = part::beside(path, number);
        }
        match self.full_range(path) {
            Some(_) => Ok(()),
            None => refuse(&resume::beside(&begun), "a checkpoint"),
        }
    }

    /// Tells whether an image is rendered from its checkpoint on. Most frames of a film have none: they are complete or
    /// not begun.
    fn continues(&self, path: &Path) -> bool {
        self.stop.resume && (self.frames.frames.is_none() || resume::beside(path).exists())
    }

    /// Tells whether an existing image is not rendered again: with `--resume`, a complete frame.
    fn skips(&self, path: &Path, model: &Model) -> Result<bool, Failure> {
        let is_resumed = self.stop.resume && !self.continues(path);
        Ok(is_resumed && aov::requested(&self.aov, model)?.is_empty())
    }
}

fn exposure(text: &str) -> Result<f64, String> {
    let stops = text.parse().ok().filter(|stops: &f64| (-32.0..=32.0).contains(stops));
    stops.ok_or_else(|| "give stops as `1.5` or `-2`, from -32 to 32".to_owned())
}
