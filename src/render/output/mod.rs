//! Images and other files made from what is rendered.

pub mod aov;
pub mod aov_values;
mod codes;
pub mod compare;
pub mod deflate;
mod filter;
pub mod full_range;
pub mod npy;
pub mod numbers;
pub mod packing;
pub mod picture;

pub use aov::Aov;
pub use compare::Comparison;
pub use deflate::Compression;
pub use picture::Format;
