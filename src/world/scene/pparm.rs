//! The rows of an entity's table: `pparm` descriptors, and lines of the dump that are derived from them.
//!
//! A descriptor is a typed key. Name, type, default and rule are written once; the reader, messages, the dump, `tabray
//! list` and the constructor all use that one place (the notes' "general attribute parser").

use crate::scene::attribute::{Attribute, Pose};
use crate::scene::counts::{Counts, OneOf};
use crate::scene::value::{COLOUR, Datum, Type, Value};
use crate::text;
use glam::DVec3;
use std::borrow::Cow;
use std::panic::Location;
use std::ptr;
use tabray_exact::formula::field::FieldOf;

/// A row of an entity's table.
pub trait Row: Sync {
    /// Returns the attribute that this row describes, or `None` where the row is only a line of the dump.
    fn attribute(&self) -> Option<&dyn Attribute>;
    /// Returns the text of this row in the notes' dump, including line ends.
    fn dump(&self, attributes: &Attributes) -> String;
    /// Returns the attributes from which a scene must give exactly one, or `None` if the row is not such a group.
    fn one_of(&self) -> Option<&OneOf> {
        None
    }
}

/// Rows that belong together. Tables can be composed: a finite plane has the plane's rows and its own.
pub type Table = &'static [&'static dyn Row];

/// An attribute's name, meaning, unit, default and rule, and the key to its value.
///
/// Type and number of the values are those of `T`.
pub struct Pparm<T: Value> {
    name: &'static str,
    aliases: &'static [&'static str],
    known_as: &'static [&'static str],
    meaning: &'static str,
    each: &'static [&'static str],
    unit: &'static str,
    default: Option<T>,
    rule: &'static str,
    keeps: fn(&T) -> bool,
    range: Option<[f64; 2]>,
    pose: Option<Pose>,
    /// The beginning of the attribute's line in the notes' dump; `None` where the dump leaves it out.
    label: Option<&'static str>,
    ending: &'static str,
    shown: Option<fn(T) -> T>,
}

impl<T: Value> Pparm<T> {
    /// Describes an attribute that every scene must give.
    pub const fn required(name: &'static str, meaning: &'static str) -> Self {
        Self::new(name, meaning, None)
    }

    /// Describes an attribute with a default.
    pub const fn or(name: &'static str, meaning: &'static str, default: T) -> Self {
        Self::new(name, meaning, Some(default))
    }

    const fn new(name: &'static str, meaning: &'static str, default: Option<T>) -> Self {
        Self {
            name,
            aliases: &[],
            known_as: &[],
            meaning,
            each: T::EACH,
            unit: "",
            default,
            rule: "",
            keeps: |_| true,
            range: None,
            pose: None,
            label: Some(name),
            ending: " \n",
            shown: None,
        }
    }

    /// Sets other names that a scene may use.
    pub const fn alias(mut self, aliases: &'static [&'static str]) -> Self {
        self.aliases = aliases;
        self
    }

    /// Sets other programs' words for the attribute, in lower case.
    pub const fn known_as(mut self, words: &'static [&'static str]) -> Self {
        self.known_as = words;
        self
    }

    /// Sets the names of the values of a row, where they are not those of its type: [`COLOUR`]
    /// for a colour.
    pub const fn each(mut self, names: &'static [&'static str]) -> Self {
        self.each = names;
        self
    }

    /// Sets the unit of the values.
    pub const fn unit(mut self, unit: &'static str) -> Self {
        self.unit = unit;
        self
    }

    /// Sets the rule: the words that end the sentence "it must be ...", and the test.
    pub const fn must(mut self, rule: &'static str, keeps: fn(&T) -> bool) -> Self {
        self.rule = rule;
        self.keeps = keeps;
        self
    }

    /// Sets the range of each number, ends included. It is part of the rule: "from 0 to 1".
    pub const fn between(mut self, least: f64, most: f64) -> Self {
        self.range = Some([least, most]);
        self
    }

    /// Sets the part of a camera's pose that the values give.
    pub const fn pose(mut self, pose: Pose) -> Self {
        self.pose = Some(pose);
        self
    }

    /// Sets the label and the end of the attribute's line in the notes' dump, where they are not its name and `" \n"`.
    pub const fn dumped(mut self, label: &'static str, ending: &'static str) -> Self {
        self.label = Some(label);
        self.ending = ending;
        self
    }

    /// Sets the value that the notes' dump shows, given the value that was read.
    pub const fn shown(mut self, shown: fn(T) -> T) -> Self {
        self.shown = Some(shown);
        self
    }

    /// Leaves the attribute out of the notes' dump.
    pub const fn not_dumped(mut self) -> Self {
        self.label = None;
        self
    }
}

