//! Parametric surfaces: the points P(u, v) of a rectangle of u and v.
//!
//! A plugin gives the formula, once for every number type. A ray's hits are the solutions of two equations in u and v, those
//! of two planes through the ray. A tree of boxes finds the parts of the rectangle that a ray may meet; there, Krawczyk's
//! test proves that there is no solution, or exactly one.
//!
//! Source: R. Krawczyk, "Newton-Algorithmen zur Bestimmung von Nullstellen mit Fehlerschranken", Computing 4 (1969);
//! D. Toth, "On Ray Tracing Parametric Surfaces", SIGGRAPH 1985.

mod hit_proofs;
mod locate;
mod patch;
mod search;
mod shape;
mod tree;

pub use patch::Parametric;

use crate::geometry::ray::{MISS, Ray, RayRange, Side};
use crate::geometry::sight::Line;
use crate::world::body::Body;
use crate::world::coincidence::{LEAST_COSINE, ROUNDING};
use crate::world::hittable::{ByDistance, Facts, Hittable, Shape, TieBreaking};
use glam::{DVec2, DVec3};
use patch::{Patches, Rectangle, normal};
use search::Search;
use shape::ParametricShape;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::constants;
use tree::Tree;

/// Marks a shape whose hits are proven by Krawczyk's test.
pub(crate) struct ByPatches;

impl TieBreaking for ByPatches {}

impl Body {
    /// Makes an object of a parametric surface with the reflectivities of its material; `None` where no box contains it, or where
    /// it turns so often that boxes around its parts tell nothing of where they are.
    pub fn parametric(formula: impl Parametric + 'static) -> Option<Self> {
        let ends = formula.ends();
        let patches: Box<dyn Patches> = Box::new(formula);
        let tree = Tree::new(&*patches, ends);
        let bounds = tree.bounds().filter(|whole| tree.tells_apart(whole))?.with_slack(0.0);
        let shape = ParametricShape { patches, tree, bounds };
        Some(Self::plain(Shape::new(shape).by::<ByDistance, ByPatches>()))
    }
}

impl Hittable for ParametricShape {
    /// Returns the distance of the first hit. Where Krawczyk's test does not decide whether there is a hit, as at a pole, there
    /// is one.
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
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
                t.low <= 4.0 * error / along.max(LEAST_COSINE)
            };
            range.origin_side.is_some() && leaves()
        };
        let search = Search { shape: self, line: &line, is_left_out: &is_left_out };
        let found = search.first();
        let narrow = found.narrow.map_or(MISS, |t| t.middle());
        range.keep(found.hit.map_or(narrow, |hit| hit.t.middle().min(narrow)))
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        self.located()
            .locate(at, self.size())
            .map_or(DVec3::Y, |place| normal(&*self.patches, place.uv.to_array()))
    }

    fn facts(&self) -> Facts {
        Facts { is_two_sided: true, may_be_costly: true, ..Facts::within(self.bounds) }
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

/// The number of plain rays that take as long as a search.
const RAYS_PER_SEARCH: u32 = 64;
