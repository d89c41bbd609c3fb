//! The hits of rays, compared with the notes' numbers, with true hits, and with the contract that every plugin keeps.

#![allow(clippy::disallowed_methods, reason = "no picture depends on what a test computes")]

#[path = "../common/mod.rs"]
mod common;
#[path = "../oracle/mod.rs"]
mod oracle;

mod arithmetic;
mod boxes;
mod cameras;
mod clips;
mod contract;
mod costs;
mod cutouts;
mod domains;
mod double_double;
mod examples;
mod implicit;
mod mesh;
mod models;
mod notes;
mod parametric;
mod places;
mod planted;
mod polynomials;
mod query;
mod ranges;
mod solids;
mod stability;
mod torus;
mod winding;
