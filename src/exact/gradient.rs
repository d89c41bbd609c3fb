//! A number and its derivatives along several variables.

use crate::chain_rule::{Differentiated, operators};
use crate::scalar::Scalar;

/// A number with derivatives along several variables, computed in one evaluation. They have the same bits as with as many
/// [`Dual`](crate::dual::Dual) numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gradient<N = f64, const K: usize = 3> {
    /// The value.
    pub value: N,
    /// The derivatives.
    pub slopes: [N; K],
}

/// Makes an array of the values of a function, which is compiled into one place.
#[inline(always)]
fn each<N: Scalar, const K: usize>(of: impl Fn(usize) -> N) -> [N; K] {
    let mut all = [N::constant(0.0); K];
    let mut axis = 0;
    while axis < K {
        all[axis] = of(axis);
        axis += 1;
    }
    all
}

impl<N: Scalar, const K: usize> Gradient<N, K> {
    /// Returns the coordinates of a point.
    #[inline(always)]
    pub fn point(at: [N; K]) -> [Self; K] {
        let slope = |own: usize, axis: usize| N::constant(if own == axis { 1.0 } else { 0.0 });
        each(|axis| Self { value: at[axis], slopes: each(|own| slope(own, axis)) })
    }
}

impl<N: Scalar, const K: usize> Differentiated for Gradient<N, K> {
    type Value = N;
    type Slope = N;

    #[inline(always)]
    fn new(value: N, slope: impl Fn(usize) -> N) -> Self {
        Self { value, slopes: each(slope) }
    }

    #[inline(always)]
    fn lower(self) -> N {
        self.value
    }

    #[inline(always)]
    fn bare(of: N) -> N {
        of
    }

    #[inline(always)]
    fn slope(self, axis: usize) -> N {
        self.slopes[axis]
    }

    #[inline(always)]
    fn is_fixed(self) -> bool {
        self.slopes.iter().all(|slope| slope.is_zero())
    }
}

operators!([N: Scalar, const K: usize] Gradient<N, K>);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::dual::Dual;
    use crate::interval::Interval;
    use crate::scalar::per_axis;
    use std::array::from_fn;

    fn function<N: Scalar>([x, y, z]: [N; 3]) -> N {
        let some = x.powi(3) * y.sin() - z.sqrt() / (x.exp() + y.cos()) + z.ln() * y.tan() + x.atan2(z);
        let more = x.max(y * z).min(z.shifted(1.0).scaled(3.0)) + (x - y).abs() + z.ramp(3) + x.floor();
        some + more * x.pow(y) + N::noise([x, y, z], [0; 3]) - (x - z).choose(x, y * y) + y.powi(-2)
    }

    #[test]
    fn slopes_have_the_bits_of_dual_numbers() {
        for at in [[0.3, 1.1, 2.5], [2.0, 0.1, 0.7], [1.4, 1.4, 1.4]] {
            let Gradient { value, slopes } = function(Gradient::point(at));
            for axis in 0..3 {
                let along = |own: usize| Dual { value: at[own], slope: f64::from(u8::from(own == axis)) };
                let Dual { value: alone, slope } = function(per_axis(along));
                assert_eq!((value.to_bits(), slopes[axis]), (alone.to_bits(), slope), "{at:?} {axis}");
            }
        }
    }

    /// Intervals are widened by each operation, so these are the same operations.
    #[test]
    fn slopes_of_intervals_have_the_bits_of_dual_numbers() {
        for at in [[0.3, 1.1, 2.5], [2.0, 0.1, 0.7], [1.4, 1.4, 1.4]] {
            let [x, _, z] = at.map(|at| Interval { low: at - 1e-3, high: at + 1e-3 });
            let of = |[x, y]: [Gradient<Interval, 2>; 2]| {
                function([x, y, Scalar::constant(0.3)]) + function([y, x, x * y])
            };
            let Gradient { value, slopes } = of(Gradient::point([x, z]));
            for axis in 0..2 {
                let own = [x, z].map(Dual::fixed);
                let [x, y] =
                    from_fn(
                        |own_axis| {
                            if own_axis == axis { Dual::variable(own[axis].value) } else { own[own_axis] }
                        },
                    );
                let alone = function([x, y, Scalar::constant(0.3)]) + function([y, x, x * y]);
                assert_eq!((value, slopes[axis]), (alone.value, alone.slope), "{at:?} {axis}");
            }
        }
    }
}
