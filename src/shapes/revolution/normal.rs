//! Normals of a surface of revolution.

use super::surface::Revolution;
use glam::DVec3;
use tabray_exact::dual::Dual;
use tabray_exact::interval::Interval;
use tabray_world::geometry::frame::Frame;
use tabray_world::geometry::ray::Side;
use tabray_world::geometry::ray_packet::{RayPacket, turned};
use tabray_world::simd::cpu::kernels;
use tabray_world::simd::soa::{LANES, Vectors};

impl Revolution {
    /// Returns the unit normal at a point of the surface, away from the axis. At an apex, it is along the axis.
    pub fn normal(&self, at: DVec3) -> DVec3 {
        if let Some(up_or_down) = self.ledge(at.y) {
            return up_or_down;
        }
        let Dual { value, slope } = self.profile.at(Dual::variable(at.y));
        if slope.is_finite() {
            return normal_at_slope(at, slope);
        }
        // The profile ends with an infinite slope, like a sphere's at its poles, but the slope of its square is finite.
        let twice = self.square.at(Dual::variable(at.y)).slope;
        let DVec3 { x, z, .. } = outward(at);
        DVec3::new(x * value, -0.5 * twice, z * value).try_normalize().unwrap_or(DVec3::Y)
    }

    /// Returns the unit normal at a point, both in world space.
    #[inline(always)]
    pub(super) fn normal_in(&self, frame: &Frame, at: DVec3) -> DVec3 {
        (frame.axes * self.normal(frame.point(at))).normalize()
    }

    /// Returns the normal of the ledge at a height where the profile jumps, pointing to the narrower side, or `None` if
    /// there is no jump.
    fn ledge(&self, y: f64) -> Option<DVec3> {
        // Only few slabs, if any, have unbounded slopes.
        if self.slabs.get(self.slabs.index(y)).slope_error.is_finite() {
            return None;
        }
        let near = 1e-9 * self.height;
        let slope = self.profile.at(Dual::variable(Interval { low: y - near, high: y + near })).slope;
        let (below, above) = (self.profile.at(y - near), self.profile.at(y + near));
        // A ledge is far wider than such a small step allows for a slope.
        let is_ledge = !slope.is_bounded() && (above - below).abs() > 1e3 * near;
        is_ledge.then_some(if above < below { DVec3::Y } else { -DVec3::Y })
    }
}

/// Returns the unit vector from the axis to a point, or 0 on the axis.
#[inline(always)]
fn outward(at: DVec3) -> DVec3 {
    // The scale keeps squares from underflow.
    let is_tiny = (at.x.abs() < 1e-100) & (at.z.abs() < 1e-100);
    let scale = if is_tiny { 1e200 } else { 1.0 };
    let (x, z) = (scale * at.x, scale * at.z);
    let around = (x * x + z * z).sqrt();
    let inverse = if around > 0.0 { 1.0 / around } else { 0.0 };
    DVec3::new(x * inverse, 0.0, z * inverse)
}

/// Returns the unit normal at a point where the profile has this slope.
#[inline(always)]
fn normal_at_slope(at: DVec3, slope: f64) -> DVec3 {
    let normal = outward(at) - slope * DVec3::Y;
    let inverse = 1.0 / normal.length();
    if (inverse > 0.0) & (inverse < f64::INFINITY) { normal * inverse } else { DVec3::Y }
}

kernels! {
    /// Computes the hits of rays with a surface at these distances. Both sides of the surface are lit.
    pub(super) fn interact(
        surface: &Revolution,
        frame: &Frame,
        rays: RayPacket,
        distances: &[f64],
        sides: &mut [Side],
        cosines: &mut [f64],
        travelled: &mut [f64],
    ) => points, normals {
        let is_smooth = surface.slabs.is_smooth();
        for first in (0..travelled.len()).step_by(LANES) {
            let eight = first..first + LANES;
            let (rays, distances) = (rays.part(eight.clone()), &distances[eight.clone()]);
            let (mut points, mut normals) = (points.part(eight.clone()), normals.part(eight.clone()));
            let (sides, cosines) = (&mut sides[eight.clone()], &mut cosines[eight.clone()]);
            let travelled = &mut travelled[eight];
            let (mut at, mut normal) = (Vectors::<LANES>::ZERO, Vectors::<LANES>::ZERO);
            for lane in 0..LANES {
                let point = rays.get(lane).at(distances[lane]);
                points.set(lane, point);
                at.set(lane, frame.point(point));
                travelled[lane] += distances[lane];
            }
            let slope = surface.profile.at_eight(at.y).slope.0;
            let mut any = 0;
            for lane in 0..LANES {
                normal.set(lane, (frame.axes * normal_at_slope(at.get(lane), slope[lane])).normalize());
                // The product with 0 is NaN if the slope is infinite or NaN.
                any |= u64::from(0.0 * slope[lane] != 0.0);
            }
            if (any != 0) | !is_smooth {
                for lane in 0..LANES {
                    normal.set(lane, surface.normal_in(frame, points.get(lane)));
                }
            }
            for lane in 0..LANES {
                let facing;
                (sides[lane], cosines[lane], facing) =
                    turned(rays.dir.get(lane), normal.get(lane), true);
                normals.set(lane, facing);
            }
        }
    }
}
