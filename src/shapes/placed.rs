//! Copies of an object in other places, which share its shape.
//!
//! A ray is taken to the object's own coordinates, and its hit back to the world. The rounding of that may decide whether
//! a ray hits the shape at all, so that no bracket of a camera ray is certain: where it enters the copy's bounding box,
//! the ray as the scene gives it decides, for which the angles' sines and cosines are enclosed in intervals.

use crate::geometry::aabb::{Aabb, SLACK};
use crate::geometry::placement::Placement;
use crate::geometry::ray::{Bracket, MISS, Ray, RayRange, Side};
use crate::geometry::roots::Method;
use crate::geometry::sight::{Line, Sight};
use crate::numeric::double_double::DoubleDouble;
use crate::numeric::dual::Dual;
use crate::numeric::interval::{Fine, Fraction, Interval};
use crate::numeric::scalar::{Scalar, dot};
use crate::world::body::Body;
use crate::world::certify::{Enclosure, Found, Onward, Precise, Precision, Proven};
use crate::world::coincidence::{CLOSE, ROUNDING};
use crate::world::hittable::{Bracketed, Hittable};
use crate::world::material::{Look, Material, Rgb};
use crate::world::packets::shader::EncloseLook;
use crate::world::packets::shape::{Proofs, by_distance};
use crate::world::shader::{LookBounds, Plain, Shader};
use crate::world::shape::{ByBracket, Shape};
use glam::{DMat3, DVec3};
use std::sync::Arc;

/// A copy of an object's shape.
pub struct Placed {
    body: Arc<Body>,
    placement: Placement,
    to_own: DMat3,
}

/// The reflectivities of an object at its own points.
struct PlacedShader(Placed);

/// Marks a shape whose hits are proven in the coordinates of the object that it is a copy of.
pub struct ByPlacement;

impl Placed {
    /// Makes a copy of an object with this material.
    pub fn body(body: Arc<Body>, placement: Placement, material: &Material) -> Body {
        let placed = || {
            let body = Arc::clone(&body);
            Self { body, placement, to_own: placement.to_own() }
        };
        let shape = Shape::new(placed()).by::<ByBracket, ByPlacement>();
        let is_plain = body.shader.uniform(material) == Plain.uniform(material);
        let copy = if is_plain { Body::plain(shape) } else { Body::shaded(shape, PlacedShader(placed())) };
        Body { depth: body.depth + 1, ..copy }
    }

    /// Takes a point from the world to the object's own coordinates.
    #[inline(always)]
    fn own_point(&self, at: DVec3) -> DVec3 {
        self.to_own * (at - self.placement.translation)
    }

    /// Takes a ray from the world to the object's own coordinates. Returns it with the length there of a world unit.
    #[inline(always)]
    fn own_ray(&self, ray: &Ray) -> (Ray, f64) {
        let dir = self.to_own * ray.dir;
        let length = dir.length();
        (Ray { origin: self.own_point(ray.origin), dir: dir / length }, length)
    }

    /// Returns a bound on the error in the object's own coordinates of a point with this error in the world, the
    /// rounding of the transformation included.
    fn own_error(&self, at: DVec3, error: f64) -> f64 {
        let size = at.abs().max_element() + self.placement.translation.abs().max_element();
        (error + ROUNDING * size) / self.placement.scale.min_element()
    }

    /// Returns a lower bound on the distance to the bounding box, or `None` where a ray misses it.
    fn entry(&self, ray: &Ray) -> Option<f64> {
        let Some(Aabb { low, high }) = self.bounds() else { return Some(0.0) };
        let slack = SLACK * (ray.origin.abs().max_element() + low.abs().max(high.abs()).max_element());
        let (mut from, mut to) = (0.0_f64, MISS);
        for axis in 0..3 {
            let (origin, dir) = (ray.origin[axis], ray.dir[axis]);
            let (one, other) = ((low[axis] - slack - origin) / dir, (high[axis] + slack - origin) / dir);
            // Of a NaN, where a ray lies in a side of the box, the other number is taken.
            (from, to) = (from.max(one.min(other)), to.min(one.max(other)));
        }
        let from = from * (1.0 - SLACK);
        (from <= to * (1.0 + SLACK)).then_some(from)
    }
}

