//! Differences of colours: in their values, and as the eye sees them.

use glam::DVec3;
use tabray_core::world::display::{Display, Transfer};
use tabray_core::world::material::Rgb;

/// The difference of colours from the true ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Difference {
    /// The root of the mean square difference over all channels, where 1 is white.
    pub rmse: f64,
    /// The greatest difference of a channel, where 1 is white.
    pub worst: f64,
    /// The 99th percentile of the distances in Oklab, in hundredths of the distance from black to white. Colours about
    /// 2 apart can just be told apart.
    pub visible: f64,
    /// The number of colours whose bytes in an image differ.
    pub changed: usize,
}

/// Compares colours, as an image shows them, with the true ones, pair by pair.
pub fn difference(display: &Display, colours: &[Rgb], right: &[Rgb]) -> Difference {
    let (mut squares, mut worst, mut changed) = (0.0, 0.0_f64, 0);
    let mut visible = Vec::new();
    for (colour, right) in colours.iter().zip(right) {
        let is_changed = display.bytes(*colour) != display.bytes(*right);
        let (colour, right) = (display.shown(*colour), display.shown(*right));
        let apart = (colour - right).abs();
        squares += apart.length_squared();
        worst = worst.max(apart.max_element());
        if apart != DVec3::ZERO {
            visible.push(100.0 * (oklab(colour) - oklab(right)).length());
            changed += usize::from(is_changed);
        }
    }
    visible.sort_unstable_by(|one, other| other.total_cmp(one));
    let count = colours.len().max(1) as f64;
    Difference {
        rmse: (squares / (3.0 * count)).sqrt(),
        worst,
        visible: visible.get(colours.len() / 100).copied().unwrap_or(0.0),
        changed,
    }
}

/// Converts a colour of an image, which is shown as sRGB, to Oklab (B. Ottosson, "A perceptual color space for image
/// processing", 2020): lightness from 0 to 1, and two axes of colour.
fn oklab(colour: Rgb) -> DVec3 {
    let light = colour.map(|channel| Transfer::Srgb.decode(channel));
    let cone = |weights: DVec3| libm::cbrt(light.dot(weights));
    let cones = DVec3::new(
        cone(DVec3::new(0.412_221_470_8, 0.536_332_536_3, 0.051_445_992_9)),
        cone(DVec3::new(0.211_903_498_2, 0.680_699_545_1, 0.107_396_956_6)),
        cone(DVec3::new(0.088_302_461_9, 0.281_718_837_6, 0.629_978_700_5)),
    );
    DVec3::new(
        cones.dot(DVec3::new(0.210_454_255_3, 0.793_617_785, -0.004_072_046_8)),
        cones.dot(DVec3::new(1.977_998_495_1, -2.428_592_205, 0.450_593_709_9)),
        cones.dot(DVec3::new(0.025_904_037_1, 0.782_771_766_2, -0.808_675_766)),
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use tabray_core::world::sensor::Sensor;

    #[test]
    fn white_is_light_and_has_no_colour() {
        assert!((oklab(DVec3::ONE) - DVec3::X).length() < 1e-6);
        // Ottosson's own example, for sRGB red.
        let red = oklab(DVec3::X);
        assert!((red - DVec3::new(0.627_96, 0.224_86, 0.125_85)).length() < 1e-4, "{red}");
    }

    #[test]
    fn differences_are_of_what_is_shown() {
        let notes = Sensor::default().display();
        let far = [DVec3::splat(7.0), DVec3::new(f64::NAN, -1.0, 0.0)];
        let right = [DVec3::ONE, DVec3::ZERO];
        assert_eq!(
            difference(&notes, &far, &right),
            Difference { rmse: 0.0, worst: 0.0, visible: 0.0, changed: 0 }
        );
        let one = difference(&notes, &[DVec3::ONE, DVec3::ZERO], &[DVec3::ZERO, DVec3::ZERO]);
        assert!((one.rmse - 0.5_f64.sqrt()).abs() < 1e-15 && (one.visible - 100.0).abs() < 1e-4, "{one:?}");
        assert_eq!((one.worst, one.changed), (1.0, 1));
    }
}
