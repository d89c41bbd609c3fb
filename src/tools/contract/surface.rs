//! The contract of [`Hittable`](tabray_core::world::hittable::Hittable) at the point where a ray has hit it.

use super::draw::Draw;
use super::promise::{Fault, Promise};
use super::shape::{GRAZING, RayTrial, SLACK, describe_ray};
use glam::{DVec2, DVec3};
use tabray_core::geometry::aabb::Aabb;
use tabray_core::geometry::ray::{MISS, Ray, RayRange, Side};
use tabray_core::geometry::sight::Sight;
use tabray_core::world::certify::{Enclosure, Precision};
use tabray_core::world::coincidence;
use tabray_exact::interval::Float;

/// A step that is far longer than rounding errors, and far shorter than visible details: in world units around a hit,
/// else as a fraction of [`RayTrial::size`].
const STRIDE: f64 = 1e-4;

/// The distance from which a hit is tried again, in world units: there, squares of coordinates lose 14 of 16 digits.
const AFAR: f64 = 1e7;

/// The distance from just before a hit, in world units, which is below any that a plugin may take for rounding.
const CLOSE: f64 = 1e-5;

/// What rounding may add to u and v.
const UV_SLACK: f64 = 1e-9;

/// A hit that is not blurred by rounding.
pub struct SurfaceHit {
    pub distance: f64,
    pub at: DVec3,
    pub normal: DVec3,
}