impl Hittable for Placed {
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        let (own, length) = self.own_ray(ray);
        let RayRange { near, far, origin_side, .. } = *range;
        let range_there = RayRange {
            near: near * length,
            far: far * length * (1.0 + CLOSE),
            origin_side,
            origin_error: self.own_error(ray.origin, range.origin_error),
        };
        range.keep(self.body.shape.distance(&own, &range_there) / length)
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        (self.to_own.transpose() * self.body.shape.normal(self.own_point(at))).normalize()
    }

    fn shading_normal(&self, at: DVec3, normal: DVec3) -> DVec3 {
        let (at, to_world) = (self.own_point(at), self.to_own.transpose());
        let own = self.body.shape.normal(at);
        let own = if (to_world * own).dot(normal) < 0.0 { -own } else { own };
        let shaded = self.body.shape.shading_normal(at, own);
        if shaded == own { normal } else { (to_world * shaded).normalize() }
    }

    fn part(&self, ray: &Ray, distance: f64) -> Option<String> {
        let (own, length) = self.own_ray(ray);
        self.body.shape.part(&own, distance * length)
    }

    fn bounds(&self) -> Option<Aabb> {
        let own = self.body.shape.bounds()?;
        let Placement { scale, translation, .. } = self.placement;
        let to_world = self.to_own.transpose() * DMat3::from_diagonal(scale * scale);
        let middle = translation + to_world * own.middle();
        let DMat3 { x_axis, y_axis, z_axis } = to_world;
        let reach = DMat3::from_cols(x_axis.abs(), y_axis.abs(), z_axis.abs()) * own.half_size();
        let size = own.low.abs().max(own.high.abs()).max_element() * scale.max_element();
        let reach = reach + SLACK * (size + translation.abs().max_element());
        Some(Aabb { low: middle - reach, high: middle + reach })
    }

    fn can_hit_itself(&self, leaving: Side) -> bool {
        self.body.shape.can_hit_itself(leaving)
    }

    fn is_two_sided(&self) -> bool {
        self.body.shape.is_two_sided()
    }

    fn method(&self) -> String {
        format!("in the object's own coordinates: {}", self.body.shape.method())
    }

    fn reach(&self) -> f64 {
        let Placement { scale, translation, .. } = self.placement;
        // A rotation moves what lies in a corner of a cube onto an axis.
        let own = 3_f64.sqrt() * scale.max_element() * self.body.shape.reach();
        // Twice as much, for the rounding of the ray's way there and back.
        2.0 * (translation.abs().max_element() + own)
    }
}

impl Bracketed for Placed {
    fn t_bounds(&self, ray: &Ray, range: &RayRange) -> Bracket {
        if self.body.shape.packets().is_of_the_notes() {
            return Bracket::exactly(self.distance(ray, range));
        }
        if range.origin_side.is_none() && range.origin_error == 0.0 {
            return self.entry(ray).map_or(Bracket::MISS, |near| Bracket { near, far: MISS });
        }
        let touches = || touches(self, ray.origin, range.origin_error);
        by_distance(range, touches, |range| Some(self.distance(ray, range)))
    }

    fn refine(&self, ray: &Ray, origin_side: Option<Side>) -> f64 {
        self.distance(ray, &RayRange { origin_side, ..RayRange::ALL })
    }
}

/// Tells whether a point in the world lies on a copy, up to an error in world units.
fn touches(placed: &Placed, at: DVec3, error: f64) -> bool {
    placed.body.shape.touches(placed.own_point(at), placed.own_error(at, error))
}

