//! Methods for the first root of a function along a line, one per file. `tabray chart` compares them.
//!
//! Scenes use two of them. [`taylor`] finds the hits of shapes that are one formula, and decides whether a ray that
//! grazes a surface of revolution hits it. The other hits of such surfaces come from quadrics (`revolution` of
//! tabray-core). [`newton`] refines the roots of both. Other programs use the other methods. Each file tells the source
//! of its method, and its weaknesses.

pub mod bernstein;
pub mod bisection;
mod chandrupatla;
mod intervals;
pub mod isolation;
pub mod newton;
pub mod range;
mod refiner;
mod samples;
mod steps;
pub mod stretch;
pub mod taylor;
mod tracing;
mod turning;
pub mod twice;
pub mod whole;

use crate::roots::range::RayRange;
pub use refiner::Refiner;
use std::fmt;
use std::ops::Range;
use taylor::FunctionOnLine;

/// A method for the first root.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Method {
    /// Fixed steps, as on the course notes' page on procedural surfaces: `steps`.
    Steps,
    /// This number of samples, and a refiner between the first two with different signs: `samples`.
    Samples(u32, Refiner),
    /// This number of samples, Newton's method, and the turning points between samples: `turning`.
    Turning(u32),
    /// Sphere tracing, with steps as long as a bound of the slope allows: `tracing`.
    Tracing,
    /// Interval bounds of the function's values and slopes: `intervals`.
    Intervals,
    /// Interval bounds of the curvature as well: [`taylor`].
    Taylor,
}

impl Method {
    /// All methods in the comparison.
    pub const ALL: [Self; 12] = [
        Self::Steps,
        Self::Samples(64, Refiner::Bisection3),
        Self::Samples(64, Refiner::Bisection6),
        Self::Samples(64, Refiner::Bisection),
        Self::Samples(64, Refiner::Chandrupatla),
        Self::Samples(16, Refiner::Newton),
        Self::Samples(64, Refiner::Newton),
        Self::Samples(1024, Refiner::Newton),
        Self::Turning(16),
        Self::Tracing,
        Self::Intervals,
        Self::Taylor,
    ];

    /// Returns the first root on the span of a line with a distance `base + root` in the range.
    ///
    /// [`taylor`] divides the span in a way that does not depend on the range. The other methods search only the part
    /// of the span in the range.
    ///
    /// If the line starts on the surface and leaves it to a side, the root at its start does not count. `shortest` is a
    /// few ulps of the largest numbers on the line.
    pub fn first_root(
        self,
        line: &impl FunctionOnLine,
        span: Range<f64>,
        base: f64,
        range: &RayRange,
        shortest: f64,
    ) -> Option<f64> {
        let origin_side = range.origin_side;
        let clipped = || {
            let part = span.start.max(range.near - base)..span.end.min(range.far - base);
            (!part.is_empty()).then_some(part)
        };
        match self {
            Self::Taylor => taylor::first_root(line, &span.clone().into(), base, range, shortest).root,
            Self::Steps => steps::first_root(line, clipped()?, origin_side),
            Self::Samples(count, refiner) => {
                samples::first_root(line, clipped()?, shortest, origin_side, (count, refiner))
            }
            Self::Turning(count) => turning::first_root(line, clipped()?, shortest, origin_side, count),
            Self::Tracing => tracing::first_root(line, clipped()?, origin_side),
            Self::Intervals => intervals::first_root(line, clipped()?, shortest, origin_side),
        }
    }

    /// Returns a bound of the error of a root by this method, in world units, apart from rounding errors divided by the
    /// function's slope. `every_method_finds_a_plain_root_as_exactly_as_it_promises` tests this.
    pub fn promise(self) -> f64 {
        match self {
            Self::Samples(_, Refiner::Bisection3) => 1e-3,
            Self::Steps | Self::Samples(_, Refiner::Bisection6) => 1e-6,
            Self::Tracing => 1e-5,
            _ => 1e-9,
        }
    }
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let name = match self {
            Self::Steps => "steps of 0.1".to_owned(),
            Self::Samples(count, refiner) => format!("{count} + {refiner}"),
            Self::Turning(count) => format!("{count} + turning points"),
            Self::Tracing => "sphere tracing".to_owned(),
            Self::Intervals => "intervals".to_owned(),
            Self::Taylor => "Taylor bounds".to_owned(),
        };
        f.pad(&name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::roots::range::Side;
    use crate::scalar::Scalar;

    /// Falls through 0 at the square root of 2, and rises through 0 at 3.
    struct Parabola;

    impl FunctionOnLine for Parabola {
        fn at<N: Scalar>(&self, t: N) -> N {
            (t - N::constant(2.0).sqrt()) * (t - N::constant(3.0))
        }
    }

    /// Is negative only within 0.0005 of 2.
    struct Notch;

    impl FunctionOnLine for Notch {
        fn at<N: Scalar>(&self, t: N) -> N {
            (t - N::constant(2.0)).powi(2) - N::constant(2.5e-7)
        }
    }

    fn root(
        method: Method,
        line: &impl FunctionOnLine,
        span: Range<f64>,
        origin_side: Option<Side>,
    ) -> Option<f64> {
        method.first_root(line, span, 0.0, &RayRange { origin_side, ..RayRange::ALL }, 1e-14)
    }

    #[test]
    fn every_method_finds_a_plain_root_as_exactly_as_it_promises() {
        for method in Method::ALL {
            let found = root(method, &Parabola, 0.0..2.6, None).expect("a root");
            assert!((found - 2.0_f64.sqrt()).abs() <= method.promise(), "{method}: {found}");
        }
    }

    #[test]
    fn every_method_leaves_the_surface_that_it_starts_on() {
        let start = 2.0_f64.sqrt().next_up();
        for method in Method::ALL {
            let found = root(method, &Parabola, start..4.0, Some(Side::Inside)).expect("a root");
            assert!((found - 3.0).abs() <= method.promise(), "{method}: {found}");
            assert_eq!(root(method, &Parabola, 3.1..4.0, Some(Side::Outside)), None, "{method}");
        }
    }

    #[test]
    fn samples_lose_what_lies_between_them_and_bounds_do_not() {
        for method in Method::ALL {
            let found = root(method, &Notch, 0.333..5.0, None);
            let is_blind = matches!(method, Method::Steps | Method::Samples(..));
            assert_eq!(found.is_none(), is_blind, "{method}: {found:?}");
        }
    }
}
