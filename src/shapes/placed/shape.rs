//! The shape of a copy: single rays and their hits in object space.

use super::image_plane::MaxZ;
use glam::{DMat3, DVec2, DVec3};
use std::sync::Arc;
use tabray_world::body::Body;
use tabray_world::certify::{Enclosure, Precision, Premise, ProofMethods};
use tabray_world::coincidence::{CLOSE, ROUNDING, close};
use tabray_world::geometry::aabb::{Aabb, SLACK};
use tabray_world::geometry::facet::Facet;
use tabray_world::geometry::placement::Placement;
use tabray_world::geometry::ray::{Bracket, MISS, Ray, RayBall, RayError, RayRange, Side};
use tabray_world::geometry::sight::Sight;
use tabray_world::hittable::{Curvature, Facts, Hittable, SurfaceHit};
use tabray_world::luminous::Luminous;
use tabray_world::packets::shape::HitQueries;

/// A copy of an object's shape.
pub struct Placed {
    pub(super) body: Arc<Body>,
    pub(super) placement: Placement,
    pub(super) to_object_space: DMat3,
    /// A bounding box in world coordinates.
    pub(super) bounds: Option<Aabb>,
    /// The end of a copy of a plane.
    pub(super) max_z: MaxZ,
}

/// A bound of the error of [`Placed::to_object_space`] as a map of unit vectors, times the minimum scale, and of the
/// rounding of a mapped point or direction.
///
/// In units of 2^-53: an angle of up to 2 pi has 3 roundings, an error of 19, and the error of its sine and cosine is
/// 20 units. For a component of the product of three rotations, it is 3 * 20 * sqrt(2) and the rounding of the
/// products, together less than 100. The error of a matrix of nine such components is 300, and a product with it adds
/// 8: less than 512. For a rotation around an axis, the error of a component of the normalized axis is 4. The errors of
/// the three terms are 21, 25 and 40, and their sum adds 3: also less than 100.
const TURN: f64 = 256.0 * f64::EPSILON;

/// The drift of a camera ray in world space: the error of a component of its direction is at most 3 units of 2^-53.
const CAMERA: RayError = RayError { origin: 0.0, dir: 3.0 * f64::EPSILON };

/// The maximum drift of a direction for which brackets are computed. The relative error of lengths is as large, and
/// must be far below the distance at which two hits count as coincident.
const MAX_DRIFT: f64 = CLOSE / 16.0;

impl Placed {
    /// Makes a copy of an object's shape.
    pub(super) fn new(body: &Arc<Body>, placement: Placement) -> Self {
        let to_object_space = placement.to_object_space();
        Self {
            body: Arc::clone(body),
            placement,
            to_object_space,
            bounds: bounds(body, placement, to_object_space),
            max_z: MaxZ(None),
        }
    }

    /// Ends the copy at a z, in world units, if one is given and the object ends like planes do.
    pub(super) fn up_to(self, max_z: Option<f64>) -> Self {
        Self { max_z: MaxZ(max_z.filter(|_| self.body.shape.facts().ends_as_planes)), ..self }
    }

    /// Maps a point from world space to object space.
    #[inline(always)]
    pub(super) fn object_point(&self, at: DVec3) -> DVec3 {
        self.to_object_space * (at - self.placement.translation)
    }

    /// Maps a ray from world space to object space. Also returns the length of a world unit along the ray there.
    #[inline(always)]
    pub(super) fn object_ray(&self, ray: &Ray) -> (Ray, f64) {
        let dir = self.to_object_space * ray.dir;
        let length = dir.length();
        (Ray { origin: self.object_point(ray.origin), dir: dir / length }, length)
    }

    /// Returns a bound of the error of a point in object space, given its error in world space. It includes the
    /// rounding of the map.
    pub(super) fn object_error(&self, at: DVec3, error: f64) -> f64 {
        let size = at.abs().max_element() + self.placement.translation.abs().max_element();
        (error + ROUNDING * size) / self.placement.scale.min_element()
    }

    /// Returns the drift in object space of rays with origins in a box and a drift in world space. Returns `None` if it
    /// is too large for useful brackets.
    pub(super) fn object_drift(&self, origins: &Aabb, drift: RayError) -> Option<RayError> {
        let Placement { scale, translation, .. } = self.placement;
        let away = (origins.low - translation).abs().max((origins.high - translation).abs()).element_sum();
        let (least, most) = (scale.min_element(), scale.max_element());
        // A camera ray in world space has only its own rounding error.
        let drift = if drift.is_none() { CAMERA } else { drift };
        // Normalizing two vectors at most doubles the difference between them, relative to the shorter one. That is at
        // least 1 / `most` long.
        let dir = 2.0 * (drift.dir + TURN) * (most / least);
        let own = RayError { origin: (drift.origin + TURN * away) / least, dir };
        (dir < MAX_DRIFT && own.origin < MISS).then_some(own)
    }

    /// Maps a surface that gives light from object space to world space.
    pub(super) fn mapped(&self, own: &Luminous) -> Option<Luminous> {
        own.mapped(self.to_object_space.inverse(), self.placement.translation)
    }