impl Proofs for Shape<Placed, ByBracket, ByPlacement> {
    fn touches(&self, at: DVec3, error: f64) -> bool {
        touches(&self.shape, at, error)
    }

    fn fine_distance(&self, _ray: &Ray, _distance: f64) -> Option<DoubleDouble> {
        None
    }

    fn certify(&self, sight: &Sight, precision: Precision) -> Enclosure {
        self.shape.body.shape.certify(&sight.within(self.shape.placement), precision)
    }

    fn proven(&self) -> Option<&dyn Proven> {
        Some(&self.shape)
    }

    fn is_of_the_notes(&self) -> bool {
        self.shape.body.shape.packets().is_of_the_notes()
    }

    fn distance_by(&self, _method: Method, _ray: &Ray, _range: &RayRange) -> Option<f64> {
        None
    }
}

impl<F: Precise> Onward<F> for Placed {
    fn first_hit(&self, line: &Line<Interval<F>>, leaves: Option<usize>) -> (Found<F>, usize) {
        let own = Line { origin: self.placement.point(line.origin), dir: self.placement.vector(line.dir) };
        match self.body.shape.proven() {
            Some(proven) => F::proofs(proven).first_hit(&own, leaves),
            None => (Found::Doubtful(F::of(0.0)), 0),
        }
    }

    fn slope(&self, at: [Dual<Interval<F>>; 3], part: usize) -> Dual<Interval<F>> {
        let own = self.placement.point(at);
        match self.body.shape.proven() {
            Some(proven) => F::proofs(proven).slope(own, part),
            None => Dual::fixed(Interval::whole()),
        }
    }

    fn shading_normal(
        &self,
        at: [Interval<F>; 3],
        part: usize,
        normal: [Interval<F>; 3],
    ) -> Option<[Interval<F>; 3]> {
        let shape = F::proofs(self.body.shape.proven()?);
        let n = Interval::<F>::constant;
        // Normals are transformed by the inverse transpose of what transforms vectors.
        let own = self.placement.vector(normal);
        let own = [0, 1, 2].map(|axis| own[axis] * n(self.placement.scale[axis]).powi(2));
        let length = dot(own, own).sqrt();
        let own = own.map(|part| part / length);
        let shaded = shape.shading_normal(self.placement.point(at), part, own)?;
        if shaded == own {
            return Some(normal);
        }
        let axes = DMat3::IDENTITY.to_cols_array_2d().map(|axis| self.placement.vector(axis.map(n)));
        let world = axes.map(|axis| dot(axis, shaded));
        let length = dot(world, world).sqrt();
        Some(world.map(|part| part / length))
    }
}

impl Shader for PlacedShader {
    fn ambient(&self, material: &Material, at: DVec3) -> Rgb {
        self.0.body.shader.ambient(material, self.0.own_point(at))
    }

    fn diffuse(&self, material: &Material, at: DVec3) -> Rgb {
        self.0.body.shader.diffuse(material, self.0.own_point(at))
    }

    fn specular(&self, material: &Material, at: DVec3) -> Rgb {
        self.0.body.shader.specular(material, self.0.own_point(at))
    }

    fn enclose<F: Precise>(&self, material: &Material, at: [Interval<F>; 3]) -> Option<LookBounds<F>> {
        let own = self.0.placement.point(at).map(F::widen);
        let look = EncloseLook::<Fraction>::look(&*self.0.body.shader, material, own)?;
        let narrow = |colour: [Fine; 3]| colour.map(F::narrow);
        let LookBounds { ambient, diffuse, specular } = look;
        Some(LookBounds { ambient: narrow(ambient), diffuse: narrow(diffuse), specular: narrow(specular) })
    }

    fn uniform(&self, material: &Material) -> Option<Look> {
        self.0.body.shader.uniform(material)
    }

    fn brightest(&self, material: &Material) -> Option<Look> {
        self.0.body.shader.brightest(material)
    }
}
