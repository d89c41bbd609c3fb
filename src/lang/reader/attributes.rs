//! The check of a parsed entity against the table of its type.

use super::cures;
use super::fault::{Fault, Place};
use super::guesses::find_attribute;
use super::names::Names;
use super::parsed::{Form, MAX_VALUES, Parsed, VALUES, Word};
use super::report::Report;
use super::values;
use crate::registry::Registry;
use crate::syntax::Syntax;
use tabray_core::scene::attribute::{Attribute, MAX_LENGTH, MIN_LENGTH};
use tabray_core::scene::choice::Choices;
use tabray_core::scene::entity::Entity;
use tabray_core::scene::kind::Kind;
use tabray_core::scene::pparm::AttributeValue;
use tabray_core::scene::store::Store;
use tabray_core::scene::value::{Datum, Type};
use tabray_core::text::{self, list};

/// Checks an entity against the table of its type, and reports its errors and warnings.
pub struct AttributeChecker<'c, 't> {
    /// The types of entities.
    pub registry: &'c Registry,
    /// The entity's type.
    pub entity: &'static Entity,
    /// The names that the entity's attributes may refer to.
    pub names: &'c mut Names,
    /// The entities and values so far.
    pub store: &'c Store,
    /// The report that receives errors and warnings.
    pub report: &'c mut Report<'t>,
}

