//! The first hits of a packet of rays, each in its bracket: Newton's method for eight of them at a time.

use super::{Finish, Revolution};
use crate::cpu::{Cpu, kernels};
use crate::dual::Dual;
use crate::frame::Frame;
use crate::geometry::Ray;
use crate::packet::{Rays, STEP};
use crate::twofold::advance;

/// Steps after which a root is taken as it is; a bracket that is only halved has none left.
const MOST: usize = 100;

/// Rays, counted from the near ends of their brackets.
struct Eight {
    x: [f64; STEP],
    y: [f64; STEP],
    z: [f64; STEP],
    dx: [f64; STEP],
    dy: [f64; STEP],
    dz: [f64; STEP],
    width: [f64; STEP],
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
        let (rays, near, far) = (rays.first(count), &near[..count], &far[..count]);
        for first in (0..count).step_by(STEP) {
            let zero = [0.0; STEP];
            let mut eight = Eight { x: zero, y: zero, z: zero, dx: zero, dy: zero, dz: zero, width: zero };
            let mut is_sought = [0; STEP];
            for lane in 0..STEP {
                let (near, far) = (near[first + lane], far[first + lane]);
                let Ray { origin, dir } = frame.ray(&rays.get(first + lane));
                eight.x[lane] = advance(origin.x, near, dir.x);
                eight.y[lane] = advance(origin.y, near, dir.y);
                eight.z[lane] = advance(origin.z, near, dir.z);
                (eight.dx[lane], eight.dy[lane], eight.dz[lane]) = (dir.x, dir.y, dir.z);
                is_sought[lane] = u64::from(near < far);
                eight.width[lane] = if near < far { far - near } else { 0.0 };
            }
            let along = surface.eight_roots(&eight, is_sought);
            for lane in 0..STEP {
                let distance = near[first + lane] + along[lane];
                out[first + lane] = if is_sought[lane] != 0 { distance } else { out[first + lane] };
            }
        }
    }
}

impl Revolution {
    /// What [`newton::root`](crate::newton::root) does, for each of those that are sought.
    #[inline(always)]
    fn eight_roots(&self, rays: &Eight, is_sought: [u64; STEP]) -> [f64; STEP] {
        let Eight { x, y, z, dx, dy, dz, width } = *rays;
        let tolerance = 2.0 * f64::EPSILON * self.slabs.widest();
        let mut is_going = is_sought;
        let (mut low, mut high, mut sign) = ([0.0; STEP], width, [0.0; STEP]);
        let (mut at, mut last_step) = ([0.0; STEP], [f64::INFINITY; STEP]);
        for lane in 0..STEP {
            at[lane] = 0.5 * width[lane];
        }
        for _ in 0..MOST {
            let mut height = [0.0; STEP];
            for lane in 0..STEP {
                let y = y[lane] + at[lane] * dy[lane];
                // Beyond its ends the profile may be anything.
                let y = if y > 0.0 { y } else { 0.0 };
                height[lane] = if y < self.height { y } else { self.height };
            }
            let Dual { value, slope } = self.square.at_eight(height);
            let mut any = 0;
            for lane in 0..STEP {
                let (px, pz) = (x[lane] + at[lane] * dx[lane], z[lane] + at[lane] * dz[lane]);
                let outside = px * px + pz * pz - value.0[lane];
                let slope = 2.0 * (px * dx[lane] + pz * dz[lane]) - slope.0[lane] * dy[lane];
                // In a bracket it falls all the way, or rises.
                let sign_here = if sign[lane] == 0.0 { -1.0_f64.copysign(slope) } else { sign[lane] };
                let is_before = (outside > 0.0) == (sign_here > 0.0);
                let (a, b) = (
                    if is_before { at[lane] } else { low[lane] },
                    if is_before { high[lane] } else { at[lane] },
                );
                let next = at[lane] - outside / slope;
                // Written so that what is not a number is outside.
                let is_inside = (next > a) & (next < b);
                let middle = 0.5 * (a + b);
                let step = (next - at[lane]).abs();
                let last = last_step[lane];
                let predicted = step * (step / last) * (step / last);
                let is_last =
                    (step <= tolerance) | ((predicted <= 0.25 * tolerance) & (last < f64::INFINITY));
                let is_root = outside == 0.0;
                let is_stuck = !is_inside & ((middle == a) | (middle == b));
                let to = if is_inside { next } else { middle };
                let to = if is_root | is_stuck { at[lane] } else { to };
                let is_moving = is_going[lane] != 0;
                at[lane] = if is_moving { to } else { at[lane] };
                low[lane] = a;
                high[lane] = b;
                sign[lane] = sign_here;
                last_step[lane] = if is_inside { step } else { f64::INFINITY };
                is_going[lane] &= u64::from(!(is_root | is_stuck | (is_inside & is_last)));
                any |= is_going[lane];
            }
            if any == 0 {
                break;
            }
        }
        at
    }
}