    /// Returns a range in object space, which includes all that rounding may have moved out of it. `length` is the
    /// length of a world unit along the ray there.
    #[inline(always)]
    fn object_range(&self, ray: &Ray, range: &RayRange, length: f64) -> RayRange {
        let RayRange { near, far, origin_side, origin_error } = *range;
        RayRange {
            near: near * length * (1.0 - 4.0 * f64::EPSILON),
            far: far * length * (1.0 + CLOSE),
            origin_side,
            origin_error: self.object_error(ray.origin, origin_error),
        }
    }

    /// Returns a lower bound of the distance to a bounding box, or `None` if a ray misses it.
    pub(super) fn entry(bounds: Option<Aabb>, ray: &Ray) -> Option<f64> {
        let Some(Aabb { low, high }) = bounds else { return Some(0.0) };
        let slack = SLACK * (ray.origin.abs().max_element() + low.abs().max(high.abs()).max_element());
        let (mut from, mut to) = (0.0_f64, MISS);
        for axis in 0..3 {
            let (origin, dir) = (ray.origin[axis], ray.dir[axis]);
            let (one, other) = ((low[axis] - slack - origin) / dir, (high[axis] + slack - origin) / dir);
            // For a ray in a side of the box, `min` and `max` ignore a NaN.
            (from, to) = (from.max(one.min(other)), to.min(one.max(other)));
        }
        let from = from * (1.0 - SLACK);
        (from <= to * (1.0 + SLACK)).then_some(from)
    }

    /// Returns a bracket of the first hits, for all rays that `ray` stands for. A ray that continues from a surface
    /// counts as exact.
    pub(super) fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        if self.body.shape.packets().is_of_the_notes() {
            return Bracket::exactly(self.distance(ray, range));
        }
        let is_from_camera = range.origin_side.is_none() && range.origin_error == 0.0;
        let mut drift = RayError::NONE;
        if is_from_camera {
            match self.object_drift(&Aabb::around(&[ray.origin]), ray.drift) {
                Some(own) => drift = own,
                None => return Bracket::UNKNOWN,
            }
        }
        let (own, length) = self.object_ray(ray);
        let mut object_range = self.object_range(ray, range, length);
        if is_from_camera {
            object_range.origin_error = 0.0;
        }
        let bracket = self.body.shape.packets().t_bounds(&RayBall { ray: own, drift }, &object_range);
        if bracket.near == bracket.far && bracket.near / length <= range.near {
            return Bracket::UNKNOWN;
        }
        let bracket = in_world(bracket, length, drift.dir, ray, range);
        let bracket = self.max_z.kept_bracket(ray, bracket, range.origin_error);
        if is_from_camera && ray.is_single() {
            entered(bracket, || Self::entry(self.bounds, ray))
        } else {
            bracket
        }
    }
}

/// Returns a bounding box of a copy in world coordinates.
fn bounds(body: &Body, placement: Placement, to_object_space: DMat3) -> Option<Aabb> {
    let Placement { scale, translation, .. } = placement;
    let to_world = to_object_space.transpose() * DMat3::from_diagonal(scale * scale);
    let own = body.shape.bounds()?;
    let turned = body.shape.bounds_after(&to_world).unwrap_or_else(|| {
        let middle = to_world * own.middle();
        let DMat3 { x_axis, y_axis, z_axis } = to_world;
        let reach = DMat3::from_cols(x_axis.abs(), y_axis.abs(), z_axis.abs()) * own.half_size();
        Aabb { low: middle - reach, high: middle + reach }
    });
    let size = own.low.abs().max(own.high.abs()).max_element() * scale.max_element();
    let slack = SLACK * (size + translation.abs().max_element());
    Some(Aabb { low: translation + turned.low - slack, high: translation + turned.high + slack })
}

/// Converts a bracket from object space to world units. `error` bounds the relative error of `length`, the length of a
/// world unit.
#[inline(always)]
pub(super) fn in_world(
    Bracket { near, far }: Bracket,
    length: f64,
    error: f64,
    ray: &Ray,
    range: &RayRange,
) -> Bracket {
    if near == far {
        let close = if range.far < MISS { close(ray, range.far) } else { 0.0 };
        let distance = RayRange { far: range.far + close, ..*range }.keep(near / length);
        // At the distance of another surface, a wider bracket lets more digits decide which comes first.
        return if (distance - range.far).abs() <= close {
            Bracket { near: distance - close, far: distance + close }
        } else {
            Bracket::exactly(distance)
        };
    }
    let error = error + 4.0 * f64::EPSILON;
    Bracket { near: near / length * (1.0 - error), far: far / length * (1.0 + error) }
}

/// Raises the bracket of a doubtful hit to the distance at which the ray enters the bounding box.
#[inline(always)]
pub(super) fn entered(bracket: Bracket, entry: impl FnOnce() -> Option<f64>) -> Bracket {
    if bracket.is_doubtful() {
        entry().map_or(Bracket::MISS, |entry| Bracket { near: bracket.near.max(entry), far: MISS })
    } else {
        bracket
    }
}

