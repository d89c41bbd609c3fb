//! The contents of a mesh, and the proofs about it.

use glam::DVec3;

/// A closed mesh of an object.
pub struct SurfaceMesh {
    /// The vertices, in world units; each coordinate is a number of single precision, as files have them.
    pub vertices: Vec<DVec3>,
    /// The triangles, counterclockwise seen from outside.
    pub faces: Vec<[u32; 3]>,
    /// The side of the cells.
    pub cell: f64,
    /// The places where it is not proven that the surface and the mesh are near each other: low and high corners.
    pub far: Vec<[DVec3; 2]>,
    /// Points near which the surface may be singular.
    pub singular: Vec<DVec3>,
    /// The places where the surface may have other parts than the mesh, or may be joined differently; `None` if not
    /// examined.
    pub tangled: Option<Vec<[DVec3; 2]>>,
}
