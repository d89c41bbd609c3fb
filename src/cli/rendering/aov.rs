//! `tabray render --aov`: auxiliary images beside the main one, and exact numbers.

use crate::files::output::{self, Output};
use crate::options::named::by_name;
use crate::options::threads;
use crate::process::failure::Failure;
use crate::process::messages;
use crate::process::progress::Progress;
use std::ffi::OsStr;
use std::io::Write;
use std::iter;
use std::ops::ControlFlow;
use std::path::{Path, PathBuf};
use tabray_core::output::aov::{Aov, Layer};
use tabray_core::output::numbers::NumberFormat;
use tabray_core::output::picture::{About, Format};
use tabray_core::render::plan::Plan;
use tabray_core::scene::model::Model;
use tabray_core::text::{self, Named};
use tabray_core::world::sample::{SCRAMBLE, Sampler};

/// The maximum number of pixels of an image with auxiliary images: unlike the main image, they are held in memory as a
/// whole.
const LARGEST: usize = 1 << 26;

#[derive(clap::Args)]
#[group(id = "pictures beside")]
#[command(next_help_heading = "Looking inside")]
pub struct Args {
    /// Also write these auxiliary images beside the main one: `-o a.png --aov depth` writes a-depth.png, and
    /// a-depth.exr with the numbers. Depth, object and face also go into an array, such as a-depth.npy
    #[arg(long, value_name = "IMAGES", value_delimiter = ',', value_parser = by_name::<Aov>())]
    aov: Vec<Aov>,
}

/// The files of one auxiliary image.
pub struct Files {
    aov: Aov,
    picture: (PathBuf, Output),
    numbers: Vec<(NumberFormat, PathBuf, Output)>,
}

/// Opens all files that are asked for; their names are derived from the main image's.
pub fn open(model: &Model, args: &Args, main: &Path, output: &Output) -> Result<Vec<Files>, Failure> {
    if args.aov.is_empty() {
        return Ok(Vec::new());
    }
    if !matches!(output, Output::File(..)) {
        return Err(Failure::usage(format!(
            "cannot write the images of `--aov` beside `{}`",
            text::shown(main)
        ))
        .help("name a file for the main image with `-o FILE`"));
    }
    let aovs = requested(args, model)?;
    let opened = |path: PathBuf| Output::open(&path).map(|output| (path, output));
    aovs.into_iter()
        .map(|aov| {
            let picture = picture(main, aov);
            let numbers = numbers(aov, &picture)
                .map(|(format, path)| opened(path).map(|(path, output)| (format, path, output)))
                .collect::<Result<_, _>>()?;
            let picture = opened(picture)?;
            Ok(Files { aov, picture, numbers })
        })
        .collect()
}

/// Returns the images that are asked for, each once.
pub fn requested(args: &Args, model: &Model) -> Result<Vec<Aov>, Failure> {
    let [width, height] = model.camera.value.pixels;
    if !args.aov.is_empty() && width * height > LARGEST {
        return Err(Failure::usage(format!(
            "an image of {width} x {height} pixels is too large for `--aov`"
        ))
        .help(format!("the maximum is {LARGEST} pixels, such as 8192 x 8192")));
    }
    let mut aovs: Vec<Aov> = Vec::new();
    for aov in &args.aov {
        if !aovs.contains(aov) {
            aovs.push(*aov);
        }
    }
    Ok(aovs)
}

/// Returns the paths of the images that are asked for, beside a main image of this name.
pub fn pictures(args: &Args, main: &Path) -> impl Iterator<Item = (Aov, PathBuf)> {
    args.aov.iter().map(move |aov| (*aov, picture(main, *aov)))
}

/// Returns the path of an image beside the main one.
pub fn picture(main: &Path, aov: Aov) -> PathBuf {
    let mut stem = main.file_stem().unwrap_or_default().to_owned();
    stem.push(format!("-{}", aov.name()));
    let picture = main.with_file_name(stem);
    let with = |extension: &OsStr| output::append_to_path(&output::append_to_path(&picture, "."), extension);
    main.extension().map_or_else(|| picture.clone(), with)
}