impl Hittable for Placed {
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        let (own, length) = self.object_ray(ray);
        let mut range_there = self.object_range(ray, range, length);
        let distance = loop {
            let found = self.body.shape.distance(&own, &range_there);
            let distance = found / length;
            // A hit where the range begins may be before it in world units, and then another one is the first.
            if distance > range.near || distance.is_nan() {
                break range.keep(distance);
            }
            range_there.near = found;
        };
        if self.max_z.cuts_off(ray, distance) { MISS } else { distance }
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        (self.to_object_space.transpose() * self.body.shape.normal(self.object_point(at))).normalize()
    }

    fn facts(&self) -> Facts {
        let Placement { scale, translation, .. } = self.placement;
        let own = self.body.shape.facts();
        // A rotation can move a corner of a cube onto an axis.
        let reach = 3_f64.sqrt() * scale.max_element() * own.max_coordinate;
        // The factor 2 covers the rounding of the ray's maps to object space and back.
        let max_coordinate = 2.0 * (translation.abs().max_element() + reach);
        Facts { bounds: self.bounds, max_coordinate, plane: None, ..own }
    }

    fn shading_normal(&self, at: DVec3, normal: DVec3) -> DVec3 {
        let (at, to_world) = (self.object_point(at), self.to_object_space.transpose());
        let own = self.body.shape.normal(at);
        let own = if (to_world * own).dot(normal) < 0.0 { -own } else { own };
        let shaded = self.body.shape.shading_normal(at, own);
        if shaded == own { normal } else { (to_world * shaded).normalize() }
    }

    fn part(&self, ray: &Ray, distance: f64) -> Option<String> {
        let (own, length) = self.object_ray(ray);
        self.body.shape.part(&own, distance * length)
    }

    fn face_hit(&self, ray: &Ray, distance: f64) -> Option<u32> {
        let (own, length) = self.object_ray(ray);
        self.body.shape.face_hit(&own, distance * length)
    }

    fn uv(&self, at: DVec3) -> Option<DVec2> {
        self.body.shape.uv(self.object_point(at))
    }

    /// Returns the object's own curvature, as the object's shader works in object space.
    fn curvature(&self, at: DVec3) -> Option<Curvature> {
        self.body.shape.curvature(self.object_point(at))
    }

    fn face(&self, at: DVec3) -> Option<u32> {
        self.body.shape.face(self.object_point(at))
    }

    fn why_not_closed(&self) -> Option<&str> {
        self.body.shape.why_not_closed()
    }

    fn search_cost(&self, ray: &Ray, origin_side: Option<Side>) -> u32 {
        self.body.shape.search_cost(&self.object_ray(ray).0, origin_side)
    }

    fn luminous(&self) -> Option<Luminous> {
        self.mapped(&self.body.shape.luminous()?)
    }

    fn method(&self) -> String {
        format!("in the object's own coordinates: {}", self.body.shape.method())
    }
}

/// Tells whether a point in world space lies on a copy, up to an error in world units.
fn is_on_surface(placed: &Placed, at: DVec3, error: f64) -> bool {
    placed.body.shape.is_on_surface(placed.object_point(at), placed.object_error(at, error))
}

impl HitQueries for Placed {
    fn is_on_surface(&self, at: DVec3, error: f64) -> bool {
        is_on_surface(self, at, error)
    }

    fn contains(&self, at: DVec3, error: f64) -> Option<bool> {
        // A rotated cube extends as far along an axis as from its middle to its corners.
        let error = 1.001 * 3_f64.sqrt() * error;
        self.body.shape.contains(self.object_point(at), self.object_error(at, error))
    }

    fn facet(&self, at: DVec3, error: f64) -> Option<Facet> {
        let own = self.body.shape.facet(self.object_point(at), self.object_error(at, error))?;
        own.placed(self.placement)
    }

    fn certify(&self, sight: &Sight, precision: Precision) -> (Enclosure, usize) {
        let (found, part) = self.body.shape.certify_part(&sight.within(self.placement), precision);
        (self.max_z.kept_enclosure(sight, found), part)
    }

    fn surface_hit(&self, ray: &Ray, distance: f64, at: DVec3, part: Option<usize>) -> Option<SurfaceHit> {
        let (own, length) = self.object_ray(ray);
        let hit = self.body.shape.surface_hit(&own, distance * length, self.object_point(at), part);
        Some(SurfaceHit { normal: (self.to_object_space.transpose() * hit.normal).normalize(), ..hit })
    }

    fn premises(&self, of: &'static str, each: &mut dyn FnMut(&'static str, Premise)) {
        let Body { shape, entity, .. } = &*self.body;
        shape.premises(entity.unwrap_or(of), each);
    }

    fn proven(&self) -> Option<&dyn ProofMethods> {
        Some(self)
    }

    fn is_of_the_notes(&self) -> bool {
        self.body.shape.packets().is_of_the_notes()
    }
}
