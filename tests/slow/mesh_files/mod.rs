//! Small models, and the files that hold them.

pub mod bodies;
mod write;

use glam::DVec3;

/// Vertices, and the corners of flat polygons between them.
#[derive(Clone)]
pub struct Model {
    pub vertices: Vec<[f32; 3]>,
    pub faces: Vec<Vec<usize>>,
}

impl Model {
    /// Returns the model with its polygons cut into triangles at their first corners: none of them may have a dent.
    pub fn of_triangles(&self) -> Self {
        let fan = |face: &Vec<usize>| {
            let face = face.clone();
            (2..face.len()).map(move |last| vec![face[0], face[last - 1], face[last]]).collect::<Vec<_>>()
        };
        Self { vertices: self.vertices.clone(), faces: self.faces.iter().flat_map(fan).collect() }
    }

    /// Returns the number of triangles of which the polygons consist.
    pub fn count(&self) -> usize {
        self.faces.iter().map(|face| face.len() - 2).sum()
    }

    /// Returns the corners of the polygons.
    pub fn polygons(&self) -> Vec<Vec<DVec3>> {
        let at = |corner: &usize| DVec3::from(self.vertices[*corner].map(f64::from));
        self.faces.iter().map(|face| face.iter().map(at).collect()).collect()
    }

    /// Returns the low and the high corner of a box around the polygons.
    pub fn bounds(&self) -> [DVec3; 2] {
        let all = self.polygons().concat();
        [
            all.iter().copied().reduce(DVec3::min).unwrap_or(DVec3::INFINITY),
            all.iter().copied().reduce(DVec3::max).unwrap_or(DVec3::NEG_INFINITY),
        ]
    }

    /// Returns the model with every face for which a test says so turned the other way.
    pub fn turned(&self, is_turned: impl Fn(usize) -> bool) -> Self {
        let mut model = self.clone();
        let turned = model.faces.iter_mut().enumerate().filter(|(index, _)| is_turned(*index));
        turned.for_each(|(_, face)| face.reverse());
        model
    }

    /// Returns the model scaled and moved.
    pub fn placed(&self, scale: f32, by: [f32; 3]) -> Self {
        let place = |at: &[f32; 3]| [0, 1, 2].map(|axis| scale * at[axis] + by[axis]);
        Self { vertices: self.vertices.iter().map(place).collect(), faces: self.faces.clone() }
    }

    /// Returns two models as one.
    pub fn and(&self, other: &Self) -> Self {
        let before = self.vertices.len();
        let moved = |face: &Vec<usize>| face.iter().map(|corner| corner + before).collect();
        Self {
            vertices: [&self.vertices[..], &other.vertices].concat(),
            faces: self.faces.iter().cloned().chain(other.faces.iter().map(moved)).collect(),
        }
    }

    /// Returns the model with corners of its own for each face.
    pub fn in_pieces(&self) -> Self {
        let vertices = self.faces.iter().flatten().map(|corner| self.vertices[*corner]).collect();
        let mut next = 0..;
        let faces = self.faces.iter().map(|face| next.by_ref().take(face.len()).collect()).collect();
        Self { vertices, faces }
    }
}
