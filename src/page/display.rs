//! The display of light on a page: colours in single precision, and the settings that make levels of them.

use serde::Serialize;
use tabray_core::render::bytes::to_byte;
use tabray_core::scene::choice::Choice;
use tabray_core::world::material::Rgb;
use tabray_core::world::sensor::Sensor;

/// The settings of the display, by the names that scenes have for them.
#[derive(Serialize)]
pub struct Display {
    rules: &'static str,
    /// In stops.
    exposure: f64,
    tone: &'static str,
    transfer: &'static str,
}

impl Display {
    /// Returns the display of a camera's light.
    pub fn of(camera: &Sensor) -> Self {
        Self {
            rules: camera.rules.option().name,
            exposure: camera.exposure,
            tone: camera.tone.option().name,
            transfer: camera.transfer.option().name,
        }
    }
}

/// Returns the channels of colours in single precision.
pub fn singles(colours: &[Rgb]) -> Vec<u8> {
    let channels = colours.iter().flat_map(|colour| colour.to_array());
    channels.flat_map(|channel| single(channel).to_le_bytes()).collect()
}

/// Converts a channel to single precision, rounded in such a way that its byte in the image stays the same.
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
