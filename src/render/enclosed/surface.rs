//! The points of a surface that lines hit.

use super::number::{Enclosing, ranges};
use super::scene::{Colour, EnclosedScene, Place};
use super::tangents::tangents;
use glam::DVec2;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::{dot, per_axis};
use tabray_world::certify::Precise;
use tabray_world::directions::facet;
use tabray_world::geometry::sight::Line;
use tabray_world::interface::{Crossing, Law};
use tabray_world::material::{Reflectivity, Rgb};
use tabray_world::patch::{MEAN_ROUNDING, MIN_COSINE, PatchOf, Window};
use tabray_world::rules;
use tabray_world::scene::model::Object;
use tabray_world::surface_point::Point;

/// A patch of a surface, whose mean colour is shown.
struct SeenPatch<F> {
    /// The maximum distance of the points from the middle, in world units along each axis.
    reach: f64,
    bounds: Option<PatchOf<Interval<F>>>,
}

/// The points that lines hit, and how they look there.
pub(super) struct HitPoints<N> {
    pub place: Place,
    pub at: [N; 3],
    /// The unit normals with which the points are shaded, turned to face the lines where both sides are lit.
    pub normal: [N; 3],
    /// Whether the normals are turned inward.
    pub is_inside: bool,
    /// The unit normals of the surface itself, turned likewise, where the points are shaded with others.
    pub geometric_normal: Option<[N; 3]>,
    pub ambient: Colour<N>,
    pub diffuse: Colour<N>,
    pub specular: Colour<N>,
    /// The fraction of what is behind the points that they cover; `None` where they cover all.
    pub coverage: Option<N>,
}

impl<N: Enclosing> HitPoints<N> {
    /// Returns the points at t of lines, once for each way that the normals may face; `None` where the normals or the
    /// look are open. `window` has the samples' window and the path lengths before the lines: with it, a shader's
    /// look is a mean over a patch.
    pub fn facing(
        scene: &EnclosedScene,
        (line, length_of_dir): (&Line<N>, N),
        t: N,
        place: Place,
        window: Option<(Window, N)>,
    ) -> Option<Vec<Self>> {
        let object = &scene.model.objects[place.object];
        let zero = N::of(0.0);
        let at = line.at(t);
        let shape = object.shape.proven()?;
        let normal = N::gradient(shape, at, place.part);
        let length = dot(normal, normal).sqrt();
        let range = length.range();
        if range.low <= zero || !range.is_bounded() {
            return None;
        }
        let outward = per_axis(|axis| normal[axis] / length);
        let toward = if object.shape.is_two_sided() {
            dot(outward, line.dir).range()
        } else {
            Interval::point(N::of(-1.0))
        };
        let window = window.filter(|_| object.shader.sees().patch);
        let patch = window.map(|(Window { start, spread, .. }, travelled)| {
            let width = (travelled + t * length_of_dir) * N::constant(spread) + N::constant(start);
            let dir = per_axis(|axis| line.dir[axis] / length_of_dir);
            let cosine = dot(outward, dir).abs().coarse().low;
            SeenPatch {
                reach: (1.0 + 1e-9) * width.coarse().high / cosine.max(MIN_COSINE),
                bounds: PatchOf::seen(ranges(at), ranges(dir), ranges(outward), width.range()),
            }
        });
        let patch = patch.as_ref();
        let mut all = Vec::with_capacity(2);
        if toward.low <= zero {
            all.push(Self::shaded(object, at, place, outward, false, patch)?);
        }
        if toward.high >= zero {
            all.push(Self::shaded(object, at, place, per_axis(|axis| -outward[axis]), true, patch)?);
        }
        Some(all)
    }

    /// Returns points whose normals face the lines, turned inward or not. For a patch, the look is the mean over the
    /// patch.
    fn shaded(
        object: &Object,
        at: [N; 3],
        place: Place,
        own: [N; 3],
        is_turned: bool,
        patch: Option<&SeenPatch<N::End>>,
    ) -> Option<Self> {
        let shape = object.shape.proven()?;
        // Mirrors use the shading normal, too.
        let normal = N::shading_normal(shape, at, place.part, own)?;
        let outward = if is_turned { per_axis(|axis| -normal[axis]) } else { normal };
        let (sees, outward) = (object.shader.sees(), ranges(outward));
        let seen = |at| Point::seen(shape, sees, place.part, at, Some(outward));
        let mut at_ranges = ranges(at);
        if let Some(SeenPatch { reach, .. }) = patch {
            let around = Interval { low: N::of(-reach), high: N::of(*reach) };
            at_ranges = at_ranges.map(|along| along + around);
        }
        let mut bounds = patch.and_then(|patch| patch.bounds);
        if let Some(bounds) = &mut bounds
            && let Some(uv) = seen(ranges(at)).uv
        {
            let proofs = N::End::proofs(shape);
            bounds.find_uv(uv.map(Interval::coarse), |at| proofs.uv_bounds(at, place.part));
        }
        let seen_point = Point { patch: bounds, ..seen(at_ranges) };
        let looks = N::End::looks(&*object.shader);
        let covers_in_part = object.shader.covers_in_part();
        let coverage = covers_in_part.then(|| N::enclosing(looks.covers(&seen_point)));
        let normal = if object.shader.bends() {
            // The normals are those of the point, not the mean over a patch.
            let mut point = seen(ranges(at));
            if sees.tangents {
                point.tangents = tangents(&object.shape, place.part, point.position, outward);
            }
            let bent = looks.leans(&point, outward)?.map(N::enclosing);
            if is_turned { bent.map(|along| -along) } else { bent }
        } else {
            normal
        };
        let geometric_normal = (normal != own).then_some(own);
        let rounding = |of: Interval<N::End>| {
            let error = if patch.is_some() { MEAN_ROUNDING * of.coarse().magnitude() } else { 0.0 };
            of + Interval { low: N::of(-error), high: N::of(error) }
        };
        let reflectivity = |of| {
            let of = looks.reflects(of, &object.material, &seen_point)?;
            Some(per_axis(|channel| N::enclosing(rounding(of[channel]))))
        };
        let mut ambient: Colour<N> = reflectivity(Reflectivity::Ambient)?;
        let emission = object.material.emission;
        if emission != Rgb::ZERO {
            ambient = per_axis(|channel| ambient[channel] + N::constant(emission[channel]));
        }
        Some(Self {
            place,
            at,
            normal,
            is_inside: is_turned,
            geometric_normal,
            ambient,
            diffuse: reflectivity(Reflectivity::Diffuse)?,
            specular: reflectivity(Reflectivity::Specular)?,
            coverage,
        })
    }

