//! `tabray render`: a scene's picture.

use super::failure::Failure;
use super::input::Source;
use super::job::Job;
use super::output::{Output, named};
use super::resume::Begun;
use super::stats::{self, Stats};
use super::{aov, cpu, debug, input, interrupt, messages, method, size, stop};
use crate::output::picture::{Compression, Format};
use crate::render::plan::Plan;
use crate::render::renderer::Renderer;
use crate::scene::reader::Loaded;
use crate::scene::registry::Registry;
use crate::world::accuracy::Accuracy;
use crate::world::sample::Sampler;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// Make a scene's picture
#[derive(clap::Args)]
pub struct Args {
    /// The scene; `-` reads it from standard input
    scene: PathBuf,
    /// Where to write the picture: a .png or .ppm file, or `-` for standard output (a PPM unless --format says
    /// otherwise); by default the scene's name with .png in the working directory
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// The picture's format, whatever the file's extension
    #[arg(long)]
    format: Option<FormatName>,
    /// How hard a PNG is compressed
    #[arg(long, value_name = "HOW", default_value = "fast")]
    compress: CompressionName,
    /// How many rays look through each pixel, to smooth edges; by default what the scene's camera says
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=i64::from(Sampler::MOST)))]
    samples: Option<u32>,
    /// Where the rays of a pixel lie
    #[arg(long, value_name = "NAME", default_value = "sobol")]
    sampler: SamplerName,
    /// How many threads to use; by default one on each core
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    #[command(flatten)]
    size: size::Args,
    #[command(flatten)]
    method: method::Args,
    #[command(flatten)]
    aov: aov::Args,
    #[command(flatten)]
    debug: debug::Args,
    #[command(flatten)]
    cpu: cpu::Args,
    #[command(flatten)]
    stats: stats::Args,
    #[command(flatten)]
    stop: stop::Args,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum FormatName {
    Ppm,
    Png,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum CompressionName {
    /// As quickly as possible
    Fast,
    /// Smaller
    Default,
    /// As small as possible
    Best,
}

#[derive(Clone, Copy, clap::ValueEnum)]
enum SamplerName {
    /// Spread evenly
    Sobol,
    /// Anywhere, as in the course notes
    Random,
}

pub fn run(registry: &Registry, args: Args) -> Result<(), Failure> {
    let path = target(&args)?;
    let format = format(&args, &path)?;
    let stop = args.stop.watch()?;
    let cpu = args.cpu.cpu()?;
    let start = Instant::now();
    let accuracy = args.method.accuracy()?;
    let source = Source::read(&args.scene)?;
    let Loaded { mut model, building, .. } = input::told(source.load(registry, accuracy))?;
    let mut stats = Stats { reading: start.elapsed() - building, building, ..Stats::default() };
    let camera = &mut model.camera.value;
    camera.samples = args.samples.unwrap_or(camera.samples);
    camera.sampler = match args.sampler {
        SamplerName::Sobol => Sampler::Sobol,
        SamplerName::Random => Sampler::Random,
    };
    let part = args.size.apply(camera)?;
    interrupt::catch()?;
    let output = Output::open(&path)?;
    let beside = aov::open(&model, &args.aov, &path, &output)?;
    let begun = Begun::open(args.stop.resume, &model, &part, &path, &output)?;
    debug::print(&model, &args.debug)?;
    let threads = args.threads.unwrap_or(0).into();
    let start = Instant::now();
    let plan = Plan::new(&model);
    stats.building += start.elapsed();
    let renderer = Renderer::new(threads)?.on(cpu);
    let whole = Instant::now();
    let job = Job {
        plan: &plan,
        part: &part,
        renderer: &renderer,
        format,
        path: &path,
        band: args.stop.band(part.columns.len())?,
        stop: &stop,
        stats: args.stats.wants_any().then_some(&stats),
    };
    job.run(output, begun)?;
    stats.writing = whole.elapsed().saturating_sub(stats.rendering.get());
    if path != Path::new("-") {
        let [width, height] = part.size();
        let seconds = start.elapsed().as_secs_f64();
        messages::note(&format!("wrote {} ({width} x {height} pixels, {seconds:.2} s)", path.display()));
    }
    args.stats.print(&stats, &model);
    let exact = || match source.load(registry, Some(Accuracy::Exact)) {
        Ok(loaded) => Ok(loaded.model),
        Err(report) => Err(Failure::Scene(report)),
    };
    aov::write(&plan, exact, threads, format, beside)
}

fn target(args: &Args) -> Result<PathBuf, Failure> {
    match (&args.output, args.scene.file_name()) {
        (Some(path), _) => Ok(path.clone()),
        (None, Some(name)) if !input::is_standard(&args.scene) => {
            let extension = if matches!(args.format, Some(FormatName::Ppm)) { "ppm" } else { "png" };
            Ok(Path::new(name).with_extension(extension))
        }
        _ => Err(Failure::Usage(
            "a scene from standard input has no name for its picture".to_owned(),
            Some("name one with `-o FILE`; `-o -` writes to standard output".to_owned()),
        )),
    }
}

fn format(args: &Args, path: &Path) -> Result<Format, Failure> {
    let compression = match args.compress {
        CompressionName::Fast => Compression::Fast,
        CompressionName::Default => Compression::Balanced,
        CompressionName::Best => Compression::High,
    };
    match args.format {
        Some(FormatName::Ppm) => Ok(Format::Ppm),
        Some(FormatName::Png) => Ok(Format::Png(compression)),
        None if path == Path::new("-") => Ok(Format::Ppm),
        None => match named(path, "end it in .png or .ppm, or give `--format png` or `--format ppm`")? {
            Format::Png(_) => Ok(Format::Png(compression)),
            Format::Ppm => Ok(Format::Ppm),
        },
    }
}
