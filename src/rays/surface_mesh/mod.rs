//! Meshes of objects: closed surfaces of triangles. Intervals prove that each point of the mesh is near the object's
//! surface, and each point of the surface near the mesh.
//!
//! The object answers one question: whether a cube lies inside of it, outside, or neither for certain. A cube around
//! the object is halved along each axis until cells that the surface may cross are small. Their corners are inside or
//! outside, and each cell is cut into six tetrahedra (H. Freudenthal's, which match from cell to cell). In each of
//! them, triangles separate the corners inside from those outside. Whatever the corners are, these triangles form
//! closed two-manifolds. Their vertices are moved along the cells' edges onto the surface. Proofs about the result
//! hold wherever they are. Where they fail, cells are halved again, until they are smaller than the error, unless
//! all that fails is how parts are joined at places that smaller cells would not untangle. Half of the error is for
//! these triangles. The other half is for merging them to fewer, except near the cells where only the whole suffices.

mod body;
mod cells;
mod closed;
mod crossing;
mod file;
mod merge;
mod proof;
#[cfg(test)]
mod tests;
mod thick;
mod triangles;

pub use body::{Body, NoBody};
pub use closed::{Singular, SurfaceMesh};
pub use file::Format;
pub use thick::Sheet;

use cells::Cells;
use glam::DVec3;
use merge::{ROUNDS, merged};
use thick::Thick;
use triangles::Triangles;

/// The least number of times that the cube is halved: a body is not missed between corners far apart.
const MIN_HALVINGS: u32 = 4;

/// The largest number of times: numbers of the files have 24 bits.
const MAX_HALVINGS: u32 = 16;

/// The number of halvings after which the work is estimated, which takes no noticeable time.
const PILOT: u32 = 5;

/// The maximum number of cells that the surface may cross, and the approximate number of bytes that each takes with
/// its triangles.
const MAX_CELLS: usize = 1 << 22;
const CELL: u64 = 700;

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

/// About how many vertices each cell has that a surface crosses.
const VERTICES: usize = 3;

/// The number of cells of which a mesh takes a noticeable time.
const MANY_CELLS: usize = 1 << 14;

/// The part of an error that remains for triangles whose corners are a little off the surface.
const MOST_OF: f64 = 0.99;

/// What is told while a mesh is made.
#[derive(Clone, Copy, Debug)]
pub enum Event {
    /// Most of the work is about to begin. A mesh that takes little time is made without this.
    Expected {
        /// About how many triangles are to be made, before they are merged; `None` while points of a surface are looked
        /// for.
        triangles: Option<usize>,
        /// In about how many steps.
        steps: usize,
    },
    /// So many steps are done.
    Done(usize),
}

/// Counts steps as done.
type Done<'a> = &'a (dyn Fn(usize) + Sync);

/// Makes a mesh of a body. Each point of the mesh is at most `error` world units from the surface, and each point of
/// the surface from the mesh, except at the places that the result lists. `memory` is about the most memory that it
/// may take, in bytes, if that is limited.
///
/// # Errors
/// Returns why there is no mesh.
pub fn mesh(
    body: &Body<'_>,
    error: f64,
    memory: Option<u64>,
    tell: &(dyn Fn(Event) + Sync),
) -> Result<SurfaceMesh, NoMesh> {
    let most = memory.map_or(MAX_CELLS, |bytes| MAX_CELLS.min((bytes / CELL) as usize));
    let mut cells = Cells::enclosing(&body.bounds);
    let may_be_crossed = |middle: DVec3, half: f64| body.contains(middle, half).is_none();
    let last = cells.halvings_to(error);
    if last > MAX_HALVINGS {
        return Err(NoMesh::TooFine);
    }
    let last = last.max(MIN_HALVINGS);
    let done = |steps: usize| tell(Event::Done(steps));
    if let Some(thick) = body.thick() {
        return of_distance(body, thick, error, most, tell);
    }
    loop {
        cells.halve(&may_be_crossed, most, &done).map_err(|()| NoMesh::TooMany(2.0 * cells.diagonal()))?;
        let now = cells.halvings();
        if now < MIN_HALVINGS {
            continue;
        }
        if cells.list.is_empty() {
            return Err(NoMesh::Empty);
        }
        let tangled = proof::tangled(&cells, body, &done);
        let stays = |of: &Vec<usize>| proof::stays_tangled(&cells, of, body, last - now);
        let may_end = now == last || tangled.as_ref().is_none_or(stays);
        if !may_end && now != PILOT {
            continue;
        }
        let triangles = Triangles::of(&cells, body, &done);
        if triangles.faces.is_empty() {
            if now == last {
                return Err(NoMesh::Empty);
            }
            continue;
        }
        if may_end {
            // The other half of the error is for merging.
            let far = proof::far(&cells, &triangles, body, (error / 2.0, now == last), &done);
            if now == last || far.is_empty() {
                return finished(&cells, triangles, body, (error, far), tangled, &done);
            }
        }
        if now == PILOT {
            tell(expected(&cells, &triangles, body, error, last));
        }
    }
}