    /// Returns the points with the normals of the facets that two numbers from 0 to 1 choose, among the facets that are
    /// seen along these unit vectors; `None` where the normals are open.
    pub fn with_facet(&self, dir: [N; 3], roughness: f64, numbers: DVec2) -> Option<Self> {
        let own = self.normal;
        // Bent normals may face away from the rays, and are turned.
        if dot(own, dir).range().high >= N::of(0.0) {
            return None;
        }
        let normal = facet(own, dir.map(|along| -along), roughness * roughness, numbers)?;
        Some(Self { normal, geometric_normal: Some(self.geometric_normal.unwrap_or(own)), ..*self })
    }

    /// Encloses what the coat of the points' material lets pass of light at angles to their normals, given their cosines;
    /// `None` where that is open.
    pub fn through_coat(&self, scene: &EnclosedScene, light: N, cosine: N) -> Option<N> {
        match scene.model.objects[self.place.object].material.enclosed_coat() {
            None => Some(light),
            Some(coat) => Some(light * N::enclosing(Interval::from_f64(coat.passes(cosine.coarse())?))),
        }
    }

    /// Returns how rays along these unit vectors continue at an interface; `None` where that is open.
    pub fn crossing(&self, law: Law, dir: [N; 3]) -> Option<Crossing<[N; 3]>> {
        let cross = |normal| law.cross(dir, normal, self.is_inside);
        let Some(geometric_normal) = self.geometric_normal else { return cross(self.normal) };
        // Bent normals may face away from the rays; the tracer then turns them.
        if dot(dir, self.normal).range().high >= N::of(0.0) {
            return None;
        }
        // They may also lead a ray back to the side from which it comes. Then the surface's own normals replace them.
        let crossing = cross(self.normal)?;
        match crossing.onward.map(|onward| dot(onward, geometric_normal).range()) {
            Some(through) if through.low >= N::of(0.0) => cross(geometric_normal),
            Some(through) if through.high >= N::of(0.0) => None,
            _ => Some(crossing),
        }
    }

    /// Returns the mirrored directions of rays along `dir`, with the same length; `None` where they are open.
    pub fn mirrored(&self, dir: [N; 3]) -> Option<[N; 3]> {
        let mirrored = rules::mirrored(dir, self.normal);
        let Some(geometric_normal) = self.geometric_normal else { return Some(mirrored) };
        // A direction that bent normals mirror through the surface is turned back.
        let through = (dot(mirrored, geometric_normal) * dot(dir, geometric_normal)).range();
        if through.low > N::of(0.0) {
            Some(rules::mirrored(mirrored, geometric_normal))
        } else {
            (through.high <= N::of(0.0)).then_some(mirrored)
        }
    }
}

/// Returns the fraction of light that passes through an object at points; `None` where it is open.
pub(super) fn tint<N: Enclosing>(transparency: f64, diffuse: Colour<N>) -> Option<Colour<N>> {
    let [red, green, blue] = diffuse;
    let (transparency, one) = (N::constant(transparency), N::constant(1.0));
    let strongest = red.max(green).max(blue);
    // The strongest channel is divided by itself, and no other is greater.
    let ratio = |channel: N| {
        if channel == strongest && strongest.is_exact() { one } else { (channel / strongest).min(one) }
    };
    let range = strongest.range();
    if range.low > N::of(0.0) {
        Some(per_axis(|channel| transparency * ratio(diffuse[channel])))
    } else {
        (range.high <= N::of(0.0)).then_some([transparency; 3])
    }
}

/// Tells whether a colour is black, for certain.
pub(super) fn is_black<N: Enclosing>(colour: &Colour<N>) -> bool {
    colour.iter().all(|channel| channel.is_zero())
}
