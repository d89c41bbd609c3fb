//! The first hits of a packet of rays, each in its bracket: Newton's method for eight of them at a time.

use super::surface::{Finish, Revolution};
use crate::geometry::frame::Frame;
use crate::geometry::packet::Rays;
use crate::numeric::number::Number;
use crate::numeric::octet::{Octet, each};
use crate::numeric::twofold::offset;
use crate::simd::cpu::{Cpu, kernels};
use crate::simd::soa::{STEP, View};

/// Steps after which a root is taken as it is; a bracket that is only halved has none left.
const MOST: usize = 100;

/// Rays, counted from the near ends of their brackets.
struct Eight {
    from: [Octet; 3],
    dir: [Octet; 3],
    width: Octet,
}

impl Revolution {
    /// The distances of the hits that lie between two distances each; those of other rays stay as they are.
    pub(super) fn roots(
        &self,
        cpu: Cpu,
        frame: &Frame,
        rays: Rays,
        (near, far): (&[f64], &[f64]),
        out: &mut [f64],
    ) {
        if self.finish == Finish::Bracket {
            for (lane, distance) in out.iter_mut().enumerate() {
                *distance = if near[lane] < far[lane] { 0.5 * (near[lane] + far[lane]) } else { *distance };
            }
        } else {
            roots(cpu, self, frame, rays, near, far, out);
        }
    }
}

kernels! {
    fn roots(surface: &Revolution, frame: &Frame, rays: Rays, near: &[f64], far: &[f64], out: &mut [f64]) {
        let count = out.len();
        for first in (0..count).step_by(STEP) {
            let (origin, dir) = (eight_vectors(&rays.origin, first), eight_vectors(&rays.dir, first));
            let (near, far) = (eight(near, first), eight(far, first));
            // Moved in the world and turned then: what is turned is as small as the surface.
            let from = frame.origin.to_array();
            let from = [0, 1, 2].map(|axis| {
                each!(origin = origin[axis], near = near, dir = dir[axis] => offset(origin, near, dir, from[axis]))
            });
            let (from, dir) = (directions(frame, from), directions(frame, dir));
            let width = each!(near = near, far = far => if near < far { far - near } else { 0.0 });
            let along = surface.eight_roots(&Eight { from, dir, width });
            let out = &mut out[first..first + STEP];
            for lane in 0..STEP {
                let (near, far) = (near.0[lane], far.0[lane]);
                out[lane] = if near < far { near + along.0[lane] } else { out[lane] };
            }
        }
    }
}

/// The numbers from this one on.
#[inline(always)]
fn eight(of: &[f64], first: usize) -> Octet {
    let mut all = [0.0; STEP];
    all.copy_from_slice(&of[first..first + STEP]);
    Octet(all)
}

/// The vectors from this one on.
#[inline(always)]
fn eight_vectors(of: &View, first: usize) -> [Octet; 3] {
    [eight(of.x, first), eight(of.y, first), eight(of.z, first)]
}

/// What [`Frame::direction`] does.
#[inline(always)]
fn directions(frame: &Frame, [x, y, z]: [Octet; 3]) -> [Octet; 3] {
    [frame.axes.x_axis, frame.axes.y_axis, frame.axes.z_axis]
        .map(|axis| Octet::constant(axis.x) * x + Octet::constant(axis.y) * y + Octet::constant(axis.z) * z)
}

impl Revolution {
    /// What [`newton::root`](crate::geometry::roots::newton::root) does, for each that has a width. Flags are 0 or 1.
    #[inline(always)]
    fn eight_roots(&self, rays: &Eight) -> Octet {
        let Eight { from: [x, y, z], dir: [dx, dy, dz], width } = *rays;
        let tolerance = 2.0 * f64::EPSILON * self.slabs.widest();
        let (two, half) = (Octet::constant(2.0), Octet::constant(0.5));
        let mut goes_on = each!(width = width => flag(width > 0.0));
        let (mut low, mut high, mut at) = (Octet::constant(0.0), width, half * width);
        let (mut sign, mut last_step) = (Octet::constant(0.0), Octet::constant(f64::INFINITY));
        for _ in 0..MOST {
            // Beyond its ends the profile may be anything.
            let height = y + at * dy;
            let height = each!(y = height => if y > 0.0 { y } else { 0.0 });
            let height = each!(y = height => if y < self.height { y } else { self.height });
            let square = self.square.at_eight(height.0);
            let (x, z) = (x + at * dx, z + at * dz);
            let outside = x * x + z * z - square.value;
            let slope = two * (x * dx + z * dz) - square.slope * dy;
            // In a bracket it falls all the way, or rises.
            sign = each!(sign = sign, slope = slope => if sign == 0.0 { -1.0_f64.copysign(slope) } else { sign });
            let is_before = each!(outside = outside, sign = sign => flag(outside * sign > 0.0));
            low = each!(is_before = is_before, at = at, low = low => if is_before != 0.0 { at } else { low });
            high = each!(is_before = is_before, at = at, high = high => if is_before != 0.0 { high } else { at });

            let (next, middle) = (at - outside / slope, half * (low + high));
            // Written so that what is not a number is outside.
            let is_inside = each!(next = next, low = low, high = high => flag((next > low) & (next < high)));
            let is_stuck =
                each!(middle = middle, low = low, high = high => flag((middle == low) | (middle == high)));
            let step = (next - at).abs();
            let shrinks = step / last_step;
            let next_step = step * shrinks * shrinks;
            let is_last = each!(step = step, next_step = next_step, last = last_step =>
                flag((step <= tolerance) | ((next_step <= 0.25 * tolerance) & (last < f64::INFINITY))));
            let to = each!(is_inside = is_inside, next = next, middle = middle =>
                if is_inside != 0.0 { next } else { middle });
            let stays = each!(goes_on = goes_on, outside = outside, is_inside = is_inside, is_stuck = is_stuck =>
                flag((goes_on == 0.0) | (outside == 0.0) | ((is_inside == 0.0) & (is_stuck != 0.0))));
            at = each!(stays = stays, at = at, to = to => if stays != 0.0 { at } else { to });
            last_step = each!(is_inside = is_inside, step = step =>
                if is_inside != 0.0 { step } else { f64::INFINITY });
            goes_on = each!(stays = stays, is_inside = is_inside, is_last = is_last =>
                flag((stays == 0.0) & ((is_inside == 0.0) | (is_last == 0.0))));
            if goes_on.is_zero() {
                break;
            }
        }
        at
    }
}

#[inline(always)]
fn flag(is_so: bool) -> f64 {
    if is_so { 1.0 } else { 0.0 }
}
