//! Meshes: surfaces of triangles from a file.
//!
//! Vertices are placed in world space and rounded once, when the file is read. The triangles of the rounded vertices
//! are the surface. An edge belongs to the faces on both of its sides, and so no ray slips through between them. First
//! hits are found face by face, as for single triangles: in `f64` arithmetic with error bounds, and with more digits
//! where the bounds do not decide which face is hit, or whether any is hit. Of several faces at the same distance, the
//! first in the file is hit.
//!
//! A closed mesh has an inside: the points with a nonzero winding number. Its bodies may overlap and touch. If some of
//! its faces do not bound the inside, solids and glass use the boundary of the inside instead of the mesh.

mod along;
mod approach;
mod arrays;
mod boundary;
mod creases;
mod edges;
mod exactly;
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
pub mod read;
mod search;
mod shape;
mod smooth;
mod solid;
mod sorts;
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
pub use sorts::{Sort, sorts};
pub use surface::{Look, Surface, SurfaceError};
pub use to_world::ToWorld;
pub use winding::Openness;
