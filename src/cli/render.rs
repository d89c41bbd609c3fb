//! `tabray render`: renders a scene's image.

use super::course::Differences;
use crate::command::{Command, Group, Run};
use crate::files::input::Source;
use crate::files::output::{Output, format_of};
use crate::files::{folders, input, output, provenance, several};
use crate::options::frames::Frame;
use crate::options::named::by_name;
use crate::options::size::Region;
use crate::options::stop::{self, Stop};
use crate::options::{cpu, frames, keep, method, samples, set, size, threads};
use crate::process::failure::Failure;
use crate::process::{messages, progress};
use crate::rendering::bands::{PIXEL, TileRender};
use crate::rendering::job::{Job, refuse_full_range};
use crate::rendering::resume::ResumedImage;
use crate::rendering::stats::{self, Stats};
use crate::rendering::{aov, debug, flaws, part, resume, trial};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use std::time::{Duration, Instant};
use tabray_core::output::aov::Aov;
use tabray_core::output::deflate::Compression;
use tabray_core::output::full_range::FullRange;
use tabray_core::output::picture::Format;
use tabray_core::render::division::Grid;
use tabray_core::render::tiles::TILE;
use tabray_core::scene::model::Model;
use tabray_core::simd::cpu::Cpu;
use tabray_core::text;
use tabray_core::world::accuracy::Accuracy;
use tabray_lang::reader::{self, Loaded, ReadOptions};
use tabray_lang::registry::Registry;
use tabray_tools::diagnosis;

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
    Command::new("render", Group::Rendering, &Run(run)).placed(0, 0)
}

fn run(registry: &Registry, mut args: Args) -> Result<(), Failure> {
    args.samples.tell_max_error();
    // The images of a folder's scenes go to a folder, however many there are.
    let is_folder = folders::open(&mut args.scenes)?;
    let output = args.output.as_deref();
    let goes_to_folder = is_folder || several::is_folder(output, args.scenes.len());
    if let ([scene], false) = (&args.scenes[..], goes_to_folder) {
        let (scene, path) = (scene.clone(), several::target(output, scene, args.extension())?);
        let frames = args.frames.of(&path, &mut args.part.part)?;
        let stop = args.stop.watch()?;
        let Some(frames) = frames else { return render_image(registry, &args, (&scene, path), &stop) };
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
            render_image(registry, &args, (&scene, frame.path), &stop)?;
        }
        return Ok(());
    }
    if args.frames.frames.is_some() {
        return Err(Failure::usage("`--frames` takes one scene")
            .help("render the scenes one after the other, each with `-o FILE`"));
    }
    let targets = several::targets(&args.scenes, output, args.extension())?;
    let stop = args.stop.watch()?;
    several::for_each_scene(&args.scenes, |index| {
        stop.exit_on_interrupt()?;
        render_image(registry, &args, (&args.scenes[index], targets[index].clone()), &stop)
    })
}

impl Args {
    /// Checks, for commands that let others render, that one scene and the options make an image, or frames, and tells
    /// which; nothing is written.
    pub fn check(mut self, registry: &Registry) -> Result<bool, Failure> {
        let [scene] = &self.scenes[..] else { return Err(Failure::AlreadyReported) };
        let scene = scene.clone();
        let path = several::target(self.output.as_deref(), &scene, self.extension())?;
        if path == Path::new("-") || input::is_standard(&scene) {
            return Err(Failure::usage("standard input and output are those of one machine")
                .help("name the scene, and the image with `-o FILE`, in a folder that all machines share"));
        }
        let (set, mut whole) = (self.set.values.clone(), None);
        self.set.set_by = self.frames.set_by();
        let frames = self.frames.of(&path, &mut whole)?;
        if frames.is_none() && self.full_range(&path).is_none() {
            format_of(self.format, &path, self.compress)?;
        }
        self.cpu.cpu()?;
        let is_film = frames.is_some();
        let mut frames = frames.unwrap_or_else(|| vec![Frame { path, sets: Vec::new() }]);
        let last = frames.len() - 1;
        frames.drain(1.min(last)..last);
        for frame in frames {
            self.set.values = [&set[..], &frame.sets].concat();
            let loaded = Source::read(&scene, &self.set)?.load(registry, self.method.accuracy()?);
            let mut model = input::print_warnings(loaded)?.model;
            self.samples.apply(&mut model.camera.value)?;
            self.size.apply(&mut model.camera.value)?;
            self.refuse_sources(&frame.path, &scene, &model)?;
        }
        Ok(is_film)
    }

