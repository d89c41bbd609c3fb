//! What the program tells a page: server-sent events, each a name and data in one line.

use super::frame::Frame;
use crate::render::bytes::to_byte;
use crate::render::progressive::Area;
use crate::world::material::Rgb;
use base64::Engine;
use base64::engine::general_purpose::STANDARD;
use hyper::body::Bytes;
use serde_json::{Value, json};
use std::time::Duration;

/// A sound scene, whose picture follows in parts.
pub fn scene(frame: &Frame) -> Bytes {
    let data = json!({
        "version": frame.version,
        "name": frame.name,
        "size": frame.model.camera.value.pixels,
        "text": frame.text,
        "warnings": frame.warnings,
    });
    event("scene", &data)
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
    event("done", &json!({ "version": frame.version, "seconds": took.as_secs_f64() }))
}

/// What is wrong with the scene as it is now: its text, if it has one, and the lines that are marked there.
pub fn fault(name: &str, text: Option<&str>, report: &str, lines: &[usize]) -> Bytes {
    event("fault", &json!({ "name": name, "text": text, "report": report, "lines": lines }))
}

fn event(name: &str, data: &Value) -> Bytes {
    format!("event: {name}\ndata: {data}\n\n").into()
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
