//! The parameters u and v of a point of a parametric surface.

use super::patch::{Patches, Rectangle};
use super::tree::Tree;
use glam::{DVec2, DVec3};
use tabray_world::coincidence::ROUNDING;
use tabray_world::geometry::aabb::Aabb;

/// The maximum number of Gauss-Newton steps.
const STEPS: usize = 24;

/// The distance, as a multiple of a surface's size, within which no part is nearer than others.
const BLURRED: f64 = 4.0;

/// The maximum number of steps after the best place so far.
const MAX_WORSE: u32 = 2;

/// A place on a surface.
#[derive(Clone, Copy)]
pub(super) struct Place {
    pub uv: DVec2,
    /// The distance from the point in question, in world units.
    pub off: f64,
}

/// A surface: its formula, and the bounding boxes of its parts.
pub(super) struct Located<'s> {
    pub patches: &'s dyn Patches,
    pub tree: &'s Tree,
}

impl Located<'_> {
    /// Returns the place of a computed point of the surface. `size` bounds the surface's coordinates.
    pub fn locate(&self, at: DVec3, size: f64) -> Option<Place> {
        let error = ROUNDING * (at.abs().max_element() + size);
        // The error along a ray is larger by the reciprocal of the cosine.
        [16.0, 1e4, 1e9].into_iter().find_map(|times| self.nearest(at, times * error))
    }

    /// Returns the place nearest to a point, among parts with boxes within a distance. If that is many times the size of
    /// the surface, the place is in the part whose middle is nearest.
    pub fn nearest(&self, at: DVec3, distance: f64) -> Option<Place> {
        let mut nearest: Option<Place> = None;
        if self.tree.bounds().is_some_and(|Aabb { low, high }| distance > BLURRED * (high - low).length()) {
            let off = |leaf: usize| (DVec3::from(self.tree.flat(leaf).middle) - at).length();
            let leaf = (0..self.tree.leaf_count()).min_by(|one, other| off(*one).total_cmp(&off(*other)))?;
            let (uv, off) = self.nearest_in(at, self.tree.leaf(leaf));
            return (off <= 2.0 * distance).then_some(Place { uv, off });
        }
        self.tree.near(at, distance, |leaf| {
            let (uv, off) = self.nearest_in(at, self.tree.leaf(leaf));
            if nearest.is_none_or(|known| off < known.off) {
                nearest = Some(Place { uv, off });
            }
        });
        nearest
    }

    /// Returns the place in a part that is nearest to a point, and its distance, by the Gauss-Newton method.
    fn nearest_in(&self, at: DVec3, part: &Rectangle<f64>) -> (DVec2, f64) {
        let [low, high] = [part.map(|side| side.low), part.map(|side| side.high)].map(DVec2::from);
        let mut uv = 0.5 * (low + high);
        let (mut best, mut worse) = ((uv, f64::INFINITY), 0);
        for _ in 0..STEPS {
            let [point, along_u, along_v] = self.patches.at(uv.to_array());
            let off = at - point;
            // Where only rounding is left, steps lead back and forth.
            worse = if off.length() < best.1 { 0 } else { worse + 1 };
            if worse == 0 {
                best = (uv, off.length());
            } else if worse == MAX_WORSE {
                break;
            }
            let (a, b, c) = (along_u.length_squared(), along_u.dot(along_v), along_v.length_squared());
            let (right, above) = (off.dot(along_u), off.dot(along_v));
            // The small terms keep the determinant above 0 at a pole, too.
            let determinant = a * c - b * b + f64::MIN_POSITIVE + 1e-14 * a * c;
            let step = DVec2::new(c * right - b * above, a * above - b * right) / determinant;
            let next = (uv + step).clamp(low, high);
            if !next.is_finite() || next == uv {
                break;
            }
            uv = next;
        }
        best
    }
}
