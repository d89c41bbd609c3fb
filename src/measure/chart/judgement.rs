//! Judges found hits by the roots of the true ray and their conditioning.
//!
//! A distance alone says little: on a plane that a ray nearly runs along, rounding the ray's direction moves the hit
//! by thousands of units, and at a silhouette two hits are closer together than a coarse method's error. So a hit
//! counts as the first one if the ray stays on the surface, up to rounding, from the true hit to the found one, and
//! as a later one only if another root lies between.

use glam::DVec3;
use std::sync::OnceLock;
use tabray_core::geometry::ray::{MISS, Ray};
use tabray_core::geometry::sight::{Line, Sight};
use tabray_core::world::any_shape::AnyShape;
use tabray_core::world::certify::{self, Enclosure, HitEnclosure, HitProofs, Precision};
use tabray_core::world::coincidence::ROUNDING;
use tabray_exact::double_double::DoubleDouble;
use tabray_exact::interval::{Float, Fraction, Interval, Wide};
use tabray_exact::scalar::Scalar;

/// What is proven about the first hit of a ray and an object.
pub(super) enum Truth {
    /// The ray hits the object.
    Hit {
        /// Bounds of the distance, in lengths of the sight's direction.
        at: Wide,
        /// The distance, in world units.
        distance: DoubleDouble,
    },
    /// The ray misses the object.
    Miss,
    /// The proof did not decide.
    Undecided,
}

/// The truth about a ray and an object, for all methods.
pub(super) struct Known {
    pub truth: Truth,
    /// The truths about rays within rounding of it, once they are asked for.
    nearby: OnceLock<Vec<Truth>>,
}

/// The judgement of a found hit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Judgement {
    /// The first hit, with this error of the distance in world units; or no hit where there is none.
    Right(Option<f64>),
    /// No hit, where there is one.
    Missed,
    /// A hit, where there is none.
    Invented,
    /// A hit at or beyond another root than the first.
    Later,
    /// A hit that is farther from the first root than the conditioning of the root explains; no other root lies
    /// between.
    Inaccurate,
    /// The proof did not decide, or rounding the ray's numbers decides.
    Undecided,
}

impl Known {
    /// Proves what a ray hits first.
    pub fn of(shape: &AnyShape, sight: &Sight) -> Self {
        Self { truth: Truth::of(shape, sight, Precision::Octuple), nearby: OnceLock::new() }
    }
}

impl Truth {
    fn of(shape: &AnyShape, sight: &Sight, precision: Precision) -> Self {
        match shape.certify(sight, precision) {
            Enclosure::Hits(at) => Self::Hit { at, distance: certify::in_world_units(at, sight) },
            Enclosure::Misses => Self::Miss,
            Enclosure::Edge(_) | Enclosure::Doubtful(_) => Self::Undecided,
        }
    }
}

/// A ray and an object, with the ray's exact form before rounding.
pub(super) struct Pair<'p> {
    pub shape: &'p AnyShape,
    pub ray: Ray,
    pub sight: &'p Sight,
}

