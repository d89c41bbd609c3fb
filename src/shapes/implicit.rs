//! Implicit surfaces: the points where f(x, y, z) = 0.
//!
//! A plugin gives the formula, generic over the number type, and a bounding box. From these, [`taylor`] isolates a
//! ray's first hit, by interval arithmetic or, for a polynomial, by its Bernstein coefficients along the ray. [`Dual`]
//! numbers give the normal.

mod beam;
mod curvature;
mod finely;
mod formula;
mod on_ray;
mod parts;

pub use formula::{CUT_BY_BOX, Implicit};
use glam::{DVec2, DVec3};
use on_ray::{FormulaOnRay, ImplicitShape, shortest};
use parts::Parts;
use std::sync::OnceLock;
use tabray_exact::dual::Dual;
use tabray_exact::formula::along::AlongLines;
use tabray_exact::formula::field::Field;
use tabray_exact::gradient::Gradient;
use tabray_exact::interval::Interval;
use tabray_exact::polynomial::{MAX_COEFFICIENTS, Polynomial};
use tabray_exact::roots::Method;
use tabray_exact::roots::stretch::Stretch;
use tabray_exact::roots::taylor::{self, FirstRoot};
use tabray_exact::scalar::Scalar;
use tabray_world::body::Body;
use tabray_world::certify::Equation;
use tabray_world::coincidence::ROUNDING;
use tabray_world::geometry::aabb::Aabb;
use tabray_world::geometry::facet::Facet;
use tabray_world::geometry::frame::Frame;
use tabray_world::geometry::ray::{Bracket, MISS, Ray, RayBall, RayRange, Side};
use tabray_world::geometry::ray_packet::RayPacket;
use tabray_world::geometry::sight::Line;
use tabray_world::hittable::{Bracketed, Certified, Curvature, Facts, Hittable, Shape};
use tabray_world::luminous::Luminous;
use tabray_world::packets::shape::by_distance;

/// The number of plain rays that take as long as a search: 25 for a torus, 60 for a heart.
const RAYS_PER_SEARCH: u32 = 32;

/// The maximum number of roots in cut-away parts of the surface along a ray, for other methods than the shape's own.
const MAX_CUT: usize = 64;

/// See [`Made::implicit`](crate::Made::implicit).
pub(super) fn body(formula: impl Implicit + 'static, frame: Frame) -> Body {
    let [low, high] = formula.bounds();
    let given = Aabb { low, high };
    let Aabb { low, high } = if formula.is_box_exact() { given } else { given.with_slack(0.0) };
    let diagonal = Polynomial::<f64, MAX_COEFFICIENTS>::along(Interval { low: -1.0, high: 1.0 });
    let own = match formula.field() {
        Some(_) => None,
        None => AlongLines::recorded(|at| formula.polynomial(at)),
    };
    let along_lines = formula.field().map(Field::along_lines).or(own.as_ref());
    let degree = along_lines.and_then(|along| along.polynomial([diagonal; 3]).degree());
    let ends = [low.to_array(), high.to_array()];
    let nodes = along_lines.zip(degree).and_then(|(along, degree)| along.nodes(degree, ends));
    let cost = formula.field().map_or(1, |field| field.formula().cost());
    let (parts, most_pieces) = (Parts::new(low, high, cost), on_ray::most_pieces(cost));
    let (recorded, along_lines) = (OnceLock::new(), own);
    let shape =
        ImplicitShape { formula, recorded, along_lines, degree, frame, low, high, parts, most_pieces, nodes };
    Body::plain(Shape::new(shape).bracketed().certified())
}

impl<T: Implicit> Hittable for ImplicitShape<T> {
    fn uv(&self, at: DVec3) -> Option<DVec2> {
        self.formula.uv(self.frame.point(at))
    }

    fn curvature(&self, at: DVec3) -> Option<Curvature> {
        Some(curvature::at(&self.formula, self.frame.point(at)))
    }

    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        let line = FormulaOnRay::new(self, ray);
        line.distance(line.first_hit(range).root, range)
    }

    /// Returns the normalized gradient of the formula. Where the gradient vanishes or does not exist, as at the tip of
    /// a cone, the normal points away from the shape's origin, and at the origin along the y axis of the shape.
    fn normal(&self, at: DVec3) -> DVec3 {
        let at = self.frame.point(at);
        let Gradient { slopes, .. } = self.formula.value(Gradient::point(at.to_array()));
        let normal = direction(DVec3::from(slopes)).or(direction(at)).unwrap_or(DVec3::Y);
        self.frame.axes * normal
    }

    fn facts(&self) -> Facts {
        // Not the widened box, which would move the patterns on the shape.
        let [low, high] = self.formula.bounds();
        let own = Aabb { low, high };
        Facts { is_two_sided: true, may_be_costly: true, ..Facts::within(self.frame.bounds(&own)) }
    }

    fn why_not_closed(&self) -> Option<&'static str> {
        self.formula.why_not_closed()
    }

    fn luminous(&self) -> Option<Luminous> {
        self.formula.luminous()?.mapped(self.frame.axes, self.frame.origin)
    }

    /// Returns the same cost for all rays that enter the box. Counting the steps would repeat the search.
    fn search_cost(&self, ray: &Ray, _origin_side: Option<Side>) -> u32 {
        let outer = FormulaOnRay::new(self, ray).stretch().outer;
        if outer.start <= outer.end { RAYS_PER_SEARCH } else { 0 }
    }

    fn method(&self) -> String {
        let means =
            if self.degree.is_some() { "coefficients of a polynomial" } else { "interval arithmetic" };
        format!("first root isolated by {means}, then polished")
    }
}