    /// Returns the extension of an image whose name derives from its scene's.
    fn extension(&self) -> &'static str {
        if self.format == Some(Format::Ppm) { "ppm" } else { "png" }
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

/// Renders one image of a scene to a path.
fn render_image(
    registry: &Registry,
    args: &Args,
    (scene, path): (&Path, PathBuf),
    stop: &Stop,
) -> Result<(), Failure> {
    let full_range = args.full_range(&path);
    let format = if full_range.is_some() {
        Format::Png(args.compress)
    } else {
        format_of(args.format, &path, args.compress)?
    };
    let cpu = args.cpu.cpu()?;
    let start = Instant::now();
    let accuracy = args.method.accuracy()?;
    let source = Source::read(scene, &args.set)?;
    let memory = args.stop.memory_left();
    let how = ReadOptions { above_all: accuracy, memory, clock: Some(clock), ..ReadOptions::default() };
    let Loaded { mut model, building, warnings, .. } = input::print_warnings(source.load_by(registry, how))?;
    let stats = Stats { reading: start.elapsed() - building, building, ..Stats::default() };
    let camera = &mut model.camera.value;
    args.samples.apply(camera)?;
    camera.exposure += args.exposure;
    let region = args.size.apply(camera)?;
    let made = provenance::texts(&source, &args.set, (&model.camera.value, args.exposure), &region);
    let image = ImageRender {
        registry,
        args,
        stop,
        scene,
        path: &path,
        format,
        full_range,
        differences: Differences::of(registry, &source, &model),
        source,
        memory,
        model,
        region,
        made,
        cpu,
    };
    args.refuse_sources(&path, scene, &image.model)?;
    if let Some(number) = args.part.part {
        return image.part(number, stats);
    }
    if args.skips(&path, &image.model)? && provenance::is_up_to_date(&path, &image.made, warnings.files()) {
        messages::note(&format!("{} exists already", text::shown(path)));
        return Ok(());
    }
    image.whole(stats)
}

/// An image that is to be rendered.
struct ImageRender<'a> {
    registry: &'a Registry,
    args: &'a Args,
    stop: &'a Stop,
    scene: &'a Path,
    path: &'a Path,
    /// The format of an image of bytes, and of the images beside it.
    format: Format,
    full_range: Option<FullRange>,
    source: Source,
    /// The memory that was left after the scene was read, in bytes, if there is a limit.
    memory: Option<u64>,
    model: Model,
    region: Region,
    /// The texts about how it was made.
    made: Vec<(&'static str, String)>,
    differences: Differences,
    cpu: Cpu,
}

impl ImageRender<'_> {
    /// Renders the image and the images beside it into their files.
    fn whole(self, mut stats: Stats) -> Result<(), Failure> {
        let Self { registry, args, stop, path, format, source, memory, model, region, .. } = self;
        args.size.refuse_other_size(path, &region)?;
        let output = Output::open(path)?;
        let beside = aov::open(&model, &args.aov, &args.main(path), &output)?;
        // The text of a large scene takes as much memory as its model.
        let source = (!beside.is_empty()).then_some(source);
        if self.full_range.is_some() && args.stop.resume {
            return Err(refuse_full_range(path, "resumed"));
        }
        let begun = ResumedImage::open(args.continues(path), path, &output, || {
            resume::label(&model, &region, format, &self.made)
        })?;
        debug::print(&model, &args.debug)?;
        let start = Instant::now();
        let plan = args.keep.plan(&model);
        stats.building += start.elapsed();
        let renderer = args.threads.renderer_for(region.rows.len())?.on(self.cpu);
        let [width, height] = region.size();
        let at_once = match self.full_range {
            Some(_) => {
                args.stop.refuse_too_large(PIXEL * width * height)?;
                width * height.next_multiple_of(TILE)
            }
            None => args.stop.band(width)?,
        };
        let whole = Instant::now();
        let tiles = TileRender {
            plan: &plan,
            region: &region,
            tiles: 0..Grid { size: region.size() }.count(),
            renderer: &renderer,
            at_once,
            stop,
            stats: &stats,
            counts: args.stats.wants_any(),
        };
        let job = Job { tiles, path, made: &self.made };
        match self.full_range {
            Some(format) => job.full_range(output, format)?,
            None => render_bytes(&job, (output, format, begun), &self.differences, start)?,
        }
        trial::warn_of_mistakes((&plan, &region), &renderer, &self.made, self.scene, start.elapsed());
        stats.writing = whole.elapsed().saturating_sub(stats.rendering.get());
        args.stats.print(&stats, &model);
        let Some(source) = source else { return Ok(()) };
        stop.exit_on_interrupt()?;
        aov::write(&plan, || read_exact(&source, registry, &model, memory), args.threads, format, beside)
    }

