//! `tabray watch`: the program and its page.

#[path = "../common/mod.rs"]
mod common;

mod browser;
mod page;
mod program;
mod server;
