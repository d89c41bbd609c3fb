//! The surface of a part of a solid, for single rays.

use glam::{DVec2, DVec3};
use std::sync::Arc;
use tabray_exact::double_double::DoubleDouble;
use tabray_world::any_shape::AnyShape;
use tabray_world::body::Part;
use tabray_world::certify::{Premise, ProofMethods};
use tabray_world::coincidence::{self, CLOSE, MIN_COSINE, ROUNDING};
use tabray_world::geometry::aabb::Aabb;
use tabray_world::geometry::ray::{Bracket, MISS, Ray, RayBall, RayRange, Side};
use tabray_world::hittable::{Curvature, Facts, Hittable, SurfaceHit};
use tabray_world::packets::shape::{HitQueries, by_distance};
use tabray_world::solid::Tree;

/// The maximum number of hits of a part that are visited along a ray.
const MAX_HITS: usize = 1024;

/// The distance from a possibly coincident surface at which both of its sides are examined, as a multiple of the error
/// of the point.
const BESIDE: f64 = 256.0;

/// The distance before a hit at which a ray is tested for being in the solid, as a fraction of the magnitude of the
/// coordinates involved.
const SHORTLY: f64 = 1e-6;

/// Known facts about a ray before its search for a part of a solid.
#[derive(Clone, Copy, Default)]
pub(super) struct Known {
    /// Bounds of the distances at which the ray is in other parts.
    pub within: Option<Bracket>,
    /// A bracket of the ray's first hit of the part.
    pub first: Option<Bracket>,
}

/// The surface of a part, where it is the surface of the solid.
pub struct SolidPart {
    pub(super) parts: Arc<[Part]>,
    around: Arc<[Option<Aabb>]>,
    /// The index of the part whose surface this is.
    pub(super) index: usize,
    /// Whether the solid lies on the outer side of the part.
    pub(super) is_outer: bool,
    /// The condition under which a point near this surface lies in the solid, given the parts that contain it.
    pub(super) tree: Tree,
    /// The condition under which any point lies in the solid.
    whole: Tree,
    /// The path to the part through the tree.
    path: Vec<usize>,
    facts: Facts,
    /// Whether the solid is a surface that a clip cuts open.
    is_open: bool,
    /// Whether the part is a clipped surface that is invisible outside of all other parts.
    is_within_others: bool,
}

impl SolidPart {
    /// Makes the surface of a part, given by its index.
    pub(super) fn new(
        parts: &Arc<[Part]>,
        around: &Arc<[Option<Aabb>]>,
        (index, is_outer, is_open): (usize, bool, bool),
        (tree, whole, path): (Tree, Tree, Vec<usize>),
        bounds: Option<Aabb>,
    ) -> Self {
        let (parts, around) = (parts.clone(), around.clone());
        let own = parts[index].body.shape.facts();
        let can_hit_itself = if is_outer { own.can_hit_itself.opposite() } else { own.can_hit_itself };
        let facts =
            Facts { bounds, can_hit_itself, is_two_sided: true, plane: None, ends_as_planes: false, ..own };
        let is_within_others = parts[index].is_clipped && {
            let outside = vec![false; parts.len()];
            let inside: Vec<bool> = (0..parts.len()).map(|part| part == index).collect();
            tree.owner(&outside, &inside) != Some(index)
        };
        Self { parts, around, index, is_outer, tree, whole, path, facts, is_open, is_within_others }
    }

    /// Tells whether the search of single rays is limited to where they are in other parts.
    pub(super) fn is_within_others(&self) -> bool {
        self.is_within_others
    }

    /// Returns the shape of the part.
    pub(super) fn own(&self) -> &AnyShape {
        &self.parts[self.index].body.shape
    }

    /// Returns the box around the surface.
    pub(super) fn around(&self) -> Option<&Aabb> {
        self.facts.bounds.as_ref()
    }

    /// Tells whether all of the part's surface is the solid's.
    pub(super) fn is_whole(&self) -> bool {
        self.path.is_empty()
    }

    /// Converts a side of the solid to a side of the part, or the other way round.
    #[inline]
    pub(super) fn side(&self, of: Side) -> Side {
        if self.is_outer { of.opposite() } else { of }
    }

    /// Tells whether a point lies in a part, or `None` if the part's surface may be within `error`, in world units.
    fn contains(&self, part: usize, at: DVec3, error: f64) -> Option<bool> {
        if let Some(Aabb { low, high }) = self.around[part]
            && ((low - error).cmpgt(at).any() || at.cmpgt(high + error).any())
        {
            return Some(false);
        }
        self.parts[part].body.shape.contains(at, error)
    }

