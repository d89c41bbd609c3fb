//! First hits of rays with a mesh: brackets in `f64` arithmetic, distances, and proofs.

use super::approach::{Approach, FAR};
use super::face::{Face, Leaving, t_bounds};
use super::known::{Known, Nearest};
use super::points::is_on_surface;
use super::search::Scratch;
use super::surface::Surface;
use crate::plane::Plane;
use crate::triangle::{Triangle, plane_for_distances};
use glam::DVec3;
use std::cell::Cell;
use tabray_exact::interval::{Float, Fraction, Interval, Wide};
use tabray_world::accuracy::NotClassic;
use tabray_world::certify::{self, Enclosure, HitEnclosure, Precision};
use tabray_world::coincidence::{CLOSE, ROUNDING, close};
use tabray_world::geometry::aabb::{Aabb, larger};
use tabray_world::geometry::ray::{Bracket, MISS, Ray, RayBall, RayError, RayRange};
use tabray_world::geometry::sight::Sight;
use tabray_world::simd::cpu::Cpu;

impl Surface {
    /// Finds a bracket of a ray's first hit in a range. If `is_any`, any certain hit in the range is enough.
    #[inline(always)]
    pub(super) fn first(
        &self,
        cpu: Cpu,
        ray: &Ray,
        range: &RayRange,
        leaving: Leaving,
        drift: RayError,
        is_any: bool,
    ) -> Known {
        let mut nearest = Nearest::NONE;
        Scratch::with(|Scratch { stack, .. }| {
            self.tree.closest_within(cpu, stack, ray, drift, range.far, |face, end| {
                let bracket = t_bounds(self.corners(face), ray, range.far, leaving, drift);
                if bracket.near == MISS {
                    return end;
                }
                nearest.add(face as u64, bracket);
                nearest.end(ray, end, is_any)
            });
        });
        nearest.known(ray, range.far, leaving, is_any)
    }

    /// Returns the bracket of a ray's first hit in a range. Its width is 0 if `f64` arithmetic finds the distance.
    #[inline(always)]
    pub(super) fn bracket<A: NotClassic>(
        &self,
        cpu: Cpu,
        ray: &Ray,
        range: &RayRange,
        leaving: Leaving,
    ) -> (Bracket, Option<usize>) {
        let known = self.first(cpu, ray, range, leaving, RayError::NONE, false);
        self.bracketed::<A>(known, self.crossing::<A>(known, ray), ray, range, leaving)
    }

    /// Like [`bracket`](Self::bracket), given what is known of the hit and, if that is a face, the distance of its
    /// plane. Also returns the face that [`face_along`](Self::face_along) finds at the bracket's distance, if it is
    /// known.
    #[inline(always)]
    pub(super) fn bracketed<A: NotClassic>(
        &self,
        known: Known,
        crossing: f64,
        ray: &Ray,
        range: &RayRange,
        leaving: Leaving,
    ) -> (Bracket, Option<usize>) {
        let (distance, bracket, only) = match known {
            Known::Face { face, bracket, is_alone } => (crossing, bracket, is_alone.then_some(face)),
            Known::Bracket(bracket) if bracket.far < MISS => {
                (self.refined::<A>(ray, range, leaving, bracket), bracket, None)
            }
            Known::Bracket(bracket) => return (bracket, None),
        };
        if distance.is_nan() {
            return (bracket, None);
        }
        let distance = distance.clamp(bracket.near, bracket.far);
        let close = if range.far < MISS { close(ray, range.far) } else { 0.0 };
        // At the distance of another surface, a wider bracket lets more digits decide which comes first.
        if (distance - range.far).abs() <= close {
            return (Bracket { near: distance - close, far: distance + close }, None);
        }
        (Bracket::exactly(distance), only)
    }

    /// Returns a bracket of the first hits in a range, for all rays that `ray` stands for.
    #[inline(always)]
    pub(super) fn bracket_within<A: NotClassic>(&self, cpu: Cpu, ray: &RayBall, range: &RayRange) -> Bracket {
        let known = self.first(cpu, ray, range, NOTHING, ray.drift, false);
        known.within(self.crossing::<A>(known, ray))
    }

    /// Returns the distance of the plane of the face that a ray hits, if that is known. Returns NaN if `f64` arithmetic
    /// is not enough.
    #[inline(always)]
    fn crossing<A: NotClassic>(&self, known: Known, ray: &Ray) -> f64 {
        known.face().map_or(f64::NAN, |face| self.plane::<A>(face).quick_crossing(ray))
    }

    /// Returns the distance of a certain hit with a bracket, or NaN if `f64` arithmetic is not enough.
    #[inline(never)]
    pub(super) fn refined<A: NotClassic>(
        &self,
        ray: &Ray,
        range: &RayRange,
        leaving: Leaving,
        bracket: Bracket,
    ) -> f64 {
        let mut first = MISS;
        let far = bracket.far.next_up();
        self.each(ray, &RayRange { far, ..*range }, leaving, |face, _| {
            let distance = self.plane::<A>(face).quick_crossing(ray);
            first = if distance < first || distance.is_nan() { distance } else { first };
            far
        });
        first
    }