impl Pparm<f64> {
    /// Sets the rule that the number is positive.
    pub const fn positive(self) -> Self {
        self.must("positive", |number| *number > 0.0)
    }
}

impl<const VARIABLES: usize> Pparm<FieldOf<VARIABLES>>
where
    FieldOf<VARIABLES>: Value,
{
    /// Sets the rule that the formula is short enough to be evaluated in thousands of places when a shape is made: see
    /// [`FieldOf::is_short`].
    pub const fn short(self) -> Self {
        self.must("of at most 10000 operations", FieldOf::is_short)
    }
}

impl Pparm<DVec3> {
    /// Sets the rule that the vector is not zero, and so has a direction.
    pub const fn nonzero(self) -> Self {
        self.must("a nonzero vector", |vector| *vector != DVec3::ZERO)
    }
}

impl<T: Value> Attribute for Pparm<T> {
    fn name(&self) -> &'static str {
        self.name
    }

    fn aliases(&self) -> &'static [&'static str] {
        self.aliases
    }

    fn known_as(&self) -> &'static [&'static str] {
        self.known_as
    }

    fn meaning(&self) -> &'static str {
        self.meaning
    }

    fn each(&self) -> &'static [&'static str] {
        self.each
    }

    fn unit(&self) -> &'static str {
        if self.unit.is_empty() { T::TYPE.unit() } else { self.unit }
    }

    fn value_type(&self) -> Type {
        T::TYPE
    }

    fn arity(&self) -> Counts {
        T::ARITY
    }

    fn default(&self) -> Option<Datum> {
        self.default.as_ref().map(T::to_datum)
    }

    fn rule(&self) -> Cow<'static, str> {
        let Some([least, most]) = self.range else { return self.rule.into() };
        let of_each = match T::ARITY.most() {
            1 => "",
            _ if self.each == COLOUR => " in each channel",
            _ => " in each dimension",
        };
        let and = if self.rule.is_empty() { "" } else { ", and " };
        format!("{}{and}from {least} to {most}{of_each}", self.rule).into()
    }

    fn range(&self) -> Option<[f64; 2]> {
        self.range
    }

    fn pose(&self) -> Option<Pose> {
        self.pose
    }

    fn allows(&self, datum: &Datum) -> bool {
        let lies_in = |number: f64| self.range.is_none_or(|[least, most]| (least..=most).contains(&number));
        let is_in_range = match datum {
            Datum::Numbers(numbers) => numbers.iter().all(|number| lies_in(*number)),
            Datum::Whole(numbers) => numbers.iter().all(|number| lies_in(*number as f64)),
            _ => true,
        };
        is_in_range && T::from_datum(datum).is_some_and(|value| (self.keeps)(&value))
    }
}

impl<T: Value> Row for Pparm<T> {
    fn attribute(&self) -> Option<&dyn Attribute> {
        Some(self)
    }

    fn dump(&self, attributes: &Attributes) -> String {
        let Some(label) = self.label else { return String::new() };
        let as_read = attributes.datum(self.name);
        match self.shown.zip(T::from_datum(as_read)) {
            Some((shown, value)) => shown(value).to_datum().line(label, self.ending),
            None => as_read.line(label, self.ending),
        }
    }
}

/// A line of the notes' dump that is derived from the attributes above it, such as a rotation matrix.
pub struct Derived(pub fn(&Attributes) -> String);

impl Row for Derived {
    fn attribute(&self) -> Option<&dyn Attribute> {
        None
    }

    fn dump(&self, attributes: &Attributes) -> String {
        (self.0)(attributes)
    }
}

/// Says of which attributes exactly one must be given.
impl Row for OneOf {
    fn attribute(&self) -> Option<&dyn Attribute> {
        None
    }

    fn dump(&self, _attributes: &Attributes) -> String {
        String::new()
    }

    fn one_of(&self) -> Option<&OneOf> {
        Some(self)
    }
}

/// The values of an attribute, and whether the scene gives them; if not, they are the default.
pub type AttributeValue = (Datum, bool);

