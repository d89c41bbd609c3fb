//! The scene language: reading a scene's text as a [`Model`](tabray_core::scene::Model), writing it back, and
//! documents generated from the tables of entity types.
//!
//! ```
//! use std::path::Path;
//! use tabray_core::render::{Plan, Renderer};
//! use tabray_lang::{Registry, read};
//! // Links the entity types, which register themselves.
//! use tabray_plugins as _;
//!
//! let text = "camera eye { pixeldim 32 24  worlddim 8 6  viewpoint 4 3 6 }
//!     material red { ambient 9 0 0 }
//!     sphere ball { material red  center 4 3 -2  radius 2 }";
//! let loaded = read(Registry::get()?, "ball", Path::new(""), text.as_bytes(), None).map_err(|report| report.to_string())?;
//! let pixels = Renderer::default().picture(&Plan::new(&loaded.model));
//! // Red, green and blue, from the upper left.
//! assert_eq!(pixels.len(), 3 * 32 * 24);
//! assert_eq!(pixels[..3], [0, 0, 0]);
//! assert!(pixels[3 * (12 * 32 + 16)] > 200);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! [`build`] makes a model without any text. `cargo run -p tabray-lang --example scene` also asks for a ray's hit.

pub mod dump;
pub mod import;
pub mod list_json;
pub mod reader;
pub mod reference;
pub mod registry;
pub mod syntax;

pub use reader::{Fault, Loaded, Parsed, Place, Report, Severity, build, read};
pub use registry::Registry;
pub use syntax::Syntax;

// Tests read scenes, and so need entity types.
#[cfg(test)]
use tabray_plugins as _;

/// Returns the configuration of property tests. Failed cases are kept below `tests/`.
#[cfg(test)]
pub(crate) fn properties() -> proptest::prelude::ProptestConfig {
    use proptest::test_runner::{Config, FileFailurePersistence};
    let kept = FileFailurePersistence::SourceParallel("../tests/proptest-regressions");
    Config { failure_persistence: Some(Box::new(kept)), ..Config::default() }
}
