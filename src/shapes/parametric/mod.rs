//! Parametric surfaces: the points P(u, v) for a rectangle of u and v.
//!
//! A plugin gives the formula, generic over the number type. A ray's hits are the solutions of two equations in u and
//! v, for two planes through the ray. A tree of boxes finds the parts of the rectangle that a ray may hit. There,
//! Krawczyk's test proves that there is no solution, or exactly one. Bounds of the slopes of each part are kept, so that
//! most parts without a hit take no evaluation. Where they allow only one hit, Newton's method finds it.
//!
//! Source: R. Krawczyk, "Newton-Algorithmen zur Bestimmung von Nullstellen mit Fehlerschranken", Computing 4 (1969);
//! D. Toth, "On Ray Tracing Parametric Surfaces", SIGGRAPH 1985.

mod hit_proofs;
mod krawczyk;
mod locate;
mod patch;
mod search;
mod shape;
#[cfg(test)]
mod tests;
mod tree;

pub use patch::Parametric;

use glam::{DVec2, DVec3};
use patch::{Patches, Rectangle, normal};
use search::{Found, Search};
use shape::ParametricShape;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::{constants, per_axis};
use tabray_world::any_shape::AnyShape;
use tabray_world::body::Body;
use tabray_world::coincidence::{MIN_COSINE, ROUNDING};
use tabray_world::geometry::ray::{Bracket, MISS, Ray, RayBall, RayRange, Side};
use tabray_world::geometry::sight::Line;
use tabray_world::hittable::{Facts, Hittable};
use tabray_world::packets::shape::{ScalarIntersect, by_distance};
use tree::Tree;

/// See [`Made::parametric`](crate::Made::parametric).
pub(super) fn body(formula: impl Parametric + 'static) -> Option<Body> {
    let ends = formula.ends();
    let patches: Box<dyn Patches> = Box::new(formula);
    let tree = Tree::new(&*patches, ends);
    let bounds = tree.bounds().filter(|whole| tree.tells_apart(whole))?;
    let shape = ParametricShape { patches, tree, bounds };
    Some(Body::plain(AnyShape::of_packets(shape)))
}

/// The first hit of a single ray.
struct FirstHit {
    /// The distance of the hit, or [`MISS`].
    distance: f64,
    /// Whether Krawczyk's test proves that this is the first hit, or that there is none.
    is_certain: bool,
}

impl ParametricShape {
    fn first_hit(&self, ray: &Ray, range: &RayRange) -> FirstHit {
        let line = Line { origin: constants(ray.origin), dir: constants(ray.dir) };
        let size = ray.origin.abs().max_element() + self.size();
        // A ray that starts on the surface leaves it there.
        let error = range.origin_error + ROUNDING * size;
        let is_left_out = |t: Interval, at: &Rectangle<f64>, _| {
            if t.high < range.near {
                return true;
            }
            let leaves = || {
                let along = normal(&*self.patches, at.map(|side| side.middle())).dot(ray.dir).abs();
                t.low <= 4.0 * error / along.max(MIN_COSINE)
            };
            range.origin_side.is_some() && leaves()
        };
        let search = Search::new(self, &line, &is_left_out);
        let Found { hit, undecided, narrow } = search.first();
        let narrow = narrow.map_or(MISS, |t| t.middle());
        let distance = range.keep(hit.map_or(narrow, |hit| hit.t.middle().min(narrow)));
        let until = hit.map_or(range.far, |hit| hit.t.high.min(range.far));
        let is_certain = undecided.is_none_or(|from| from > until) && !hit.is_some_and(|hit| hit.is_edge);
        FirstHit { distance, is_certain }
    }
}

impl Hittable for ParametricShape {
    /// Returns the distance of the first hit. Where Krawczyk's test is not conclusive, as at a pole, there is a hit.
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        self.first_hit(ray, range).distance
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        self.located()
            .locate(at, self.size())
            .map_or(DVec3::Y, |place| normal(&*self.patches, place.uv.to_array()))
    }

    fn facts(&self) -> Facts {
        Facts { is_two_sided: true, may_be_costly: true, has_uv: true, ..Facts::within(self.bounds) }
    }

    fn method(&self) -> String {
        "boxes of u and v, then Krawczyk's test".to_owned()
    }

    fn uv(&self, at: DVec3) -> Option<DVec2> {
        let [u, v] = self.ends().map(|side| DVec2::new(side.low, side.width()));
        let uv = self.located().locate(at, self.size())?.uv;
        Some(DVec2::new((uv.x - u.x) / u.y, (uv.y - v.x) / v.y).clamp(DVec2::ZERO, DVec2::ONE))
    }

    fn search_cost(&self, _ray: &Ray, _origin_side: Option<Side>) -> u32 {
        RAYS_PER_SEARCH
    }
}

impl ScalarIntersect for ParametricShape {
    type Author = Self;

    fn author(&self) -> &Self {
        self
    }

    fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        if ray.is_single() {
            let is_on_surface = || self.is_near(ray.origin, range.origin_error);
            return by_distance(ray, range, is_on_surface, |range| {
                let FirstHit { distance, is_certain } = self.first_hit(ray, range);
                is_certain.then_some(distance)
            });
        }
        let about = |at: DVec3, error: f64| {
            per_axis(|axis| Interval::point(at[axis]) + Interval { low: -error, high: error })
        };
        let line = Line { origin: about(ray.origin, ray.drift.origin), dir: about(ray.dir, ray.drift.dir) };
        match Search::new(self, &line, &|_, _, _| false).first() {
            Found { hit: None, undecided: None, .. } => Bracket::MISS,
            Found { hit: Some(hit), undecided, .. }
                if !hit.is_edge && undecided.is_none_or(|from| from > hit.t.high) =>
            {
                Bracket { near: hit.t.low, far: hit.t.high }
            }
            _ => Bracket::UNKNOWN,
        }
    }
}

/// The number of plain rays that take as long as a search.
const RAYS_PER_SEARCH: u32 = 64;
