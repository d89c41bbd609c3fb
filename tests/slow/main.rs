//! What takes long: builds of packages with further plugins, hundreds of thousands of rays against true hits, and what is
//! measured for the docs.

#[path = "../common/mod.rs"]
mod common;
#[path = "../oracle/mod.rs"]
mod oracle;

mod accuracy;
mod copy;
mod falsify;
mod gallery;
mod performance;
mod plugins;
mod truth;
