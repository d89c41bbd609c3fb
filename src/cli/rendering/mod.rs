//! One image being rendered: checkpoints, parts, statistics, images beside it.

pub mod aov;
pub mod bands;
pub mod debug;
pub mod flaws;
pub mod job;
pub mod overlay;
pub mod part;
pub mod part_files;
pub mod resume;
pub mod stats;
pub mod trial;
