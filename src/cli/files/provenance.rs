//! What an image file says of how its image was made, and of how it is to be printed. The texts of a PNG are the same for
//! images that must be the same, and by them an existing frame is recognized.

use crate::files::input::Source;
use crate::options::size::Region;
use crate::options::{max_error, set};
use std::env;
use std::fs;
use std::io::{self, BufReader};
use std::path::{Path, PathBuf};
use tabray_core::files;
use tabray_core::output::picture::About;
use tabray_core::scene::choice::Choice;
use tabray_core::text;
use tabray_core::text::Named;
use tabray_core::world::accuracy::Accuracy;
use tabray_core::world::rules::Rules;
use tabray_core::world::sensor::{Adaptive, Sensor};

/// What the file of an image says besides its pixels.
#[derive(Default)]
pub struct Provenance {
    /// Texts, each with its keyword: the version of the program, the hash of the scene's text, and the options with which
    /// the program makes the same file of the scene. Threads, the level of CPU instructions and the compression are none
    /// of them, as the image does not depend on these.
    pub texts: Vec<(&'static str, String)>,
    /// The number of pixels per inch with which the image is to be printed.
    pub dpi: Option<u32>,
    /// Whether the pixels have alpha.
    pub alpha: bool,
}

impl Provenance {
    /// Describes an image. With the camera goes the exposure that is added to its own, in stops; with its density, whether
    /// its labels are in a drawing over it.
    pub fn of(
        source: &Source,
        set: &set::Args,
        camera: (&Sensor, f64),
        region: &Region,
        (dpi, has_overlay): (Option<u32>, bool),
    ) -> Self {
        let printed = dpi.map_or(String::new(), |dpi| format!(" --dpi {dpi}"))
            + if has_overlay { " --overlay" } else { "" };
        let texts = vec![
            ("Software", concat!("tabray ", env!("CARGO_PKG_VERSION")).to_owned()),
            ("tabray scene", source.hash()),
            ("tabray options", options(camera, region) + &printed + &set.words()),
        ];
        Self { texts, dpi, alpha: camera.0.alpha }
    }

    /// Returns what the format has a place for.
    pub fn about(&self) -> About<'_> {
        About { texts: &self.texts, dpi: self.dpi, alpha: self.alpha }
    }
}

/// Tells whether a complete image exists: a PNG that says this, and is newer than the program and than the files
/// that its scene names. The texts do not contain the content of these files.
pub fn is_up_to_date(path: &Path, made: &Provenance, named: &[PathBuf]) -> bool {
    let changed = |path: &Path| fs::metadata(path).and_then(|meta| meta.modified()).ok();
    let written = changed(path);
    // What has no time is not known to be older.
    let is_older = |file: &Path| changed(file).zip(written).is_some_and(|(file, written)| file < written);
    let is_newer =
        env::current_exe().is_ok_and(|program| is_older(&program)) && named.iter().all(|file| is_older(file));
    is_newer && matches!(is_whole(path, made), Ok(true))
}

/// Tells whether a file is an undamaged PNG that says this, and that no pixel is missing of.
fn is_whole(path: &Path, made: &Provenance) -> io::Result<bool> {
    let mut png = png::Decoder::new(BufReader::with_capacity(1 << 16, files::open(path)?));
    png.ignore_checksums(false);
    let mut png = png.read_info()?;
    let info = png.info();
    let has = |(keyword, text): &(&str, String)| {
        let plain = info.uncompressed_latin1_text.iter().any(|of| of.keyword == *keyword && of.text == *text);
        // A compressed text might be a thousand times longer than the file.
        let mut others = info.utf8_text.iter().filter(|of| of.keyword == *keyword && !of.compressed);
        plain || others.any(|of| of.get_text().is_ok_and(|of| of == *text))
    };
    // What a stopped render leaves is transparent where pixels are missing, and has no texts.
    let colours = if made.alpha { png::ColorType::Rgba } else { png::ColorType::Rgb };
    if info.color_type != colours || !made.texts.iter().all(has) {
        return Ok(false);
    }
    while png.next_row()?.is_some() {}
    png.finish()?;
    Ok(true)
}

fn options((camera, exposure): (&Sensor, f64), region: &Region) -> String {
    let [width, height] = camera.pixels;
    let mut words = format!("--size {width}x{height}");
    if region.size() != camera.pixels {
        let (columns, rows) = (&region.columns, &region.rows);
        words += &format!(" --crop {},{},{},{}", columns.start, height - rows.end, columns.len(), rows.len());
    }
    match camera.adaptive {
        None => words += &format!(" --samples {}", camera.samples),
        Some(Adaptive { most, error }) => {
            words += &format!(" --samples {}..{most}", camera.samples);
            words +=
                &error.map_or(String::new(), |error| format!(" --max-error {}", max_error::option(error)));
        }
    }
    if camera.certain {
        words += " --certain";
    }
    if camera.samples > 1 || camera.adaptive.is_some() {
        words += &format!(" --sampler {}", camera.sampler.name());
    }
    if camera.alpha {
        words += " --alpha";
    }
    if exposure != 0.0 {
        words += &format!(" --exposure {}", text::shortest(exposure));
    }
    match (camera.accuracy, camera.rules) {
        // The scene itself chooses the notes' method and not their rules of light.
        (Accuracy::Classic, Rules::Free) => {}
        (Accuracy::Classic, Rules::Notes) => words += " --method classic",
        (accuracy, _) => words += &format!(" --accuracy {}", accuracy.option().name),
    }
    words
}
