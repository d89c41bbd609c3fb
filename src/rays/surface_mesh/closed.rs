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
    /// Where the surface may be singular.
    pub singular: Vec<Singular>,
    /// The places where the surface may have other parts than the mesh, or may be joined differently; `None` if not
    /// examined.
    pub tangled: Option<Vec<[DVec3; 2]>>,
}

/// A place where the gradient of a surface may be 0.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Singular {
    /// Near a point.
    Point(DVec3),
    /// Along a curve between two points, through so many cells.
    Curve([DVec3; 2], usize),
    /// In so many adjoining cells between two corners: along curves that are closed or meet, or all over a part of the
    /// surface.
    Part([DVec3; 2], usize),
}
