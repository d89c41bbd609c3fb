//! Meshes: surfaces of triangles from a file.
//!
//! Vertices are placed in the world and rounded once, when the file is read. The triangles through the rounded vertices
//! are the surface: an edge belongs to the faces on both of its sides, so that no ray falls through between them. First
//! hits are found face by face, as for single triangles: in plain arithmetic with bounds on its errors, and with more
//! digits where the bounds leave open which face is hit, or whether any face is hit. If several faces are at the same
//! distance, the first in the file is hit.
//!
//! A closed mesh has an inside: the points around which it winds, so that its bodies may overlap and touch. Where some
//! of its faces do not bound the inside, solids and glass use the boundary of the inside instead of the mesh.

mod along;
mod approach;
mod arrays;
mod boundary;
mod creases;
mod edges;
mod face;
mod finished;
mod given_normals;
mod hits;
mod inside;
mod known;
mod memo;
mod overlap;
mod packets;
mod painted;
mod passages;
mod points;
mod proven;
pub mod read;
mod search;
mod shape;
mod smooth;
mod solid;
mod surface;
#[cfg(test)]
mod tests;
mod to_world;
mod uv;
mod winding;

pub use arrays::ArrayError;
pub use finished::Finished;
pub use painted::Painted;
pub use shape::Mesh;
pub use surface::{Look, Surface, SurfaceError};
pub use to_world::ToWorld;
pub use winding::Openness;
