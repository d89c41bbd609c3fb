//! The values of an attribute during typing: their names, and the index of the current one.

use super::hover::about;
use super::types::value_name;
use super::view::View;
use std::ops::Range;

/// The values of an attribute.
#[derive(Clone, Debug)]
pub struct Signature {
    /// The attribute with its values: `center x y z`.
    pub label: String,
    /// The range of each value in the label, in UTF-16 units.
    pub values: Vec<Range<u32>>,
    /// The index of the value at the position.
    pub active: usize,
    /// A description of the attribute, in Markdown.
    pub about: String,
}

/// Returns the signature of the attribute at a position.
pub fn signature(view: &View, at: usize) -> Option<Signature> {
    let entity = view.entity_at(at)?;
    let is_before =
        |attribute: &&super::view::Attribute| attribute.values_from.is_some_and(|from| from < at + 1);
    let attribute = entity.attributes.iter().rfind(is_before)?;
    let known = attribute.known?;
    let is_below = view.slice(attribute.end.min(at)..at).contains('\n');
    let before = attribute.values.iter().filter(|word| word.end < at).count();
    let most = known.arity().most();
    if attribute.name.has(at) || is_below || before >= most {
        return None;
    }
    let count = known.arity().examples().last().copied().unwrap_or(1).max(1);
    let mut label = known.name().to_owned();
    let mut values = Vec::new();
    for index in 0..count {
        let name = match value_name(known, index) {
            name if count > 1 && !name.is_empty() => name.replace(' ', "-"),
            _ if count > 1 => format!("N{}", index + 1),
            _ => view
                .syntax
                .usage(known)
                .split_once([' ', '='])
                .map_or("N", |(_, usage)| usage.trim_start_matches(['=', ' ']))
                .to_owned(),
        };
        label.push(' ');
        let start = label.encode_utf16().count() as u32;
        label += &name;
        values.push(start..label.encode_utf16().count() as u32);
    }
    // A list continues with the names of its first values.
    let active = if before < count { before } else { before % known.each().len().max(1) };
    Some(Signature { label, values, active, about: about(view.syntax, known) })
}