/// The attributes of an entity of a scene, each with its checked value.
#[derive(Clone)]
pub struct Attributes {
    /// The name of the entity's type, and the source position that registers it.
    plugin: (&'static str, &'static Location<'static>),
    /// All attributes of the type, in the order of its table.
    values: Vec<(&'static dyn Attribute, AttributeValue)>,
}

impl Attributes {
    /// Makes the attributes of an entity. `values` holds one value for each attribute, in table order.
    pub(crate) fn new(
        plugin: (&'static str, &'static Location<'static>),
        attributes: impl Iterator<Item = &'static dyn Attribute>,
        values: Vec<AttributeValue>,
    ) -> Self {
        let count = values.len();
        let values: Vec<_> = attributes.zip(values).collect();
        debug_assert_eq!(values.len(), count);
        Self { plugin, values }
    }

    /// Returns the value of the attribute that `key` describes.
    ///
    /// # Panics
    /// If the plugin asks for an attribute that is not in the table it registered.
    #[track_caller]
    pub fn get<T: Value>(&self, key: &Pparm<T>) -> T {
        match self.found(key).and_then(T::from_datum) {
            Some(value) => value,
            // No closure, so the panic message names the plugin's line.
            None => self.not_in_table(key.name()),
        }
    }

    /// Returns the value of the attribute that `key` describes, if the scene gives it.
    ///
    /// # Panics
    /// If the plugin asks for an attribute that is not in the table it registered.
    #[track_caller]
    pub(crate) fn get_given<T: Value>(&self, key: &Pparm<T>) -> Option<T> {
        let value = self.get(key);
        self.given().any(|(attribute, _)| attribute.name() == key.name()).then_some(value)
    }

    /// Returns the checked value of an attribute.
    #[track_caller]
    pub(crate) fn datum(&self, attribute: &str) -> &Datum {
        self.find(attribute).unwrap_or_else(|| self.not_in_table(attribute))
    }

    /// Returns every attribute with its value, in the order of the table.
    pub fn values(&self) -> impl Iterator<Item = (&'static dyn Attribute, &Datum)> {
        self.values.iter().map(|(attribute, (datum, _))| (*attribute, datum))
    }

    /// Returns the attributes that the scene gives, with their values.
    pub fn given(&self) -> impl Iterator<Item = (&'static dyn Attribute, &Datum)> {
        let given = self.values.iter().filter(|(_, (_, given))| *given);
        given.map(|(attribute, (datum, _))| (*attribute, datum))
    }

    /// Returns the names of the textures that the entity refers to.
    pub fn textures(&self) -> impl Iterator<Item = &str> {
        self.values().filter_map(|(_, datum)| match datum {
            Datum::Texture { name, .. } => Some(&**name),
            _ => None,
        })
    }

    /// Returns every attribute with its value and whether the scene gives it, in the order of the table.
    pub(crate) fn values_mut(
        &mut self,
    ) -> impl Iterator<Item = (&'static dyn Attribute, &mut Datum, &mut bool)> {
        self.values.iter_mut().map(|(attribute, (datum, is_given))| (*attribute, datum, is_given))
    }

    /// Finds the value of the attribute that `key` describes: most keys are themselves in the table, and need not be
    /// compared by name.
    fn found<T: Value>(&self, key: &Pparm<T>) -> Option<&Datum> {
        let itself = self.values.iter().find(|(attribute, _)| ptr::addr_eq(*attribute, key));
        itself.map(|(_, (datum, _))| datum).or_else(|| self.find(key.name()))
    }

    /// Returns the names of the files that the entity is read from, as the scene gives them.
    pub fn files(&self) -> impl Iterator<Item = &str> {
        self.values().filter_map(|(attribute, datum)| match (attribute.value_type(), datum) {
            (Type::File, Datum::Word(file)) => Some(file.as_str()),
            _ => None,
        })
    }

    /// Finds the value of the attribute of this name.
    pub fn find(&self, attribute: &str) -> Option<&Datum> {
        self.values().find(|(known, _)| known.name() == attribute).map(|(_, datum)| datum)
    }

    #[track_caller]
    fn not_in_table(&self, attribute: &str) -> ! {
        let (name, place) = (self.plugin.0, text::place(self.plugin.1));
        match self.find(attribute) {
            Some(_) => panic!(
                "the plugin `{name}` asks for `{attribute}` with another type than in the table it registers at {place}: give both the same type"
            ),
            None => panic!(
                "the plugin `{name}` asks for `{attribute}`, which is not in the table it registers at {place}: add it there"
            ),
        }
    }
}
