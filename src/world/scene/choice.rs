//! Sets of alternatives from which an attribute chooses one, by name or by number: procedural shaders, profiles,
//! accuracies.
//!
//! Profiles are collected in a registry of their own; a plugin file adds one.

use crate::accuracy::Accuracy;
use crate::display::{Tone, Transfer};
use crate::rules::{Falloff, Rules};
use crate::scene::kind::Kind;
use crate::text;
use std::panic::Location;

/// A type whose values are the alternatives that an attribute can choose from.
pub trait Choice: Copy + Send + Sync + 'static {
    /// The noun for one alternative, in the singular: "profile".
    const WHAT: &'static str;
    /// The kind of entity whose names may be used instead of an alternative's, if there is one.
    const KIND: Option<Kind> = None;
    /// Returns all alternatives, in no particular order.
    fn all() -> Vec<Self>;
    /// Returns how a scene names this alternative.
    fn option(&self) -> ChoiceName;
}

/// The name, number and meaning of an alternative in scenes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ChoiceName {
    /// The name.
    pub name: &'static str,
    /// The number that the notes give the alternative, if any.
    pub number: Option<i64>,
    /// The meaning, in a few words.
    pub meaning: &'static str,
    /// The source position that registers the alternative.
    pub place: &'static Location<'static>,
}

impl ChoiceName {
    /// Names an alternative that the notes give no number.
    #[track_caller]
    pub const fn of(name: &'static str, meaning: &'static str) -> Self {
        Self { name, number: None, meaning, place: Location::caller() }
    }
}

/// The alternatives of one type, with the type erased.
#[derive(Clone, Copy, Debug)]
pub struct Choices {
    /// The noun for one alternative, in the singular.
    pub what: &'static str,
    /// The kind of entity whose names may be used instead of an alternative's, if there is one.
    pub kind: Option<Kind>,
    all: fn() -> Vec<ChoiceName>,
}

impl Choices {
    /// Describes the alternatives of type `T`.
    pub const fn of<T: Choice>() -> Self {
        Self { what: T::WHAT, kind: T::KIND, all: sorted::<T> }
    }

    /// Returns all alternatives: first those with numbers, in numerical order, then the others, by name.
    pub fn all(&self) -> Vec<ChoiceName> {
        (self.all)()
    }

    /// Lists all alternatives with number and name, for messages.
    pub fn listed(&self) -> String {
        let shown = |choice: ChoiceName| match choice.number {
            Some(number) => format!("{number} (`{}`)", choice.name),
            None => format!("`{}`", choice.name),
        };
        self.all().into_iter().map(shown).collect::<Vec<_>>().join(", ")
    }

    /// Finds the alternative of this name.
    pub fn named(&self, name: &str) -> Option<ChoiceName> {
        self.all().into_iter().find(|choice| choice.name == name)
    }

    /// Finds the alternative of this number.
    pub fn numbered(&self, number: i64) -> Option<ChoiceName> {
        self.all().into_iter().find(|choice| choice.number == Some(number))
    }
}

fn sorted<T: Choice>() -> Vec<ChoiceName> {
    let mut all: Vec<_> = T::all().iter().map(T::option).collect();
    all.sort_unstable_by_key(|choice| (choice.number.unwrap_or(i64::MAX), choice.name));
    all
}

/// Returns an error message for each name or number that two plugins register, with both source positions. Names of
/// alternatives that are entity types are not compared.
pub fn contradictions<T: Choice>() -> Vec<String> {
    let all = sorted::<T>();
    let mut faults = Vec::new();
    for (index, second) in all.iter().enumerate() {
        for first in &all[..index] {
            let is_same = T::KIND.is_none() && first.name == second.name;
            if is_same || (first.number.is_some() && first.number == second.number) {
                faults.push(format!(
                    "two plugins register the {} `{}` or its number, at {} and at {}: rename or renumber one of them",
                    T::WHAT,
                    second.name,
                    text::place(first.place),
                    text::place(second.place)
                ));
            }
        }
    }
    faults
}

impl Choice for Accuracy {
    const WHAT: &'static str = "accuracy";

    fn all() -> Vec<Self> {
        Self::ALL.to_vec()
    }

    fn option(&self) -> ChoiceName {
        let (name, meaning) = self.named();
        ChoiceName::of(name, meaning)
    }
}

/// Makes enums choices: each with its noun, and its alternatives with their names and meanings.
///
/// ```
/// use tabray_world::choices;
/// use tabray_world::scene::choice::Choice;
///
/// #[derive(Clone, Copy)]
/// enum Weave {
///     Plain,
///     Twill,
/// }
///
/// choices! {
///     Weave, "weave" {
///         Plain => "plain", "each thread over every other one";
///         Twill => "twill", "in diagonal ribs";
///     }
/// }
///
/// assert_eq!(Weave::Twill.option().name, "twill");
/// ```
#[macro_export]
macro_rules! choices {
    ($($Type:ident, $what:literal { $($Variant:ident => $name:literal, $meaning:literal;)* })*) => {$(
        impl $crate::scene::choice::Choice for $Type {
            const WHAT: &'static str = $what;

            fn all() -> ::std::vec::Vec<Self> {
                ::std::vec![$(Self::$Variant),*]
            }

            fn option(&self) -> $crate::scene::choice::ChoiceName {
                match self {
                    $(Self::$Variant => $crate::scene::choice::ChoiceName::of($name, $meaning),)*
                }
            }
        }
    )*};
}

choices! {
    Rules, "set of rules" {
        Notes => "notes", "the course notes': light is divided by the length of its path, up to 20 units";
        Free => "free", "linear light that does not depend on the scale of the scene";
    }
    Tone, "tone mapper" {
        Clip => "clip", "all of it is white";
        Neutral => "neutral", "compressed, by the Khronos PBR neutral tone mapper";
    }
    Transfer, "transfer function" {
        Srgb => "srgb", "the curve of sRGB, which screens expect";
        Linear => "linear", "in proportion to the light";
    }
    Falloff, "falloff" {
        None => "none", "as bright at any distance";
        Distance => "distance", "divided by the distance";
        Square => "square", "divided by the square of the distance, as that of a real lamp";
    }
}