    /// Calls a function with each face that a ray may hit in a range, and with the bracket of its distance. The
    /// function returns the distance beyond which faces no longer matter.
    pub(super) fn each(
        &self,
        ray: &Ray,
        range: &RayRange,
        leaving: Leaving,
        mut call: impl FnMut(usize, Bracket) -> f64,
    ) {
        let approach =
            if leaving.most < 0.0 { Approach::new(ray, &self.bounds) } else { Approach::none(ray) };
        let Approach { ray, drift, travelled, slack } = &approach;
        let after = |distance: f64| distance - travelled + slack;
        let far = after(range.far);
        Scratch::with(|Scratch { stack, .. }| {
            self.tree.closest_within(Cpu::best(), stack, ray, *drift, far, |face, end| {
                let Bracket { near, far } = t_bounds(self.corners(face), ray, far, leaving, *drift);
                let bracket = Bracket { near: near + travelled - slack, far: far + travelled + slack };
                if near < MISS { after(call(face, bracket)) } else { end }
            });
        });
    }

    /// Returns the distance of a ray's first hit in a range, decided for the rounded ray, or [`MISS`] if there is none.
    /// The ray leaves the faces within `leaves` world units of its origin, or no face if this is negative.
    pub(super) fn distance<A: NotClassic>(&self, ray: &Ray, range: &RayRange, leaves: f64) -> f64 {
        let mut first = MISS;
        let leaving = if leaves < 0.0 { NOTHING } else { Leaving { least: leaves, most: leaves } };
        self.each(ray, range, leaving, |face, _| {
            let triangle = self.triangle::<A>(face);
            if leaves < 0.0 || !is_on_surface(&triangle, ray.origin, leaves) {
                let distance = range.keep(triangle.plane.crossing(ray));
                if distance < first && triangle.is_passed_by(ray) {
                    first = distance;
                }
            }
            // Brackets bound rounded distances too, except for the last bits.
            if first < MISS { first * (1.0 + CLOSE) } else { range.far }
        });
        first
    }

    /// Returns the face that a ray hits at a distance in world units. If several faces contain the point up to
    /// rounding, visible faces come before hidden ones, then faces hit from outside, and then the first in the file. At
    /// the outline of a closed mesh, choosing a hidden face would show light from within.
    #[inline(always)]
    pub(super) fn face_along(&self, ray: &Ray, distance: f64) -> usize {
        let close = close(ray, distance);
        let (mut only, mut count) = (0, 0);
        let range = RayRange { far: distance + close, ..RayRange::ALL };
        self.each(ray, &range, NOTHING, |face, bracket| {
            if bracket.far >= distance - close {
                (only, count) = (face, count + 1);
            }
            range.far
        });
        if count == 1 {
            only
        } else {
            let at = ray.at(distance);
            self.first_at(at, |face| match self.is_hidden(face, ray, at) {
                true => 2,
                false => u8::from(!self.is_outside_hit(face, ray.dir)),
            })
        }
    }

    /// Tells whether a ray in a direction hits the outside of a face, in `f64` arithmetic.
    fn is_outside_hit(&self, face: usize, dir: DVec3) -> bool {
        let [a, b, c] = self.corners(face);
        // An open mesh has no outside.
        !self.is_closed() || (b - a).cross(c - a).dot(dir) < 0.0
    }

    /// Tells whether a face of a closed mesh, beside one of its points, is certainly hidden from a ray's origin.
    fn is_hidden(&self, face: usize, ray: &Ray, at: DVec3) -> bool {
        let farthest = 64.0 * f64::EPSILON * (ray.origin.abs().max_element() + (at - ray.origin).length());
        // From so far away, the order of the mesh's faces is uncertain.
        if !self.is_closed() || 4.0 * (self.bounds.high - self.bounds.low).length() < farthest {
            return false;
        }
        let [a, b, c] = self.corners(face);
        let way = at + BESIDE * ((a + b + c) / 3.0 - at) - ray.origin;
        let distance = way.length();
        let far = distance - 64.0 * f64::EPSILON * (distance + ray.origin.abs().max_element());
        let (toward, range) = (Ray { dir: way / distance, ..*ray }, RayRange { far, ..RayRange::ALL });
        let first = || self.first(Cpu::best(), &toward, &range, NOTHING, RayError::NONE, false);
        // The upper end of a bracket may lie beyond the range.
        matches!(first(), Known::Bracket(bracket) | Known::Face { bracket, .. } if bracket.far < far)
    }

