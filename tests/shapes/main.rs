//! The hits of rays: against the notes' numbers, against true ones, and against the promises of each plugin.

#[path = "../common/mod.rs"]
mod common;
#[path = "../oracle/mod.rs"]
mod oracle;

mod arithmetic;
mod contract;
mod double_double;
mod implicit;
mod mesh;
mod notes;
mod stability;
