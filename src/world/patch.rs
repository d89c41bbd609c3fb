//! The part of a surface that a sample shows, over which shaders take the mean of their pattern.
//!
//! Under the free rules, and where all pixels have the same number of samples, a sample stands for a part of its pixel,
//! and so for a patch of the surface that its ray hits. Far away, a patch is larger than the squares of a chequered
//! floor; the mean over it is what many samples would show.

use crate::hittable::Hittable;
use crate::material::Rgb;
use crate::number::Number;
use glam::{DVec2, DVec3};
use tabray_exact::interval::{Float, Interval};
use tabray_exact::scalar::{Scalar, cross, dot, per_axis};

/// The width of the window through which a sample looks, in world units: at the start of its ray, and for each unit
/// of its path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// The width at the start.
    pub start: f64,
    /// The width that is added for each unit of the path.
    pub spread: f64,
    /// The width of a pixel, in widths of the window.
    pub pixel: f64,
}

/// The least cosine of the angle at which a patch is seen. At smaller cosines, patches are as long as at this one.
pub const MIN_COSINE: f64 = 1e-6;

/// An upper limit on the rounding errors of a mean over a patch, as a fraction of the averaged values.
pub const MEAN_ROUNDING: f64 = 1e-7;

/// A part of a surface around a point: a parallelogram that touches the surface there.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Patch {
    /// Its sides, in world units.
    pub sides: [DVec3; 2],
    /// The width that a pixel shows, in widths of the patch.
    pub pixel: f64,
    /// The least and the greatest u and v; `None` where the shape has none, or the shader does not see them. They may
    /// lie beyond the ends of the surface.
    pub uv: Option<[DVec2; 2]>,
}

impl Patch {
    /// Returns the patch that a ray shows, given its unit direction, the unit normal, the width of its window, and
    /// the width of a pixel in widths of the window.
    pub fn seen(dir: DVec3, normal: DVec3, (width, pixel): (f64, f64)) -> Self {
        let cosine = dir.dot(normal);
        let along =
            (dir - cosine * normal).try_normalize().unwrap_or_else(|| normal.any_orthonormal_vector());
        let across = normal.cross(along);
        Self { sides: [width / cosine.abs().max(MIN_COSINE) * along, width * across], pixel, uv: None }
    }

    /// Finds u and v at the corners of the patch around a point of a shape, given u and v in the middle.
    pub fn find_uv(&mut self, shape: &dyn Hittable, middle: DVec3, uv: DVec2) {
        let [one, other] = self.sides.map(|side| 0.5 * side);
        let mut ends = [uv; 2];
        for corner in [one + other, one - other, other - one, -one - other] {
            let Some(at) = shape.uv(middle + corner) else { return };
            // A coordinate that grows beyond 1 begins at 0 again.
            let off = at - uv;
            let at = uv + (off - off.round());
            ends = [ends[0].min(at), ends[1].max(at)];
        }
        self.uv = Some(ends);
    }

    /// Returns the length of the patch along a unit vector.
    pub fn extent(&self, along: DVec3) -> f64 {
        self.sides[0].dot(along).abs() + self.sides[1].dot(along).abs()
    }
}

/// A [`Patch`] as a rule of light sees it, in any number.
#[derive(Clone, Copy, Debug)]
pub struct PatchOf<N> {
    /// The point around which it lies.
    pub middle: [N; 3],
    /// Its sides, in world units.
    pub sides: [[N; 3]; 2],
    /// The least and the greatest u and v; `None` where they are not known, or the shader does not see them.
    pub uv: Option<[[N; 2]; 2]>,
}

impl<N: Number> PatchOf<N> {
    /// Returns the lengths of the patch along two directions, given a function that returns the parts of a vector
    /// along them.
    #[inline]
    pub fn widths(&self, along: impl Fn([N; 3]) -> [N; 2]) -> [N; 2] {
        let [one, other] = [along(self.sides[0]), along(self.sides[1])];
        [one[0].abs() + other[0].abs(), one[1].abs() + other[1].abs()]
    }
}

