//! The tests of a ray against the edges of a triangle: the arithmetic behind triangles.

mod hits;
pub mod loose;
mod normals;
mod sides;

use crate::plane::Plane;
use glam::DVec3;
use tabray_exact::double_double::vectors::{
    self, plain_cross, quick_unit, rounded_unit, scaled_to_one, triple_product,
};
use tabray_exact::double_double::{DoubleDouble, two_sum};
use tabray_exact::scalar::{Scalar, constants, cross, dot, per_axis};
use tabray_world::accuracy::{Classic, NotClassic};
use tabray_world::geometry::aabb::larger;
use tabray_world::geometry::ray::{Ray, RayError};
use tabray_world::geometry::ray_packet::RayPacket;
use tabray_world::simd::soa::{LANES, Vectors};

pub(crate) use sides::{UNDERFLOW, largest, passed, passed_by_eight};

/// A triangle.
#[derive(Clone, Copy, Debug)]
pub struct Triangle<A> {
    /// The plane of the triangle.
    pub plane: Plane<A>,
    /// The corners in world coordinates, counterclockwise as seen from the lit side.
    pub corners: [DVec3; 3],
}

impl Triangle<Classic> {
    /// Returns the triangle with these corners, or `None` if `f64` cannot distinguish the corners from collinear ones.
    pub fn classic(corners: [DVec3; 3]) -> Option<Self> {
        let [a, b, c] = corners;
        let normal = (b - a).cross(c - a).try_normalize()?;
        Some(Self { plane: Plane::new(normal, exact_normal(corners), a), corners })
    }
}

impl<A: NotClassic> Triangle<A> {
    /// Returns the triangle with these corners, or `None` if they are collinear.
    pub fn new(corners: [DVec3; 3]) -> Option<Self> {
        let area_normal = exact_normal(corners);
        if area_normal.iter().all(|part| part.high == 0.0) {
            return None;
        }
        let normal = DVec3::from(rounded_unit(area_normal));
        Some(Self { plane: Plane::new(normal, area_normal, corners[0]), corners })
    }
}

fn given<N: Scalar>(corners: &[DVec3; 3]) -> [[N; 3]; 3] {
    per_axis(|corner| constants(corners[corner]))
}

/// See [`Triangle::area_normal`]. It is compiled once for all accuracies, as the next one is.
fn area_normal<N: Scalar>(corners: &[DVec3; 3]) -> [N; 3] {
    let [a, b, c] = given(corners);
    let from_a = |corner: [N; 3]| per_axis(|axis| corner[axis] - a[axis]);
    cross(from_a(b), from_a(c))
}

/// See [`Triangle::inside`].
fn inside<N: Scalar>(corners: &[DVec3; 3], at: [N; 3]) -> N {
    let normal = area_normal(corners);
    let [a, b, c] = given(corners);
    let inside = |from: [N; 3], to: [N; 3]| {
        // This vector is perpendicular to the edge, in the plane, toward the inside.
        let inward = cross(normal, per_axis(|axis| to[axis] - from[axis]));
        dot(inward, per_axis(|axis| at[axis] - from[axis]))
    };
    inside(a, b).min(inside(b, c)).min(inside(c, a))
}

impl<A> Triangle<A> {
    /// Returns a normal whose length is twice the triangle's area.
    pub(crate) fn area_normal<N: Scalar>(&self) -> [N; 3] {
        area_normal(&self.corners)
    }

    /// Returns a number that is positive for a point of the plane inside the three edges, and negative outside. Its
    /// unit differs from edge to edge.
    pub fn inside<N: Scalar>(&self, at: [N; 3]) -> N {
        inside(&self.corners, at)
    }

    /// Returns whether a point of the plane is to the left of each edge, or on it.
    #[inline(always)]
    pub fn contains(&self, at: DVec3) -> bool {
        let left_of = |from: DVec3, to: DVec3| (to - from).cross(at - from).dot(self.plane.normal) >= 0.0;
        let [a, b, c] = self.corners;
        left_of(a, b) && left_of(b, c) && left_of(c, a)
    }

    /// Returns whether the line of a ray, extended both ways, passes all edges on the same side.
    ///
    /// For an edge that two triangles share, both compute the same number except for its sign, and so no ray slips
    /// through between them (Woop, Benthin and Wald 2013).
    #[inline(always)]
    pub(crate) fn is_passed_by(&self, ray: &Ray) -> bool {
        passed(self.corners, ray, RayError::NONE).unwrap_or_else(|| {
            let [a, b, c] = self.corners;
            let sides = [(a, b), (b, c), (c, a)].map(|(from, to)| exact_side(from, to, ray));
            sides.iter().all(|side| *side >= 0.0) || sides.iter().all(|side| *side <= 0.0)
        })
    }
}

