//! Exact rays, for proofs.

use crate::geometry::image_point::ImagePoint;
use crate::geometry::placement::Placement;
use crate::geometry::ray::Ray;
use crate::geometry::view_frame::{self, ViewFrame};
use glam::{DVec2, DVec3};
use std::sync::Arc;
use tabray_exact::double_double::exact::exact_sum;
use tabray_exact::double_double::two_product;
use tabray_exact::dual::Dual;
use tabray_exact::interval::{Float, Interval};
use tabray_exact::scalar::{Scalar, constants, per_axis};

/// A ray in the numbers of the scene, before rounding.
#[derive(Clone, Debug)]
pub struct Sight {
    origin: DVec3,
    toward: SightTarget,
    /// The placement whose own coordinates the line has, or `None` for world coordinates.
    within: Option<Arc<PlacementChain>>,
}

/// A placement, possibly in the coordinates of another one.
#[derive(Debug)]
struct PlacementChain {
    placement: Placement,
    outer: Option<Arc<PlacementChain>>,
}

#[derive(Clone, Debug)]
enum SightTarget {
    /// A direction, of any length, and which of the ray's numbers were rounded.
    Direction(DVec3, Rounded),
    /// A point on the image plane z = 0, whose x and y are each `at / last * size`: `at` and `last` in pixels, `size`
    /// in world units.
    ImagePoint { at: DVec2, last: DVec2, size: DVec2 },
    /// The forward direction of a frame.
    Forward(Arc<ViewFrame>),
    /// A point of the image of a frame. The angle of view across the image is in degrees.
    Ahead(Arc<(ViewFrame, f64, ImagePoint)>),
}

/// The numbers of a ray that were computed from the scene's numbers and rounded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Rounded {
    /// None.
    Nothing,
    /// The numbers of the ray's start.
    Start,
    /// All of them.
    Ray,
}

/// A line in any number type: the points `origin + t dir`.
#[derive(Clone, Copy, Debug)]
pub struct Line<N> {
    /// The point at t = 0.
    pub origin: [N; 3],
    /// The direction, of any length.
    pub dir: [N; 3],
}

impl<F: Float> Line<Interval<F>> {
    /// Tells whether all numbers of the line are known exactly.
    pub fn is_exact(&self) -> bool {
        self.origin.iter().chain(&self.dir).all(|of| of.low == of.high)
    }

    /// Returns bounds of the t, from 0 on, at which the line is in a box, given by its low and its high corner, or
    /// `None` if the line certainly misses the box.
    pub fn clip(&self, low: DVec3, high: DVec3) -> Option<(F, F)> {
        let (mut from, mut to) = (F::of(0.0), F::INFINITY);
        for axis in 0..3 {
            let (origin, dir) = (self.origin[axis], self.dir[axis]);
            let (low, high) = (Interval::<F>::constant(low[axis]), Interval::<F>::constant(high[axis]));
            if dir.has_zero() {
                if dir.is_zero() && (origin.high < low.low || origin.low > high.high) {
                    return None;
                }
                continue;
            }
            let (one, other) = ((low - origin) / dir, (high - origin) / dir);
            from = from.max(one.low.min(other.low));
            to = to.min(one.high.max(other.high));
        }
        (from <= to).then_some((from, to))
    }

    /// Returns the t at which the line may enter a box where the line's error is larger than the box on each axis:
    /// nothing in the box can be told from anything else.
    pub fn blurred_entry(&self, low: DVec3, high: DVec3) -> Option<F> {
        let (entry, is_blurred) = self.blurred(low, high)?;
        (is_blurred == [true; 3]).then_some(entry)
    }

    /// Returns the t at which the line may enter a box, and tells for each axis whether the line's error there is larger
    /// than the box.
    pub fn blurred(&self, low: DVec3, high: DVec3) -> Option<(F, [bool; 3])> {
        let (entry, _) = self.clip(low, high)?;
        let at = self.at(Interval::point(entry));
        // False for NaN, where products overflow.
        let is_sharp = |axis: usize| at[axis].width() <= F::of(high[axis]) - F::of(low[axis]);
        Some((entry, per_axis(|axis| !is_sharp(axis))))
    }
}

impl Sight {
    /// Returns the ray from a viewpoint through a point of the image plane, at `at / last` of the image's width and
    /// height from its lower left corner.
    #[inline(always)]
    pub fn through(viewpoint: DVec3, at: DVec2, last: DVec2, size: DVec2) -> Self {
        Self { origin: viewpoint, toward: SightTarget::ImagePoint { at, last, size }, within: None }
    }

    /// Returns the ray from a rounded point straight forward in a frame.
    pub fn forward(origin: DVec3, frame: &ViewFrame) -> Self {
        Self { origin, toward: SightTarget::Forward(Arc::new(*frame)), within: None }
    }

    /// Returns the ray from a frame's viewer through a point of an image with square pixels. `angle` is the angle of
    /// view across the image, in degrees.
    pub fn ahead(frame: &ViewFrame, angle: f64, at: ImagePoint) -> Self {
        Self {
            origin: frame.position(),
            toward: SightTarget::Ahead(Arc::new((*frame, angle, at))),
            within: None,
        }
    }

    /// Returns a sight along a ray. All numbers of the ray count as exact, including the length of its direction.
    pub fn along(ray: &Ray) -> Self {
        Self { origin: ray.origin, toward: SightTarget::Direction(ray.dir, Rounded::Ray), within: None }
    }

    /// Returns the ray from a point along a nonzero direction of any length. The numbers of both count as exact.
    pub fn exactly(origin: DVec3, dir: DVec3) -> Self {
        Self { origin, toward: SightTarget::Direction(dir, Rounded::Nothing), within: None }
    }

