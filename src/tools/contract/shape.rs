//! The contract of [`Hittable`](tabray_core::world::hittable::Hittable), tried with rays.

use super::looks::same_bits;
use super::promise::{Fault, Promise};
use crate::{clock, off_surface};
use glam::DVec3;
use std::f64::consts::TAU;
use std::hint::black_box;
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::Duration;
use tabray_core::geometry::ray::{MISS, Ray, RayBall, RayError, RayRange, Side};
use tabray_core::geometry::ray_packet::{HitRecordMut, RayPacket, SurfaceInteraction};
use tabray_core::geometry::sight::Sight;
use tabray_core::simd::cpu::Cpu;
use tabray_core::simd::soa::{LANES, Vectors};
use tabray_core::world::any_shape::AnyShape;
use tabray_core::world::certify::{Enclosure, Precision};
use tabray_exact::interval::{Float, Wide};

/// The maximum distance by which rounding may shift a ray sideways, as a fraction of the numbers from which its
/// distance is computed. It is above 2^-52 to the power of 2/3, about 4e-11, for methods that lose a third of the
/// digits. The tolerance of a distance is derived from it.
const ASIDE: f64 = 1e-10;

/// A step, as a fraction of the same numbers, that is longer than the rounding error of a hit that does not graze:
/// `ASIDE / GRAZING` is 2e-9.
pub const SLACK: f64 = 1e-7;

/// The least absolute cosine between a ray and the normal. Below it the ray grazes the surface, and rounding decides
/// whether and where it hits.
pub const GRAZING: f64 = 0.05;

/// The least depth of a gap, in world units: at a cusp, hits beside a ray are a little nearer.
const GAP: f64 = 1e-2;

/// The distance between rays and the ray that represents them, as a fraction of the same numbers: some thousand times
/// that of the rays of an undistorted copy.
const DRIFT: f64 = 1e-10;

/// The number of sines that take as long as a ray may.
const SINES: u32 = 1_000_000;

/// A duration that is shorter than that of these sines.
const QUICK: Duration = Duration::from_millis(1);

/// The least time that these sines have taken so far, in nanoseconds; 0 before the first time.
static SINES_TAKE: AtomicU64 = AtomicU64::new(0);

/// What the ratio of two times may be off by where other programs run.
const NOISE: f64 = 1.25;

/// How many times as long as it may a hit must take for one measurement to show it.
const FAR_SLOWER: f64 = 2.5;

/// A shape and the ray with which it is tried.
pub struct RayTrial<'s> {
    pub shape: &'s AnyShape,
    pub ray: Ray,
    /// Whether the ray may hit an edge or a corner, where rounding decides what rays from elsewhere hit.
    pub is_exact: bool,
}

