//! Meshes from arrays of numbers, without a file.

use super::read::Model;
use super::surface::{Look, Surface, SurfaceError};
use super::to_world::ToWorld;
use glam::DVec3;
use std::fmt;
use tabray_world::geometry::placement::Rotation;
use tabray_world::parallel;

/// The reason why arrays do not make a surface.
#[derive(Debug, PartialEq)]
pub enum ArrayError {
    /// The first face with a corner that is not a vertex: the index of the face, the index of the corner in it, and the
    /// number given there.
    Corner(usize, usize, u32),
    /// The first vertex that is not finite, by its index.
    NotFinite(usize),
    /// These triangles do not make a surface, for this reason.
    Surface(&'static str),
}

impl fmt::Display for ArrayError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Corner(face, corner, index) => {
                write!(f, "corner {corner} of face {face} is {index}, which is not the index of a vertex")
            }
            Self::NotFinite(vertex) => write!(f, "vertex {vertex} is not finite"),
            Self::Surface(why) => write!(f, "the mesh {why}"),
        }
    }
}

impl Surface {
    /// Makes the surface of triangles, given by the indices of their vertices. Coordinates and the orientations of
    /// faces stay as they are.
    ///
    /// ```
    /// use glam::DVec3;
    /// use tabray_shapes::mesh::{ArrayError, Surface};
    ///
    /// let corners = || vec![DVec3::ZERO, DVec3::X, DVec3::Y];
    /// assert_eq!(Surface::of_arrays(corners(), vec![[0, 1, 2]]).map(|surface| surface.face_count()), Ok(1));
    /// assert_eq!(Surface::of_arrays(corners(), vec![[0, 1, 3]]).err(), Some(ArrayError::Corner(0, 2, 3)));
    /// ```
    ///
    /// # Errors
    /// Returns the reason why there is no surface.
    pub fn of_arrays(vertices: Vec<DVec3>, faces: Vec<[u32; 3]>) -> Result<Self, ArrayError> {
        let first = |vertex: usize| !vertices[vertex].is_finite();
        if let Some(vertex) = parallel::find_first(vertices.len(), first) {
            return Err(ArrayError::NotFinite(vertex));
        }
        let is_none = |index: &u32| *index as usize >= vertices.len();
        if let Some(face) = parallel::find_first(faces.len(), |face| faces[face].iter().any(is_none)) {
            let corner = faces[face].iter().position(is_none).unwrap_or(0);
            return Err(ArrayError::Corner(face, corner, faces[face][corner]));
        }
        Self::of_checked(vertices, faces, Look::default())
    }

    /// Returns vertices and faces that make this surface again. A face that was left out, as it has no area, has one
    /// vertex as all of its corners.
    pub fn to_arrays(&self) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let count = self.order.iter().max().map_or(0, |last| *last as usize + 1);
        let mut faces = vec![[0; 3]; count];
        for (face, order) in self.faces.iter().zip(&self.order) {
            faces[*order as usize] = *face;
        }
        (self.vertices.clone(), faces)
    }

    /// Returns this surface with the faces of each part oriented consistently, as most of them are. Surfaces read from
    /// files are oriented in the same way.
    ///
    /// # Errors
    /// Returns the reason why there is no surface.
    pub fn turned_alike(&self) -> Result<Self, ArrayError> {
        let look = Look { crease: None, is_two_sided: true };
        Self::of_checked(self.vertices.clone(), self.faces.clone(), look)
    }

    fn of_checked(vertices: Vec<DVec3>, faces: Vec<[u32; 3]>, look: Look) -> Result<Self, ArrayError> {
        let placement = ToWorld::new(DVec3::ONE, Rotation::NONE, DVec3::ZERO);
        let model = Model { vertices, faces, ..Model::default() };
        let refused = |error: SurfaceError| ArrayError::Surface(error.message().0);
        Self::new(model, &placement, look).map_err(refused)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_surface_is_made_again_from_its_arrays() {
        let corners = vec![DVec3::ONE, DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let faces = vec![[1, 2, 3], [2, 2, 4], [4, 3, 2], [1, 4, 2]];
        let surface = Surface::of_arrays(corners.clone(), faces.clone()).expect("a surface");
        let (vertices, again) = surface.to_arrays();
        let triangle = |vertices: &[DVec3], face: [u32; 3]| face.map(|corner| vertices[corner as usize]);
        for index in [0, 2, 3] {
            assert_eq!(triangle(&vertices, again[index]), triangle(&corners, faces[index]), "face {index}");
        }
        let other = Surface::of_arrays(vertices, again).expect("a surface");
        assert_eq!(
            (&other.vertices, &other.faces, &other.order),
            (&surface.vertices, &surface.faces, &surface.order)
        );
    }

    #[test]
    fn what_makes_no_surface_is_told_with_its_first_place() {
        let corners = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let error = |vertices: &[DVec3], faces: &[[u32; 3]]| {
            Surface::of_arrays(vertices.to_vec(), faces.to_vec()).err().map(|error| error.to_string())
        };
        assert_eq!(error(&corners, &[[0, 1, 2], [1, 2, 3]]), None);
        let told = error(&corners, &[[0, 1, 2], [0, 7, 9], [8, 0, 0]]);
        assert_eq!(told.as_deref(), Some("corner 1 of face 1 is 7, which is not the index of a vertex"));
        let told = error(&[DVec3::X, DVec3::NAN], &[[0, 1, 0]]);
        assert_eq!(told.as_deref(), Some("vertex 1 is not finite"));
        let told = error(&corners, &[[0, 1, 1]]);
        assert_eq!(told.as_deref(), Some("the mesh has no face with an area"));
        assert_eq!(error(&corners, &[]).as_deref(), Some("the mesh has no face with an area"));
    }
}
