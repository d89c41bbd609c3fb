//! Shapes: the traits that a plugin implements, each for one ray.
//!
//! [`Hittable`] is all that a shape needs. A shape opts into faster methods with [`Bracketed`] and into proofs with
//! [`Certified`], and declares both to [`Shape`].

use crate::certify::{Assumption, Equation};
use crate::coincidence;
use crate::geometry::aabb::Aabb;
use crate::geometry::facet::Facet;
use crate::geometry::ray::{Bracket, Ray, RayBall, RayRange, Side};
use crate::geometry::ray_packet::RayPacket;
use crate::luminous::Luminous;
use glam::{DMat3, DVec2, DVec3};
use std::marker::PhantomData;
use tabray_exact::double_double::DoubleDouble;
use tabray_exact::roots::Method;

/// The surface where a ray hits a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfaceHit {
    /// The outward unit normal.
    pub normal: DVec3,
    /// The coordinates u and v, where the shape has some.
    pub uv: Option<DVec2>,
    /// The index of the face, from 0, where the shape has several.
    pub face: Option<u32>,
}

/// A shape that rays can hit. Shapes do not change while an image is rendered.
///
/// A plugin implements `distance`, `normal` and `facts`, and overrides other methods if it knows more than their
/// defaults. Each default is correct for every shape.
pub trait Hittable: Send + Sync {
    /// Returns the distance from the ray's origin to its first hit of the shape within the range, in world units, or
    /// [`MISS`](crate::geometry::ray::MISS).
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64;

    /// Returns the unit normal at a point of the surface.
    fn normal(&self, at: DVec3) -> DVec3;

    /// Returns the properties of the shape that depend on no point and no ray.
    fn facts(&self) -> Facts;

    /// Returns the unit normal for shading at a point of the surface, where it differs from the surface's own: a mesh
    /// may look smooth. `normal` is that of the surface, flipped to face the ray where both sides are lit.
    #[inline]
    fn shading_normal(&self, _at: DVec3, normal: DVec3) -> DVec3 {
        normal
    }

    /// Returns a bounding box of the image of the shape under a linear map, up to rounding, if the shape knows one that
    /// is tighter than that of the corners of its box.
    fn bounds_after(&self, _linear: &DMat3) -> Option<Aabb> {
        None
    }

    /// Says why the surface is not closed, phrased to follow "is not a closed shape: "; `None` for a closed surface,
    /// whose normal points outward and whose equation, if it has one, is below 0 inside. Only closed shapes can be
    /// parts of solids.
    fn why_not_closed(&self) -> Option<&str> {
        Some("it has no inside")
    }

    /// Describes how hits are found, in a few words, for the plan of a scene.
    fn method(&self) -> String {
        "its own distance".to_owned()
    }

    /// Names the part of the shape that a ray hits at a distance in world units, for explanations: `face 7` of a mesh.
    /// `None` for a shape of one part.
    fn part(&self, _ray: &Ray, _distance: f64) -> Option<String> {
        None
    }

    /// Returns the coordinates u and v of a point of the surface, for shaders, such as the longitude and the latitude
    /// of a sphere. They are from 0 to 1 on a whole shape. `None` for a shape that has none.
    fn uv(&self, _at: DVec3) -> Option<DVec2> {
        None
    }

    /// Returns the index of the face on which a point of the surface lies, for shaders, from 0. `None` for a shape of
    /// one face.
    fn face(&self, _at: DVec3) -> Option<u32> {
        None
    }

    /// Returns the curvature of the surface at one of its points, for shaders; `None` for a shape that is given by no
    /// formula.
    fn curvature(&self, _at: DVec3) -> Option<Curvature> {
        None
    }

    /// Returns the index of the face that a ray hits at a distance in world units, from 0. `None` for a shape of one
    /// face.
    fn face_hit(&self, ray: &Ray, distance: f64) -> Option<u32> {
        self.face(ray.at(distance))
    }

    /// Passes to a function the numbers that proofs about the shape treat as exact, although they were computed from
    /// the numbers of the scene and rounded.
    fn assumes(&self, _each: &mut dyn FnMut(Assumption)) {}

    /// Passes the bytes that the shape has read from files beside the scene to a function: a part of an image can only
    /// be continued with the same bytes.
    fn read_from_files(&self, _each: &mut dyn FnMut(&[u8])) {}

    /// Tells whether no part of the shape lies in a region, which may be unbounded. The default asks the bounding box;
    /// an unbounded shape may know more. `false` is always correct.
    fn is_clear_of(&self, region: &Aabb) -> bool {
        self.facts().bounds.is_some_and(|bounds| !bounds.overlaps(region))
    }