    /// Returns which of the ray's numbers were rounded before they were given.
    pub fn rounded(&self) -> Rounded {
        match self.toward {
            SightTarget::Direction(_, rounded) => rounded,
            SightTarget::Forward(_) => Rounded::Start,
            SightTarget::ImagePoint { .. } | SightTarget::Ahead(_) => Rounded::Nothing,
        }
    }

    /// Returns the sight of a line in the coordinates of a placed shape: the [`line`](Self::line) of this one, with the
    /// same t.
    pub fn within(&self, placement: Placement) -> Self {
        let Self { origin, toward, within: outer } = self.clone();
        Self { origin, toward, within: Some(Arc::new(PlacementChain { placement, outer })) }
    }

    /// Returns the ray, rounded.
    #[inline(always)]
    pub fn ray(&self) -> Ray {
        if self.within.is_some() {
            let Line { origin, dir } = self.line::<f64>();
            return Ray { origin: origin.into(), dir: DVec3::from(dir).normalize() };
        }
        let dir = match &self.toward {
            SightTarget::Direction(dir, Rounded::Nothing) => unit(*dir),
            SightTarget::Direction(dir, _) => *dir,
            SightTarget::ImagePoint { at, last, size } => direction(self.origin, *at, *last, *size),
            SightTarget::Forward(frame) => frame.forward(),
            SightTarget::Ahead(ahead) => ahead.0.direction(view_frame::half_tangent(ahead.1), &ahead.2),
        };
        Ray { origin: self.origin, dir }
    }

    /// Returns the line of the ray, which starts at t = 0.
    pub fn line<N: Scalar>(&self) -> Line<N> {
        let n = N::constant;
        let dir = match &self.toward {
            SightTarget::Direction(dir, _) => constants(*dir),
            SightTarget::Forward(frame) => frame.exact_forward(),
            SightTarget::Ahead(ahead) => {
                let (frame, angle, at) = **ahead;
                frame.exact_direction(angle, at.exactly())
            }
            SightTarget::ImagePoint { at, last, size } => {
                let part = |side: usize| n(at[side]) / n(last[side]) * n(size[side]) - n(self.origin[side]);
                [part(0), part(1), n(-self.origin.z)]
            }
        };
        let line = Line { origin: constants(self.origin), dir };
        match &self.within {
            None => line,
            Some(within) => within.line(line),
        }
    }

    /// Returns the squared length of the direction of [`line`](Self::line), in square world units.
    pub(crate) fn squared_length<N: Scalar>(&self) -> N {
        let [x, y, z] = self.line::<N>().dir;
        x.powi(2) + y.powi(2) + z.powi(2)
    }
}

impl PlacementChain {
    /// Maps a line from world space to the placed shape's own coordinates.
    fn line<N: Scalar>(&self, line: Line<N>) -> Line<N> {
        let Line { origin, dir } = match &self.outer {
            None => line,
            Some(outer) => outer.line(line),
        };
        Line { origin: self.placement.point(origin), dir: self.placement.vector(dir) }
    }
}

/// Returns the unit vector along a nonzero vector of any length, rounded like a camera ray's direction.
fn unit(dir: DVec3) -> DVec3 {
    let largest = dir.abs().max_element();
    // The squares of the largest and the smallest numbers overflow and underflow.
    let dir = if (1e-100..1e100).contains(&largest) { dir } else { dir / largest };
    dir.normalize()
}

/// Returns the rounded unit vector from a viewpoint to a point of the image plane. A component is 0 only if the scene's
/// numbers make it 0. A ray parallel to a plane thus differs from one that hits the plane far away.
#[inline(always)]
pub(crate) fn direction(viewpoint: DVec3, at: DVec2, last: DVec2, size: DVec2) -> DVec3 {
    let mut toward = toward(viewpoint, at, last, size);
    if (toward.x == 0.0) | (toward.y == 0.0) {
        toward = unless_cancelled(toward, viewpoint, at, last, size);
    }
    toward.normalize()
}

/// Returns the vector from a viewpoint to a point of the image plane, in plain arithmetic.
#[inline(always)]
pub(crate) fn toward(viewpoint: DVec3, at: DVec2, last: DVec2, size: DVec2) -> DVec3 {
    (at / last * size).extend(0.0) - viewpoint
}

/// Returns a vector from a viewpoint to a point of the image plane. Components that rounding makes 0 are computed
/// exactly: for example, if the viewpoint's x is 3.2 and the point's x is 8 times 6/15.
#[cold]
#[inline(never)]
fn unless_cancelled(toward: DVec3, viewpoint: DVec3, at: DVec2, last: DVec2, size: DVec2) -> DVec3 {
    let part = |side: usize| {
        if toward[side] != 0.0 {
            return toward[side];
        }
        let [there, here] = [two_product(at[side], size[side]), two_product(-viewpoint[side], last[side])];
        let parts = [there.0, there.1, here.0, here.1];
        // Beyond about 1e300, the rounding error of a product is not a number.
        if parts.iter().all(|part| part.is_finite()) { exact_sum(parts).high / last[side] } else { 0.0 }
    };
    DVec3::new(part(0), part(1), toward.z)
}

impl<N: Scalar> Line<N> {
    /// Returns the point at t.
    pub fn at(&self, t: N) -> [N; 3] {
        per_axis(|axis| self.origin[axis] + t * self.dir[axis])
    }

    /// Returns the point at a t that depends on a variable.
    pub fn along(&self, t: Dual<N>) -> [Dual<N>; 3] {
        per_axis(|axis| Dual::fixed(self.origin[axis]) + t * Dual::fixed(self.dir[axis]))
    }
}