impl Pair<'_> {
    /// Judges a found distance, in world units. `promise` is the greatest error of a distance or of a point's
    /// distance from the surface that the method allows itself besides rounding.
    pub fn judge(&self, known: &Known, found: f64, promise: f64) -> Judgement {
        let judged = self.judge_by(&known.truth, found, promise);
        if matches!(judged, Judgement::Right(_) | Judgement::Undecided) {
            return judged;
        }
        // If the method is right about the given, rounded ray, or about one within rounding of it, rounding decides
        // the hit.
        let error = self.rounding(match known.truth {
            Truth::Hit { distance, .. } => distance.high,
            Truth::Miss | Truth::Undecided => 0.0,
        });
        let (across, upward) = self.ray.dir.any_orthonormal_pair();
        let sights = [DVec3::ZERO, across, -across, upward, -upward]
            .map(|aside| Sight::along(&Ray { origin: self.ray.origin + error * aside, dir: self.ray.dir }));
        let truths = known.nearby.get_or_init(|| sights.iter().map(|sight| self.nearby(sight)).collect());
        let is_right = |(sight, truth): (&Sight, &Truth)| {
            let pair = Pair { shape: self.shape, ray: sight.ray(), sight };
            matches!(pair.judge_by(truth, found, promise), Judgement::Right(_) | Judgement::Undecided)
        };
        if sights.iter().zip(truths).any(is_right) { Judgement::Undecided } else { judged }
    }

    /// Proves what another ray hits, in more digits only where few do not decide.
    fn nearby(&self, sight: &Sight) -> Truth {
        match Truth::of(self.shape, sight, Precision::Double) {
            Truth::Undecided => Truth::of(self.shape, sight, Precision::Octuple),
            decided => decided,
        }
    }

    /// Returns the distance by which rounding may move the true hit along the ray, in world units: the error across the
    /// surface, divided by the cosine.
    pub fn moved_by_rounding(&self, known: &Known) -> Option<f64> {
        let Truth::Hit { distance, .. } = known.truth else { return None };
        let normal = self.shape.normal(self.ray.at(distance.high));
        Some(self.rounding(distance.high) / normal.dot(self.ray.dir).abs())
    }

    /// Returns a bound on the distance by which rounding moves the ray and the surface, at a distance, in world
    /// units.
    fn rounding(&self, distance: f64) -> f64 {
        ROUNDING * (self.ray.origin.abs().max_element() + distance.abs() + self.shape.facts().max_coordinate)
    }

    fn judge_by(&self, truth: &Truth, found: f64, promise: f64) -> Judgement {
        let (at, distance) = match truth {
            Truth::Undecided => return Judgement::Undecided,
            Truth::Miss if found == MISS => return Judgement::Right(None),
            Truth::Miss => return Judgement::Invented,
            Truth::Hit { .. } if found == MISS => return Judgement::Missed,
            Truth::Hit { at, distance } => (at, distance),
        };
        let error = promise + self.rounding(found);
        let is_on = |distance: f64| self.shape.is_on_surface(self.ray.at(distance), error);
        // Between two roots the ray leaves the surface, the farthest about half-way.
        let is_same =
            |root: f64| (found - root).abs() <= error || is_on(found) && is_on(0.5 * (root + found));
        if is_same(distance.high) {
            return Judgement::Right(Some((DoubleDouble::from(found) - *distance).high.abs()));
        }
        if found <= distance.high {
            return Judgement::Inaccurate;
        }
        match self.root_after(at) {
            None => Judgement::Inaccurate,
            Some(Root::Certain(next)) if next <= found || is_same(next) => Judgement::Later,
            Some(Root::Certain(_)) => Judgement::Inaccurate,
            Some(Root::Possible(from)) if from > found => Judgement::Inaccurate,
            Some(Root::Possible(_)) => Judgement::Undecided,
        }
    }

    /// Returns the next root after a proven one, in world units; `None` where there is none.
    fn root_after(&self, at: &Wide) -> Option<Root> {
        /// The gap between a root and the start of the search for the next one, as a fraction of the distance: nearer
        /// roots are the same in `f64`.
        const GAP: f64 = 4.0 * f64::EPSILON;
        let start = Interval::constant(at.high.to_f64() * (1.0 + GAP));
        let line = self.sight.line::<Wide>();
        let rest = Line { origin: line.at(start), dir: line.dir };
        let in_world = |t: Wide| certify::in_world_units(start + t, self.sight).high;
        let Some(proven) = self.shape.proven() else { return Some(Root::Possible(0.0)) };
        match HitProofs::<Fraction>::first_hit(proven, &rest, None).0 {
            HitEnclosure::Misses => None,
            HitEnclosure::Hits(t) => Some(Root::Certain(in_world(t))),
            HitEnclosure::Edge(t) => Some(Root::Possible(in_world(t))),
            HitEnclosure::Doubtful(t) => Some(Root::Possible(in_world(Interval::point(t)))),
        }
    }
}