impl RayTrial<'_> {
    /// Returns the size of the numbers from which the ray's distance is computed, in world units.
    pub fn size(&self, distance: f64) -> f64 {
        1.0 + self.ray.origin.abs().max_element() + distance
    }

    /// Returns the error of a ray's distance if rounding shifts the ray a little sideways, in world units: twice the
    /// greatest difference from the distances of four neighbouring rays, plus the shift; infinite if one of the
    /// neighbours hits where the ray misses, or the other way round.
    pub fn tolerance(&self, ray: &Ray, range: &RayRange, distance: f64) -> f64 {
        let step = ASIDE * self.size(if distance == MISS { 0.0 } else { distance });
        let (across, up) = ray.dir.any_orthonormal_pair();
        let apart = [across, -across, up, -up].map(|aside| {
            let neighbour = Ray { origin: ray.origin + step * aside, ..*ray };
            let its = self.shape.distance(&neighbour, range);
            if its == distance { 0.0 } else { (its - distance).abs() }
        });
        // The direction of the greatest change is at most 45 degrees from one of the four, so a factor of sqrt 2 would
        // do for a plane.
        step + 2.0 * apart.into_iter().fold(0.0, f64::max)
    }

    /// Returns the distance along a ray, after checking that it lies within the range or is a miss.
    pub fn distance_in_range(&self, ray: &Ray, range: &RayRange) -> Result<f64, Fault> {
        in_range(self.shape.distance(ray, range), ray, range)
    }

    pub fn check_repeats(&self, distance: f64) -> Result<(), Fault> {
        let again = self.shape.distance(&self.ray, &RayRange::ALL);
        if again.to_bits() == distance.to_bits() {
            return Ok(());
        }
        Err(Promise::DistanceIsTheSameAgain
            .fault(format!("first {distance}, then {again}, {}", describe_ray(&self.ray))))
    }

    pub fn check_packets(&self, distance: f64, cpu: Cpu) -> Result<(), Fault> {
        let Self { shape, ray, .. } = self;
        let fault =
            |found: String| Err(Promise::PacketsAgree.fault(format!("{found}, {}", describe_ray(ray))));
        let bracket = shape.t_bounds(ray, &RayRange::ALL);
        if bracket.near.is_nan() || bracket.far.is_nan() || bracket.near > distance || distance > bracket.far
        {
            return fault(format!("`distance` gives {distance}, and `t_bounds` {bracket:?}"));
        }
        let refined = if bracket.far < MISS { shape.refine(ray, None) } else { f64::NAN };
        if !refined.is_nan() && refined.to_bits() != distance.to_bits() {
            return fault(format!("`distance` gives {distance}, and `refine` {refined}"));
        }
        let (origin, dir) = (Vectors::<LANES>::of(ray.origin), Vectors::<LANES>::of(ray.dir));
        let rays = RayPacket::new(origin.view(LANES), dir.view(LANES), 0.0);
        let found = self
            .packet_fault(cpu, rays, distance)
            .or_else(|| (distance != MISS).then(|| self.interaction_fault(cpu, rays, distance)).flatten());
        found.map_or(Ok(()), |found| fault(format!("{found} ({cpu})")))
    }

    /// Describes the difference between the distance of a packet of copies of the ray and that of the ray.
    fn packet_fault(&self, cpu: Cpu, rays: RayPacket, distance: f64) -> Option<String> {
        let (mut near, mut far) = ([MISS; LANES], [MISS; LANES]);
        let (mut hit_ids, mut doubt) = ([0; LANES], [0; LANES]);
        let nearest =
            HitRecordMut { near: &mut near, far: &mut far, hit_ids: &mut hit_ids, doubt: &mut doubt };
        self.shape.closest_hits(cpu, rays, 1, nearest);
        let (low, high) = (near[0], far[0]);
        if doubt[0] != 0 {
            return None;
        }
        if !(low <= distance && distance <= high) {
            return Some(format!("`distance` gives {distance}, and packets {low} to {high}"));
        }
        // As in the tracer, which does not refine a distance that is known exactly.
        if low < high {
            let mut many = near;
            self.shape.packets().refine(cpu, rays, (&near, &far), &mut many);
            if !many[0].is_nan() && many[0].to_bits() != distance.to_bits() {
                return Some(format!("`distance` gives {distance}, and {} in packets", many[0]));
            }
        }
        None
    }

    /// Describes the difference between the hit of a packet of copies of the ray and that of the ray.
    fn interaction_fault(&self, cpu: Cpu, rays: RayPacket, distance: f64) -> Option<String> {
        let Self { shape, ray, .. } = self;
        let (mut points, mut normals) = (Vectors::<LANES>::ZERO, Vectors::<LANES>::ZERO);
        let mut geometric_normals = Vectors::<LANES>::ZERO;
        let (mut sides, mut cosines, mut travelled) = ([Side::Inside; LANES], [0.0; LANES], [1.0; LANES]);
        let interaction = SurfaceInteraction {
            points: points.view_mut(LANES),
            normals: normals.view_mut(LANES),
            geometric_normals: geometric_normals.view_mut(LANES),
            sides: &mut sides,
            cosines: &mut cosines,
            travelled: &mut travelled,
        };
        shape.packets().interact(cpu, rays, &[distance; LANES], interaction);
        let (at, normal) = (ray.at(distance), shape.normal(ray.at(distance)));
        let side = Side::seen_along(ray.dir, normal);
        let turned = shape.is_two_sided() && side == Side::Inside;
        let (one, many) = (shape.shading_normal(at, if turned { -normal } else { normal }), normals.get(0));
        // At an edge the surface has two normals, and packets may take that of the face on the ray's side.
        if shape.packets().finds_normals_by_rays() && is_beside(shape, at, [normal, many]) {
            return None;
        }
        if !same_bits(one, many) && one.is_finite() {
            return Some(format!("the normal {one} in single rays, and {many} in packets"));
        }
        if !same_bits(at, points.get(0)) || sides[0] != side || travelled[0] != 1.0 + distance {
            return Some(format!("packets give {} in place of {at}", points.get(0)));
        }
        let cosine = ray.dir.dot(normal);
        (cosine.to_bits() != cosines[0].to_bits() && cosine.is_finite())
            .then(|| format!("the cosine {cosine} in single rays, and {} in packets", cosines[0]))
    }

    /// Checks that the bracket of a ray that stands for others contains the hits of these, as where a copy is placed.
    pub fn check_drift(&self) -> Result<(), Fault> {
        let Self { shape, ray, .. } = self;
        let drift = RayError { origin: DRIFT * self.size(0.0), dir: DRIFT };
        let bracket = shape.packets().t_bounds(&RayBall { ray: *ray, drift }, &RayRange::ALL);
        // A shape that knows only its distance answers for the ray alone.
        if bracket.near == bracket.far {
            return Ok(());
        }
        let (across, up) = ray.dir.any_orthonormal_pair();
        for aside in [across, -across, up, -up] {
            let origin = ray.origin + 0.9 * drift.origin * aside;
            let neighbour = Ray { origin, dir: (ray.dir + 0.9 * drift.dir * aside).normalize() };
            let distance = shape.distance(&neighbour, &RayRange::ALL);
            if !(bracket.near <= distance && distance <= bracket.far) {
                return Err(Promise::PacketsAgree.fault(format!(
                    "`distance` gives {distance} for a ray within {drift:?}, and `t_bounds` {bracket:?}, {}",
                    describe_ray(ray)
                )));
            }
        }
        Ok(())
    }

    /// Checks that no distance outside a range is returned, and that the end of the range does not change the hits
    /// before it.
    pub fn check_ranges(&self, distance: f64) -> Result<(), Fault> {
        let slack = SLACK * self.size(if distance == MISS { 0.0 } else { distance });
        let middle = if distance == MISS { 5.0 } else { distance };
        for range in [
            RayRange { far: middle - slack, ..RayRange::ALL },
            RayRange { near: middle + slack, ..RayRange::ALL },
            RayRange { near: 0.5 * middle, far: 0.5 * middle + slack, ..RayRange::ALL },
        ] {
            self.distance_in_range(&self.ray, &range)?;
        }
        // The end of the range does not change the hits before it.
        let t_max =
            if distance == MISS { [middle, 2.0 * middle] } else { [distance.next_up(), distance + slack] };
        for far in t_max {
            let until = self.distance_in_range(&self.ray, &RayRange { far, ..RayRange::ALL })?;
            if until != distance {
                return Err(Promise::HitIsOnTheSurface.fault(format!(
                    "`distance` gives {distance}, and {until} where the ray range ends at {far}, {}",
                    describe_ray(&self.ray)
                )));
            }
        }
        Ok(())
    }

    /// Checks that a ray hits what the rays on all its sides hit: else it falls through a seam.
    pub fn check_beside(&self, distance: f64) -> Result<(), Fault> {
        let (across, up) = self.ray.dir.any_orthonormal_pair();
        // Seams often run along axes, and so would these two.
        let step = ASIDE * self.size(10.0);
        let beside = [across + up, across - up, up - across, -across - up].map(|aside| {
            let ray = Ray { origin: self.ray.origin + step * aside, ..self.ray };
            self.shape.distance(&ray, &RayRange::ALL)
        });
        let [least, most] = [beside.into_iter().fold(MISS, f64::min), beside.into_iter().fold(0.0, f64::max)];
        let is_even = most < MISS && most - least <= 10.0 * step;
        // At the tip of a cone, a proof says that it cannot tell.
        let is_open = || {
            self.shape.is_certified()
                && matches!(
                    self.shape.certify(&Sight::along(&self.ray), Precision::Double),
                    Enclosure::Edge(_) | Enclosure::Doubtful(_)
                )
        };
        if is_even && distance > most + GAP && !is_open() {
            return Err(Promise::HitIsOnTheSurface.fault(format!(
                "`distance` gives {distance}, and {least} to {most} for rays on all sides of it, {}",
                describe_ray(&self.ray)
            )));
        }
        Ok(())
    }

    /// Returns the distance of the hit.
    ///
    /// # Errors
    /// Fails if it takes too long, compared with sines on the same thread: hundreds of such rays would take minutes.
    pub fn distance_in_time(&self) -> Result<f64, Fault> {
        let start = clock::now();
        let distance = self.shape.distance(&self.ray, &RayRange::ALL);
        let ray = clock::now() - start;
        // The least time of the sines so far is measured once, and not for each ray.
        if ray > QUICK && ray.as_nanos() > u128::from(SINES_TAKE.load(Ordering::Relaxed)) {
            self.check_speed(ray)?;
        }
        Ok(distance)
    }

    /// Checks that the cost of a hit, which took this long, is limited.
    fn check_speed(&self, ray: Duration) -> Result<(), Fault> {
        let hit = || {
            black_box(self.shape.distance(&self.ray, &RayRange::ALL));
        };
        let sines = || {
            black_box((0..SINES).map(|number| libm::sin(f64::from(number))).sum::<f64>());
        };
        let time = |work: &dyn Fn()| {
            let start = clock::now();
            work();
            clock::now() - start
        };
        let of_sines = time(&sines);
        let (now, least) = (of_sines.as_nanos() as u64, SINES_TAKE.load(Ordering::Relaxed));
        SINES_TAKE.store(if least == 0 { now } else { least.min(now) }, Ordering::Relaxed);
        if ray <= of_sines {
            return Ok(());
        }
        // The clock may count other work, once or twice.
        let [mut ray, mut most] = [ray.min(time(&hit)), of_sines].map(|time| time.as_secs_f64());
        // What is far slower needs no more care, which takes long.
        if ray < FAR_SLOWER * most {
            [ray, most] = clock::least(Duration::ZERO, [&mut { hit }, &mut { sines }]);
        }
        if ray <= NOISE * most {
            return Ok(());
        }
        let found = format!(
            "`distance` takes as long as {:.0} sines, {}",
            f64::from(SINES) * ray / most,
            describe_ray(&self.ray)
        );
        Err(Promise::RayIsQuick.fault(found))
    }

    /// Checks that a ray's hit is on the surface, if that has an equation.
    pub fn check_off(&self, ray: &Ray, distance: f64) -> Result<(), Fault> {
        match self.off(ray, distance) {
            Some(off) => Err(Promise::HitIsAccurate.fault(format!("{off}, {}", describe_ray(ray)))),
            None => Ok(()),
        }
    }

    /// Says how far a ray's hit is off the surface, where an equation tells that it is.
    fn off(&self, ray: &Ray, distance: f64) -> Option<String> {
        if distance == MISS || !self.shape.is_certified() {
            return None;
        }
        let (sight, allowed) = (Sight::along(ray), ASIDE * self.size(distance));
        let off = off_surface::beyond(self.shape, &sight, ray.at(distance), allowed)?;
        Some(format!("the hit is {off:.0e} off the surface"))
    }

    /// For a shape without an equation, only the bounds are proven. They have a promise of their own.
    pub fn check_proof(&self, distance: f64) -> Result<(), Fault> {
        if !self.shape.is_certified() {
            return Ok(());
        }
        let proven = self.shape.certify(&Sight::along(&self.ray), Precision::Double);
        let agrees = |slack: f64| match proven {
            Enclosure::Misses => distance == MISS || slack == MISS,
            Enclosure::Hits(hit) => {
                hit.low.to_f64() - slack <= distance && distance <= hit.high.to_f64() + slack
            }
            Enclosure::Edge(Wide { low, .. }) | Enclosure::Doubtful(low) => low.to_f64() - slack <= distance,
        };
        if agrees(0.0) || agrees(self.tolerance(&self.ray, &RayRange::ALL, distance)) {
            return Ok(());
        }
        let off = self.off(&self.ray, distance).map_or(String::new(), |off| format!("{off}; "));
        let found = format!(
            "{off}`distance` gives {distance}, and `certify` {proven:?}, {}",
            describe_ray(&self.ray)
        );
        Err(Promise::AgreesWithItsProof.fault(found))
    }
}

