//! The first hits of a packet of rays, each in its bracket: Newton's method for eight of them at a time.

use super::{Finish, Revolution};
use crate::cpu::{Cpu, kernels};
use crate::frame::Frame;
use crate::geometry::Ray;
use crate::number::Number;
use crate::octet::{Octet, each};
use crate::packet::{Rays, STEP};
use crate::twofold::advance;

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
            let rays = rays.part(first..first + STEP);
            let (near, far) = (&near[first..first + STEP], &far[first..first + STEP]);
            let out = &mut out[first..first + STEP];
            let zero = Octet([0.0; STEP]);
            let mut eight = Eight { from: [zero; 3], dir: [zero; 3], width: zero };
            for lane in 0..STEP {
                let Ray { origin, dir } = frame.ray(&rays.get(lane));
                for axis in 0..3 {
                    eight.from[axis].0[lane] = advance(origin[axis], near[lane], dir[axis]);
                    eight.dir[axis].0[lane] = dir[axis];
                }
                eight.width.0[lane] = if near[lane] < far[lane] { far[lane] - near[lane] } else { 0.0 };
            }
            let along = surface.eight_roots(&eight).0;
            for lane in 0..STEP {
                out[lane] = if near[lane] < far[lane] { near[lane] + along[lane] } else { out[lane] };
            }
        }
    }
}

impl Revolution {
    /// What [`newton::root`](crate::roots::newton::root) does, for each that has a width. Flags are 0 or 1.
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
