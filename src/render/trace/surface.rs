//! Places on one object, where the rays of a packet meet it, and what goes on from there.

use super::arrays::VectorList;
use super::light::Colours;
use crate::geometry::ray::Side;
use crate::world::coincidence;
use crate::world::material::Look;

/// Places on one object, where the rays of a packet meet it.
#[derive(Default)]
pub(super) struct Surface {
    /// The object's index.
    pub index: usize,
    pub points: VectorList,
    /// The unit normals; turned to the rays' side where both are lit.
    pub normals: VectorList,
    /// The side that each ray comes to.
    pub sides: Vec<Side>,
    /// How far the light has come from each.
    pub travelled: Vec<f64>,
    /// The cosines of the angles between the rays and the normals.
    pub cosines: Vec<f64>,
    /// What the places are computed from, and how far any may be from where it should be; see [`Errors`].
    pub errors: Errors,
    /// What all answer to light, where that is the same.
    pub look: Option<Look>,
    /// Else what each mirrors.
    pub specular: VectorList,
    /// Whether any mirrors anything.
    pub is_mirror: bool,
}

impl Surface {
    /// Rays in these directions from its places.
    pub fn onward<'o>(&'o self, dir: &'o VectorList) -> Onward<'o> {
        let Self { index, points, sides, travelled, cosines, errors, .. } = self;
        Onward { points, dir, travelled, origin_object: *index, sides, cosines, errors: *errors }
    }

    /// How far one of the places may be from where it should be, in world units.
    pub fn error(&self, lane: usize) -> f64 {
        self.errors.of(&self.travelled, &self.cosines, lane)
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
    pub points: &'o VectorList,
    pub dir: &'o VectorList,
    pub travelled: &'o [f64],
    /// The object that they leave.
    pub origin_object: usize,
    pub sides: &'o [Side],
    /// The cosines of the angles at which the rays came there, and how far the points may be from where they should be.
    pub cosines: &'o [f64],
    pub errors: Errors,
}

/// How far points where rays have come to a surface may be from where they should be: that of one is only computed where
/// it is asked for.
#[derive(Clone, Copy, Default)]
pub(super) struct Errors {
    /// How large the coordinates are that the points are computed from, the rays' ways apart; nothing where errors make no
    /// difference.
    pub reach: Option<f64>,
    /// The most that any may be off, in world units.
    pub most: f64,
}

impl Errors {
    /// Of points that are what they are.
    pub const NONE: Self = Self { reach: None, most: 0.0 };

    /// That of one of some points, in world units.
    pub fn of(&self, travelled: &[f64], cosines: &[f64], lane: usize) -> f64 {
        self.reach.map_or(0.0, |reach| coincidence::error_after(travelled[lane], reach, cosines[lane]))
    }
}