/// Returns a number with a sign that tells on which side of the line from one point to another a ray passes. It is 0 if
/// the two lines intersect.
#[inline(never)]
pub(crate) fn exact_side(from: DVec3, to: DVec3, ray: &Ray) -> f64 {
    let place =
        |of: DVec3| scaled_to_one(per_axis(|axis| DoubleDouble::difference(of[axis], ray.origin[axis])));
    triple_product(place(from), place(to), ray.dir.to_array().map(DoubleDouble::from)).high
}

/// Returns the plane through the corners of a triangle with an area, for distances only. Its unit normal, the slowest
/// part, stays 0.
#[inline]
pub(crate) fn plane_for_distances<A>(corners: [DVec3; 3]) -> Plane<A> {
    Plane::new(DVec3::ZERO, exact_normal(corners), corners[0])
}

/// Returns a normal of the plane through three points, with each component rounded once however thin their triangle is.
/// It is 0 if the points are collinear.
#[inline]
fn exact_normal(corners: [DVec3; 3]) -> [DoubleDouble; 3] {
    let (normal, is_known) = quick_normal(corners);
    if is_known { normal } else { slow_normal(corners) }
}

/// Computes [`exact_normal`] without branches, and returns whether the result is certain. It usually is: edges must be
/// plain numbers of common magnitudes.
#[inline(always)]
fn quick_normal([a, b, c]: [DVec3; 3]) -> ([DoubleDouble; 3], bool) {
    let edge = |to: DVec3| {
        let (x, x_low) = two_sum(to.x, -a.x);
        let (y, y_low) = two_sum(to.y, -a.y);
        let (z, z_low) = two_sum(to.z, -a.z);
        let (scale, is_common) = scale_to_one(x, y, z);
        let scaled = [x * scale, y * scale, z * scale];
        // No product with the scale loses digits.
        let is_normal = |part: f64| (part == 0.0) | (part.abs() > 1e-280);
        let is_normal = is_normal(scaled[0]) & is_normal(scaled[1]) & is_normal(scaled[2]);
        let is_plain = (x_low == 0.0) & (y_low == 0.0) & (z_low == 0.0);
        (scaled, is_common & is_normal & is_plain)
    };
    let ((one, is_one_known), (other, is_other_known)) = (edge(b), edge(c));
    let ([x, y, z], lost) = plain_cross(one, other);
    let (scale, is_common) = scale_to_one(x.high, y.high, z.high);
    let scaled = |of: DoubleDouble| DoubleDouble { high: of.high * scale, low: of.low * scale };
    ([scaled(x), scaled(y), scaled(z)], is_one_known & is_other_known & is_common & (lost == 0.0))
}

/// Returns the power of two that scales the largest of three numbers to between 1/2 and 1, and whether it has a common
/// magnitude.
#[inline(always)]
fn scale_to_one(x: f64, y: f64, z: f64) -> (f64, bool) {
    let exponent = larger(larger(x.abs(), y.abs()), z.abs()).to_bits() >> 52;
    // Common magnitudes are 2^-400 to 2^400. Other scales are not used.
    (f64::from_bits(2045_u64.wrapping_sub(exponent) << 52), exponent.wrapping_sub(623) <= 800)
}

/// Computes the distances at which eight rays each cross the plane of a triangle, or NaN if plain and compensated
/// arithmetic are not enough.
///
/// The distances equal those of `plane_for_distances`, to the bit.
#[inline(always)]
pub fn crossings<A: NotClassic>(
    corners: &[Vectors<LANES>; 3],
    rays: RayPacket,
    distances: &mut [f64; LANES],
) {
    let corners_of = |lane: usize| [corners[0].get(lane), corners[1].get(lane), corners[2].get(lane)];
    let (mut high, mut low, mut is_known) = (Vectors::<LANES>::ZERO, Vectors::<LANES>::ZERO, [0; LANES]);
    for lane in 0..LANES {
        let ([x, y, z], is_its) = quick_normal(corners_of(lane));
        high.set(lane, DVec3::new(x.high, y.high, z.high));
        low.set(lane, DVec3::new(x.low, y.low, z.low));
        is_known[lane] = u64::from(is_its);
    }
    let mut last = None;
    for lane in (0..LANES).filter(|lane| is_known[*lane] == 0) {
        let [x, y, z] = unless_last(&mut last, corners_of(lane), slow_normal);
        high.set(lane, DVec3::new(x.high, y.high, z.high));
        low.set(lane, DVec3::new(x.low, y.low, z.low));
    }
    let plane = |lane: usize| {
        let part = |high: f64, low: f64| DoubleDouble { high, low };
        let area_normal = [
            part(high.x[lane], low.x[lane]),
            part(high.y[lane], low.y[lane]),
            part(high.z[lane], low.z[lane]),
        ];
        Plane::<A>::new(DVec3::ZERO, area_normal, corners[0].get(lane))
    };
    Plane::quick_crossings(plane, rays.first(LANES), distances);
}