    /// Returns the cost of the search for a ray's hit, in plain rays, beyond the ray itself. It depends only on the
    /// ray, and on the side of the shape that the ray leaves, if it does.
    fn search_cost(&self, _ray: &Ray, _origin_side: Option<Side>) -> u32 {
        0
    }

    /// Returns a lower bound on the distance from a point to the shape, in world units, or `None` where the bounding
    /// box gives as good a bound.
    fn clearance(&self, _from: DVec3) -> Option<f64> {
        None
    }

    /// Returns the whole surface as rays aim at it where it gives light; `None` where only chance is to meet it, which
    /// is always correct.
    fn luminous(&self) -> Option<Luminous> {
        None
    }
}

/// The curvature of a surface that is given by a formula, at a point. A value that does not exist there, as at the
/// tip of a cone, is NaN or infinite.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Curvature {
    /// The length of the formula's gradient.
    pub gradient: f64,
    /// The mean of the two principal curvatures, per unit of length. It is above 0 where the surface bends like a
    /// sphere seen from outside.
    pub mean: f64,
    /// The product of the principal curvatures, the Gaussian curvature: below 0 on a saddle.
    pub gauss: f64,
}

/// A shape whose [`distance`](Hittable::distance) is expensive, and which can quickly bracket it.
///
/// Branch-free arithmetic on several rays at a time uses the brackets to find the shape that each ray may hit first.
/// The exact distance is then computed only for that shape.
pub trait Bracketed: Hittable {
    /// Whether [`t_bounds_each`](Self::t_bounds_each) takes less time than rays one by one.
    const BY_BEAMS: bool = false;

    /// Returns a bracket of the [`distance`](Hittable::distance) of each ray that this one stands for. In the world,
    /// that is the ray itself; in a copy's coordinates, all rays within its error.
    ///
    /// Where the ray may start on the shape, because the shape touches the origin within the range's `origin_error`,
    /// the bracket has no certain upper end.
    fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket;

    /// Computes a bracket of the first hit of each of up to [`BEAM`](crate::geometry::ray_packet::BEAM) rays, each in
    /// its own range.
    fn t_bounds_each(&self, rays: RayPacket, ranges: &[RayRange], brackets: &mut [Bracket]) {
        rays.each(ranges, brackets, |ray, range| self.t_bounds(ray, range));
    }

    /// Returns the distance that [`distance`](Hittable::distance) returns, to the last bit, for a ray whose hit a
    /// bracket has found for certain, or NaN where it takes more than plain arithmetic. For other rays it need not
    /// detect a miss. `origin_side` is the side of the shape that the ray starts on, if it starts on the shape.
    fn refine(&self, ray: &Ray, origin_side: Option<Side>) -> f64;

    /// Tells whether eight rays certainly miss the shape, where that is known in less time than their brackets.
    #[inline(always)]
    fn is_missed_by(&self, _rays: RayPacket) -> bool {
        false
    }

    /// Writes the result of [`refine`](Self::refine) for each ray of a packet, if that takes less time for all of them than
    /// one by one, and tells whether it did.
    #[inline(always)]
    fn refine_each(&self, _rays: RayPacket, _out: &mut [f64]) -> bool {
        false
    }
}

/// A shape given by an equation, by which its hits can be proven.
pub trait Certified: Hittable + Equation {
    /// Tells whether a point lies on the surface, up to an error in world units and to the rounding of the shape's own
    /// numbers. Rays that start at such a point leave the shape.
    fn is_on_surface(&self, at: DVec3, error: f64) -> bool {
        coincidence::is_on_surface(self, at, error)
    }

    /// Returns the plane that contains all of a closed shape's surface within an error, in world units, of a point;
    /// `None` where the surface is curved, has an edge there, or where that is not known.
    fn facet(&self, _at: DVec3, _error: f64) -> Option<Facet> {
        None
    }

    /// Returns the distance of the hit near `distance` in double-double arithmetic, which tells which of two coincident
    /// surfaces is nearer. Returns `None` where no such distance can be computed.
    fn fine_distance(&self, ray: &Ray, distance: f64) -> Option<DoubleDouble> {
        coincidence::distance(self, ray, distance)
    }

    /// Returns the distance by another root-finding method, for comparison; `None` where the shape's hits are not the roots
    /// of a function along the ray, or are found in closed form.
    fn distance_by(&self, _method: Method, _ray: &Ray, _range: &RayRange) -> Option<f64> {
        None
    }
}