/// Makes the mesh of the points near a surface, without a search for cells that suffice. First, these are as large as they
/// may be where the body's border is smooth. Where its parts meet at an edge, they are made anew, so small that no point
/// of a triangle is farther from a corner than the error, and its distance from the surface differs by no more.
fn of_distance(
    body: &Body<'_>,
    thick: &Thick,
    error: f64,
    most: usize,
    tell: &(dyn Fn(Event) + Sync),
) -> Result<SurfaceMesh, NoMesh> {
    let may_be_crossed = |middle: DVec3, half: f64| body.contains(middle, half).is_none();
    let done = |steps: usize| tell(Event::Done(steps));
    let triangles_in = |diagonal: f64, least_error: &dyn Fn(f64) -> f64| {
        let mut cells = Cells::enclosing(&body.bounds);
        let last = cells.fit(MOST_OF * diagonal);
        while cells.halvings() < last {
            cells
                .halve(&may_be_crossed, most, &done)
                .map_err(|()| NoMesh::TooMany(least_error(cells.diagonal())))?;
        }
        if cells.list.len() > MANY_CELLS {
            let vertices = VERTICES * cells.list.len();
            let steps = vertices * (1 + ROUNDS as usize);
            tell(Event::Expected { triangles: Some(2 * vertices), steps });
        }
        let triangles = Triangles::of(&cells, body, &done);
        if triangles.faces.is_empty() { Err(NoMesh::Empty) } else { Ok((cells, triangles)) }
    };
    let (mut cells, mut triangles) =
        triangles_in(thick.smooth_diagonal(error / 2.0), &|diagonal| thick.smooth_error(diagonal))?;
    let mut far = Vec::new();
    if !thick.is_near(&triangles, error / 2.0) {
        (cells, triangles) = triangles_in(3f64.sqrt() * error / 2.0, &|diagonal| 2.0 * diagonal)?;
        far = proof::large(&cells, &triangles, error / 2.0);
    }
    finished(&cells, triangles, body, (error, far), None, &done)
}

/// Estimates the work, from the errors with which these cells would do: halved once, they do with a quarter of the error
/// where the surface is smooth, and with half of it at edges.
fn expected(cells: &Cells, triangles: &Triangles, body: &Body<'_>, error: f64, last: u32) -> Event {
    let (most, gain) = (last - cells.halvings(), if body.has_edges { 1 } else { 2 });
    let suffices = |more: &u32| {
        let error = error / 2.0 * f64::from(1 << (gain * more));
        proof::far(cells, triangles, body, (error, false), &|_| ()).is_empty()
    };
    let more = (1..most).find(suffices).unwrap_or(most);
    let (growth, count) = (4usize.pow(more), cells.list.len());
    // Each size of cells is four times the work of the size before: a third is added for all of them. A cell is halved,
    // and examined four times. The last triangles are merged.
    let vertices = triangles.vertices.len();
    let steps =
        (growth - 1) * 4 / 3 * (count / 4 + 4 * count + vertices) + growth * vertices * ROUNDS as usize;
    Event::Expected { triangles: Some(growth * triangles.faces.len()), steps }
}

/// Returns a mesh with fewer triangles, and the cells in which its proof fails. It is known to be within half of the
/// error, except in these cells.
fn finished(
    cells: &Cells,
    triangles: Triangles,
    body: &Body<'_>,
    (error, coarse): (f64, Vec<usize>),
    tangled: Option<Vec<usize>>,
    done: Done<'_>,
) -> Result<SurfaceMesh, NoMesh> {
    let far = if coarse.is_empty() {
        coarse.clone()
    } else {
        proof::far(cells, &triangles, body, (error, true), done)
    };
    let mut fixed = vec![false; triangles.vertices.len()];
    for face in proof::beside(cells, coarse).into_iter().flat_map(|cell| triangles.of_cells[cell].clone()) {
        triangles.faces[face as usize].iter().for_each(|corner| fixed[*corner as usize] = true);
    }
    let triangles = merged(&triangles, fixed, error / 2.0, done);
    if !triangles.is_closed() {
        return Err(NoMesh::Open);
    }
    let places = |of: Vec<usize>| of.into_iter().map(|cell| cells.cube(cell)).collect::<Vec<_>>();
    let Triangles { vertices, faces, .. } = triangles;
    let vertices = vertices.into_iter().map(|vertex| vertex.at).collect();
    let (mut far, tangled) = (places(far), tangled.map(places));
    far.extend_from_slice(&body.doubtful);
    Ok(SurfaceMesh {
        vertices,
        faces,
        cell: cells.side(),
        far,
        singular: proof::singular(cells, body),
        tangled,
    })
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
