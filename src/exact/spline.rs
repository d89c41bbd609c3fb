//! Natural cubic splines.

use std::array;

/// The factorials of 0 to 3.
const FACTORIALS: [f64; 4] = [1.0, 1.0, 2.0, 6.0];

/// A curve of cubics, one between each two neighbouring points, with two continuous derivatives.
#[derive(Clone, Debug, PartialEq)]
pub struct Spline {
    /// The y of each point, rising.
    knots: Vec<f64>,
    /// The coefficients of each cubic and of its first three derivatives, the constant first.
    cubics: Vec<[[f64; 4]; 4]>,
}

impl Spline {
    /// Makes the natural spline through points (y, value), at least two, of which each y is above the one before: it
    /// has no curvature at its ends.
    pub fn new(points: &[[f64; 2]]) -> Self {
        let curvature = curvatures(points);
        let cubics = points.windows(2).zip(curvature.windows(2)).map(|(ends, curvatures)| {
            let (&[[y, value], [next, after]], &[bend, last]) = (ends, curvatures) else { unreachable!() };
            let width = next - y;
            let slope = (after - value) / width - width * (2.0 * bend + last) / 6.0;
            // The value and the first three derivatives at the lower point.
            let derivatives = [value, slope, bend, (last - bend) / width];
            array::from_fn(|order| {
                array::from_fn(|power| {
                    derivatives.get(order + power).map_or(0.0, |of| of / FACTORIALS[power])
                })
            })
        });
        let cubics = cubics.collect();
        Self { knots: points.iter().map(|[y, _]| *y).collect(), cubics }
    }

    /// Returns the index of the cubic at y. The first and the last go on beyond the ends.
    #[inline]
    pub fn piece(&self, y: f64) -> usize {
        let inner = &self.knots[1..self.knots.len() - 1];
        inner.partition_point(|knot| *knot <= y)
    }

    /// Returns where a cubic ends: its lower and its upper point's y, infinite for those that go on.
    pub fn ends(&self, piece: usize) -> [f64; 2] {
        let last = self.cubics.len() - 1;
        [
            if piece == 0 { f64::NEG_INFINITY } else { self.knots[piece] },
            if piece == last { f64::INFINITY } else { self.knots[piece + 1] },
        ]
    }

    /// Returns the y from which a cubic, or its derivative of an order from 0, is measured, and its coefficients, the
    /// constant first.
    #[inline]
    pub fn cubic(&self, piece: usize, order: usize) -> (f64, [f64; 4]) {
        (self.knots[piece], self.cubics[piece].get(order).copied().unwrap_or_default())
    }
}

/// Returns the second derivatives of the spline at its points: Thomas's algorithm for a diagonally dominant system.
fn curvatures(points: &[[f64; 2]]) -> Vec<f64> {
    let count = points.len();
    let width = |piece: usize| points[piece + 1][0] - points[piece][0];
    let rise = |piece: usize| (points[piece + 1][1] - points[piece][1]) / width(piece);
    let (mut above, mut right) = (vec![0.0; count], vec![0.0; count]);
    for at in 1..count - 1 {
        let pivot = 2.0 * (width(at - 1) + width(at)) - width(at - 1) * above[at - 1];
        above[at] = width(at) / pivot;
        right[at] = (6.0 * (rise(at) - rise(at - 1)) - width(at - 1) * right[at - 1]) / pivot;
    }
    for at in (1..count - 1).rev() {
        right[at] -= above[at] * right[at + 1];
    }
    right
}
