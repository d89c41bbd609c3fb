//! How rays and points find the faces of a mesh that may matter to them.

use super::tree::{Child, Node, Tree, WIDTH, larger, smaller};
use crate::geometry::aabb::Aabb;
use crate::geometry::ray::{Drift, Ray};
use glam::DVec3;
use std::ops::Range;

/// The size of the traversal stack: seven boxes wait at each of up to 31 levels.
const STACK: usize = 224;

/// The error, in the tree's own coordinates, of a box's distance in single precision as a fraction of the coordinates:
/// eight times the unit of rounding, for the origin, a difference, a product, and the reciprocal of a direction.
const ROUNDING: f64 = 1.0 / (1 << 21) as f64;

/// The smallest magnitude of a component of a direction by which it is divided: over the size of a mesh, a smaller one
/// moves a ray by far less than [`ROUNDING`].
const LEAST: f64 = 1.0 / (1_u64 << 40) as f64;

/// A byte of 1 for each box of a node.
const ALL: u64 = u64::from_le_bytes([1; WIDTH]);

/// Visits faces in the boxes that a ray passes through.
pub(super) trait Faces {
    /// Visits faces by their indices, and returns the distance beyond which no more need be visited, in world units;
    /// a negative number ends the search.
    fn visit(&mut self, faces: Range<usize>) -> f64;
}

/// A ray in the tree's own coordinates, in single precision, started near the mesh.
struct LocalRay {
    /// For each axis, the origin moved by its error, so that distances of boxes' near sides are too small.
    near_origin: [f32; 3],
    /// For each axis, the origin moved by its error the other way, so that distances of boxes' far sides are too large.
    far_origin: [f32; 3],
    inverse: [f32; 3],
    is_backward: [bool; 3],
    /// The distance that the origin was moved toward the mesh.
    skipped: f64,
    scale: f64,
}

impl LocalRay {
    #[inline(always)]
    fn new(tree: &Tree, ray: &Ray, drift: Option<Drift>) -> Self {
        let origin = tree.space.point(ray.origin);
        // The mesh lies within 2 of its center.
        let skipped = (origin.length() - 2.0).max(0.0);
        let near = origin + skipped * ray.dir;
        let error = ROUNDING * (1.0 + near.abs().max_element()) + 8.0 * f64::EPSILON * skipped;
        // In the mesh, no point of the ray is farther than 4 from where it was moved to.
        let error = match drift {
            None => error,
            Some(Drift { origin, dir }) => error + origin * tree.space.scale + dir * (skipped + 8.0),
        };
        let (mut near_origin, mut far_origin, mut inverse) = ([0.0; 3], [0.0; 3], [0.0; 3]);
        let mut is_backward = [false; 3];
        for axis in 0..3 {
            let dir = ray.dir[axis];
            is_backward[axis] = dir < 0.0;
            let (size, sign) = (dir.abs().max(LEAST), if dir < 0.0 { -1.0 } else { 1.0 });
            inverse[axis] = (sign / size) as f32;
            near_origin[axis] = (near[axis] + sign * error) as f32;
            far_origin[axis] = (near[axis] - sign * error) as f32;
        }
        Self { near_origin, far_origin, inverse, is_backward, skipped, scale: tree.space.scale }
    }

    /// Tells whether the ray's origin is finite in single precision. Only then are the boxes missed that do not exist,
    /// which are infinitely far away.
    #[inline(always)]
    fn is_finite(&self) -> bool {
        let sum = |of: [f32; 3]| of[0].abs() + of[1].abs() + of[2].abs();
        (sum(self.near_origin) + sum(self.far_origin)).is_finite()
    }

    /// Returns a distance in the tree's own units from where the ray starts there, rounded up.
    #[inline(always)]
    fn limit(&self, distance: f64) -> f32 {
        let own = distance * self.scale - self.skipped;
        (own + ROUNDING * (own.abs() + 1.0)) as f32
    }

    /// Computes the distances at which the ray enters the boxes of a node, rounded down, and a byte for each box, the
    /// lowest one for the first: 0 where the ray certainly misses the box before `limit`, and else 1.
    #[inline(always)]
    fn enters(&self, node: &Node, limit: f32) -> ([f32; WIDTH], u64) {
        let sides =
            |is_near: bool| {
                [0, 1, 2].map(|axis: usize| {
                    if self.is_backward[axis] == is_near { &node.high[axis] } else { &node.low[axis] }
                })
            };
        let (near, far) = (sides(true), sides(false));
        let Self { near_origin, far_origin, inverse, .. } = self;
        let (mut entries, mut is_missed) = ([0.0; WIDTH], [0; WIDTH]);
        for index in 0..WIDTH {
            let enters = |axis: usize| (near[axis][index] - near_origin[axis]) * inverse[axis];
            let leaves = |axis: usize| (far[axis][index] - far_origin[axis]) * inverse[axis];
            let entry = larger(enters(2), larger(enters(1), larger(enters(0), 0.0)));
            let exit = smaller(leaves(2), smaller(leaves(1), smaller(leaves(0), limit)));
            entries[index] = entry;
            // The sign of the difference, not a comparison: with that, the compiler takes the boxes one by one.
            is_missed[index] = ((exit - entry).to_bits() >> 31) as u8;
        }
        (entries, u64::from_le_bytes(is_missed) ^ ALL)
    }
}