/// The next root after a hit, by its distance in world units.
enum Root {
    Certain(f64),
    /// There may be a root, no nearer than this.
    Possible(f64),
}

#[cfg(test)]
mod tests {
    use super::*;
    use tabray_core::geometry::ray::RayRange;
    use tabray_core::world::certify::Equation;
    use tabray_core::world::hittable::{Certified, Facts, Hittable, Shape};

    /// A sphere of radius 1 around the origin, or the plane y = 0.
    enum Surface {
        Ball,
        Floor,
    }

    impl Equation for Surface {
        const IS_QUADRATIC: bool = true;

        fn value<N: Scalar>(&self, [x, y, z]: [N; 3]) -> N {
            match self {
                Self::Ball => x.powi(2) + y.powi(2) + z.powi(2) - N::constant(1.0),
                Self::Floor => y,
            }
        }
    }

    impl Hittable for Surface {
        fn distance(&self, _ray: &Ray, _range: &RayRange) -> f64 {
            MISS
        }

        fn normal(&self, _at: DVec3) -> DVec3 {
            DVec3::Y
        }

        fn facts(&self) -> Facts {
            Facts::unbounded(0.0)
        }
    }

    impl Certified for Surface {}

    fn judged(surface: Surface, origin: DVec3, dir: DVec3, found: f64, promise: f64) -> Judgement {
        let shape = Shape::new(surface).certified().into();
        let ray = Ray { origin, dir: dir.normalize() };
        let sight = Sight::along(&ray);
        Pair { shape: &shape, ray, sight: &sight }.judge(&Known::of(&shape, &sight), found, promise)
    }

    #[test]
    fn a_hit_is_later_only_if_a_root_lies_between() {
        let ball =
            |found, promise| judged(Surface::Ball, DVec3::new(0.0, 0.0, 5.0), -DVec3::Z, found, promise);
        assert!(matches!(ball(4.0, 0.0), Judgement::Right(Some(error)) if error < 1e-60));
        assert!(matches!(ball(4.0 + 1e-14, 0.0), Judgement::Right(Some(error)) if error > 9e-15));
        assert!(matches!(ball(4.0005, 1e-3), Judgement::Right(Some(_))));
        for (found, right) in [
            (4.0005, Judgement::Inaccurate),
            (3.0, Judgement::Inaccurate),
            (5.9, Judgement::Inaccurate),
            (6.0 - 1e-15, Judgement::Later),
            (6.0, Judgement::Later),
            (7.0, Judgement::Later),
            (MISS, Judgement::Missed),
        ] {
            assert_eq!(ball(found, 0.0), right, "{found}");
        }
    }

    #[test]
    fn a_plane_that_a_ray_nearly_runs_along_has_no_later_crossing() {
        let floor = |found| judged(Surface::Floor, DVec3::Y, DVec3::new(1.0, -1e-13, 0.0), found, 0.0);
        // Half an ulp of the direction, times the distance, is a thousandth of the height.
        assert!(matches!(floor(1.0001e13), Judgement::Right(Some(error)) if error > 1e8));
        assert_eq!(floor(1.5e13), Judgement::Inaccurate);
        assert_eq!(floor(0.5e13), Judgement::Inaccurate);
        assert_eq!(floor(MISS), Judgement::Missed);
    }

    #[test]
    fn a_ray_within_rounding_of_a_silhouette_is_undecided() {
        let beside = |offset: f64, found| {
            judged(Surface::Ball, DVec3::new(1.0 + offset, 0.0, 5.0), -DVec3::Z, found, 0.0)
        };
        assert_eq!(beside(1e-15, MISS), Judgement::Right(None));
        assert_eq!(beside(1e-15, 5.0), Judgement::Undecided);
        assert_eq!(beside(-1e-15, MISS), Judgement::Undecided);
        assert_eq!(beside(1e-12, 5.0), Judgement::Invented);
        assert_eq!(beside(-1e-12, MISS), Judgement::Missed);
    }
}