/// The properties of a shape that depend on no point and no ray.
///
/// A shape that is made of another one copies its facts, and changes those that differ: `..self.shape.facts()`.
#[derive(Clone, Copy, Debug)]
pub struct Facts {
    /// A box that contains the shape up to rounding, by which the box is widened wherever it counts
    /// ([`widened`](Self::widened)); `None` for an unbounded shape.
    pub bounds: Option<Aabb>,
    /// The largest magnitude of the shape's own coordinates that its hits are computed from, in world units. The ray's
    /// coordinates do not count.
    pub max_coordinate: f64,
    /// The sides from which a ray that leaves the shape may hit it again. From other sides, the ray is not tested
    /// against the shape. A ray that leaves a plane cannot hit it again, and a ray that leaves a sphere only from
    /// inside. [`Sides::BOTH`] is correct for every shape whose [`distance`](Hittable::distance) respects
    /// `range.origin_side`.
    pub can_hit_itself: Sides,
    /// Whether both sides of the surface are lit. If so, the normal is flipped to face the ray. A plane is lit on one
    /// side.
    pub is_two_sided: bool,
    /// Whether [`shading_normal`](Hittable::shading_normal) differs from the surface's own normal
    /// anywhere.
    pub is_smooth: bool,
    /// A point and the unit normal of the plane that contains the whole shape, if there is one: rays that leave the
    /// shape stay on their side of the plane, it is shaded with the plane's normal, and a light behind the plane does
    /// not light it. `None` is always correct.
    pub plane: Option<[DVec3; 2]>,
    /// Whether the shape ends where the camera cuts off planes
    /// ([`planes_end_at`](crate::camera::Camera::planes_end_at)). Its copies end at the same z of the world.
    pub ends_as_planes: bool,
    /// Whether the search for a ray's hit may take as long as several plain rays
    /// ([`search_cost`](Hittable::search_cost)). Shapes without bounds are not asked.
    pub may_be_costly: bool,
    /// Whether the surface has u and v although [`uv`](Hittable::uv) may know none of points off the surface.
    pub has_uv: bool,
}

impl Facts {
    /// Returns the facts of a shape without bounds, if only its largest coordinate is known.
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
            has_uv: false,
        }
    }

    /// Returns the facts of a shape, if only a box that contains it is known.
    #[inline]
    pub fn within(bounds: Aabb) -> Self {
        let max_coordinate = bounds.low.abs().max(bounds.high.abs()).max_element();
        Self { bounds: Some(bounds), ..Self::unbounded(max_coordinate) }
    }

    /// Returns the box that contains the shape, widened by far more than the rounding of its numbers: these are sums
    /// and products of a few numbers of the size of the box and of the shape's coordinates.
    #[inline]
    pub fn widened(&self) -> Option<Aabb> {
        self.bounds.map(|bounds| bounds.with_slack(self.max_coordinate))
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
    /// Only the inside.
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

/// A shape, how packets of rays are tested against it (`S`), and how its hits are proven (`P`).
///
/// By default, hits are found by the shape's distance, and nothing about them is proven.
pub struct Shape<T, S = ByDistance, P = Unproven> {
    pub(crate) shape: T,
    how: PhantomData<fn() -> (S, P)>,
}

impl<T: Hittable> Shape<T> {
    /// Makes a shape whose hits are found by its distance.
    pub fn new(shape: T) -> Self {
        Self { shape, how: PhantomData }
    }
}

impl<T, S, P> Shape<T, S, P> {
    /// Returns the same shape, with hits found and proven in other ways.
    pub fn by<U, Q>(self) -> Shape<T, U, Q> {
        Shape { shape: self.shape, how: PhantomData }
    }
}

impl<T: Bracketed, P> Shape<T, ByDistance, P> {
    /// Finds hits by the shape's brackets.
    pub fn bracketed(self) -> Shape<T, ByBracket, P> {
        self.by()
    }
}

impl<T: Certified, S> Shape<T, S> {
    /// Proves hits by the shape's equation.
    pub fn certified(self) -> Shape<T, S, ByEquation> {
        self.by()
    }
}

impl<T: Hittable + Equation> Shape<T> {
    /// Finds hits by a formula of the notes, which computes a distance as quickly as a bracket. The distance is not
    /// refined, even where the shape coincides with another surface. The equation states the surface that the notes
    /// mean.
    pub fn classic(self) -> Shape<T, ByDistance, ByFormula> {
        self.by()
    }
}

/// Marks a shape whose hits are found by its distance.
pub struct ByDistance;
/// Marks a shape whose hits are found by its bracket, and refined by its distance.
pub struct ByBracket;

/// Marks a shape about whose hits nothing is proven.
pub struct Unproven;
/// Marks a shape whose hits are proven by its equation.
pub struct ByEquation;
/// Marks a shape whose hits are found by a formula of the notes, with an equation of the surface that they mean.
pub struct ByFormula;