impl Tree {
    /// Visits the faces in the boxes that a ray passes through before a distance in world units, roughly from near to
    /// far; with a drift, those of all rays within it.
    #[inline(always)]
    pub fn along(&self, ray: &Ray, far: f64, drift: Option<Drift>, faces: &mut impl Faces) {
        let local = LocalRay::new(self, ray, drift);
        if !local.is_finite() {
            return;
        }
        let mut limit = local.limit(far);
        let mut stack = [(0.0_f32, 0_u32); STACK];
        let mut waiting = 1;
        while waiting > 0 {
            waiting -= 1;
            let (distance, code) = stack[waiting];
            if distance > limit {
                continue;
            }
            match Child::of(code) {
                Child::Leaf(range) => {
                    let far = faces.visit(range);
                    if far < 0.0 {
                        return;
                    }
                    limit = local.limit(far);
                }
                Child::Node(index) => {
                    let node = &self.nodes[index];
                    let (entries, mut entered) = local.enters(node, limit);
                    let first = waiting;
                    while entered != 0 {
                        let index = (entered.trailing_zeros() / u8::BITS) as usize % WIDTH;
                        entered &= entered - 1;
                        let entry = entries[index];
                        // The nearest box is on top of the stack.
                        let mut place = waiting;
                        while place > first && stack[place - 1].0 < entry {
                            stack[place] = stack[place - 1];
                            place -= 1;
                        }
                        stack[place] = (entry, node.children[index]);
                        waiting += 1;
                    }
                }
            }
        }
    }

    /// Visits the faces in the boxes within a distance of a point, in world units, roughly the nearer ones first.
    pub fn around(&self, at: DVec3, distance: f64, faces: &mut impl Faces) {
        let own = self.space.point(at);
        // The rounding of the point and of the distance.
        let slack = 8.0 * f64::EPSILON * (own.abs().max_element() + 1.0);
        let mut limit = distance * self.space.scale + slack;
        let mut stack = vec![(0.0, 0_u32)];
        while let Some((nearest, code)) = stack.pop() {
            if nearest > limit {
                continue;
            }
            match Child::of(code) {
                Child::Leaf(range) => limit = faces.visit(range) * self.space.scale + slack,
                Child::Node(index) => {
                    let node = &self.nodes[index];
                    let start = stack.len();
                    for index in 0..WIDTH {
                        let mut square = 0.0;
                        for axis in 0..3 {
                            let (low, high) =
                                (f64::from(node.low[axis][index]), f64::from(node.high[axis][index]));
                            let outside = (low - own[axis]).max(own[axis] - high).max(0.0);
                            square += outside * outside;
                        }
                        let distance = square.sqrt();
                        // Boxes that do not exist are infinitely far away.
                        if distance <= limit && distance < f64::INFINITY {
                            stack.push((distance, node.children[index]));
                        }
                    }
                    stack[start..].sort_by(|one, other| other.0.total_cmp(&one.0));
                }
            }
        }
    }

    /// Visits the faces in the boxes that a test lets pass. Boxes are in world coordinates.
    pub fn within(&self, mut enters: impl FnMut(&Aabb) -> bool, mut visit: impl FnMut(Range<usize>)) {
        let mut stack = vec![0_u32];
        while let Some(code) = stack.pop() {
            match Child::of(code) {
                Child::Leaf(range) => visit(range),
                Child::Node(index) => {
                    let node = &self.nodes[index];
                    let is_there = |index: &usize| node.low[0][*index] < f32::INFINITY;
                    let entered =
                        (0..WIDTH).filter(is_there).filter(|index| enters(&self.space.bounds(node, *index)));
                    stack.extend(entered.map(|index| node.children[index]));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Count(usize);

    impl Faces for Count {
        fn visit(&mut self, faces: Range<usize>) -> f64 {
            self.0 += faces.len();
            f64::INFINITY
        }
    }

    #[test]
    fn a_ray_that_is_not_finite_visits_no_face() {
        let (tree, _) = Tree::new(&[DVec3::X, DVec3::Y, DVec3::Z], &[[0, 1, 2]]);
        let visits = |origin, dir, drift| {
            let mut faces = Count(0);
            tree.along(&Ray { origin, dir }, f64::INFINITY, drift, &mut faces);
            faces.0
        };
        let origin = DVec3::splat(-1.0);
        let dir = DVec3::ONE.normalize();
        assert_eq!(visits(origin, dir, None), 1);
        for number in [f64::NAN, f64::INFINITY, -f64::INFINITY, 1e200] {
            assert_eq!(visits(DVec3::splat(number), dir, None), 0, "{number}");
            let drift = Drift { origin: number.abs(), dir: 0.0 };
            assert_eq!(visits(origin, dir, Some(drift)), 0, "{number}");
        }
        assert_eq!(visits(origin, DVec3::NAN, None), 0);
        assert_eq!(visits(origin, DVec3::INFINITY, None), 0);
    }
}
