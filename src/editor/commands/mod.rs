//! The subcommands: `fmt`, `grammar`, `lsp` and `schema`.

mod fmt;
mod grammar;
mod lsp;
mod schema;
