//! The colours of a scene, as swatches, and the text to replace a colour.

use super::view::{Form, Item, View, Word};
use std::ops::Range;
use tabray_core::scene::COLOUR;
use tabray_core::text::shortest;
use tabray_lang::syntax::Syntax;

/// A colour in a text.
#[derive(Clone, Debug, PartialEq)]
pub struct Swatch {
    /// The range of the colour's values.
    pub place: Range<usize>,
    /// Red, green and blue, from 0 to 1. A brighter colour is scaled to a largest channel of 1, with the same hue.
    pub colour: [f64; 3],
}

/// Returns the colours that a text gives as numbers.
pub fn colours(view: &View) -> Vec<Swatch> {
    let mut swatches = Vec::new();
    view.visit(&mut |item, _| {
        let Item::Entity(entity) = item else { return };
        for attribute in entity.attributes.iter().filter(|attribute| attribute.values.len() == COLOUR.len()) {
            if let Some(known) = attribute.known
                && known.each() == COLOUR
                && let Some(colour) = numbers(view, &attribute.values)
            {
                let place = attribute.values[0].start..attribute.values[2].end;
                let bright = brightest(colour);
                swatches.push(Swatch { place, colour: colour.map(|channel| channel.max(0.0) / bright) });
            }
        }
    });
    swatches
}

fn numbers(view: &View, words: &[Word]) -> Option<[f64; 3]> {
    let mut colour = [0.0; 3];
    for (channel, word) in colour.iter_mut().zip(words) {
        let number = Some(word).filter(|word| word.form == Form::Bare)?;
        *channel = view.slice(number.place()).parse().ok().filter(|number: &f64| number.is_finite())?;
    }
    Some(colour)
}

/// Returns the number that a colour is divided by for its swatch: its brightest channel, but at least 1.
fn brightest(colour: [f64; 3]) -> f64 {
    colour.into_iter().fold(1.0, f64::max)
}

/// Returns the text for a new colour in place of the one in a range. If the old colour is brighter than 1, the new one
/// is scaled by the same factor.
pub fn presented(view: &View, place: &Range<usize>, colour: [f64; 3]) -> String {
    let old = view.slice(place.clone()).split([' ', ',', '\t', '\n']).filter(|word| !word.is_empty());
    let old: Vec<f64> = old.filter_map(|word| word.parse().ok()).collect();
    let scale = brightest(old.try_into().unwrap_or([1.0; 3]));
    let written = colour.map(|channel| shortest((channel * scale * 1000.0).round() / 1000.0));
    match view.syntax {
        Syntax::Notes => written.join(" "),
        Syntax::Toml => written.join(", "),
    }
}