impl<F: Float> PatchOf<Interval<F>> {
    /// Encloses the patch that [`Patch::seen`] returns, before any rounding; `None` where its sides are open, as
    /// where the surface faces the ray.
    pub fn seen(
        middle: [Interval<F>; 3],
        dir: [Interval<F>; 3],
        normal: [Interval<F>; 3],
        width: Interval<F>,
    ) -> Option<Self> {
        let cosine = dot(dir, normal);
        let along = per_axis(|axis| dir[axis] - cosine * normal[axis]);
        let length = dot(along, along).sqrt();
        if length.low <= F::of(0.0) || !length.is_bounded() {
            return None;
        }
        let along = along.map(|axis| axis / length);
        let long = width / cosine.abs().max(Interval::constant(MIN_COSINE));
        let across = cross(normal, along).map(|axis| width * axis);
        Some(Self { middle, sides: [along.map(|axis| long * axis), across], uv: None })
    }

    /// Encloses u and v at the corners of the patch, as [`Patch::find_uv`] finds them, given u and v in the middle,
    /// and a function that encloses those of a point.
    pub fn find_uv(&mut self, uv: [Interval; 2], of: impl Fn([Interval<F>; 3]) -> Option<[Interval; 2]>) {
        let (half, middle, [one, other]) = (Interval::constant(0.5), self.middle, self.sides);
        let corner = |along: f64, across: f64| {
            let [along, across] = [along, across].map(|sign| half * Interval::constant(sign));
            let at = of(per_axis(|axis| middle[axis] + along * one[axis] + across * other[axis]))?;
            // A coordinate that grows beyond 1 begins at 0 again.
            let near = |axis: usize| {
                let off = at[axis] - uv[axis];
                let turns = (off + Interval::constant(0.5)).certain_floor()?;
                Some(uv[axis] + (off - Interval::constant(turns)))
            };
            Some([near(0)?, near(1)?])
        };
        let corners =
            [(1.0, 1.0), (1.0, -1.0), (-1.0, 1.0), (-1.0, -1.0)].map(|(along, across)| corner(along, across));
        let mut ends = [uv; 2];
        for at in corners {
            let Some(at) = at else { return };
            for axis in 0..2 {
                ends[0][axis] = ends[0][axis].min(at[axis]);
                ends[1][axis] = ends[1][axis].max(at[axis]);
            }
        }
        self.uv = Some(ends.map(|uv| uv.map(Interval::from_f64)));
    }
}

/// Tells whether a square or a tile is odd, given its two integers. In a row, every other square is odd. A square
/// whose number is NaN counts as odd.
#[inline(always)]
pub fn is_odd(square: DVec2) -> bool {
    // Exact, and many times faster than a remainder.
    let half = 0.5 * (square.x + square.y);
    half - half.floor() != 0.0
}

/// Returns the colour of tiles at a place, in units of which each tile is one wide, or the mean over a patch there, given
/// its middle and its widths. The tile from 0 to 1 is even.
#[inline(always)]
pub fn tiled<N: Number>(even: [N; 3], odd: [N; 3], at: [N; 2], patch: Option<[[N; 2]; 2]>) -> [N; 3] {
    let [columns, rows] = [at[0].floors(), at[1].floors()];
    let is_known = columns[0] == columns[1] && rows[0] == rows[1];
    match patch {
        Some(patch) if at[0].plain().is_some() || !is_known => N::mean(even, odd, odd_part(patch)),
        None if at[0].plain().is_none() && !is_known => N::any(-1.0, 1.0).either(even, odd),
        _ if is_odd(DVec2::new(columns[0], rows[0])) => odd,
        _ => even,
    }
}

/// Returns the fraction of a rectangle with this middle and these widths that odd tiles cover.
#[inline(never)]
pub fn odd_part<N: Number>([middle, widths]: [[N; 2]; 2]) -> N {
    let (half, balance) = (N::constant(0.5), |axis: usize| balance(middle[axis], widths[axis]));
    half - half * balance(0) * balance(1)
}

