//! A ray tracer in which a scene is data and every entity type is a plugin.
//!
//! This library is all of tabray, with its entity types: a program that links it can read every scene. It only joins
//! crates that can also be used by themselves:
//!
//! - [`exact`] (tabray-exact): intervals, longer numbers, formulas and roots
//! - [`geometry`], [`world`], [`shapes`], [`render`] and [`output`] (tabray-core): from a model to an image
//! - [`scene`] (tabray-core, tabray-lang): the tables of entity types, the model, and the reader of scenes
//! - [`tools`] (tabray-tools) and [`cli`] (tabray-cli): proofs and contract tests; the command line
//! - guests, each with a feature of its name that is on by default: `editor`, `farm`, `import`, `measure`, `page`,
//!   `rays` and `teachers`
//! - `tabray-plugins`: the entity types, each a file in `plugins/`
//!
//! Data flows in one direction: a scene's text becomes entities, checked against the tables of their types, then a
//! [`Model`](scene::Model), then a [`Plan`](render::Plan), and tile by tile an image ([`Renderer`](render::Renderer),
//! [`Format`](output::Format)). A model can also be built without any text ([`scene::build`]), and printed again
//! ([`scene::dump`]). `docs/architecture.md` draws this flow, and the module of each step.
//!
//! A file in `plugins/` adds an entity type: it registers an [`Entity`](scene::Entity) and implements a trait of
//! [`world`]; [`prelude`] has everything that it needs. No other file mentions the type. A plugin outside of this
//! package does the same, and calls [`cli::run`] from its own `main` (see `docs/plugins.md`).

pub use tabray_cli as cli;
pub use tabray_core::{geometry, glam, output, prelude, query, render, shapes, simd, world};
pub use tabray_exact as exact;

#[cfg(not(feature = "import"))]
mod absent;

// Links the entity types and what guests add, which register themselves.
#[cfg(feature = "farm")]
use tabray_farm as _;
#[cfg(feature = "import")]
use tabray_import as _;
#[cfg(feature = "page")]
use tabray_page as _;
use tabray_plugins as _;
#[cfg(feature = "teachers")]
use tabray_teachers as _;

/// Entries for fuzzing.
#[cfg(feature = "fuzz")]
#[doc(hidden)]
pub mod fuzz {
    pub use tabray_cli::fuzz::Image;
    pub use tabray_page::fuzz::{Server, watch};
    pub use tabray_teachers::fuzz::review;
}

/// Scenes: the tables of entity types, the model that a scene becomes, and the language in which it is written.
pub mod scene {
    pub use tabray_core::scene::*;
    #[cfg(feature = "editor")]
    pub use tabray_editor::{self as editor, grammar, schema};
    pub use tabray_lang::*;
}

/// Uses of a scene beside its image, with those of the guests that are enabled.
pub mod tools {
    #[cfg(feature = "measure")]
    pub use tabray_measure::{bench, chart};
    #[cfg(feature = "rays")]
    pub use tabray_rays::{hits, surface_mesh};
    pub use tabray_tools::*;
}