impl AttributeChecker<'_, '_> {
    /// Returns a datum for each attribute of the type, or `None` after reporting an error.
    pub fn values(&mut self, parsed: &Parsed<'_>) -> Option<Vec<AttributeValue>> {
        let entity = self.entity;
        let title = match parsed.name.text.as_ref() {
            "" => format!("this {}", entity.name),
            name => format!("{} `{}`", entity.name, text::abridged(name)),
        };
        let attributes: Vec<_> = entity.attributes().collect();
        let mut given = vec![None; attributes.len()];
        let mut sound = !parsed.is_damaged;
        let (mut unknown, mut split) = (Vec::new(), Vec::new());
        // The last name of an entity, which may have further words.
        let mut last: Option<(_, _, Vec<_>)> = None;
        for pair in parsed.attributes() {
            let (word, words) = pair;
            let known = find_attribute(entity, &word.text);
            match known.and_then(|known| attributes.iter().position(|a| a.name() == known.name())) {
                None => match &mut last {
                    Some((_, name, further))
                        if [*name, word].into_iter().chain(words).all(|word| self.may_be_of_a_name(word)) =>
                    {
                        further.push(pair);
                    }
                    _ => {
                        split.extend(last.take());
                        unknown.push(pair);
                    }
                },
                Some(at) => {
                    split.extend(last.take());
                    last = match (attributes[at].value_type(), words) {
                        (Type::Name(kind), [name]) => Some(((at, kind), name, Vec::new())),
                        _ => None,
                    };
                    let before: Option<(&Word<'_>, _)> = given[at].replace(pair);
                    if let Some((first, _)) = before {
                        self.report.add(
                            Fault::warning(word.place.clone(), format!("{title} has `{}` twice", word.text))
                                .label("this one is used")
                                .also(first.place.clone(), "this one is ignored"),
                        );
                    }
                }
            }
        }
        split.extend(last);
        let mut in_words = Vec::new();
        for ((at, kind), name, further) in split.into_iter().filter(|(.., further)| !further.is_empty()) {
            sound = false;
            let further_words = further.iter().flat_map(|(word, words)| [*word].into_iter().chain(*words));
            let words: Vec<_> = [name].into_iter().chain(further_words).collect();
            if self.name_of_words(kind, attributes[at], &words) {
                given[at] = None;
                in_words.push(attributes[at].name());
            } else {
                unknown.extend(further);
            }
        }
        sound &= unknown.is_empty();
        let mut meant = self.unknown_attributes(&title, &attributes, &given, &unknown);
        meant.extend(in_words);
        sound &= self.groups(&title, &attributes, &given, &meant, parsed);
        let mut missing = Vec::new();
        let mut values = Vec::new();
        for (attribute, given) in attributes.iter().zip(given) {
            let is_given = given.is_some();
            let datum = match given {
                Some((word, words)) => self.datum(*attribute, &title, word, words),
                None => {
                    // An attribute that may be present but misspelt or unreadable is not reported as missing.
                    let may_be_there = meant.contains(&attribute.name()) || parsed.is_damaged;
                    if attribute.default().is_none() && !may_be_there {
                        missing.push(*attribute);
                    }
                    attribute.default()
                }
            };
            sound &= datum.is_some();
            values.extend(datum.map(|datum| (datum, is_given)));
        }
        if !missing.is_empty() {
            let wanted: Vec<_> =
                missing.iter().map(|attribute| self.report.syntax().usage(*attribute)).collect();
            let fault = format!("{title} lacks {}", list(missing.iter().map(|attribute| attribute.name())));
            self.report.add(
                Fault::error(parsed.name.place.clone(), fault)
                    .help(format!("add `{}`", wanted.join("` and `"))),
            );
        }
        sound.then_some(values)
    }

    /// Tells whether exactly one attribute of each required group is given, and reports the other groups.
    fn groups(
        &mut self,
        title: &str,
        attributes: &[&'static dyn Attribute],
        given: &[Option<(&Word<'_>, &[Word<'_>])>],
        meant: &[&str],
        parsed: &Parsed<'_>,
    ) -> bool {
        let mut sound = true;
        for group in self.entity.groups() {
            let of_group = || attributes.iter().zip(given).filter(|(a, _)| group.names.contains(&a.name()));
            let there: Vec<_> = of_group().filter_map(|(a, given)| Some((a.name(), (*given)?))).collect();
            // An attribute that may be present but misspelt or unreadable is not reported as missing.
            let may_be_there = parsed.is_damaged || group.names.iter().any(|name| meant.contains(name));
            sound &= there.len() == 1;
            if let [_, (_, (word, words)), ..] = there[..] {
                let names: Vec<_> = there.iter().map(|(name, _)| *name).collect();
                let message = format!("{title} has {}", group.several(&names));
                let help = format!("each of them is {}: leave one out", group.meaning);
                self.report.add(Fault::error(whole(word, words), message).help(help));
            } else if there.is_empty() && !may_be_there {
                let usage = |attribute: &dyn Attribute| {
                    let usage = self.report.syntax().usage(attribute);
                    let is_formula = matches!(attribute.value_type(), Type::Formula(_));
                    if is_formula { format!("a formula: `{usage}`") } else { format!("`{usage}`") }
                };
                let usages: Vec<_> = of_group().map(|(attribute, _)| usage(*attribute)).collect();
                let message = format!("{title} lacks {}", group.describe("or"));
                self.report.add(
                    Fault::error(parsed.name.place.clone(), message)
                        .help(format!("add {}", usages.join(", or "))),
                );
            }
        }
        sound
    }

    /// Checks the values of one attribute: their type, their number and their rule.
    fn datum(
        &mut self,
        attribute: &'static dyn Attribute,
        title: &str,
        word: &Word<'_>,
        words: &[Word<'_>],
    ) -> Option<Datum> {
        if words.iter().any(|word| word.form == Form::Faulty) {
            return None;
        }
        if let Some(fault) = fault_of_values(attribute, title, (word, words), self.report.syntax()) {
            self.report.add(fault);
            return None;
        }
        let datum = match (attribute.value_type(), words) {
            (Type::Name(kind), names) if attribute.arity().most() > 1 => self.objects(kind, title, names)?,
            (Type::Choice(Choices { kind: Some(kind), .. }), [name])
                if name.form != Form::Number
                    && let Some(index) = self.names.defined(kind, &name.text) =>
            {
                self.store.datum(index).clone()
            }
            (Type::Name(kind), [name]) if name.form != Form::Number => {
                // An optional object, such as the clip of a surface, becomes a part of the object that names it. The
                // original of a copy does not.
                self.names.combines |= kind == Kind::Object && attribute.default().is_some();
                self.names.resolve(self.store, kind, name)
            }
            (value_type, _) => match values::read(value_type, words) {
                Ok(datum) => datum,
                Err(mut faults) => {
                    if let Some(cure) = cures::cure(attribute, words, self.report.syntax()) {
                        faults.truncate(1);
                        faults.iter_mut().for_each(|fault| fault.help = Some(cure.clone()));
                    }
                    for fault in faults {
                        let takes = format!("`{}` of {title} takes {}", word.text, attribute.takes());
                        self.report.add(match (&fault.place, fault.label.is_empty()) {
                            // An entity built in Rust has no text to mark.
                            (None, _) => Fault { message: format!("{}: {takes}", fault.message), ..fault },
                            (Some(_), true) => fault.label(takes),
                            (Some(_), false) => fault,
                        });
                    }
                    return None;
                }
            },
        };
        if let Some(fault) = fault_of_value(attribute, &datum, title, word, words) {
            self.report.add(fault);
            return None;
        }
        Some(datum)
    }

    /// Returns the objects with these names, and reports repeated names.
    fn objects(&mut self, kind: Kind, title: &str, words: &[Word<'_>]) -> Option<Datum> {
        self.names.combines = true;
        let (mut all, mut is_right) = (Vec::with_capacity(words.len()), true);
        for (index, word) in words.iter().enumerate() {
            if let Some(first) = words[..index].iter().find(|first| first.text == word.text) {
                let message = format!("{title} names `{}` twice", word.text);
                let fault =
                    Fault::error(word.place.clone(), message).also(first.place.clone(), "named here first");
                self.report.add(fault.help("name each object once"));
                is_right = false;
            } else if let Datum::Object { name, body } = self.names.resolve(self.store, kind, word) {
                all.push((name, body));
            }
        }
        is_right.then_some(Datum::Objects(all))
    }
}

/// Returns an error if words cannot be values of an attribute at all, or if their number is wrong.
fn fault_of_values(
    attribute: &dyn Attribute,
    title: &str,
    (word, words): (&Word<'_>, &[Word<'_>]),
    syntax: Syntax,
) -> Option<Fault> {
    let truth = words.iter().find(|word| word.form == Form::Truth);
    if let (false, Some(truth)) = (matches!(attribute.value_type(), Type::Truth), truth) {
        let message = format!("`{}` cannot be the value of an attribute", truth.text);
        return Some(Fault::error(truth.place.clone(), message).help(VALUES));
    }
    if attribute.arity().allow(words.len()) {
        return None;
    }
    let more = if words.len() < MAX_VALUES { "" } else { " or more" };
    let count = format!("{}{more}", words.len());
    let not = match attribute.value_type() {
        Type::Truth | Type::Formula(_) => format!("{count} values"),
        _ => attribute.arity().not(&count),
    };
    let message = format!("`{}` of {title} takes {}, not {not}", word.text, attribute.takes());
    let help = cures::cure(attribute, words, syntax).unwrap_or_else(|| meaning(attribute));
    Some(Fault::error(whole(word, words), message).help(help))
}

/// Returns an error if an attribute's value breaks its rule, or if its square overflows.
fn fault_of_value(
    attribute: &dyn Attribute,
    datum: &Datum,
    title: &str,
    word: &Word<'_>,
    words: &[Word<'_>],
) -> Option<Fault> {
    if !attribute.allows(datum) {
        let given = words.iter().map(|word| word.text.as_ref()).collect::<Vec<_>>().join(" ");
        let message = format!("`{}` of {title} must be {}, not {given}", word.text, attribute.rule());
        let place = words.first().map_or(word.place.clone(), |first| whole(first, words));
        return Some(Fault::error(place, message).help(meaning(attribute)));
    }
    let (index, why) = attribute.beyond_squares(datum)?;
    let message = format!("`{}` of {title} is {why}", attribute.name());
    let place = words.get(index).map_or(word.place.clone(), |word| word.place.clone());
    Some(Fault::error(place, message).help(format!(
        "lengths and coordinates other than 0 must be between {MIN_LENGTH:e} and {MAX_LENGTH:e} world units"
    )))
}

fn meaning(attribute: &dyn Attribute) -> String {
    format!("`{}`: {}", attribute.name(), attribute.meaning())
}

/// Returns the place from an attribute's name, or its first value, to its last value.
pub fn whole(first: &Word<'_>, words: &[Word<'_>]) -> Place {
    let last = words.last().unwrap_or(first);
    Some(first.place.as_ref()?.start..last.place.as_ref()?.end)
}