impl RayTrial<'_> {
    /// Returns the hit at a distance, after checking its normals, and its u and v.
    pub fn hit_at(&self, distance: f64) -> Result<SurfaceHit, Fault> {
        let at = self.ray.at(distance);
        let normal = self.shape.normal(at);
        let shading = self.shape.shading_normal(at, normal);
        for (what, normal) in [("normal", normal), ("shading normal", shading)] {
            let is_unit = (normal.length() - 1.0).abs() <= 1e-9;
            if !is_unit {
                let found = format!("at {at} the {what} is {normal}, of length {}", normal.length());
                return Err(Promise::NormalIsUnit.fault(found));
            }
        }
        if shading.dot(normal) <= 0.0 {
            let found = format!("at {at} the shading normal is {shading}, and the surface's own {normal}");
            return Err(Promise::NormalsAgree.fault(found));
        }
        if let Some(uv) = self.shape.uv(at)
            && !(uv.cmpge(DVec2::splat(-UV_SLACK)) & uv.cmple(DVec2::splat(1.0 + UV_SLACK))).all()
        {
            return Err(Promise::UvIsWithin.fault(format!("at {at} they are {uv}")));
        }
        Ok(SurfaceHit { distance, at, normal })
    }

    /// Checks that a ray from just before a hit hits it, and that one from far away hits what one from nearby does.
    pub fn check_from_afar(&self, met: &SurfaceHit) -> Result<(), Fault> {
        let Ray { dir, .. } = self.ray;
        let from_before = |at: DVec3, before: f64| {
            let ray = Ray { origin: at - before * dir, dir };
            self.distance_in_range(&ray, &RayRange::ALL).map(|found| (ray, found))
        };
        let (ray, found) = from_before(met.at, CLOSE)?;
        if (found - CLOSE).abs() > self.tolerance(&ray, &RayRange::ALL, found) {
            return Err(Promise::HitIsOnTheSurface.fault(format!(
                "it is hit at {}, {}; but `distance` gives {found} from {CLOSE:e} before that point, {}",
                met.at,
                describe_ray(&self.ray),
                describe_ray(&ray)
            )));
        }
        let (far, found) = from_before(met.at, AFAR)?;
        let tolerance = self.tolerance(&far, &RayRange::ALL, found);
        if found == MISS {
            return match tolerance.is_finite() {
                true => Err(Promise::HitIsAccurate.fault(format!(
                    "it is hit at {}, but not {}",
                    met.at,
                    describe_ray(&far)
                ))),
                false => Ok(()),
            };
        }
        self.check_off(&far, found)?;
        let (_, near) = from_before(far.at(found), 1.0)?;
        let off = (near - 1.0).abs();
        if off > tolerance {
            let off = off * met.normal.dot(dir).abs();
            let found = format!("the hit is {off:.0e} off the surface, {}", describe_ray(&far));
            return Err(Promise::HitIsAccurate.fault(found));
        }
        Ok(())
    }

    pub fn check_bounds(&self, at: DVec3) -> Result<(), Fault> {
        let around = Aabb { low: at - STRIDE, high: at + STRIDE };
        let (up, down) =
            (Aabb { high: DVec3::INFINITY, ..around }, Aabb { low: DVec3::NEG_INFINITY, ..around });
        if let Some(region) = [around, up, down].iter().find(|region| self.shape.is_clear_of(region)) {
            let found = format!("`is_clear_of` is true of {region:?}, yet it is hit at {at}");
            return Err(Promise::BoundsHoldHits.fault(found));
        }
        match self.shape.bounds() {
            Some(bounds) if !bounds.with_slack(100.0).overlaps(&Aabb { low: at, high: at }) => {
                Err(Promise::BoundsHoldHits.fault(format!("it is hit at {at}, outside {bounds:?}")))
            }
            _ => Ok(()),
        }
    }

    /// Checks that rays from nearer, from behind and from other directions hit the surface at the point too.
    pub fn check_from_elsewhere(&self, met: &SurfaceHit, draw: &mut Draw) -> Result<(), Fault> {
        let (Ray { dir, .. }, stride) = (self.ray, STRIDE * self.size(met.distance));
        let mut origins = vec![self.ray.at(0.75 * met.distance), met.at + stride * dir];
        for _ in 0..4 {
            let from = draw.direction();
            if met.normal.dot(from).abs() >= GRAZING {
                origins.push(met.at + 3.0 * draw.part() * from + stride * from);
            }
        }
        for origin in origins {
            let way = met.at - origin;
            let ray = Ray { origin, dir: way.normalize() };
            let distance = self.distance_in_range(&ray, &RayRange::ALL)?;
            let is_farther = |slack: f64| distance > way.length() + slack;
            // What a search gives up on, its proof leaves open: a hit that it misses there, or one farther away that it
            // finds, is no promise that none comes before.
            let is_open = || {
                let proven = self.shape.certify(&Sight::along(&ray), Precision::Double);
                matches!(proven, Enclosure::Doubtful(low) if low.to_f64() < way.length())
            };
            let is_too_far = is_farther(0.0) && is_farther(self.tolerance(&ray, &RayRange::ALL, distance));
            if is_too_far && !(self.shape.is_certified() && is_open()) {
                return Err(Promise::HitIsOnTheSurface.fault(format!(
                    "it is hit at {}, {}; but `distance` gives {distance} for that point, which is {} away, {}",
                    met.at,
                    describe_ray(&self.ray),
                    way.length(),
                    describe_ray(&ray)
                )));
            }
        }
        Ok(())
    }

    /// Checks, where the surface is smooth, that the normal is perpendicular to it and points to the same side as the
    /// normals nearby.
    pub fn check_normal(&self, met: &SurfaceHit) -> Result<(), Fault> {
        let (across, up) = self.ray.dir.any_orthonormal_pair();
        let stride = STRIDE * self.size(met.distance).min(10.0);
        for aside in [stride * across, stride * up] {
            let beside = |aside: DVec3| {
                let ray = Ray { origin: self.ray.origin + aside, ..self.ray };
                let distance = self.shape.distance(&ray, &RayRange::ALL);
                (distance != MISS).then(|| ray.at(distance))
            };
            let (Some(one), Some(other)) = (beside(aside), beside(-aside)) else { continue };
            let between = other - one;
            // The surface bends or has an edge here, or one of the points is on another part of the shape.
            if (one + other - 2.0 * met.at).length() > 1e-3 * between.length() {
                continue;
            }
            let lean = met.normal.dot(between.normalize());
            if lean.abs() > 0.01 {
                let found = format!(
                    "at {} it is at {} degrees to the surface instead of 90",
                    met.at,
                    libm::acos(lean).to_degrees()
                );
                return Err(Promise::NormalIsUpright.fault(found));
            }
            let (a, b) = (self.shape.normal(one), self.shape.normal(other));
            if a.dot(b) < 0.0 {
                return Err(Promise::NormalsAgree.fault(format!("{a} at {one}, and {b} at {other}")));
            }
        }
        Ok(())
    }

    /// Checks that a shape whose outside no ray hits again is convex: a ray that goes through it enters from outside.
    pub fn check_convex(&self, met: &SurfaceHit) -> Result<(), Fault> {
        let (Ray { dir, .. }, stride) = (self.ray, STRIDE * self.size(met.distance));
        let beyond = Ray { origin: met.at + stride * dir, dir };
        let through = self.distance_in_range(&beyond, &RayRange::ALL)?;
        if through != MISS {
            let at = beyond.at(through);
            let behind = Ray { origin: at + stride * dir, dir };
            let sides = [(met.at, met.normal), (at, self.shape.normal(at))];
            let ends = self.distance_in_range(&behind, &RayRange::ALL)? == MISS;
            match sides.map(|(_, normal)| Side::seen_along(dir, normal)) {
                // Too thin to be distinguished from a single touch.
                _ if through <= 10.0 * stride => {}
                [Side::Outside, Side::Inside] if ends => {}
                [Side::Inside, Side::Outside] if ends => {
                    let found = format!(
                        "a ray passes through it, and the normals show the sides {sides:?}, {}",
                        describe_ray(&self.ray)
                    );
                    return Err(Promise::NormalsPointOut.fault(found));
                }
                _ => {
                    let found = format!("a ray enters or leaves twice, {}", describe_ray(&self.ray));
                    return Err(Promise::IsNotMetAgain.fault(found));
                }
            }
        }
        Ok(())
    }

    /// Checks that the point of a hit touches the shape within its error, and that the bounds of a ray from there,
    /// given only that error, contain the distance of the ray that leaves the surface.
    pub fn is_touched(&self, met: &SurfaceHit, draw: &mut Draw) -> Result<(), Fault> {
        let Self { shape, ray, .. } = self;
        let origin_error = coincidence::error(ray, met.distance, met.normal, shape.facts().max_coordinate);
        let fault = |what: String| Err(Promise::HitIsTouched.fault(what));
        if !shape.is_on_surface(met.at, origin_error) {
            return fault(format!(
                "it is hit at {}, {}, where `is_on_surface` is false",
                met.at,
                describe_ray(ray)
            ));
        }
        for _ in 0..4 {
            let onward = Ray { origin: met.at, dir: draw.direction() };
            let bracket = shape.t_bounds(&onward, &RayRange { origin_error, ..RayRange::ALL });
            let side = Side::seen_along(onward.dir, met.normal).opposite();
            let distance = match shape.can_hit_itself(side) {
                true => {
                    self.distance_in_range(&onward, &RayRange { origin_side: Some(side), ..RayRange::ALL })?
                }
                false => MISS,
            };
            if !(bracket.near <= distance && distance <= bracket.far) {
                return fault(format!(
                    "`is_on_surface` is true of the start of a ray, whose distance on leaving is {distance}; `t_bounds` is {bracket:?} with an `origin_error` of {origin_error:e}, {}",
                    describe_ray(&onward)
                ));
            }
        }
        Ok(())
    }

    /// Checks that a ray that leaves the surface has the same hit as one from a little farther on, or none where the
    /// shape says so.
    pub fn check_leaving(&self, met: &SurfaceHit, draw: &mut Draw) -> Result<(), Fault> {
        let stride = STRIDE * self.size(met.distance);
        for _ in 0..4 {
            let dir = draw.direction();
            let cos = dir.dot(met.normal);
            if cos.abs() < GRAZING {
                continue;
            }
            let side = if cos > 0.0 { Side::Outside } else { Side::Inside };
            let ray = Ray { origin: met.at, dir };
            let ahead = Ray { origin: ray.at(stride), dir };
            if !self.shape.can_hit_itself(side) {
                if self.distance_in_range(&ahead, &RayRange::ALL)? != MISS {
                    let found = format!(
                        "`can_hit_itself` leaves out its {side:?}, yet a ray that leaves it hits it again, {}",
                        describe_ray(&ahead)
                    );
                    return Err(Promise::IsNotMetAgain.fault(found));
                }
                continue;
            }
            let leaving =
                self.distance_in_range(&ray, &RayRange { origin_side: Some(side), ..RayRange::ALL })?;
            let from_ahead = self.distance_in_range(&ahead, &RayRange::ALL)? + stride;
            let found =
                |what: String| Err(Promise::StartIsNoHit.fault(format!("{what}, {}", describe_ray(&ray))));
            if leaving <= SLACK * self.size(met.distance) {
                return found(format!("on leaving its {side:?} `distance` gives {leaving}"));
            }
            // Hits within three steps of the surface are not compared.
            let is_near = |distance: f64| distance < 3.0 * stride;
            let apart = if leaving == from_ahead { 0.0 } else { (leaving - from_ahead).abs() };
            let is_told = !is_near(leaving) && !is_near(from_ahead);
            let differ = apart > 0.0 && apart > self.tolerance(&ahead, &RayRange::ALL, from_ahead - stride);
            if differ && is_told {
                return found(format!(
                    "on leaving its {side:?} `distance` gives {leaving}, and from a little farther {from_ahead}"
                ));
            }
        }
        Ok(())
    }
}
