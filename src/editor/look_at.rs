//! Converts the notes' `camera`, which has a fixed image plane, into a `look_at` with the same view.

use super::text::Text;
use super::view::{Attribute, Entity, Item, View};
use super::word::Form;
use std::ops::Range;
use tabray_core::text::{short, shortest};
use tabray_lang::syntax::Syntax;

/// The maximum shift of a pixel, in pixels, for a view that counts as the same.
const SAME: f64 = 0.5;

/// The minimum angle, in degrees, that does not count as 0.
const STRAIGHT: f64 = 1e-6;

/// The conversion of a `camera` into a `look_at`.
#[derive(Debug)]
pub struct LookAt {
    /// Ranges of the text and their replacements, in the order of the text.
    pub edits: Vec<(Range<usize>, String)>,
    /// The change of the view.
    pub change: Change,
}

/// The difference between the view of a `look_at` and that of the original `camera`.
#[derive(Clone, Copy, Debug, Default)]
pub struct Change {
    /// The shift of a pixel at the edge of the image, in pixels. The outermost pixels of a `camera` have their centres
    /// on the edges of its image plane, and so its pixels are square only if the image is.
    pub shift: f64,
    /// The angle, in degrees, by which the view turns toward the middle of the image plane. It is 0 if the viewer of
    /// the `camera` is in front of the middle.
    pub turn: f64,
}

impl LookAt {
    /// Returns the text after the edits.
    pub fn applied(&self, text: &Text) -> Text {
        self.edits.iter().rev().fold(text.clone(), |text, (place, with)| text.edited(place.clone(), with))
    }
}

/// Returns the conversion of the `camera` in a range of a text into a `look_at`, or `None` if there is no `camera`.
///
/// The viewer stays, and the middle of the image plane appears in the middle of the image, at the same size as before.
///
/// # Errors
/// Returns the reason why no `look_at` has the view of the `camera`, or why the text does not determine it.
pub fn look_at(view: &View, wanted: &Range<usize>) -> Option<Result<LookAt, String>> {
    let camera = view.items.iter().find_map(|item| match item {
        Item::Entity(entity) if entity.known.is_some_and(|known| known.name == "camera") => Some(entity),
        _ => None,
    })?;
    let is_there = camera.place.start <= wanted.end && wanted.start <= camera.place.end;
    is_there.then(|| turned(view, camera))
}

fn turned(view: &View, camera: &Entity) -> Result<LookAt, String> {
    if !camera.again.is_empty() {
        return Err("its name stands in several places: change the text".to_owned());
    }
    let (_, pixels) = numbers::<2>(view, camera, "pixeldim")?;
    let (plane, size) = numbers::<2>(view, camera, "worlddim")?;
    let (viewpoint, at) = numbers::<3>(view, camera, "viewpoint")?;
    let (angle, change) = angle(pixels, size, at)?;

    let column = plane.values[0].start - plane.name.start;
    let is_on_lines = view.slice(camera.place.clone()).contains('\n');
    let padded = |name: &str, width: usize| {
        if is_on_lines { format!("{name:width$}") } else { name.to_owned() }
    };
    let renamed =
        |given: &Attribute, name: &str| (given.name.place(), padded(name, given.name.end - given.name.start));
    let target = [0.5 * size[0], 0.5 * size[1], 0.0].map(shortest);
    let target = target.join(if view.syntax == Syntax::Toml { ", " } else { " " });
    let mut further = vec![("angle", shortest(angle))];
    let has_rules = camera.attributes.iter().any(|given| is_called(given, "rules"));
    if !has_rules {
        further.push(("rules", view.syntax.word("notes")));
    }
    let (end, between) = view.room(camera);
    let further = further.into_iter().map(|(name, value)| {
        let pair = match view.syntax {
            Syntax::Notes => format!("{} {value}", padded(name, column.saturating_sub(1))),
            Syntax::Toml => view.syntax.pair(name, &[value]),
        };
        format!("{between}{pair}")
    });
    let mut edits = vec![
        (camera.kind.place(), "look_at".to_owned()),
        renamed(plane, "target"),
        (plane.values[0].start..plane.values[1].end, target),
        renamed(viewpoint, "position"),
        (end..end, further.collect()),
    ];
    edits.sort_by_key(|(place, _)| (place.start, place.end));
    Ok(LookAt { edits, change })
}

/// Returns the angle of view across an image, in degrees, and the change of the view. At this angle, square pixels show
/// the same as the pixels of an image plane at z = 0.
fn angle(pixels: [f64; 2], size: [f64; 2], [x, y, z]: [f64; 3]) -> Result<(f64, Change), String> {
    if z <= 0.0 {
        return Err("the viewer is behind the image plane, which mirrors the image".to_owned());
    }
    let aside = libm::hypot(x - 0.5 * size[0], y - 0.5 * size[1]);
    let turn = libm::atan2(aside, z).to_degrees();
    let [across, up] = [0, 1].map(|side| size[side] / (pixels[side] - 1.0).max(1.0));
    let pixel = (pixels[0] * across + pixels[1] * up) / (pixels[0] + pixels[1]);
    let shift = (pixels[0] * (across - pixel).abs()).max(pixels[1] * (up - pixel).abs()) / (2.0 * pixel);
    if shift.is_nan() || shift >= SAME {
        let ratio = short(across / up);
        return Err(format!(
            "its pixels are {ratio} times as wide as high, and those of a `look_at` are square"
        ));
    }
    let angle = 2.0 * libm::atan(0.5 * pixels[0] * pixel / libm::hypot(aside, z)).to_degrees();
    if !(0.001..=179.0).contains(&angle) {
        return Err(format!(
            "its angle of view is {} degrees; that of a `look_at` is from 0.001 to 179",
            short(angle)
        ));
    }
    // Rounding loses less than a hundredth of a pixel.
    let angle = format!("{angle:.5e}").parse().unwrap_or(angle);
    Ok((angle, Change { shift, turn: if turn < STRAIGHT { 0.0 } else { turn } }))
}

