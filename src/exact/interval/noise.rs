//! Bounds of noise in a box, cell by cell if there are few.

use super::{Float, Interval};
use crate::noise;
use crate::scalar::{Scalar, of_noise};

/// The maximum number of cells along an axis that are examined one by one.
const MAX_CELLS: f64 = 2.0;

/// Encloses the noise, or its derivative of these orders, at the points of a box.
pub(crate) fn enclosed<F: Float>(at: [Interval<F>; 3], orders: [u8; 3]) -> Interval<F> {
    let most = noise::most(orders);
    let anywhere = match most.is_finite() {
        true => Interval { low: F::of(-most), high: F::of(most) },
        false => Interval::whole(),
    };
    let [low, high] = [0, 1].map(|end| at.map(|along| along.bounds()[end].floor()));
    // The comparison is false for NaN, which may be anywhere.
    let are_few = (0..3).all(|axis| high[axis] - low[axis] < MAX_CELLS);
    if !are_few {
        return anywhere;
    }
    let (zero, one) = (Interval::constant(0.0), Interval::constant(1.0));
    let mut all: Option<Interval<F>> = None;
    let counts = [0, 1, 2].map(|axis| (high[axis] - low[axis]) as usize + 1);
    for index in 0..counts.iter().product() {
        let cell = [index % counts[0], index / counts[0] % counts[1], index / (counts[0] * counts[1])];
        let corner = [0, 1, 2].map(|axis| low[axis] + cell[axis] as f64);
        let t = [0, 1, 2].map(|axis| at[axis].shifted(-corner[axis]).max(zero).min(one));
        let part = of_noise(corner, t, orders);
        all = Some(all.map_or(part, |all| all.hull(part)));
    }
    all.map_or(anywhere, |all| all.max(Interval::point(anywhere.low)).min(Interval::point(anywhere.high)))
}
