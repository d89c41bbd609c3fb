//! First hits of rays with a mesh: brackets in plain arithmetic, distances, and proofs.

use super::face::{Face, Leaving, nearest_point, t_bounds};
use super::surface::Surface;
use super::traversal::Faces;
use crate::geometry::aabb::Aabb;
use crate::geometry::ray::{Bracket, Drift, MISS, Ray, RayRange};
use crate::geometry::sight::Sight;
use crate::numeric::interval::{Float, Interval, Wide};
use crate::shapes::triangle::Triangle;
use crate::world::accuracy::Bounded;
use crate::world::certify::{self, Enclosure, Precision};
use crate::world::coincidence::CLOSE;
use f256::f256;
use glam::DVec3;
use std::ops::Range;

/// The search for a bracket of a ray's first hit.
struct Nearest<'s> {
    surface: &'s Surface,
    ray: &'s Ray,
    range: &'s RayRange,
    leaving: Leaving,
    drift: Option<Drift>,
    /// Whether any certain hit ends the search.
    is_any: bool,
    /// The smallest upper bound of a certain hit's distance so far.
    far: f64,
    /// The smallest lower bound of a hit's distance, and its face; and the second smallest.
    near: (f64, usize),
    second: f64,
    /// The smallest lower bound of an uncertain hit's distance.
    doubtful: f64,
}

impl Faces for Nearest<'_> {
    #[inline(always)]
    fn visit(&mut self, faces: Range<usize>) -> f64 {
        for face in faces {
            let Bracket { near, far } =
                t_bounds(self.surface.corners(face), self.ray, self.range, self.leaving, self.drift);
            if near == MISS {
                continue;
            }
            if near < self.near.0 {
                self.second = self.near.0;
                self.near = (near, face);
            } else if near < self.second {
                self.second = near;
            }
            if far == MISS {
                self.doubtful = self.doubtful.min(near);
            } else if far < self.far {
                self.far = far;
                if self.is_any {
                    return -1.0;
                }
            }
        }
        self.far
    }
}

/// The triangle of the face that the last ray hit: neighbouring rays often hit the same, and its normal takes many
/// digits.
pub(super) struct Last<A>(Option<(usize, Triangle<A>)>);

impl<A: Bounded> Last<A> {
    pub(super) fn none() -> Self {
        Self(None)
    }

    /// Returns the triangle of a face.
    #[inline(always)]
    pub(super) fn triangle(&mut self, surface: &Surface, face: usize) -> &Triangle<A> {
        if self.0.as_ref().is_none_or(|(last, _)| *last != face) {
            self.0 = Some((face, surface.triangle(face)));
        }
        let (_, triangle) = self.0.as_ref().expect("a triangle");
        triangle
    }
}

/// What is known of a ray's first hit.
pub(super) enum Known {
    /// A bracket of the distance.
    Bracket(Bracket),
    /// The ray certainly hits this face first.
    Face(usize, Bracket),
}

impl Surface {
    /// Finds a bracket of a ray's first hit in a range. If `is_any`, any certain hit in the range will do.
    #[inline(always)]
    pub(super) fn first(
        &self,
        ray: &Ray,
        range: &RayRange,
        leaving: Leaving,
        drift: Option<Drift>,
        is_any: bool,
    ) -> Known {
        let mut nearest = Nearest {
            surface: self,
            ray,
            range,
            leaving,
            drift,
            is_any,
            far: MISS,
            near: (MISS, 0),
            second: MISS,
            doubtful: MISS,
        };
        self.tree.along(ray, range.far, drift, &mut nearest);
        let Nearest { far, near: (near, face), second, doubtful, .. } = nearest;
        if doubtful < far {
            // A certain hit behind an uncertain one does not make the nearer one certain.
            return Known::Bracket(Bracket { near, far: if is_any && far < MISS { far } else { MISS } });
        }
        let bracket = Bracket { near, far };
        if far < MISS && far < second && !is_any {
            Known::Face(face, bracket)
        } else {
            Known::Bracket(bracket)
        }
    }

