//! Images and other files made from what is rendered.

pub(crate) mod aov;
pub(crate) mod aov_values;
pub(crate) mod checkpoint;
pub(crate) mod compare;
pub(crate) mod deflate;
mod filter;
pub(crate) mod full_range;
pub(crate) mod packing;
pub(crate) mod part;
pub(crate) mod picture;

pub use aov::Aov;
pub use compare::Comparison;
pub use deflate::Compression;
pub use picture::Format;
