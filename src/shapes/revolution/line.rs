//! A surface of revolution along a ray, as a function of the place.

use super::local::Local;
use super::surface::Revolution;
use tabray_exact::interval::Interval;
use tabray_exact::jet::Jet;
use tabray_exact::roots::taylor::FunctionOnLine;
use tabray_exact::roots::twice;
use tabray_exact::scalar::{Scalar, per_axis};
use tabray_world::certify::Equation;
use tabray_world::geometry::ray::Side;

/// The left side of the surface's equation along a ray: positive outside, negative inside.
pub(super) struct ProfileOnRay<'s> {
    pub surface: &'s Revolution,
    pub local: &'s Local,
}

impl FunctionOnLine for ProfileOnRay<'_> {
    #[inline(always)]
    fn at<N: Scalar>(&self, along: N) -> N {
        self.surface.value(per_axis(|axis| self.local.place(axis, along)))
    }

    fn wants_proof(&self) -> bool {
        !self.local.ray.is_single()
    }

    /// Returns bounds of the second derivative only. That of the squared distance from the axis is constant.
    fn slopes(&self, piece: Interval) -> Option<[Interval; 2]> {
        let dir = self.local.dir.to_array().map(|part| Interval::about(part, self.local.turn));
        let height = self.local.place(1, piece);
        let of_square = self.surface.square.at(Jet::variable(height)).second;
        let second = Interval::constant(2.0) * (dir[0].powi(2) + dir[2].powi(2)) - of_square * dir[1].powi(2);
        Some([Interval::whole(), second])
    }

    /// Decides a piece in double-double arithmetic from the ray in world space and the axis of the scene, which
    /// distinguishes nearly all touches from misses.
    fn undecided(&self, piece: Interval, origin_side: Option<Side>) -> Option<f64> {
        let Self { surface, local } = *self;
        // This is the rounding error along this ray alone, however far apart the rays are that may have been rounded to
        // it.
        let hidden = |along: f64| {
            let along = Interval::<f64>::constant(along);
            let place = per_axis(|axis| local.own_place(axis, along));
            surface.value(place).width()
        };
        let hidden = hidden(piece.low).min(hidden(piece.high));
        let exact = local.frame.exactly(&local.ray, local.base);
        twice::first_root(|along| surface.value(exact.along(along)), piece, origin_side, hidden)
    }
}

/// The surface along a ray like [`ProfileOnRay`], but with 0 in place of a negative profile. Other methods do not use
/// slabs, and cannot skip parts.
pub(super) struct Uncut<'s> {
    pub surface: &'s Revolution,
    pub local: &'s Local,
}

impl FunctionOnLine for Uncut<'_> {
    #[inline(always)]
    fn at<N: Scalar>(&self, along: N) -> N {
        let place = |axis: usize| self.local.own_place(axis, along);
        place(0).powi(2) + place(2).powi(2) - self.surface.profile.at(place(1)).max(N::constant(0.0)).powi(2)
    }
}