/// Returns a colour between two others, or one of them. Rounding does not move a channel beyond both.
pub fn between(one: Rgb, other: Rgb, part: f64) -> Rgb {
    one.lerp(other, part).clamp(one.min(other), one.max(other))
}

/// Returns the mean of a wave over an interval: 1 from 0 to 1, -1 from 1 to 2, and so on.
fn balance<N: Number>(middle: N, width: N) -> N {
    let (n, half) = (N::constant, N::constant(0.5) * width);
    let (from, to) = (middle - half, middle + half);
    let (first, last) = (from.floors()[0], to.floors()[1]);
    if first == last {
        return n(if (0.5 * first).floor() == 0.5 * first { 1.0 } else { -1.0 });
    }
    // The integral from 0 rises to 1 and falls back to 0.
    let mean = (to.off_even() - from.off_even()) / width;
    mean.max(n(-1.0)).min(n(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn odd_are_those_with_an_odd_sum() {
        for (x, y, expected) in [
            (0.0, 0.0, false),
            (1.0, 0.0, true),
            (-3.0, 2.0, true),
            (-3.0, -5.0, false),
            (9_007_199_254_740_991.0, 0.0, true),
            (1e300, 1.0, false),
            (f64::INFINITY, 0.0, true),
            (f64::NAN, 0.0, true),
        ] {
            assert_eq!(is_odd(DVec2::new(x, y)), expected, "{x} {y}");
            assert_eq!(is_odd(DVec2::new(x, y)), (x + y).rem_euclid(2.0) != 0.0, "{x} {y}");
        }
    }

    proptest! {
        /// Of squares known exactly and of squares known up to a little.
        #[test]
        fn the_enclosure_of_the_odd_part_contains_it(
            x in -9.0..9.0_f64, y in -9.0..9.0_f64, width in 1e-3..5.0_f64, height in 1e-3..5.0_f64, off in 0.0..0.01_f64,
        ) {
            let around = |at: f64, off: f64| Interval { low: at - off, high: at + off };
            let found = odd_part([[x, y], [width, height]]);
            let exactly = odd_part([[x, y].map(Interval::point), [width, height].map(Interval::point)]);
            let nearly = odd_part([[x, y].map(|at| around(at, off)), [width, height].map(Interval::point)]);
            prop_assert!(exactly.low - 1e-12 <= found && found <= exactly.high + 1e-12, "{found} {exactly:?}");
            prop_assert!(exactly.high - exactly.low < 1e-9, "{exactly:?}");
            prop_assert!(nearly.low <= exactly.high && exactly.low <= nearly.high, "{nearly:?} {exactly:?}");
            for part in [-1.0, -0.3, 0.8] {
                let moved = odd_part([[x + part * off, y - part * off], [width, height]]);
                prop_assert!(nearly.low - 1e-12 <= moved && moved <= nearly.high + 1e-12, "{moved} {nearly:?}");
            }
        }

        #[test]
        fn the_part_of_odd_squares_is_that_of_many_samples(
            x in -9.0..9.0_f64, y in -9.0..9.0_f64, width in 0.0..5.0_f64, height in 0.0..5.0_f64,
        ) {
            let count = 400;
            let along = |middle: f64, width: f64| {
                move |place: i32| middle + width * ((f64::from(place) + 0.5) / f64::from(count) - 0.5)
            };
            let (across, up) = (along(x, width), along(y, height));
            let odds = |at: &dyn Fn(i32) -> f64| (0..count).filter(|place| at(*place).floor().rem_euclid(2.0) != 0.0).count();
            let (right, above) = (odds(&across) as f64, odds(&up) as f64);
            let n = f64::from(count);
            let expected = (right * (n - above) + above * (n - right)) / (n * n);
            let found = odd_part([[x, y], [width, height]]);
            prop_assert!((found - expected).abs() < 0.02, "{found} {expected}");
        }
    }
}