/// Returns the unit normals of eight triangles.
///
/// They equal those of [`Triangle::new`], to the bit.
#[inline(always)]
pub(crate) fn unit_normals(corners: &[Vectors<LANES>; 3]) -> Vectors<LANES> {
    let (mut normals, mut is_known) = (Vectors::ZERO, [0; LANES]);
    let Vectors { x, y, z } = &mut normals;
    let corners_of = |lane: usize| [corners[0].get(lane), corners[1].get(lane), corners[2].get(lane)];
    for lane in 0..LANES {
        let (area_normal, is_upright_known) = quick_normal(corners_of(lane));
        let ([a, b, c], is_unit_known) = quick_unit(area_normal);
        (x[lane], y[lane], z[lane]) = (a, b, c);
        is_known[lane] = u64::from(is_upright_known & is_unit_known);
    }
    let mut last = None;
    for lane in (0..LANES).filter(|lane| is_known[*lane] == 0) {
        let unit = |corners| DVec3::from(rounded_unit(exact_normal(corners)));
        normals.set(lane, unless_last(&mut last, corners_of(lane), unit));
    }
    normals
}

/// Computes values from the corners of a triangle, unless the corners equal those of the last triangle. Neighbouring
/// rays often hit the same one.
#[inline(always)]
fn unless_last<T: Copy>(
    last: &mut Option<([DVec3; 3], T)>,
    corners: [DVec3; 3],
    compute: impl FnOnce([DVec3; 3]) -> T,
) -> T {
    match last {
        Some((of, known)) if *of == corners => *known,
        _ => last.insert((corners, compute(corners))).1,
    }
}

/// Computes [`exact_normal`] in all cases.
#[inline(never)]
fn slow_normal([a, b, c]: [DVec3; 3]) -> [DoubleDouble; 3] {
    let edge = |to: DVec3| {
        let edge = |axis: usize| DoubleDouble::difference(to[axis], a[axis]);
        scaled_to_one([edge(0), edge(1), edge(2)])
    };
    scaled_to_one(vectors::cross(edge(b), edge(c)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Generates coordinates of all magnitudes, some with few digits.
    fn coordinate() -> impl Strategy<Value = f64> {
        // `prop_oneof` would seed a random number generator for each alternative, which takes far longer.
        (0..16, -1.0..1.0, -490..490).prop_map(|(kind, part, exponent)| match kind {
            0..4 => 10.0 * part,
            4..8 => f64::from((10.0 * part) as f32),
            8..10 => 0.0,
            10 => 1.0,
            11 => 1e-3 * part,
            12 => 5e-324,
            13 => 1e-150,
            14 => 1e150,
            _ => part * 2_f64.powi(exponent),
        })
    }

    fn corner() -> impl Strategy<Value = DVec3> {
        (coordinate(), coordinate(), coordinate()).prop_map(DVec3::from)
    }

    proptest! {
        #![proptest_config(ProptestConfig { cases: 4096, ..crate::properties() })]

        #[test]
        fn a_normal_is_the_same_by_the_quick_way(
            corners in prop::array::uniform8((corner(), corner(), corner())),
            scale in prop_oneof![Just(1.0), Just(1e-140), Just(1e-60), Just(1e60)],
        ) {
            let corners = corners.map(|(a, b, c)| [scale * a, scale * b, scale * c]);
            let mut lanes = [Vectors::ZERO, Vectors::ZERO, Vectors::ZERO];
            for (lane, corners) in corners.iter().enumerate() {
                for (of, at) in lanes.iter_mut().zip(corners) {
                    of.set(lane, *at);
                }
            }
            let normals = unit_normals(&lanes);
            for (lane, corners) in corners.into_iter().enumerate() {
                let slow = slow_normal(corners);
                prop_assert_eq!(exact_normal(corners), slow, "{:?}", corners);
                for _ in 0..2 {
                    prop_assert_eq!(normals::remembered_normal(corners), slow, "{:?}", corners);
                }
                if slow.iter().any(|part| part.high != 0.0) {
                    let bits = |of: [f64; 3]| of.map(f64::to_bits);
                    prop_assert_eq!(bits(normals.get(lane).to_array()), bits(rounded_unit(slow)), "{:?}", corners);
                }
            }
        }
    }
}