    /// Renders a part of the image into a file of its own.
    fn part(&self, number: [usize; 2], mut stats: Stats) -> Result<(), Failure> {
        let Self { args, stop, path, format, model, region, .. } = self;
        if *path == Path::new("-") {
            return Err(Failure::usage("a part cannot be written beside standard output")
                .help("name the image with `-o FILE`"));
        }
        debug::print(model, &args.debug)?;
        let beside = aov::requested(&args.aov, model)?;
        let start = Instant::now();
        let plan = args.keep.plan(model);
        stats.building += start.elapsed();
        let renderer = args.threads.renderer()?.on(self.cpu);
        let tiles = TileRender {
            plan: &plan,
            region,
            tiles: part::tiles(number, region, &plan, &renderer)?,
            renderer: &renderer,
            at_once: args.stop.band(region.columns.len())?,
            stop,
            stats: &stats,
            counts: args.stats.wants_any(),
        };
        let part = part::PartRender {
            part: number,
            made: &self.made,
            tiles,
            paths: [path, &args.main(path)],
            full_range: self.full_range,
            beside: &beside,
            format: *format,
        };
        let whole = Instant::now();
        let exact = || read_exact(&self.source, self.registry, model, args.stop.memory_left());
        let has_errors = beside.contains(&Aov::Error);
        part.run(args.stop.resume, |work| aov::with_truth(&plan, has_errors, exact, |truth| work(truth)))?;
        trial::warn_of_mistakes((&plan, region), &renderer, &self.made, self.scene, start.elapsed());
        stats.writing = whole.elapsed().saturating_sub(stats.rendering.get());
        args.stats.print(&stats, model);
        Ok(())
    }
}

/// Reads a scene again, with the rules of light of its model, and hits that are exact.
fn read_exact(
    source: &Source,
    registry: &Registry,
    model: &Model,
    memory: Option<u64>,
) -> Result<Model, Failure> {
    let rules = Some(model.camera.value.rules);
    let exact = ReadOptions { above_all: Some(Accuracy::Exact), rules, memory, ..ReadOptions::default() };
    source.load_by(registry, exact).map(|loaded| loaded.model).map_err(Failure::Scene)
}

/// Renders an image of bytes, and tells what was written since a time, unless that is standard output.
fn render_bytes(
    job: &Job,
    (output, format, begun): (Output, Format, Option<ResumedImage>),
    differences: &Differences,
    start: Instant,
) -> Result<(), Failure> {
    let levels = job.bytes(output, format, begun)?;
    let &Job { tiles: TileRender { plan, region, stats, .. }, path, .. } = job;
    if path == Path::new("-") {
        return Ok(());
    }
    let [width, height] = region.size();
    let (which, seconds) = (progress::count(), start.elapsed().as_secs_f64());
    messages::note(&format!(
        "{which}wrote {} ({width} x {height} pixels, {seconds:.2} s)",
        text::shown(path)
    ));
    differences.print();
    flaws::tell_of_far(stats.tally.flaws().far);
    if !reader::is_black(plan.model) {
        messages::remark(diagnosis::remark(plan, [&region.columns, &region.rows], &levels));
    }
    Ok(())
}

/// The time since some moment.
fn clock() -> Duration {
    static START: LazyLock<Instant> = LazyLock::new(Instant::now);
    START.elapsed()
}

fn exposure(text: &str) -> Result<f64, String> {
    let stops = text.parse().ok().filter(|stops: &f64| (-32.0..=32.0).contains(stops));
    stops.ok_or_else(|| "give stops as `1.5` or `-2`, from -32 to 32".to_owned())
}