/// Returns the paths of the numbers of an image beside the main one.
pub fn numbers(aov: Aov, picture: &Path) -> impl Iterator<Item = (NumberFormat, PathBuf)> {
    aov.number_formats().iter().map(|format| (*format, picture.with_extension(format.name())))
}

/// Writes the numbers of an image.
pub fn write_numbers(
    layer: &Layer,
    (format, path, output): (NumberFormat, PathBuf, Output),
    size: [usize; 2],
) -> Result<(), Failure> {
    let Some(numbers) = &layer.numbers else { return Ok(()) };
    let bytes = numbers.file(format, size).map_err(|error| Failure::cannot_write(&path, &error))?;
    output::write_image(&path, output, |out| out.write_all(&bytes))
}

/// The samples per pixel of the reference for errors: this many times the model's own, and at least [`TRUE_LEAST`].
const TRUE_TIMES: u32 = 4;
const TRUE_LEAST: u32 = 64;

/// The maximum number of samples per pixel of the reference where pixels take different numbers.
const TRUE_MOST: u32 = 1024;

/// Calls `work` with the plan of the reference for errors if that is `requested`, otherwise with the plan itself. `exact`
/// makes the model of the reference.
pub fn with_truth<T>(
    plan: &Plan,
    requested: bool,
    exact: impl FnOnce() -> Result<Model, Failure>,
    work: impl FnOnce(&Plan) -> Result<T, Failure>,
) -> Result<T, Failure> {
    if !requested || plan.camera.certain {
        return work(plan);
    }
    let exact_model = exact()?;
    let mut exact = Plan::new(&exact_model);
    let samples = match plan.camera.adaptive {
        None => (TRUE_TIMES * plan.camera.samples).clamp(TRUE_LEAST, Sampler::MAX_SAMPLES),
        Some(adaptive) => {
            // Samples of their own, since a pixel may have taken as many.
            exact.camera.scramble = SCRAMBLE;
            TRUE_TIMES.saturating_mul(adaptive.most).clamp(TRUE_LEAST, TRUE_MOST)
        }
    };
    (exact.camera.samples, exact.camera.sampler) = (samples, Sampler::Sobol);
    work(&exact)
}

/// Renders the auxiliary images and writes their files, to be printed with as many pixels per inch. `exact` makes the model
/// of the reference for errors.
pub fn write(
    plan: &Plan,
    exact: impl FnOnce() -> Result<Model, Failure>,
    threads: threads::Args,
    format: (Format, Option<u32>),
    files: Vec<Files>,
) -> Result<(), Failure> {
    let requested = files.iter().any(|file| file.aov == Aov::Error);
    with_truth(plan, requested, exact, |truth| all(plan, truth, threads, format, files))
}

fn all(
    plan: &Plan,
    truth: &Plan,
    threads: threads::Args,
    (format, dpi): (Format, Option<u32>),
    files: Vec<Files>,
) -> Result<(), Failure> {
    let about = About { dpi, ..About::default() };
    let renderer = threads.renderer()?;
    let size = plan.camera.pixels;
    for Files { aov, picture, numbers } in files {
        let progress = Progress::new(size[1]);
        let layer = aov.render(&renderer, plan, truth, &|| {
            progress.step();
            ControlFlow::Continue(())
        });
        progress.end();
        let layer = layer.map_err(|_| Failure::Interrupted("the image was not finished"))?;
        print_remarks(&layer);
        for file in numbers {
            write_numbers(&layer, file, size)?;
        }
        let (path, output) = picture;
        output::write_image(&path, output, |out| {
            format.write_on(None, &about, out, size, iter::once(Ok(layer.bytes)))
        })?;
    }
    Ok(())
}

/// Adds the remarks on an image.
pub fn print_remarks(layer: &Layer) {
    if let Some((most, [x, y])) = layer.most {
        messages::note(&format!("the most expensive pixel is {x} {y}, with {most} rays"));
    }
    if let Some((worst, [x, y])) = layer.worst {
        messages::note(&format!("the greatest error is {worst:.2e}, at pixel {x} {y}"));
    }
}
