//! Surfaces of revolution of a profile that has a bound: every point at the distance g(y) from the axis, for heights y from 0 to
//! the surface's own, wherever g is not negative.
//!
//! Each is cut, when it is made, into slabs in which the profile's square is a parabola but for a proven error
//! (`slabs`). A ray meets the quadrics of revolution around those in closed form, which brackets its first hit or
//! proves that there is none (`bracket`, for any number of rays). Where it grazes the error's shell, bounds of the second
//! derivative decide ([`taylor`](crate::shapes::roots::taylor)) on its way alone (`walk`), and where rounding hides what they
//! say, twice the precision ([`twice`]). Nothing has to be tuned. A profile of which all that cannot be proven within a
//! stated number of operations is refused, with the reason ([`NoSurface`]). The rounding of a ray's own arithmetic is held
//! by margins that are derived where they stand, and tried against the truth in `tests/truth.rs`.

mod bracket;
mod budget;
mod classic;
mod lanes;
mod local;
mod normal;
mod quadratic;
mod ranges;
mod root;
mod shape;
mod slabs;
#[cfg(test)]
mod tests;
mod walk;

pub use classic::Classic;
pub use shape::InFrame;
pub use slabs::NoSurface;

use crate::geometry::bounds::Bounds;
use crate::geometry::frame::{BLUR, Frame};
use crate::numeric::dual::Dual;
use crate::numeric::formula::Formula;
use crate::numeric::interval::Interval;
use crate::numeric::number::Number;
use crate::shapes::roots::Method;
use crate::shapes::roots::taylor::Line;
use crate::shapes::roots::twice;
use crate::words;
use crate::world::certify::Equation;
use crate::world::hittable::{MISS, Ray, Side, Span};
use glam::DVec3;
use local::Local;
use slabs::Slabs;
use std::fmt;

/// A surface of revolution around the y axis, from the origin upward.
pub struct Revolution {
    /// The distance from the axis at each height.
    profile: Formula,
    /// The square of that.
    square: Formula,
    height: f64,
    slabs: Slabs,
    finish: Finish,
}

/// How the distance of a hit is finished.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Finish {
    /// Not at all: the middle of its bracket, right to about 1/1000.
    Bracket,
    /// To full precision, by Newton's method.
    Root,
}

impl Revolution {
    /// The surface of a profile.
    ///
    /// # Errors
    /// Where the profile has no bound, where it is nowhere above 0, and where it takes too long to prove what it is.
    pub fn new(profile: &Formula, height: f64, finish: Finish) -> Result<Self, NoSurface> {
        let square = profile.squared();
        let slabs = Slabs::new(profile, &square, height)?;
        Ok(Self { profile: profile.clone(), square, height, slabs, finish })
    }

    /// Whether it comes into the box of so many units around a point. Beyond the surface's ends the profile may be
    /// anything, and is not asked.
    pub fn touches(&self, at: DVec3, error: f64) -> bool {
        let [x, y, z] = at.to_array().map(|place| Interval { low: place - error, high: place + error });
        let y = Interval { low: y.low.max(0.0), high: y.high.min(self.height) };
        y.low <= y.high && self.value([x, y, z]).has_zero()
    }

    /// A box around it.
    pub fn bounds(&self) -> Bounds {
        let widest = self.slabs.widest();
        Bounds { low: DVec3::new(-widest, 0.0, -widest), high: DVec3::new(widest, self.height, widest) }
    }

    /// As [`first_hit`](Self::first_hit), by another method and in the same bounding cylinder; but the notes' steps, as
    /// in the notes, go all the way between the surface's heights.
    pub fn first_hit_by(&self, method: Method, frame: &Frame, ray: &Ray, within: &Span) -> f64 {
        let widest = if method == Method::Steps { f64::INFINITY } else { self.slabs.widest() };
        let Some(local) = Local::new(frame, ray, within, self.height, widest) else { return MISS };
        let line = Uncut { surface: self, local: &local };
        let shortest = 4.0 * local.tolerance();
        match method.first_root(&line, local.from..local.to, local.base, within, shortest) {
            Some(along) => within.keep(local.base + along),
            None => MISS,
        }
    }
}

/// How its hits are found.
impl fmt::Display for Revolution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let error = self.slabs.coarsest();
        let count = words::count(self.slabs.count(), "slab");
        let finish = match self.finish {
            Finish::Bracket => "left in the middle of their brackets",
            Finish::Root => "finished by Newton's method",
        };
        write!(f, "{count}, the profile's square in each a parabola within {error:.1e}; hits {finish}")
    }
}

impl Equation for Revolution {
    /// Beyond its ends the profile may be anything, and rounding must not ask.
    fn value<N: Number>(&self, [x, y, z]: [N; 3]) -> N {
        let height = y.max(N::constant(0.0)).min(N::constant(self.height));
        x.powi(2) + z.powi(2) - self.square.at(height)
    }

    fn kept<N: Number>(&self, [_, y, _]: [N; 3]) -> N {
        let below_the_top = N::constant(self.height) - y;
        y.min(below_the_top).min(self.profile.at(y))
    }

    fn extent(&self) -> [DVec3; 2] {
        let Bounds { low, high } = self.bounds();
        [low, high]
    }
}

/// How far outside of the surface the places along a ray are, with any number type.
struct OnRay<'s> {
    surface: &'s Revolution,
    local: &'s Local,
}

impl Line for OnRay<'_> {
    #[inline(always)]
    fn at<N: Number>(&self, along: N) -> N {
        self.surface.value([0, 1, 2].map(|axis| self.local.place(axis, along)))
    }

    /// That of the squared distance from the axis is the same everywhere.
    fn curvature(&self, piece: Interval) -> Interval {
        let dir = self.local.dir.to_array().map(|part| Interval::about(part, BLUR));
        let height = self.local.place(1, piece);
        let of_square = self.surface.square.at(Dual::variable_twice(height)).second();
        Interval::constant(2.0) * (dir[0].powi(2) + dir[2].powi(2)) - of_square * dir[1].powi(2)
    }

    /// Twice the precision, from the ray in the world and the axis as the scene has it, tells nearly all touches from
    /// misses.
    fn undecided(&self, piece: Interval, leaves: Option<Side>) -> Option<f64> {
        let Self { surface, local } = *self;
        // What rounding hides of this ray alone, however far those are apart that it was rounded from.
        let hidden = |along: f64| {
            let along = Interval::<f64>::constant(along);
            let place = [0, 1, 2].map(|axis| local.own_place(axis, along));
            surface.value(place).width()
        };
        let hidden = hidden(piece.low).min(hidden(piece.high));
        let exact = local.frame.exactly(&local.ray, local.base);
        twice::first_root(|along| surface.value(exact.along(along)), piece, leaves, hidden)
    }
}

/// As [`OnRay`], and where the profile is negative it is 0: methods that know nothing of slabs have nothing to leave
/// out.
struct Uncut<'s> {
    surface: &'s Revolution,
    local: &'s Local,
}

impl Line for Uncut<'_> {
    #[inline(always)]
    fn at<N: Number>(&self, along: N) -> N {
        let place = |axis: usize| self.local.own_place(axis, along);
        place(0).powi(2) + place(2).powi(2) - self.surface.profile.at(place(1)).max(N::constant(0.0)).powi(2)
    }
}