    /// Returns the enclosure of a ray's first hit, and the hit face.
    pub(super) fn certify<A: NotClassic>(&self, sight: &Sight, precision: Precision) -> (Enclosure, usize) {
        let line = sight.line::<Interval>();
        let Aabb { low, high } = self.bounds;
        let reach = line.origin.iter().fold(0.0, |reach, at| larger(reach, at.magnitude()));
        let fine = (reach > FAR * (high - low).max_element()).then(|| sight.line::<Wide>());
        if let Some(fine) = &fine {
            if fine.clip(low, high).is_none() {
                return (Enclosure::Misses, 0);
            }
            if let Some(entry) = fine.blurred_entry(low, high) {
                return (Enclosure::Doubtful(entry), 0);
            }
        } else if precision == Precision::Double {
            match self.first_along::<A, f64>(&line, None) {
                // Integers decide a ray that 53 bits leave open.
                (HitEnclosure::Edge(_) | HitEnclosure::Doubtful(_), _) if !line.is_exact() => {}
                (found, face) => return (found.into(), face),
            }
        } else if let Some((found, face)) = self.first_exactly::<A, Fraction>(&sight.line()) {
            return (found.into(), face);
        }
        let entry = |Aabb { low, high }: &Aabb| match &fine {
            Some(fine) => fine.clip(*low, *high).map(|(entry, _)| entry),
            None => line.clip(*low, *high).map(|(entry, _)| Fraction::from(entry)),
        };
        let end = Cell::new(Fraction::INFINITY);
        // Nothing needs to be searched behind a proven hit of the face that `f64` arithmetic found.
        let found = self.first(Cpu::best(), &sight.ray(), &RayRange::ALL, NOTHING, RayError::NONE, false);
        if let Some(face) = found.face()
            && let Enclosure::Hits(at) = certify::first_hit(&Face(self.triangle::<A>(face)), sight, precision)
        {
            end.set(at.high);
        }
        let mut met = Vec::new();
        self.tree.within(
            |bounds| entry(bounds).is_some_and(|entry| entry <= end.get()),
            |face| {
                let enclosure = certify::first_hit(&Face(self.triangle::<A>(face)), sight, precision);
                let low = match enclosure {
                    Enclosure::Misses => return,
                    Enclosure::Hits(at) => {
                        end.set(Float::min(end.get(), at.high));
                        at.low
                    }
                    Enclosure::Edge(at) => at.low,
                    Enclosure::Doubtful(low) => low,
                };
                met.push((low, enclosure, face));
            },
        );
        let end = end.get();
        met.retain(|(low, ..)| *low <= end);
        let first = met.iter().copied().reduce(|one, other| if other.0 < one.0 { other } else { one });
        let Some((low, first, face)) = first else { return (Enclosure::Misses, 0) };
        let first = match first {
            // The face certainly has a hit there, or a certain hit overlaps this one. Then the first hit lies in the
            // union of both intervals.
            Enclosure::Edge(at) | Enclosure::Hits(at) if end <= at.high => {
                Enclosure::Hits(Wide { low, high: end })
            }
            Enclosure::Edge(_) if precision == Precision::Octuple => {
                return self
                    .first_exactly::<A, Fraction>(&sight.line())
                    .map_or((first, face), |(found, face)| (found.into(), face));
            }
            first => first,
        };
        (first, face)
    }

    /// Returns the distance, in world units, within which a ray that starts on the surface leaves faces. It starts on
    /// some face, so where its rounded origin is farther from all of them than the bounds of its error say, it leaves
    /// the nearest one. `nearest` returns the distance of that.
    pub(super) fn leaves(&self, origin_error: f64, nearest: impl FnOnce() -> f64) -> f64 {
        let (error, nearest) = (origin_error.max(self.least_error()), nearest());
        if nearest <= error { error } else { 2.0 * nearest }
    }

    /// Returns a bound of the rounding error of a hit point at the viewer, in world units.
    pub(super) fn least_error(&self) -> f64 {
        ROUNDING * self.max_coordinate()
    }

    /// Returns the exact triangle of a face.
    #[inline(always)]
    pub(super) fn triangle<A: NotClassic>(&self, face: usize) -> Triangle<A> {
        let corners = self.corners(face);
        Triangle::new(corners).expect("faces without an area are left out")
    }

    /// Returns the plane of a face, for distances only.
    #[inline(always)]
    pub(super) fn plane<A: NotClassic>(&self, face: usize) -> Plane<A> {
        plane_for_distances(self.corners(face))
    }

    /// Returns the largest magnitude of a coordinate, in world units.
    pub fn max_coordinate(&self) -> f64 {
        self.bounds.low.abs().max(self.bounds.high.abs()).max_element()
    }
}

/// The bounds of a ray that starts on no face.
pub(super) const NOTHING: Leaving = Leaving { least: -1.0, most: -1.0 };

/// The distance between a point of a face and the point examined beside it, as a fraction of the distance to the middle
/// of the face.
pub(super) const BESIDE: f64 = 1.0 / (1 << 20) as f64;
