//! The ways in which pixels of a picture differ.

use super::views::View;
use tabray_core::scene::model::Model;
use tabray_core::text;

/// A kind of difference between pixels of a picture and of its image.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Mistake {
    /// The whole picture is changed in one way.
    View(View),
    /// The pixel shows another object; `None` for nothing.
    Object {
        /// The index of the object that the picture shows.
        shown: Option<usize>,
        /// The index of the object that the scene shows.
        right: Option<usize>,
    },
    /// These lights shine on an object, though other objects are in their way.
    ShadowMissing {
        /// The indices of the lights.
        lights: Vec<usize>,
        /// The index of the object.
        on: usize,
    },
    /// These lights do not shine on an object, though nothing is in their way.
    ShadowTooMuch {
        /// The indices of the lights.
        lights: Vec<usize>,
        /// The index of the object.
        on: usize,
    },
    /// The glint on an object is missing.
    GlintMissing {
        /// The index of the object.
        on: usize,
    },
    /// The glint on an object is stronger or weaker, or where there should be none.
    GlintOther {
        /// The index of the object.
        on: usize,
    },
    /// No channel differs by more than a level.
    OffByOne,
    /// No trial has this colour.
    Other,
}

impl Mistake {
    /// Returns a name of the kind of mistake.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::View(view) => view.kind(),
            Self::Object { .. } => "wrong object",
            Self::ShadowMissing { .. } => "shadow missing",
            Self::ShadowTooMuch { .. } => "too much shadow",
            Self::GlintMissing { .. } | Self::GlintOther { .. } => "glint",
            Self::OffByOne => "off by one",
            Self::Other => "other",
        }
    }

    /// Describes the mistake, in words that complete "the picture".
    pub fn words(&self, model: &Model) -> String {
        let object = |index: &usize| format!("`{}`", model.objects[*index].args.name());
        let seen = |index: &Option<usize>| index.as_ref().map_or("nothing".to_owned(), object);
        let lights =
            |lights: &[usize]| text::list(lights.iter().map(|index| model.lights[*index].args.name()));
        match self {
            Self::View(view) => view.words(),
            Self::Object { shown, right } => format!("shows {} where {} is seen", seen(shown), seen(right)),
            Self::ShadowMissing { lights: of, on } => {
                format!("has light of {} on {}, though something is in its way", lights(of), object(on))
            }
            Self::ShadowTooMuch { lights: of, on } => {
                format!("lacks light of {} on {}, though nothing is in its way", lights(of), object(on))
            }
            Self::GlintMissing { on } => format!("lacks the glint on {}", object(on)),
            Self::GlintOther { on } => format!("has another glint on {}", object(on)),
            Self::OffByOne => "differs by a level, as by rounding".to_owned(),
            Self::Other => "has other colours, which no trial explains".to_owned(),
        }
    }
}
