//! Renders one image of a scene, or a part of it, with the images beside it.

use super::Args;
use crate::course::Differences;
use crate::files::input::{self, Source};
use crate::files::output::Output;
use crate::files::provenance::{self, Provenance};
use crate::options::size::Region;
use crate::options::stop::Stop;
use crate::process::failure::Failure;
use crate::process::{messages, progress};
use crate::rendering::bands::{PIXEL, TileRender};
use crate::rendering::job::{Job, refuse_full_range};
use crate::rendering::resume::ResumedImage;
use crate::rendering::stats::Stats;
use crate::rendering::{aov, debug, flaws, part, resume, trial};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;
use std::time::{Duration, Instant};
use tabray_core::output::aov::Aov;
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

/// Renders one image of a scene to a path.
pub(super) fn render(
    registry: &Registry,
    args: &Args,
    (scene, path): (&Path, PathBuf),
    stop: &Stop,
) -> Result<(), Failure> {
    let (format, full_range) = args.format_of(&path)?;
    let dpi = args.print.dpi(&path, (format, full_range))?;
    let cpu = args.cpu.cpu()?;
    let start = Instant::now();
    let accuracy = args.method.accuracy()?;
    let source = Source::read(scene, &args.set)?;
    let memory = args.stop.memory_left();
    let labels_apart = args.overlay.is_wanted();
    let how = ReadOptions {
        above_all: accuracy,
        labels_apart,
        memory,
        clock: Some(clock),
        ..ReadOptions::default()
    };
    let Loaded { mut model, building, warnings, .. } = input::print_warnings(source.load_by(registry, how))?;
    let stats = Stats { reading: start.elapsed() - building, building, ..Stats::default() };
    let camera = &mut model.camera.value;
    args.samples.apply(camera)?;
    camera.exposure += args.exposure;
    args.print.apply_alpha(&path, (format, full_range), &mut model.camera)?;
    let camera = &mut model.camera.value;
    let region = args.size.apply(camera)?;
    args.samples.raise(&mut model, args.threads, cpu)?;
    let camera = (&model.camera.value, args.exposure);
    let made = Provenance::of(&source, &args.set, camera, &region, (dpi, labels_apart));
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
    /// What its file says of how it was made.
    made: Provenance,
    differences: Differences,
    cpu: Cpu,
}

impl ImageRender<'_> {
    /// Renders the image and the images beside it into their files.
    fn whole(self, mut stats: Stats) -> Result<(), Failure> {
        let Self { registry, args, stop, path, format, source, memory, model, region, .. } = self;
        args.size.refuse_larger(path, &region)?;
        let output = Output::open(path)?;
        let beside = aov::open(&model, &args.aov, &args.main(path), &output)?;
        let drawing =
            args.overlay.open((path, format, self.full_range), self.made.dpi, (self.scene, &model))?;
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
        let mut plan = args.keep.plan(&model);
        plan.camera.alpha = model.camera.value.alpha;
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
        trial::warn_of_mistakes((&plan, &region), &renderer, &self.made.texts, self.scene, start.elapsed());
        stats.writing = whole.elapsed().saturating_sub(stats.rendering.get());
        args.stats.print(&stats, &model);
        if let Some(drawing) = drawing {
            drawing.write(&plan, &region, &renderer, stop)?;
        }
        let Some(source) = source else { return Ok(()) };
        stop.exit_on_interrupt()?;
        aov::write(
            &plan,
            || read_exact(&source, registry, &model, (memory, args.overlay.is_wanted())),
            args.threads,
            (format, self.made.dpi),
            beside,
        )
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
        let mut plan = args.keep.plan(model);
        plan.camera.alpha = model.camera.value.alpha;
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
        let exact = || read_exact(&self.source, self.registry, model, (args.stop.memory_left(), false));
        let has_errors = beside.contains(&Aov::Error);
        part.run(args.stop.resume, |work| aov::with_truth(&plan, has_errors, exact, |truth| work(truth)))?;
        trial::warn_of_mistakes((&plan, region), &renderer, &self.made.texts, self.scene, start.elapsed());
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
    (memory, labels_apart): (Option<u64>, bool),
) -> Result<Model, Failure> {
    let (above_all, rules) = (Some(Accuracy::Exact), Some(model.camera.value.rules));
    let exact = ReadOptions { above_all, rules, labels_apart, memory, ..ReadOptions::default() };
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
