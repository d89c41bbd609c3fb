//! A bounding volume hierarchy (BVH) of objects with boxes: the objects of a scene, or the triangles of a mesh.
//!
//! A node has up to eight children, nodes or objects, and their boxes are tested together. Each object has its own box
//! in its parent node, and so few objects are tested for rays that miss their boxes. To save memory, boxes lie on a
//! grid of 255 steps along each axis of their node (Ylitie, Karras and Laine, "Efficient Incoherent Ray Traversal on
//! GPUs Through Compressed Wide BVHs", 2017), rounded outward: 88 bytes for eight boxes, of which six are used on
//! average. Distances are in double precision. In single precision, the rounding of a ray's origin alone would widen a
//! box of 10^-6 of its distance by a tenth, and boxes of scenes at 10^6 would be indistinguishable.

mod beam;
mod bins;
mod build;
mod line;
mod nearby;
mod node;
mod packet;
mod tree;

pub use node::Order;
pub use packet::{PacketVisitor, visit};
pub use tree::{Bvh, Stack};
