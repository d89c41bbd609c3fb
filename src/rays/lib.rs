//! Rays of other programs, and what they hit: the hits of lists of rays, the verdict on another program's hits, rays that
//! are hard for it, and meshes of objects. With the feature `commands`, also the subcommands.

#[cfg(feature = "commands")]
mod commands;
pub mod hits;
pub mod surface_mesh;

// Tests read scenes, and so need entity types.
#[cfg(test)]
use tabray_plugins as _;