fn is_called(given: &Attribute, name: &str) -> bool {
    given.known.is_some_and(|known| known.name() == name)
}

/// Returns an attribute with this many numbers.
fn numbers<'c, const N: usize>(
    view: &View,
    camera: &'c Entity,
    name: &str,
) -> Result<(&'c Attribute, [f64; N]), String> {
    let mut all = camera.attributes.iter().filter(|given| is_called(given, name));
    let (Some(given), None) = (all.next(), all.next()) else {
        return Err(format!("it does not have one `{name}`"));
    };
    if given.values.iter().any(|word| word.form != Form::Bare) {
        return Err(format!("its `{name}` is a formula: change the text"));
    }
    let values = given.values.iter().map(|word| view.word(*word).replace('_', "").parse().ok());
    let values = values.collect::<Option<Vec<f64>>>().and_then(|values| <[f64; N]>::try_from(values).ok());
    let are_finite = |values: &[f64; N]| values.iter().all(|value| value.is_finite());
    let values = values.filter(are_finite).ok_or_else(|| format!("its `{name}` is not {N} numbers"))?;
    Ok((given, values))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::read;
    use tabray_lang::registry::Registry;

    fn turned(file: &str, text: &str) -> Result<String, String> {
        let view = read(Registry::get().expect("plugins"), file, Text::new(text));
        let camera = view.entity("eye").expect("a camera");
        let turned = look_at(&view, &camera.place).expect("a camera")?;
        Ok(turned.applied(&view.text).as_str().to_owned())
    }

    #[test]
    fn a_camera_becomes_a_look_at_and_nothing_else_changes() {
        let line =
            "# here\ncamera eye { pixeldim 100 100  worlddim 6 6  viewpoint 3 3 4 samples 4 } # there\n";
        let after = "# here\nlook_at eye { pixeldim 100 100  target 3 3 0  position 3 3 4 samples 4  angle 74.2934  rules notes } # there\n";
        assert_eq!(turned("a.ray", line), Ok(after.to_owned()));
        let lines = "camera eye\n{\n    pixeldim  100 100\n    worlddim  6 6   # wide\n    viewpoint 3 3 4 # the viewer\n}\n";
        let after = "look_at eye\n{\n    pixeldim  100 100\n    target    3 3 0   # wide\n    position  3 3 4 # the viewer\n    angle     74.2934\n    rules     notes\n}\n";
        assert_eq!(turned("a.ray", lines), Ok(after.to_owned()));
        let toml = "[camera.eye]\npixeldim = [100, 100]\nviewpoint = [3, 3, 4]\nworlddim = [6, 6] # wide\nrules = \"free\"\n";
        let after = "[look_at.eye]\npixeldim = [100, 100]\nposition  = [3, 3, 4]\ntarget   = [3, 3, 0] # wide\nrules = \"free\"\nangle = 74.2934\n";
        assert_eq!(turned("a.toml", toml), Ok(after.to_owned()));
    }

    #[test]
    fn what_no_look_at_shows_is_refused_with_the_reason() {
        for (attributes, reason) in [
            ("worlddim 8 6  viewpoint 4 3 -7", "behind the image plane"),
            ("worlddim 8 8  viewpoint 4 4 7", "as wide as high"),
            ("worlddim 8 6  viewpoint 4 \"1 + 2\" 7", "its `viewpoint` is a formula"),
            ("worlddim 8 6  viewpoint 4 3", "its `viewpoint` is not 3 numbers"),
            ("worlddim 8 6", "it does not have one `viewpoint`"),
            ("worlddim 8e-9 6e-9  viewpoint 4e-9 3e-9 7", "angle of view"),
        ] {
            let refused = turned("a.ray", &format!("camera eye {{ pixeldim 640 480  {attributes} }}"));
            assert!(refused.as_ref().is_err_and(|said| said.contains(reason)), "{refused:?}");
        }
    }

    #[test]
    fn an_image_of_any_shape_shifts_by_less_than_half_a_pixel() {
        for pixels in [[640.0, 480.0], [1920.0, 1080.0], [480.0, 640.0], [1000.0, 100.0], [3.0, 3.0]] {
            let size = pixels.map(|side| side / 80.0);
            let (_, change) = angle(pixels, size, [0.5 * size[0], 0.5 * size[1], 6.0]).expect("a view");
            let [wide, high] = pixels;
            let expected = 0.5 * (f64::abs(wide - high) / (wide + high));
            assert!((change.shift - expected).abs() < 0.05, "{pixels:?}: {change:?}, {expected}");
            assert_eq!(change.turn, 0.0);
        }
    }

    #[test]
    fn a_viewer_aside_looks_at_the_middle_and_the_turn_is_told() {
        let (_, change) = angle([640.0, 480.0], [8.0, 6.0], [4.0, 4.0, 1.0]).expect("a view");
        assert!((change.turn - 45.0).abs() < 1e-9, "{change:?}");
    }
}
