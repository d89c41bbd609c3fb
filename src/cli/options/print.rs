//! `--dpi` and `--alpha`: an image for a page on which it is printed.

use crate::options::number::whole;
use crate::process::failure::Failure;
use std::path::Path;
use tabray_core::output::full_range::FullRange;
use tabray_core::output::picture::Format;
use tabray_core::scene::model::Item;
use tabray_core::text::shown;
use tabray_core::world::sensor::Sensor;

/// How the image stands on a page.
#[derive(clap::Args)]
#[group(id = "how it stands on a page")]
#[command(next_help_heading = "Image")]
pub struct Args {
    /// Make a PNG or an EXR transparent where it shows no object, like `alpha yes` in the camera. Edges are transparent as
    /// far as their pixels show no object. The background still lights, and is seen in mirrors and through glass
    #[arg(long, conflicts_with = "certain")]
    alpha: bool,
    /// Record with how many pixels per inch the image is to be printed, in a PNG or an EXR, so that LaTeX and editors know
    /// its width: 1200 pixels at `--dpi 300` are 4 inches. The pixels stay the same
    #[arg(long, value_name = "DPI", value_parser = whole::<u32>(1..=100_000))]
    dpi: Option<u32>,
}

impl Args {
    /// Returns the density of an image, which its format must be able to record. The format of bytes only matters if the
    /// image is not one of full range.
    pub fn dpi(&self, path: &Path, formats: (Format, Option<FullRange>)) -> Result<Option<u32>, Failure> {
        match (self.dpi, lacking(formats)) {
            (None, _) | (_, None) => Ok(self.dpi),
            (Some(_), Some(lacking)) => Err(Failure::usage(format!(
                "`{}` cannot record `--dpi`: {lacking} has no place for it",
                shown(path)
            ))
            .help(format!("{}, or leave out the option", other(path)))),
        }
    }

    /// Switches alpha on in a camera, if it is asked for. Its own is refused, too, where an image cannot have it.
    pub fn apply_alpha(
        &self,
        path: &Path,
        formats: (Format, Option<FullRange>),
        camera: &mut Item<Sensor>,
    ) -> Result<(), Failure> {
        camera.value.alpha |= self.alpha;
        if !camera.value.alpha {
            return Ok(());
        }
        let without = match self.alpha {
            true => "leave out `--alpha`".to_owned(),
            false => format!("give `--set {}.alpha=no`", camera.args.name()),
        };
        if camera.value.certain {
            return Err(Failure::usage("`--certain` proves colours, and cannot prove alpha")
                .help(format!("leave out `--certain`, or {without}")));
        }
        match lacking(formats) {
            None => Ok(()),
            Some(lacking) => Err(Failure::usage(format!(
                "`{}` cannot be transparent: {lacking} has no alpha",
                shown(path)
            ))
            .help(format!("{}, or {without}", other(path)))),
        }
    }
}

/// Names a format that records colours and nothing else.
fn lacking((bytes, full_range): (Format, Option<FullRange>)) -> Option<&'static str> {
    match full_range {
        Some(FullRange::Exr) => None,
        Some(FullRange::Pfm) => Some("a PFM"),
        None if bytes == Format::Ppm => Some("a PPM"),
        None => None,
    }
}

/// Says how to write a format that records more. Standard output has no name that tells it.
fn other(path: &Path) -> &'static str {
    if path == Path::new("-") { "give `--format png`" } else { "name a .png or .exr file" }
}
