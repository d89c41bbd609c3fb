//! The entity types of tabray: one file for each, of which no other file knows.
//!
//! Each file registers what it adds. A program that links this crate, by `use tabray_plugins as _;`, has all of them; in
//! a program that does not, scenes have no entities.

// Plugins may name the core `crate`, too: those written when it was one crate with them do.
#[allow(unused_imports, reason = "none of those here does")]
use tabray::*;

include!(concat!(env!("OUT_DIR"), "/plugins.rs"));

plugins!();

/// Links the entity types. For most systems, `use tabray_plugins as _;` does that alone; for WebAssembly, a program calls this
/// and compiles this crate as one unit (`codegen-units = 1`).
#[inline(never)]
pub fn link() {}
