//! The events that the program sends to a page: server-sent events, each a name and data on one line.

use super::frame::Frame;
use crate::display::{Display, singles};
use crate::trial_values::Difference;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use hyper::body::Bytes;
use serde::Serialize;
use std::time::Duration;
use tabray_core::render::progressive::Area;
use tabray_core::text::json;
use tabray_core::world::material::Rgb;
use tabray_tools::diagnosis::Remark;

/// Announces a valid scene, whose image follows in parts.
pub fn scene(frame: &Frame) -> Bytes {
    let data = Scene {
        display: Display::of(&frame.model.camera.value),
        name: &frame.name,
        size: frame.model.camera.value.pixels,
        text: &frame.text,
        version: frame.version,
        warnings: &frame.warnings,
    };
    event("scene", &data)
}

/// A scene, as the page receives it.
#[derive(Serialize)]
struct Scene<'s> {
    /// How its light is shown.
    display: Display,
    /// The name of the scene in messages.
    name: &'s str,
    /// The width and the height of the image in pixels.
    size: [usize; 2],
    text: &'s str,
    /// The version of the scene, from 1.
    version: u64,
    /// The warnings, as people read them; empty where there are none.
    warnings: &'s str,
}

/// Sends a part of a scene's image: the area, 1 if it is final and 0 if not, and its colours, red, green and blue of each block.
pub fn part(frame: &Frame, area: &Area, colours: &[Rgb]) -> Bytes {
    let Area { corner: [left, top], size: [width, height], block, is_final } = area;
    let pass = u8::from(*is_final);
    let base64 = STANDARD.encode(singles(colours));
    format!("event: part\ndata: {} {left} {top} {width} {height} {block} {pass} {base64}\n\n", frame.version)
        .into()
}

/// Announces that all parts of a scene's image have been sent.
pub fn done(frame: &Frame, took: Duration) -> Bytes {
    event("done", &ImageDone { seconds: took.as_secs_f64(), version: frame.version })
}

/// The end of an image.
#[derive(Serialize)]
struct ImageDone {
    /// The time for the image, in seconds.
    seconds: f64,
    version: u64,
}

/// Says why a complete image is black, burnt or empty.
pub fn remark(frame: &Frame, Remark { message, help }: &Remark) -> Bytes {
    let words = format!("warning: {message}\nhelp: {help}");
    event("remark", &ImageRemark { version: frame.version, words: &words })
}

/// Something about an image that is likely not to be meant.
#[derive(Serialize)]
struct ImageRemark<'w> {
    /// The version of the scene.
    version: u64,
    /// The message: the likely fault, its reason, and its cure.
    words: &'w str,
}

/// Announces an error in the current scene.
pub fn fault(fault: &Fault) -> Bytes {
    event("fault", fault)
}

/// The error in a scene.
#[derive(Serialize)]
pub struct Fault<'f> {
    /// The marked lines of the text, from 1.
    pub lines: &'f [usize],
    /// The name of the scene in messages.
    pub name: &'f str,
    /// The error, as people read it.
    pub report: &'f str,
    /// The text of the scene, or null where there is none.
    pub text: Option<&'f str>,
}

/// Tells which values differ from the scene's file.
pub fn tried(differences: &[Difference]) -> Bytes {
    event("tried", &differences)
}

/// Tells why the system does not tell of changes, null if it does.
pub fn watching(refused: Option<&str>) -> Bytes {
    event("watching", &refused)
}

/// Tells which scenes there are, in the order of the list.
pub fn scenes(list: &[SceneEntry]) -> Bytes {
    event("scenes", &list)
}

/// A scene in the list of all scenes.
#[derive(Serialize)]
pub struct SceneEntry {
    /// The number in the address of its page.
    pub number: usize,
    /// Its name.
    pub name: String,
}

fn event(name: &str, data: &impl Serialize) -> Bytes {
    format!("event: {name}\ndata: {}\n\n", json(data)).into()
}
