//! The subcommands: `bench`, `chart` and `choose`.

mod bench;
mod chart;
mod choose;