impl<T: Implicit> Bracketed for ImplicitShape<T> {
    const BY_BEAMS: bool = true;

    fn t_bounds_each(&self, rays: RayPacket, ranges: &[RayRange], brackets: &mut [Bracket]) {
        beam::bracket_each(self, rays, ranges, brackets);
    }

    fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        if !ray.is_single() {
            return FormulaOnRay::new(self, ray).within(ray.drift).bracket(range);
        }
        let is_on_surface = || self.is_on_surface(ray.origin, range.origin_error);
        by_distance(ray, range, is_on_surface, |range| {
            let line = FormulaOnRay { by_proof: true, ..FormulaOnRay::new(self, ray) };
            let FirstRoot { root, is_certain } = line.first_hit(range);
            is_certain.then(|| line.distance(root, range))
        })
    }

    fn refine(&self, ray: &Ray, origin_side: Option<Side>) -> f64 {
        self.distance(ray, &RayRange { origin_side, ..RayRange::ALL })
    }
}

impl<T: Implicit> Certified for ImplicitShape<T> {
    fn facet(&self, at: DVec3, error: f64) -> Option<Facet> {
        let height = self.formula.extruded()?;
        let size = (at.abs() + self.frame.origin.abs()).element_sum();
        // A rotated error is at most √3 times as long along an axis.
        let (at, error) = (self.frame.point(at), 1.75 * error + ROUNDING * size);
        let is_upward = at.y > 0.5 * height;
        let end = if is_upward { height } else { 0.0 };
        let is_alone = (at.y - end).abs() + error < 0.25 * height;
        let around = |place: f64| Interval { low: place - error, high: place + error };
        let amid = self.formula.value([around(at.x), Interval::constant(0.5 * height), around(at.z)]);
        (is_alone && amid.high < 0.0).then(|| self.frame.facet(end, is_upward))
    }

    fn distance_by(&self, method: Method, ray: &Ray, range: &RayRange) -> Option<f64> {
        let line = FormulaOnRay::new(self, ray);
        let (Stretch { outer, .. }, mut left) = (line.stretch(), *range);
        for _ in 0..MAX_CUT {
            let root = method.first_root(&line, outer.clone(), line.closest, &left, shortest(&outer));
            match root {
                Some(root) if self.has_gaps() && !line.kept(root).is_kept => {
                    // Another method may find the same root again, unless the origin's side tells it that the line
                    // leaves the surface there.
                    let rises = taylor::FunctionOnLine::at(&line, Dual::variable(root)).slope > 0.0;
                    left.origin_side = Some(if rises { Side::Outside } else { Side::Inside });
                    left.near = line.closest + root;
                }
                root => return Some(line.distance(root, range)),
            }
        }
        Some(MISS)
    }
}

impl<T: Implicit> Equation for ImplicitShape<T> {
    fn to_local<N: Scalar>(&self, line: Line<N>) -> Line<N> {
        self.frame.line(line)
    }

    fn value<N: Scalar>(&self, at: [N; 3]) -> N {
        match self.formula.field() {
            Some(field) => field.at(at),
            None => self.value().at(at),
        }
    }

    fn polynomial(&self) -> Option<&AlongLines> {
        let along_lines = self.formula.field().map(Field::along_lines).or(self.along_lines.as_ref());
        along_lines.filter(|_| self.degree.is_some())
    }

    fn field(&self) -> Option<&Field> {
        self.formula.field()
    }

    fn uv_bounds(&self, at: [Interval; 3]) -> Option<[Interval; 2]> {
        self.formula.uv_bounds(at)
    }

    fn inside_trim<N: Scalar>(&self, at: [N; 3]) -> N {
        let inside = |axis: usize| {
            let (low, high) = (N::constant(self.low[axis]), N::constant(self.high[axis]));
            (at[axis] - low).min(high - at[axis])
        };
        inside(0).min(inside(1)).min(inside(2)).min(self.formula.inside_trim(at))
    }

    fn condition<N: Scalar>(&self, at: [N; 3]) -> N {
        self.formula.condition(at)
    }

    fn extent(&self) -> [DVec3; 2] {
        [self.low, self.high]
    }
}

/// Returns the unit vector along a vector of any length, or `None` for a vector without a direction.
fn direction(vector: DVec3) -> Option<DVec3> {
    (vector / vector.abs().max_element()).try_normalize()
}

#[cfg(test)]
mod tests {
    use super::*;
    use tabray_world::certify::{Enclosure, Precision};
    use tabray_world::geometry::sight::Sight;

    /// Steiner's surface, of which the parts of the axes beyond 1 are alone: the formula is 0 there and above 0 around them.
    struct Steiner;

    impl Implicit for Steiner {
        fn value<N: Scalar>(&self, at: [N; 3]) -> N {
            let [x, y, z] = at.map(|axis| axis.powi(2));
            x * y + y * z + z * x - N::constant(2.0) * at[0] * at[1] * at[2]
        }

        fn bounds(&self) -> [DVec3; 2] {
            [DVec3::splat(-2.0), DVec3::splat(2.0)]
        }
    }

    #[test]
    fn a_polynomial_that_no_scene_gives_is_decided_exactly() {
        let body = body(Steiner, Frame::at(DVec3::ZERO));
        let start = DVec3::new(3.0, 2.5, 4.5);
        let certify = |dir| body.shape.certify(&Sight::exactly(start, dir), Precision::Octuple);
        // The ray meets the y axis at 1.83.
        let touch = certify(DVec3::new(-9.0, -2.0, -13.5));
        assert!(matches!(touch, Enclosure::Hits(_)), "{touch:?}");
        assert_eq!(certify(DVec3::new(-9.0, -2.0, -13.5 - 1e-12)), Enclosure::Misses);
    }
}