    /// Tells whether a point lies in the solid, or `None` if its surface may be within `error`, in world units.
    fn holds(&self, at: DVec3, error: f64) -> Option<bool> {
        self.whole.holds(&mut |part| self.contains(part, at, error))
    }

    /// Tells whether a hit of the part is a hit of the solid, or `None` if the surface of another part may be within
    /// `error`, in world units.
    fn is_on_solid(&self, at: DVec3, error: f64) -> Option<bool> {
        self.tree.is_on_solid(&self.path, &mut |part| self.contains(part, at, error))
    }

    /// Tells whether a hit of the part is a hit of the solid if all other surfaces within `error`, in world units, lie
    /// in the part's own plane by the numbers of the scene. Returns `None` if that is undecided.
    fn is_on_solid_in_plane(&self, at: DVec3, error: f64) -> Option<bool> {
        let own = self.own().facet(at, error)?;
        let (mut outside, mut inside) = (vec![false; self.parts.len()], vec![false; self.parts.len()]);
        inside[self.index] = true;
        let mut is_known = true;
        self.tree.holds(&mut |part| {
            if part != self.index {
                let beside = self.contains(part, at, error).map(|holds| [holds; 2]);
                let beside = beside.or_else(|| self.parts[part].body.shape.facet(at, error)?.beside(&own));
                match beside {
                    Some(beside) => [outside[part], inside[part]] = beside,
                    None => is_known = false,
                }
            }
            // `None` keeps the evaluation from ending early, and so each part is visited.
            None
        });
        is_known.then(|| self.tree.owner(&outside, &inside) == Some(self.index))
    }

    /// Tells whether a hit of the part is a hit of the solid by examining both sides of the surface, at a multiple of
    /// `error`, in world units: along the normal, or along the ray where another part has an edge.
    fn is_on_solid_by_sides(&self, ray: &Ray, at: DVec3, normal: DVec3, error: f64) -> bool {
        let step = BESIDE * (error + ROUNDING * at.abs().max_element());
        let ahead = if ray.dir.dot(normal) < 0.0 { -ray.dir } else { ray.dir };
        let beside = |outward: DVec3, may_guess: bool| -> Option<bool> {
            let sides = [(step * outward, false), (-step * outward, true)].map(|(step, is_inside)| {
                let inside = |part: usize| match self.contains(part, at + step, 0.0) {
                    _ if part == self.index => Some(is_inside),
                    None if may_guess => Some(false),
                    holds => holds,
                };
                (0..self.parts.len()).map(inside).collect::<Option<Vec<_>>>()
            });
            let [Some(outside), Some(inside)] = sides else { return None };
            Some(self.tree.owner(&outside, &inside) == Some(self.index))
        };
        let known = beside(normal, false).or_else(|| beside(ahead, false));
        known.or_else(|| beside(normal, true)).unwrap_or(false)
    }

    /// Tells whether a hit of the part is a hit of the solid, or `None` if that is undecided. `size` is the magnitude
    /// of the coordinates involved.
    fn is_certainly_on_solid(&self, ray: &Ray, distance: f64, size: f64) -> Option<bool> {
        let at = ray.at(distance);
        // The first error holds for any hit. The second, for this hit, needs the normal.
        self.is_on_solid(at, ROUNDING / MIN_COSINE * size).or_else(|| {
            let error = coincidence::error(ray, distance, self.own().normal(at), self.facts.max_coordinate);
            self.is_on_solid(at, error).or_else(|| self.is_on_solid_in_plane(at, error))
        })
    }

    /// Tells whether a ray is certainly in the solid shortly before a hit. If so, and if the ray enters the part at the
    /// hit, it does not enter the solid there, even where surfaces coincide.
    fn is_within(&self, ray: &Ray, distance: f64, size: f64) -> bool {
        let before = ray.at(distance - SHORTLY * size);
        // The tree omits parts far from this surface.
        let is_near = self
            .facts
            .bounds
            .is_none_or(|Aabb { low, high }| low.cmple(before).all() && before.cmple(high).all());
        is_near
            && distance > 2.0 * SHORTLY * size
            && self.tree.holds(&mut |part| self.contains(part, before, ROUNDING * size)) == Some(true)
    }

