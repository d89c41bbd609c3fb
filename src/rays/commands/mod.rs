//! The subcommands: `hits`, `judge`, `hard` and `mesh`.

mod hits;
mod mesh;
