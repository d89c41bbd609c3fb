//! One image being rendered: checkpoints, parts, statistics, images beside it.

pub mod aov;
pub mod debug;
pub mod full_range;
pub mod job;
pub mod part;
pub mod part_files;
pub mod resume;
pub mod stats;
pub mod unfinished;
