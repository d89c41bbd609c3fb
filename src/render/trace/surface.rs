//! Places on one object, where the rays of a packet meet it, and what goes on from there.

use super::arrays::Vectors;
use super::light::Colours;
use crate::geometry::ray::Side;
use crate::world::material::Look;

/// Places on one object, where the rays of a packet meet it.
#[derive(Default)]
pub(super) struct Surface {
    /// The object's index.
    pub index: usize,
    pub points: Vectors,
    /// The unit normals; turned to the rays' side where both are lit.
    pub normals: Vectors,
    /// The side that each ray comes to.
    pub sides: Vec<Side>,
    /// How far the light has come from each.
    pub travelled: Vec<f64>,
    /// How far each may be from where it should be, in world units, and the most of any; empty and 0 where that makes no
    /// difference.
    pub errors: Vec<f64>,
    pub most_error: f64,
    /// What all answer to light, where that is the same.
    pub look: Option<Look>,
    /// Else what each mirrors.
    pub specular: Vectors,
    /// Whether any mirrors anything.
    pub is_mirror: bool,
}

impl Surface {
    /// Rays in these directions from its places.
    pub fn onward<'o>(&'o self, dir: &'o Vectors) -> Onward<'o> {
        let Self { index, points, sides, travelled, errors, most_error, .. } = self;
        Onward { points, dir, travelled, leaves: *index, sides, errors, most_error: *most_error }
    }

    /// What each place mirrors.
    pub fn mirrors(&self, count: usize) -> Colours<'_> {
        match self.look {
            Some(look) => Colours::Even(look.specular),
            None => Colours::Each(self.specular.view(count)),
        }
    }
}

/// Of a group's rays, by their lanes.
pub(super) struct Onward<'o> {
    pub points: &'o Vectors,
    pub dir: &'o Vectors,
    pub travelled: &'o [f64],
    /// The object that they leave.
    pub leaves: usize,
    pub sides: &'o [Side],
    /// How far those points may be from where they should be.
    pub errors: &'o [f64],
    pub most_error: f64,
}
