//! `tabray watch`: the program and its page.

mod away;
mod broken;
pub mod browser;
mod camera;
mod compare;
mod differs;
mod everybody;
mod page;
mod pictures;
pub mod program;
mod scenes;
mod server;
mod tabs;