/// Returns the distance along a ray, after checking that it lies within the range or is a miss.
pub fn in_range(distance: f64, ray: &Ray, range: &RayRange) -> Result<f64, Fault> {
    if distance == MISS || (range.near < distance && distance < range.far) {
        return Ok(distance);
    }
    let RayRange { near, far, .. } = range;
    Err(Promise::DistanceIsInItsSpan
        .fault(format!("`distance` gives {distance} between {near} and {far}, {}", describe_ray(ray))))
}

/// Describes a ray in words.
pub fn describe_ray(Ray { origin, dir }: &Ray) -> String {
    format!("from {origin} along {dir}")
}

/// Tells whether a point lies on an edge or a corner of two faces with different normals: whether the second normal
/// is found a little beside the point, in its plane. At a corner, the directions to both sides of one edge may lead
/// along others, so many are tried.
fn is_beside(shape: &AnyShape, at: DVec3, [one, other]: [DVec3; 2]) -> bool {
    const DIRECTIONS: u32 = 32;
    let Some(along) = one.cross(other).try_normalize() else { return false };
    let (step, across) = (1e-6 * (1.0 + at.abs().max_element()), along.cross(other));
    let mut beside = (0..DIRECTIONS).map(|part| {
        let (sin, cos) = libm::sincos(f64::from(part) / f64::from(DIRECTIONS) * TAU);
        at + step * (cos * across + sin * along)
    });
    (one - other).length() > 1e-6 && beside.any(|beside| (shape.normal(beside) - other).length() < 1e-6)
}
