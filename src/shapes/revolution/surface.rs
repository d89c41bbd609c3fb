//! The surface of a profile.

use super::no_surface::NoSurface;
use super::pieces::Slabs;
use crate::uv;
use glam::DVec3;
use std::fmt;
use tabray_exact::formula::Formula;
use tabray_exact::formula::written::Obstacle;
use tabray_exact::interval::Interval;
use tabray_exact::scalar::Scalar;
use tabray_world::certify::Equation;
use tabray_world::geometry::aabb::{Aabb, SLACK};
use tabray_world::text;

/// The maximum number of examined pieces of a profile to decide whether it crosses the axis.
const MAX_PIECES: usize = 10_000;

/// A surface of revolution around the y axis, from the origin upward.
pub struct Revolution {
    /// The distance from the axis at each height, in world units.
    pub(super) profile: Formula,
    /// The square of the profile.
    pub(super) square: Formula,
    pub(super) height: f64,
    pub(super) slabs: Slabs,
    pub(super) finish: Refinement,
}

/// The refinement of the distance of a hit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Refinement {
    /// Not refined: the midpoint of the bracket, with an error of about 1/1000 of a world unit.
    Bracket,
    /// Refined to full precision by Newton's method.
    Root,
}

impl Revolution {
    /// Returns the surface of a profile.
    ///
    /// # Errors
    /// Fails if the profile is unbounded, is positive nowhere, or takes too long to analyze.
    pub fn new(profile: &Formula, height: f64, finish: Refinement) -> Result<Self, NoSurface> {
        let square = profile.squared();
        let slabs = Slabs::new(profile, &square, height)?;
        Ok(Self { profile: profile.clone(), square, height, slabs, finish })
    }

    /// Returns whether the surface may intersect the cube of half size `error` around a point. The profile may have any
    /// value beyond the surface's ends, and is not evaluated there.
    pub fn is_on_surface(&self, at: DVec3, error: f64) -> bool {
        let [x, y, z] = at.to_array().map(|place| Interval { low: place - error, high: place + error });
        let y = Interval { low: y.low.max(0.0), high: y.high.min(self.height) };
        y.low <= y.high && self.value([x, y, z]).has_zero()
    }

    /// Returns the reason why the surface does not bound a solid, or `None` if the profile begins and ends on the axis
    /// and does not cross it, up to rounding.
    pub fn why_not_closed(&self) -> Option<&'static str> {
        let rounding = SLACK * self.slabs.widest();
        let radius = |low: f64, high: f64| self.profile.at(Interval { low, high });
        let is_on_axis = |at: f64| radius(at, at).magnitude() <= rounding;
        if !is_on_axis(0.0) || !is_on_axis(self.height) {
            return Some("its profile does not begin and end on the axis");
        }
        let (mut waiting, mut left) = (vec![(0.0, self.height)], MAX_PIECES);
        while let Some((low, high)) = waiting.pop() {
            if radius(low, high).low >= -rounding {
                continue;
            }
            left -= 1;
            if left == 0 {
                return Some("its profile may cross the axis");
            }
            let middle = 0.5 * (low + high);
            waiting.extend([(low, middle), (middle, high)]);
        }
        None
    }

    /// Returns a bounding box of the surface.
    pub fn bounds(&self) -> Aabb {
        let widest = self.slabs.widest();
        Aabb { low: DVec3::new(-widest, 0.0, -widest), high: DVec3::new(widest, self.height, widest) }
    }
}

/// Displays the method for hits.
impl fmt::Display for Revolution {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let error = self.slabs.coarsest();
        let count = text::count(self.slabs.count(), "slab");
        let finish = match self.finish {
            Refinement::Bracket => "left at the midpoints of their brackets",
            Refinement::Root => "finished by Newton's method",
        };
        write!(f, "{count}, the profile's square in each a parabola within {error:.1e}; hits {finish}")
    }
}

impl Equation for Revolution {
    /// Clamps the height to the surface's. The profile may have any value beyond the ends, and rounding must not lead
    /// there.
    fn value<N: Scalar>(&self, [x, y, z]: [N; 3]) -> N {
        let height = y.max(N::constant(0.0)).min(N::constant(self.height));
        x.powi(2) + z.powi(2) - self.square.at(height)
    }

    fn uv_bounds(&self, at: [Interval; 3]) -> Option<[Interval; 2]> {
        Some(uv::bounds_on_height(at, self.height))
    }

    fn obstacle(&self, [_, y, _]: [Interval; 3]) -> Option<Obstacle> {
        let height = Interval { low: y.low.max(0.0), high: y.high.min(self.height) };
        Some(self.profile.obstacle(&[height]))
    }

    fn cost(&self) -> usize {
        self.square.cost() as usize
    }

    fn inside_trim<N: Scalar>(&self, [_, y, _]: [N; 3]) -> N {
        let below_the_top = N::constant(self.height) - y;
        y.min(below_the_top).min(self.profile.at(y))
    }

    fn extent(&self) -> [DVec3; 2] {
        let Aabb { low, high } = self.bounds();
        [low, high]
    }
}
