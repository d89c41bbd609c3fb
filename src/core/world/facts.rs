//! What a shape is, wherever it is and whatever ray hits it.

use crate::geometry::aabb::Aabb;
use crate::geometry::ray::Side;
use glam::DVec3;

/// What a shape is, apart from any point and any ray.
///
/// A shape that is made of another one copies its facts, and changes those that differ: `..self.shape.facts()`.
#[derive(Clone, Copy, Debug)]
pub struct Facts {
    /// A box that contains the shape; `None` for an unbounded shape.
    pub bounds: Option<Aabb>,
    /// The largest magnitude of the shape's own coordinates that its hits are computed from, in world units. The ray's
    /// coordinates do not count.
    pub max_coordinate: f64,
    /// The sides from which a ray that leaves the shape may hit it again. From other sides, the ray is not tested against
    /// the shape. A ray that leaves a plane cannot hit it again, and a ray that leaves a sphere only from inside.
    /// [`Sides::BOTH`] is correct for every shape whose [`distance`](super::hittable::Hittable::distance) respects
    /// `range.origin_side`.
    pub can_hit_itself: Sides,
    /// Whether both sides of the surface are lit. If so, the normal is flipped to face the ray. A plane is lit on one
    /// side.
    pub is_two_sided: bool,
    /// Whether [`shading_normal`](super::hittable::Hittable::shading_normal) differs from the surface's own normal
    /// anywhere.
    pub is_smooth: bool,
    /// A point and the unit normal of the plane that contains the whole shape, if there is one: rays that leave the shape
    /// stay on their side of the plane, it is shaded with the plane's normal, and a light behind the plane does not light
    /// it. `None` is always correct.
    pub plane: Option<[DVec3; 2]>,
    /// Whether the shape ends where the camera cuts off planes
    /// ([`planes_end_at`](crate::world::camera::Camera::planes_end_at)). Its copies end at the same z of the world.
    pub ends_as_planes: bool,
    /// Whether the search for a ray's hit may take as long as several plain rays
    /// ([`search_cost`](super::hittable::Hittable::search_cost)). Shapes without bounds are not asked.
    pub may_be_costly: bool,
}

impl Facts {
    /// Returns the facts of a shape without bounds of which no more is known than its largest coordinate.
    #[inline]
    pub const fn unbounded(max_coordinate: f64) -> Self {
        Self {
            bounds: None,
            max_coordinate,
            can_hit_itself: Sides::BOTH,
            is_two_sided: false,
            is_smooth: false,
            plane: None,
            ends_as_planes: false,
            may_be_costly: false,
        }
    }

    /// Returns the facts of a shape of which no more is known than a box that contains it.
    #[inline]
    pub fn within(bounds: Aabb) -> Self {
        let max_coordinate = bounds.low.abs().max(bounds.high.abs()).max_element();
        Self { bounds: Some(bounds), ..Self::unbounded(max_coordinate) }
    }
}

/// Some of the two sides of a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sides {
    outside: bool,
    inside: bool,
}

impl Sides {
    /// Neither side.
    pub const NONE: Self = Self { outside: false, inside: false };
    /// The inside alone.
    pub const INSIDE: Self = Self { outside: false, inside: true };
    /// Both sides.
    pub const BOTH: Self = Self { outside: true, inside: true };

    /// Returns both sides where a condition holds, and neither where it does not.
    #[inline]
    pub const fn both_if(condition: bool) -> Self {
        Self { outside: condition, inside: condition }
    }

    /// Tells whether a side is one of them.
    #[inline]
    pub const fn contain(self, side: Side) -> bool {
        match side {
            Side::Outside => self.outside,
            Side::Inside => self.inside,
        }
    }

    /// Returns the sides opposite to these.
    #[inline]
    pub const fn opposite(self) -> Self {
        Self { outside: self.inside, inside: self.outside }
    }
}