    /// Returns the bracket of a ray's first hit in a range: of width 0, where plain arithmetic finds the distance.
    #[inline(always)]
    pub(super) fn bracket<A: Bounded>(
        &self,
        ray: &Ray,
        range: &RayRange,
        leaving: Leaving,
        last: &mut Last<A>,
    ) -> Bracket {
        let (distance, bracket) = match self.first(ray, range, leaving, None, false) {
            Known::Face(face, bracket) => (last.triangle(self, face).plane.quick_crossing(ray), bracket),
            Known::Bracket(bracket) if bracket.far < MISS => {
                (self.refined::<A>(ray, range, leaving, bracket), bracket)
            }
            Known::Bracket(bracket) => return bracket,
        };
        if distance.is_nan() {
            return bracket;
        }
        let distance = distance.clamp(bracket.near, bracket.far);
        let close = if range.far < MISS { CLOSE * range.far } else { 0.0 };
        // At the distance of another surface, the bracket is widened, so that more digits decide which comes first.
        if (distance - range.far).abs() <= close {
            return Bracket { near: distance - close, far: distance + close };
        }
        Bracket::exactly(distance)
    }

    /// Returns a bracket of the first hits in a range of all rays within a drift of one.
    #[inline(always)]
    pub(super) fn bracket_within<A: Bounded>(
        &self,
        ray: &Ray,
        range: &RayRange,
        drift: Drift,
        last: &mut Last<A>,
    ) -> Bracket {
        match self.first(ray, range, NOTHING, Some(drift), false) {
            Known::Face(face, bracket) => {
                let distance = last.triangle(self, face).plane.quick_crossing(ray);
                // A bracket that is far narrower than what coincides is taken for the distance.
                let is_narrow = bracket.far - bracket.near <= 0.125 * CLOSE * bracket.near;
                let is_known = is_narrow & (bracket.near <= distance) & (distance <= bracket.far);
                if is_known { Bracket::exactly(distance) } else { bracket }
            }
            Known::Bracket(bracket) => bracket,
        }
    }

    /// Returns the distance of a certain hit with a bracket, or NaN where it takes more than plain arithmetic.
    #[inline(never)]
    pub(super) fn refined<A: Bounded>(
        &self,
        ray: &Ray,
        range: &RayRange,
        leaving: Leaving,
        bracket: Bracket,
    ) -> f64 {
        let mut first = MISS;
        let far = bracket.far.next_up();
        self.each(ray, &RayRange { far, ..*range }, leaving, |face, _| {
            let distance = self.triangle::<A>(face).plane.quick_crossing(ray);
            first = if distance < first || distance.is_nan() { distance } else { first };
            far
        });
        first
    }

