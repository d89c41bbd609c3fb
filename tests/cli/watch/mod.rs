//! `tabray watch`: the program and its page.

pub mod browser;
mod camera;
mod page;
pub mod program;
mod server;
