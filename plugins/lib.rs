//! The entity types of tabray: one file for each type. No other file knows about it.
//!
//! Each file registers what it adds. A program that links this crate, by `use tabray_plugins as _;`, has all of them; in
//! a program that does not, scenes have no entities.

// Plugins may also name the core `crate`: plugins that were written when the core and they were one crate do so.
#[allow(unused_imports, reason = "none of those here does")]
use tabray::*;

include!(concat!(env!("OUT_DIR"), "/plugins.rs"));

plugins!();

/// Links the entity types. For most systems, `use tabray_plugins as _;` does that alone; for WebAssembly, a program calls this
/// and compiles this crate as one unit (`codegen-units = 1`).
#[inline(never)]
pub fn link() {}