    /// Returns bounds of the distances, in world units, at which a ray is in another part, or `None` if it certainly
    /// misses all of them.
    pub(super) fn within_others(&self, ray: &Ray) -> Option<Bracket> {
        let mut within: Option<Bracket> = None;
        for part in (0..self.parts.len()).filter(|part| *part != self.index) {
            let Some(around) = &self.around[part] else { return Some(Bracket { near: 0.0, far: MISS }) };
            let shape = self.parts[part].body.shape.packets();
            let ahead = shape.t_bounds(&ray.into(), &RayRange::ALL);
            if ahead.near == MISS {
                continue;
            }
            // A ray back from beyond the part first hits it where this ray leaves it.
            let beyond = (around.middle() - ray.origin).length() + 2.0 * around.half_size().length();
            let back = Ray { origin: ray.at(beyond), dir: -ray.dir };
            let behind = shape.t_bounds(&back.into(), &RayRange::ALL);
            // The slack includes surfaces that touch the part.
            let slack = CLOSE * (ray.origin.abs().max_element() + beyond);
            let is_outside = self.contains(part, ray.origin, slack) == Some(false);
            let near = if is_outside { (ahead.near - slack).max(0.0) } else { 0.0 };
            let far = beyond - if behind.near < MISS { behind.near } else { 0.0 } + slack;
            let (other_near, other_far) = within.map_or((MISS, 0.0), |other| (other.near, other.far));
            within = Some(Bracket { near: near.min(other_near), far: far.max(other_far) });
        }
        within
    }

    /// Returns the range to search for the part's own first hit of a ray, given bounds of its distances within other
    /// parts.
    pub(super) fn first_range(&self, range: &RayRange, within: &Bracket) -> RayRange {
        let far = if range.far < MISS { (1.0 + CLOSE) * range.far } else { MISS };
        let (near, far) = (within.near.max(0.0), far.min(within.far));
        RayRange { near, far, ..self.own_range(range) }
    }

    /// Returns the distance of the first visible hit, and whether it is certain.
    pub(super) fn first_hit(&self, ray: &Ray, range: &RayRange, known: Known) -> (f64, bool) {
        let Known { within, mut first } = known;
        let (shape, max_coordinate) = (self.own(), self.facts.max_coordinate);
        let (mut start, mut gone, mut is_certain) = (*ray, 0.0, true);
        let mut leaves = range.origin_side.map(|side| self.side(side));
        let mut error = range.origin_error;
        let (low, high) = (ray.origin - error, ray.origin + error);
        let is_clipped = self.parts[self.index].is_clipped;
        let is_apart =
            !is_clipped && self.around[self.index].is_some_and(|own| !own.overlaps(&Aabb { low, high }));
        let within = match self.is_within_others {
            true => within.or_else(|| self.within_others(ray)),
            false => Some(Bracket { near: 0.0, far: MISS }),
        };
        let Some(within) = within else { return (MISS, true) };
        // The side of the part from which the next hit comes. The sides alternate.
        let mut from = leaves.or(is_apart.then_some(Side::Outside));
        for _ in 0..MAX_HITS {
            if leaves.is_some_and(|side| !shape.can_hit_itself(side)) {
                break;
            }
            let far = if range.far < MISS { (1.0 + CLOSE) * range.far - gone } else { MISS };
            let (near, end) = ((within.near - gone).max(0.0), far.min(within.far - gone));
            if end <= near {
                break;
            }
            let left = RayRange { near, far: end, origin_side: leaves, origin_error: error };
            let bracket = first.take().unwrap_or_else(|| shape.t_bounds(&start, &left));
            let is_exact = bracket.near == bracket.far;
            let onward = if is_exact { bracket.near } else { shape.distance(&start, &left) };
            if onward == MISS {
                // For a ray that starts on the surface, the start itself is doubtful.
                is_certain &= !bracket.is_doubtful() || leaves == Some(Side::Outside) && far == MISS;
                break;
            }
            let distance = gone + onward;
            let at = ray.at(distance);
            let size = ray.origin.abs().max_element() + distance + max_coordinate;
            let sure = self.is_certainly_on_solid(ray, distance, size);
            // The visible side, which needs a normal, does not matter then.
            if sure == Some(true) && !bracket.is_doubtful() {
                return (range.keep(distance), is_certain);
            }
            let side = match from {
                Some(from) if !bracket.is_doubtful() => from,
                _ => Side::seen_along(ray.dir, shape.normal(at)),
            };
            is_certain &= !bracket.is_doubtful() || leaves == Some(side);
            let sure = sure.or_else(|| {
                let is_hidden = self.side(side) == Side::Outside && self.is_within(ray, distance, size);
                is_hidden.then_some(false)
            });
            is_certain &= sure.is_some();
            let is_on_solid = sure.unwrap_or_else(|| {
                let normal = shape.normal(at);
                self.is_on_solid_by_sides(
                    ray,
                    at,
                    normal,
                    coincidence::error(ray, distance, normal, max_coordinate),
                )
            });
            if is_on_solid {
                return (range.keep(distance), is_certain);
            }
            leaves = Some(side.opposite());
            from = leaves;
            // The hit may be further off along the ray, but not off the surface.
            error = ROUNDING * size;
            (start.origin, gone) = (at, distance);
        }
        (MISS, is_certain)
    }

