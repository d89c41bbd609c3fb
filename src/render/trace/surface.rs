//! The points where the rays of a packet hit one object, and the rays that continue from there.

use super::arrays::VectorList;
use super::light::Colours;
use crate::geometry::ray::Side;
use crate::world::coincidence;
use crate::world::material::Look;

/// The points where the rays of a packet hit one object.
#[derive(Default)]
pub(super) struct Surface {
    /// The object's index.
    pub index: usize,
    pub points: VectorList,
    /// The unit normals, flipped to face the rays where both sides are lit.
    pub normals: VectorList,
    /// The side that each ray hits.
    pub sides: Vec<Side>,
    /// The path length from the viewer to each point, in world units.
    pub travelled: Vec<f64>,
    /// The cosines of the angles between the rays and the normals before they are flipped, from -1 to 1.
    pub cosines: Vec<f64>,
    /// The errors of the points.
    pub errors: Errors,
    /// The reflectivities, where they are the same at all points.
    pub look: Option<Look>,
    /// The specular reflectivity at each point, where `look` is `None`.
    pub specular: VectorList,
    /// Whether the specular reflectivity is not 0 at any point.
    pub is_mirror: bool,
}

impl Surface {
    /// Returns rays from the points in these directions.
    pub fn onward<'o>(&'o self, dir: &'o VectorList) -> Onward<'o> {
        let Self { index, points, sides, travelled, cosines, errors, .. } = self;
        Onward { points, dir, travelled, origin_object: *index, sides, cosines, errors: *errors }
    }

    /// Returns a bound on the error of a point, in world units.
    pub fn error(&self, lane: usize) -> f64 {
        self.errors.of(&self.travelled, &self.cosines, lane)
    }

    /// Returns the specular reflectivities at the points.
    pub fn mirrors(&self, count: usize) -> Colours<'_> {
        match self.look {
            Some(look) => Colours::Uniform(look.specular),
            None => Colours::Each(self.specular.view(count)),
        }
    }
}

/// Rays that continue from the points where a group's rays have hit an object, in the same lanes.
pub(super) struct Onward<'o> {
    pub points: &'o VectorList,
    pub dir: &'o VectorList,
    /// The path length from the viewer to each point, in world units.
    pub travelled: &'o [f64],
    /// The index of the object that the rays leave.
    pub origin_object: usize,
    /// The side of the object that each ray leaves.
    pub sides: &'o [Side],
    /// The cosines of the angles at which the group's rays hit the points.
    pub cosines: &'o [f64],
    /// The errors of the points.
    pub errors: Errors,
}

/// Bounds on the errors of computed hit points. The bound of a single point is computed on demand.
#[derive(Clone, Copy, Default)]
pub(super) struct Errors {
    /// The largest magnitude of the coordinates that the points are computed from, in world units, without the path
    /// length; `None` where errors make no difference.
    pub reach: Option<f64>,
    /// A bound on the error of every point, in world units.
    pub most: f64,
}

impl Errors {
    /// The errors of exact points.
    pub const NONE: Self = Self { reach: None, most: 0.0 };

    /// Returns a bound on the error of one point, in world units.
    pub fn of(&self, travelled: &[f64], cosines: &[f64], lane: usize) -> f64 {
        self.reach.map_or(0.0, |reach| coincidence::error_after(travelled[lane], reach, cosines[lane]))
    }
}
