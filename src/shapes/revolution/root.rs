//! The first hits of rays in their brackets: Newton's method for one ray or for eight at once.

use super::surface::{Refinement, Revolution};
use tabray_exact::double_double::offset;
use tabray_exact::dual::Dual;
use tabray_exact::f64x8::{F64x8, each};
use tabray_exact::roots::newton::{self, Functions, Start};
use tabray_exact::scalar::{Scalar, per_axis};
use tabray_world::geometry::frame::Frame;
use tabray_world::geometry::ray::Ray;
use tabray_world::geometry::ray_packet::RayPacket;
use tabray_world::simd::cpu::{Cpu, kernels};
use tabray_world::simd::soa::{LANES, View};

/// Rays that start at the near ends of their brackets, in one number type for one ray or for eight.
struct BracketedRays<'s, N> {
    surface: &'s Revolution,
    from: [N; 3],
    dir: [N; 3],
}

// The square is an argument, because closures are not reliably inlined into kernels.
impl<N: Scalar> BracketedRays<'_, N> {
    /// Returns the heights at these places, clamped to the surface's. Beyond the ends, the profile may have any value.
    #[inline(always)]
    fn heights(&self, along: N) -> N {
        let height = self.from[1] + along * self.dir[1];
        height.max(N::constant(0.0)).min(N::constant(self.surface.height))
    }

    /// Returns the left side of the surface's equation and its slope, given the square of the profile at the heights.
    #[inline(always)]
    fn outside(&self, along: N, square: Dual<N>) -> (N, N) {
        let Self { from: [x, _, z], dir: [dx, dy, dz], .. } = *self;
        let (x, z) = (x + along * dx, z + along * dz);
        let slope = N::constant(2.0) * (x * dx + z * dz) - square.slope * dy;
        (x * x + z * z - square.value, slope)
    }
}

impl Functions<1> for BracketedRays<'_, f64> {
    #[inline(always)]
    fn at(&self, [along]: [f64; 1]) -> ([f64; 1], [f64; 1]) {
        let square = self.surface.square.at(Dual::variable(self.heights(along)));
        let (value, slope) = self.outside(along, square);
        ([value], [slope])
    }
}

impl Functions<LANES> for BracketedRays<'_, F64x8> {
    #[inline(always)]
    fn at(&self, along: [f64; LANES]) -> ([f64; LANES], [f64; LANES]) {
        let along = F64x8(along);
        let square = self.surface.square.at_eight(self.heights(along).0);
        let (value, slope) = self.outside(along, square);
        (value.0, slope.0)
    }
}

impl Revolution {
    /// Computes the distances of hits, each between two distances. The distances of other rays stay unchanged.
    pub(super) fn roots(
        &self,
        cpu: Cpu,
        frame: &Frame,
        rays: RayPacket,
        (near, far): (&[f64], &[f64]),
        out: &mut [f64],
    ) {
        if self.finish == Refinement::Bracket {
            for (lane, distance) in out.iter_mut().enumerate() {
                *distance = if near[lane] < far[lane] { 0.5 * (near[lane] + far[lane]) } else { *distance };
            }
        } else {
            roots(cpu, self, frame, rays, near, far, out);
        }
    }

    /// Returns the distance of a ray's hit between two distances.
    pub(super) fn root(&self, frame: &Frame, ray: &Ray, (near, far): (f64, f64)) -> f64 {
        if self.finish == Refinement::Bracket {
            return 0.5 * (near + far);
        }
        // The offset is computed before the rotation, and so the rotated vector is as small as the surface.
        let from = frame.direction(frame.from_origin(ray, near)).to_array();
        let bracketed = BracketedRays { surface: self, from, dir: frame.direction(ray.dir).to_array() };
        near + newton::roots(&bracketed, self.start([far - near]))[0]
    }

    /// Returns the start of Newton's method in brackets of these widths. In each bracket, the function is monotonic.
    #[inline(always)]
    fn start<const N: usize>(&self, width: [f64; N]) -> Start<N> {
        let tolerance = 2.0 * f64::EPSILON * self.slabs.widest();
        Start {
            low: [0.0; N],
            high: width,
            falls: [0.0; N],
            guess: width.map(|width| 0.5 * width),
            tolerance,
        }
    }
}

kernels! {
    fn roots(surface: &Revolution, frame: &Frame, rays: RayPacket, near: &[f64], far: &[f64], out: &mut [f64]) {
        let count = out.len();
        for first in (0..count).step_by(LANES) {
            let (origin, dir) = (eight_vectors(&rays.origin, first), eight_vectors(&rays.dir, first));
            let (near, far) = (eight(near, first), eight(far, first));
            // The offset is computed before the rotation, and so the rotated vector is as small as the surface.
            let from = frame.origin.to_array();
            let from = per_axis(|axis| {
                each!(origin = origin[axis], near = near, dir = dir[axis] => offset(origin, near, dir, from[axis]))
            });
            let (from, dir) = (directions(frame, from), directions(frame, dir));
            let width = each!(near = near, far = far => if near < far { far - near } else { 0.0 });
            let along = newton::roots(&BracketedRays { surface, from, dir }, surface.start(width.0));
            let out = &mut out[first..first + LANES];
            for lane in 0..LANES {
                let (near, far) = (near.0[lane], far.0[lane]);
                out[lane] = if near < far { near + along[lane] } else { out[lane] };
            }
        }
    }
}

/// Returns eight numbers from an index on.
#[inline(always)]
fn eight(of: &[f64], first: usize) -> F64x8 {
    let mut all = [0.0; LANES];
    all.copy_from_slice(&of[first..first + LANES]);
    F64x8(all)
}

/// Returns eight vectors from an index on.
#[inline(always)]
fn eight_vectors(of: &View, first: usize) -> [F64x8; 3] {
    [eight(of.x, first), eight(of.y, first), eight(of.z, first)]
}

/// Computes [`Frame::direction`] for eight directions.
#[inline(always)]
fn directions(frame: &Frame, [x, y, z]: [F64x8; 3]) -> [F64x8; 3] {
    [frame.axes.x_axis, frame.axes.y_axis, frame.axes.z_axis]
        .map(|axis| F64x8::constant(axis.x) * x + F64x8::constant(axis.y) * y + F64x8::constant(axis.z) * z)
}