    /// Calls a function with each face that a ray may hit in a range, and with the bracket of its distance. The
    /// function returns the distance beyond which no more faces matter.
    fn each(&self, ray: &Ray, range: &RayRange, leaving: Leaving, call: impl FnMut(usize, Bracket) -> f64) {
        struct Each<'s, F> {
            surface: &'s Surface,
            ray: &'s Ray,
            range: &'s RayRange,
            leaving: Leaving,
            call: F,
            far: f64,
        }
        impl<F: FnMut(usize, Bracket) -> f64> Faces for Each<'_, F> {
            #[inline(always)]
            fn visit(&mut self, faces: Range<usize>) -> f64 {
                for face in faces {
                    let bracket =
                        t_bounds(self.surface.corners(face), self.ray, self.range, self.leaving, None);
                    if bracket.near < MISS {
                        self.far = (self.call)(face, bracket);
                    }
                }
                self.far
            }
        }
        let far = range.far;
        self.tree.along(ray, far, None, &mut Each { surface: self, ray, range, leaving, call, far });
    }

    /// Returns the distance of a ray's first hit in a range, decided for the ray as it is rounded; [`MISS`] for none.
    /// The ray leaves the faces within `leaves` world units of its origin; negative where it leaves none.
    pub(super) fn distance<A: Bounded>(&self, ray: &Ray, range: &RayRange, leaves: f64) -> f64 {
        let mut first = MISS;
        let leaving = if leaves < 0.0 { NOTHING } else { Leaving { least: leaves, most: leaves } };
        self.each(ray, range, leaving, |face, _| {
            let triangle = self.triangle::<A>(face);
            if leaves < 0.0 || !touches(&triangle, ray.origin, leaves) {
                let distance = range.keep(triangle.plane.crossing(ray));
                if distance < first && triangle.is_passed_by(ray) {
                    first = distance;
                }
            }
            // Brackets are bounds of rounded distances too, but for the last bits.
            if first < MISS { first * (1.0 + CLOSE) } else { range.far }
        });
        first
    }

    /// Returns the face that a ray hits at a distance in world units: of several that hold the point up to rounding, the
    /// first in the file of those that are seen there; of these, those whose outside the ray hits, if there are any. At
    /// the outline of a closed mesh, a face that others hide would show light from within.
    #[inline(always)]
    pub(super) fn face_along(&self, ray: &Ray, distance: f64) -> usize {
        let close = CLOSE * (distance + ray.origin.abs().max_element());
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

    /// Returns the face that is nearest to a point; of several, up to rounding, the first in the file.
    pub(super) fn face_at(&self, at: DVec3) -> usize {
        self.first_at(at, |_| 0)
    }

    /// Tells whether a ray along a direction hits the outside of a face, in plain arithmetic.
    fn is_outside_hit(&self, face: usize, dir: DVec3) -> bool {
        let [a, b, c] = self.corners(face);
        // An open mesh is lit on one side, and shows nothing of the other.
        self.open_edges > 0 || (b - a).cross(c - a).dot(dir) < 0.0
    }

    /// Tells whether the part of a face of a closed mesh beside a point of it is certainly hidden from where a ray starts.
    fn is_hidden(&self, face: usize, ray: &Ray, at: DVec3) -> bool {
        const BESIDE: f64 = 1.0 / (1 << 20) as f64;
        let [a, b, c] = self.corners(face);
        let way = at + BESIDE * ((a + b + c) / 3.0 - at) - ray.origin;
        let distance = way.length();
        let far = distance - 64.0 * f64::EPSILON * (distance + ray.origin.abs().max_element());
        let (toward, range) = (Ray { dir: way / distance, ..*ray }, RayRange { far, ..RayRange::ALL });
        let first = || self.first(&toward, &range, NOTHING, None, false);
        // The upper end of a bracket may lie beyond the range.
        self.open_edges == 0
            && matches!(first(), Known::Bracket(bracket) | Known::Face(_, bracket) if bracket.far < far)
    }

    /// Returns the face that is nearest to a point; of several, up to rounding, the first in the file of those with the
    /// least rank.
    fn first_at(&self, at: DVec3, rank: impl Fn(usize) -> u8) -> usize {
        let rounding = 8.0 * f64::EPSILON * (at.abs().max_element() + self.reach());
        let (distance, face) = self.nearest(at);
        let within = distance + rounding;
        let mut first = face;
        self.near(at, within, |face, distance| {
            let place = |face: usize| (rank(face), self.order[face]);
            if distance <= within && face != first && place(face) < place(first) {
                first = face;
            }
            within
        });
        first
    }

    /// Returns the distance of the nearest face to a point in world units, and the face.
    pub(super) fn nearest(&self, at: DVec3) -> (f64, usize) {
        // Most points are on the surface: few boxes are so near.
        for within in [CLOSE * (at.abs().max_element() + self.reach()), MISS] {
            let mut best = (within, None);
            self.near(at, within, |face, distance| {
                if distance < best.0 {
                    best = (distance, Some(face));
                }
                best.0
            });
            if let (distance, Some(face)) = best {
                return (distance, face);
            }
        }
        // The point is not finite.
        (MISS, 0)
    }

    /// Calls a function with each face that may be within a distance of a point, and with its distance, in world units.
    /// The function returns the distance beyond which no more faces matter.
    fn near(&self, at: DVec3, within: f64, call: impl FnMut(usize, f64) -> f64) {
        struct Near<'s, F> {
            surface: &'s Surface,
            at: DVec3,
            within: f64,
            call: F,
        }
        impl<F: FnMut(usize, f64) -> f64> Faces for Near<'_, F> {
            fn visit(&mut self, faces: Range<usize>) -> f64 {
                for face in faces {
                    let distance = nearest_point(self.surface.corners(face), self.at).distance(self.at);
                    self.within = (self.call)(face, distance);
                }
                self.within
            }
        }
        self.tree.around(at, within, &mut Near { surface: self, at, within, call });
    }

    /// Tells whether a point is on a face, up to an error in world units and to rounding.
    pub(super) fn touches<A: Bounded>(&self, at: DVec3, error: f64) -> bool {
        struct Touched<'s, F> {
            surface: &'s Surface,
            touches: F,
            within: f64,
            any: bool,
        }
        impl<F: Fn([DVec3; 3]) -> bool> Faces for Touched<'_, F> {
            fn visit(&mut self, mut faces: Range<usize>) -> f64 {
                self.any |= faces.any(|face| (self.touches)(self.surface.corners(face)));
                if self.any { -1.0 } else { self.within }
            }
        }
        let error_there = error + 8.0 * f64::EPSILON * at.abs().max_element();
        let touches = |corners: [DVec3; 3]| {
            Triangle::<A>::new(corners).is_some_and(|triangle| touches(&triangle, at, error))
        };
        let mut touched = Touched { surface: self, touches, within: error_there, any: false };
        self.tree.around(at, error_there, &mut touched);
        touched.any
    }

    /// Returns what is certain about a ray's first hit.
    pub(super) fn certify<A: Bounded>(&self, sight: &Sight, precision: Precision) -> Enclosure {
        let line = sight.line::<Interval>();
        let end = std::cell::Cell::new(f256::INFINITY);
        let mut met = Vec::new();
        self.tree.within(
            |bounds| {
                line.clip(bounds.low, bounds.high).is_some_and(|(entry, _)| f256::from(entry) <= end.get())
            },
            |faces| {
                for face in faces {
                    let enclosure = certify::first_hit(&Face(self.triangle::<A>(face)), sight, precision);
                    let low = match enclosure {
                        Enclosure::Misses => continue,
                        Enclosure::Hits(at) => {
                            end.set(Float::min(end.get(), at.high));
                            at.low
                        }
                        Enclosure::Edge(at) => at.low,
                        Enclosure::Doubtful(low) => low,
                    };
                    met.push((low, enclosure));
                }
            },
        );
        let end = end.get();
        met.retain(|(low, _)| *low <= end);
        let first = met.iter().copied().reduce(|one, other| if other.0 < one.0 { other } else { one });
        match first {
            None => Enclosure::Misses,
            // It is hit there, or a certain hit overlaps it: then the first hit is in both together.
            Some((low, Enclosure::Edge(at) | Enclosure::Hits(at))) if end <= at.high => {
                Enclosure::Hits(Wide { low, high: end })
            }
            Some((_, first)) => first,
        }
    }

    /// Returns the exact triangle of a face.
    #[inline(always)]
    pub(super) fn triangle<A: Bounded>(&self, face: usize) -> Triangle<A> {
        let corners = self.corners(face);
        Triangle::new(corners).expect("faces without an area are left out")
    }

    /// Returns the largest magnitude of a coordinate, in world units.
    pub(super) fn reach(&self) -> f64 {
        self.bounds.low.abs().max(self.bounds.high.abs()).max_element()
    }
}

/// What a ray leaves that starts on no face.
pub(super) const NOTHING: Leaving = Leaving { least: -1.0, most: -1.0 };

/// Tells whether a point is on a face, up to an error in world units and to rounding.
fn touches<A: Bounded>(triangle: &Triangle<A>, at: DVec3, error: f64) -> bool {
    let Aabb { low, high } = Aabb::around(&triangle.corners);
    let beside = error + 4.0 * f64::EPSILON * at.abs().max_element();
    (low - beside).cmple(at).all() && at.cmple(high + beside).all() && triangle.plane.touches(at, error)
}
