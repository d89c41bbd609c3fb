//! Tests that take long: builds of packages with further plugins, hundreds of thousands of rays compared with true
//! hits, renders that are stopped midway, charts, and the measurements of the docs.

#[path = "../common/mod.rs"]
mod common;
#[path = "../oracle/mod.rs"]
mod oracle;

mod accuracy;
mod chart;
mod copy;
mod falsify;
#[cfg(feature = "fuzz")]
mod fuzz;
mod gallery;
mod habits;
mod performance;
mod plugins;
mod proven;
mod same;
mod slurm;
mod stop;
mod truth;
