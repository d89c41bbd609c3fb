//! `tabray diff`: compares two images.

use super::explain::Place;
use super::report::{Change, Item, Page};
use std::path::PathBuf;
use std::process::ExitCode;
use tabray_cli::files::input;
use tabray_cli::files::picture::Picture;
use tabray_cli::options::number::whole;
use tabray_cli::options::set;
use tabray_cli::process::failure::{Failure, print, report};
use tabray_cli::{Command, Group, Run};
use tabray_core::output::compare::{Comparison, FullRangeComparison, Pixel};
use tabray_core::text;
use tabray_lang::registry::Registry;

/// Compare two images
///
/// Prints how many pixels differ, the largest difference of any channel, in levels from 0 to 255, and the root mean
/// square (RMS) of the differences of all channels. Names the first pixel that differs, row by row from the top, and
/// the pixel that differs most. As everywhere, a pixel's column counts from 0 at the left, and its row from 0 at the
/// bottom.
#[derive(clap::Args)]
#[command(after_help = EXIT_STATUS, after_long_help = EXAMPLES)]
pub struct Args {
    /// The old image: PNG or PPM, or EXR or PFM
    old: PathBuf,
    /// The new image, of the same size
    new: PathBuf,
    /// Ignore differences of up to this many levels in each channel
    #[arg(long, value_name = "LEVELS", default_value = "0", value_parser = whole::<u8>(0..=255))]
    tolerance: u8,
    /// Write a page that shows both images and their difference, as one self-contained .html file
    #[arg(short, long, value_name = "FILE")]
    output: Option<PathBuf>,
    /// The scene of the images, from which the page explains the pixel that differs most
    #[arg(long, requires = "output")]
    scene: Option<PathBuf>,
    #[command(flatten)]
    set: set::Args,
    /// The `tabray` that made the old image, whose explanation the page shows too
    #[arg(long, value_name = "PROGRAM", requires = "scene")]
    before: Option<PathBuf>,
}

const EXIT_STATUS: &str = "\
Exit status:
    0  the images are the same
    1  the images differ
    2  trouble: an image could not be read, the sizes differ, or the page could not be written";

const EXAMPLES: &str = "\
Exit status:
    0  the images are the same
    1  the images differ
    2  trouble: an image could not be read, the sizes differ, or the page could not be written

Examples:
  tabray diff old.png new.png
  tabray diff old.png new.png --tolerance 1 -o diff.html --scene ball.ray";

inventory::submit! {
    Command::new("diff", Group::Inside, &Run(run)).placed(2, 17)
}

/// Compares two images. The exit status distinguishes errors of any kind from a difference, as with `diff` and `cmp`.
fn run(registry: &Registry, args: Args) -> ExitCode {
    match compare(registry, &args) {
        Ok(same) => ExitCode::from(u8::from(!same)),
        Err(failure) => {
            report(&failure);
            ExitCode::from(2)
        }
    }
}

/// Tells whether the images are equal.
fn compare(registry: &Registry, args: &Args) -> Result<bool, Failure> {
    let page = args.output.as_deref().map(Page::open).transpose()?;
    let model =
        args.scene.as_deref().map(|scene| input::load(registry, scene, &args.set, None)).transpose()?;
    let (old, new) = (Picture::read(&args.old)?, Picture::read(&args.new)?);
    let names = [&args.old, &args.new].map(text::shown);
    let sizes = [old.size(), new.size()];
    let other_size = || {
        let size =
            |name: &str, (width, height): (u32, u32)| format!("`{name}` has {width} x {height} pixels");
        Failure::usage(format!("{}, and {}", size(&names[0], sizes[0]), size(&names[1], sizes[1])))
            .help("only images of the same size can be compared")
    };
    let (old, new) = match (old, new) {
        (Picture::Bytes(old), Picture::Bytes(new)) => (old, new),
        (old, new) if page.is_none() => {
            let comparison = FullRangeComparison::new(&old.full_range(), &new.full_range(), args.tolerance);
            let comparison = comparison.ok_or_else(other_size)?;
            print(&format!("{comparison}\n"))?;
            return Ok(comparison.differing == 0);
        }
        _ => {
            return Err(Failure::usage("a page shows images of 8 bits per channel only")
                .help("compare PNGs or PPMs, or leave out `--output`"));
        }
    };
    let comparison = Comparison::new(&old, &new, args.tolerance).ok_or_else(other_size)?;
    let (first, worst) = (comparison.first, comparison.worst);
    let line = |what: &str, pixel: Option<Pixel>| pixel.map(|pixel| format!("{what} at {pixel}\n"));
    let most = worst.filter(|_| worst != first);
    let places = [line("first", first), line("most", most)].map(Option::unwrap_or_default).concat();
    print(&format!("{comparison}\n{places}"))?;
    let same = comparison.differing == 0;
    if let Some(page) = page {
        let place = args.scene.as_deref().zip(model).zip(worst);
        let (size, set) = (comparison.size, &args.set);
        let place = place.map(|((scene, model), pixel)| Place { scene, set, model, size, pixel });
        let explanations = place.map(|place| place.explained(args.before.as_deref())).unwrap_or_default();
        let name = names.join(" and ");
        let change = Change::Picture { old: Some(old), new, names, comparison: Some(comparison) };
        page.write("tabray diff", &[Item { name, change, explanations, decision: None }])?;
    }
    Ok(same)
}
