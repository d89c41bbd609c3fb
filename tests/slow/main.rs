//! Tests that take long: builds of packages with further plugins, hundreds of thousands of rays compared with true
//! hits, renders that are stopped midway, charts, and the measurements of the docs.
#![allow(clippy::disallowed_methods, reason = "no picture depends on what a test computes")]

#[path = "../common/mod.rs"]
mod common;
#[path = "../oracle/mod.rs"]
mod oracle;

mod accuracy;
mod budget;
mod chart;
mod choose;
mod copy;
mod counted;
mod emitted;
mod extremes;
mod falsify;
mod far_rays;
#[cfg(feature = "fuzz")]
mod fuzz;
mod gallery;
mod grammar;
mod habits;
mod measured;
mod mesh_files;
mod mesh_table;
mod performance;
mod placed;
mod plugins;
mod proven;
mod radiosity;
mod same;
mod secondary;
mod slurm;
mod stop;
mod trees;
mod truth;
