//! Attributes, independent of the Rust type of their values.

use crate::scene::counts::Counts;
use crate::scene::value::{Datum, Type};
use crate::text;
use std::borrow::Cow;

/// The least length in world units other than 0. Its square, 1e-304, is above the least normal number (2.2e-308), so it
/// keeps its full precision.
pub const MIN_LENGTH: f64 = 1e-152;

/// The greatest length or coordinate in world units. Its square is 1e304, so thousands of squares can be added without
/// an overflow (at 1.8e308).
pub const MAX_LENGTH: f64 = 1e152;

/// An attribute, independent of the Rust type of its values.
pub trait Attribute: Sync {
    /// Returns the name in the scene language.
    fn name(&self) -> &'static str;
    /// Returns the other names.
    fn aliases(&self) -> &'static [&'static str];
    /// Returns the words by which other programs call the attribute, in lower case. Messages about these words suggest
    /// the attribute.
    fn known_as(&self) -> &'static [&'static str];
    /// Returns the meaning, in a few words.
    fn meaning(&self) -> &'static str;
    /// Returns the names of the values of a row, or of those of each group of a list; empty where they have none.
    fn each(&self) -> &'static [&'static str];
    /// Returns the unit of the values, or an empty string where they have none.
    fn unit(&self) -> &'static str;
    /// Returns the type of the values.
    fn value_type(&self) -> Type;
    /// Returns the numbers of values that the attribute may take.
    fn arity(&self) -> Counts;
    /// Returns the values where a scene gives none, or `None` where a scene must give them.
    fn default(&self) -> Option<Datum>;
    /// Returns the rule of the values, such as "positive", or an empty string where every value is allowed.
    fn rule(&self) -> Cow<'static, str>;
    /// Returns the least and the greatest number that each value may be, where there are such numbers.
    fn range(&self) -> Option<[f64; 2]>;
    /// Returns which part of a camera's pose the values give, if they give any.
    fn pose(&self) -> Option<Pose>;
    /// Tells whether values of the right type and number satisfy the rule.
    fn allows(&self, datum: &Datum) -> bool;
}

/// The part of a camera's pose that an attribute gives. With it, a page can move cameras of any type.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pose {
    /// The point where the viewer is. A camera without a [`Target`](Self::Target) looks through an image plane that
    /// stays in its place when the viewer moves.
    Position,
    /// The point at which the viewer looks.
    Target,
    /// The direction that points up in the image.
    Up,
    /// The size of the shown region in world units, if the rays are parallel.
    Extent,
}

impl dyn Attribute + '_ {
    /// Finds the first value that is a length or a coordinate whose square would overflow or underflow; returns its
    /// index and the reason.
    pub fn beyond_squares(&self, datum: &Datum) -> Option<(usize, &'static str)> {
        let Datum::Numbers(numbers) = datum else { return None };
        let is_length = self.unit() == "world units";
        // The sides of a rectangle or of the image plane, which come in pairs, are not squared.
        let is_alone = is_length && numbers.len() == 1;
        let why = |number: f64| match number.abs() {
            size if size > MAX_LENGTH && (is_length || self.unit() == "world coordinates") => {
                Some("so large that its square overflows")
            }
            size if size > 0.0 && size < MIN_LENGTH && is_alone => {
                Some("so small that its square underflows")
            }
            _ => None,
        };
        numbers.iter().enumerate().find_map(|(index, number)| Some((index, why(*number)?)))
    }

    /// Says how many values of which type the attribute takes: "1 or 3 numbers".
    pub fn takes(&self) -> String {
        match self.value_type() {
            Type::Whole => self.arity().describe("whole number"),
            Type::Number | Type::Rotation => self.arity().describe("number"),
            Type::Word => "a word".to_owned(),
            Type::File => "the name of a file".to_owned(),
            Type::Name(kind) if self.arity().most() > 1 => self.arity().describe(&format!("{kind} name")),
            Type::Name(kind) => format!("the name of {}", kind.with_article()),
            Type::Choice(choices) => {
                let has_numbers = choices.all().iter().any(|choice| choice.number.is_some());
                let name = if has_numbers { "name or number" } else { "name" };
                format!("the {name} of {}", text::with_article(choices.what))
            }
            Type::Formula(variables) => {
                let what = match self.arity().most() {
                    1 => "a formula".to_owned(),
                    _ => self.arity().describe("formula"),
                };
                format!("{what} in {}, in quotes", text::and(variables))
            }
            Type::Truth => "`yes` or `no`".to_owned(),
        }
    }
}
