//! `tabray watch`: the program and its page.

mod browser;
mod page;
mod program;
mod server;
