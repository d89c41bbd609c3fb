//! `tabray film`: puts frames together to a contact sheet and to an animation.

use clap::ArgGroup;
use image::imageops;
use std::ffi::OsStr;
use std::fs;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use tabray_cli::files::output::{self, Output};
use tabray_cli::files::paths::are_same;
use tabray_cli::files::picture;
use tabray_cli::options::frames::{self, Range};
use tabray_cli::options::number::whole;
use tabray_cli::process::failure::Failure;
use tabray_cli::process::progress::Progress;
use tabray_cli::process::{memory, messages};
use tabray_cli::{Command, Group, Run};
use tabray_core::output::deflate::Compression;
use tabray_core::output::picture::Format;
use tabray_core::text;
use tabray_lang::registry::Registry;

/// The maximum number of frames on a contact sheet.
const ON_SHEET: usize = 100;

/// The width of a frame on a contact sheet in pixels.
const WIDTH: u32 = 192;

/// Join frames into a contact sheet or an animation
///
/// The frames are those that `tabray render --frames A..B -o IMAGE` wrote.
#[derive(clap::Args)]
#[command(after_long_help = EXAMPLES)]
#[command(group = ArgGroup::new("outputs").args(["sheet", "animation"]).required(true).multiple(true))]
pub struct Args {
    /// The name of the frames, as given to `render --frames` with -o: film.png for film-0001.png, film-0002.png ...
    images: PathBuf,
    /// The frames that there must be, as given to `render`; by default, all from the first that there is to the last
    #[arg(long, value_name = "A..B", value_parser = frames::range)]
    frames: Option<Range>,
    /// Write one image with small images of the frames in rows; of more than 100 frames, an even choice
    #[arg(long, value_name = "FILE")]
    sheet: Option<PathBuf>,
    /// Write an animated PNG, which browsers and image viewers play
    #[arg(long, value_name = "FILE")]
    animation: Option<PathBuf>,
    /// The number of frames per second of the animation
    #[arg(long, value_name = "N", default_value = "25", value_parser = whole::<u16>(1..=240))]
    rate: u16,
}

const EXAMPLES: &str = "\
Examples:
  tabray film film.png --sheet sheet.png
  tabray film film.png --frames 1..240 --animation film.apng --rate 30";

inventory::submit! {
    Command::new("film", Group::Rendering, &Run(run)).placed(3, 2)
}

fn run(_: &Registry, args: Args) -> Result<(), Failure> {
    if let Some(path) = &args.animation {
        refuse_name(path)?;
    }
    let frames = found(&args.images, args.frames.as_ref())?;
    let outputs: Vec<_> = [&args.sheet, &args.animation].into_iter().flatten().collect();
    for path in &outputs {
        if let Some(frame) = frames.iter().find(|frame| are_same(frame, path)) {
            return Err(Failure::usage(format!(
                "`{}` is a frame, which would be replaced",
                text::shown(frame)
            ))
            .help("name another file"));
        }
    }
    if let [sheet, animation] = outputs[..]
        && sheet == animation
    {
        return Err(Failure::usage(format!(
            "the sheet and the animation cannot both be `{}`",
            text::shown(sheet)
        ))
        .help("name two files"));
    }
    if let Some(path) = &args.sheet {
        sheet(path, &frames)?;
    }
    if let Some(path) = &args.animation {
        animation(path, &frames, args.rate)?;
    }
    Ok(())
}

/// Refuses a name that is not that of an animated PNG.
fn refuse_name(animation: &Path) -> Result<(), Failure> {
    let is_png =
        |extension: &OsStr| ["png", "apng"].iter().any(|known| extension.eq_ignore_ascii_case(known));
    if animation == Path::new("-") || animation.extension().is_some_and(is_png) {
        return Ok(());
    }
    Err(Failure::usage(format!(
        "an animation is an animated PNG, and `{}` is not named like one",
        text::shown(animation)
    ))
    .help("end the name in .apng or .png"))
}

