//! Meshes of objects: closed surfaces of triangles. Intervals prove that each point of the mesh is near the object's
//! surface, and each point of the surface near the mesh.
//!
//! The object answers one question: whether a cube lies inside of it, outside, or neither for certain. A cube around
//! the object is halved along each axis until cells that the surface may cross are small. Their corners are inside or
//! outside, and each cell is cut into six tetrahedra (H. Freudenthal's, which match from cell to cell). In each of
//! them, triangles separate the corners inside from those outside. Whatever the corners are, these triangles form
//! closed two-manifolds. Their vertices are moved along the cells' edges onto the surface. Proofs about the result
//! hold however it was made. Where they fail, cells are halved again, until they are smaller than the error.

mod body;
mod cells;
mod closed;
mod file;
mod proof;
#[cfg(test)]
mod tests;
mod triangles;

pub use body::{Body, NoBody};
pub use closed::SurfaceMesh;
pub use file::Format;

use cells::Cells;
use glam::DVec3;
use proof::Proof;
use triangles::Triangles;

/// The least number of times that the cube is halved: a body is not missed between corners far apart.
const FEWEST: u32 = 4;

/// The largest number of times: numbers of the files have 24 bits.
const MOST: u32 = 16;

/// The maximum number of cells that the surface may cross, and the approximate number of bytes that each takes with
/// its triangles.
const MOST_CELLS: usize = 1 << 22;
const CELL: u64 = 400;

/// The reason why there is no mesh.
#[derive(Debug, PartialEq)]
pub enum NoMesh {
    /// No corner of a cell, however small, is inside the object: it may be empty.
    Empty,
    /// More cells than allowed are needed; the smallest error for which the allowed cells suffice, approximately.
    TooMany(f64),
    /// The error is too small for numbers of single precision.
    TooFine,
    /// The mesh is not closed: a fault of the program.
    Open,
}

/// Makes a mesh of a body. Each point of the mesh is at most `error` world units from the surface, and each point of
/// the surface from the mesh, except at the places that the result lists. `memory` is about the most memory that it
/// may take, in bytes, if that is limited.
///
/// # Errors
/// Returns why there is no mesh.
pub fn mesh(body: &Body<'_>, error: f64, memory: Option<u64>) -> Result<SurfaceMesh, NoMesh> {
    let most = memory.map_or(MOST_CELLS, |bytes| MOST_CELLS.min((bytes / CELL) as usize));
    let mut cells = Cells::around(body);
    let last = cells.halvings_to(error);
    if last > MOST {
        return Err(NoMesh::TooFine);
    }
    loop {
        cells.halve(body, most).map_err(|()| NoMesh::TooMany(2.0 * cells.diagonal()))?;
        let is_last = cells.halvings() >= last.max(FEWEST);
        if cells.halvings() < FEWEST {
            continue;
        }
        let triangles = Triangles::of(&cells, body);
        if triangles.faces.is_empty() {
            if is_last {
                return Err(NoMesh::Empty);
            }
            continue;
        }
        let Proof { far, tangled } = proof::of(&cells, &triangles, body, error, is_last);
        let is_proven = far.is_empty() && tangled.as_ref().is_none_or(Vec::is_empty);
        if !(is_proven || is_last) {
            continue;
        }
        if !triangles.is_closed() {
            return Err(NoMesh::Open);
        }
        let Triangles { vertices, faces, .. } = triangles;
        let vertices = vertices.into_iter().map(|vertex| vertex.at).collect();
        return Ok(SurfaceMesh { vertices, faces, cell: cells.side(), far, tangled });
    }
}

impl SurfaceMesh {
    /// Returns the volume inside, in cubic world units.
    pub fn volume(&self) -> f64 {
        // Around the first vertex, so a body far from the origin loses no digits.
        let origin = self.vertices.first().copied().unwrap_or(DVec3::ZERO);
        let volume = |face: &[u32; 3]| {
            let [a, b, c] = face.map(|corner| self.vertices[corner as usize] - origin);
            a.dot(b.cross(c)) / 6.0
        };
        self.faces.iter().map(volume).sum()
    }
}
