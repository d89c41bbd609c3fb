//! What the program tells a page: server-sent events, each a name and data in one line.

use super::frame::Frame;
use crate::render::bytes::to_byte;
use crate::render::progressive::Area;
use crate::words::json;
use crate::world::material::Rgb;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use hyper::body::Bytes;
use serde::Serialize;
use std::time::Duration;

/// A sound scene, whose picture follows in parts.
pub fn scene(frame: &Frame) -> Bytes {
    let data = Scene {
        name: &frame.name,
        size: frame.model.camera.value.pixels,
        text: &frame.text,
        version: frame.version,
        warnings: &frame.warnings,
    };
    event("scene", &data)
}

/// A scene as the page has it.
#[derive(Serialize)]
struct Scene<'s> {
    /// What messages call it.
    name: &'s str,
    /// The width and the height of its picture.
    size: [usize; 2],
    /// What it was read from.
    text: &'s str,
    /// Which one it is, counted from 1.
    version: u64,
    /// What may not mean what was intended, as people read it; empty where there is nothing.
    warnings: &'s str,
}

/// A part of a scene's picture: the area and its colours, red, green and blue of each block.
pub fn part(frame: &Frame, area: &Area, colours: &[Rgb]) -> Bytes {
    let Area { corner: [left, top], size: [width, height], block } = area;
    let bytes: Vec<u8> = colours
        .iter()
        .flat_map(|colour| colour.to_array())
        .flat_map(|channel| single(channel).to_le_bytes())
        .collect();
    let base64 = STANDARD.encode(bytes);
    format!("event: part\ndata: {} {left} {top} {width} {height} {block} {base64}\n\n", frame.version).into()
}

/// All parts of a scene's picture were told.
pub fn done(frame: &Frame, took: Duration) -> Bytes {
    event("done", &Done { seconds: took.as_secs_f64(), version: frame.version })
}

/// The end of a picture.
#[derive(Serialize)]
struct Done {
    /// How long the picture took.
    seconds: f64,
    /// Which scene it is of.
    version: u64,
}

/// What is wrong with the scene as it is now.
pub fn fault(fault: &Fault) -> Bytes {
    event("fault", fault)
}

/// What is wrong with a scene.
#[derive(Serialize)]
pub struct Fault<'f> {
    /// The lines of the text that are marked, counted from 1.
    pub lines: &'f [usize],
    /// What messages call it.
    pub name: &'f str,
    /// What is wrong, as people read it.
    pub report: &'f str,
    /// Its text, or null where there is none.
    pub text: Option<&'f str>,
}

fn event(name: &str, data: &impl Serialize) -> Bytes {
    format!("event: {name}\ndata: {}\n\n", json(data)).into()
}

/// A channel in half the bits, such that its byte in the picture stays the same.
fn single(channel: f64) -> f32 {
    let nearest = channel as f32;
    if to_byte(nearest.into()) == to_byte(channel) {
        nearest
    } else if f64::from(nearest) < channel {
        nearest.next_up()
    } else {
        nearest.next_down()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_channel_keeps_its_byte_in_half_the_bits() {
        for byte in 1..=255 {
            let edge = f64::from(byte) / 255.0;
            for channel in [edge.next_down().next_down(), edge.next_down(), edge, edge.next_up()] {
                assert_eq!(to_byte(single(channel).into()), to_byte(channel), "{channel}");
            }
        }
        assert!(single(f64::NAN).is_nan());
        assert_eq!(single(f64::MAX), f32::INFINITY);
    }
}
