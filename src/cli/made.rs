//! What an image was made of and with, for a PNG to carry: the same for images that must be the same.

use super::input::Source;
use super::set;
use super::size::Part;
use crate::scene::choice::Choice;
use crate::text;
use crate::world::accuracy::Accuracy;
use crate::world::film::{Adaptive, Film};

/// Returns the texts of an image, each with its keyword: the version of the program, the hash of the scene's text, and
/// the options with which the program makes the same image of the scene. Threads, the level of CPU instructions and
/// the compression are none of them, as the image does not depend on these.
pub fn texts(source: &Source, set: &set::Args, camera: &Film, part: &Part) -> Vec<(&'static str, String)> {
    vec![
        ("Software", concat!("tabray ", env!("CARGO_PKG_VERSION")).to_owned()),
        ("tabray scene", source.hash()),
        ("tabray options", options(camera, part) + &set.words()),
    ]
}

fn options(camera: &Film, part: &Part) -> String {
    let [width, height] = camera.pixels;
    let mut words = format!("--size {width}x{height}");
    if part.size() != camera.pixels {
        let (columns, rows) = (&part.columns, &part.rows);
        words += &format!(" --crop {},{},{},{}", columns.start, height - rows.end, columns.len(), rows.len());
    }
    match camera.adaptive {
        None => words += &format!(" --samples {}", camera.samples),
        Some(Adaptive { most, error }) => {
            words += &format!(" --samples {}..{most}", camera.samples);
            words +=
                &error.map_or(String::new(), |error| format!(" --max-error {}", text::short(255.0 * error)));
        }
    }
    if camera.certain {
        words += " --certain";
    }
    if camera.samples > 1 || camera.adaptive.is_some() {
        words += &format!(" --sampler {}", text::name(&camera.sampler));
    }
    if camera.exposure != 0.0 {
        words += &format!(" --exposure {}", text::shortest(camera.exposure));
    }
    let accuracy = camera.accuracy.option().name;
    let option = if camera.accuracy == Accuracy::Classic { "method" } else { "accuracy" };
    words + &format!(" --{option} {accuracy}")
}