    /// Returns a bracket of the first hit of one ray.
    pub(super) fn t_bounds(&self, ray: &RayBall, range: &RayRange) -> Bracket {
        self.t_bounds_from(ray, range, Known::default())
    }

    /// Returns a bracket of the first hit of one ray, given known facts about it.
    pub(super) fn t_bounds_from(&self, ray: &RayBall, range: &RayRange, known: Known) -> Bracket {
        if self.is_whole() {
            return self.own().packets().t_bounds(ray, &self.own_range(range));
        }
        // A copy of a solid is a solid of copies.
        if !ray.is_single() {
            return Bracket::UNKNOWN;
        }
        let is_on_surface = || self.own().is_on_surface(ray.origin, range.origin_error);
        by_distance(ray, range, is_on_surface, |range| {
            let (distance, is_certain) = self.first_hit(ray, range, known);
            is_certain.then_some(distance)
        })
    }

    fn own_range(&self, range: &RayRange) -> RayRange {
        RayRange { origin_side: range.origin_side.map(|side| self.side(side)), ..*range }
    }
}

impl Hittable for SolidPart {
    fn distance(&self, ray: &Ray, range: &RayRange) -> f64 {
        if self.is_whole() {
            self.own().distance(ray, &self.own_range(range))
        } else {
            self.first_hit(ray, range, Known::default()).0
        }
    }

    fn normal(&self, at: DVec3) -> DVec3 {
        let normal = self.own().normal(at);
        if self.is_outer { -normal } else { normal }
    }

    fn facts(&self) -> Facts {
        self.facts
    }

    fn shading_normal(&self, at: DVec3, normal: DVec3) -> DVec3 {
        self.own().shading_normal(at, normal)
    }

    fn uv(&self, at: DVec3) -> Option<DVec2> {
        self.own().uv(at)
    }

    fn curvature(&self, at: DVec3) -> Option<Curvature> {
        self.own().curvature(at)
    }

    fn face(&self, at: DVec3) -> Option<u32> {
        self.own().face(at)
    }

    fn face_hit(&self, ray: &Ray, distance: f64) -> Option<u32> {
        self.own().face_hit(ray, distance)
    }

    fn part(&self, ray: &Ray, distance: f64) -> Option<String> {
        let Part { name, body, .. } = &self.parts[self.index];
        let own = body.shape.part(ray, distance);
        Some(format!("part `{name}`{}", own.map_or(String::new(), |own| format!(", {own}"))))
    }

    fn read_from_files(&self, each: &mut dyn FnMut(&[u8])) {
        self.parts.iter().for_each(|part| part.body.shape.read_from_files(each));
    }

    fn search_cost(&self, ray: &Ray, origin_side: Option<Side>) -> u32 {
        let own = self.own().search_cost(ray, origin_side.map(|side| self.side(side)));
        // The hits after the first cost as much again.
        if self.is_whole() { own } else { 2 * own }
    }

    fn method(&self) -> String {
        let Part { name, body, .. } = &self.parts[self.index];
        let own = body.shape.method();
        if self.is_whole() {
            format!("all of part `{name}`: {own}")
        } else {
            format!("part `{name}` where the others allow it: {own}")
        }
    }

    fn clearance(&self, from: DVec3) -> Option<f64> {
        self.own().clearance(from)
    }
}

impl HitQueries for SolidPart {
    fn is_on_surface(&self, at: DVec3, error: f64) -> bool {
        let is_near = self
            .facts
            .bounds
            .is_none_or(|Aabb { low, high }| (low - error).cmple(at).all() && at.cmple(high + error).all());
        is_near && self.own().is_on_surface(at, error)
    }

    fn contains(&self, at: DVec3, error: f64) -> Option<bool> {
        self.holds(at, error)
    }

    fn is_of_solid(&self) -> bool {
        true
    }

    fn is_of_closed_solid(&self) -> bool {
        !self.is_open
    }

    fn fine_distance(&self, ray: &Ray, distance: f64) -> Option<DoubleDouble> {
        self.own().packets().fine_distance(ray, distance)
    }

    fn surface_hit(&self, ray: &Ray, distance: f64, at: DVec3, part: Option<usize>) -> Option<SurfaceHit> {
        let hit = self.own().surface_hit(ray, distance, at, part);
        Some(SurfaceHit { normal: if self.is_outer { -hit.normal } else { hit.normal }, ..hit })
    }

    fn premises(&self, of: &'static str, each: &mut dyn FnMut(&'static str, Premise)) {
        for Part { body, .. } in &*self.parts {
            body.shape.premises(body.entity.unwrap_or(of), each);
        }
    }

    fn proven(&self) -> Option<&dyn ProofMethods> {
        Some(self)
    }
}
