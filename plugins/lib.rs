//! The entity types of tabray: one file for each, of which no other file knows.
//!
//! Each file registers what it adds. A program that links this crate, by `use tabray_plugins as _;`, has all of them; in
//! a program that does not, scenes have no entities.

include!(concat!(env!("OUT_DIR"), "/plugins.rs"));

plugins!();
