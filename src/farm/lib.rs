//! Subcommands for renders on many machines: `farm` writes the jobs of a scheduler, and `film` puts frames together.

mod farm;
mod film;
