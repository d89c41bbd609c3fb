//! Words that are no attributes of an entity's type: what they probably mean.

use super::attributes::AttributeChecker;
use super::fault::Fault;
use super::files;
use super::guesses::{find_attribute, near_attribute};
use super::parsed::Word;
use crate::syntax::Syntax;
use tabray_core::scene::attribute::Attribute;
use tabray_core::scene::entity::Entity;
use tabray_core::scene::kind::Kind;
use tabray_core::scene::value::Type;
use tabray_core::text::{self, list};

/// The maximum number of other types that are named because they have an attribute.
const MAX_OTHERS: usize = 4;

impl AttributeChecker<'_, '_> {
    /// Reports attributes that the type does not have, and returns the attributes that they probably meant.
    pub(super) fn unknown_attributes(
        &mut self,
        title: &str,
        attributes: &[&'static dyn Attribute],
        given: &[Option<(&Word<'_>, &[Word<'_>])>],
        unknown: &[(&Word<'_>, &[Word<'_>])],
    ) -> Vec<&'static str> {
        let syntax = self.report.syntax();
        let guesses = self.report.guesses();
        let near = |word: &Word<'_>| near_attribute(self.entity, &word.text, guesses).map(|near| near.name());
        let mut near: Vec<_> = unknown.iter().map(|(word, _)| *word).map(near).collect();
        let mut cures = vec![None; unknown.len()];
        let missing = attributes.iter().zip(given).filter(|(attribute, given)| {
            given.is_none() && attribute.default().is_none() && !near.contains(&Some(attribute.name()))
        });
        let mut missing: Vec<_> = missing.map(|(attribute, _)| *attribute).collect();
        // A file, alone or as the value of a word, belongs to an attribute that takes one, or to a texture.
        for (index, (word, values)) in unknown.iter().enumerate() {
            let file = values.first().unwrap_or(word).text.as_ref();
            let is_file = near[index].is_none() && values.len() < 2 && files::stem(file).is_some();
            let takes = |attribute: &&dyn Attribute| {
                files::takes(*attribute) || matches!(attribute.value_type(), Type::Name(Kind::Texture))
            };
            if !is_file {
                continue;
            }
            let Some(at) = missing.iter().position(takes) else {
                if self.entity.refers_to(Kind::Shader) && values.is_empty() {
                    cures[index] = files::cure(Kind::Shader, file, None, syntax);
                }
                continue;
            };
            let attribute = missing.remove(at);
            near[index] = Some(attribute.name());
            cures[index] = match (files::takes(attribute), values.is_empty()) {
                (true, false) => None,
                (true, true) => {
                    Some(format!("write `{}`", syntax.pair(attribute.name(), &[syntax.word(file)])))
                }
                (false, _) => files::cure(Kind::Texture, file, Some(attribute.name()), syntax),
            };
        }
        // If as many attributes are unknown as are missing, with as many numbers each, other programs use these names.
        let strange: Vec<_> = (0..unknown.len()).filter(|index| near[*index].is_none()).collect();
        let fits = |(index, attribute): (&usize, &&dyn Attribute)| {
            let values = unknown[*index].1;
            matches!(attribute.value_type(), Type::Number | Type::Whole)
                && attribute.arity().allow(values.len())
                && values.iter().all(|word| word.text.parse::<f64>().is_ok())
        };
        if strange.len() == missing.len() && strange.iter().zip(&missing).all(fits) {
            strange.iter().zip(&missing).for_each(|(index, attribute)| near[*index] = Some(attribute.name()));
        }
        for (((word, _), near), cure) in unknown.iter().zip(&near).zip(cures) {
            match cure {
                Some(cure) => {
                    let message = format!("{title} has no attribute `{}`", word.text);
                    self.report.add(Fault::error(word.place.clone(), message).help(cure));
                }
                None => self.unknown_attribute(title, word, *near),
            }
        }
        near.into_iter().flatten().collect()
    }

    /// Reports an attribute that the type does not have, with the attribute that it probably meant, if any.
    fn unknown_attribute(&mut self, title: &str, word: &Word<'_>, near: Option<&str>) {
        let entity = self.entity;
        let mut fault = Fault::error(word.place.clone(), format!("{title} has no attribute `{}`", word.text));
        if let Some(near) = near {
            fault = fault.label(format!("did you mean `{near}`?")).meant(Some(near));
        }
        if let (None, Some(other)) = (near, self.registry.known_as(&word.text)) {
            let usage = self.report.syntax().entity_usage(other, "NAME");
            self.report.add(fault.help(format!("see `{}`, {}: {usage}", other.name, other.meaning)));
            return;
        }
        let names = list(entity.attributes().map(|attribute| attribute.name()));
        let takes = format!("{} takes {names}", text::with_article(entity.name));
        // One material, light or camera stands where another does. An object has a material, and may have a shader.
        let kind = entity.kind();
        let of_kind = |kind: Kind, is_there: bool| {
            let others = self.registry.iter().filter(|other| other.kind() == kind);
            let others = others.filter(|_| is_there);
            others.filter_map(|other| has(other, &word.text)).take(MAX_OTHERS).collect::<Vec<_>>()
        };
        // What is only spelt alike may well be meant for another type.
        let is_synonym = entity.attributes().any(|attribute| is_known_as(attribute, &word.text));
        let alike = of_kind(kind, !is_synonym && !matches!(kind, Kind::Object | Kind::Texture));
        let is_strange = alike.is_empty() && near.is_none();
        let materials = of_kind(Kind::Material, is_strange && entity.refers_to(Kind::Material));
        let is_material = !materials.is_empty();
        let shaders = of_kind(Kind::Shader, is_strange && !is_material && entity.refers_to(Kind::Shader));
        let there = match (alike.is_empty(), is_material) {
            (false, _) => "",
            (true, true) => ": write it there",
            (true, false) => ": `shader` takes the name of one",
        };
        let others = [alike, materials, shaders].concat();
        let words: Vec<_> = others.iter().map(String::as_str).collect();
        self.report.add(fault.help(match words[..] {
            [] => takes,
            [other] => format!("{other} has it{there}; {takes}"),
            _ => format!("{} have it{there}; {takes}", text::and(&words)),
        }));
    }

    /// Tells whether a word after the name of an entity may belong to the name.
    pub(super) fn may_be_of_a_name(&mut self, word: &Word<'_>) -> bool {
        let is_attribute = |entity: &'static Entity| find_attribute(entity, &word.text).is_some();
        self.report.syntax() == Syntax::Notes
            && word.text.starts_with(char::is_alphabetic)
            && word.text.chars().all(|letter| letter.is_alphanumeric() || matches!(letter, '_' | '-'))
            && !matches!(word.text.as_ref(), "yes" | "no" | "true" | "false" | "on" | "off")
            && files::stem(&word.text).is_none()
            && near_attribute(self.entity, &word.text, self.report.guesses()).is_none()
            && !self.registry.iter().any(is_attribute)
    }

    /// Reports a name of several words, unless the first one is a name by itself. Returns whether it did.
    pub(super) fn name_of_words(
        &mut self,
        kind: Kind,
        attribute: &dyn Attribute,
        words: &[&Word<'_>],
    ) -> bool {
        let all: Vec<_> = words.iter().map(|word| word.text.as_ref()).collect();
        let (apart, joined) = (all.join(" "), all.join("_"));
        let is_there = |name: &str| self.names.defined(kind, name).is_some();
        let known = [apart.as_str(), &joined].into_iter().find(|name| is_there(name));
        if known.is_none() && is_there(all[0]) {
            return false;
        }
        let name = known.or(all.into_iter().find(|word| is_there(word))).unwrap_or(&joined);
        let syntax = self.report.syntax();
        let pair = syntax.pair(attribute.name(), &[syntax.word(name)]);
        let place = words[0].place.as_ref().zip(words[words.len() - 1].place.as_ref());
        let place = place.map(|(first, last)| first.start..last.end);
        let fault = Fault::error(place, format!("`{apart}` is not one word"));
        self.report.add(fault.help(format!("a name is one word, or stands in quotes: `{pair}`")));
        true
    }
}

/// Returns the name of an entity type that has an attribute, with the name that it has there.
fn has(entity: &'static Entity, word: &str) -> Option<String> {
    let known = || entity.attributes().find(|attribute| is_known_as(*attribute, word));
    let known = find_attribute(entity, word).or_else(known)?;
    let its = known.name();
    Some(if its == word { format!("`{}`", entity.name) } else { format!("`{}` (as `{its}`)", entity.name) })
}

/// Tells whether other programs call an attribute so.
fn is_known_as(attribute: &dyn Attribute, word: &str) -> bool {
    attribute.known_as().contains(&word.to_lowercase().as_str())
}
