//! `--dpi`: how densely the image is to be printed.

use crate::options::number::whole;
use crate::process::failure::Failure;
use std::path::Path;
use tabray_core::output::full_range::FullRange;
use tabray_core::output::picture::Format;
use tabray_core::text::shown;

/// How densely the image is to be printed.
#[derive(clap::Args)]
#[group(id = "how dense")]
#[command(next_help_heading = "Image")]
pub struct Args {
    /// Record with how many pixels per inch the image is to be printed, in a PNG or an EXR, so that LaTeX and editors know
    /// its width: 1200 pixels at `--dpi 300` are 4 inches. The pixels stay the same
    #[arg(long, value_name = "DPI", value_parser = whole::<u32>(1..=100_000))]
    dpi: Option<u32>,
}

impl Args {
    /// Returns the density of an image, which its format must be able to record. The format of bytes only matters if the
    /// image is not one of full range.
    pub fn dpi(
        &self,
        path: &Path,
        bytes: Format,
        full_range: Option<FullRange>,
    ) -> Result<Option<u32>, Failure> {
        let lacking = match full_range {
            Some(FullRange::Exr) => return Ok(self.dpi),
            Some(FullRange::Pfm) => "a PFM",
            None if bytes == Format::Ppm => "a PPM",
            None => return Ok(self.dpi),
        };
        match self.dpi {
            None => Ok(None),
            Some(_) => Err(Failure::usage(format!(
                "`{}` cannot record `--dpi`: {lacking} has no place for it",
                shown(path)
            ))
            .help("name a .png or .exr file, or leave out the option")),
        }
    }
}
