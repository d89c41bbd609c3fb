//! `--root`, `--max-memory` and `--time-limit`, for every command: the files that a scene may use, the memory and the time
//! that it may take.

use super::failure::Failure;
use super::{memory, time_limit};
use bytesize::ByteSize;
use std::path::PathBuf;
use std::time::Duration;
use tabray_core::{files, text};

/// The files, the memory and the time that a command may use.
#[derive(clap::Args)]
#[group(skip)]
#[command(next_help_heading = "Limits")]
pub struct Args {
    /// Read and write nothing outside of this folder: no scene, included file, texture, mesh or image, not even through
    /// a link
    #[arg(long, global = true, value_name = "DIR")]
    root: Option<PathBuf>,
    /// Take at most this memory, such as 200MiB, and refuse scenes, textures and meshes that need more; by default half
    /// of the machine's memory. A render first holds less of the image at a time, and if that is not enough, it stops
    /// like Ctrl-C
    #[arg(long, global = true, value_name = "SIZE", value_parser = size)]
    max_memory: Option<ByteSize>,
    /// Stop after this time, such as 90s, 5m or 1.5h, like Ctrl-C. A render then writes the finished part, and beside it
    /// a checkpoint for --resume; `chart` and `verify --colours` show what is done. The time includes reading the scene
    /// and writing the image. By default, `choose` takes up to 30s and `chart` 2m
    #[arg(long, global = true, value_name = "TIME", value_parser = time_limit::time)]
    time_limit: Option<Duration>,
}

impl Args {
    /// Keeps to the bounds from here on.
    pub fn keep(&self) -> Result<(), Failure> {
        memory::limit(self.max_memory);
        self.time_limit.into_iter().for_each(time_limit::set);
        let Some(root) = &self.root else { return Ok(()) };
        files::confine(root).map_err(|error| {
            let reason = text::reason(&error);
            Failure::usage(format!("cannot keep to the folder `{}`: {reason}", text::shown(root)))
        })
    }
}

fn size(text: &str) -> Result<ByteSize, String> {
    text.parse().map_err(|_| "give a size as `200MiB` or `1.5GiB`".to_owned())
}