/// Lists the frames of a range, or else all, in the order of their numbers.
fn found(name: &Path, range: Option<&Range>) -> Result<Vec<PathBuf>, Failure> {
    let folder = name.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    let stem = name.file_stem().unwrap_or_default().to_string_lossy().into_owned() + "-";
    let number = |path: &Path| {
        let digits = path.file_stem()?.to_str()?.strip_prefix(&stem)?;
        digits.bytes().all(|byte| byte.is_ascii_digit()).then(|| digits.parse::<u32>().ok()).flatten()
    };
    let cannot = |error: io::Error| Failure::cannot_read(folder, &error);
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).map_err(cannot)? {
        let path = name.with_file_name(entry.map_err(cannot)?.file_name());
        let is_wanted = |number: &u32| range.is_none_or(|Range(range)| range.contains(number));
        if let Some(number) = number(&path).filter(is_wanted).filter(|_| path.extension() == name.extension())
        {
            found.push((number, path));
        }
    }
    found.sort();
    let numbers = match (found.first(), found.last()) {
        (Some((first, _)), Some((last, _))) => range.map_or(*first..=*last, |Range(range)| range.clone()),
        _ => {
            return Err(Failure::usage(format!("there is no frame of `{}`", text::shown(name)))
                .help("`tabray render SCENE --frames 1..240 -o IMAGE` renders frames"));
        }
    };
    let mut numbers_found = found.iter().map(|(number, _)| *number);
    if let Some(missing) = numbers.into_iter().find(|number| numbers_found.next() != Some(*number)) {
        return Err(Failure::usage(format!("frame {missing} of `{}` is missing", text::shown(name)))
            .help("its render may have been stopped, or its name may have another number of digits"));
    }
    Ok(found.into_iter().map(|(_, path)| path).collect())
}

fn sheet(path: &Path, frames: &[PathBuf]) -> Result<(), Failure> {
    let format = output::format_by_name(path, "end it in .png or .ppm")?;
    let format = if let Format::Png(_) = format { Format::Png(Compression::default()) } else { format };
    let count = frames.len().min(ON_SHEET);
    let (across, mut all) = ((count as f64).sqrt().ceil() as usize, image::RgbImage::new(0, 0));
    let out = Output::open(path)?;
    let mut tall = 0;
    for index in 0..count {
        // The first and the last are always there.
        let at = index * (frames.len() - 1) / (count - 1).max(1);
        let frame = picture::read(&frames[at])?;
        if index == 0 {
            tall = (WIDTH * frame.height() / frame.width()).clamp(1, 8 * WIDTH);
            let rows = count.div_ceil(across) as u32;
            all = image::RgbImage::new(WIDTH * across as u32, tall * rows);
        }
        let small = imageops::thumbnail(&frame, WIDTH, tall);
        let place = [(index % across) as u32 * WIDTH, (index / across) as u32 * tall];
        imageops::replace(&mut all, &small, place[0].into(), place[1].into());
    }
    let size = [all.width() as usize, all.height() as usize];
    output::write_image(path, out, |out| format.write(out, size, [Ok(all.into_raw())]))
}

fn animation(path: &Path, frames: &[PathBuf], rate: u16) -> Result<(), Failure> {
    let cannot = |error: png::EncodingError| Failure::cannot_write(path, &error.into());
    let first = picture::read(&frames[0])?;
    let (width, height) = first.dimensions();
    memory::refuse_too_large(6 * width as usize * height as usize, "a frame")?;
    let mut out = BufWriter::with_capacity(1 << 16, Output::open(path)?);
    let mut encoder = png::Encoder::new(&mut out as &mut dyn Write, width, height);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_depth(png::BitDepth::Eight);
    encoder.set_source_srgb(png::SrgbRenderingIntent::RelativeColorimetric);
    let count = u32::try_from(frames.len()).map_err(|error| Failure::Failed(error.to_string()))?;
    encoder.set_animated(count, 0).map_err(cannot)?;
    encoder.set_frame_delay(1, rate).map_err(cannot)?;
    let mut writer = encoder.write_header().map_err(cannot)?;
    let progress = Progress::new(frames.len());
    for file in frames {
        let frame = picture::read(file)?;
        if frame.dimensions() != (width, height) {
            progress.end();
            return Err(Failure::usage(format!(
                "`{}` does not have {width} x {height} pixels, as the first frame does",
                text::shown(file)
            )));
        }
        writer.write_image_data(&frame).map_err(cannot)?;
        progress.step();
    }
    progress.end();
    writer.finish().map_err(cannot)?;
    output::finished(path, Ok(()), out)?;
    messages::note(&format!("wrote {} ({})", text::shown(path), text::count(frames.len(), "frame")));
    Ok(())
}
